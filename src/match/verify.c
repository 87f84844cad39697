/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, last test: every match is judged by the matches around it.
 *
 * The consensus asks for neighbours that agree, and where matches are many a false one finds some; the many that do not agree
 * tell. A true match lies on a surface whose other matches agree with it (asj_surface_agreement(); edges do not count, because
 * this test is for what slides along them); where surfaces meet, its own side does. With a_k the agreement of the k-th of the
 * `verify_neighbours` nearest matches of image 1, and as many of image 2, at distance d_k there, and
 * w_k = 1 / (1 + d_k^2 / verify_distance^2), a match stays when
 *
 *     (P / 2 + sum of w_k a_k) / (P + sum of w_k) >= verify_agreement,     P = PRIOR_NEIGHBOURS.
 *
 * Far neighbours stand on other surfaces, or perspective is no longer affine between them, so they say little; where nobody is
 * near the match stays, as if P neighbours agreed by half. Neighbours are accepted matches, not candidates: one for each
 * location, and hardly any of them false, so that the share means what it says.
 *
 * T-junctions where one thing hides another need T_FACTOR times as much. Such a crossing slides over both things when the
 * viewpoint moves, everything within sight of it fits, and only corners nearby, which move with either the one or the other
 * thing, tell that no point of the scene is there. (Branches that go on beyond the location make a T: one of the two in one of the
 * images.)
 *
 * Two rounds, the second one without the matches that the first one found false. */
#include "verify.h"
#include "agreement.h"
#include "nearest.h"
#include "core/watch.h"

#define LEAST_MATCHES 8      /* for a thread */
#define ROUNDS 2             /* a third one changes nothing */
#define PRIOR_NEIGHBOURS 6.0 /* corners of a thing of its own; 3 or 10 trade right for wrong ones as verify_agreement does */
#define T_FACTOR 1.5         /* in rendered rooms 1.25 brings 55 right and 26 wrong ones, 2 costs 161 right and 38 wrong ones */

/* A choice as the others see it. */
typedef struct suspect {
    double x[2], y[2]; /* px, in either image */
    double needs;      /* agreement */
    int32_t stays;
} suspect;

typedef struct trial {
    const asj_match_run *run;
    suspect *suspects; /* as many as choices */
    double *agreed;
    asj_watch *watch;
    size_t fixed; /* as many choices, the first ones, stay; if there are any the others are judged by these alone */
} trial;

static const asj_candidate *candidate_of(const trial *t, size_t n)
{
    return &t->run->candidates.list[t->run->choices.list[n].candidate];
}

static suspect suspect_of(const trial *t, size_t n)
{
    const asj_candidate *c = candidate_of(t, n);
    const asj_l_junction *l1 = asj_match_run_l(t->run, c, 0), *l2 = asj_match_run_l(t->run, c, 1);
    const int is_t = t->run->image[0]->l_junctions.t_junction[c->i] || t->run->image[1]->l_junctions.t_junction[c->j];
    return (suspect){{(double)l1->x, (double)l2->x}, {(double)l1->y, (double)l2->y},
                     t->run->options->verify_agreement * (is_t ? T_FACTOR : 1), 1};
}

/* The nearest choices farther than `separation` in one image, ties by number. */
static void find_nearest(const trial *t, size_t self, int32_t side, asj_nearest *nearest)
{
    const suspect *all = t->suspects;
    const double least = t->run->options->separation * t->run->options->separation;
    const size_t asked = t->fixed ? t->fixed : t->run->choices.count;
    for (size_t n = 0; n < asked; n++) {
        const double dx = all[n].x[side] - all[self].x[side], dy = all[n].y[side] - all[self].y[side];
        const double square = dx * dx + dy * dy;
        if (n != self && all[n].stays && square > least)
            asj_nearest_offer(nearest, (uint32_t)n, square);
    }
}

static double agreement(const trial *t, size_t self)
{
    const asj_match_options *options = t->run->options;
    const double reach = options->verify_distance * options->verify_distance;
    const asj_candidate *c = candidate_of(t, self);
    double sum = PRIOR_NEIGHBOURS / 2, asked = PRIOR_NEIGHBOURS;
    for (int32_t side = 0; side < 2; side++) {
        uint32_t neighbour[ASJ_NEAREST_MOST];
        asj_nearest nearest = {.limit = (uint32_t)options->verify_neighbours, .index = neighbour};
        find_nearest(t, self, side, &nearest);
        for (uint32_t k = 0; k < nearest.count; k++) {
            const asj_candidate *other = candidate_of(t, neighbour[k]);
            const double weight = 1 / (1 + nearest.square[k] / reach);
            const asj_way way = asj_way_between(t->run, c, other);
            sum += weight * (double)asj_surface_agreement(options, c, other, &way);
            asked += weight;
        }
    }
    return sum / asked;
}

static void agree_some(const void *data, const asj_part *part)
{
    const trial *t = data;
    for (int64_t n = part->first; n < part->end && !asj_watch_stops(t->watch, part); n++) {
        const size_t self = t->fixed + (size_t)n;
        t->agreed[self] = agreement(t, self);
    }
}

static asj_status try_all(const trial *t)
{
    const size_t all = t->run->choices.count;
    const int64_t count = (int64_t)(all - t->fixed);
    for (size_t n = 0; n < all; n++)
        t->suspects[n] = suspect_of(t, n);
    asj_watch_start(t->watch, t->run->context, ASJ_STAGE_ASSIGN);
    for (int round = 0; round < ROUNDS && !t->watch->stopped; round++) {
        asj_parallel(t->run->context, asj_threads_for(t->run->context, count, LEAST_MATCHES), count, 0, agree_some, t);
        for (size_t n = t->fixed; n < all; n++)
            t->suspects[n].stays = t->agreed[n] >= t->suspects[n].needs;
    }
    return asj_watch_end(t->watch);
}

asj_status asj_verify(asj_match_run *run, size_t fixed)
{
    asj_choices *choices = &run->choices;
    const size_t all = choices->count;
    if (run->options->verify_neighbours == 0 || all == fixed)
        return ASJ_OK;
    asj_memory *memory = &run->context->memory;
    asj_watch watch;
    const trial t = {run, asj_allocate(memory, all, sizeof *t.suspects), asj_allocate(memory, all, sizeof *t.agreed), &watch,
                     fixed};
    asj_status status = ASJ_OK;
    if (!t.suspects || !t.agreed) {
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to verify %zu matches", all);
    } else {
        status = try_all(&t);
        choices->count = 0;
        for (size_t n = 0; status == ASJ_OK && n < all; n++)
            if (t.suspects[n].stays)
                choices->list[choices->count++] = choices->list[n];
    }
    asj_release(memory, t.suspects);
    asj_release(memory, t.agreed);
    return status;
}
