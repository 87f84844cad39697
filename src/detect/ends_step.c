/* SPDX-License-Identifier: BSD-2-Clause */
/* Ends over an image: what the planes of an octave say of every branch that is left. */
#include "edge_evidence.h"
#include "steps.h"
#include "core/threads.h"
#include "core/watch.h"

asj_status asj_step_ends(asj_detection_run *run)
{
    asj_watch watch;
    const int64_t count = (int64_t)run->hypothesis_count;
    const int32_t threads = asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS);
    (void)threads;
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 8)
    for (int64_t i = 0; i < count; i++)
        if (!asj_watch_stops(&watch))
            asj_edge_evidence_measure(run->context, run->frame, run->options, &run->hypotheses[i]);
    return asj_watch_end(&watch);
}
