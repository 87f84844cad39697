/* SPDX-License-Identifier: BSD-2-Clause */
/* Directions come from the straight line segments of the image (segments/): the long edges of a room, which end nowhere in
 * particular, tell them better than the branches of its corners do. Of fourteen video frames (seven pairs) none has two directions
 * that its branches alone are sure of; the best of the directions that explain its segments put the camera's turn within 1.4 to 7.5
 * degrees of the known one (median 2.4; it is known to a degree or more itself). Where segments tell none, as in a picture of a
 * bare corner, the vanishing points of the branches (geometry/vanishing.c) do, to BRANCHES_SD.
 *
 * Segments are looked for where the image is no larger than LONGEST px: what is straight is seen there. And at half that size: what
 * is faint or soft has no level lines where its slope is less than rounding and noise, and twice the slope there (7 of 158
 * images have no directions without it and none with it; with a third level nothing is gained: tests/accuracy/tried/geometry.md,
 * "Edges at half the size, rivals that both looks have"). */
#include "room_directions.h"
#include "core/angle.h"
#include "geometry/vanishing.h"
#include "segments/line_segments.h"

#include <math.h>
#include <string.h>

#define LONGEST 1200
#define LEVELS 2
#define BRANCHES_SD (2 * ASJ_DEGREE)
#define SEGMENT_EPSILON 1.0

typedef struct segments_of_level {
    asj_line_segment *list;
    size_t count;
} segments_of_level;

static int32_t longer_side(const asj_pyramid *p, int32_t level)
{
    return p->width[level] > p->height[level] ? p->width[level] : p->height[level];
}

static asj_status find_segments(asj_context *context, const asj_pyramid *pyramid, int32_t level, segments_of_level *found)
{
    const asj_frame frame = {.width = pyramid->width[level], .height = pyramid->height[level],
                             .stride = pyramid->width[level] + 1, .gray = pyramid->plane[level]};
    return asj_line_segments_find(context, &frame, ASJ_STAGE_ASSIGN, SEGMENT_EPSILON, &found->list, &found->count);
}

/* In pixels of the first level: the centre of pixel i of one with pixels `pixel` wide lies at (i + 1/2) pixel - 1/2. */
static void add_edges(const segments_of_level *found, double pixel, asj_edge_list *edges)
{
    for (size_t k = 0; k < found->count; k++) {
        const asj_line_segment *s = &found->list[k];
        edges->list[edges->count++] = (asj_straight_edge){(s->x1 + 0.5) * pixel - 0.5, (s->y1 + 0.5) * pixel - 0.5,
                                                          (s->x2 + 0.5) * pixel - 0.5, (s->y2 + 0.5) * pixel - 0.5, pixel};
    }
}

asj_status asj_room_edges(asj_context *context, const asj_pyramid *pyramid, asj_edge_list *edges)
{
    segments_of_level found[LEVELS] = {{NULL, 0}};
    asj_status status = ASJ_OK;
    int32_t first = 0;
    size_t count = 0;
    memset(edges, 0, sizeof *edges);
    while (first + 1 < pyramid->levels && longer_side(pyramid, first) > LONGEST)
        first++;
    for (int32_t k = 0; k < LEVELS && first + k < pyramid->levels && status == ASJ_OK; k++) {
        status = find_segments(context, pyramid, first + k, &found[k]);
        count += found[k].count;
    }
    edges->scale = ldexp(1, first);
    edges->longer = longer_side(pyramid, first);
    if (status == ASJ_OK)
        edges->list = asj_allocate(&context->memory, count, sizeof *edges->list);
    if (status == ASJ_OK && !edges->list)
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu edges", count);
    for (int32_t k = 0; k < LEVELS; k++) {
        if (edges->list)
            add_edges(&found[k], ldexp(1, k), edges);
        asj_release(&context->memory, found[k].list);
    }
    return status;
}

static asj_status from_segments(asj_context *context, const asj_pyramid *pyramid, const asj_camera *camera,
                                asj_directions_list *found)
{
    asj_edge_list edges;
    asj_status status = asj_room_edges(context, pyramid, &edges);
    if (status == ASJ_OK && !asj_find_directions(&context->memory, &edges, camera, 1, found))
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the directions of %zu edges", edges.count);
    asj_release(&context->memory, edges.list);
    return status;
}

/* The branches of the L-junctions that are no guests. Their angles carry no uncertainty here: vanishing.c takes it from their
 * lengths. */
static asj_status from_branches(asj_context *context, const asj_image_features *image, const asj_camera *camera,
                                asj_directions_list *found)
{
    const asj_l_junctions *in = &image->l_junctions;
    asj_vanishing_options options;
    asj_vanishing_points points;
    size_t count = 0;
    asj_junction *list = asj_allocate_zero(&context->memory, in->count, sizeof *list);
    if (!list)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the directions of %lu L-junctions", (unsigned long)in->count);
    for (uint32_t k = 0; k < in->count; k++) {
        const asj_l_junction *l = &in->l[k];
        asj_junction *of_two = &list[count];
        if (asj_is_guest(in, k))
            continue;
        const double to[2][2] = {{(double)l->ax - (double)l->x, (double)l->ay - (double)l->y},
                                 {(double)l->bx - (double)l->x, (double)l->by - (double)l->y}};
        of_two->x = l->x;
        of_two->y = l->y;
        of_two->branch_count = 2;
        for (int32_t b = 0; b < 2; b++) {
            const double angle = atan2(to[b][1], to[b][0]);
            of_two->branches[b].angle = (float)(angle < 0 ? angle + ASJ_TWO_PI : angle);
            of_two->branches[b].length = (float)sqrt(to[b][0] * to[b][0] + to[b][1] * to[b][1]);
        }
        count++;
    }
    asj_vanishing_options_init(&options);
    options.camera = *camera;
    options.width = image->pyramid.width[0];
    options.height = image->pyramid.height[0];
    const asj_status status = asj_vanishing_points_of(context, list, count, &options, ASJ_STAGE_ASSIGN, &points);
    asj_release(&context->memory, list);
    if (status != ASJ_OK || points.count < 2)
        return status;
    const double *d = points.points[0].direction, *e = points.points[1].direction;
    asj_directions more;
    memset(&more, 0, sizeof more);
    memcpy(more.axes, d, 3 * sizeof *d);
    memcpy(more.axes + 3, e, 3 * sizeof *e);
    for (int32_t k = 0; k < 3; k++) {
        more.axes[6 + k] = d[(k + 1) % 3] * e[(k + 2) % 3] - d[(k + 2) % 3] * e[(k + 1) % 3];
        more.covariance[4 * k] = BRANCHES_SD * BRANCHES_SD;
    }
    asj_directions_add(found, &more);
    return ASJ_OK;
}

asj_status asj_room_directions(asj_context *context, const asj_image_features *image, const asj_camera *camera,
                               asj_directions_list *found)
{
    const asj_status status = from_segments(context, &image->pyramid, camera, found);
    return status == ASJ_OK && found->count == 0 ? from_branches(context, image, camera, found) : status;
}
