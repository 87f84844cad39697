/* SPDX-License-Identifier: BSD-2-Clause */
/* Which of the directions of a room an edge has. */
#ifndef ASJ_CLI_PLOT_DIRECTION_H
#define ASJ_CLI_PLOT_DIRECTION_H

#include <asj/vanishing.h>

/* The number of the vanishing point that an edge at (x, y), px, with the angle of a branch runs to; -1: none of them. */
int32_t cli_direction_of(const asj_vanishing_points *points, double x, double y, double angle);

/* Where vanishing point `number` lies, px. 0: so far away that it has no place. */
int32_t cli_vanishing_place(const asj_vanishing_points *points, int32_t number, double place[2]);

#endif
