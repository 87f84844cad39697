/* SPDX-License-Identifier: BSD-2-Clause */
/* The directions of the room that an image shows. */
#ifndef ASJ_SRC_MATCH_ROOM_DIRECTIONS_H
#define ASJ_SRC_MATCH_ROOM_DIRECTIONS_H

#include "geometry/directions.h"
#include "image_features.h"

/* Sets of three directions at right angles: those of line segments, the surest first, then that of the branches. count 0 when there
 * are none. */
asj_status asj_room_directions(asj_context *context, const asj_image_features *image, const asj_camera *camera,
                               asj_directions_list *found);

#endif
