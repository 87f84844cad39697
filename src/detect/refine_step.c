/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5 over an image: orientations to scan along again, and at the end orientations, locations and validation. */
#include "refine.h"
#include "edge_width.h"
#include "steps.h"
#include "suppress.h"
#include "validate.h"
#include "core/threads.h"
#include "core/watch.h"

asj_status asj_step_orient(asj_detection_run *run)
{
    if (run->options->refinement == ASJ_REFINE_SEARCH)
        return asj_step_search(run);
    const int64_t count = (int64_t)run->hypothesis_count;
    const int32_t threads = asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS);
    asj_watch watch;
    (void)threads;
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 8)
    for (int64_t i = 0; i < count; i++)
        if (!asj_watch_stops(&watch))
            asj_orient(run->context, run->frame, &run->hypotheses[i]);
    return asj_watch_end(&watch);
}

static asj_status refine_all(asj_detection_run *run)
{
    asj_watch watch;
    const int64_t count = (int64_t)run->hypothesis_count;
    const int32_t threads = asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS);
    (void)threads;
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 8)
    for (int64_t i = 0; i < count; i++) {
        if (asj_watch_stops(&watch))
            continue;
        if (run->frame->octaves > 1) /* soft edges are looked for: how soft? */
            asj_edge_widths(run->frame, &run->hypotheses[i]);
        asj_refine(run->context, run->frame, run->options, &run->hypotheses[i]);
        asj_validate(run->context, run->frame, run->options, &run->hypotheses[i]);
    }
    return asj_watch_end(&watch);
}

asj_status asj_step_refine(asj_detection_run *run)
{
    asj_status status = refine_all(run);
    if (status == ASJ_OK)
        status = asj_suppress_all(run, ASJ_SUPPRESS_CLOSE);
    return status == ASJ_OK ? asj_detection_run_dump_hypotheses(run, ASJ_STAGE_REFINE, "junctions") : status;
}
