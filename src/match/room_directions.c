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
#include "core/threads.h"
#include "geometry/vanishing.h"
#include "segments/line_segments.h"

#include <math.h>
#include <string.h>

#define LONGEST 1200
#define LEVELS 2
#define BRANCHES_SD (2 * ASJ_DEGREE)
#define SEGMENT_EPSILON 1.0

static int32_t longer_side(const asj_pyramid *p, int32_t level)
{
    return p->width[level] > p->height[level] ? p->width[level] : p->height[level];
}

/* The segments of level `level` of each picture, counted from its first one, where it has that. */
static asj_status find_segments(asj_context *context, const asj_pyramid *const pyramids[], const int32_t first[], int32_t count,
                                int32_t level, asj_line_segments found[][LEVELS])
{
    asj_frame frames[ASJ_SEGMENT_IMAGES];
    asj_line_segments each[ASJ_SEGMENT_IMAGES];
    int32_t of[ASJ_SEGMENT_IMAGES], some = 0;
    for (int32_t v = 0; v < count; v++) {
        const asj_pyramid *p = pyramids[v];
        const int32_t n = first[v] + level;
        if (n >= p->levels)
            continue;
        frames[some] = (asj_frame){.width = p->width[n], .height = p->height[n], .stride = p->width[n] + 1, .gray = p->plane[n]};
        of[some++] = v;
    }
    const asj_status status = asj_line_segments_find_each(context, frames, some, ASJ_STAGE_ASSIGN, SEGMENT_EPSILON, each);
    for (int32_t n = 0; n < some; n++)
        found[of[n]][level] = each[n];
    return status;
}

/* In pixels of the first level: the centre of pixel i of one with pixels `pixel` wide lies at (i + 1/2) pixel - 1/2. */
static void add_edges(const asj_line_segments *found, double pixel, asj_edge_list *edges)
{
    for (size_t k = 0; k < found->count; k++) {
        const asj_line_segment *s = &found->list[k];
        edges->list[edges->count++] = (asj_straight_edge){(s->x1 + 0.5) * pixel - 0.5, (s->y1 + 0.5) * pixel - 0.5,
                                                          (s->x2 + 0.5) * pixel - 0.5, (s->y2 + 0.5) * pixel - 0.5, pixel};
    }
}

/* Takes the segments of all levels apart. */
static asj_status collect(asj_context *context, const asj_pyramid *pyramid, int32_t first, asj_line_segments found[LEVELS],
                          asj_edge_list *edges)
{
    size_t count = 0;
    for (int32_t k = 0; k < LEVELS; k++)
        count += found[k].count;
    *edges = (asj_edge_list){.list = asj_allocate(&context->memory, count, sizeof *edges->list), .scale = ldexp(1, first),
                             .longer = longer_side(pyramid, first)};
    for (int32_t k = 0; k < LEVELS && edges->list; k++)
        add_edges(&found[k], ldexp(1, k), edges);
    return edges->list ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu edges", count);
}

asj_status asj_room_edges(asj_context *context, const asj_pyramid *const pyramids[], int32_t count, asj_edge_list *edges)
{
    asj_memory *memory = &context->memory;
    asj_line_segments found[ASJ_SEGMENT_IMAGES][LEVELS] = {{{NULL, 0}}};
    int32_t first[ASJ_SEGMENT_IMAGES] = {0};
    asj_status status = ASJ_OK;
    memset(edges, 0, (size_t)count * sizeof *edges);
    for (int32_t v = 0; v < count; v++)
        while (first[v] + 1 < pyramids[v]->levels && longer_side(pyramids[v], first[v]) > LONGEST)
            first[v]++;
    for (int32_t k = 0; k < LEVELS && status == ASJ_OK; k++)
        status = find_segments(context, pyramids, first, count, k, found);
    for (int32_t v = 0; v < count && status == ASJ_OK; v++)
        status = collect(context, pyramids[v], first[v], found[v], &edges[v]);
    for (int32_t v = 0; v < count; v++) {
        for (int32_t k = 0; k < LEVELS; k++)
            asj_release(memory, found[v][k].list);
        if (status != ASJ_OK)
            asj_release(memory, edges[v].list);
        if (status != ASJ_OK)
            edges[v].list = NULL;
    }
    return status;
}

typedef struct job {
    asj_directions_scratch *scratch[2];
    const asj_edge_list *edges;
    const asj_camera *cameras;
    asj_directions_list *found;
} job;

static void find_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t v = part->first; v < part->end; v++)
        asj_find_directions_with(j->scratch[v], &j->edges[v], &j->cameras[v], 1, &j->found[v]);
}

/* Each image by a thread. */
static asj_status from_segments(asj_context *context, const asj_image_features *const images[2], const asj_camera cameras[2],
                                asj_directions_list found[2])
{
    asj_memory *memory = &context->memory;
    const asj_pyramid *const pyramids[2] = {&images[0]->pyramid, &images[1]->pyramid};
    asj_edge_list edges[2];
    asj_status status = asj_room_edges(context, pyramids, 2, edges);
    if (status != ASJ_OK)
        return status;
    const job j = {{asj_directions_scratch_create(memory, edges[0].count), asj_directions_scratch_create(memory, edges[1].count)},
                   edges, cameras, found};
    if (j.scratch[0] && j.scratch[1])
        asj_parallel(context, context->threads, 2, 1, find_some, &j);
    else
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the directions of %zu edges", edges[0].count + edges[1].count);
    for (int32_t v = 0; v < 2; v++) {
        asj_directions_scratch_free(memory, j.scratch[v]);
        asj_release(memory, edges[v].list);
    }
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

asj_status asj_room_directions(asj_context *context, const asj_image_features *const images[2], const asj_camera cameras[2],
                               asj_directions_list found[2])
{
    memset(found, 0, 2 * sizeof *found);
    asj_status status = from_segments(context, images, cameras, found);
    for (int32_t v = 0; v < 2 && status == ASJ_OK; v++)
        if (found[v].count == 0)
            status = from_branches(context, images[v], &cameras[v], &found[v]);
    return status;
}
