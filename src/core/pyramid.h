/* SPDX-License-Identifier: BSD-2-Clause */
/* Image pyramids. All integer from the grey levels on. */
#ifndef ASJ_SRC_PYRAMID_H
#define ASJ_SRC_PYRAMID_H

#include "image.h"

#define ASJ_PYRAMID_LEVELS 6

/* Level l holds means of 2^l x 2^l pixels; its pixel (i, j) is centred at ((i + 0.5) 2^l - 0.5, (j + 0.5) 2^l - 0.5) of level
 * 0. Grey levels in 1/128. Each plane has one more column and row than its size: copies of the last ones, so that interpolation
 * needs no test. */
typedef struct asj_pyramid {
    int32_t levels;
    int32_t width[ASJ_PYRAMID_LEVELS];
    int32_t height[ASJ_PYRAMID_LEVELS];
    uint16_t *plane[ASJ_PYRAMID_LEVELS]; /* row y of level l at [y * (width[l] + 1)] */
    const asj_ops *ops;                  /* the context's */
} asj_pyramid;

/* From an image view: blurred with a Gaussian of standard deviation `smoothing` px (0 = not), then halved. Statuses as
 * asj_detect() has them for images. On failure the caller still frees. */
asj_status asj_pyramid_create(asj_context *context, const asj_image *image, double smoothing, asj_pyramid *pyramid);
/* The same of the image upsampled by two (asj_frame_upsample()). */
asj_status asj_pyramid_create_upsampled(asj_context *context, const asj_image *image, double smoothing, asj_pyramid *pyramid);
void asj_pyramid_free(asj_memory *memory, asj_pyramid *pyramid);

/* The same in two parts, for a level 0 from elsewhere: room for all levels, and, when level 0 holds its pixels, their borders and
 * the other levels. ASJ_ERROR_MEMORY; on failure the caller still frees. */
asj_status asj_pyramid_allocate(asj_context *context, int32_t width, int32_t height, asj_pyramid *pyramid);
void asj_pyramid_complete(asj_context *context, asj_pyramid *pyramid);

/* The level on which neighbouring samples that span `area` px^2 (of level 0) are closest to 1 px apart, a little on the fine
 * side. */
int32_t asj_pyramid_level(const asj_pyramid *pyramid, double area);

/* Grey levels (1/128) at x[i], y[i] (level 0 pixels), bilinear in 1/256 px; outside the image its border continues. Returns
 * how many lay inside. */
int32_t asj_pyramid_sample(const asj_pyramid *pyramid, int32_t level, const float *x, const float *y, int32_t count,
                           uint16_t *grey);
int32_t asj_pyramid_sample_reference(const asj_pyramid *pyramid, int32_t level, const float *x, const float *y, int32_t count,
                                     uint16_t *grey);

/* One row of a Gaussian with taps that sum to 2^14: rows[0] is the middle one, rows[2 i - 1] and rows[2 i] those i before and after
 * it; grey levels below 2^15. */
#define ASJ_BLUR_RADIUS 6 /* 3 sigma of the largest blur */
#define ASJ_BLUR_ROWS (2 * ASJ_BLUR_RADIUS + 1)
void asj_blur_row(const uint16_t *const *rows, const int32_t *taps, int32_t radius, int32_t width, uint16_t *to);

/* Operations (ops.h). */
typedef struct asj_pyramid_ops {
    /* asj_blur_row() */
    void (*blur_row)(const uint16_t *const *rows, const int32_t *taps, int32_t radius, int32_t width, uint16_t *to);
    /* asj_pyramid_sample_reference() */
    int32_t (*sample)(const asj_pyramid *pyramid, int32_t level, const float *x, const float *y, int32_t count, uint16_t *grey);
} asj_pyramid_ops;
extern const asj_pyramid_ops asj_pyramid_reference;

#endif
