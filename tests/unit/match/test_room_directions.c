/* SPDX-License-Identifier: BSD-2-Clause */
/* The straight edges that a room's directions come from: clear ones in the image, faint ones at half its size. */
#include "unit_test.h"

#include "core/pyramid.h"
#include "match/room_directions.h"

#include <asj/asj.h>

#define WIDTH 320
#define HEIGHT 240

/* Dark and light on either side of a line through the middle that rises by a tenth, the step `soft` px wide, with noise. */
static void paint(double contrast, double soft, double noise, uint8_t *pixels)
{
    synth_random random;
    synth_random_seed(&random, 3);
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            const double off = y - 0.5 * HEIGHT - 0.1 * (x - 0.5 * WIDTH);
            const double grey = 120 + contrast / (1 + exp(-4 * off / soft)) + noise * synth_random_normal(&random);
            pixels[y * WIDTH + x] = (uint8_t)lround(grey);
        }
}

/* px that the farther end of the edge lies from the line. */
static double off_line(const asj_straight_edge *e)
{
    const double first = e->y1 - 0.5 * HEIGHT - 0.1 * (e->x1 - 0.5 * WIDTH);
    const double second = e->y2 - 0.5 * HEIGHT - 0.1 * (e->x2 - 0.5 * WIDTH);
    return fmax(fabs(first), fabs(second));
}

/* The longest edge seen in pixels that wide, {0} if there is none. */
static asj_straight_edge longest(const asj_edge_list *edges, double pixel)
{
    asj_straight_edge best = {0, 0, 0, 0, 0};
    for (size_t k = 0; k < edges->count; k++) {
        const asj_straight_edge *e = &edges->list[k];
        if (e->pixel == pixel && hypot(e->x2 - e->x1, e->y2 - e->y1) > hypot(best.x2 - best.x1, best.y2 - best.y1))
            best = *e;
    }
    return best;
}

static asj_pyramid pyramid_of(asj_context *context, const uint8_t *pixels)
{
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
    asj_pyramid pyramid;
    assert_int_equal(asj_pyramid_create(context, &image, 0.8, &pyramid), ASJ_OK);
    return pyramid;
}

static void faint_edges_are_seen_at_half_size(void **state)
{
    static const struct {
        double contrast, soft, noise;
        int in_image; /* is it long there? */
    } cases[] = {{60, 2, 1, 1}, {24, 5, 2, 0}};
    static uint8_t pixels[WIDTH * HEIGHT];
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        paint(cases[k].contrast, cases[k].soft, cases[k].noise, pixels);
        asj_pyramid pyramid = pyramid_of(context, pixels);
        asj_edge_list edges;
        const asj_pyramid *const pyramids[] = {&pyramid};
        assert_int_equal(asj_room_edges(context, pyramids, 1, &edges), ASJ_OK);
        assert_true(edges.scale == 1 && edges.longer == WIDTH);
        const asj_straight_edge fine = longest(&edges, 1), coarse = longest(&edges, 2);
        const double across = fabs(fine.x2 - fine.x1), coarse_across = fabs(coarse.x2 - coarse.x1);
        printf("contrast %.0f: %.1f px, %.1f at half size\n", cases[k].contrast, across, coarse_across);
        assert_true(cases[k].in_image == (across > 0.6 * WIDTH));
        assert_true(coarse_across > 0.6 * WIDTH && off_line(&coarse) < 1.5);
        assert_true(!cases[k].in_image || off_line(&fine) < 1);
        asj_release(&context->memory, edges.list);
        asj_pyramid_free(&context->memory, &pyramid);
    }
}

static void every_allocation_may_fail(void **state)
{
    static uint8_t pixels[WIDTH * HEIGHT];
    int reached = 1;
    (void)state;
    paint(60, 2, 1, pixels);
    for (long n = 1; reached; n++) {
        unit_counter counter = {0};
        asj_context *context = unit_context(&counter, 1);
        asj_pyramid pyramid = pyramid_of(context, pixels);
        asj_edge_list edges;
        counter.fail_at = counter.calls + n;
        const asj_pyramid *const pyramids[] = {&pyramid};
        const asj_status status = asj_room_edges(context, pyramids, 1, &edges);
        reached = unit_reached(&counter);
        assert_int_equal(status, reached ? ASJ_ERROR_MEMORY : ASJ_OK);
        assert_true(status == ASJ_OK || !edges.list);
        asj_release(&context->memory, edges.list);
        asj_pyramid_free(&context->memory, &pyramid);
        unit_context_free(&counter, &context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faint_edges_are_seen_at_half_size),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
