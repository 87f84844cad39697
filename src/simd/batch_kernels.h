/* SPDX-License-Identifier: BSD-2-Clause */
/* Strengths of all sectors at pixels that are no neighbours, in vectors. Part of kernels.h.
 *
 * Gammas are computed for 8 neighbouring offsets of one pixel at once, which are contiguous in the image, for V_LANES pixels from
 * anywhere; squares of 8 x 8 are then turned round, and from there on a vector holds V_LANES pixels. */
#ifndef ASJ_SRC_SIMD_BATCH_KERNELS_H
#define ASJ_SRC_SIMD_BATCH_KERNELS_H

#include "detect/field.h"
#include "strength_kernels.h"

#define SQUARE ASJ_SECTOR_RUN
#define SQUARES (V_LANES / SQUARE) /* side by side in a vector */

/* Pixels to work on together. */
typedef struct batch {
    int32_t count;
    ptrdiff_t at[SQUARE][SQUARES]; /* of pixel 8 j + i, in the planes, at [i][j] */
} batch;

static inline void add_to_batch(batch *b, ptrdiff_t at)
{
    b->at[b->count % SQUARE][b->count / SQUARE] = at;
    b->count++;
}

/* Unused lanes look where another looks. */
static inline void fill_batch(batch *b)
{
    for (int32_t i = b->count; i < V_LANES; i++)
        b->at[i % SQUARE][i / SQUARE] = b->at[0][0];
}

/* Columns become rows, in each 128 bits. */
static inline void turn_square(vec v[SQUARE])
{
    vec t[SQUARE];
    for (int i = 0; i < 4; i++) {
        t[2 * i] = v_interleave_low(v[2 * i], v[2 * i + 1]);
        t[2 * i + 1] = v_interleave_high(v[2 * i], v[2 * i + 1]);
    }
    for (int i = 0; i < 8; i += 4)
        for (int j = 0; j < 2; j++) {
            v[i + 2 * j] = v_interleave32_low(t[i + j], t[i + j + 2]);
            v[i + 2 * j + 1] = v_interleave32_high(t[i + j], t[i + j + 2]);
        }
    for (int i = 0; i < 4; i++) {
        t[2 * i] = v_interleave64_low(v[i], v[i + 4]);
        t[2 * i + 1] = v_interleave64_high(v[i], v[i + 4]);
    }
    for (int i = 0; i < SQUARE; i++)
        v[i] = t[i];
}

/* gamma at each offset of all runs. */
static void batch_gammas(const asj_sector_runs *runs, const asj_frame *frame, const batch *b, uint16_t *gamma)
{
    for (int32_t r = 0; r < runs->count; r++, gamma += SQUARE * V_LANES) {
        const ptrdiff_t to = runs->dy[r] * frame->stride + runs->dx[r];
        const int16_t *gx = frame->gradient_x + to, *gy = frame->gradient_y + to;
        int16_t(*const factors)[SQUARE] = runs->factors + 4 * r;
        const vec ux = v_load_repeated(factors[0]), uy = v_load_repeated(factors[1]);
        const vec cross_x = v_load_repeated(factors[2]), dot_y = v_load_repeated(factors[3]);
        vec v[SQUARE];
#pragma GCC unroll 8 /* so that they stay in registers */
        for (int i = 0; i < SQUARE; i++) {
            const vec x = v_load_places(gx, b->at[i]), y = v_load_places(gy, b->at[i]);
            const vec cross = v_abs(v_sub(v_high(x, uy), v_high(y, cross_x)));
            const vec dot = v_abs(v_sub(v_high(x, ux), v_high(y, dot_y)));
            v[i] = v_sub_saturated(cross, dot);
        }
        turn_square(v);
        for (int i = 0; i < SQUARE; i++)
            v_store(gamma + i * V_LANES, v[i]);
    }
}

/* Slots of asj_sector_plan, then strengths, with `suppress` sectors repeated at either end. Every running sum is stored, most of
 * them where a later one goes: which are wanted is then no question. */
static void batch_strengths(const asj_sectors *s, const asj_sector_plan *plan, int32_t suppress, const uint16_t *gamma,
                            uint16_t *slots, int16_t *z)
{
    enum { SCALE = V_LANES / ASJ_SECTOR_RUN };
    /* what is stored might be part of the plan, for all that compilers know: its pointers are read once */
    const int16_t *const extra = plan->extra, *const low = plan->low, *const high = plan->high;
    const uint16_t *const mean = s->mean, *const scale = s->scale;
    const int32_t plain_count = plan->plain_count, extra_count = plan->slot_count - plain_count, count = s->count;
    const int16_t(*step)[2] = (const int16_t(*)[2])plan->steps;
    vec total = v_zero();
    v_store(slots, total); /* before the first offset a sector may begin */
#pragma GCC unroll 4
    for (int32_t i = 0; i < s->offset_count; i++, step++) {
        total = v_add(total, v_load(gamma + (ptrdiff_t)step[0][0] * SCALE));
        v_store(slots + (ptrdiff_t)step[0][1] * SCALE, total);
    }
    uint16_t *slot = slots + (ptrdiff_t)plain_count * V_LANES;
    for (int32_t e = 0; e < extra_count; e++, slot += V_LANES)
        v_store(slot, v_add(total, v_load(slots + (ptrdiff_t)extra[e] * V_LANES)));
    int16_t *to = z + suppress * V_LANES;
    for (int32_t k = 0; k < count; k++, to += V_LANES) {
        const vec sum = v_sub(v_load(slots + (ptrdiff_t)high[k] * V_LANES), v_load(slots + (ptrdiff_t)low[k] * V_LANES));
        v_store(to, v_strength(sum, mean[k], scale[k]));
    }
    repeat_ends(z, count, suppress, V_LANES);
}

/* Peaks of each pixel, largest value first; of equals the one put in first. Of as many sectors in a row as peaks suppress, and one
 * more, a pixel has one peak at most, so that the peaks of these are put in at once. */
typedef struct ranking {
    vec values[ASJ_MAX_BRANCHES], sectors[ASJ_MAX_BRANCHES];
} ranking;

/* `most` places with the value that stands for no peak. */
static inline void start_ranking(ranking *ranked, int32_t most, vec none)
{
    for (int32_t m = 0; m < most; m++) {
        ranked->values[m] = none;
        ranked->sectors[m] = v_zero();
    }
}

/* One peak of each pixel, or none. What has had to leave its place takes the next one, also from its equal. */
static inline void insert_peaks(ranking *ranked, int32_t most, vec value, vec sector)
{
    vec moves = v_zero();
    for (int32_t m = 0; m < most; m++) {
        moves = v_or(moves, v_greater(value, ranked->values[m]));
        const vec change = v_and(moves, v_xor(sector, ranked->sectors[m]));
        const vec rest = v_min(value, ranked->values[m]);
        ranked->values[m] = v_max(value, ranked->values[m]);
        ranked->sectors[m] = v_xor(ranked->sectors[m], change);
        value = rest;
        sector = v_xor(sector, change);
    }
}

#endif
