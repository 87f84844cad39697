/* SPDX-License-Identifier: BSD-2-Clause */
/* An accepted geometry, and the matches.
 *
 *   - A match that is there already goes when an epipolar geometry contradicts it: a location farther from its line than
 *     asj_farthest_from_line(). A homography contradicts nothing: there are other planes. And a geometry that contradicts more than
 *     half of the matches is not believed against them.
 *   - A candidate comes when its probability is LEAST_PROBABILITY at least, and both its locations are free; where there are
 *     MANY_MATCHES already, only when it is SURE_PROBABILITY at least. (On photographs that are none of the wide pairs three of
 *     four newcomers below that are right, and 45 of 47 above.)
 *   - Guests (guests.c) are no candidates, but matches as others are: contradicted ones go, and what the newcomers propose comes if
 *     the geometry does not contradict it.
 *
 * Each match receives its probability: that of the candidate; of guests that under the geometry, where GUEST_RIGHT of them are
 * right before it (962 of 1055 in rooms 101 to 140). It is 0 where a map keeps hardly any area, and beyond the likeliest
 * candidates, which are all that a geometry looks at (pairs.c). */
#include "verdict.h"
#include "geometry_candidate.h"

#include <math.h>
#include <stdlib.h>

#define LEAST_PROBABILITY 0.5
#define SURE_PROBABILITY 0.99
#define MANY_MATCHES 20
#define GUEST_RIGHT 0.9

/* --- matches that are there -------------------------------------------------------------------------------------------------- */

static int by_pair(const void *left, const void *right)
{
    const asj_candidate *p = left, *q = right;
    if (p->i != q->i)
        return p->i < q->i ? -1 : 1;
    return p->j < q->j ? -1 : p->j > q->j;
}

static double probability_of_guest(const asj_match_run *run, const asj_candidate *c)
{
    const asj_geometry_candidate g = asj_candidate_for_geometry(run, c, GUEST_RIGHT);
    return asj_keeps_area(c) ? asj_judge_probability(&run->judge, &g) : 0;
}

/* Of others that of the same pair in the wide list, 0 when it is not there. */
static double probability_of(const asj_match_run *run, const asj_wide_run *w, const asj_candidate *c)
{
    const asj_candidates *wide = &w->run.candidates;
    if (asj_is_of_guests(run, c))
        return probability_of_guest(run, c);
    const asj_candidate *found = wide->count ? bsearch(c, wide->list, wide->count, sizeof *c, by_pair) : NULL;
    return found ? w->probability[found - wide->list] : 0;
}

static const asj_candidate *chosen(const asj_match_run *run, size_t n)
{
    return &run->candidates.list[run->choices.list[n].candidate];
}

static int32_t is_off_line(const asj_match_run *run, const asj_candidate *c)
{
    const asj_geometry_candidate at = asj_candidate_for_geometry(run, c, 0);
    return asj_distance_from_line(&run->geometry, at.x1, at.y1, at.x2, at.y2) > asj_farthest_from_line(run);
}

static asj_status filter(asj_match_run *run, const asj_wide_run *w)
{
    asj_choices *choices = &run->choices, *rejected = &run->rejected;
    size_t against = 0, kept = 0;
    rejected->list = asj_allocate(&run->context->memory, choices->count, sizeof *rejected->list);
    if (!rejected->list)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the geometry");
    for (size_t n = 0; n < choices->count; n++)
        against += (size_t)is_off_line(run, chosen(run, n));
    run->lines_hold = 2 * against <= choices->count;
    for (size_t n = 0; n < choices->count; n++) {
        const asj_candidate *c = chosen(run, n);
        const asj_choice choice = choices->list[n];
        if (run->lines_hold && is_off_line(run, c)) {
            rejected->list[rejected->count++] = choice;
            continue;
        }
        choices->list[kept] = choice;
        choices->list[kept++].probability = (float)probability_of(run, w, c);
    }
    choices->count = kept;
    return ASJ_OK;
}

void asj_judge_guests(asj_match_run *run, size_t first)
{
    asj_choices *choices = &run->choices;
    size_t kept = first;
    for (size_t n = first; n < choices->count; n++) {
        const asj_candidate *c = chosen(run, n);
        if (run->lines_hold && is_off_line(run, c))
            continue;
        choices->list[kept] = choices->list[n];
        choices->list[kept++].probability = (float)probability_of_guest(run, c);
    }
    choices->count = kept;
}

/* --- matches that come ------------------------------------------------------------------------------------------------------- */

typedef struct newcomer {
    double probability;
    size_t index; /* in the wide list */
} newcomer;

static int likelier(const void *left, const void *right)
{
    const newcomer *p = left, *q = right;
    if (p->probability != q->probability)
        return p->probability > q->probability ? -1 : 1;
    return p->index < q->index ? -1 : p->index > q->index;
}

static asj_status add(asj_match_run *run, const asj_candidate *c, double probability)
{
    asj_candidate copy = *c;
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
        const asj_candidate *c = chosen(run, n);
        for (int32_t side = 0; side < 2; side++) {
            const uint32_t location = run->image[side]->l_junctions.location[asj_candidate_l(c, side)];
            taken[side][w->place[side][location]] = 1;
            if (asj_is_of_guests(run, c))
                take_around(run, w, side, location, taken[side]);
        }
    }
}

/* The likeliest first. list: room for all candidates. */
static asj_status rescue(asj_match_run *run, const asj_wide_run *w, newcomer *list, uint8_t *const taken[2])
{
    size_t count = 0;
    const double least = run->choices.count < MANY_MATCHES ? LEAST_PROBABILITY : SURE_PROBABILITY;
    take_places(run, w, taken);
    for (size_t k = 0; k < w->run.candidates.count; k++)
        if (w->probability[k] >= least)
            list[count++] = (newcomer){w->probability[k], k};
    if (count > 1)
        qsort(list, count, sizeof *list, likelier);
    for (size_t n = 0; n < count; n++) {
        const asj_geometry_candidate *g = &w->given[list[n].index];
        if (taken[0][g->place1] || taken[1][g->place2])
            continue;
        taken[0][g->place1] = taken[1][g->place2] = 1;
        const asj_status status = add(run, &w->run.candidates.list[list[n].index], list[n].probability);
        if (status != ASJ_OK)
            return status;
    }
    return ASJ_OK;
}

asj_status asj_apply_verdict(asj_match_run *run, const asj_wide_run *w)
{
    asj_memory *memory = &run->context->memory;
    newcomer *list = asj_allocate(memory, w->run.candidates.count, sizeof *list);
    uint8_t *taken[2];
    for (int32_t side = 0; side < 2; side++)
        taken[side] = asj_allocate_zero(memory, run->image[side]->l_junctions.location_count, sizeof *taken[side]);
    asj_status status = list && taken[0] && taken[1] ? ASJ_OK
                                                     : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the geometry");
    if (status == ASJ_OK)
        status = filter(run, w);
    if (status == ASJ_OK)
        status = rescue(run, w, list, taken);
    asj_release(memory, taken[0]);
    asj_release(memory, taken[1]);
    asj_release(memory, list);
    return status;
}
