/* SPDX-License-Identifier: BSD-2-Clause */
/* Directions come from the straight line segments of the image (segments/): the long edges of a room, which end nowhere in
 * particular, tell them better than the branches of its corners do. Of fourteen video frames (seven pairs) none has two directions
 * that its branches alone are sure of; the best of the directions that explain its segments put the camera's turn within 1.4 to 7.5
 * degrees of the known one (median 2.4; it is known to a degree or more itself). Where segments are few, as in a picture of a bare
 * corner, the vanishing points of the branches (geometry/vanishing.c) come to them.
 *
 * Segments are looked for where the image is no larger than LONGEST px: what is straight is seen there. */
#include "room_directions.h"
#include "core/angle.h"
#include "geometry/vanishing.h"
#include "segments/line_segments.h"

#include <math.h>
#include <string.h>

#define LONGEST 1200
#define SEGMENT_EPSILON 1.0

static int32_t longer_side(const asj_pyramid *p, int32_t level)
{
    return p->width[level] > p->height[level] ? p->width[level] : p->height[level];
}

asj_status asj_room_edges(asj_context *context, const asj_pyramid *pyramid, asj_edge_list *edges)
{
    int32_t level = 0;
    memset(edges, 0, sizeof *edges);
    while (level + 1 < pyramid->levels && longer_side(pyramid, level) > LONGEST)
        level++;
    const asj_frame frame = {.width = pyramid->width[level], .height = pyramid->height[level],
                             .stride = pyramid->width[level] + 1, .gray = pyramid->plane[level]};
    asj_line_segment *segments;
    size_t count;
    const asj_status status = asj_line_segments_find(context, &frame, ASJ_STAGE_ASSIGN, SEGMENT_EPSILON, &segments, &count);
    if (status != ASJ_OK)
        return status;
    edges->scale = ldexp(1, level);
    edges->longer = longer_side(pyramid, level);
    edges->list = asj_allocate(&context->memory, count, sizeof *edges->list);
    for (size_t k = 0; k < count && edges->list; k++)
        edges->list[edges->count++] = (asj_straight_edge){segments[k].x1, segments[k].y1, segments[k].x2, segments[k].y2};
    asj_release(&context->memory, segments);
    return edges->list ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu edges", count);
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
    more.score = found->count > 0 ? found->list[0].score : 0; /* not comparable: as much as the segments' best */
    for (int32_t k = 0; k < 3; k++)
        more.axes[6 + k] = d[(k + 1) % 3] * e[(k + 2) % 3] - d[(k + 2) % 3] * e[(k + 1) % 3];
    asj_directions_add(found, &more);
    return ASJ_OK;
}

asj_status asj_room_directions(asj_context *context, const asj_image_features *image, const asj_camera *camera,
                               asj_directions_list *found)
{
    const asj_status status = from_segments(context, &image->pyramid, camera, found);
    return status == ASJ_OK ? from_branches(context, image, camera, found) : status;
}
