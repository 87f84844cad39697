/* SPDX-License-Identifier: BSD-2-Clause */
/* Geometry decides what texture cannot.
 *
 * Seen from far apart, corners look like each other more than like themselves, and the ratio test leaves nothing. The right
 * partners are among the best WIDE_SHORTLIST, though, most of all where colours have a say (wide_shortlist.c). So all candidates of
 * such a list, of the MOST_LISTED most meaningful L-junctions of either image, aligned and scored by support, go with their priors
 * (prior.c) to asj_geometry_estimate(), which finds what they have in common. There a location within CLUSTER px of one before it
 * is one place with that, so rows of near ones are one.
 *
 * The matches that are there are among the candidates whatever their rank, but those of guests (guests.c), which are alike among
 * themselves. Where a geometry is accepted, and no other one contradicts it, verdict.c says what it makes of the matches.
 *
 * Most pairs of a collection have nothing in common, and all that takes long. So those of which related.c says so, or nearly, are
 * asked first for a geometry by lists of FIRST_SHORTLIST, in a third of the time: where that is chance, by LEAST_HOPE, nothing more
 * is looked for. */
#include "two_view.h"
#include "align.h"
#include "compare.h"
#include "consensus.h"
#include "geometry/estimate.h"
#include "geometry/geometry_options.h"
#include "geometry_candidate.h"
#include "pair_list.h"
#include "prior.h"
#include "room_directions.h"
#include "shown_pictures.h"
#include "support.h"
#include "verdict.h"
#include "wide_shortlist.h"

#include <math.h>

#define WIDE_SHORTLIST 16
#define FIRST_SHORTLIST 4
#define LEAST_HOPE 0.0   /* log10 NFA by such lists. Of frames of videos of which that is so, where the longer lists have -10 and
                          * less, these have -5.8, -6.1, -6.4 and from -10 down to -25, of LePoint3 -.1; of 52 unrelated pairs one
                          * has less (-3.9), and most have no start worth refining */
#define MOST_LISTED 4000 /* L-junctions of an image, the most meaningful ones. Upsampled photographs have over 20000, and what all
                          * of them bring besides takes longer than all other steps: a corridor with cameras 246 matches in 12.0 s,
                          * so 235 in 6.1, a dense mosaic 6073 in 36.7 s and 6074 in 12.5; rooms of poor texture have fewer */
#define CLUSTER 5.0 /* px */

/* The matches are candidates too, wherever they rank: guided ones (guided.c) stand in no list, and each needs its probability. */
static asj_status add_matches(const asj_match_run *run, asj_wide_run *w)
{
    asj_memory *memory = &run->context->memory;
    asj_pair_list list = {NULL, 0, 0};
    asj_candidates matches = {NULL, 0, 0};
    asj_status status = ASJ_OK;
    for (size_t n = 0; n < run->choices.count && status == ASJ_OK; n++) {
        const asj_candidate *c = &run->candidates.list[run->choices.list[n].candidate];
        if (!asj_is_of_guests(run, c))
            status = asj_pair_list_add(run->context, &list, c->i, c->j);
    }
    if (status == ASJ_OK)
        status = asj_pair_list_candidates(run->context, &list, run->image[0]->l_junctions.count, 0, ASJ_STAGE_DISTANCES,
                                          &matches);
    if (status == ASJ_OK)
        status = asj_compare_and_drop(&w->run, &matches);
    if (status == ASJ_OK)
        status = asj_candidates_merge(run->context, &w->run.candidates, &matches, ASJ_STAGE_DISTANCES);
    asj_release_much(memory, list.pairs);
    asj_release(memory, matches.list);
    return status;
}

