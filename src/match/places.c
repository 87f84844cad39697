/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches by their place. See places.h. */
#include "places.h"
#include "core/sort.h"

#include <math.h>
#include <stddef.h>

#define BAND 32.0  /* px; most squares that are asked for are smaller */
#define MARGIN 1.0 /* px: more than rounding */

static int32_t band_of(double y)
{
    const double band = floor(y / BAND), most = 1e9; /* images end far before */
    return (int32_t)(band < -most ? -most : band > most ? most : band);
}

static int by_place(const void *left, const void *right)
{
    const asj_place *p = left, *q = right;
    if (p->band != q->band)
        return p->band < q->band ? -1 : 1;
    if (p->x < q->x || p->x > q->x)
        return p->x < q->x ? -1 : 1;
    return p->match < q->match ? -1 : p->match > q->match;
}

void asj_places_sort(asj_place *places, const asj_junction_match *matches, uint32_t count, int32_t side)
{
    for (uint32_t k = 0; k < count; k++)
        places[k] = side ? (asj_place){band_of((double)matches[k].y2), matches[k].x2, k}
                         : (asj_place){band_of((double)matches[k].y1), matches[k].x1, k};
    if (count > 1)
        asj_sort(places, count, sizeof *places, by_place);
}

/* The first place in the walk's band, or behind it, that is not left of the square. */
static uint32_t first_of_band(const asj_place_walk *w)
{
    uint32_t low = 0, high = w->count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        const asj_place *p = &w->places[middle];
        if (p->band < w->band || (p->band == w->band && (double)p->x < w->left))
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

asj_place_walk asj_places_near(const asj_place *places, uint32_t count, float x, float y, double radius)
{
    const double reach = radius + MARGIN;
    asj_place_walk walk = {places, count, 0, band_of((double)y - reach), band_of((double)y + reach),
                           (double)x - reach, (double)x + reach};
    walk.next = first_of_band(&walk);
    return walk;
}

int asj_places_next(asj_place_walk *w, uint32_t *match)
{
    while (w->band <= w->last_band) {
        const asj_place *p = w->next < w->count ? &w->places[w->next] : NULL;
        if (p && p->band == w->band && (double)p->x <= w->right) {
            *match = p->match;
            w->next++;
            return 1;
        }
        w->band++;
        w->next = first_of_band(w);
    }
    return 0;
}
