/* SPDX-License-Identifier: BSD-2-Clause */
/* A part of an image on the command line: a rectangle, a mask. */
#ifndef ASJ_CLI_REGION_H
#define ASJ_CLI_REGION_H

#include "common.h"

#include <asj/detect.h>
#include <asj/io.h>

typedef struct cli_region {
    const char *mask;            /* a file; NULL = none */
    int32_t x, y, width, height; /* width 0 = the whole image */
} cli_region;

/* --NAME X,Y,WIDTH,HEIGHT. CLI_SUCCESS, or CLI_USAGE after saying why. */
int cli_region_take(const char *command, const char *name, const char *text, cli_region *region);

/* Reads the mask, if any, which the caller frees. CLI_SUCCESS, or CLI_FAILED after saying why: it cannot be read or is not 8-bit
 * gray. */
int cli_region_read_mask(cli_session *session, const cli_common *common, const cli_region *region,
                         asj_image_file **mask);

/* What asj_detect_region() takes for this image; `mask` as read, NULL for none. CLI_SUCCESS, or CLI_FAILED after saying why: a mask
 * of another size, a rectangle that leaves the image. */
int cli_region_of(cli_session *session, const cli_region *region, const asj_image_file *mask, const char *name,
                  const asj_image *image, asj_region *result);

#endif