static asj_status wide_candidates(const asj_match_run *run, asj_wide_run *w)
{
    asj_status status = asj_wide_shortlist(&w->run);
    if (status == ASJ_OK)
        status = add_matches(run, w);
    if (status == ASJ_OK && w->options.align_iterations > 0)
        status = asj_align_candidates(&w->run, &w->run.candidates);
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

/* With the places of clusters. */
static asj_geometry_candidate clustered(const asj_wide_run *w, const asj_candidate *c, double prior)
{
    asj_geometry_candidate g = asj_candidate_for_geometry(&w->run, c, prior);
    g.place1 = w->place[0][g.place1];
    g.place2 = w->place[1][g.place2];
    return g;
}

/* Sizes; and, unless the caller gave directions, those of both images where cameras are known, and their straight edges where a
 * focal length is looked for. */
static asj_status complete_options(asj_match_run *run, asj_geometry_options *options, asj_geometry_hints *hints,
                                   asj_edge_list edges[2])
{
    asj_status status = ASJ_OK;
    const int32_t known = asj_cameras_are_known(options), finds_focal = asj_finds_focal(options);
    const asj_pyramid *const pyramids[2] = {&run->image[0]->pyramid, &run->image[1]->pyramid};
    double given = 0;
    for (int32_t k = 0; k < 18 && known; k++)
        given += fabs(options->directions[k / 9][k % 9]);
    for (int32_t side = 0; side < 2; side++) {
        options->widths[side] = run->image[side]->pyramid.width[0];
        options->heights[side] = run->image[side]->pyramid.height[0];
    }
    if (known && !finds_focal && given == 0)
        status = asj_room_directions(run->context, run->image, options->cameras, hints->directions);
    if (finds_focal && given == 0)
        status = asj_room_edges(run->context, pyramids, 2, edges);
    hints->edges = finds_focal && given == 0 ? edges : NULL;
    return status;
}

static asj_status estimate(asj_match_run *run, asj_wide_run *w)
{
    asj_memory *memory = &run->context->memory;
    const size_t count = w->run.candidates.count;
    w->given = asj_allocate(memory, count, sizeof *w->given);
    w->probability = asj_allocate(memory, count, sizeof *w->probability);
    w->colours = asj_allocate(memory, count, sizeof *w->colours);
    w->branches = asj_allocate(memory, ASJ_BRANCH_NUMBERS * count, sizeof *w->branches);
    for (int32_t side = 0; side < 2; side++)
        w->place[side] = asj_allocate(memory, run->image[side]->l_junctions.location_count, sizeof *w->place[side]);
    if (!w->given || !w->probability || !w->colours || !w->branches || !w->place[0] || !w->place[1])
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the geometry of %zu candidates", count);
    asj_geometry_options options = run->options->geometry;
    asj_geometry_hints hints = {.branches = w->branches};
    asj_status status = asj_candidate_priors(&w->run, w->probability, w->colours);
    if (status == ASJ_OK)
        status = complete_options(run, &options, &hints, w->edges);
    if (status == ASJ_OK)
        status = asj_show_pictures(run, &w->shown, hints.pictures);
    if (status != ASJ_OK)
        return status;
    for (int32_t side = 0; side < 2; side++)
        cluster(&run->image[side]->l_junctions, w->place[side]);
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) { /* a map that hardly keeps any area is no map */
        const asj_candidate *c = &w->run.candidates.list[k];
        if (!asj_keeps_area(c->map.to))
            continue;
        w->given[kept] = clustered(w, c, w->probability[k]);
        w->colours[kept] = w->colours[k];
        asj_candidate_branches(&w->run, c, &w->branches[ASJ_BRANCH_NUMBERS * kept]);
        w->run.candidates.list[kept++] = *c;
    }
    w->run.candidates.count = kept;
    hints.colours = run->image[0]->colours && run->image[1]->colours ? w->colours : NULL;
    return asj_estimate_with_hints(run->context, w->given, kept, &hints, &options, w->probability, &run->judge,
                                   &run->geometry);
}

/* The geometry by lists of so many partners of each L-junction; *w is to be freed, whatever comes of it. */
static asj_status look_for_geometry(asj_match_run *run, int32_t shortlist, asj_wide_run *w)
{
    *w = (asj_wide_run){.options = *run->options};
    w->options.shortlist = shortlist;
    w->run = (asj_match_run){.context = run->context, .options = &w->options, .image = {run->image[0], run->image[1]},
                             .alignments = run->alignments, .for_geometry = 1, .most_listed = MOST_LISTED};
    const asj_status status = wide_candidates(run, w);
    return status == ASJ_OK ? estimate(run, w) : status;
}

static void free_wide(asj_memory *memory, asj_wide_run *w)
{
    asj_release_much(memory, w->run.candidates.list);
    asj_wide_shortlist_free(&w->run);
    asj_support_free(memory, &w->run.support);
    asj_release(memory, w->given);
    asj_release(memory, w->probability);
    asj_release(memory, w->colours);
    asj_release(memory, w->branches);
    asj_release(memory, w->place[0]);
    asj_release(memory, w->place[1]);
    asj_release(memory, w->edges[0].list);
    asj_release(memory, w->edges[1].list);
    asj_shown_pictures_free(memory, &w->shown);
}

asj_status asj_geometry_may_be(asj_match_run *run, int32_t *may)
{
    asj_wide_run w;
    const asj_status status = look_for_geometry(run, FIRST_SHORTLIST, &w);
    const int32_t chance = run->geometry.status == ASJ_GEOMETRY_CHANCE || run->geometry.status == ASJ_GEOMETRY_TOO_FEW;
    *may = !chance || run->geometry.log10_nfa < LEAST_HOPE;
    free_wide(&run->context->memory, &w);
    return status;
}

asj_status asj_apply_geometry(asj_match_run *run)
{
    asj_wide_run w;
    const int32_t listed = run->options->shortlist;
    asj_status status = look_for_geometry(run, listed > WIDE_SHORTLIST ? listed : WIDE_SHORTLIST, &w);
    if (status == ASJ_OK && run->geometry.status == ASJ_GEOMETRY_ACCEPTED)
        status = asj_apply_verdict(run, &w);
    free_wide(&run->context->memory, &w);
    return status;
}
