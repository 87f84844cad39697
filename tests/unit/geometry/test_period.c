/* SPDX-License-Identifier: BSD-2-Clause */
/* Motions whose matches repeat on a plane. */
#include "unit_test.h"

#include "geometry/estimate.h"
#include "geometry/pairs.h"
#include "geometry/period.h"

#include <asj/geometry.h>

#define WIDTH 640
#define HEIGHT 480
#define ACROSS 13
#define DOWN 7
#define FAR 5.0     /* of the wall from camera 1 */
#define SPACING 0.5 /* of the crossings on it: 60 px */
#define MOST 400

static const asj_camera camera = {600, 600, 319.5, 239.5};

/* A wall of crossings that faces two cameras a step of two crossings apart. */
typedef struct wall {
    asj_geometry_candidate candidates[MOST];
    double probability[MOST];
    size_t count;
    uint32_t right; /* matches, with themselves */
} wall;

/* Pixel of a crossing in either image; 0 outside. */
static int see(int32_t n, int side, double xy[2])
{
    const double x = (n % ACROSS - ACROSS / 2) * SPACING + side, y = (n / ACROSS - DOWN / 2) * SPACING;
    xy[0] = camera.fx * x / FAR + camera.cx;
    xy[1] = camera.fy * y / FAR + camera.cy;
    return xy[0] >= 0 && xy[0] < WIDTH && xy[1] >= 0 && xy[1] < HEIGHT;
}

static void add(wall *w, uint32_t place1, uint32_t place2, const double one[2], const double two[2], double probability)
{
    w->probability[w->count] = probability;
    w->candidates[w->count++] = (asj_geometry_candidate){place1, place2, one[0], one[1], two[0], two[1], {1, 0, 0, 1}, 0.2};
}

/* Each crossing with itself and with the one beside it; every `odd`-th is like no other one (0: none is). */
static void make(wall *w, int32_t odd)
{
    memset(w, 0, sizeof *w);
    for (int32_t n = 0; n < ACROSS * DOWN; n++) {
        double one[2], two[2], beside[2];
        if (!see(n, 0, one))
            continue;
        if (see(n, 1, two)) {
            add(w, (uint32_t)n, (uint32_t)n, one, two, 1);
            w->right++;
        }
        if (n % ACROSS + 1 < ACROSS && see(n + 1, 1, beside) && (odd == 0 || (n % odd != 0 && (n + 1) % odd != 0)))
            add(w, (uint32_t)n, (uint32_t)n + 1, one, beside, 0);
    }
}

/* So many more matches, in front of the wall. */
static void add_elsewhere(wall *w, int count)
{
    for (int k = 0; k < count; k++) {
        const double one[2] = {100 + 40 * k, 333}, two[2] = {100 + 40 * k + 200, 333};
        add(w, 300 + (uint32_t)k, 300 + (uint32_t)k, one, two, 1);
    }
}

/* Of the motion that matches the crossings with themselves; fail_at: an allocation that fails, 0 = none does. */
static int32_t find_without(const wall *w, long fail_at, asj_model *shifted)
{
    unit_counter all = {0}, *counter = &all;
    asj_context *context = unit_context(counter, 1);
    asj_geometry_options options;
    asj_pairs set;
    asj_model motion = {.kind = ASJ_GEOMETRY_ESSENTIAL, .parameters = 8, .cameras = {camera, camera},
                        .rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1}, .translation = {1, 0, 0}, .planes = {{0, 0, 1 / FAR}}};
    double probability[MOST];
    motion.view.plane_count = 1;
    asj_geometry_options_init(&options);
    for (int v = 0; v < 2; v++) {
        options.widths[v] = WIDTH;
        options.heights[v] = HEIGHT;
    }
    assert_int_equal(asj_model_complete(&motion), 1);
    assert_int_equal(asj_pairs_create(context, w->candidates, w->count, NULL, &options, &set), ASJ_OK);
    assert_int_equal(set.count, w->count);
    for (int32_t k = 0; k < set.count; k++)
        probability[k] = w->probability[set.list[k].source];
    counter->fail_at = fail_at ? counter->calls + fail_at : 0;
    const int32_t found = asj_find_period(&context->memory, &set, &motion, probability, shifted);
    counter->fail_at = 0;
    asj_pairs_free(&context->memory, &set);
    unit_context_free(counter, &context);
    return found;
}

