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

/* What may be wrong with edges. */
typedef enum asj_edge_fault {
    ASJ_EDGES_SOUND = 0,
    ASJ_EDGE_OF_NOTHING,  /* it does not join branches of two junctions that there are, the first before the second */
    ASJ_EDGE_OF_AN_OTHER, /* one of its branches is part of an edge before */
    ASJ_EDGES_NO_MEMORY
} asj_edge_fault;

/* The first fault, and the edge that has it. */
asj_edge_fault asj_find_edge_fault(const asj_junction *junctions, size_t count, const asj_edge *edges, size_t edge_count,
                                   size_t *which);

#endif
