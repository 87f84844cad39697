/* SPDX-License-Identifier: BSD-2-Clause */
/* Words for the ends of branches, and what an edge must be like. */
#include "junction_graph.h"

#include <math.h>
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

int asj_is_sound_edge(const asj_junction *junctions, size_t count, const asj_edge *edge)
{
    return edge->junction_a < edge->junction_b && edge->junction_b < count &&
           edge->branch_a < junctions[edge->junction_a].branch_count && edge->branch_b < junctions[edge->junction_b].branch_count &&
           isfinite(edge->log10_nfa);
}
