/* SPDX-License-Identifier: BSD-2-Clause */
/* Motions that tiles allow.
 *
 * A floor of tiles is matched with itself shifted, or turned by 90 degrees, and where more tiles are in common that way than by the
 * right motion no search may come upon that: it has fewer matches than what is beside the wrong one. But all these motions are
 * known from one of them. Camera 2 sees the floor n'X = 1 as it does, n2'Y = 1, n2 = R n/(1 + (R n)'t); which tile it is that it
 * sees is left open. So a matched corner X is put on each corner of image 2 in turn, whose ray meets the floor in Y, with T one of
 * the four quarter turns about n:
 *
 *     R' = R T,   t' = Y - R' X,   then t' / |t'| and n |t'|.
 *
 * That with CORNERS of the matched ones, since image 2 may show any of them nowhere. The best by score follow their candidates
 * (adjust.c).
 *
 * Matches have said what they can: it is pictures in colours that may tell these motions from each other. The best of many agrees
 * by chance with what it shows better than usual, so only what agrees by AGREES, and is not chance by its matches, is added, and
 * only where the pictures do not agree with the best motion (DOUBTFUL). Whether it is preferred is decided where all others are
 * compared (strike_out.c). What was measured: tests/accuracy/tried/geometry.md, "Motions that tiles allow". */
#include "tiled_motions.h"
#include "contradiction.h"
#include "core/angle.h"
#include "core/sort.h"
#include "core/threads.h"
#include "evidence.h"
#include "geometry_options.h"
#include "motions.h"
#include "ranking.h"
#include "small_matrix.h"
#include "stop.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define DOUBTFUL 0.62 /* of the share that agrees (picture_agreement.h) */
#define AGREES 0.75   /* likewise */
#define OTHER_MOTION (3 * ASJ_DEGREE) /* what is nearer is the best one again */
#define LEAST_MATCHED 6 /* on a plane */
#define CORNERS 4 /* of a plane */
#define TURNS 4
#define MOST_PLACES 300 /* of image 2, the likeliest ones */
#define PRESELECTED 600
#define SHORT 200
#define DISTINCT 40
#define ROUNDS 4
#define LOOSE 2.0
#define LEAST_LENGTH 1e-6 /* of t', where that of the best motion is 1 */

/* A corner of a plane that the best motion has matched. */
typedef struct corner {
    const double *normal; /* n */
    double seen[3];  /* n2 */
    double point[3]; /* X */
} corner;

typedef struct tiled {
    asj_context *context;
    const asj_pairs *set;
    const asj_model *best;
    corner corners[ASJ_MOST_PLANES * CORNERS];
    double rays[MOST_PLACES][3]; /* of camera 2 */
    int32_t corner_count, ray_count;
    asj_ranked *order; /* of all of them, then of those below */
    asj_model *models; /* SHORT */
    asj_model *picked; /* DISTINCT */
    asj_adjust_scratch *scratch; /* for each thread */
} tiled;

/* The matched corners of the plane with number `plane`. */
static void find_corners(tiled *t, int32_t plane, const asj_patch_of_plane *matched)
{
    const asj_model *best = t->best;
    corner c = {.normal = best->planes[plane]};
    asj_apply3(best->rotation, c.normal, c.seen);
    const double distance = 1 + asj_dot3(c.seen, best->translation);
    if (matched->count < LEAST_MATCHED || !(distance > 0))
        return;
    for (int32_t i = 0; i < 3; i++)
        c.seen[i] /= distance;
    for (int32_t k = 0; k < CORNERS; k++) {
        const asj_pair *pair = matched->list[(ptrdiff_t)k * matched->count / CORNERS]; /* the likeliest come first */
        double ray[3];
        asj_ray(&best->cameras[0], pair->x1, pair->y1, ray);
        const double along = asj_dot3(c.normal, ray);
        if (!(along > 0))
            continue;
        for (int32_t i = 0; i < 3; i++)
            c.point[i] = ray[i] / along;
        t->corners[t->corner_count++] = c;
    }
}

