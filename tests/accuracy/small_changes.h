/* SPDX-License-Identifier: BSD-2-Clause */
/* Copies of an image that hardly differ from it. */
#ifndef ASJ_TESTS_ACCURACY_SMALL_CHANGES_H
#define ASJ_TESTS_ACCURACY_SMALL_CHANGES_H

#include "correspond.h"

enum { CHANGE_ZOOM, CHANGE_PIXEL, CHANGE_SHIFT, CHANGE_BLUR, CHANGE_NOISE, CHANGE_JPEG, CHANGE_GAIN, CHANGES };

extern const char *const change_names[CHANGES];

typedef struct changed_image {
    uint8_t *pixels; /* 8-bit grey, row by row; free() */
    int32_t width, height;
    correspond_map map; /* from the image to the copy */
} changed_image;

/* CHANGE_...
 * ZOOM   0.9 times as large, area averages
 * PIXEL  by one pixel to the left and up
 * SHIFT  by half a pixel to the right and down, cubic interpolation
 * BLUR   Gaussian, standard deviation 0.5 px
 * NOISE  normal, standard deviation 2 grey levels
 * JPEG   what quality 90 leaves
 * GAIN   times 0.8
 * 0, or -1 (memory, or an image of one pixel). */
int change_image(const uint8_t *pixels, int32_t width, int32_t height, int change, changed_image *out);

#endif
