/* SPDX-License-Identifier: BSD-2-Clause */
/* CSV: one line for each straight edge. */
#include "junction_graph.h"
#include "junction_output.h"

#include "number.h"

#include <stdio.h>

static void write_floats(asj_output *output, const float *values, size_t count)
{
    char number[ASJ_NUMBER_SIZE];
    size_t i;
    for (i = 0; i < count; i++) {
        asj_output_text(output, asj_number_float(number, values[i]));
        asj_output_text(output, ",");
    }
}

/* Empty when there is none. */
static void write_junction(asj_output *output, uint32_t junction)
{
    char text[32];
    snprintf(text, sizeof text, "%lu,", (unsigned long)junction);
    asj_output_text(output, junction == ASJ_NO_JUNCTION ? "," : text);
}

static void write_word(asj_output *output, int32_t end)
{
    asj_output_text(output, asj_end_word(end) ? asj_end_word(end) : "");
    asj_output_text(output, ",");
}

static void write_segment(asj_output *output, const asj_segment *s)
{
    const float places[] = {s->x1, s->y1, s->x2, s->y2, s->sd1, s->sd2};
    char text[64];
    write_floats(output, places, sizeof places / sizeof places[0]);
    write_word(output, s->end1);
    write_word(output, s->end2);
    write_junction(output, s->junction1);
    write_junction(output, s->junction2);
    write_floats(output, &s->log10_nfa, 1);
    snprintf(text, sizeof text, "%lu,%u,%u\n", (unsigned long)s->junction, (unsigned)s->branch, (unsigned)s->branch_count);
    asj_output_text(output, text);
}

void asj_write_segments_csv(asj_output *output, const asj_segment_list *list)
{
    uint32_t i;
    asj_output_text(output, "x1,y1,x2,y2,sd1,sd2,end1,end2,junction1,junction2,log10_nfa,junction,branch,branches\n");
    for (i = 0; i < list->count; i++)
        write_segment(output, &list->segments[i]);
}
