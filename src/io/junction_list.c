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

/* For one element more of `size` bytes, and the number of its line. */
static asj_status make_room(void **elements, uint32_t **lines, size_t count, size_t *capacity, size_t size, const char *what,
                            const asj_message *message)
{
    const size_t wanted = *capacity ? 2 * *capacity : 64;
    if (count < *capacity)
        return ASJ_OK;
    void *more = realloc(*elements, wanted * size);
    if (more)
        *elements = more;
    uint32_t *more_lines = realloc(*lines, wanted * sizeof **lines);
    if (more_lines)
        *lines = more_lines;
    if (!more || !more_lines)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for %zu %s", wanted, what);
    *capacity = wanted;
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
    void *elements = list->junctions;
    status = make_room(&elements, &list->lines, list->count, &list->capacity, sizeof *list->junctions, "junctions", message);
    list->junctions = elements;
    if (status != ASJ_OK)
        return status;
    list->junctions[list->count] = *junction;
    list->was_sorted |= sort_branches(&list->junctions[list->count]);
    list->lines[list->count] = line > UINT32_MAX ? UINT32_MAX : (uint32_t)line;
    list->count++;
    return ASJ_OK;
}

asj_status asj_junction_list_add_edge(asj_junction_list *list, const asj_edge *edge, size_t line, const asj_message *message)
{
    asj_status status;
    if (list->edge_count >= ASJ_EDGES_MAX)
        return asj_message_fail(message, ASJ_ERROR_LIMIT, "more than %u edges", ASJ_EDGES_MAX);
    void *elements = list->edges;
    status = make_room(&elements, &list->edge_lines, list->edge_count, &list->edge_capacity, sizeof *list->edges, "edges", message);
    list->edges = elements;
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
