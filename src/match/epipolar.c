/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, test by epipolar lines: what contradicts the fundamental matrix of all matches goes.
 *
 * What verify.c leaves is right to 95 % and more, and of the rest most are T-junctions where one thing hides another: they slide a
 * few px along both when the viewpoint moves, and everything around them agrees with that. But where matches are many, they tell
 * the fundamental matrix to a fraction of a pixel, and a slide that leaves the epipolar line shows. It is estimated from the
 * choices alone (../geometry/), each PRIOR likely, with few samples, since nearly all are right. A choice goes when it is farther
 * from its epipolar line in either image than asj_farthest_from_line() allows. (8 samples and 20 matches: rendered rooms and
 * sixteen pairs of photographs.) Choices whose maps keep hardly any area are not asked. Nothing goes when choices are
 * fewer than LEAST_MATCHES, when no matrix is accepted, or when it contradicts more than MOST_AGAINST of them: things that move by
 * themselves, lenses that bend lines.
 *
 * A plane leaves the matrix open; then any of those that its matches allow does. */
#include "epipolar.h"
#include "geometry_candidate.h"
#include "geometry/estimate.h"

#include <math.h>
#include <string.h>

#define LEAST_MATCHES 20
#define SAMPLES 8
#define PRIOR 0.9
#define MOST_AGAINST 0.25

/* asked: room for all choices. */
static asj_status estimate(const asj_match_run *run, asj_geometry_candidate *asked, asj_geometry *geometry)
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
        if (asj_keeps_area(c->map.to))
            asked[count++] = asj_candidate_for_geometry(run, c, PRIOR);
    }
    return asj_estimate_with_hints(run->context, asked, count, NULL, &options, NULL, NULL, geometry);
}

static int is_far(const asj_match_run *run, const asj_geometry *geometry, size_t n)
{
    const asj_candidate *c = &run->candidates.list[run->choices.list[n].candidate];
    const asj_geometry_candidate g = asj_candidate_for_geometry(run, c, PRIOR);
    return asj_distance_from_line(geometry, g.x1, g.y1, g.x2, g.y2) > asj_farthest_from_line(run);
}

static void drop_far(asj_match_run *run, const asj_geometry *geometry, size_t first)
{
    asj_choices *choices = &run->choices;
    size_t kept = first;
    for (size_t n = first; n < choices->count; n++)
        if (!is_far(run, geometry, n)) /* kept <= n: what is asked about is not yet overwritten */
            choices->list[kept++] = choices->list[n];
    choices->count = kept;
}

/* Of all choices: does it contradict few enough to be believed? */
static int is_believed(const asj_match_run *run, const asj_geometry *geometry)
{
    size_t against = 0;
    for (size_t n = 0; n < run->choices.count; n++)
        against += (size_t)is_far(run, geometry, n);
    return (double)against <= MOST_AGAINST * (double)run->choices.count;
}

void asj_drop_off_lines(asj_match_run *run, size_t first)
{
    asj_geometry geometry = {.model = ASJ_GEOMETRY_FUNDAMENTAL};
    memcpy(geometry.matrix, run->epipolar, sizeof geometry.matrix);
    if (run->has_epipolar)
        drop_far(run, &geometry, first);
}

asj_status asj_verify_epipolar(asj_match_run *run)
{
    if (run->options->verify_neighbours == 0 || run->choices.count < LEAST_MATCHES)
        return ASJ_OK;
    asj_geometry geometry;
    asj_geometry_candidate *asked = asj_allocate(&run->context->memory, run->choices.count, sizeof *asked);
    if (!asked)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to verify %zu matches", run->choices.count);
    const asj_status status = estimate(run, asked, &geometry);
    if (status == ASJ_OK && geometry.status == ASJ_GEOMETRY_ACCEPTED && is_believed(run, &geometry)) {
        run->has_epipolar = 1;
        memcpy(run->epipolar, geometry.matrix, sizeof run->epipolar);
        drop_far(run, &geometry, 0);
    }
    asj_release(&run->context->memory, asked);
    return status;
}
