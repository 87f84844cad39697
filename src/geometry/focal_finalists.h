/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_FOCAL_FINALISTS_H
#define ASJ_SRC_GEOMETRY_FOCAL_FINALISTS_H

#include "estimation.h"

/* One focal length for both images, in place of cameras or near theirs: adds what is found with it to the finalists, of which the
 * homographies are where it starts. hints may be NULL. ASJ_ERROR_MEMORY. */
asj_status asj_find_focal_finalists(asj_estimation *e, const asj_geometry_hints *hints);

#endif
