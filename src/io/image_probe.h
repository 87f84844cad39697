/* SPDX-License-Identifier: BSD-2-Clause */
/* What the first bytes of an image file say, before any decoder is trusted with it. */
#ifndef ASJ_IO_IMAGE_PROBE_H
#define ASJ_IO_IMAGE_PROBE_H

#include "input.h"

typedef struct asj_image_probe {
    const char *name;       /* "JPEG", ...; NULL = no image format that is known here */
    uint64_t width, height; /* as declared; has_size = 0: not known before decoding */
    int32_t has_size;
    int32_t orientation;    /* EXIF; 1 when there is none */
    int32_t is_tiff;        /* TIFF: the orientation stands in the file's own directory */
    int32_t is_truncated;   /* the file ends before the image does */
    int32_t is_uncommon;    /* the usual OpenCV has no decoder for it */
    int32_t needs_path;     /* OpenCV decodes it from a named file only, not from memory */
} asj_image_probe;

void asj_probe_image(const asj_input *input, asj_image_probe *probe);

/* JPEG has a file of its own: fills in size, orientation and truncation. */
void asj_probe_jpeg(const asj_input *input, asj_image_probe *probe);

#endif
