/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7 as the paper has it: the neighbourhood of each junction, a square of fixed size in pixels, is carried into the other
 * image by the pair's map H, and back by its inverse from the other junction; D = D~(P(j_n), H P(j_n)) + D~(P(j_m), H^-1
 * P(j_m)), where D~ is the L2 distance of the grey levels, or of SIFT descriptors.
 *
 * Kept for comparison; canonical patches (patch.c) cost a hundredth. Departure: a pair is dropped when more than a quarter of a
 * warped square lies outside its image (the paper does not say what happens there). */
#include "descriptor.h"
#include "distance.h"

#include <math.h>

/* Distance of two descriptions in grey levels (raw), or in units of the descriptor. */
static float difference(const asj_match_options *options, const uint16_t *grey1, const uint16_t *grey2)
{
    const int32_t samples = options->patch_size * options->patch_size, sift = options->descriptor == ASJ_DESCRIPTOR_SIFT;
    if (!sift && !options->normalise) {
        int64_t sum = 0;
        for (int32_t i = 0; i < samples; i++) {
            int32_t d = (int32_t)grey1[i] - (int32_t)grey2[i];
            sum += (int64_t)d * d;
        }
        return (float)(sqrt((double)sum) / ASJ_GRAY_ONE);
    }
    int16_t unit1[ASJ_PATCH_SAMPLES], unit2[ASJ_PATCH_SAMPLES];
    int32_t length = sift ? ASJ_SIFT_LENGTH : samples;
    if (sift) {
        asj_descriptor_sift(grey1, options->patch_size, unit1);
        asj_descriptor_sift(grey2, options->patch_size, unit2);
    } else {
        asj_patch_normalise(grey1, options->patch_size, unit1);
        asj_patch_normalise(grey2, options->patch_size, unit2);
    }
    double product = (double)asj_patch_product(unit1, unit2, length) / ((double)ASJ_UNIT_ONE * ASJ_UNIT_ONE);
    return product < 1 ? (float)sqrt(2 - 2 * product) : 0;
}

/* D~ of the square around `from` and its image around `to`. */
static float one_way(const asj_match_options *options, const asj_pyramid *pyramid1, const asj_affine_frame *from,
                     const asj_pyramid *pyramid2, const asj_affine_frame *to, const double map[4])
{
    uint16_t grey1[ASJ_PATCH_SAMPLES], grey2[ASJ_PATCH_SAMPLES];
    const double side = 2 * options->patch_radius;
    const asj_affine_frame square = {from->x, from->y, side, 0, 0, side};
    const asj_affine_frame warped = {to->x, to->y, side * map[0], side * map[2], side * map[1], side * map[3]};
    if (!asj_patch_sample(pyramid1, &square, options->patch_size, -0.5, 0.5, grey1) ||
        !asj_patch_sample(pyramid2, &warped, options->patch_size, -0.5, 0.5, grey2))
        return HUGE_VALF;
    return difference(options, grey1, grey2);
}

float asj_induced_distance(const asj_match_options *options, const asj_view *view1, const asj_view *view2, uint32_t i, uint32_t j)
{
    const asj_corners *c1 = &view1->corners, *c2 = &view2->corners;
    if (c1->first_frame[i] == c1->first_frame[i + 1] || c2->first_frame[j] == c2->first_frame[j + 1])
        return HUGE_VALF;
    const asj_affine_frame *f1 = &c1->frames[c1->first_frame[i]], *f2 = &c2->frames[c2->first_frame[j]];
    asj_linear map;
    if (!asj_affine_between(f1, f2, &map))
        return HUGE_VALF;
    float there = one_way(options, &view1->pyramid, f1, &view2->pyramid, f2, map.to);
    return there < HUGE_VALF ? there + one_way(options, &view2->pyramid, f2, &view1->pyramid, f1, map.from) : HUGE_VALF;
}
