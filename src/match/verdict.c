/* SPDX-License-Identifier: BSD-2-Clause */
/* An accepted geometry, and the matches.
 *
 *   - A match that is there already goes when an epipolar geometry contradicts it: a location farther from its line than
 *     asj_farthest_from_line(). Off the plane of a homography are other planes. And lines against which more matches speak than
 *     candidates for them are not believed. Where cameras are known they may be some px off, no farther: a match that is beyond
 *     ELSEWHERE is no reason against them, but one that a floor of tiles has by the period.
 *   - Whatever the geometry, a match goes when it is as good as impossible (1 - SURE_PROBABILITY) and a likely candidate
 *     (LEAST_PROBABILITY) gives one of its places another partner, more than ELSEWHERE px away. Things that repeat match by the
 *     period, all together, and nothing around says so.
 *   - A candidate comes when its probability is LEAST_PROBABILITY at least, and both its locations are free; where there are
 *     MANY_MATCHES already, only when it is SURE_PROBABILITY at least.
 *   - Newcomers go by the fundamental matrix of the matches that were there, too, where there is one (epipolar.c), no more than
 *     half of them went, and no cameras tell more; guests that newcomers propose go by it in any case.
 *   - Guests (guests.c) are no candidates, but matches as others are: contradicted ones go, and what the newcomers propose comes if
 *     the geometry does not contradict it.
 *
 * Each match receives its probability: that of the candidate; of guests, and beyond the likeliest candidates, which are all that a
 * geometry looks at (pairs.c), that under the geometry alone, where ASJ_MATCH_RIGHT of them are right before it, and of upsampled
 * images (upsampled.c) the larger one of both. It is 0 where a map keeps hardly any area. Counts of each rule:
 * tests/accuracy/tried/geometry.md, "Which matches go, and which come". */
#include "verdict.h"
#include "epipolar.h"
#include "geometry_candidate.h"
#include "geometry/geometry_options.h"
#include "locations.h"
#include "core/sort.h"

#include <math.h>

#define LEAST_PROBABILITY 0.5
#define SURE_PROBABILITY 0.99 /* of newcomers to photographs below it three of four are right, above it 45 of 47 */
#define MANY_MATCHES 20
#define ELSEWHERE 15.0 /* px: of matches that go by it none is right in rooms seen from far apart; at any distance most are */

/* --- candidates that the geometry makes likely ------------------------------------------------------------------------------- */

typedef struct likely {
    double probability;
    size_t index; /* in the wide list */
} likely;

/* LEAST_PROBABILITY at least, the likeliest first. */
typedef struct likely_list {
    likely *list;
    size_t count;
} likely_list;

static int likelier(const void *left, const void *right)
{
    const likely *p = left, *q = right;
    if (p->probability != q->probability)
        return p->probability > q->probability ? -1 : 1;
    return p->index < q->index ? -1 : p->index > q->index;
}

static void find_likely(const asj_wide_run *w, likely_list *all)
{
    for (size_t k = 0; k < w->run.candidates.count; k++)
        if (w->probability[k] >= LEAST_PROBABILITY)
            all->list[all->count++] = (likely){w->probability[k], k};
    if (all->count > 1)
        asj_sort(all->list, all->count, sizeof *all->list, likelier);
}

/* Does the geometry give a place of this match to another partner, elsewhere? */
static int32_t is_replaced(const asj_match_run *run, const asj_wide_run *w, const likely_list *all, const asj_candidate *c)
{
    const asj_geometry_candidate at = asj_candidate_for_geometry(run, c, 0);
    for (size_t n = 0; n < all->count; n++) {
        const asj_geometry_candidate *g = &w->given[all->list[n].index];
        const int32_t same1 = g->place1 == w->place[0][at.place1], same2 = g->place2 == w->place[1][at.place2];
        const double away = same1 ? hypot(g->x2 - at.x2, g->y2 - at.y2) : hypot(g->x1 - at.x1, g->y1 - at.y1);
        if (same1 != same2 && away > ELSEWHERE)
            return 1;
    }
    return 0;
}

