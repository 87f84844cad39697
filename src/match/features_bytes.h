/* SPDX-License-Identifier: BSD-2-Clause */
/* Features as bytes: what .asjf files hold (asj-formats(5)).
 *
 *      0  8 bytes        0x89 A S J F CR LF 0x1a: tells a file that was sent as text
 *      8  u32            version of the format: 1; 1 more where there are colours; 2 more where there are junctions of octave -1,
 *                        and 4 more where these have colours; 8 more where the image at half its size is there
 *     12  u32            CRC-32 of all that follows
 *     16  u64            size of the whole
 *     24  u32, u32       width and height of the image, px
 *     32  u32            bytes of the options' text
 *     36  u32            number of junctions
 *     40  text           options: a line KEY=VALUE for each
 *         junctions      x, y, scale, log10_nfa, location_sd: five floats; u32 number of branches; i32 octave; for each branch
 *                        angle, length, strength, log10_nfa, angle_sd, width, length_sd: seven floats; u32 end
 *         u16            the image after the blur, with junctions of octave -1 before it, in 1/128 of a grey level, row by row
 *         u16            if any: the colours of each L-junction of octave 0 and up, red, green and blue of six regions (colour.h)
 *         u16            if any: the colours of each L-junction, as the upsampled image has them
 *         u8             if any: red, then green, then blue of the image at half its size (colour_patch.h), row by row
 *
 * All numbers with the least significant byte first, floats as IEEE 754.
 *
 * Only what cannot be computed is there: L-junctions, neighbours, frames, patches and the coarser images are made again; the
 * patches alone would double the size. So there is no index that a hostile file could set, and what a file says is checked as
 * asj_match() checks what a caller says. */
#ifndef ASJ_SRC_FEATURES_BYTES_H
#define ASJ_SRC_FEATURES_BYTES_H

#include "colour.h"

#define ASJ_FEATURES_MAGIC "\x89" "ASJF\r\n\x1a"
#define ASJ_FEATURES_MAGIC_SIZE 8
#define ASJ_FEATURES_VERSION 1       /* and .. */
#define ASJ_FEATURES_COLOURS 1       /* .. so much more where there are colours of the L-junctions of the image itself, */
#define ASJ_FEATURES_UPSAMPLED 2         /* .. junctions of octave -1, */
#define ASJ_FEATURES_UPSAMPLED_COLOURS 4 /* .. and colours of all L-junctions for the upsampled image */
#define ASJ_FEATURES_PICTURE 8           /* and the image at half its size */
#define ASJ_FEATURES_COLOUR_BYTES (2 * 3 * ASJ_COLOUR_REGIONS)
#define ASJ_FEATURES_HEADER 40
#define ASJ_FEATURES_CHECKED 16      /* the checksum is of the bytes from here on */
#define ASJ_FEATURES_JUNCTION_BYTES 28
#define ASJ_FEATURES_BRANCH_BYTES 32
#define ASJ_FEATURES_LONGEST_LINE 256 /* of the options' text */

#endif
