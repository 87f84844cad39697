/* SPDX-License-Identifier: BSD-2-Clause */
/* Vanishing points for the library itself. */
#ifndef ASJ_SRC_VANISHING_H
#define ASJ_SRC_VANISHING_H

#include "core/context.h"

#include <asj/vanishing.h>

/* asj_find_vanishing_points() of junctions and options that are sound; the camera may be one of an upsampled image, beyond what a
 * caller may give. The caller is asked on behalf of `stage`. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_vanishing_points_of(asj_context *context, const asj_junction *junctions, size_t count,
                                   const asj_vanishing_options *options, int32_t stage, asj_vanishing_points *result);

#endif
