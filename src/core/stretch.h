/* SPDX-License-Identifier: BSD-2-Clause */
/* Images of more pixels. Pixel areas map: the point (x, y) of the image is at (s_x (x + 1/2) - 1/2, s_y (y + 1/2) - 1/2). */
#ifndef ASJ_SRC_STRETCH_H
#define ASJ_SRC_STRETCH_H

#include "context.h"

#include <asj/image.h>

/* A copy of a view that asj_image_check() has passed, of `width` x `height` pixels, no fewer than half of what it has in either
 * direction: interpolated between the four pixels around (at a half that is their mean), of the same format, rows without gaps.
 * The pixels are the caller's, allocated in `memory`. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_stretch_image(asj_context *context, asj_memory *memory, const asj_image *image, int32_t width, int32_t height,
                             asj_image *stretched, void **pixels);

#endif
