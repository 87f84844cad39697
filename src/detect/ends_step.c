/* SPDX-License-Identifier: BSD-2-Clause */
/* Ends over an image: what the planes of an octave say of every branch that is left. */
#include "edge_evidence.h"
#include "end_kind.h"
#include "ends.h"
#include "steps.h"
#include "core/threads.h"
#include "core/watch.h"

/* Hypotheses that are shared out. */
typedef struct job {
    asj_detection_run *run;
    const asj_end_rays *rays;
    asj_watch *watch;
} job;

static void measure_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_detection_run *run = j->run;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++) {
        asj_edge_evidence_measure(run->context, run->frame, run->options, &run->hypotheses[i]);
        asj_end_kinds(run->frame, j->rays, run->options, &run->hypotheses[i]);
    }
}

static asj_status measure_all(asj_detection_run *run)
{
    asj_watch watch;
    asj_end_rays rays;
    const int64_t count = (int64_t)run->hypothesis_count;
    const job j = {run, &rays, &watch};
    asj_end_rays_make(&rays);
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    asj_parallel(run->context, asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS), count, ASJ_JUNCTIONS_AT_ONCE,
                 measure_some, &j);
    return asj_watch_end(&watch);
}

/* asj_ends_mark() or asj_ends_snap(). */
typedef void (*ends_work)(asj_hypothesis *hypotheses, size_t count, double reach, const asj_hypothesis **order, asj_watch *watch);

static asj_status look_for_junctions(asj_detection_run *run, ends_work work)
{
    const size_t count = run->hypothesis_count;
    const asj_hypothesis **order = asj_allocate_list(&run->context->memory, asj_detection_run_room(count), sizeof *order);
    if (!order)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", count);
    asj_watch watch;
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    work(run->hypotheses, count, run->options->snap_distance, order, &watch);
    asj_release(&run->context->memory, order);
    return asj_watch_end(&watch);
}

/* Ends at junctions need no look at the picture. */
asj_status asj_step_ends(asj_detection_run *run)
{
    const asj_status status = look_for_junctions(run, asj_ends_mark);
    return status == ASJ_OK ? measure_all(run) : status;
}

asj_status asj_step_snap(asj_detection_run *run)
{
    return look_for_junctions(run, asj_ends_snap);
}
