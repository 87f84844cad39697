/* SPDX-License-Identifier: BSD-2-Clause */
/* Random sampling (Fischler and Bolles 1981) with a prior, a score in place of a count, and refinement of the best few.
 *
 * Samples are drawn in proportion to the candidates' priors, at different places of both images. They are scored on the likeliest
 * PRESELECTED candidates with standard deviations doubled, since two candidates place a geometry roughly only; the best SHORT of
 * them on all candidates; and the best of these that differ are refined a little. What they make likely is then sampled in its
 * turn, AROUND times ("local optimisation", Chum, Matas and Kittler 2003). Where the best of the first ones is as poor as in images
 * that have nothing in common, nothing more is looked for. Sample n draws its numbers from stream n, so that threads change
 * nothing. Before rivals were looked for by themselves (rivals.c), fewer STARTS and CENTRES missed them: of unrelated rooms with
 * tiled floors, one in 29 was accepted with 8 and 4. With rivals looked for, the search of rivals itself does with the BRIEF ones:
 * 189 pairs, two seeds (tests/benchmark/tried.md). AROUND 1, LOCAL 20, FEW_ROUNDS 2, or no second round where the first one finds
 * nothing better, lose poses in the first search. */
#include "search.h"
#include "core/angle.h"
#include "core/sort.h"
#include "core/threads.h"
#include "counter_random.h"
#include "evidence.h"
#include "labels.h"
#include "manhattan.h"
#include "minimal.h"
#include "ranking.h"
#include "small_matrix.h"
#include "stop.h"
#include "turned.h"

#include <math.h>
#include <string.h>

#define PRESELECTED 600
#define SHORT 50
#define STARTS 16
#define CENTRES 10
#define LOCAL 40
#define AROUND 2
#define BRIEF_STARTS 8
#define BRIEF_CENTRES 5
#define BRIEF_AROUND 1
#define WIDEST 3.0
#define FEW_ROUNDS 3
#define ROUNDS 5
#define LAST_ROUNDS 12 /* of fundamental matrices, which nothing refines after this: with 5, of two that explain 259 matches as well
                        * (glasscaseb), the last digits of samples decided which was told */
#define LOOSE 2.0
#define TRIES 20
#define FLAT_SAMPLES 2
#define TURNED 16
#define LIKELIEST 4 /* rotations, by labels: one near the true one is among them in 46 of 47 pairs of rooms 200 to 310 */
#define KNOWN_TURN (10 * ASJ_DEGREE)

/* --- samples ----------------------------------------------------------------------------------------------------------------- */

/* The candidate at which the sum of priors passes `target`. */
static const asj_pair *draw(const asj_pairs *set, const double *sum, int32_t count, double target)
{
    int32_t low = 0, high = count - 1;
    while (low < high) {
        const int32_t middle = (low + high) / 2;
        if (sum[middle] > target)
            high = middle;
        else
            low = middle + 1;
    }
    return &set->list[low];
}

/* Candidates of different places, drawn by the running sums, that labels do not speak against with this rotation (NULL: any);
 * 0 when none were found. */
static int32_t draw_some(const asj_pairs *set, const double *sum, int32_t count, uint64_t seed, uint64_t stream, int32_t wanted,
                         const asj_likely_rotation *rotation, const asj_pair **pairs)
{
    int32_t found = 0;
    for (int32_t number = 0; number < TRIES && found < wanted; number++) {
        const asj_pair *c = draw(set, sum, count, asj_counter_random(seed, stream, (uint64_t)number) * sum[count - 1]);
        int32_t fresh = !rotation || !set->has_labels || asj_label_ratio(rotation, c) >= 1;
        for (int32_t k = 0; k < found; k++)
            fresh = fresh && pairs[k]->place1 != c->place1 && pairs[k]->place2 != c->place2;
        if (fresh)
            pairs[found++] = c;
    }
    return found == wanted;
}

