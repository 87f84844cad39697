/* SPDX-License-Identifier: BSD-2-Clause */
/* The k nearest of many points, found one after the other. */
#ifndef ASJ_SRC_NEAREST_H
#define ASJ_SRC_NEAREST_H

#include <stdint.h>

#define ASJ_NEAREST_MOST 64 /* the largest k: that of options neighbours and verify_neighbours */

/* Nearest first, ties by index. Start with count 0. */
typedef struct asj_nearest {
    uint32_t count, limit;              /* 1 <= limit <= ASJ_NEAREST_MOST */
    uint32_t *index;                    /* room for `limit` */
    double square[ASJ_NEAREST_MOST];    /* px^2: of their distances */
} asj_nearest;

/* Is the list full, and this point farther than all of it? */
static inline int32_t asj_nearest_beyond(const asj_nearest *list, double square)
{
    return list->count == list->limit && square > list->square[list->limit - 1];
}

/* For asj_nearest_offer() only. */
void asj_nearest_insert(asj_nearest *list, uint32_t index, double square);

/* Takes a point unless `limit` nearer ones are there; the order in which points come does not matter. */
static inline void asj_nearest_offer(asj_nearest *list, uint32_t index, double square)
{
    if (!asj_nearest_beyond(list, square))
        asj_nearest_insert(list, index, square);
}

#endif