/* Of the corners in image 2, as far as there is room, those of the likeliest candidates. `seen`: zero, one a place. */
static void find_rays(tiled *t, uint8_t *seen)
{
    for (int32_t k = 0; k < t->set->count && t->ray_count < MOST_PLACES; k++) {
        const asj_pair *pair = &t->set->list[k];
        if (!seen[pair->place2])
            asj_ray(&t->best->cameras[1], pair->x2, pair->y2, t->rays[t->ray_count++]);
        seen[pair->place2] = 1;
    }
}

static int64_t count_all(const tiled *t)
{
    return (int64_t)t->corner_count * t->ray_count * TURNS;
}

/* Number n of them; 0 when it cannot be. */
static int32_t make(const tiled *t, int64_t n, asj_model *m)
{
    const corner *c = &t->corners[n / TURNS / t->ray_count];
    const double *ray = t->rays[n / TURNS % t->ray_count], along = asj_dot3(c->seen, ray);
    double axis[3] = {c->normal[0], c->normal[1], c->normal[2]}, turn[9], moved[3], shift[3];
    if (!(along > 0) || !asj_normalise3(axis))
        return 0;
    for (int32_t i = 0; i < 3; i++)
        axis[i] *= (double)(n % TURNS) * (ASJ_TWO_PI / TURNS);
    asj_rotation_of(axis, turn);
    *m = *t->best;
    asj_multiply3(t->best->rotation, turn, m->rotation);
    asj_apply3(m->rotation, c->point, moved);
    for (int32_t i = 0; i < 3; i++)
        shift[i] = ray[i] / along - moved[i];
    const double length = sqrt(asj_dot3(shift, shift));
    if (!(length > LEAST_LENGTH))
        return 0;
    for (int32_t i = 0; i < 3; i++) {
        m->translation[i] = shift[i] / length;
        m->planes[0][i] = c->normal[i] * length;
    }
    m->view.plane_count = 1;
    m->parameters = 5 + 3;
    m->settled = 0;
    return asj_model_complete(m);
}

static void score_some(const void *data, const asj_part *part)
{
    const tiled *t = data;
    const int32_t first = t->set->count < PRESELECTED ? t->set->count : PRESELECTED;
    for (int64_t n = part->first; n < part->end; n++) {
        asj_model m;
        const int32_t good = !asj_pairs_stop(t->set, part) && make(t, n, &m);
        const double score = good ? asj_score(t->set, first, &m.view, LOOSE, &t->scratch[part->thread].score) : -HUGE_VAL;
        t->order[n] = (asj_ranked){score, (int32_t)n};
    }
}

static void adjust_some(const void *data, const asj_part *part)
{
    const tiled *t = data;
    for (int64_t n = part->first; n < part->end; n++) {
        asj_model *m = &t->picked[n];
        m->evidence = -HUGE_VAL;
        if (!asj_pairs_stop(t->set, part)) {
            asj_adjust(t->set, m, ROUNDS, &t->scratch[part->thread]);
            m->evidence = asj_log_evidence(t->set, m, &t->scratch[part->thread]);
        }
        t->order[n] = (asj_ranked){m->evidence, (int32_t)n};
    }
}

/* Leaves those that differ in t->models, with the most evidence first; how many. */
static int32_t find_likely(const tiled *t)
{
    const int64_t all = count_all(t);
    const int32_t threads = t->context->threads;
    int32_t count = 0;
    asj_parallel(t->context, threads, all, 8, score_some, t);
    asj_sort(t->order, (size_t)all, sizeof *t->order, asj_by_score);
    for (int64_t k = 0; k < all && count < SHORT && t->order[k].score > -HUGE_VAL; k++)
        if (make(t, t->order[k].index, &t->models[count])) {
            t->order[count] = (asj_ranked){t->order[k].score, count};
            count++;
        }
    count = asj_pick(t->models, t->order, count, DISTINCT, t->picked);
    asj_parallel(t->context, threads, count, 1, adjust_some, t);
    asj_sort(t->order, (size_t)count, sizeof *t->order, asj_by_score);
    return asj_pick(t->picked, t->order, count, DISTINCT, t->models);
}

