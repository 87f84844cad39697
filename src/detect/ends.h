/* SPDX-License-Identifier: BSD-2-Clause */
/* After step 5: branches that end near a junction end at it. */
#ifndef ASJ_SRC_ENDS_H
#define ASJ_SRC_ENDS_H

#include "junction_grid.h"

#include <asj/options.h>

typedef struct asj_ends {
    const asj_junction_grid *grid; /* of the hypotheses */
    const asj_detect_options *options;
    asj_hypothesis *hypotheses;
} asj_ends;

/* Both look at all hypotheses, but for lengths and ends of branches, and change those of one: several may go on at once. */

/* Marks the branches that have a junction on their line within 4 px, or snap_distance if that is more, of their end; what is at the
 * others is still to be seen. */
void asj_ends_mark(const asj_ends *ends, size_t index);

/* Moves the ends of branches onto junctions that lie on their line within snap_distance of the end, or somewhat farther (ends.c),
 * and tells which end at one. With independent_octaves junctions of other octaves are none. */
void asj_ends_snap(const asj_ends *ends, size_t index);

#endif
