/* SPDX-License-Identifier: BSD-2-Clause */
/* Pixels on their way from a decoder to the caller. */
#ifndef ASJ_IO_IMAGE_BUFFER_H
#define ASJ_IO_IMAGE_BUFFER_H

#include <asj/image.h>

#include "lens.h"
#include "probe.h"
#include "shared/pixels.h"

typedef struct asj_image_buffer {
    unsigned char *pixels; /* malloc; rows without gaps */
    int32_t width, height;
    int32_t format;        /* ASJ_FORMAT_... */
    int32_t orientation;   /* EXIF: how `pixels` are stored */
    int32_t has_more;      /* asj_image_file */
    asj_lens lens;         /* EXIF */
} asj_image_buffer;

/* ASJ_OK, or ASJ_ERROR_FORMAT for a side of 0, or ASJ_ERROR_LIMIT, for the size that a file declares. */
asj_status asj_check_declared_size(uint64_t width, uint64_t height, uint64_t max_pixels, const asj_message *message);

/* Memory for an image whose size is checked as above. ASJ_ERROR_MEMORY too. */
asj_status asj_image_allocate(asj_image_buffer *buffer, uint64_t width, uint64_t height, int32_t format, uint64_t max_pixels,
                              const asj_message *message);

/* Decodes a file's bytes. What is in buffer->pixels belongs to the caller, whatever happened.
 * ASJ_ERROR_FORMAT, ASJ_ERROR_LIMIT, ASJ_ERROR_UNSUPPORTED, ASJ_ERROR_MEMORY */
typedef asj_status asj_image_decoder(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels,
                                     asj_image_buffer *buffer, const asj_message *message);
asj_image_decoder asj_png_decode, asj_jpeg_decode, asj_webp_decode, asj_tiff_decode, asj_jpeg2000_decode, asj_pnm_decode;
asj_image_decoder asj_heif_decode, asj_opencv_decode; /* in processes of their own: decoder_process.h */

/* The decoder that the kind of file has in this build, or NULL. */
asj_image_decoder *asj_decoder_of(asj_image_kind kind);

#endif
