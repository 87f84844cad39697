/* SPDX-License-Identifier: BSD-2-Clause */
/* EXIF orientation: how a camera was held. */
#ifndef ASJ_IO_EXIF_H
#define ASJ_IO_EXIF_H

#include <asj/image.h>

/* The orientation in an EXIF block, which is a small TIFF file: tag 0x0112 of its first directory. 1 ("upright as stored") when
 * the block has none or is damaged: EXIF describes the picture, and a picture with a bad description is still a picture. */
int32_t asj_exif_orientation(const unsigned char *block, size_t size);

/* A value of the first directory of a TIFF or BigTIFF file that is one number; 0 when it is not there. */
int32_t asj_tiff_value(const unsigned char *block, size_t size, unsigned tag, uint32_t *value);

/* Whether the index of a multi-picture file (CIPA DC-007), a small TIFF file too, names a further view of the scene: of a stereo
 * pair, of a panorama. Previews, and what belongs to the picture without being one (gain maps of HDR), are none. */
int32_t asj_mpf_has_views(const unsigned char *block, size_t size);

/* Copies width x height pixels of `pixel_size` bytes, rows `stride` bytes apart, so that the copy is upright. The copy has no gaps
 * between rows; for orientations 5 to 8 it is height pixels wide and width pixels high. */
void asj_turn_upright(unsigned char *copy, const unsigned char *pixels, ptrdiff_t stride, int32_t width, int32_t height,
                      size_t pixel_size, int32_t orientation);

#endif
