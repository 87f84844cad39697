/* SPDX-License-Identifier: BSD-2-Clause */
/* EXIF: through what lens a picture was taken. */
#ifndef ASJ_IO_LENS_H
#define ASJ_IO_LENS_H

#include <stddef.h>
#include <stdint.h>

/* What EXIF says of the focal length. 0 = nothing. */
typedef struct asj_lens {
    double film_mm;       /* focal length that shows as much on 35 mm film: FocalLengthIn35mmFilm */
    double mm;            /* focal length: FocalLength */
    double per_unit;      /* px on the focal plane: FocalPlaneXResolution, each .. */
    int32_t unit;         /* FocalPlaneResolutionUnit: 2 = inch, 3 = cm, 4 = mm, 5 = um */
    int32_t is_damaged;   /* a part of the block could not be read */
    double width, height; /* px of the picture that all this was said of: PixelXDimension, PixelYDimension */
} asj_lens;

/* Reads an EXIF block, which is a small TIFF file. Damage is no error: a picture with a bad description is still a picture. */
void asj_exif_lens(const unsigned char *block, size_t size, asj_lens *lens);

/* The focal length in px of a picture of this size, either way up; 0 when it is not known. *source: ASJ_EXIF_FOCAL_... of io.h. */
double asj_lens_focal(const asj_lens *lens, int32_t width, int32_t height, int32_t *source);

#endif
