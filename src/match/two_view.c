/* SPDX-License-Identifier: BSD-2-Clause */
/* Geometry decides what texture cannot.
 *
 * Seen from far apart, corners look like each other more than like themselves, and the ratio test leaves nothing. The right
 * partners are among the best WIDE_SHORTLIST, though. So all candidates of such a list, aligned and scored by support, go with
 * their priors (prior.c) to asj_geometry_estimate(), which finds what they have in common. Locations within CLUSTER px are one
 * place there.
 *
 * Where a geometry is accepted, and no other one contradicts it:
 *   - a match that is there already goes when an epipolar geometry contradicts it: a location farther from its line than FARTHEST
 *     px, or OF_SIDE of the longer side, since lenses bend lines in proportion to the image; twice as far for each octave where
 *     L-junctions of the image itself are few. Guests (guests.c) may lie no farther off than others: their places are known less
 *     well, but the alignment finds the same place in the other image as well as it does of others. (Rendered rooms and sixteen
 *     pairs of photographs with sides of up to 1600 px; epipolar.c asks the same.) A homography contradicts nothing: there are
 *     other planes. And a geometry that contradicts more than half of the matches is not believed against them;
 *   - a candidate comes when its probability is LEAST_PROBABILITY at least, and both its locations are free; where there are
 *     MANY_MATCHES already, only when it is SURE_PROBABILITY at least. (On photographs that are none of the wide pairs three of
 *     four newcomers below that are right, and 45 of 47 above.)
 * Each match receives its probability; so that there is one, the matches are among the candidates whatever their rank. It is 0
 * where a map keeps hardly any area, and beyond the likeliest candidates, which are all that a geometry looks at (pairs.c). */
#include "two_view.h"
#include "align.h"
#include "compare.h"
#include "consensus.h"
#include "geometry/estimate.h"
#include "prior.h"
#include "room_directions.h"
#include "shortlist.h"
#include "support.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define WIDE_SHORTLIST 16
#define CLUSTER 5.0    /* px */
#define FARTHEST 4.0   /* px, and .. */
#define OF_SIDE 0.0025 /* .. of the longer side */
#define LEAST_PROBABILITY 0.5
#define SURE_PROBABILITY 0.99
#define MANY_MATCHES 20

/* The longer list, and what the geometry says of it. */
typedef struct wide_run {
    asj_match_options options;
    asj_match_run run;
    asj_geometry_candidate *given;
    double *probability;
    double *colours;    /* how well those of each candidate agree */
    uint32_t *place[2]; /* of each location */
} wide_run;

/* The matches are candidates too, wherever they rank: guided ones (guided.c) stand in no list, and each needs its probability. */
static asj_status add_matches(const asj_match_run *run, wide_run *w)
{
    asj_memory *memory = &run->context->memory;
    asj_candidates matches = {asj_allocate_zero(memory, run->choices.count, sizeof *matches.list), 0, 0};
    if (!matches.list)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu matches", run->choices.count);
    for (; matches.count < run->choices.count; matches.count++) {
        const asj_candidate *c = &run->candidates.list[run->choices.list[matches.count].candidate];
        matches.list[matches.count].i = c->i;
        matches.list[matches.count].j = c->j;
    }
    asj_status status = asj_compare_and_drop(&w->run, &matches);
    if (status == ASJ_OK)
        status = asj_candidates_append(run->context, &w->run.candidates, &matches);
    if (status == ASJ_OK)
        asj_candidates_sort(&w->run.candidates);
    asj_release(memory, matches.list);
    return status;
}

static asj_status wide_candidates(const asj_match_run *run, wide_run *w)
{
    asj_status status = asj_shortlist(&w->run);
    if (status == ASJ_OK)
        status = add_matches(run, w);
    if (status == ASJ_OK && w->options.align_iterations > 0)
        status = asj_align_candidates(&w->run, 0);
    if (status == ASJ_OK)
        status = asj_support_find(&w->run);
    return status == ASJ_OK ? asj_consensus(&w->run) : status;
}

/* Locations come in order of x, so near ones are looked for backwards. Guests (guests.c) have no candidates here. */
static void cluster(const asj_l_junctions *in, uint32_t *place)
{
    for (uint32_t p = 0; p < in->location_count; p++) {
        place[p] = p;
        for (uint32_t q = p; q-- > 0 && in->location_x[p] - in->location_x[q] < CLUSTER;) {
            const double dx = in->location_x[p] - in->location_x[q], dy = in->location_y[p] - in->location_y[q];
            if (dx * dx + dy * dy < CLUSTER * CLUSTER && !asj_is_guest_location(in, q)) {
                place[p] = place[q];
                break;
            }
        }
    }
}

