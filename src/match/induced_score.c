/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7 with the paper's patches (patch_induced.c), for all pairs: the same scores as asj_score_pair(), but a pair that cannot
 * come on a short list any more is left.
 *
 * D = |f - Hf| + |g - H^-1 g| is a sum of roots of sums of squares, which only grow. The samples of both patches are taken in
 * parts, in turn, each a grid of its own over the whole patch; what is there bounds D from below, and a pair is left when that is
 * too far by more than rounding can be wrong. Descriptors and normalised patches need all samples: they are compared in one go. */
#include "induced_score.h"
#include "compare.h"
#include "describe.h"
#include "patch_induced.h"

#include <math.h>

#define DOUBT 2e-6 /* more than scores are rounded by, as a part of the distance */

#define STRIDE 2   /* a part takes every such row and column */
#define PARTS (STRIDE * STRIDE)

static int32_t in_parts(const asj_match_options *options)
{
    return options->patches == ASJ_PATCHES_INDUCED && options->descriptor == ASJ_DESCRIPTOR_RAW && !options->normalise &&
           options->patch_size % (4 * STRIDE) == 0; /* sides of samples come in fours */
}

/* ---- the squares, part by part ---- */

static void order_square(const int16_t *square, int32_t size, int16_t *ordered)
{
    for (int32_t part = 0; part < PARTS; part++)
        for (int32_t j = part / STRIDE; j < size; j += STRIDE)
            for (int32_t i = part % STRIDE; i < size; i += STRIDE)
                *ordered++ = square[j * size + i];
}

asj_status asj_induced_squares_create(const asj_match_run *run, asj_induced_squares *squares)
{
    const size_t length = (size_t)asj_patch_length(run->options);
    *squares = (asj_induced_squares){{NULL, NULL}};
    for (int32_t side = 0; side < 2 && in_parts(run->options); side++) {
        const asj_image_features *features = run->image[side];
        const uint32_t count = features->l_junctions.count;
        squares->of[side] = asj_allocate(&run->context->memory, count, length * sizeof *squares->of[side]);
        if (!squares->of[side])
            return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %u patches", (unsigned)count);
        for (uint32_t l = 0; l < count; l++)
            order_square(features->patches + l * length, run->options->patch_size, squares->of[side] + l * length);
    }
    return ASJ_OK;
}

void asj_induced_squares_free(asj_memory *memory, asj_induced_squares *squares)
{
    asj_release(memory, squares->of[0]);
    asj_release(memory, squares->of[1]);
}

/* ---- a pair ---- */

/* One direction: the square of one image, carried into the other. */
typedef struct direction {
    const asj_pyramid *pyramid;
    const int16_t *square;
    asj_patch_grid grid;
    int32_t side, inside; /* samples along a side of a part; samples so far that lie in the image */
    int64_t sum;          /* of squares, and its root */
    double root;
} direction;

static direction direct(const asj_match_run *run, const asj_induced_squares *squares, int32_t side, uint32_t from, uint32_t to,
                        const double map[4])
{
    const asj_image_features *other = run->image[1 - side];
    const int32_t size = run->options->patch_size;
    const asj_affine_frame warped = asj_patch_induced_frame(run->options, &other->l_junctions.l[to], map);
    direction d = {.pyramid = &other->pyramid, .square = squares->of[side] + (size_t)from * (size_t)(size * size),
                   .side = size / STRIDE};
    asj_patch_grid_set(d.pyramid, &warped, size, -0.5, 0.5, &d.grid);
    return d;
}

/* |d| < 2^15, so that d^2 < 2^30; its halves are added apart. */
static int64_t squared_difference(const int16_t *left, const uint16_t *right, int32_t count)
{
    uint32_t low = 0, high = 0;
    for (int32_t i = 0; i < count; i++) {
        const int32_t d = (int16_t)(left[i] - (int16_t)right[i]);
        const uint32_t square = (uint32_t)(d * d);
        low += square & 0xffff;
        high += square >> 16;
    }
    return ((int64_t)high << 16) + low;
}

static void add_part(direction *d, int32_t part)
{
    uint16_t grey[ASJ_PATCH_SAMPLES / PARTS];
    const int32_t count = d->side * d->side, right = part % STRIDE, down = part / STRIDE;
    const asj_patch_grid *whole = &d->grid;
    const asj_patch_grid grid = {whole->level, whole->x + right * whole->ax + down * whole->bx,
                                 whole->y + right * whole->ay + down * whole->by, STRIDE * whole->ax, STRIDE * whole->ay,
                                 STRIDE * whole->bx, STRIDE * whole->by};
    d->inside += d->pyramid->ops->patch->levels(d->pyramid, &grid, d->side, grey);
    d->sum += squared_difference(d->square + part * count, grey, count);
    d->root = sqrt((double)d->sum);
}

static int32_t enough_inside(const direction *d)
{
    return 4 * d->inside >= 3 * PARTS * d->side * d->side;
}

/* Sums of both roots above it give no score above `needed`. */
static double farthest(int32_t needed)
{
    return needed > ASJ_NO_PARTNER ? asj_patch_induced_of_score(needed) * ASJ_GRAY_ONE * (1 + DOUBT) : HUGE_VAL;
}

static int32_t score_in_parts(const asj_match_run *run, const asj_induced_squares *squares, uint32_t i, uint32_t j, int32_t needed)
{
    asj_linear map;
    if (!asj_patch_induced_map(run, i, j, &map))
        return ASJ_NO_PARTNER;
    direction there = direct(run, squares, 0, i, j, map.to), back = direct(run, squares, 1, j, i, map.from);
    if (there.grid.level < 0 || back.grid.level < 0)
        return ASJ_NO_PARTNER;
    const double most = farthest(needed);
    for (int32_t part = 0; part < PARTS; part++) {
        add_part(&there, part);
        if (there.root + back.root > most)
            return ASJ_NO_PARTNER;
        add_part(&back, part);
        if (there.root + back.root > most)
            return ASJ_NO_PARTNER;
    }
    if (!enough_inside(&there) || !enough_inside(&back))
        return ASJ_NO_PARTNER;
    return asj_patch_induced_to_score(asj_patch_induced_raw(there.sum) + asj_patch_induced_raw(back.sum));
}

int32_t asj_induced_score(const asj_match_run *run, const asj_induced_squares *squares, uint32_t i, uint32_t j, int32_t needed)
{
    return squares->of[0] ? score_in_parts(run, squares, i, j, needed) : asj_score_pair(run, i, j).score;
}
