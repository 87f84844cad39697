/* SPDX-License-Identifier: BSD-2-Clause */
/* What an image's colours show beside its luma, as planes of grey levels. */
#ifndef ASJ_SRC_COLOUR_PLANE_H
#define ASJ_SRC_COLOUR_PLANE_H

#include "context.h"

/* Where the channels of an 8-bit colour image stand: red at byte 0 or 2 of a pixel, blue at the other, green between them. */
typedef struct asj_channels {
    const uint8_t *first;     /* of the top row */
    ptrdiff_t stride;         /* bytes from row to row */
    int32_t width, height;
    int32_t step, red;        /* bytes from pixel to pixel; of red in it */
} asj_channels;

/* Of a view that asj_image_check() has passed. 0 = it is grey. */
int32_t asj_channels_of(const asj_image *image, asj_channels *channels);

/* Planes of an image. Grey images, and colour images without a colour, have the first one only. */
enum { ASJ_PLANE_LUMA = 0, ASJ_PLANE_RED_GREEN = 1, ASJ_PLANE_BLUE_YELLOW = 2, ASJ_PLANES = 3 };

/* What is known of an image's planes. */
typedef struct asj_colour_planes {
    int32_t count;               /* ASJ_PLANES, or 1 */
    int32_t smooth[ASJ_PLANES];  /* 1 = neighbouring pixels of its noise are alike: see colour_plane.c; luma: 0 */
} asj_colour_planes;

/* Whether any pixel of a view that asj_image_check() has passed has a colour. ASJ_ERROR_CANCELLED. */
asj_status asj_image_has_colours(asj_context *context, const asj_image *image, int32_t *has);

/* Of such a view. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_colour_planes_look(asj_context *context, const asj_image *image, asj_colour_planes *planes);

/* `width` pixels of a colour plane. `step` bytes from pixel to pixel, red at byte 0 or 2, blue at the other, green between them.
 * levels: of 8-bit samples, in 1/ASJ_GRAY_ONE of a grey level; NULL = they are grey levels. */
void asj_colour_row(const uint8_t *pixels, int32_t width, int32_t step, int32_t red, const uint16_t *levels, int32_t plane,
                    uint16_t *to);

#endif
