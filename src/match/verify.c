/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, last look: every match is asked whether the matches around it agree with it.
 *
 * The consensus asks for neighbours that agree, and where matches are many a false one finds some. What tells it then are the
 * many that do not. A true match lies on a surface whose other matches agree with it (asj_surface_agreement(); edges do not count
 * here, for what slides along them is what is looked for); where surfaces meet, its own side does. With a_k the agreement of the
 * k-th of the `verify_neighbours` nearest matches of image 1, and as many of image 2, at distance d_k there, and
 * w_k = 1 / (1 + d_k^2 / verify_distance^2),
 *
 *     (DOUBT / 2 + sum of w_k a_k) / (DOUBT + sum of w_k) >= verify_agreement
 *
 * has to hold: far witnesses stand on other surfaces, or perspective is no longer affine between them, so they say little, and
 * where nobody is near the match stays, as if DOUBT witnesses agreed by half. Witnesses are accepted matches, not candidates:
 * one for each place and hardly any of them false, so the share means what it says.
 *
 * T-junctions where one thing hides another need STEM times as much. Such a crossing slides over both things when the viewpoint
 * moves, everything within sight of it fits, and only corners nearby, which move with either the one or the other thing, tell
 * that no point of the scene is there. (Branches that go on beyond the location make a T: one of the two in one of the images.)
 *
 * Twice, the second time without the witnesses that the first round found false. */
#include "verify.h"
#include "agreement.h"

#define ROUNDS 2          /* a third one changes nothing */
#define MOST_WITNESSES 64 /* the option's maximum */
#define DOUBT 6.0         /* what a thing of its own has in corners; 3 or 10 trade right for wrong ones as verify_agreement does */
#define STEM 1.5          /* in rendered rooms 1.25 brings 55 right and 26 wrong ones, 2 costs 161 right and 38 wrong ones */

/* A choice as the witnesses see it. */
typedef struct spot {
    double x[2], y[2]; /* px, in either image */
    double needs;      /* agreement */
    int32_t stays;
} spot;

typedef struct trial {
    const asj_match_options *options;
    const asj_view *view1, *view2;
    const asj_candidates *candidates;
    const asj_choice *choices;
    spot *spots;
    size_t count;
} trial;

static void set_spot(const trial *t, size_t n)
{
    const asj_corners *corners1 = &t->view1->corners, *corners2 = &t->view2->corners;
    const asj_candidate *c = &t->candidates->list[t->choices[n].candidate];
    const asj_l_junction *l1 = &corners1->l[c->i], *l2 = &corners2->l[c->j];
    const int stem = corners1->stem[c->i] || corners2->stem[c->j];
    t->spots[n] = (spot){{(double)l1->x, (double)l2->x}, {(double)l1->y, (double)l2->y},
                         t->options->verify_agreement * (stem ? STEM : 1), 1};
}

/* The nearest choices farther than `separation` in one image, ties by number, and the squares of their distances. */
static uint32_t nearest(const trial *t, size_t self, int32_t side, uint32_t *witness, double *square)
{
    const double least = t->options->separation * t->options->separation;
    const uint32_t limit = (uint32_t)t->options->verify_neighbours;
    uint32_t found = 0;
    for (size_t n = 0; n < t->count; n++) {
        const double dx = t->spots[n].x[side] - t->spots[self].x[side], dy = t->spots[n].y[side] - t->spots[self].y[side];
        const double d = dx * dx + dy * dy;
        if (n == self || !t->spots[n].stays || d <= least || (found == limit && d >= square[found - 1]))
            continue;
        uint32_t k = found < limit ? found++ : limit - 1;
        for (; k > 0 && square[k - 1] > d; k--) {
            square[k] = square[k - 1];
            witness[k] = witness[k - 1];
        }
        square[k] = d;
        witness[k] = (uint32_t)n;
    }
    return found;
}

static double agreement(const trial *t, size_t self)
{
    const double reach = t->options->verify_distance * t->options->verify_distance;
    const asj_candidate *c = &t->candidates->list[t->choices[self].candidate];
    double sum = DOUBT / 2, asked = DOUBT;
    for (int32_t side = 0; side < 2; side++) {
        uint32_t witness[MOST_WITNESSES];
        double square[MOST_WITNESSES];
        const uint32_t found = nearest(t, self, side, witness, square);
        for (uint32_t k = 0; k < found; k++) {
            const asj_candidate *other = &t->candidates->list[t->choices[witness[k]].candidate];
            const double weight = 1 / (1 + square[k] / reach);
            const asj_way way = asj_way_between(t->view1, t->view2, c, other);
            sum += weight * (double)asj_surface_agreement(t->options, c, other, &way);
            asked += weight;
        }
    }
    return sum / asked;
}

asj_status asj_verify(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                      const asj_candidates *candidates, asj_choice *choices, size_t *count)
{
    if (options->verify_neighbours == 0 || *count == 0)
        return ASJ_OK;
    trial t = {options, view1, view2, candidates, choices, NULL, *count};
    t.spots = asj_allocate(&context->memory, *count, sizeof *t.spots);
    double *agreed = asj_allocate(&context->memory, *count, sizeof *agreed);
    if (!t.spots || !agreed) {
        asj_release(&context->memory, t.spots);
        asj_release(&context->memory, agreed);
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory to verify %zu matches", *count);
    }
    const int64_t all = (int64_t)*count;
#pragma omp parallel for num_threads(context->threads) schedule(static)
    for (int64_t n = 0; n < all; n++)
        set_spot(&t, (size_t)n);
    for (int round = 0; round < ROUNDS; round++) {
#pragma omp parallel for num_threads(context->threads) schedule(static)
        for (int64_t n = 0; n < all; n++)
            agreed[n] = agreement(&t, (size_t)n);
        for (int64_t n = 0; n < all; n++)
            t.spots[n].stays = agreed[n] >= t.spots[n].needs;
    }
    *count = 0;
    for (int64_t n = 0; n < all; n++)
        if (t.spots[n].stays)
            choices[(*count)++] = choices[n];
    asj_release(&context->memory, t.spots);
    asj_release(&context->memory, agreed);
    return ASJ_OK;
}
