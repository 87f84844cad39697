/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 1: image -> normalised gradient. */
#ifndef ASJ_SRC_GRADIENT_H
#define ASJ_SRC_GRADIENT_H

#include "image.h"

/* Units of the normalised gradient, and the largest norm that it can have (see gradient.c). */
#define ASJ_GRADIENT_ONE 1024
#define ASJ_GRADIENT_LIMIT 3.5

/* Fills frame->gradient_x and frame->gradient_y from frame->gray. */
asj_status asj_gradient(asj_context *context, asj_frame *frame, const asj_detect_options *options);

/* Gradient of the gray plane itself at a sub-pixel place, in grey levels per pixel: bilinear between the central differences of
 * the four pixels around; places outside are moved to the nearest inside. */
void asj_gradient_sample(const asj_frame *frame, double x, double y, double *gx, double *gy);

#endif