static int32_t find(const wall *w, asj_model *shifted)
{
    return find_without(w, 0, shifted);
}

/* The motion by a crossing more explains as much: the step is three crossings then. */
static void a_wall_of_crossings_repeats(void **state)
{
    (void)state;
    asj_model shifted;
    wall w;
    make(&w, 0);
    assert_true(w.right > 40);
    assert_int_equal(find(&w, &shifted), 1);
    assert_true(shifted.kind == ASJ_GEOMETRY_ESSENTIAL && shifted.view.plane_count == 1 && !shifted.settled);
    for (int k = 0; k < 3; k++) {
        unit_near("translation", k, 0, shifted.translation[k], k == 0, 1e-9);
        unit_near("plane", k, 0, shifted.planes[0][k], k == 2 ? 1.5 / FAR : 0, 1e-9);
    }
}

static void what_has_something_of_its_own_does_not(void **state)
{
    (void)state;
    asj_model shifted;
    wall w;
    make(&w, 5); /* a fifth of the crossings look like no other one */
    assert_int_equal(find(&w, &shifted), 0);
    make(&w, 0); /* matches in front of it say which step it was */
    add_elsewhere(&w, 2);
    assert_int_equal(find(&w, &shifted), 1);
    add_elsewhere(&w, 2);
    assert_int_equal(find(&w, &shifted), 0);
    make(&w, 0); /* a wall that ends, so that nothing is where its last crossings would go */
    size_t kept = 0;
    for (size_t k = 0; k < w.count; k++)
        if (w.candidates[k].x2 < 300) {
            w.probability[kept] = w.probability[k];
            w.candidates[kept++] = w.candidates[k];
        }
    w.count = kept;
    assert_int_equal(find(&w, &shifted), 0);
    make(&w, 0); /* few matches */
    for (size_t k = 0, left = 5; k < w.count; k++)
        if (w.probability[k] > 0)
            w.probability[k] = left > 0 ? (left--, 1) : 0;
    assert_int_equal(find(&w, &shifted), 0);
}

static void memory_may_be_missing(void **state)
{
    (void)state;
    asj_model shifted;
    wall w;
    make(&w, 0);
    for (long n = 1; n <= 2; n++)
        assert_int_equal(find_without(&w, n, &shifted), -1);
}

/* Who asks for the geometry hears of it. */
static void it_is_told_as_ambiguous(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_geometry_options options;
    asj_geometry g;
    wall w;
    asj_geometry_options_init(&options);
    options.model = ASJ_GEOMETRY_ESSENTIAL;
    for (int v = 0; v < 2; v++) {
        options.widths[v] = WIDTH;
        options.heights[v] = HEIGHT;
        options.cameras[v] = camera;
    }
    make(&w, 0);
    for (size_t k = 0; k < w.count; k++) /* that look most like themselves: evidence has no doubt */
        w.candidates[k].probability = w.probability[k] > 0 ? 0.8 : 0.01;
    assert_int_equal(asj_geometry_estimate(context, w.candidates, w.count, &options, NULL, &g), ASJ_OK);
    assert_true(g.status == ASJ_GEOMETRY_AMBIGUOUS && g.has_rival && isfinite(g.rival_log10_nfa));
    unit_near("matches", 0, 0, g.inliers, w.right, 2);
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_wall_of_crossings_repeats), cmocka_unit_test(what_has_something_of_its_own_does_not),
        cmocka_unit_test(memory_may_be_missing), cmocka_unit_test(it_is_told_as_ambiguous)};
    return cmocka_run_group_tests_name("period", tests, NULL, NULL);
}
