/* SPDX-License-Identifier: BSD-2-Clause */
/* Ends of branches and edges between junctions, as files have them. */
#ifndef ASJ_IO_JUNCTION_GRAPH_H
#define ASJ_IO_JUNCTION_GRAPH_H

#include <asj/junction.h>

#include <stddef.h>

/* The word for ASJ_BRANCH_END_...; NULL for unknown ends, which files leave out, and for what is none. */
const char *asj_end_word(int32_t end);

/* Its number, or -1. */
int32_t asj_end_of_word(const char *word);

/* Whether an edge joins branches of two junctions that there are, the first before the second. */
int asj_is_sound_edge(const asj_junction *junctions, size_t count, const asj_edge *edge);

#endif
