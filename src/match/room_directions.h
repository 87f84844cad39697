/* SPDX-License-Identifier: BSD-2-Clause */
/* The directions of the room that an image shows. */
#ifndef ASJ_SRC_MATCH_ROOM_DIRECTIONS_H
#define ASJ_SRC_MATCH_ROOM_DIRECTIONS_H

#include "geometry/directions.h"
#include "image_features.h"

/* The straight edges of the picture; edges->list is to be released. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED: nothing is held then. */
asj_status asj_room_edges(asj_context *context, const asj_pyramid *pyramid, asj_edge_list *edges);

/* Sets of three directions at right angles: those of line segments, the surest first, then that of the branches. count 0 when there
 * are none. */
asj_status asj_room_directions(asj_context *context, const asj_image_features *image, const asj_camera *camera,
                               asj_directions_list *found);

#endif
