/* SPDX-License-Identifier: BSD-2-Clause */
/* Ends over an image: what the planes of an octave say of every branch that is left. */
#include "end_kind.h"
#include "ends.h"
#include "soft_twins.h"
#include "steps.h"
#include "validate.h"
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
        asj_edge_evidence_measure(run->context, run->frame, run->options, &run->hypotheses[i], run->evidence);
        asj_end_kinds(run->frame, j->rays, run->options, &run->hypotheses[i]);
    }
}

/* Room for the evidence of every branch, behind that of other octaves. */
static asj_status number_branches(asj_detection_run *run)
{
    size_t total = run->evidence_count;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        for (int32_t b = 0; b < run->hypotheses[i].branch_count; b++)
            run->hypotheses[i].branches[b].evidence = (int32_t)total++;
    void *list = run->evidence;
    const asj_status status = asj_grow(&run->context->memory, &list, &run->evidence_capacity, asj_detection_run_room(total),
                                       sizeof *run->evidence, run->evidence_count);
    run->evidence = list;
    run->evidence_count = status == ASJ_OK ? total : 0;
    return status == ASJ_OK ? status : asj_fail(run->context, status, "no memory for %zu branches", total);
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

/* asj_ends_mark(), or at the end asj_ends_snap(). */
static asj_status look_for_junctions(asj_detection_run *run, int at_the_end)
{
    const size_t count = run->hypothesis_count;
    const asj_hypothesis **order = asj_allocate_list(&run->context->memory, asj_detection_run_room(count), sizeof *order);
    if (!order)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", count);
    asj_watch watch;
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    if (at_the_end)
        asj_ends_snap(run->hypotheses, count, run->options, order, &watch);
    else
        asj_ends_mark(run->hypotheses, count, run->options->snap_distance, order, &watch);
    asj_release(&run->context->memory, order);
    return asj_watch_end(&watch);
}

static void end_by_contrast(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    asj_ends_by_contrast(run->frame, run->options, hypothesis);
    asj_validate_lengths(run->options, hypothesis);
}

static void leave_out_rejected(asj_detection_run *run)
{
    size_t kept = 0;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        if (run->hypotheses[i].branch_count > 0) {
            if (kept != i)
                run->hypotheses[kept] = run->hypotheses[i];
            kept++;
        }
    run->hypothesis_count = kept;
}

/* Ends at junctions are told first: what is at them needs no look at the picture. */
asj_status asj_step_ends(asj_detection_run *run)
{
    asj_status status = asj_detection_run_dump_hypotheses(run, ASJ_STAGE_REFINE, "validated");
    if (status == ASJ_OK)
        status = asj_drop_soft_twins(run);
    if (status == ASJ_OK)
        status = asj_detection_run_dump_hypotheses(run, ASJ_STAGE_REFINE, "junctions");
    if (status == ASJ_OK)
        status = asj_detection_run_each(run, ASJ_STAGE_REFINE, ASJ_LEAST_JUNCTIONS, end_by_contrast);
    leave_out_rejected(run);
    if (status == ASJ_OK)
        status = look_for_junctions(run, 0);
    if (status == ASJ_OK)
        status = number_branches(run);
    return status == ASJ_OK ? measure_all(run) : status;
}

asj_status asj_step_snap(asj_detection_run *run)
{
    return look_for_junctions(run, 1);
}