/* A fundamental matrix from two candidates and a guess of the focal length: three of them in turn, a factor of 1.4 apart. */
static int32_t guess(const asj_pairs *set, const asj_pair *const pairs[2], const asj_search *search, uint64_t stream,
                     asj_model *model)
{
    static const double factor[3] = {1, 0.71, 1.41};
    asj_camera cameras[2] = {search->cameras[0], search->cameras[1]};
    for (int32_t v = 0; v < 2; v++) {
        cameras[v].fx *= factor[stream % 3];
        cameras[v].fy *= factor[stream % 3];
    }
    if (!asj_essential_from_two(set, pairs, cameras, model))
        return 0;
    model->kind = ASJ_GEOMETRY_FUNDAMENTAL;
    model->parameters = 7;
    model->view.has_motion = 0; /* its cameras are a guess */
    memcpy(model->cameras, search->cameras, sizeof model->cameras);
    return 1;
}

/* Which of the set's rotations a sample has: `near`, or -1: one of its own choice. Where labels tell the likeliest ones, every
 * other one is one of these. -1: its candidates tell the rotation, too. */
static int32_t rotation_of(const asj_pairs *set, const asj_search *search, const asj_turned *turned, int32_t near, uint64_t stream)
{
    const int32_t known = turned ? turned->count > 0 : near >= 0;
    const uint64_t number = stream / 2, all = (uint64_t)set->rotation_count;
    if (search->kind != ASJ_GEOMETRY_ESSENTIAL || !known || stream % 2 == 0)
        return -1;
    if (near >= 0)
        return near;
    if (set->has_labels)
        return (int32_t)(number / 2 % (number % 2 == 0 && all > LIKELIEST ? LIKELIEST : all));
    return (int32_t)(number % all);
}

/* turned: NULL in samples around a geometry with the rotation `near` (-1: not known). */
static int32_t sample(const asj_pairs *set, const double *sum, int32_t count, const asj_search *search, const asj_turned *turned,
                      int32_t near, uint64_t stream, asj_model *model)
{
    const asj_pair *pairs[3];
    const int32_t turn = rotation_of(set, search, turned, near, stream);
    const asj_likely_rotation *rotation = turn >= 0 ? &set->rotations[turn] : NULL;
    const int32_t by_three = search->kind == ASJ_GEOMETRY_FUNDAMENTAL && stream % 4 == 3;
    const int32_t wanted = turned && rotation ? 1 : by_three ? 3 : 2;
    if (!(sum[count - 1] > 0) || !draw_some(set, sum, count, search->seed, stream, wanted, rotation, pairs))
        return 0;
    if (turned && rotation)
        return asj_translation_by_vote(set, turned, turn, pairs[0], search->cameras, model);
    if (rotation)
        return asj_translation_from_two(pairs, rotation->matrix, search->cameras, model);
    if (search->kind == ASJ_GEOMETRY_ESSENTIAL)
        return asj_essential_from_two(set, pairs, search->cameras, model);
    if (search->kind == ASJ_GEOMETRY_HOMOGRAPHY)
        return asj_homography_from_two(set, pairs, search->cameras, model);
    return wanted == 3 ? asj_fundamental_from_three(pairs, search->cameras, model) : guess(set, pairs, search, stream, model);
}

/* Those of homographies cost least, and most of them are given up at once. */
static int32_t samples_of(const asj_search *search)
{
    return search->kind == ASJ_GEOMETRY_HOMOGRAPHY ? FLAT_SAMPLES * search->samples : search->samples;
}

/* --- all of it --------------------------------------------------------------------------------------------------------------- */

typedef struct work {
    asj_context *context;
    asj_model *models, *starts;
    asj_ranked *order;
    double *sum;
    asj_turned turned;           /* count 0: no rotation is likely */
    asj_adjust_scratch *scratch; /* for each thread */
} work;

/* run_turned() has a model for each rotation in the room of those around CENTRES. */
typedef char rotations_fit[ASJ_MOST_ROTATIONS <= CENTRES * (LOCAL + 1) ? 1 : -1];

