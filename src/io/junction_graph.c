/* SPDX-License-Identifier: BSD-2-Clause */
/* Words for the ends of branches, and what an edge must be like. */
#include "junction_graph.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char *const words[] = {NULL, "junction", "crossing", "faded", "occlusion", "border"};
enum { WORDS = sizeof words / sizeof words[0] };

const char *asj_end_word(int32_t end)
{
    return end >= 0 && end < WORDS ? words[end] : NULL;
}

int32_t asj_end_of_word(const char *word)
{
    int32_t i;
    for (i = 1; i < WORDS; i++)
        if (!strcmp(words[i], word))
            return i;
    return -1;
}

static int is_sound(const asj_junction *junctions, size_t count, const asj_edge *edge)
{
    return edge->junction_a < edge->junction_b && edge->junction_b < count &&
           edge->branch_a < junctions[edge->junction_a].branch_count && edge->branch_b < junctions[edge->junction_b].branch_count &&
           isfinite(edge->log10_nfa);
}

/* Marks a branch as taken; 0 when it was taken before. */
static int take(unsigned char *taken, uint32_t junction, uint16_t branch)
{
    unsigned char bit = (unsigned char)(1u << branch);
    int was_free = !(taken[junction] & bit);
    taken[junction] |= bit;
    return was_free;
}

asj_edge_fault asj_find_edge_fault(const asj_junction *junctions, size_t count, const asj_edge *edges, size_t edge_count,
                                   size_t *which)
{
    asj_edge_fault fault = ASJ_EDGES_SOUND;
    unsigned char *taken = edge_count ? calloc(count ? count : 1, 1) : NULL;
    size_t i;
    *which = 0;
    if (edge_count && !taken)
        return ASJ_EDGES_NO_MEMORY;
    for (i = 0; i < edge_count && fault == ASJ_EDGES_SOUND; i++) {
        const asj_edge *e = &edges[i];
        *which = i;
        if (!is_sound(junctions, count, e))
            fault = ASJ_EDGE_OF_NOTHING;
        else if (!take(taken, e->junction_a, e->branch_a) || !take(taken, e->junction_b, e->branch_b))
            fault = ASJ_EDGE_OF_AN_OTHER;
    }
    free(taken);
    return fault;
}
