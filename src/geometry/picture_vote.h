/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_PICTURE_VOTE_H
#define ASJ_SRC_GEOMETRY_PICTURE_VOTE_H

#include "model.h"

#include "core/pyramid.h"

#define ASJ_CELLS_ALONG 48 /* the longer side of image 1 */
#define ASJ_CELLS (ASJ_CELLS_ALONG * ASJ_CELLS_ALONG)

/* What the planes of a geometry say of image 1, cell by cell. */
typedef struct asj_seen_cell {
    double x2, y2;     /* where its middle is in image 2 */
    double difference; /* of brightness, after what differs between the images as a whole */
    int32_t seen;      /* 0: on no plane, or outside image 2 */
} asj_seen_cell;

/* A look at the pictures through one geometry. */
typedef struct asj_look {
    asj_seen_cell cells[ASJ_CELLS];
    double cell;               /* px: side of a cell */
    double grey[ASJ_CELLS][2]; /* logarithms of the mean grey levels in both images */
} asj_look;

/* Matches on one plane: candidates, and those around all of them. */
typedef struct asj_patch_of_plane {
    const asj_pair **list;
    int32_t count, corners;
    int32_t *hull;
} asj_patch_of_plane;

typedef struct asj_pictures {
    const asj_pyramid *of[2];
    asj_patch_of_plane planes[ASJ_MOST_PLANES];
    asj_look looks[2];
} asj_pictures;

/* NULL: no memory. */
asj_pictures *asj_pictures_create(asj_memory *memory, const asj_pyramid *const of[2], int32_t candidates);
void asj_pictures_free(asj_memory *memory, asj_pictures *pictures);

/* The look of a geometry, given the probability of each candidate under it. */
void asj_pictures_look(asj_pictures *pictures, const asj_pairs *set, const asj_two_view *view, const double *probability,
                       asj_look *look);

/* How much the pictures speak against the second look: above 1 they contradict it, 0 where they do not or nothing is known. */
double asj_pictures_against(const asj_look *first, const asj_look *second);

#endif
