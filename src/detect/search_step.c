/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 5 as in the paper (option refinement = search), over an image.
 *
 * "A branch with the most accurate orientation theta should have the maximum junction-ness with the scale r_theta"
 *     theta^ = argmax_theta  sum over q in S_p(r_theta, theta) of gamma_p(q)          (paper, end of section "Junction Detection")
 * The scale depends on the orientation: a ray that is a degree off leaves its edge early. So each branch is scanned (step 4) at
 * every orientation within 0.1 rad of that of the isotropic test, followed outwards (follow.c), and has then both its orientation
 * and its scale. The range is half a sector of the isotropic test; the step of 0.005 rad is ours, 1 px at a distance of 200.
 *
 * Every fourth orientation is scanned first, then those around the best: 15 rays a branch instead of 41. Agreement with the output
 * of the authors' program is the same, and of the L-junctions that repeat under zoom by 0.9 one in a hundred is lost. */
#include "search.h"
#include "follow.h"
#include "steps.h"
#include "core/threads.h"
#include "core/watch.h"

#include <math.h>

#define STEPS 20         /* to either side */
#define STEP 0.005       /* rad */
#define SPARSE 4         /* one of so many orientations is scanned first */
#define COARSE (2 * STEPS / SPARSE + 1)
#define FINE 4           /* those around the best */
#define TOGETHER 512     /* branches whose rays are followed at once */

/* Orientations at which a branch is looked at in one pass, relative to where it stands: of equals the first wins, so those nearest
 * to the middle come first. */
typedef struct pass {
    int32_t count;
    double angles[COARSE]; /* rad */
} pass;

typedef struct lists {
    asj_hypothesis **hypotheses; /* of each branch */
    asj_hypothesis_branch **branches;
    double *strengths; /* of each branch at the orientation chosen so far */
    asj_ray *rays;     /* COARSE for each branch */
} lists;

static pass coarse_pass(void)
{
    pass p = {COARSE, {0}};
    for (int32_t i = 0; i < COARSE; i++)
        p.angles[i] = SPARSE * STEP * (i % 2 ? -(i + 1) / 2 : i / 2);
    return p;
}

/* The branch takes the orientation whose ray has the strongest sector. */
static void choose(const asj_detection_run *run, const asj_hypothesis *hypothesis, const asj_ray *rays, int32_t count,
                   double *strongest, asj_hypothesis_branch *branch)
{
    for (int32_t i = 0; i < count; i++) {
        const double length = asj_ray_length(run->options, &rays[i]);
        const double strength = asj_search_strength(run->frame, hypothesis->x, hypothesis->y, rays[i].angle, length,
                                                    run->options->sector_width);
        if (strength <= *strongest)
            continue;
        *strongest = strength;
        branch->angle = rays[i].angle;
        branch->length = length;
        branch->scanned = (asj_scanned_ray){rays[i].x, rays[i].y, rays[i].angle};
    }
}

/* Branches whose rays have been scanned. */
typedef struct job {
    const asj_detection_run *run;
    const lists *l;
    const pass *p;
    asj_watch *watch;
} job;

static void choose_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const lists *l = j->l;
    const int32_t count = j->p->count;
    for (int64_t b = part->first; b < part->end && !asj_watch_stops(j->watch, part); b++)
        choose(j->run, l->hypotheses[b], l->rays + b * count, count, &l->strengths[b], l->branches[b]);
}

static asj_status scan_pass(const asj_detection_run *run, const lists *l, size_t count, const pass *p)
{
    const int64_t branches = (int64_t)count;
    for (size_t b = 0; b < count; b++) {
        const asj_hypothesis *h = l->hypotheses[b];
        const int32_t start = run->options->scan_start > 0 ? run->options->scan_start : (int32_t)h->radius;
        for (int32_t i = 0; i < p->count; i++)
            l->rays[b * (size_t)p->count + (size_t)i] =
                (asj_ray){h->x, h->y, asj_angle_wrap(l->branches[b]->angle + p->angles[i]), start, 0, 0};
    }
    const asj_status status = run->context->ops->scan->rays(run->context, run->scan, run->frame, &run->scratch, l->rays,
                                                            count * (size_t)p->count);
    if (status != ASJ_OK)
        return status;
    asj_watch watch;
    const job j = {run, l, p, &watch};
    asj_watch_start(&watch, run->context, ASJ_STAGE_REFINE);
    asj_parallel(run->context, asj_threads_for(run->context, branches, ASJ_LEAST_JUNCTIONS), branches, ASJ_JUNCTIONS_AT_ONCE,
                 choose_some, &j);
    return asj_watch_end(&watch);
}

static asj_status search(const asj_detection_run *run, const lists *l, size_t count)
{
    const pass coarse = coarse_pass(), fine = {FINE, {-STEP, STEP, -2 * STEP, 2 * STEP}};
    for (size_t b = 0; b < count; b++)
        l->strengths[b] = -HUGE_VAL;
    const asj_status status = scan_pass(run, l, count, &coarse);
    return status == ASJ_OK ? scan_pass(run, l, count, &fine) : status;
}

static asj_status search_all(asj_detection_run *run, const lists *l)
{
    asj_status status = ASJ_OK;
    size_t count = 0;
    for (size_t i = run->validated; i < run->hypothesis_count && status == ASJ_OK; i++) {
        asj_hypothesis *hypothesis = &run->hypotheses[i];
        for (int32_t b = 0; b < hypothesis->branch_count; b++) {
            l->hypotheses[count] = hypothesis;
            l->branches[count++] = &hypothesis->branches[b];
        }
        if (count + ASJ_MAX_BRANCHES > TOGETHER || (i + 1 == run->hypothesis_count && count > 0)) {
            status = search(run, l, count);
            count = 0;
        }
    }
    return status;
}

asj_status asj_step_search(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    const lists l = {asj_allocate(memory, TOGETHER, sizeof *l.hypotheses), asj_allocate(memory, TOGETHER, sizeof *l.branches),
                     asj_allocate(memory, TOGETHER, sizeof *l.strengths),
                     asj_allocate(memory, (size_t)TOGETHER * COARSE, sizeof *l.rays)};
    asj_status status = ASJ_OK;
    if (l.hypotheses && l.branches && l.strengths && l.rays) {
        status = asj_detection_run_each(run, ASJ_STAGE_REFINE, ASJ_LEAST_JUNCTIONS, asj_follow);
        status = status == ASJ_OK ? search_all(run, &l) : status;
    } else
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the rays of %d branches", TOGETHER);
    asj_release(memory, l.rays);
    asj_release(memory, l.strengths);
    asj_release(memory, l.branches);
    asj_release(memory, l.hypotheses);
    return status;
}
