/* SPDX-License-Identifier: BSD-2-Clause */
/* From the caller's view to the planes that the steps work on. */
#ifndef ASJ_SRC_IMAGE_H
#define ASJ_SRC_IMAGE_H

#include "colour_plane.h"
#include "gray_level.h"

/* Samples of the gray plane on either side of a row that may be read: ASJ_GRAY_BORDER times the border pixel again, then anything.
 * As many rows above and below repeat the first and the last one. So line fits near the border read what is there (line_sums.c). */
#define ASJ_GRAY_MARGIN 32
#define ASJ_GRAY_BORDER 8

/* Zeros around the gradient planes, so that sectors may look outside: more than the largest radius. */
#define ASJ_MARGIN 32

/* Pixels that the field and the isotropic test work on at once: a run in one row, starting at a multiple of it. */
#define ASJ_LANES 16

/* The image in working form. All planes share one layout: sample (x, y) at [y * stride + x] from the pointer; those of the gradient
 * stand ASJ_MARGIN rows and columns inside their memory. */
typedef struct asj_frame {
    int32_t width, height;
    int32_t blocks;               /* runs of ASJ_LANES pixels in a row */
    ptrdiff_t stride;             /* elements from row to row of gray, gx, gy */
    uint16_t *gray;               /* ASJ_GRAY_BORDER columns and rows around the image repeat its border */
    int16_t *gradient_x;          /* normalised gradient in 1/1024 units, zero in the margin */
    int16_t *gradient_y;
    int16_t *memory;              /* what the three planes stand in */
    size_t capacity;              /* elements of it */
    size_t loaded;                /* behind so many stands the grey plane that asj_frame_load() has filled last; 0 = no more, */
    int32_t loaded_width, loaded_height, loaded_plane; /* and what it is */
    double octave;                /* how often the image was halved to make it, 1/2 by sqrt 2; -1 = it was upsampled by two */
    int32_t octaves;              /* that share the false alarms allowed: 1, or more (octaves.c) */
    void *rows;                   /* scratch of asj_gradient() */
    size_t row_capacity;
} asj_frame;

/* Checks a view: ASJ_OK, or the status and message that asj_detect() documents. Does not look at the pixels. */
asj_status asj_image_check(asj_context *context, const asj_image *image);

/* Makes room for an image of this size; keeps the memory when it is large enough. */
asj_status asj_frame_prepare(asj_context *context, asj_frame *frame, int32_t width, int32_t height);

/* Bytes that takes. */
size_t asj_frame_bytes(int32_t width, int32_t height);
/* The same for gray levels alone: the gradient must not be read. */
asj_status asj_frame_prepare_gray(asj_context *context, asj_frame *frame, int32_t width, int32_t height);
void asj_frame_free(asj_memory *memory, asj_frame *frame);

/* 8-bit colour to luma (shared/pixels.h), grey levels. `step` bytes from pixel to pixel,
 * red at byte 0 or 2, blue at the other, green between them. */
void asj_image_luma(const uint8_t *pixels, int32_t width, int32_t step, int32_t red, uint16_t *gray);

/* Operations (ops.h). */
typedef struct asj_image_ops {
    void (*luma)(const uint8_t *pixels, int32_t width, int32_t step, int32_t red, uint16_t *gray); /* asj_image_luma() */
} asj_image_ops;
extern const asj_image_ops asj_image_reference;

/* `width` means of 2 x 2 pixels of two rows. */
void asj_halve_row(const uint16_t *upper, const uint16_t *lower, int32_t width, uint16_t *to);

/* Halves the grey plane in place: means of 2 x 2 pixels, an odd last column or row left out; gradient planes are to be filled
 * anew. */
asj_status asj_frame_halve(asj_context *context, asj_frame *frame);

/* A grey plane, of a frame or put by (half_octave.c). */
typedef struct asj_gray_plane {
    uint16_t *levels; /* row y at [y * stride] */
    ptrdiff_t stride;
    int32_t width, height;
    double octave;
} asj_gray_plane;

asj_gray_plane asj_frame_gray(const asj_frame *frame);
/* Puts the frame's grey plane by. The caller releases copy->levels. ASJ_ERROR_MEMORY. */
asj_status asj_gray_plane_keep(asj_context *context, const asj_frame *frame, asj_gray_plane *copy);
/* Makes the frame that of a plane made 1 / sqrt 2 as large, and of one halved: in place, if the plane is its own and
 * asj_frame_shrinks_in_place(). ASJ_ERROR_MEMORY. */
asj_status asj_frame_shrink(asj_context *context, asj_frame *frame, const asj_gray_plane *from);
asj_status asj_frame_halve_plane(asj_context *context, asj_frame *frame, const asj_gray_plane *from);
int32_t asj_frame_shrinks_in_place(const asj_frame *frame);

#define ASJ_SQRT2 1.4142135623730951

/* Whether a view that asj_image_check() has passed may be upsampled by two: ASJ_ERROR_LIMIT where images are not that large. */
asj_status asj_upsample_check(asj_context *context, const asj_image *image);

/* Repeats the border of gray. */
void asj_frame_repeat_border(const asj_frame *frame);

/* Makes room for the image upsampled by two and fills frame->gray with a plane of the view: interpolated between the four pixels
 * around, so that pixel (i, j) is centred at (i / 2 - 1/4, j / 2 - 1/4) of the image. Becomes octave -1. Statuses as
 * asj_frame_load(). */
asj_status asj_frame_upsample(asj_context *context, asj_frame *frame, const asj_image *image, int32_t plane);

/* Makes room for the image at another size, at least .75 of its own in both directions, and fills frame->gray with a plane of it
 * (resized.c). The frame's octaves stay what they are. Statuses as asj_frame_load(). */
asj_status asj_frame_load_resized(asj_context *context, asj_frame *frame, const asj_image *image, int32_t plane, int32_t width,
                                  int32_t height);

/* Fills frame->gray with a plane of the view, ASJ_PLANE_... (asj_frame_prepare() first). Finds NaN and infinity. */
asj_status asj_frame_load(asj_context *context, asj_frame *frame, const asj_image *image, int32_t plane);
/* Back to that plane, where it is of this size and nothing has been put over it since: coarser octaves stand before it. 0 = it has
 * to be loaded again. The gradient must not be read. */
int asj_frame_recall(asj_frame *frame, int32_t width, int32_t height, int32_t plane);

#endif