/* What a loop over samples or models works on. */
typedef struct job {
    const asj_pairs *set;
    const asj_search *search;
    work *w;
    asj_model *models;
    int32_t first, count, rounds;
    const double *except; /* a rotation near which none is looked for; NULL: everywhere */
} job;

/* Sample n, made again whenever it is wanted: keeping all of them would take more time. */
static void sample_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++) {
        asj_model m = {.kind = ASJ_GEOMETRY_NONE};
        const int32_t good =
            !asj_pairs_stop(j->set, part) && sample(j->set, j->w->sum, j->first, j->search, &j->w->turned, -1, (uint64_t)n, &m);
        const double score = good ? asj_score(j->set, j->first, &m.view, LOOSE, &j->w->scratch[part->thread].score) : -HUGE_VAL;
        j->w->order[n] = (asj_ranked){score, (int32_t)n};
    }
}

/* The best samples, now by all pairs. */
static void score_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++) {
        asj_ranked *r = &j->w->order[n];
        asj_model *m = &j->models[n];
        memset(m, 0, sizeof *m);
        if (r->score > -HUGE_VAL && !asj_pairs_stop(j->set, part) &&
            sample(j->set, j->w->sum, j->first, j->search, &j->w->turned, -1, (uint64_t)r->index, m))
            r->score = asj_score(j->set, j->set->count, &m->view, LOOSE, &j->w->scratch[part->thread].score);
        r->index = (int32_t)n;
    }
}

static void set_sums(const asj_pairs *set, const asj_search *search, int32_t count, double *sum)
{
    for (int32_t k = 0; k < count; k++)
        sum[k] = (k > 0 ? sum[k - 1] : 0) + set->list[k].prior * (search->weights ? search->weights[k] : 1);
}

/* Leaves the best in w->models, in the order of w->order; how many. */
static int32_t draw_samples(const asj_pairs *set, const asj_search *search, work *w)
{
    const int32_t first = set->count < PRESELECTED ? set->count : PRESELECTED, samples = samples_of(search);
    const int32_t most = samples < SHORT ? samples : SHORT;
    set_sums(set, search, first, w->sum);
    const job j = {.set = set, .search = search, .w = w, .models = w->models, .first = first};
    asj_parallel(w->context, w->context->threads, samples, 8, sample_some, &j);
    asj_sort(w->order, (size_t)samples, sizeof *w->order, asj_by_score);
    asj_parallel(w->context, w->context->threads, most, 4, score_some, &j);
    asj_sort(w->order, (size_t)most, sizeof *w->order, asj_by_score);
    return most;
}

static void sample_around(const void *data, const asj_part *part)
{
    const job *j = data;
    const int32_t first = j->first;
    asj_adjust_scratch *scratch = &j->w->scratch[part->thread];
    double *sum = scratch->probability;
    for (int64_t n = part->first; n < part->end; n++) {
        double w[3];
        const int32_t has_rotation = j->models[n].kind == ASJ_GEOMETRY_ESSENTIAL;
        const int32_t near = has_rotation ? asj_nearest_rotation(j->set, j->models[n].rotation, w) : -1;
        asj_probabilities(j->set, &j->models[n].view, WIDEST, &scratch->score, sum);
        for (int32_t k = 1; k < first; k++)
            sum[k] += sum[k - 1];
        for (int64_t k = 0; k < LOCAL; k++) {
            asj_model *m = &j->models[j->count + n * LOCAL + k];
            const uint64_t stream = ((uint64_t)j->rounds + 1) << 32 | (uint64_t)(n * LOCAL + k);
            const int32_t good = !asj_pairs_stop(j->set, part) && sample(j->set, sum, first, j->search, NULL, near, stream, m);
            m->score = good ? asj_score(j->set, first, &m->view, LOOSE, &scratch->score) : -HUGE_VAL;
        }
    }
}

/* Samples once more, from what each of the `count` models makes likely: LOCAL of them each, behind the models. Returns how many
 * there are then. */
