/* SPDX-License-Identifier: BSD-2-Clause */
/* What the planes of a geometry say of two pictures, cell by cell. */
#ifndef ASJ_SRC_GEOMETRY_PICTURE_LOOK_H
#define ASJ_SRC_GEOMETRY_PICTURE_LOOK_H

#include "model.h"
#include "picture.h"
#include "core/context.h"

#define ASJ_CELLS_ALONG 48 /* the longer side of image 1 */
#define ASJ_CELLS (ASJ_CELLS_ALONG * ASJ_CELLS_ALONG)

/* A difference of brightness is the absolute one of logarithms, the mean of that of all channels; smaller ones than this say
 * nothing. */
#define ASJ_LEAST_DIFFERENCE 0.02

typedef struct asj_seen_cell {
    double x2, y2;     /* where its middle is in image 2 */
    double difference; /* of brightness, after what differs between the images as a whole */
    int32_t plane;     /* that it lies on; -1: on none, or outside image 2, and nothing else is known */
    int32_t is_near;   /* a match of that plane */
} asj_seen_cell;

/* A look at the pictures through one geometry. */
typedef struct asj_picture_look {
    asj_seen_cell cells[ASJ_CELLS];
    double cell;                                       /* px: side of a cell */
    double brightness[ASJ_MOST_CHANNELS][ASJ_CELLS][2]; /* logarithms of the mean levels in both images, .. */
    double offset[ASJ_MOST_CHANNELS], slope[ASJ_MOST_CHANNELS]; /* .. the second of which are about so much of the first */
    int32_t channel_count;
} asj_picture_look;

/* Matches on one plane: candidates, and those around all of them. */
typedef struct asj_patch_of_plane {
    const asj_pair **list;
    int32_t count, corners;
    int32_t *hull;
} asj_patch_of_plane;

typedef struct asj_pictures {
    asj_picture of[2]; /* with as many channels as either */
    asj_patch_of_plane planes[ASJ_MOST_PLANES];
    asj_picture_look looks[2];
} asj_pictures;

/* NULL: no memory. */
asj_pictures *asj_pictures_create(asj_memory *memory, const asj_picture of[2], int32_t candidates);
void asj_pictures_free(asj_memory *memory, asj_pictures *pictures);

/* The look of a geometry, given the probability of each candidate under it. */
void asj_pictures_look(const asj_context *context, asj_pictures *pictures, const asj_pairs *set, const asj_two_view *view,
                       const double *probability, asj_picture_look *look);

#endif
