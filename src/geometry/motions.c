/* SPDX-License-Identifier: BSD-2-Clause */
/* Motions with planes: each essential matrix that was found, and each motion of a homography that was found, is refined, and the
 * best that differ receive planes. So walls and floor speak for one motion together, and what one plane leaves open (two motions;
 * which of its tiles) the others decide. The best ASJ_SETTLED that lie apart become what the candidates allow around them
 * (posterior.c). */
#include "motions.h"
#include "around_rotation.h"
#include "core/angle.h"
#include "core/sort.h"
#include "core/threads.h"
#include "evidence.h"
#include "other_motions.h"
#include "planes.h"
#include "posterior.h"
#include "ranking.h"
#include "small_matrix.h"
#include "stop.h"

#include <math.h>
#include <string.h>

#define MOST_STARTS (3 * ASJ_FINALISTS)
#define FEW_ROUNDS 4
#define ROUNDS 5
#define WITH_PLANES 4
#define UNLIKELY 7.0 /* nats below the best one */
#define BESIDE (8 * ASJ_DEGREE) /* likely rotations that are tried in place of a motion's own; what is farther is another motion */

typedef struct motions {
    asj_model starts[MOST_STARTS], picked[ASJ_FINALISTS];
    asj_ranked order[MOST_STARTS];
    int32_t count;
} motions;

/* What a loop over motions works on. */
typedef struct job {
    const asj_pairs *set;
    asj_adjust_scratch *scratch; /* for each thread */
    motions *m;
} job;

static void collect(const asj_pairs *set, const asj_camera cameras[2], asj_model *finalists, int32_t *count, motions *m)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < *count; k++) {
        if (finalists[k].kind == ASJ_GEOMETRY_ESSENTIAL) {
            m->starts[m->count++] = finalists[k];
            continue;
        }
        if (finalists[k].kind == ASJ_GEOMETRY_HOMOGRAPHY)
            m->count += asj_motions_of_homography(set, &finalists[k], cameras, m->starts + m->count);
        finalists[kept++] = finalists[k];
    }
    *count = kept;
}

static void refine_some(const void *data, const asj_part *part)
{
    const job *j = data;
    asj_adjust_scratch *s = &j->scratch[part->thread];
    for (int64_t n = part->first; n < part->end; n++) {
        asj_model *model = &j->m->starts[n];
        model->evidence = -HUGE_VAL;
        if (!asj_pairs_stop(j->set, part)) {
            asj_adjust(j->set, model, FEW_ROUNDS, s);
            model->evidence = asj_log_evidence(j->set, model, s);
        }
        j->m->order[n] = (asj_ranked){model->evidence, (int32_t)n};
    }
}

static void add_planes_to_some(const void *data, const asj_part *part)
{
    const job *j = data;
    asj_adjust_scratch *s = &j->scratch[part->thread];
    for (int64_t n = part->first; n < part->end && !asj_pairs_stop(j->set, part); n++) {
        asj_model *model = &j->m->picked[n];
        asj_add_planes(j->set, model, s);
        asj_model last = *model;
        asj_adjust(j->set, &last, ROUNDS, s);
        last.evidence = asj_log_evidence(j->set, &last, s);
        if (last.evidence > model->evidence)
            *model = last;
    }
}

/* The model with the k-th likely rotation in place of its own, and with the matches of its own; -HUGE_VAL: no such model.
 * Translation and planes follow before the rotation is free: all at once they often do not come along. */
static asj_model snapped(const asj_pairs *set, const asj_model *model, int32_t k, asj_adjust_scratch *s)
{
    asj_model m = *model;
    memcpy(m.rotation, set->rotations[k].matrix, sizeof m.rotation);
    m.evidence = -HUGE_VAL;
    if (!asj_model_complete(&m))
        return m;
    asj_adjust_around_rotation(set, &m, model, s);
    asj_adjust(set, &m, ROUNDS, s);
    m.evidence = asj_log_evidence(set, &m, s);
    return m;
}

static int32_t is_beside(const double a[9], const double b[9])
{
    double turn[9];
    asj_multiply3_transposed(a, b, turn);
    return asj_rotation_angle(turn) < BESIDE;
}

static void snap_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++) {
        asj_model *model = &j->m->picked[n];
        const asj_model from = *model;
        for (int32_t k = 0; k < j->set->rotation_count && !asj_pairs_stop(j->set, part); k++) {
            if (!is_beside(j->set->rotations[k].matrix, from.rotation))
                continue;
            const asj_model m = snapped(j->set, &from, k, &j->scratch[part->thread]);
            if (m.evidence > model->evidence)
                *model = m;
        }
    }
}

static void refine(asj_context *context, const job *j)
{
    motions *m = j->m;
    asj_parallel(context, context->threads, m->count, 1, refine_some, j);
    asj_sort(m->order, (size_t)m->count, sizeof *m->order, asj_by_score);
    m->count = asj_pick(m->starts, m->order, m->count, ASJ_FINALISTS, m->picked);
    const int32_t most = m->count < WITH_PLANES ? m->count : WITH_PLANES;
    asj_parallel(context, context->threads, most, 1, add_planes_to_some, j);
    if (j->set->rotation_count > 0)
        asj_parallel(context, context->threads, most, 1, snap_some, j);
}

/* The best ones that are apart from each other become all that the candidates allow around them. */
static void settle(asj_context *context, const job *j, uint64_t seed, int32_t most)
{
    motions *m = j->m;
    for (int32_t k = 0; k < m->count; k++)
        m->order[k] = (asj_ranked){m->picked[k].evidence, k};
    asj_sort(m->order, (size_t)m->count, sizeof *m->order, asj_by_score);
    const double least = m->count > 0 ? fmax(0, m->order[0].score - UNLIKELY) : 0;
    for (int32_t k = 0, settled = 0; k < m->count && settled < most; k++) {
        asj_model *model = &m->picked[m->order[k].index];
        int32_t apart = model->evidence > least;
        for (int32_t i = 0; i < k && apart; i++)
            apart = !asj_is_within(&m->picked[m->order[i].index], model);
        if (!apart)
            continue;
        asj_settle(context, j->set, seed + (uint64_t)k, j->scratch, model);
        settled++;
    }
}

asj_status asj_refine_motions(asj_context *context, const asj_pairs *set, const asj_camera cameras[2], uint64_t seed,
                              int32_t settled, asj_model *finalists, int32_t *count)
{
    asj_memory *memory = &context->memory;
    const int32_t threads = context->threads;
    motions *m = asj_allocate_zero(memory, 1, sizeof *m);
    asj_adjust_scratch *scratch = asj_adjust_scratches_create(memory, set, threads);
    const int32_t good = m && scratch;
    if (good) {
        const job j = {set, scratch, m};
        collect(set, cameras, finalists, count, m);
        refine(context, &j);
        settle(context, &j, seed, settled);
        memcpy(finalists + *count, m->picked, (size_t)m->count * sizeof *m->picked);
        *count += m->count;
    }
    asj_adjust_scratches_free(memory, scratch, threads);
    asj_release(memory, m);
    return good ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the motions of %d candidates", (int)set->count);
}
