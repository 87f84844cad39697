/* SPDX-License-Identifier: BSD-2-Clause */
/* Sums over the pixels of a straight band: what a quick fit of a line to an edge needs. */
#ifndef ASJ_SRC_LINE_SUMS_H
#define ASJ_SRC_LINE_SUMS_H

#include "core/image.h"

#define ASJ_LINE_LANES 16

/* The pixels around a middle with |(p - middle).u| <= half_length and |(p - middle).n| <= half_width, n = u turned by +90
 * degrees. */
typedef struct asj_line_band {
    float ux, uy;
    int32_t x, y;                       /* a pixel near the middle, from which columns and rows are counted */
    float middle_x, middle_y;           /* the middle from there, less than a pixel */
    int32_t top, bottom, left, right;   /* what it is within, of the image too */
    float reach_t, step_t;              /* rows of the band's ends: middle_y + step_t (column - middle_x) -+ reach_t */
    float reach_s, step_s;              /* and of its sides */
} asj_line_band;

/* With weights w of the pixels whose gradient points along +n or along -n: sums of w, w x, w x^2 ..; (x, y) from the middle. */
typedef struct asj_line_sums {
    float w, x, y, xx, xy, yy;
} asj_line_sums;

/* Where a band lies: its middle, the unit vector along it, half its length and width in px. */
typedef struct asj_line_box {
    double x, y;
    double ux, uy;
    double half_length, half_width;
} asj_line_box;

/* Pixels at the border of the image, where a gradient has one neighbour only, are left out. */
void asj_line_band_set(const asj_frame *frame, const asj_line_box *box, asj_line_band *band);

/* sums[1]: the gradient points along +n, sums[0]: along -n. */
void asj_line_sums_of(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2]);

#define ASJ_PROFILE_SAMPLES 96  /* along the line; a multiple of ASJ_LINE_LANES */
#define ASJ_PROFILE_OFFSETS 11  /* across */

/* Samples between the pixels, around the line s = a + b t: at t = first + k step and s = a + b t + offset[i]. */
typedef struct asj_line_profile {
    float ux, uy;
    float first, step, a, b;
    float offset[ASJ_PROFILE_OFFSETS];
    int32_t count, offsets;
    int32_t x, y;               /* a pixel near the origin */
    float origin_x, origin_y;   /* the origin from there, less than a pixel */
} asj_line_profile;

/* With weights w of the samples whose gradient points along -n and along +n: sums of w and of w offset, for each k. */
typedef struct asj_profile_sums {
    float w[2][ASJ_PROFILE_SAMPLES], moment[2][ASJ_PROFILE_SAMPLES];
    int32_t counts[2]; /* of k with any */
    struct asj_profile_totals {
        float w, k, kk, r, kr; /* over all k: of w, w k, w k^2, and of the moments, also times k */
    } totals[2];
} asj_profile_sums;

void asj_line_profile_of(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums);

/* ---- for its vector forms ---- */

/* The same for from <= k < to. */
void asj_line_profile_part(const asj_frame *frame, const asj_line_profile *profile, int32_t from, int32_t to,
                           asj_profile_sums *sums);

/* Whether all samples of these k have the pixels around them that interpolation wants. */
int asj_line_profile_inside(const asj_frame *frame, const asj_line_profile *profile, int32_t from, int32_t to);

/* The rows that so many columns from `column` on may have inside, from *first to *last. */
static inline void asj_line_band_rows(const asj_line_band *band, int32_t column, int32_t columns, int32_t *first, int32_t *last)
{
    const float dx = (float)column - band->middle_x, end = dx + (float)(columns - 1);
    const float t = band->step_t * dx, end_t = band->step_t * end, s = band->step_s * dx, end_s = band->step_s * end;
    const float top_t = (t < end_t ? t : end_t) - band->reach_t, bottom_t = (t > end_t ? t : end_t) + band->reach_t;
    const float top_s = (s < end_s ? s : end_s) - band->reach_s, bottom_s = (s > end_s ? s : end_s) + band->reach_s;
    float top = band->middle_y + (top_t > top_s ? top_t : top_s);
    float bottom = band->middle_y + (bottom_t < bottom_s ? bottom_t : bottom_s);
    top = top > (float)band->top ? top : (float)band->top;
    bottom = bottom < (float)band->bottom ? bottom : (float)band->bottom;
    *first = top <= bottom + 1 ? (int32_t)(top + 131072) - 131072 : band->bottom + 1; /* a row too many does no harm */
    *last = top <= bottom + 1 ? (int32_t)(bottom + 131073) - 131072 : band->bottom;
    *last = *last < band->bottom ? *last : band->bottom;
}

/* Operations (core/ops.h). */
typedef struct asj_line_ops {
    /* asj_line_sums_of(), asj_line_profile_of() */
    void (*sums)(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2]);
    void (*profile)(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums);
} asj_line_ops;
extern const asj_line_ops asj_line_reference;

#endif
