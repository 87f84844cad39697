/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, test by epipolar lines: what contradicts the fundamental matrix of all matches goes.
 *
 * What verify.c leaves is right to 95 % and more, and of the rest most are T-junctions where one thing hides another: they slide a
 * few px along both when the viewpoint moves, and everything around them agrees with that. But where matches are many, they tell
 * the fundamental matrix to a fraction of a pixel, and a slide that leaves the epipolar line shows. It is estimated from the
 * choices alone (../geometry/), each PRIOR likely, with few samples, since nearly all are right. A choice goes when it is farther
 * from its epipolar line in either image than asj_farthest_from_line() allows. (8 samples and 20 matches: rendered rooms and
 * sixteen pairs of photographs.) Choices whose maps keep hardly any area (two_view.c) are not asked. Nothing goes when choices are
 * fewer than LEAST_MATCHES, when no matrix is accepted, or when it contradicts more than MOST_AGAINST of them: things that move by
 * themselves, lenses that bend lines.
 *
 * A plane leaves the matrix open; then any of those that its matches allow does. */
#include "epipolar.h"
#include "two_view.h"

#include <math.h>

#define LEAST_MATCHES 20
#define SAMPLES 8
#define PRIOR 0.9
#define MOST_AGAINST 0.25

/* given: of all choices. asked: room for those of them that are asked. */
static asj_status estimate(const asj_match_run *run, asj_geometry_candidate *given, asj_geometry_candidate *asked,
                           asj_geometry *geometry)
{
    asj_geometry_options options;
    size_t count = 0;
    asj_geometry_options_init(&options);
    options.model = ASJ_GEOMETRY_FUNDAMENTAL;
    options.samples = SAMPLES;
    for (int32_t side = 0; side < 2; side++) {
        options.widths[side] = run->image[side]->pyramid.width[0];
        options.heights[side] = run->image[side]->pyramid.height[0];
    }
    for (size_t n = 0; n < run->choices.count; n++) {
        const asj_candidate *c = &run->candidates.list[run->choices.list[n].candidate];
        given[n] = asj_candidate_for_geometry(run, c, PRIOR);
        if (asj_keeps_area(c))
            asked[count++] = given[n];
    }
    return asj_geometry_estimate(run->context, asked, count, &options, NULL, geometry);
}

static int is_far(const asj_match_run *run, size_t n, const asj_geometry *geometry, const asj_geometry_candidate *given)
{
    const asj_geometry_candidate *g = &given[n];
    return asj_distance_from_line(geometry, g->x1, g->y1, g->x2, g->y2) >
           asj_farthest_from_line(run, &run->candidates.list[run->choices.list[n].candidate]);
}

static void drop_far(asj_match_run *run, const asj_geometry *geometry, const asj_geometry_candidate *given)
{
    asj_choices *choices = &run->choices;
    size_t against = 0, kept = 0;
    for (size_t n = 0; n < choices->count; n++)
        against += (size_t)is_far(run, n, geometry, given);
    if ((double)against > MOST_AGAINST * (double)choices->count)
        return;
    for (size_t n = 0; n < choices->count; n++)
        if (!is_far(run, n, geometry, given)) /* kept <= n: what is asked about is not yet overwritten */
            choices->list[kept++] = choices->list[n];
    choices->count = kept;
}

asj_status asj_verify_epipolar(asj_match_run *run)
{
    if (run->options->verify_neighbours == 0 || run->choices.count < LEAST_MATCHES)
        return ASJ_OK;
    asj_geometry geometry;
    asj_geometry_candidate *given = asj_allocate(&run->context->memory, run->choices.count, 2 * sizeof *given);
    if (!given)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to verify %zu matches", run->choices.count);
    const asj_status status = estimate(run, given, given + run->choices.count, &geometry);
    if (status == ASJ_OK && geometry.status == ASJ_GEOMETRY_ACCEPTED)
        drop_far(run, &geometry, given);
    asj_release(&run->context->memory, given);
    return status;
}
