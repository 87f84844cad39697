/* SPDX-License-Identifier: BSD-2-Clause */
/* Junctions on their way from a file to the caller, and the rules that both readers share. */
#ifndef ASJ_IO_JUNCTION_LIST_H
#define ASJ_IO_JUNCTION_LIST_H

#include <asj/io.h>

#include "message.h"

/* Most junctions of a file. */
#define ASJ_JUNCTIONS_MAX (1u << 24)
#define ASJ_EDGES_MAX (5 * ASJ_JUNCTIONS_MAX / 2) /* no branch is part of two */

typedef struct asj_junction_list {
    asj_junction *junctions;
    uint32_t *lines;
    size_t count, capacity;
    asj_edge *edges;
    uint32_t *edge_lines;
    size_t edge_count, edge_capacity;
    int was_sorted; /* 1 = some junction's branches did not stand in order of angle */
    int32_t width, height;
} asj_junction_list;

/* Writes "path: line N: cause" and returns ASJ_ERROR_FORMAT. */
asj_status asj_line_fail(const asj_message *message, size_t line, const char *format, ...) ASJ_IO_PRINTF(3, 4);

/* 1 when the float nearest to a finite number is finite. */
int asj_fits_float(double value);

/* Sets the angle of a branch, brought into [0, 2 pi). */
void asj_set_angle(asj_branch *branch, double angle);

/* Checks the junction (asj_junction_check()), sorts the branches by angle and adds it.
 * ASJ_ERROR_FORMAT, ASJ_ERROR_LIMIT, ASJ_ERROR_MEMORY */
asj_status asj_junction_list_add(asj_junction_list *list, const asj_junction *junction, size_t line, const asj_message *message);

/* Adds an edge; whether it fits the junctions is seen when all are read. ASJ_ERROR_LIMIT, ASJ_ERROR_MEMORY */
asj_status asj_junction_list_add_edge(asj_junction_list *list, const asj_edge *edge, size_t line, const asj_message *message);

/* Whether all edges join branches that there are, each of them once. ASJ_ERROR_FORMAT, ASJ_ERROR_MEMORY */
asj_status asj_junction_list_check_edges(const asj_junction_list *list, const asj_message *message);

#endif
