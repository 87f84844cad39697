/* SPDX-License-Identifier: BSD-2-Clause */
/* After step 5: branches that end near a junction end at it. */
#ifndef ASJ_SRC_ENDS_H
#define ASJ_SRC_ENDS_H

#include "core/watch.h"
#include "hypothesis.h"

#include <asj/options.h>

/* Marks the branches that asj_ends_snap() would find a junction at the end of; what is at the others is still to be seen. */
void asj_ends_mark(asj_hypothesis *hypotheses, size_t count, double reach, const asj_hypothesis **order, asj_watch *watch);

/* Moves the ends of branches onto junctions that lie on their line within snap_distance of the end, or somewhat farther (ends.c),
 * and tells which end at one. With octave_union junctions of other octaves are none. Both: `order` is scratch for `count` elements;
 * they leave off when the watch stops; NULL = none. */
void asj_ends_snap(asj_hypothesis *hypotheses, size_t count, const asj_detect_options *options, const asj_hypothesis **order,
                   asj_watch *watch);

#endif
