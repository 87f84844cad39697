/* SPDX-License-Identifier: BSD-2-Clause */
/* .asj text, as the program of the paper's authors writes it:
 *
 *     N                        number of records
 *     x y                      px; then for each record
 *     M scale r_d log10_nfa    number of branches, isotropic scale in px, smallest radius in px, log10 NFA of the junction
 *     theta strength length    rad, standard deviations, px: M lines
 *
 * Their records are L-junctions, M = 2, with branches in the order a, b: a junction of three branches gives three records. r_d is
 * the radius where their branch scan begins; ours has no such number, so the scale stands there again, and readers pass it over. */
#include "junction_output.h"

#include "number.h"

#include <stdio.h>

static void write_head(asj_output *output, const asj_junction *junction, int branch_count)
{
    char x[ASJ_NUMBER_SIZE], y[ASJ_NUMBER_SIZE], scale[ASJ_NUMBER_SIZE], nfa[ASJ_NUMBER_SIZE], line[5 * ASJ_NUMBER_SIZE];
    asj_number_float(scale, junction->scale); /* a whole number of pixels is written as one */
    snprintf(line, sizeof line, "%s %s\n%d %s %s %s\n", asj_number_fixed(x, junction->x), asj_number_fixed(y, junction->y),
             branch_count, scale, scale, asj_number_fixed(nfa, junction->log10_nfa));
    asj_output_text(output, line);
}

static void write_branch(asj_output *output, const asj_branch *branch)
{
    char angle[ASJ_NUMBER_SIZE], strength[ASJ_NUMBER_SIZE], length[ASJ_NUMBER_SIZE], line[4 * ASJ_NUMBER_SIZE];
    snprintf(line, sizeof line, "%s %s %s\n", asj_number_fixed(angle, branch->angle),
             asj_number_fixed(strength, branch->strength), asj_number_fixed(length, branch->length));
    asj_output_text(output, line);
}

void asj_write_text(asj_output *output, const asj_detection *detection, int whole)
{
    char count[32];
    uint32_t i;
    int32_t b;

    snprintf(count, sizeof count, "%lu\n", (unsigned long)(whole ? detection->junction_count : detection->l_junction_count));
    asj_output_text(output, count);
    for (i = 0; whole && i < detection->junction_count; i++) {
        const asj_junction *junction = &detection->junctions[i];
        write_head(output, junction, junction->branch_count);
        for (b = 0; b < junction->branch_count; b++)
            write_branch(output, &junction->branches[b]);
    }
    for (i = 0; !whole && i < detection->l_junction_count; i++) {
        const asj_l_junction *pair = &detection->l_junctions[i];
        const asj_junction *junction = &detection->junctions[pair->junction];
        write_head(output, junction, 2);
        write_branch(output, &junction->branches[pair->branch_a]);
        write_branch(output, &junction->branches[pair->branch_b]);
    }
}
