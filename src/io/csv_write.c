/* SPDX-License-Identifier: BSD-2-Clause */
/* CSV: one line for each branch, so that a spreadsheet can filter; the junction's own columns repeat. An edge stands in the lines
 * of both its branches, which name each other. */
#include "junction_graph.h"
#include "junction_output.h"

#include "number.h"

#include <stdio.h>
#include <stdlib.h>

/* The other end of an edge, and the edge, empty when there is none. */
static void write_edge(asj_output *output, const asj_edge *edge, int reversed)
{
    char text[64], number[ASJ_NUMBER_SIZE];
    if (!edge) {
        asj_output_text(output, ",,,\n");
        return;
    }
    snprintf(text, sizeof text, ",%lu,%u,", (unsigned long)(reversed ? edge->junction_a : edge->junction_b),
             (unsigned)(reversed ? edge->branch_a : edge->branch_b));
    asj_output_text(output, text);
    asj_output_text(output, asj_number_float(number, edge->log10_nfa));
    asj_output_text(output, "\n");
}

/* places[index * ASJ_MAX_BRANCHES + b]: number of the branch's edge, from 1; 0 = none. */
static void write_line(asj_output *output, const asj_detection *detection, uint32_t index, int32_t b, const uint32_t *places)
{
    const asj_junction *junction = &detection->junctions[index];
    const uint32_t place = places ? places[(size_t)index * ASJ_MAX_BRANCHES + (size_t)b] : 0;
    const asj_edge *edge = place ? &detection->edges[place - 1] : NULL;
    const asj_branch *branch = &junction->branches[b];
    const float before[] = {junction->x, junction->y, junction->scale, junction->log10_nfa, junction->location_sd};
    const float after[] = {branch->angle, branch->length, branch->strength, branch->log10_nfa, branch->angle_sd,
                           branch->width, branch->length_sd};
    char number[ASJ_NUMBER_SIZE];
    size_t i;

    snprintf(number, sizeof number, "%lu", (unsigned long)index);
    asj_output_text(output, number);
    for (i = 0; i < sizeof before / sizeof before[0]; i++) {
        asj_output_text(output, ",");
        asj_output_text(output, asj_number_float(number, before[i]));
    }
    snprintf(number, sizeof number, ",%d,%d", (int)junction->octave, (int)b);
    asj_output_text(output, number);
    for (i = 0; i < sizeof after / sizeof after[0]; i++) {
        asj_output_text(output, ",");
        asj_output_text(output, asj_number_float(number, after[i]));
    }
    asj_output_text(output, ",");
    asj_output_text(output, asj_end_word(branch->end) ? asj_end_word(branch->end) : "");
    write_edge(output, edge, edge && edge->junction_b == index);
}

/* NULL when there is no memory, or no edge. */
static uint32_t *place_edges(const asj_detection *detection)
{
    uint32_t *places = detection->edge_count ? calloc(detection->junction_count, ASJ_MAX_BRANCHES * sizeof *places) : NULL;
    uint32_t i;
    for (i = 0; places && i < detection->edge_count; i++) {
        const asj_edge *edge = &detection->edges[i];
        places[(size_t)edge->junction_a * ASJ_MAX_BRANCHES + edge->branch_a] = i + 1;
        places[(size_t)edge->junction_b * ASJ_MAX_BRANCHES + edge->branch_b] = i + 1;
    }
    return places;
}

asj_status asj_write_csv(asj_output *output, const asj_detection *detection, const asj_message *message)
{
    uint32_t *places = place_edges(detection);
    uint32_t i;
    int32_t b;

    if (detection->edge_count && !places)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for CSV");

    asj_output_text(output,
                    "junction,x,y,scale,log10_nfa,location_sd,octave,branch,angle,length,strength,branch_log10_nfa,"
                    "angle_sd,width,length_sd,end,to_junction,to_branch,edge_log10_nfa\n");
    for (i = 0; i < detection->junction_count; i++)
        for (b = 0; b < detection->junctions[i].branch_count; b++)
            write_line(output, detection, i, b, places);
    free(places);
    return ASJ_OK;
}