asj_geometry_candidate asj_candidate_for_geometry(const asj_match_run *run, const asj_candidate *c, double prior)
{
    const asj_l_junction *l1 = asj_match_run_l(run, c, 0), *l2 = asj_match_run_l(run, c, 1);
    const double *t = c->map.to;
    return (asj_geometry_candidate){
        run->image[0]->l_junctions.location[c->i], run->image[1]->l_junctions.location[c->j],
        (double)l1->x, (double)l1->y, (double)l2->x + c->move2[0] - (t[0] * c->move1[0] + t[1] * c->move1[1]),
        (double)l2->y + c->move2[1] - (t[2] * c->move1[0] + t[3] * c->move1[1]), {t[0], t[1], t[2], t[3]}, prior};
}

/* With the places of clusters. */
static asj_geometry_candidate clustered(const wide_run *w, const asj_candidate *c, double prior)
{
    asj_geometry_candidate g = asj_candidate_for_geometry(&w->run, c, prior);
    g.place1 = w->place[0][g.place1];
    g.place2 = w->place[1][g.place2];
    return g;
}

/* Sizes and, where both cameras are known, directions of both images, unless the caller gave some. */
static asj_status complete_options(asj_match_run *run, asj_geometry_options *options, asj_geometry_hints *hints)
{
    asj_status status = ASJ_OK;
    double given = 0;
    for (int32_t k = 0; k < 18; k++)
        given += fabs(options->directions[k / 9][k % 9]);
    for (int32_t side = 0; side < 2; side++) {
        options->widths[side] = run->image[side]->pyramid.width[0];
        options->heights[side] = run->image[side]->pyramid.height[0];
    }
    for (int32_t side = 0; side < 2 && given == 0 && status == ASJ_OK; side++)
        if (options->cameras[0].fx > 0 && options->cameras[1].fx > 0)
            status = asj_room_directions(run->context, run->image[side], &options->cameras[side], &hints->directions[side]);
    return status;
}

static asj_status estimate(asj_match_run *run, wide_run *w)
{
    asj_memory *memory = &run->context->memory;
    const size_t count = w->run.candidates.count;
    w->given = asj_allocate(memory, count, sizeof *w->given);
    w->probability = asj_allocate(memory, count, sizeof *w->probability);
    w->colours = asj_allocate(memory, count, sizeof *w->colours);
    for (int32_t side = 0; side < 2; side++)
        w->place[side] = asj_allocate(memory, run->image[side]->l_junctions.location_count, sizeof *w->place[side]);
    if (!w->given || !w->probability || !w->colours || !w->place[0] || !w->place[1])
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the geometry of %zu candidates", count);
    asj_geometry_options options = run->options->geometry;
    asj_geometry_hints hints = {.colours = NULL};
    asj_status status = asj_candidate_priors(&w->run, w->probability, w->colours);
    if (status == ASJ_OK)
        status = complete_options(run, &options, &hints);
    if (status != ASJ_OK)
        return status;
    for (int32_t side = 0; side < 2; side++)
        cluster(&run->image[side]->l_junctions, w->place[side]);
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) { /* a map that hardly keeps any area is no map */
        const asj_candidate *c = &w->run.candidates.list[k];
        if (!asj_keeps_area(c))
            continue;
        w->given[kept] = clustered(w, c, w->probability[k]);
        w->colours[kept] = w->colours[k];
        w->run.candidates.list[kept++] = *c;
    }
    w->run.candidates.count = kept;
    hints.colours = run->image[0]->colours && run->image[1]->colours ? w->colours : NULL;
    return asj_estimate_with_hints(run->context, w->given, kept, &hints, &options, w->probability, &run->geometry);
}

/* --- matches that are there -------------------------------------------------------------------------------------------------- */

int asj_keeps_area(const asj_candidate *c)
{
    const double *t = c->map.to, area = t[0] * t[3] - t[1] * t[2];
    return area > 1e-3 && area < 1e3;
}

double asj_distance_from_line(const asj_geometry *g, double x1, double y1, double x2, double y2)
{
    const double *f = g->matrix;
    const double n2x = f[0] * x1 + f[1] * y1 + f[2], n2y = f[3] * x1 + f[4] * y1 + f[5];
    const double n1x = f[0] * x2 + f[3] * y2 + f[6], n1y = f[1] * x2 + f[4] * y2 + f[7];
    const double e = fabs(x2 * n2x + y2 * n2y + f[6] * x1 + f[7] * y1 + f[8]);
    const double least = fmin(n1x * n1x + n1y * n1y, n2x * n2x + n2y * n2y);
    return g->model == ASJ_GEOMETRY_HOMOGRAPHY ? 0 : least > 0 ? e / sqrt(least) : HUGE_VAL;
}

double asj_farthest_from_line(const asj_match_run *run)
{
    double most = 0;
    for (int32_t side = 0; side < 2; side++) {
        const asj_image_features *image = run->image[side];
        const int32_t width = image->pyramid.width[0], height = image->pyramid.height[0];
        most = fmax(most, ldexp(fmax(FARTHEST, OF_SIDE * (width > height ? width : height)), image->l_junctions.home));
    }
    return most;
}