static int32_t draw_around(const asj_pairs *set, const asj_search *search, work *w, asj_model *models, int32_t count,
                           int32_t round)
{
    const int32_t first = set->count < PRESELECTED ? set->count : PRESELECTED;
    const job j = {set, search, w, models, first, count, round, NULL};
    asj_parallel(w->context, w->context->threads, count, 1, sample_around, &j);
    for (int32_t n = 0; n < count; n++) /* in the same measure as the samples */
        models[n].score = asj_score(set, first, &models[n].view, LOOSE, &w->scratch[0].score);
    return count * (LOCAL + 1);
}

static void adjust_each(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++) {
        if (!asj_pairs_stop(j->set, part))
            asj_adjust(j->set, &j->models[n], j->rounds, &j->w->scratch[part->thread]);
        j->w->order[n] = (asj_ranked){j->models[n].score, (int32_t)n};
    }
}

/* Refines models in so many rounds and leaves the `most` best ones that differ in `finalists`. */
static int32_t adjust_some(const asj_pairs *set, work *w, asj_model *models, int32_t count, int32_t rounds, int32_t most,
                           asj_model *finalists)
{
    const job j = {.set = set, .w = w, .models = models, .rounds = rounds};
    asj_parallel(w->context, w->context->threads, count, 1, adjust_each, &j);
    asj_sort(w->order, (size_t)count, sizeof *w->order, asj_by_score);
    return asj_pick(models, w->order, count, most, finalists);
}

static void judge_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++) {
        j->models[n].evidence = asj_pairs_stop(j->set, part)
                                    ? -HUGE_VAL : asj_log_evidence(j->set, &j->models[n], &j->w->scratch[part->thread]);
        j->w->order[n] = (asj_ranked){j->models[n].evidence, (int32_t)n};
    }
}

static void judge(const asj_pairs *set, work *w, asj_model *finalists, int32_t count)
{
    asj_model copy[ASJ_FINALISTS];
    const job j = {.set = set, .w = w, .models = finalists};
    asj_parallel(w->context, w->context->threads, count, 1, judge_some, &j);
    asj_sort(w->order, (size_t)count, sizeof *w->order, asj_by_score);
    memcpy(copy, finalists, sizeof copy);
    for (int32_t n = 0; n < count; n++)
        finalists[n] = copy[w->order[n].index];
}

static int32_t run(const asj_pairs *set, const asj_search *search, work *w, asj_model *finalists)
{
    const int32_t starts = search->brief ? BRIEF_STARTS : STARTS, centres = search->brief ? BRIEF_CENTRES : CENTRES;
    int32_t count = draw_samples(set, search, w);
    count = asj_pick(w->models, w->order, count, starts, w->starts);
    count = adjust_some(set, w, w->starts, count, FEW_ROUNDS, centres, w->models);
    if (count == 0 || w->models[0].score < search->least)
        return 0;
    for (int32_t round = 0; round < (search->brief ? BRIEF_AROUND : AROUND); round++) {
        count = draw_around(set, search, w, w->models, count < centres ? count : centres, round);
        for (int32_t n = 0; n < count; n++)
            w->order[n] = (asj_ranked){w->models[n].score, n};
        asj_sort(w->order, (size_t)count, sizeof *w->order, asj_by_score);
        count = asj_pick(w->models, w->order, count, starts, w->starts);
        count = adjust_some(set, w, w->starts, count, FEW_ROUNDS, ASJ_FINALISTS, w->models);
    }
    const int32_t rounds = search->kind == ASJ_GEOMETRY_FUNDAMENTAL ? LAST_ROUNDS : ROUNDS;
    count = adjust_some(set, w, w->models, count, rounds, ASJ_FINALISTS, finalists);
    judge(set, w, finalists, count);
    return count;
}

static int32_t are_near(const double a[9], const double b[9])
{
    return asj_dot3(a, b) + asj_dot3(a + 3, b + 3) + asj_dot3(a + 6, b + 6) > 1 + 2 * cos(KNOWN_TURN);
}

