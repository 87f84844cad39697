/* SPDX-License-Identifier: BSD-2-Clause */
/* Options of the geometry, and what its status says. */
#ifndef ASJ_SRC_GEOMETRY_OPTIONS_H
#define ASJ_SRC_GEOMETRY_OPTIONS_H

#include "core/context.h"

#include <asj/geometry.h>

/* ASJ_ERROR_OPTION, with a message. The first without the sizes of the images, which the matcher fills in. */
asj_status asj_geometry_request_check(asj_context *context, const asj_geometry_options *options);
asj_status asj_geometry_options_check(asj_context *context, const asj_geometry_options *options);

/* Of a caller: not known, or within the ranges of asj_camera. */
int32_t asj_camera_can_be(const asj_camera *camera);
int32_t asj_camera_is_known(const asj_camera *camera);
int32_t asj_cameras_are_known(const asj_geometry_options *options); /* both, exactly or about */

/* Are homographies finalists? */
int32_t asj_asks_homographies(const asj_geometry_options *options);

/* One focal length is found with the motion: nothing is known of it, or the cameras' are about right. */
int32_t asj_finds_focal(const asj_geometry_options *options);

/* Rivals, or a motion that stays open: an answer, too. */
int32_t asj_geometry_is_open(const asj_geometry *geometry);

#endif
