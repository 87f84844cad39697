/* SPDX-License-Identifier: BSD-2-Clause */
/* Edges over an image: memory around edges.c. */
#include "edges.h"
#include "steps.h"

static size_t count_branches(const asj_detection_run *run)
{
    size_t count = 0;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        count += (size_t)run->hypotheses[i].branch_count;
    return count;
}

asj_status asj_step_join(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    const int32_t width = run->image->width, height = run->image->height;
    const size_t count = run->hypothesis_count, most = asj_detection_run_room(count_branches(run) / 2);
    asj_junction_grid grid;
    asj_status status = asj_junction_grid_make(run->context, run->hypotheses, count, width, height, &grid);
    if (status != ASJ_OK)
        return status;
    int32_t *scratch = asj_allocate_list(memory, asj_edges_scratch(asj_detection_run_room(count)), sizeof *scratch);
    run->edges = asj_allocate_list(memory, most, sizeof *run->edges);
    asj_watch watch;
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    if (scratch && run->edges) {
        const asj_edge_search search = {&watch, run->options, width, height, run->sharing, run->evidence, &grid, run->hypotheses,
                                        count, scratch};
        run->edge_count = asj_edges_join(&search, run->edges);
        status = asj_watch_end(&watch);
    } else
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for edges between %zu junctions", count);
    asj_junction_grid_free(run->context, &grid);
    asj_release(memory, scratch);
    return status;
}
