/* SPDX-License-Identifier: BSD-2-Clause */
/* The locations of L-junctions (l_junctions.h), and their neighbours. */
#ifndef ASJ_SRC_LOCATIONS_H
#define ASJ_SRC_LOCATIONS_H

#include "l_junctions.h"
#include "location_grid.h"

/* Sets everything of `all` from location to location_y, and home_locations. ASJ_ERROR_MEMORY. */
asj_status asj_locations_find(asj_context *context, asj_l_junctions *all);

/* Sets neighbour, neighbour_count and neighbour_limit; `grid` has all that may be a neighbour. ASJ_ERROR_MEMORY,
 * ASJ_ERROR_CANCELLED. */
asj_status asj_neighbours_find(asj_context *context, const asj_match_options *options, const asj_location_grid *grid,
                               asj_l_junctions *all);

/* The first location that is not left of x. */
uint32_t asj_first_location(const asj_l_junctions *all, double x);

#endif
