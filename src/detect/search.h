/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5 as in the paper: the orientation of strongest junction-ness. */
#ifndef ASJ_SRC_SEARCH_H
#define ASJ_SRC_SEARCH_H

#include "core/image.h"

/* omega: the sum of gamma over the sector of radius `length` around `angle`, half-width tau px, at a whole pixel; and how many
 * pixels it has in the image. */
typedef struct asj_search_sum {
    double gamma;
    int32_t pixels;
} asj_search_sum;

asj_search_sum asj_search_omega(const asj_frame *frame, double x, double y, double angle, double length, double tau);

/* Normalised junction-ness of that sector: standard deviations above the null model's mean. */
double asj_search_strength(const asj_frame *frame, double x, double y, double angle, double length, double tau);

#endif
