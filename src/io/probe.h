/* SPDX-License-Identifier: BSD-2-Clause */
/* What the head of an image file says, and the probes of the formats that have files of their own. */
#ifndef ASJ_IO_PROBE_H
#define ASJ_IO_PROBE_H

#include "input.h"

typedef enum asj_image_kind {
    ASJ_KIND_UNKNOWN = 0, /* no image format that is known here */
    ASJ_KIND_PNG,
    ASJ_KIND_JPEG,
    ASJ_KIND_TIFF,        /* BigTIFF too */
    ASJ_KIND_WEBP,
    ASJ_KIND_JPEG2000,
    ASJ_KIND_PNM,
    ASJ_KIND_BMP,
    ASJ_KIND_SUN_RASTER,
    ASJ_KIND_RADIANCE,
    ASJ_KIND_HEIF,        /* AVIF too */
    ASJ_KIND_OTHER        /* known by name only */
} asj_image_kind;

typedef struct asj_image_probe {
    asj_image_kind kind;
    const char *name;       /* "JPEG", ... */
    uint64_t width, height; /* as declared; has_size = 0: the header does not say, or says nonsense */
    int32_t has_size;
    int32_t orientation;    /* EXIF; 1 when there is none */
    const unsigned char *exif; /* JPEG, WebP: the EXIF block in the file's bytes, or NULL */
    size_t exif_size;
    int32_t is_truncated;   /* the file ends before the image does */
    int32_t has_more;       /* JPEG, PNM: asj_image_file */
    const char *fault;      /* what else is wrong with the file's structure, or NULL */
    size_t codestream;      /* JPEG 2000: where it begins */
    int32_t is_ycc;         /* JPEG 2000: the file says that its colours are sYCC */
} asj_image_probe;

/* Size, orientation, truncation, fault; asj_probe_heif() also the kind and the name, as it begins like a film. */
void asj_probe_jpeg(const asj_input *input, asj_image_probe *probe);
void asj_probe_heif(const asj_input *input, asj_image_probe *probe);
void asj_probe_jpeg2000(const asj_input *input, asj_image_probe *probe);
void asj_probe_pnm(const asj_input *input, asj_image_probe *probe);
void asj_probe_tiff(const asj_input *input, asj_image_probe *probe);

/* Whether a PNM picture begins so: 'P', which kind, a blank. */
int asj_pnm_begins(const unsigned char *bytes, size_t size);

#endif
