/* SPDX-License-Identifier: BSD-2-Clause */
/* CSV: one line for each branch, so that a spreadsheet can filter; the junction's own columns repeat. */
#include "junction_output.h"

#include "number.h"

#include <stdio.h>

static void write_line(asj_output *output, uint32_t index, const asj_junction *junction, int32_t b)
{
    const asj_branch *branch = &junction->branches[b];
    const float before[] = {junction->x, junction->y, junction->scale, junction->log10_nfa, junction->location_sd};
    const float after[] = {branch->angle, branch->length, branch->strength, branch->log10_nfa, branch->angle_sd,
                           branch->width};
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
    asj_output_text(output, "\n");
}

void asj_write_csv(asj_output *output, const asj_detection *detection)
{
    uint32_t i;
    int32_t b;

    asj_output_text(output,
                    "junction,x,y,scale,log10_nfa,location_sd,octave,branch,angle,length,strength,branch_log10_nfa,"
                    "angle_sd,width\n");
    for (i = 0; i < detection->junction_count; i++)
        for (b = 0; b < detection->junctions[i].branch_count; b++)
            write_line(output, i, &detection->junctions[i], b);
}
