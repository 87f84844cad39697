/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7 as the paper has it: the neighbourhood of each junction, a square of fixed size in pixels, is carried into the other
 * image by the pair's map H, and back by its inverse from the other junction; D = D~(P(j_n), H P(j_n)) + D~(P(j_m), H^-1
 * P(j_m)), where D~ is the L2 distance of the grey levels, or of SIFT descriptors.
 *
 * Kept for comparison; canonical patches (patch.c) cost a hundredth. Departure: a pair is dropped when more than a quarter of a
 * warped square lies outside its image (the paper does not say what happens there). */
#include "patch_induced.h"
#include "describe.h"
#include "sift.h"
#include "core/threads.h"

#include <math.h>

#define DISTANCE_ONE 65536 /* distances of raw patches are below 2^14, so that a score has at most 30 bits */

/* What is compared: grey levels, grey levels brought to zero mean and unit norm, or a descriptor. */
static void describe(const asj_match_options *options, const uint16_t *grey, int16_t *description)
{
    if (options->descriptor == ASJ_DESCRIPTOR_SIFT)
        asj_sift_describe(grey, options->patch_size, description);
    else if (options->normalise)
        asj_patch_normalise(grey, options->patch_size, description);
    else
        for (int32_t i = 0; i < options->patch_size * options->patch_size; i++)
            description[i] = (int16_t)grey[i]; /* below 2^15 */
}

float asj_patch_induced_raw(int64_t sum)
{
    return (float)(sqrt((double)sum) / ASJ_GRAY_ONE);
}

/* Distance of two descriptions in grey levels (raw), or in units of the descriptor. */
static float difference(const asj_match_options *options, const int16_t *left, const int16_t *right)
{
    const int32_t length = asj_patch_length(options);
    if (options->descriptor != ASJ_DESCRIPTOR_SIFT && !options->normalise) {
        int64_t sum = 0;
        for (int32_t i = 0; i < length; i++) {
            const int32_t d = (int32_t)left[i] - (int32_t)right[i];
            sum += (int64_t)d * d;
        }
        return asj_patch_induced_raw(sum);
    }
    const double product = (double)asj_patch_product(left, right, length) / ((double)ASJ_UNIT_ONE * ASJ_UNIT_ONE);
    return product < 1 ? (float)sqrt(2 - 2 * product) : 0;
}

typedef struct job {
    const asj_match_options *options;
    asj_image_features *features;
} job;

static void describe_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const size_t length = (size_t)asj_patch_length(j->options);
    const double side = 2 * j->options->patch_radius;
    for (int64_t l = part->first; l < part->end; l++) {
        uint16_t grey[ASJ_PATCH_SAMPLES];
        const asj_l_junction *at = &j->features->l_junctions.l[l];
        const asj_affine_frame square = {(double)at->x, (double)at->y, side, 0, 0, side};
        j->features->usable[l] = (uint8_t)asj_patch_sample(&j->features->pyramid, &square, j->options->patch_size, -0.5, 0.5, grey);
        describe(j->options, grey, j->features->patches + (size_t)l * length);
    }
}

/* The square of an L-junction does not depend on its partner: it is described once. */
asj_status asj_patch_induced_describe(asj_context *context, const asj_match_options *options, asj_image_features *features)
{
    const size_t length = (size_t)asj_patch_length(options);
    const int64_t count = features->l_junctions.count;
    features->patches = asj_allocate(&context->memory, (size_t)count, length * sizeof *features->patches);
    features->usable = asj_allocate(&context->memory, (size_t)count, sizeof *features->usable);
    if (!features->patches || !features->usable)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %lld patches", (long long)count);
    const job j = {options, features};
    asj_parallel(context, context->threads, count, 0, describe_some, &j);
    return ASJ_OK;
}

asj_affine_frame asj_patch_induced_frame(const asj_match_options *options, const asj_l_junction *l, const double map[4])
{
    const double size = 2 * options->patch_radius;
    return (asj_affine_frame){(double)l->x, (double)l->y, size * map[0], size * map[2], size * map[1], size * map[3]};
}

/* D~ of the square around L-junction `from` of image `side` (0 or 1) and its image around `to` of the other. */
static float one_way(const asj_match_run *run, int32_t side, uint32_t from, uint32_t to, const double map[4])
{
    uint16_t grey[ASJ_PATCH_SAMPLES];
    int16_t description[ASJ_PATCH_SAMPLES];
    const asj_match_options *options = run->options;
    const asj_image_features *mine = run->image[side], *other = run->image[1 - side];
    const asj_affine_frame warped = asj_patch_induced_frame(options, &other->l_junctions.l[to], map);
    if (!mine->usable[from] || !asj_patch_sample(&other->pyramid, &warped, options->patch_size, -0.5, 0.5, grey))
        return HUGE_VALF;
    describe(options, grey, description);
    return difference(options, mine->patches + (size_t)from * (size_t)asj_patch_length(options), description);
}

int32_t asj_patch_induced_map(const asj_match_run *run, uint32_t i, uint32_t j, asj_linear *map)
{
    const asj_l_junctions *l_junctions1 = &run->image[0]->l_junctions, *l_junctions2 = &run->image[1]->l_junctions;
    const uint32_t f = l_junctions1->first_frame[i], g = l_junctions2->first_frame[j];
    return f < l_junctions1->first_frame[i + 1] && g < l_junctions2->first_frame[j + 1] && run->image[0]->usable[i] &&
           run->image[1]->usable[j] && asj_affine_between(&l_junctions1->frames[f], &l_junctions2->frames[g], map);
}

float asj_patch_induced_distance(const asj_match_run *run, uint32_t i, uint32_t j)
{
    asj_linear map;
    if (!asj_patch_induced_map(run, i, j, &map))
        return HUGE_VALF;
    const float there = one_way(run, 0, i, j, map.to);
    return there < HUGE_VALF ? there + one_way(run, 1, j, i, map.from) : HUGE_VALF;
}

int32_t asj_patch_induced_to_score(float distance)
{
    return distance < HUGE_VALF ? -(int32_t)lrintf(distance * DISTANCE_ONE) : ASJ_NO_PARTNER;
}

double asj_patch_induced_of_score(int32_t score)
{
    return -(double)score / DISTANCE_ONE;
}
