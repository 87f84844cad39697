/* SPDX-License-Identifier: BSD-2-Clause */
/* Three directions of the scene at right angles to each other, from the straight edges of one image. */
#ifndef ASJ_SRC_GEOMETRY_DIRECTIONS_H
#define ASJ_SRC_GEOMETRY_DIRECTIONS_H

#include "candidates.h"
#include "vanishing_vote.h"
#include "core/memory.h"

/* Edges are not independent (both sides of a board; what is not quite at right angles): scores count by this. */
#define ASJ_SCORE_COOL 2.0

typedef struct asj_directions {
    double axes[9];       /* rows: directions in camera coordinates */
    double covariance[9]; /* rad^2: of w with exp([w]x) axis the true ones */
    double score;         /* log of likelihood with them over likelihood without any */
} asj_directions;

typedef struct asj_directions_list {
    asj_directions list[ASJ_MOST_DIRECTIONS];
    int32_t count;
} asj_directions_list;

/* The straight edges of an image, px of a level of its pyramid (core/pyramid.h) whose pixels are `scale` pixels of the image wide.
 * The list is its owner's. */
typedef struct asj_edge_list {
    asj_straight_edge *list;
    size_t count;
    double scale;
    double longer; /* side of the level, px */
} asj_edge_list;

/* The sets of directions that explain the edges best, the best first; count 0 when there are too few edges. camera: of the image,
 * px; `exact` says that it is known, so that right angles are as right as the edges say. 0: no memory. */
int32_t asj_find_directions(asj_memory *memory, const asj_edge_list *edges, const asj_camera *camera, int32_t exact,
                            asj_directions_list *found);

/* The same in the threads of a loop, each with scratch of its own for lists of at most `count` edges. NULL: no memory. */
typedef struct asj_directions_scratch asj_directions_scratch;
asj_directions_scratch *asj_directions_scratch_create(asj_memory *memory, size_t count);
void asj_directions_scratch_free(asj_memory *memory, asj_directions_scratch *scratch);
void asj_find_directions_with(asj_directions_scratch *scratch, const asj_edge_list *edges, const asj_camera *camera, int32_t exact,
                              asj_directions_list *found);

/* Adds one set of directions, unless it is there already but for their names, or there is no room. */
void asj_directions_add(asj_directions_list *found, const asj_directions *more);

#endif
