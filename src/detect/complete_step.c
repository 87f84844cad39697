/* SPDX-License-Identifier: BSD-2-Clause */
/* Option complete_junctions, over an image: the directions that are worth following become hypotheses of one branch each, which
 * take the same steps as the branches of junctions have taken. */
#include "complete.h"
#include "steps.h"
#include "core/sort.h"
#include "core/threads.h"
#include "core/watch.h"

/* Junctions that are shared out. */
typedef struct job {
    const asj_detection_run *run;
    asj_missed *missed; /* of each junction */
    asj_watch *watch;
} job;

/* The most meaningful of a junction first; the scan has sorted them by place. */
static int by_junction(const void *a, const void *b)
{
    const asj_hypothesis *p = a, *q = b;
    if (p->completes != q->completes)
        return p->completes < q->completes ? -1 : 1;
    if (p->branches[0].log_nfa != q->branches[0].log_nfa)
        return p->branches[0].log_nfa < q->branches[0].log_nfa ? -1 : 1;
    return p->branches[0].angle < q->branches[0].angle ? -1 : p->branches[0].angle > q->branches[0].angle;
}

static void look_at_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_detection_run *run = j->run;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++)
        asj_complete_look(run->context, run->frame, run->options, &run->hypotheses[i], &j->missed[i]);
}

static asj_status look_at_all(const asj_detection_run *run, asj_missed *missed)
{
    const int64_t count = (int64_t)run->hypothesis_count;
    asj_watch watch;
    const job j = {run, missed, &watch};
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    asj_parallel(run->context, asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS), count, ASJ_JUNCTIONS_AT_ONCE,
                 look_at_some, &j);
    return asj_watch_end(&watch);
}

/* The steps of detect.c; a length that is not 0 stands for one that a scan has found. */
static asj_status follow(asj_detection_run *branches)
{
    asj_status status = asj_step_orient(branches); /* near the junction */
    for (size_t i = 0; i < branches->hypothesis_count; i++)
        branches->hypotheses[i].branches[0].length = 0;
    if (status == ASJ_OK)
        status = asj_step_scan(branches);
    if (status == ASJ_OK)
        status = asj_step_orient(branches);
    if (status == ASJ_OK)
        status = asj_step_scan(branches);
    return status == ASJ_OK ? asj_detection_run_each(branches, ASJ_STAGE_REFINE, ASJ_LEAST_JUNCTIONS, asj_step_fit_lines) : status;
}

static void start_all(const asj_detection_run *run, const asj_missed *missed, asj_hypothesis *list)
{
    size_t count = 0;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        for (int32_t k = 0; k < missed[i].count; k++) {
            asj_complete_start(&run->hypotheses[i], &missed[i].list[k], &list[count]);
            list[count++].completes = (int32_t)i;
        }
}

static asj_status complete(asj_detection_run *run, const asj_missed *missed)
{
    asj_detection_run branches = *run;
    branches.validated = branches.hypothesis_count = 0;
    for (size_t i = 0; i < run->hypothesis_count; i++)
        branches.hypothesis_count += (size_t)missed[i].count;
    branches.hypotheses = asj_allocate_list(&run->context->memory, asj_detection_run_room(branches.hypothesis_count),
                                            sizeof *branches.hypotheses);
    if (!branches.hypotheses)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu branches", branches.hypothesis_count);
    start_all(run, missed, branches.hypotheses);
    const asj_status status = follow(&branches);
    if (status == ASJ_OK && branches.hypothesis_count > 0)
        asj_sort(branches.hypotheses, branches.hypothesis_count, sizeof *branches.hypotheses, by_junction);
    for (size_t i = 0; i < branches.hypothesis_count && status == ASJ_OK; i++)
        asj_complete_add(run->context, run->frame, run->options, &branches.hypotheses[i],
                         &run->hypotheses[branches.hypotheses[i].completes]);
    asj_release(&run->context->memory, branches.hypotheses);
    return status;
}

asj_status asj_step_complete(asj_detection_run *run)
{
    if (!asj_complete_is_asked(run->options))
        return ASJ_OK;
    asj_missed *missed = asj_allocate_list(&run->context->memory, asj_detection_run_room(run->hypothesis_count), sizeof *missed);
    if (!missed)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", run->hypothesis_count);
    asj_status status = look_at_all(run, missed);
    if (status == ASJ_OK)
        status = complete(run, missed);
    asj_release(&run->context->memory, missed);
    return status;
}
