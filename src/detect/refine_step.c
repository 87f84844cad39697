/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5 over an image: orientations to scan along again, and at the end orientations, locations and validation. */
#include "refine.h"
#include "edge_width.h"
#include "steps.h"
#include "suppress.h"
#include "validate.h"
#include "core/threads.h"
#include "core/watch.h"

/* Hypotheses that are shared out. */
typedef struct job {
    asj_detection_run *run;
    asj_watch *watch;
} job;

static void orient_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++)
        asj_orient(j->run->context, j->run->frame, &j->run->hypotheses[i]);
}

asj_status asj_step_orient(asj_detection_run *run)
{
    if (run->options->refinement == ASJ_REFINE_SEARCH)
        return asj_step_search(run);
    const int64_t count = (int64_t)run->hypothesis_count;
    asj_watch watch;
    const job j = {run, &watch};
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    asj_parallel(run->context, asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS), count, ASJ_JUNCTIONS_AT_ONCE, orient_some,
                 &j);
    return asj_watch_end(&watch);
}

static void refine_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_detection_run *run = j->run;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++) {
        if (run->frame->octaves > 1) /* soft edges are looked for: how soft? */
            asj_edge_widths(run->frame, &run->hypotheses[i]);
        asj_refine(run->context, run->frame, run->options, &run->hypotheses[i]);
        asj_validate(run->context, run->frame, run->options, &run->hypotheses[i]);
    }
}

static asj_status refine_all(asj_detection_run *run)
{
    asj_watch watch;
    const int64_t count = (int64_t)run->hypothesis_count;
    const job j = {run, &watch};
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    asj_parallel(run->context, asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS), count, ASJ_JUNCTIONS_AT_ONCE, refine_some,
                 &j);
    return asj_watch_end(&watch);
}

asj_status asj_step_refine(asj_detection_run *run)
{
    asj_status status = refine_all(run);
    if (status == ASJ_OK)
        status = asj_detection_run_dump_hypotheses(run, ASJ_STAGE_REFINE, "validated");
    if (status == ASJ_OK)
        status = asj_suppress_all(run, ASJ_SUPPRESS_CLOSE);
    return status == ASJ_OK ? asj_detection_run_dump_hypotheses(run, ASJ_STAGE_REFINE, "junctions") : status;
}
