/* SPDX-License-Identifier: BSD-2-Clause */
/* Ends over an image: what the planes of an octave say of every branch that is left. */
#include "end_kind.h"
#include "ends.h"
#include "soft_twins.h"
#include "steps.h"
#include "validate.h"
#include "core/threads.h"
#include "core/watch.h"

#include <string.h>

#define LEAST_ENDS 64 /* junctions for a thread: fewer take less time than to wake it */

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
        asj_end_kinds(run->context->ops->edge, run->frame, j->rays, run->options, &run->hypotheses[i]);
    }
}

/* Room for the evidence of every branch, behind that of other octaves. The votes, which stand elsewhere, share one that is not
 * measured. */
static asj_status number_branches(asj_detection_run *run, asj_hypothesis *votes, size_t vote_count)
{
    const asj_evidence none = {.length = 0};
    size_t total = run->evidence_count;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        for (int32_t b = 0; b < run->hypotheses[i].branch_count; b++)
            run->hypotheses[i].branches[b].evidence = (int32_t)total++;
    for (size_t i = 0; i < vote_count; i++)
        for (int32_t b = 0; b < votes[i].branch_count; b++)
            votes[i].branches[b].evidence = (int32_t)total;
    total += vote_count > 0;
    void *list = run->evidence;
    const asj_status status = asj_grow(&run->context->memory, &list, &run->evidence_capacity, asj_detection_run_room(total),
                                       sizeof *run->evidence, run->evidence_count);
    run->evidence = list;
    run->evidence_count = status == ASJ_OK ? total : 0;
    if (status == ASJ_OK && vote_count > 0)
        run->evidence[total - 1] = none;
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

typedef struct junctions_job {
    asj_ends ends;
    asj_watch *watch;
    void (*look)(const asj_ends *ends, size_t index);
} junctions_job;

static void look_for_some(const void *data, const asj_part *part)
{
    const junctions_job *j = data;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++)
        j->look(&j->ends, (size_t)i);
}

/* asj_ends_mark(), or at the end asj_ends_snap(), of all. width, height: px, of where the junctions are. */
static asj_status look_for_junctions(asj_detection_run *run, int32_t width, int32_t height,
                                     void (*look)(const asj_ends *ends, size_t index))
{
    const int64_t count = (int64_t)run->hypothesis_count;
    asj_junction_grid grid;
    const asj_status status = asj_junction_grid_make(run->context, run->hypotheses, run->hypothesis_count, width, height, &grid);
    if (status != ASJ_OK)
        return status;
    asj_watch watch;
    const junctions_job j = {{&grid, run->options, run->hypotheses}, &watch, look};
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    asj_parallel(run->context, asj_threads_for(run->context, count, LEAST_ENDS), count, 0, look_for_some, &j);
    asj_junction_grid_free(run->context, &grid);
    return asj_watch_end(&watch);
}

static void end_by_contrast(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    asj_ends_by_contrast(run->context->ops->edge, run->frame, run->options, hypothesis);
    asj_validate_lengths(run->frame, run->options, hypothesis);
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
    const size_t vote_count = asj_sizes_votes_last(run); /* which need no ends */
    run->hypothesis_count -= vote_count;
    asj_hypothesis *votes = run->hypotheses + run->hypothesis_count;
    if (status == ASJ_OK)
        status = asj_detection_run_each(run, ASJ_STAGE_REFINE, ASJ_LEAST_JUNCTIONS, end_by_contrast);
    leave_out_rejected(run);
    if (status == ASJ_OK)
        status = look_for_junctions(run, run->frame->width, run->frame->height, asj_ends_mark);
    if (status == ASJ_OK)
        status = number_branches(run, votes, vote_count);
    if (status == ASJ_OK)
        status = measure_all(run);
    if (vote_count > 0)
        memmove(run->hypotheses + run->hypothesis_count, votes, vote_count * sizeof *votes);
    run->hypothesis_count += vote_count;
    return status;
}

asj_status asj_step_snap(asj_detection_run *run)
{
    return look_for_junctions(run, run->image->width, run->image->height, asj_ends_snap);
}