/* --- matches that are there -------------------------------------------------------------------------------------------------- */

/* Of a match that is no candidate. */
static double probability_by_itself(const asj_match_run *run, const asj_candidate *c)
{
    const asj_geometry_candidate g = asj_candidate_for_geometry(run, c, ASJ_MATCH_RIGHT);
    return asj_keeps_area(c->map.to) ? asj_judge_probability(&run->judge, &g) : 0;
}

/* That of the same pair in the wide list, where it was looked at. */
static double probability_of(const asj_match_run *run, const asj_wide_run *w, const asj_candidate *c)
{
    const asj_candidates *wide = &w->run.candidates;
    const asj_candidate *found = asj_candidates_find(wide, c->i, c->j);
    const double probability = found ? w->probability[found - wide->list] : 0;
    return probability > 0 ? probability : probability_by_itself(run, c);
}

/* px */
static double off_line(const asj_match_run *run, const asj_candidate *c)
{
    const asj_geometry_candidate at = asj_candidate_for_geometry(run, c, 0);
    return asj_distance_from_line(&run->geometry, at.x1, at.y1, at.x2, at.y2);
}

static int32_t is_off_line(const asj_match_run *run, const asj_candidate *c)
{
    return off_line(run, c) > asj_farthest_from_line(run);
}

/* More candidates speak for them than matches against, as those of lenses do, and of cameras that are not quite what they are said
 * to be. */
static int32_t are_lines_believed(const asj_match_run *run)
{
    const double farthest = asj_farthest_from_line(run);
    const double most = asj_cameras_are_known(&run->options->geometry) ? fmax(ELSEWHERE, farthest) : HUGE_VAL;
    double against = 0;
    for (size_t n = 0; n < run->choices.count; n++) {
        const asj_candidate *c = asj_chosen(run, n);
        const double off = off_line(run, c);
        against += !asj_is_of_guests(run, c) && off > farthest && off <= most;
    }
    return against <= run->geometry.inliers;
}

static asj_status filter(asj_match_run *run, const asj_wide_run *w, const likely_list *all)
{
    asj_choices *choices = &run->choices, *rejected = &run->rejected;
    size_t kept = 0;
    rejected->list = asj_allocate(&run->context->memory, choices->count, sizeof *rejected->list);
    if (!rejected->list)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the geometry");
    run->lines_hold = are_lines_believed(run);
    for (size_t n = 0; n < choices->count; n++) {
        const asj_candidate *c = asj_chosen(run, n);
        const double probability = probability_of(run, w, c);
        asj_choice choice = choices->list[n];
        const int32_t hopeless = probability < 1 - SURE_PROBABILITY && asj_keeps_area(c->map.to);
        if ((run->lines_hold && is_off_line(run, c)) || (hopeless && is_replaced(run, w, all, c))) {
            rejected->list[rejected->count++] = choice;
        } else {
            choice.probability = (float)probability;
            choices->list[kept++] = choice;
        }
    }
    choices->count = kept;
    run->has_epipolar = run->has_epipolar && rejected->count <= kept;
    return ASJ_OK;
}

static int32_t was_rejected(const asj_match_run *run, const asj_candidate *c)
{
    for (size_t n = 0; n < run->rejected.count; n++) {
        const asj_candidate *gone = &run->candidates.list[run->rejected.list[n].candidate];
        if (gone->i == c->i && gone->j == c->j)
            return 1;
    }
    return 0;
}

void asj_judge_guests(asj_match_run *run, size_t first)
{
    asj_choices *choices = &run->choices;
    size_t kept = first;
    for (size_t n = first; n < choices->count; n++) {
        const asj_candidate *c = asj_chosen(run, n);
        if ((run->lines_hold && is_off_line(run, c)) || was_rejected(run, c))
            continue;
        choices->list[kept] = choices->list[n];
        choices->list[kept++].probability = (float)probability_by_itself(run, c);
    }
    choices->count = kept;
}

/* --- matches that come ------------------------------------------------------------------------------------------------------- */

