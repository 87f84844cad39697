/* SPDX-License-Identifier: BSD-2-Clause */
/* What an image has at three sizes: junctions that two of them have. See sizes.c. */
#ifndef ASJ_SRC_SIZES_H
#define ASJ_SRC_SIZES_H

#include "octave_grid.h"

#define ASJ_SIZES 3
#define ASJ_SIZES_NEAR 3.0 /* px of the image between what two sizes have of one junction: see sizes.c */

/* Hypotheses of one size, in pixels of the image, the most meaningful first. */
typedef struct asj_size_found {
    asj_hypothesis *found;
    size_t count;
} asj_size_found;

/* Where copies are looked at. */
typedef struct asj_size_place {
    double x, y;   /* px of the image */
    double octave; /* of what is there */
} asj_size_place;

/* px of a side that has so many in the image, at size 0, 1, 2: as it is, smaller, larger. */
int32_t asj_size_px(int32_t px, int32_t size);

/* From pixels of a copy of width x height to those of an image of to_width x to_height, without what lies too far outside there. */
void asj_size_map(asj_size_found *list, int32_t width, int32_t height, int32_t to_width, int32_t to_height);

typedef struct asj_sizes {
    asj_size_found found[ASJ_SIZES];
    asj_octave_grid grids[ASJ_SIZES]; /* asj_sizes_mark() */
    int32_t count;                    /* that are done */
} asj_sizes;

/* How much all of them have found; elements of `cells` for that. */
size_t asj_sizes_total(const asj_sizes *sizes);
size_t asj_sizes_cells(const asj_sizes *sizes, int32_t width, int32_t height);

/* Puts what each has found into grids, which stand in `cells`. */
void asj_sizes_mark(asj_sizes *sizes, int32_t width, int32_t height, int32_t *cells);

/* Whether one of those that are done has something within `reach` px of the image. */
int asj_sizes_have(const asj_sizes *sizes, const asj_size_place *place, double reach);

/* Where one size of those that are done has something and the others have not, as many places as all have found at most. Returns
 * how many. */
size_t asj_sizes_disputed(const asj_sizes *sizes, asj_size_place *places);

/* What two sizes have, each once, from the first of them that has it. `to` has room for all lists, and `cells`, others than those
 * of the grids, asj_octave_grid_cells() for them. Returns how many. */
size_t asj_sizes_agreed(const asj_sizes *sizes, int32_t width, int32_t height, int32_t *cells, asj_hypothesis *to);

#endif
