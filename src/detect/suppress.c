/* SPDX-License-Identifier: BSD-2-Clause */
/* Suppression: of hypotheses that lie close together the most meaningful one stays.
 *
 * The isotropic test finds a clear corner at several pixels and radii; the fits bring these to one place. ACJ suppresses within its
 * scale in the same way; the paper says no more about it. */
#include "suppress.h"
#include "close_grid.h"
#include "core/sort.h"

#include <math.h>

/* Two located junctions are one when they are closer than this: the larger of 3 px and a share of the radius of the more
 * meaningful one (ASJ_CLOSE_SHARE). Chosen: less reports corners twice, more loses one of two close corners (of a frame, of a tile
 * joint). */
#define LEAST_CLOSE 3.0 /* px */

static int by_meaning(const void *a, const void *b)
{
    const asj_hypothesis *p = a, *q = b;
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p->x < q->x ? -1 : p->x > q->x;
}

void asj_suppress_sort(asj_hypothesis *hypotheses, size_t count)
{
    if (count > 1)
        asj_sort(hypotheses, count, sizeof *hypotheses, by_meaning);
}

int asj_suppress_hides(const asj_hypothesis *hypotheses, const asj_close_grid *grid, double x, double y, double spare)
{
    const int64_t cell = asj_close_grid_cell(grid, x, y);
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            for (int32_t i = grid->heads[cell + dy * grid->columns + dx]; i >= 0; i = grid->next[i]) {
                const double radius = fmax(LEAST_CLOSE, ASJ_CLOSE_SHARE * hypotheses[i].radius) - spare;
                const double across = hypotheses[i].x - x, down = hypotheses[i].y - y;
                if (radius > 0 && across * across + down * down < radius * radius)
                    return 1;
            }
    return 0;
}

size_t asj_suppress(asj_hypothesis *hypotheses, size_t validated, size_t count, int32_t width, int32_t height, int32_t *cells)
{
    asj_close_grid grid = asj_close_grid_start(width, height, cells);
    size_t valid = validated, kept = validated;
    for (size_t i = 0; i < validated; i++)
        asj_close_grid_add(&grid, asj_close_grid_cell(&grid, hypotheses[i].x, hypotheses[i].y), i);
    for (size_t i = validated; i < count; i++)
        if (hypotheses[i].branch_count >= 2)
            hypotheses[valid++] = hypotheses[i];
    asj_suppress_sort(hypotheses + validated, valid - validated);
    for (size_t i = validated; i < valid; i++) {
        if (asj_suppress_hides(hypotheses, &grid, hypotheses[i].x, hypotheses[i].y, 0))
            continue;
        if (kept < i)
            hypotheses[kept] = hypotheses[i];
        asj_close_grid_add(&grid, asj_close_grid_cell(&grid, hypotheses[kept].x, hypotheses[kept].y), kept);
        kept++;
    }
    return kept;
}

asj_status asj_suppress_all(asj_detection_run *run)
{
    const asj_frame *frame = run->frame;
    const size_t count = asj_close_grid_cells(run->hypothesis_count, frame->width, frame->height);
    int32_t *cells = asj_allocate_list(&run->context->memory, count, sizeof *cells);
    if (!cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    run->hypothesis_count = asj_suppress(run->hypotheses, run->validated, run->hypothesis_count, frame->width, frame->height,
                                         cells);
    asj_release(&run->context->memory, cells);
    return ASJ_OK;
}