/* The list of the geometry may have put a match that was off its line on it. */
static void forget_rejected(asj_match_run *run, const asj_candidate *c)
{
    asj_choices *rejected = &run->rejected;
    size_t kept = 0;
    for (size_t n = 0; n < rejected->count; n++) {
        const asj_candidate *gone = &run->candidates.list[rejected->list[n].candidate];
        if (gone->i != c->i || gone->j != c->j)
            rejected->list[kept++] = rejected->list[n];
    }
    rejected->count = kept;
}

static asj_status add(asj_match_run *run, const asj_candidate *c, double probability)
{
    asj_candidate copy = *c;
    forget_rejected(run, c);
    const asj_candidates one = {&copy, 1, 1};
    const size_t count = run->candidates.count;
    const asj_status status = asj_candidates_append(run->context, &run->candidates, &one);
    if (status == ASJ_OK)
        run->choices.list[run->choices.count++] = (asj_choice){(uint32_t)count, HUGE_VALF, (float)probability};
    return status;
}

/* The places nearer than `separation` to a guest's location: the same corner (same_corner.c). */
static void take_around(const asj_match_run *run, const asj_wide_run *w, int32_t side, uint32_t location, uint8_t *taken)
{
    const asj_l_junctions *in = &run->image[side]->l_junctions;
    const double x = in->location_x[location], y = in->location_y[location], far = run->options->separation;
    for (uint32_t q = asj_first_location(in, x - far); q < in->location_count && in->location_x[q] < x + far; q++) {
        const double dx = in->location_x[q] - x, dy = in->location_y[q] - y;
        if (dx * dx + dy * dy < far * far)
            taken[w->place[side][q]] = 1;
    }
}

/* taken: of each place in either image. */
static void take_places(const asj_match_run *run, const asj_wide_run *w, uint8_t *const taken[2])
{
    for (size_t n = 0; n < run->choices.count; n++) {
        const asj_candidate *c = asj_chosen(run, n);
        for (int32_t side = 0; side < 2; side++) {
            const uint32_t location = run->image[side]->l_junctions.location[asj_candidate_l(c, side)];
            taken[side][w->place[side][location]] = 1;
            if (asj_is_of_guests(run, c))
                take_around(run, w, side, location, taken[side]);
        }
    }
}

static asj_status rescue(asj_match_run *run, const asj_wide_run *w, const likely_list *all, uint8_t *const taken[2])
{
    const double least = run->choices.count < MANY_MATCHES ? LEAST_PROBABILITY : SURE_PROBABILITY;
    take_places(run, w, taken);
    for (size_t n = 0; n < all->count && all->list[n].probability >= least; n++) {
        const asj_geometry_candidate *g = &w->given[all->list[n].index];
        if (taken[0][g->place1] || taken[1][g->place2])
            continue;
        taken[0][g->place1] = taken[1][g->place2] = 1;
        const asj_status status = add(run, &w->run.candidates.list[all->list[n].index], all->list[n].probability);
        if (status != ASJ_OK)
            return status;
    }
    return ASJ_OK;
}

asj_status asj_apply_verdict(asj_match_run *run, const asj_wide_run *w)
{
    asj_memory *memory = &run->context->memory;
    likely_list all = {asj_allocate(memory, w->run.candidates.count, sizeof *all.list), 0};
    uint8_t *taken[2];
    for (int32_t side = 0; side < 2; side++)
        taken[side] = asj_allocate_zero(memory, run->image[side]->l_junctions.location_count, sizeof *taken[side]);
    asj_status status = all.list && taken[0] && taken[1] ? ASJ_OK
                                                         : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the geometry");
    if (status == ASJ_OK) {
        find_likely(w, &all);
        status = filter(run, w, &all);
    }
    const size_t before = run->choices.count;
    if (status == ASJ_OK)
        status = rescue(run, w, &all, taken);
    if (status == ASJ_OK && run->geometry.model != ASJ_GEOMETRY_ESSENTIAL)
        asj_drop_off_lines(run, before);
    asj_release(memory, taken[0]);
    asj_release(memory, taken[1]);
    asj_release(memory, all.list);
    return status;
}
