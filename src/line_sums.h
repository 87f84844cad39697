/* SPDX-License-Identifier: BSD-2-Clause */
/* Sums over the pixels of a straight band: what a quick fit of a line to an edge needs. */
#ifndef ASJ_SRC_LINE_SUMS_H
#define ASJ_SRC_LINE_SUMS_H

#include "image.h"

#define ASJ_LINE_LANES 8

/* The pixels with first <= t <= last and low <= s <= high, t = (p - origin).u, s = (p - origin).n, n = u turned by +90 degrees. */
typedef struct asj_line_band {
    float ux, uy;
    float first, last, low, high;
    int32_t x, y;                    /* a pixel near the origin, from which columns and rows are counted */
    float origin_x, origin_y;        /* the origin from there, less than a pixel */
    int32_t top, bottom;             /* rows, counted from y */
    int32_t left, right;             /* columns that the image has, counted from x */
    float near_t, far_t, step_t;     /* columns of the band's ends: near_t + step_t (row - origin_y) .. */
    float near_s, far_s, step_s;     /* and of its sides */
} asj_line_band;

/* With weights w of the pixels whose gradient points along +n or along -n: sums of w, w t, w t^2, w s, w t s. */
typedef struct asj_line_sums {
    float w, t, tt, s, ts;
} asj_line_sums;

/* Pixels at the border of the image, where a gradient has one neighbour only, are left out. */
void asj_line_band_set(const asj_frame *frame, double x, double y, double angle, const double t[2], const double s[2],
                       asj_line_band *band);

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
} asj_profile_sums;

void asj_line_profile_of(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums);

/* ---- for its vector forms ---- */

/* The same for from <= k < to. */
void asj_line_profile_part(const asj_frame *frame, const asj_line_profile *profile, int32_t from, int32_t to,
                           asj_profile_sums *sums);

/* Whether all samples of these k have the pixels around them that interpolation wants. */
int asj_line_profile_inside(const asj_frame *frame, const asj_line_profile *profile, int32_t from, int32_t to);

/* The columns of a row that may be inside, from *first to *last. */
static inline void asj_line_band_row(const asj_line_band *band, int32_t row, int32_t *first, int32_t *last)
{
    const float dy = (float)row - band->origin_y, t = band->step_t * dy, s = band->step_s * dy;
    float low = band->near_t + t, high = band->far_t + t;
    low = band->near_s + s > low ? band->near_s + s : low;
    high = band->far_s + s < high ? band->far_s + s : high;
    low = low > (float)band->left ? low : (float)band->left;
    high = high < (float)band->right ? high : (float)band->right;
    low = low < (float)(band->right + 1) ? low : (float)(band->right + 1); /* none: still near the image, for who reads there */
    high = high > (float)(band->left - 1) ? high : (float)(band->left - 1);
    *first = (int32_t)(low + 32768.99f) - 32768; /* a pixel too many does no harm: its t and s tell */
    *last = (int32_t)(high + 32768.01f) - 32768;
}

#endif
