/* SPDX-License-Identifier: BSD-2-Clause */
#include "pages.h"

const pages_print pages_large_print = {70, 0.08, 0.3}, pages_small_print = {220, 0.03, 0.09};

/* From low above; turned about the page's middle for the second view. */
synth_point pages_seen(double u, double v, int view)
{
    const double turn = view == 0 ? 0.1 : 0.75;
    const double x = u * cos(turn) - v * sin(turn), y = u * sin(turn) + v * cos(turn);
    const double w = 1 - 0.12 * y;
    return (synth_point){0.5 * PAGE_WIDTH + 145 * x / w, 0.5 * PAGE_HEIGHT + 28 * y / w};
}

uint8_t *pages_draw(const pages_print *print, int view)
{
    synth_scene scene;
    synth_random random;
    synth_random_seed(&random, 8);
    synth_scene_init(&scene, PAGE_WIDTH, PAGE_HEIGHT, 120);
    for (int k = 0; k < print->count; k++) {
        const double u = synth_random_between(&random, -0.9, 0.9), v = synth_random_between(&random, -0.9, 0.9);
        const double a = synth_random_between(&random, print->least, print->most);
        const double b = synth_random_between(&random, print->least, print->most);
        const double gray = synth_random_between(&random, 30, 220);
        const synth_point corners[4] = {pages_seen(u - a, v - b, view), pages_seen(u + a, v - b, view),
                                        pages_seen(u + a, v + b, view), pages_seen(u - a, v + b, view)};
        synth_scene_add(&scene, corners, 4, synth_flat(gray), k);
    }
    return unit_picture(&scene, 0.7, 1, 3 + (uint64_t)view);
}

/* px: how far a match is from what the page says. Newton's method in the page's coordinates. */
static double error_of(double x1, double y1, double x2, double y2)
{
    double u = 0, v = 0;
    for (int step = 0; step < 60; step++) {
        const synth_point p = pages_seen(u, v, 0), du = pages_seen(u + 1e-6, v, 0), dv = pages_seen(u, v + 1e-6, 0);
        const double a = (du.x - p.x) * 1e6, b = (dv.x - p.x) * 1e6, c = (du.y - p.y) * 1e6, d = (dv.y - p.y) * 1e6;
        u += (d * (x1 - p.x) - b * (y1 - p.y)) / (a * d - b * c);
        v += (a * (y1 - p.y) - c * (x1 - p.x)) / (a * d - b * c);
    }
    const synth_point q = pages_seen(u, v, 1);
    return hypot(q.x - x2, q.y - y2);
}

int pages_set_up(void **state)
{
    static pages made;
    for (int view = 0; view < 2; view++) {
        made.pixels[view] = pages_draw(&pages_large_print, view);
        made.images[view] = unit_gray8(made.pixels[view], PAGE_WIDTH, PAGE_HEIGHT);
    }
    *state = &made;
    return 0;
}

int pages_tear_down(void **state)
{
    pages *made = *state;
    free(made->pixels[0]);
    free(made->pixels[1]);
    return 0;
}

void pages_expect_equal(const asj_match_result *a, const asj_match_result *b)
{
    assert_int_equal(a->match_count, b->match_count);
    assert_int_equal(a->l_junction_count1, b->l_junction_count1);
    assert_memory_equal(a->matches, b->matches, a->match_count * sizeof *a->matches);
    assert_memory_equal(a->l_junctions2, b->l_junctions2, a->l_junction_count2 * sizeof *a->l_junctions2);
}

uint32_t pages_count_right(const asj_match_result *r)
{
    uint32_t right = 0;
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *m = &r->matches[k];
        right += error_of((double)m->x1, (double)m->y1, (double)m->x2, (double)m->y2) < 3;
    }
    return right;
}

void pages_expect_consistent(const asj_match_result *r)
{
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *m = &r->matches[k];
        const double *h = m->affine, x = (double)m->x1, y = (double)m->y1;
        unit_near("x2", k, 0, (double)m->x2, h[0] * x + h[1] * y + h[2], 1e-3);
        unit_near("y2", k, 0, (double)m->y2, h[3] * x + h[4] * y + h[5], 1e-3);
        assert_true(m->l1 < r->l_junction_count1 && m->l2 < r->l_junction_count2);
        assert_true(m->x1 == r->l_junctions1[m->l1].x && m->y1 == r->l_junctions1[m->l1].y);
        unit_near("x of the L-junction", k, 0, (double)m->x2, (double)r->l_junctions2[m->l2].x, 9);
    }
    const size_t count = asj_match_segments(r, ASJ_END_CUT, NULL, 0);
    asj_segment_match *segments = calloc(count + 1, sizeof *segments);
    assert_non_null(segments);
    assert_int_equal(asj_match_segments(r, ASJ_END_CUT, segments, count), count);
    assert_true(count >= r->match_count);
    for (size_t k = 0; k < count; k++)
        assert_true(segments[k].x1 == r->matches[segments[k].match].x1 && segments[k].y2 == r->matches[segments[k].match].y2);
    free(segments);
}

asj_match_result *pages_look(asj_context *context, const asj_image images[2], const asj_stretch *stretch, int32_t model)
{
    asj_match_options options;
    asj_match_result *r = NULL;
    asj_match_options_init(&options);
    options.geometry.model = model;
    options.upsample_from = 0;
    assert_int_equal(asj_match_images(context, &images[0], &images[1], stretch, NULL, &options, &r), ASJ_OK);
    return r;
}
