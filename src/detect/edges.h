/* SPDX-License-Identifier: BSD-2-Clause */
/* The graph: which branches of two junctions are one edge. */
#ifndef ASJ_SRC_EDGES_H
#define ASJ_SRC_EDGES_H

#include "edge_evidence.h"
#include "junction_grid.h"
#include "core/watch.h"

/* Joins junctions, all in pixels of an image of width x height, with the evidence that their branches name; `octaves` as in
 * asj_strip_log_tests(). Branches that turn out to end at the other junction are marked so. Writes the edges in order of
 * junction_a, branch_a and returns how many there are, half the number of branches at most, 0 when the caller stopped it. `grid`:
 * of these junctions. `scratch`: asj_edges_scratch() elements. */
size_t asj_edges_join(asj_watch *watch, const asj_detect_options *options, int32_t width, int32_t height, int32_t octaves,
                      const asj_evidence *evidence, const asj_junction_grid *grid, asj_hypothesis *hypotheses, size_t count,
                      int32_t *scratch, asj_edge *edges);
size_t asj_edges_scratch(size_t count);

#endif
