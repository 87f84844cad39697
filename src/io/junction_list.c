/* SPDX-License-Identifier: BSD-2-Clause */
/* The rules that both readers of junction files share. */
#include "junction_graph.h"
#include "junction_list.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

static const double two_pi = 6.283185307179586;

asj_status asj_line_fail(const asj_message *message, size_t line, const char *format, ...)
{
    char cause[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(cause, sizeof cause, format, arguments);
    va_end(arguments);
    return asj_message_fail(message, ASJ_ERROR_FORMAT, "line %zu: %s", line, cause);
}

int asj_fits_float(double value)
{
    return fabs(value) < 3.4028235677973366e38; /* from there on the nearest float is infinity */
}

void asj_set_angle(asj_branch *branch, double angle)
{
    double turned = fmod(angle, two_pi);
    float nearest = (float)(turned < 0 ? turned + two_pi : turned);
    branch->angle = (double)nearest < two_pi ? nearest : 0.0f; /* the float next to 2 pi lies above it */
}

/* 1 when they were not in order. */
static int sort_branches(asj_junction *junction)
{
    int32_t i, j;
    int moved = 0;
    for (i = 1; i < junction->branch_count; i++) {
        asj_branch branch = junction->branches[i];
        for (j = i; j > 0 && junction->branches[j - 1].angle > branch.angle; j--)
            junction->branches[j] = junction->branches[j - 1];
        junction->branches[j] = branch;
        moved |= j < i;
    }
    return moved;
}

static asj_status make_room(asj_junction_list *list, const asj_message *message)
{
    size_t wanted = list->capacity ? 2 * list->capacity : 64;
    asj_junction *junctions;
    uint32_t *lines;

    if (list->count < list->capacity)
        return ASJ_OK;
    junctions = realloc(list->junctions, wanted * sizeof *junctions);
    if (junctions)
        list->junctions = junctions;
    lines = realloc(list->lines, wanted * sizeof *lines);
    if (lines)
        list->lines = lines;
    if (!junctions || !lines)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for %zu junctions", wanted);
    list->capacity = wanted;
    return ASJ_OK;
}

asj_status asj_junction_list_add(asj_junction_list *list, const asj_junction *junction, size_t line, const asj_message *message)
{
    asj_status status;
    char fault[128];

    if (asj_junction_check(junction, fault, sizeof fault) != ASJ_OK)
        return asj_line_fail(message, line, "a junction with %s", fault);
    if (list->count >= ASJ_JUNCTIONS_MAX)
        return asj_message_fail(message, ASJ_ERROR_LIMIT, "more than %u junctions", ASJ_JUNCTIONS_MAX);
    status = make_room(list, message);
    if (status != ASJ_OK)
        return status;
    list->junctions[list->count] = *junction;
    list->was_sorted |= sort_branches(&list->junctions[list->count]);
    list->lines[list->count] = line > UINT32_MAX ? UINT32_MAX : (uint32_t)line;
    list->count++;
    return ASJ_OK;
}

static asj_status make_edge_room(asj_junction_list *list, const asj_message *message)
{
    size_t wanted = list->edge_capacity ? 2 * list->edge_capacity : 64;
    asj_edge *edges;
    uint32_t *lines;

    if (list->edge_count < list->edge_capacity)
        return ASJ_OK;
    edges = realloc(list->edges, wanted * sizeof *edges);
    if (edges)
        list->edges = edges;
    lines = realloc(list->edge_lines, wanted * sizeof *lines);
    if (lines)
        list->edge_lines = lines;
    if (!edges || !lines)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for %zu edges", wanted);
    list->edge_capacity = wanted;
    return ASJ_OK;
}

asj_status asj_junction_list_add_edge(asj_junction_list *list, const asj_edge *edge, size_t line, const asj_message *message)
{
    asj_status status;
    if (list->edge_count >= ASJ_EDGES_MAX)
        return asj_message_fail(message, ASJ_ERROR_LIMIT, "more than %u edges", ASJ_EDGES_MAX);
    status = make_edge_room(list, message);
    if (status != ASJ_OK)
        return status;
    list->edges[list->edge_count] = *edge;
    list->edge_lines[list->edge_count++] = line > UINT32_MAX ? UINT32_MAX : (uint32_t)line;
    return ASJ_OK;
}

asj_status asj_junction_list_check_edges(const asj_junction_list *list, const asj_message *message)
{
    size_t which;
    if (!list->edge_count)
        return ASJ_OK;
    if (list->was_sorted)
        return asj_line_fail(message, list->edge_lines[0], "edges name branches, which must stand in order of angle then");
    switch (asj_find_edge_fault(list->junctions, list->count, list->edges, list->edge_count, &which)) {
    case ASJ_EDGES_SOUND: break;
    case ASJ_EDGE_OF_NOTHING:
        return asj_line_fail(message, list->edge_lines[which], "an edge of a junction or branch that is not there");
    case ASJ_EDGE_OF_AN_OTHER: return asj_line_fail(message, list->edge_lines[which], "a branch is part of two edges");
    case ASJ_EDGES_NO_MEMORY: return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for %zu junctions", list->count);
    }
    return ASJ_OK;
}
