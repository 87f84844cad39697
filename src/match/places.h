/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches by their place in one of the images, so that those near a point are found without looking at all. */
#ifndef ASJ_SRC_PLACES_H
#define ASJ_SRC_PLACES_H

#include <asj/match.h>

/* A match in its band of rows. */
typedef struct asj_place {
    int32_t band;
    float x; /* px */
    uint32_t match;
} asj_place;

/* Writes the place of each match in image 1 (side 0) or 2, by bands and by x in each. */
void asj_places_sort(asj_place *places, const asj_junction_match *matches, uint32_t count, int32_t side);

typedef struct asj_place_walk {
    const asj_place *places;
    uint32_t count, next;
    int32_t band, last_band;
    double left, right;
} asj_place_walk;

/* The matches in the square of half side `radius` (px) about (x, y), and some others around it: asj_places_next() sets *match to
 * each in turn and returns 0 when there is none left. */
asj_place_walk asj_places_near(const asj_place *places, uint32_t count, float x, float y, double radius);
int asj_places_next(asj_place_walk *walk, uint32_t *match);

#endif