/* With which the pictures agree. e->first is the best motion. */
static int32_t keep_agreeing(asj_estimation *e, const tiled *t, int32_t count, asj_model *motions)
{
    int32_t kept = 0;
    for (int32_t k = 0; k < count && kept < ASJ_TILED && !asj_pairs_stop(t->set, NULL); k++) {
        const asj_model *m = &t->models[k];
        if (asj_estimation_log10_nfa(e, m) > log10(e->options->epsilon))
            break;
        if (asj_motions_apart(t->best, m) < OTHER_MOTION)
            continue;
        asj_compare_with(e, m);
        const asj_agreement *agreement = asj_agreement_of_other(e);
        if (agreement->share >= AGREES && agreement->known >= ASJ_LEAST_KNOWN)
            motions[kept++] = *m;
    }
    return kept;
}

static asj_status find(asj_estimation *e, tiled *t, asj_model *motions, int32_t *count)
{
    asj_memory *memory = &e->context->memory;
    uint8_t *seen = asj_allocate_zero(memory, (size_t)e->set.place_count[1], sizeof *seen);
    const int32_t has_rays = seen != NULL;
    for (int32_t k = 0; k < t->best->view.plane_count; k++)
        find_corners(t, k, &e->pictures->planes[k]);
    if (has_rays)
        find_rays(t, seen);
    asj_release(memory, seen);
    const size_t all = (size_t)count_all(t), room = all > SHORT ? all : SHORT;
    t->order = asj_allocate(memory, room, sizeof *t->order);
    t->models = asj_allocate(memory, SHORT, sizeof *t->models);
    t->picked = asj_allocate(memory, DISTINCT, sizeof *t->picked);
    t->scratch = asj_adjust_scratches_create(memory, &e->set, e->context->threads);
    if (!has_rays || !t->order || !t->models || !t->picked || !t->scratch)
        return asj_fail(e->context, ASJ_ERROR_MEMORY, "no memory for the motions that tiles allow");
    *count = keep_agreeing(e, t, find_likely(t), motions);
    return *count == 0 ? ASJ_OK : asj_refine_motions(e->context, &e->set, t->best->cameras, e->options->seed, 0, motions, count);
}

/* Do the pictures know something, and it is not this? */
static int32_t is_doubtful(asj_estimation *e, int32_t best)
{
    if (!e->pictures || e->pictures->of[0].channel_count < ASJ_MOST_CHANNELS || e->finalists[best].kind != ASJ_GEOMETRY_ESSENTIAL)
        return 0;
    asj_compare_from(e, best);
    return e->first.agreement.share < DOUBTFUL && e->first.agreement.known >= ASJ_LEAST_KNOWN;
}

asj_status asj_find_tiled_motions(asj_estimation *e, int32_t best, asj_model *motions, int32_t *count)
{
    asj_memory *memory = &e->context->memory;
    *count = 0;
    if (!is_doubtful(e, best))
        return ASJ_OK;
    tiled *t = asj_allocate_zero(memory, 1, sizeof *t);
    if (!t)
        return asj_fail(e->context, ASJ_ERROR_MEMORY, "no memory for the motions that tiles allow");
    t->context = e->context;
    t->set = &e->set;
    t->best = &e->finalists[best];
    const asj_status status = find(e, t, motions, count);
    asj_adjust_scratches_free(memory, t->scratch, e->context->threads);
    asj_release(memory, t->picked);
    asj_release(memory, t->models);
    asj_release(memory, t->order);
    asj_release(memory, t);
    return status;
}
