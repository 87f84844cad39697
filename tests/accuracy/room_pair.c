/* SPDX-License-Identifier: BSD-2-Clause */
#include "room_pair.h"
#include "render.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define AROUND 2.0  /* px */
#define NEAR 4.0    /* px */
#define NEAR_END 8.0 /* px */
#define PART 20.0    /* px of a branch */
#define LEAST_COSINE 0.984807753 /* of 10 degrees */

static int fail(const char *what)
{
    fprintf(stderr, "room: %s\n", what);
    return -1;
}

int room_view_make(asj_context *context, const synth_room *room, synth_camera camera, uint64_t noise_seed, int32_t first_octave,
                   room_view *view)
{
    synth_view painted;
    asj_detect_options options;
    memset(view, 0, sizeof *view);
    view->camera = camera;
    if (synth_view_make(room, &camera, 1.0, &painted) != 0)
        return fail("cannot make a view");
    view->pixels = synth_photograph(&painted.scene, 0.9, 2.0, noise_seed);
    synth_view_free(&painted);
    if (!view->pixels)
        return fail("cannot render a view");
    view->image = (asj_image){view->pixels, ASJ_FORMAT_GRAY8, camera.width, camera.height, 0, 0};
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    options.first_octave = first_octave;
    return asj_detect(context, &view->image, &options, &view->found) == ASJ_OK ? 0 : fail(asj_context_message(context));
}

void room_view_free(room_view *view)
{
    asj_detection_free(&view->found);
    free(view->pixels);
    view->pixels = NULL;
}

int room_pair_right(const synth_room *room, const room_view *a, const room_view *b, float x1, float y1, float x2, float y2,
                    double near)
{
    for (int32_t j = -2; j <= 2; j++)
        for (int32_t i = -2; i <= 2; i++) {
            synth_point p;
            const double x = (double)x1 + i * AROUND / 2, y = (double)y1 + j * AROUND / 2;
            if (i * i + j * j > 4 || !synth_room_transfer(room, &a->camera, x, y, &b->camera, &p))
                continue;
            const double dx = p.x - (double)x2, dy = p.y - (double)y2;
            if (dx * dx + dy * dy <= near * near)
                return 1;
        }
    return 0;
}

/* Does the branch that ends there, x and y in both views, point in the second one as the surface beside it says, within 2 px as
 * above? */
static int points_right(const synth_room *room, const room_view *a, const room_view *b, const asj_junction_match *m,
                        const float end[4])
{
    const double dx = (double)end[0] - (double)m->x1, dy = (double)end[1] - (double)m->y1, length = hypot(dx, dy);
    const double ux = (double)end[2] - (double)m->x2, uy = (double)end[3] - (double)m->y2;
    const double part = length > PART ? PART / length : 1;
    for (int32_t j = -2; j <= 2; j++)
        for (int32_t i = -2; i <= 2; i++) {
            synth_point p, q;
            const double x = (double)m->x1 + i * AROUND / 2, y = (double)m->y1 + j * AROUND / 2;
            if (i * i + j * j > 4 || !synth_room_transfer(room, &a->camera, x, y, &b->camera, &p) ||
                !synth_room_transfer(room, &a->camera, x + part * dx, y + part * dy, &b->camera, &q))
                continue;
            const double vx = q.x - p.x, vy = q.y - p.y;
            if (hypot(p.x - (double)m->x2, p.y - (double)m->y2) <= NEAR && hypot(vx, vy) > 0 && hypot(ux, uy) > 0 &&
                vx * ux + vy * uy >= LEAST_COSINE * hypot(vx, vy) * hypot(ux, uy))
                return 1;
        }
    return 0;
}

/* How many have both ends in place. */
static uint32_t lines_right(const synth_room *room, const room_view *a, const room_view *b, const asj_segment_match *lines,
                            size_t count)
{
    uint32_t right = 0;
    for (size_t k = 0; k < count; k++) {
        const asj_segment_match *m = &lines[k];
        right += room_pair_right(room, a, b, m->x1, m->y1, m->x2, m->y2, NEAR_END) &&
                 room_pair_right(room, a, b, m->ex1, m->ey1, m->ex2, m->ey2, NEAR_END);
    }
    return right;
}

int room_pair_score(const synth_room *room, const room_view *a, const room_view *b, const asj_match_result *result, room_score *s)
{
    for (uint32_t k = 0; k < result->match_count; k++) {
        const asj_junction_match *m = &result->matches[k];
        const int right = room_pair_right(room, a, b, m->x1, m->y1, m->x2, m->y2, NEAR);
        s->points++;
        s->right_points += (uint32_t)right;
        s->segments += 2;
        const float ends[2][4] = {{m->ax1, m->ay1, m->ax2, m->ay2}, {m->bx1, m->by1, m->bx2, m->by2}};
        for (int32_t n = 0; n < 2 && right; n++)
            s->right_directions += (uint32_t)points_right(room, a, b, m, ends[n]);
        s->right_segments += (uint32_t)(right && room_pair_right(room, a, b, m->ax1, m->ay1, m->ax2, m->ay2, NEAR_END));
        s->right_segments += (uint32_t)(right && room_pair_right(room, a, b, m->bx1, m->by1, m->bx2, m->by2, NEAR_END));
    }
    const size_t count = asj_match_segments(result, ASJ_END_INNER, NULL, 0);
    asj_segment_match *lines = malloc((count + 1) * sizeof *lines);
    if (!lines)
        return fail("no memory");
    asj_match_segments(result, ASJ_END_INNER, lines, count);
    s->lines += (uint32_t)count;
    s->right_lines += lines_right(room, a, b, lines, count);
    const size_t joined = asj_join_segment_matches(lines, count);
    s->joined += (uint32_t)joined;
    s->right_joined += lines_right(room, a, b, lines, joined);
    free(lines);
    return 0;
}
