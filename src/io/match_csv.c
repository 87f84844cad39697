/* SPDX-License-Identifier: BSD-2-Clause */
/* CSV: one line for each match, or for each line segment, whose location is left empty. */
#include "match_output.h"

#include "number.h"

#include <stdio.h>

static void put_indices(asj_output *output, const asj_junction_match *m)
{
    char text[64];
    snprintf(text, sizeof text, "%lu,%lu", (unsigned long)m->l1, (unsigned long)m->l2);
    asj_output_text(output, text);
}

static void put_floats(asj_output *output, const float *values, size_t count)
{
    char number[ASJ_NUMBER_SIZE];
    size_t i;
    for (i = 0; i < count; i++) {
        asj_output_text(output, ",");
        asj_output_text(output, asj_number_float(number, values[i]));
    }
}

static void put_quality(asj_output *output, const asj_junction_match *m)
{
    const float values[] = {m->distance, m->ratio};
    char number[ASJ_NUMBER_SIZE];
    size_t i;
    put_floats(output, values, 2);
    for (i = 0; i < 6; i++) {
        asj_output_text(output, ",");
        asj_output_text(output, asj_number_nine(number, m->affine[i]));
    }
    asj_output_text(output, "\n");
}

static void put_match(asj_output *output, const asj_junction_match *m)
{
    const float places[] = {m->x1, m->y1, m->ax1, m->ay1, m->bx1, m->by1, m->x2, m->y2, m->ax2, m->ay2, m->bx2, m->by2};
    put_indices(output, m);
    put_floats(output, places, sizeof places / sizeof places[0]);
    put_quality(output, m);
}

static void put_segment(asj_output *output, const asj_segment_match *s, const asj_junction_match *m)
{
    const float first[] = {s->x1, s->y1, s->ex1, s->ey1}, second[] = {s->x2, s->y2, s->ex2, s->ey2};
    put_indices(output, m);
    asj_output_text(output, ",,");
    put_floats(output, first, 4);
    asj_output_text(output, ",,");
    put_floats(output, second, 4);
    put_quality(output, m);
}

void asj_write_match_csv(asj_output *output, const asj_match_report *report, const asj_match_lines *segments)
{
    const asj_match_result *result = report->result;
    size_t i;

    asj_output_text(output, "i,j,x1,y1,ax1,ay1,bx1,by1,x2,y2,ax2,ay2,bx2,by2,distance,ratio,h11,h12,h13,h21,h22,h23\n");
    for (i = 0; i < segments->count; i++)
        put_segment(output, &segments->list[i], &result->matches[segments->list[i].match]);
    for (i = 0; i < result->match_count && !report->lines; i++)
        put_match(output, &result->matches[i]);
}
