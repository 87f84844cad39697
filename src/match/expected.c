/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, upsampled images: where the images' own matches put the partners of an L-junction.
 *
 * In upsampled images there are some ten times as many L-junctions, and of the best partners by looks among all of them few are
 * near the right place. The matches of the images say where that is: with the nearest GUIDES of them, whose affine maps put a point
 * p at A_k p, and which are d_k away from it, the partners lie in the least upright rectangle around all squares of
 *     A_k p +- (reach D + SLOPE d_k),          D the diagonal of the images in px (of whichever is larger).
 * Matches that disagree, on two surfaces or because one of them is wrong, make the rectangle larger; the reach lets in what stands
 * before or behind them. Two L-junctions are compared when each lies in the rectangle of the other, so that swapping the images
 * changes nothing.
 *
 * There are more right matches so, for fewer comparisons, down to a reach of .01 (tests/accuracy/tried/matching.md, "Images
 * upsampled"). Margins scaled as the maps scale give as many, since both rectangles must hold. */
#include "expected.h"
#include "nearest.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define GUIDES 6  /* nearest matches: two or three surfaces meet at a corner */
#define SLOPE 0.3 /* what a surface at 45 degrees is foreshortened by */

/* All that the L-junctions of an image share. */
typedef struct job {
    const asj_match_run *run;
    const asj_match_result *known;
    const asj_stretch *by; /* of either image */
    double reach;          /* px of the images */
    int32_t side;
    asj_point *points;
    asj_box *boxes;
    asj_watch *watch;
} job;

/* Where a match puts (x, y) of image `side` in the other one. Returns 0 when its map has no inverse: it says nothing of either. */
static int predict(const asj_junction_match *m, int32_t side, double x, double y, double at[2])
{
    const double *h = m->affine, dx = x - (double)(side ? m->x2 : m->x1), dy = y - (double)(side ? m->y2 : m->y1);
    const double to[4] = {h[0], h[1], h[3], h[4]};
    double from[4];
    if (!asj_affine_invert(to, from))
        return 0;
    const double *a = side ? from : to;
    at[0] = (double)(side ? m->x1 : m->x2) + a[0] * dx + a[1] * dy;
    at[1] = (double)(side ? m->y1 : m->y2) + a[2] * dx + a[3] * dy;
    return 1;
}

/* From where the junctions were detected: x2, y2 is where a match has moved one to. */
static asj_nearest find_guides(const job *j, double x, double y, uint32_t *index)
{
    const asj_match_result *known = j->known;
    asj_nearest near = {.limit = GUIDES, .index = index};
    for (uint32_t k = 0; k < known->match_count; k++) {
        const asj_junction_match *m = &known->matches[k];
        const asj_l_junction *l = j->side ? &known->l_junctions2[m->l2] : &known->l_junctions1[m->l1];
        const double dx = x - (double)l->x, dy = y - (double)l->y;
        asj_nearest_offer(&near, k, dx * dx + dy * dy);
    }
    return near;
}

/* In px of the other image, upsampled; for (x, y) in px of the image. */
static asj_box box_of(const job *j, double x, double y)
{
    const asj_stretch *by = &j->by[1 - j->side];
    asj_box box = asj_box_empty();
    uint32_t index[GUIDES];
    const asj_nearest near = find_guides(j, x, y, index);
    for (uint32_t k = 0; k < near.count; k++) {
        const double margin = j->reach + SLOPE * sqrt(near.square[k]);
        double at[2];
        if (!predict(&j->known->matches[index[k]], j->side, x, y, at))
            continue;
        const asj_box one = {(float)((at[0] - margin + 0.5) * by->x - 0.5), (float)((at[1] - margin + 0.5) * by->y - 0.5),
                             (float)((at[0] + margin + 0.5) * by->x - 0.5), (float)((at[1] + margin + 0.5) * by->y - 0.5)};
        asj_box_join(&box, &one);
    }
    return box;
}

static void expect_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_l_junctions *mine = &j->run->image[j->side]->l_junctions;
    const asj_stretch *by = &j->by[j->side];
    for (int64_t p = part->first; p < part->end && !asj_watch_stops(j->watch, part); p++) {
        const asj_box box = box_of(j, (mine->location_x[p] + 0.5) / by->x - 0.5, (mine->location_y[p] + 0.5) / by->y - 0.5);
        for (uint32_t n = mine->first_of_location[p]; n < mine->first_of_location[p + 1]; n++) {
            const uint32_t l = mine->l_of_location[n];
            j->points[l] = (asj_point){mine->l[l].x, mine->l[l].y};
            j->boxes[l] = box;
        }
    }
}

/* px of the images: of the larger one's diagonal. */
static double diagonal(const asj_match_run *run, const asj_stretch by[2])
{
    double most = 0;
    for (int32_t n = 0; n < 2; n++) {
        const asj_pyramid *whole = &run->image[n]->pyramid;
        most = fmax(most, hypot(whole->width[0] / by[n].x, whole->height[0] / by[n].y));
    }
    return most;
}

asj_status asj_expect(const asj_match_run *run, const asj_match_result *known, const asj_stretch by[2], asj_expected *expected)
{
    asj_context *context = run->context;
    asj_status status = ASJ_OK;
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++) {
        const asj_l_junctions *mine = &run->image[side]->l_junctions;
        asj_watch watch;
        expected->points[side] = asj_allocate(&context->memory, mine->count, sizeof **expected->points);
        expected->boxes[side] = asj_allocate(&context->memory, mine->count, sizeof **expected->boxes);
        if (!expected->points[side] || !expected->boxes[side])
            return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the places of %u partners", (unsigned)mine->count);
        const job j = {run, known, by, run->options->upsampled_search_radius * diagonal(run, by), side, expected->points[side],
                       expected->boxes[side], &watch};
        asj_watch_start(&watch, context, ASJ_STAGE_DISTANCES);
        asj_parallel(context, context->threads, mine->location_count, 16, expect_some, &j);
        status = asj_watch_end(&watch);
    }
    return status;
}

void asj_expected_free(asj_memory *memory, asj_expected *expected)
{
    for (int32_t side = 0; side < 2; side++) {
        asj_release(memory, expected->points[side]);
        asj_release(memory, expected->boxes[side]);
    }
    memset(expected, 0, sizeof *expected);
}
