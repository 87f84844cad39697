/* SPDX-License-Identifier: BSD-2-Clause */
/* The directions of the room that an image shows. */
#ifndef ASJ_SRC_MATCH_ROOM_DIRECTIONS_H
#define ASJ_SRC_MATCH_ROOM_DIRECTIONS_H

#include "geometry/directions.h"
#include "image_features.h"

/* The straight edges of one or two pictures; the lists are to be released. ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED: nothing is held
 * then. */
asj_status asj_room_edges(asj_context *context, const asj_pyramid *const pyramids[], int32_t count, asj_edge_list *edges);

/* Of each of two images sets of three directions at right angles: those of line segments, the surest first, then that of the
 * branches. count 0 when there are none. */
asj_status asj_room_directions(asj_context *context, const asj_image_features *const images[2], const asj_camera cameras[2],
                               asj_directions_list found[2]);

#endif