/* For every rotation the best of TURNED samples, in w->models; -HUGE_VAL where there is none. */
static void turn_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t r = part->first; r < part->end; r++) {
        asj_model *best = &j->models[r];
        best->score = -HUGE_VAL;
        const int32_t known = j->except && are_near(j->except, j->set->rotations[r].matrix);
        for (int64_t k = 0; k < TURNED && !known && !asj_pairs_stop(j->set, part); k++) {
            asj_model m = {.kind = ASJ_GEOMETRY_NONE};
            const uint64_t stream = (uint64_t)(2 * (j->set->rotation_count * k + r) + 1);
            if (!sample(j->set, j->w->sum, j->first, j->search, &j->w->turned, (int32_t)r, stream, &m))
                continue;
            m.score = asj_score(j->set, j->first, &m.view, LOOSE, &j->w->scratch[part->thread].score);
            if (m.score > best->score)
                *best = m;
        }
        j->w->order[r] = (asj_ranked){best->score, (int32_t)r};
    }
}

static int32_t run_turned(const asj_pairs *set, const asj_search *search, work *w, const double *except, asj_model *finalists)
{
    const int32_t first = w->turned.count;
    set_sums(set, search, first, w->sum);
    const job j = {.set = set, .search = search, .w = w, .models = w->models, .first = first, .except = except};
    asj_parallel(w->context, w->context->threads, set->rotation_count, 1, turn_some, &j);
    asj_sort(w->order, (size_t)set->rotation_count, sizeof *w->order, asj_by_score);
    const int32_t count = asj_pick(w->models, w->order, set->rotation_count, ASJ_TURNED, w->starts);
    return adjust_some(set, w, w->starts, count, ROUNDS, ASJ_TURNED, finalists);
}

static asj_status search_some(asj_context *context, const asj_pairs *set, const asj_search *search, int32_t turned,
                              const double *except, asj_model *finalists, int32_t *count)
{
    asj_memory *memory = &context->memory;
    const int32_t threads = context->threads;
    work w = {.context = context};
    *count = 0;
    const size_t around = CENTRES * (LOCAL + 1), room = around > SHORT ? around : SHORT;
    const size_t samples = (size_t)samples_of(search) > room ? (size_t)samples_of(search) : room;
    w.models = asj_allocate_zero(memory, room, sizeof *w.models);
    w.starts = asj_allocate_zero(memory, STARTS, sizeof *w.starts);
    w.order = asj_allocate(memory, samples, sizeof *w.order);
    w.sum = asj_allocate(memory, PRESELECTED, sizeof *w.sum);
    w.scratch = asj_adjust_scratches_create(memory, set, threads);
    int32_t good = w.models && w.starts && w.order && w.sum && w.scratch;
    if (search->kind == ASJ_GEOMETRY_ESSENTIAL && set->rotation_count > 0 && good)
        good = asj_turned_create(memory, set, set->count < PRESELECTED ? set->count : PRESELECTED, search->weights, search->cameras,
                                 &w.turned);
    if (good && set->count >= 2)
        *count = turned ? run_turned(set, search, &w, except, finalists) : run(set, search, &w, finalists);
    asj_adjust_scratches_free(memory, w.scratch, threads);
    asj_turned_free(memory, &w.turned);
    asj_release(memory, w.sum);
    asj_release(memory, w.order);
    asj_release(memory, w.starts);
    asj_release(memory, w.models);
    return good ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the geometry of %d candidates", (int)set->count);
}

asj_status asj_geometry_search(asj_context *context, const asj_pairs *set, const asj_search *search, asj_model *finalists,
                               int32_t *count)
{
    return search_some(context, set, search, 0, NULL, finalists, count);
}

asj_status asj_geometry_search_turned(asj_context *context, const asj_pairs *set, const asj_search *search, const double *except,
                                      asj_model *finalists, int32_t *count)
{
    return search_some(context, set, search, 1, except, finalists, count);
}
