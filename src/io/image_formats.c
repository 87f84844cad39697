/* SPDX-License-Identifier: BSD-2-Clause */
/* Which decoder reads which kind of file: decided by the probe, never by a decoder. */
#include <asj/io.h>

#include "image_buffer.h"

#ifdef ASJ_IO_HAVE_JPEG
#define JPEG asj_jpeg_decode
#define JPEG_NAME ", JPEG"
#else
#define JPEG NULL
#define JPEG_NAME ""
#endif
#ifdef ASJ_IO_HAVE_TIFF
#define TIFF asj_tiff_decode
#define TIFF_NAME ", TIFF"
#else
#define TIFF NULL
#define TIFF_NAME ""
#endif
#ifdef ASJ_IO_HAVE_WEBP
#define WEBP asj_webp_decode
#define WEBP_NAME ", WebP"
#else
#define WEBP NULL
#define WEBP_NAME ""
#endif
#ifdef ASJ_IO_HAVE_JPEG2000
#define JPEG2000 asj_jpeg2000_decode
#define JPEG2000_NAME ", JPEG 2000"
#else
#define JPEG2000 NULL
#define JPEG2000_NAME ""
#endif
#ifdef ASJ_IO_HAVE_HEIF
#define HEIF asj_heif_decode
#define HEIF_NAMES ", HEIF, AVIF"
#else
#define HEIF NULL
#define HEIF_NAMES ""
#endif
#ifdef ASJ_IO_HAVE_OPENCV
#define OPENCV asj_opencv_decode
#define OPENCV_NAMES ", BMP, Sun raster, Radiance HDR"
#else
#define OPENCV NULL
#define OPENCV_NAMES ""
#endif

asj_image_decoder *asj_decoder_of(asj_image_kind kind)
{
    switch (kind) {
    case ASJ_KIND_PNG: return asj_png_decode;
    case ASJ_KIND_PNM: return asj_pnm_decode;
    case ASJ_KIND_JPEG: return JPEG;
    case ASJ_KIND_TIFF: return TIFF;
    case ASJ_KIND_WEBP: return WEBP;
    case ASJ_KIND_JPEG2000: return JPEG2000;
    case ASJ_KIND_HEIF: return HEIF;
    case ASJ_KIND_BMP:
    case ASJ_KIND_SUN_RASTER:
    case ASJ_KIND_RADIANCE: return OPENCV;
    default: return NULL;
    }
}

const char *asj_io_image_formats(void)
{
    return "PNG, PNM" JPEG_NAME TIFF_NAME WEBP_NAME JPEG2000_NAME HEIF_NAMES OPENCV_NAMES;
}
