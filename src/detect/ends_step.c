/* SPDX-License-Identifier: BSD-2-Clause */
/* Ends over an image: what the planes of an octave say of every branch that is left. */
#include "edge_evidence.h"
#include "steps.h"
#include "core/threads.h"
#include "core/watch.h"

/* Hypotheses that are shared out. */
typedef struct job {
    asj_detection_run *run;
    asj_watch *watch;
} job;

static void measure_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++)
        asj_edge_evidence_measure(j->run->context, j->run->frame, j->run->options, &j->run->hypotheses[i]);
}

asj_status asj_step_ends(asj_detection_run *run)
{
    asj_watch watch;
    const int64_t count = (int64_t)run->hypothesis_count;
    const job j = {run, &watch};
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    asj_parallel(run->context, asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS), count, ASJ_JUNCTIONS_AT_ONCE,
                 measure_some, &j);
    return asj_watch_end(&watch);
}
