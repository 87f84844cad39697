/* SPDX-License-Identifier: BSD-2-Clause */
/* The end of step 3: duplicates of isotropic junctions go. */
#ifndef ASJ_SRC_ISOTROPIC_THIN_H
#define ASJ_SRC_ISOTROPIC_THIN_H

#include "isotropic.h"

/* Of junctions in order of y, then x, drops those that lie close to something better (see isotropic_thin.c). Returns how many
 * stay, at the front, in the same order: what comes next then finds most of the image in the cache.
 * `scratch`: asj_isotropic_thin_scratch() bytes, aligned as by malloc(). */
size_t asj_isotropic_thin(asj_isotropic_junction *junctions, size_t count, const asj_detect_options *options,
                          int32_t width, int32_t height, void *scratch);
size_t asj_isotropic_thin_scratch(size_t count, int32_t width, int32_t height);

#endif