static int by_pair(const void *left, const void *right)
{
    const asj_candidate *p = left, *q = right;
    if (p->i != q->i)
        return p->i < q->i ? -1 : 1;
    return p->j < q->j ? -1 : p->j > q->j;
}

/* The probability of a match: that of the same pair in the wide list, 0 when it is not there. */
static double probability_of(const wide_run *w, const asj_candidate *c)
{
    const asj_candidates *wide = &w->run.candidates;
    const asj_candidate *found = wide->count ? bsearch(c, wide->list, wide->count, sizeof *c, by_pair) : NULL;
    return found ? w->probability[found - wide->list] : 0;
}

static asj_status filter(asj_match_run *run, const wide_run *w)
{
    asj_choices *choices = &run->choices, *rejected = &run->rejected;
    size_t against = 0, kept = 0;
    rejected->list = asj_allocate(&run->context->memory, choices->count, sizeof *rejected->list);
    if (!rejected->list)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the geometry");
    for (int32_t pass = 0; pass < 2; pass++) {
        for (size_t n = 0; n < choices->count; n++) {
            const asj_candidate *c = &run->candidates.list[choices->list[n].candidate];
            const asj_geometry_candidate at = clustered(w, c, 0);
            const double off = asj_distance_from_line(&run->geometry, at.x1, at.y1, at.x2, at.y2);
            const int32_t far = off > asj_farthest_from_line(run);
            if (pass == 0) {
                against += (size_t)far;
            } else if (!far || 2 * against > choices->count) {
                choices->list[kept] = choices->list[n];
                choices->list[kept++].probability = (float)probability_of(w, c);
            } else {
                rejected->list[rejected->count++] = choices->list[n];
            }
        }
    }
    choices->count = kept;
    return ASJ_OK;
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
    void *list = run->candidates.list;
    const size_t count = run->candidates.count;
    const asj_status status = asj_grow(&run->context->memory, &list, &run->candidates.capacity, count + 1, sizeof *c, count);
    if (status != ASJ_OK)
        return asj_fail(run->context, status, "no memory for matches of the geometry");
    run->candidates.list = list;
    run->candidates.list[count] = *c;
    run->choices.list[run->choices.count++] = (asj_choice){(uint32_t)count, HUGE_VALF, (float)probability};
    run->candidates.count++;
    return ASJ_OK;
}

/* taken: of each place in either image. The likeliest first. */
static asj_status rescue(asj_match_run *run, const wide_run *w, newcomer *list, uint8_t *const taken[2])
{
    size_t count = 0;
    const double least = run->choices.count < MANY_MATCHES ? LEAST_PROBABILITY : SURE_PROBABILITY;
    for (size_t n = 0; n < run->choices.count; n++) {
        const asj_candidate *c = &run->candidates.list[run->choices.list[n].candidate];
        for (int32_t side = 0; side < 2; side++)
            taken[side][w->place[side][run->image[side]->l_junctions.location[asj_candidate_l(c, side)]]] = 1;
    }
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

static asj_status apply(asj_match_run *run, const wide_run *w)
{
    asj_memory *memory = &run->context->memory;
    newcomer *list = asj_allocate(memory, w->run.candidates.count, sizeof *list);
    uint8_t *taken[2];
    for (int32_t side = 0; side < 2; side++)
        taken[side] = asj_allocate_zero(memory, run->image[side]->l_junctions.location_count, sizeof *taken[side]);
    asj_status status = list && taken[0] && taken[1] ? ASJ_OK
                                                     : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the geometry");
    if (status == ASJ_OK) {
        status = filter(run, w);
        if (status == ASJ_OK)
            status = rescue(run, w, list, taken);
    }
    asj_release(memory, taken[0]);
    asj_release(memory, taken[1]);
    asj_release(memory, list);
    return status;
}

asj_status asj_apply_geometry(asj_match_run *run)
{
    if (run->options->geometry.model == ASJ_GEOMETRY_NONE)
        return ASJ_OK;
    asj_memory *memory = &run->context->memory;
    wide_run w = {.options = *run->options};
    w.options.shortlist = w.options.shortlist > WIDE_SHORTLIST ? w.options.shortlist : WIDE_SHORTLIST;
    w.run = (asj_match_run){.context = run->context, .options = &w.options, .image = {run->image[0], run->image[1]}};
    asj_status status = wide_candidates(run, &w);
    if (status == ASJ_OK)
        status = estimate(run, &w);
    if (status == ASJ_OK && run->geometry.status == ASJ_GEOMETRY_ACCEPTED)
        status = apply(run, &w);
    asj_release(memory, w.run.candidates.list);
    asj_support_free(memory, &w.run.support);
    asj_release(memory, w.given);
    asj_release(memory, w.probability);
    asj_release(memory, w.colours);
    asj_release(memory, w.place[0]);
    asj_release(memory, w.place[1]);
    return status;
}
