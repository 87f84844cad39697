/* SPDX-License-Identifier: BSD-2-Clause */
/* The graph: which branches of two junctions are one edge. */
#ifndef ASJ_SRC_EDGES_H
#define ASJ_SRC_EDGES_H

#include "edge_evidence.h"
#include "junction_grid.h"
#include "core/watch.h"

/* Junctions that are to be joined. */
typedef struct asj_edge_search {
    asj_watch *watch;
    const asj_detect_options *options;
    int32_t width, height;         /* px of the image */
    int32_t octaves;               /* as in asj_strip_log_tests() */
    const asj_evidence *evidence;  /* what branches name */
    const asj_junction_grid *grid; /* of these junctions */
    asj_hypothesis *hypotheses;    /* all in pixels of the image */
    size_t count;
    int32_t *scratch;              /* asj_edges_scratch() elements */
} asj_edge_search;

/* Branches that turn out to end at the other junction are marked so. Writes the edges in order of junction_a, branch_a and returns
 * how many there are, half the number of branches at most, 0 when the caller stopped it. */
size_t asj_edges_join(const asj_edge_search *search, asj_edge *edges);
size_t asj_edges_scratch(size_t count);

#endif
