/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_geometry_estimate() where the camera only turns: its rotation is told and no translation; where it moves by what shows, the
 * motion. */
#include "unit_test.h"

#include "geometry/small_matrix.h"

#include <asj/geometry.h>

#define WIDTH 640
#define HEIGHT 480
#define RIGHT 60
#define COUNT (3 * RIGHT)
#define SEEDS 12

static const asj_camera camera = {600, 600, 319.5, 239.5};
static const double none[3] = {0, 0, 0};

typedef struct scene {
    double rotation[9];
    asj_geometry_candidate candidates[COUNT];
} scene;

/* Where a pixel at a depth goes. */
static void map(const scene *s, const double translation[3], double depth, double x, double y, double xy[2])
{
    const double p[3] = {depth * (x - camera.cx) / camera.fx, depth * (y - camera.cy) / camera.fy, depth};
    double q[3];
    asj_apply3(s->rotation, p, q);
    xy[0] = camera.fx * (q[0] + translation[0]) / (q[2] + translation[2]) + camera.cx;
    xy[1] = camera.fy * (q[1] + translation[1]) / (q[2] + translation[2]) + camera.cy;
}

/* RIGHT right ones, 3 to 8 away, with so many px of noise, each with a depth of its own and turned towards the camera; two wrong
 * ones for each place. */
static void make(scene *s, const double translation[3], double noise, uint64_t seed)
{
    static const double w[3] = {0.1, -0.35, 0.05};
    synth_random random;
    synth_random_seed(&random, seed);
    memset(s, 0, sizeof *s);
    asj_rotation_of(w, s->rotation);
    for (uint32_t i = 0; i < COUNT; i++) {
        asj_geometry_candidate *c = &s->candidates[i];
        c->place1 = i % RIGHT;
        c->place2 = i < RIGHT ? i : (7 * i + 3) % RIGHT;
        c->probability = i < RIGHT ? 0.3 : 0.15;
        if (i >= RIGHT) {
            const double angle = synth_random_between(&random, 0, 2 * UNIT_PI), size = exp(synth_random_between(&random, -1, 1));
            c->x1 = s->candidates[c->place1].x1;
            c->y1 = s->candidates[c->place1].y1;
            c->x2 = s->candidates[c->place2].x2;
            c->y2 = s->candidates[c->place2].y2;
            c->affine[0] = c->affine[3] = size * cos(angle);
            c->affine[2] = size * sin(angle);
            c->affine[1] = -c->affine[2];
            continue;
        }
        const double depth = synth_random_between(&random, 3, 8), step = 0.01;
        double at[2], along[2][2];
        c->x1 = synth_random_between(&random, 220, WIDTH - 20); /* what image 2 shows, too */
        c->y1 = synth_random_between(&random, 20, HEIGHT - 20);
        map(s, translation, depth, c->x1, c->y1, at);
        map(s, translation, depth, c->x1 + step, c->y1, along[0]);
        map(s, translation, depth, c->x1, c->y1 + step, along[1]);
        c->x2 = at[0] + noise * synth_random_normal(&random);
        c->y2 = at[1] + noise * synth_random_normal(&random);
        for (int k = 0; k < 2; k++)
            for (int j = 0; j < 2; j++)
                c->affine[2 * j + k] = (along[k][j] - at[j]) / step * (1 + 0.05 * synth_random_normal(&random));
    }
}

static asj_geometry_options options_for(int32_t model, int32_t with_cameras)
{
    asj_geometry_options o;
    asj_geometry_options_init(&o);
    o.model = model;
    o.samples = 300;
    for (int v = 0; v < 2; v++) {
        o.widths[v] = WIDTH;
        o.heights[v] = HEIGHT;
        if (with_cameras)
            o.cameras[v] = camera;
    }
    return o;
}

static asj_geometry estimate(asj_context *context, const scene *s, const asj_geometry_options *o)
{
    asj_geometry g;
    assert_int_equal(asj_geometry_estimate(context, s->candidates, COUNT, o, NULL, &g), ASJ_OK);
    return g;
}

static double turn_error(const asj_geometry *g, const scene *s)
{
    double turn[9];
    asj_multiply3_transposed(g->rotation, s->rotation, turn);
    return asj_rotation_angle(turn) * 180 / UNIT_PI;
}

/* Squared Mahalanobis distance of the true rotation over its three degrees of freedom. */
static double squared_error(const asj_geometry *g, const scene *s)
{
    double turn[9], block[9], inverse[9], weighed[3];
    asj_multiply3_transposed(s->rotation, g->rotation, turn);
    const double w[3] = {0.5 * (turn[7] - turn[5]), 0.5 * (turn[2] - turn[6]), 0.5 * (turn[3] - turn[1])};
    for (int k = 0; k < 9; k++)
        block[k] = g->covariance[k / 3 * 6 + k % 3];
    assert_true(asj_invert3(block, inverse));
    asj_apply3(inverse, w, weighed);
    return asj_dot3(w, weighed) / 3;
}

static void check_turn(const asj_geometry *g, const scene *s, double most)
{
    assert_int_equal(g->status, ASJ_GEOMETRY_ACCEPTED);
    assert_int_equal(g->model, ASJ_GEOMETRY_HOMOGRAPHY);
    assert_true(g->only_turns && !g->has_pose);
    unit_near("rotation, deg", 0, 0, turn_error(g, s), 0, most);
    for (int k = 0; k < 3; k++)
        assert_true(g->translation[k] == 0);
    for (int k = 0; k < 36; k++)
        assert_true((g->covariance[k] != 0) == (k / 6 < 3 && k % 6 < 3));
    for (uint32_t k = 0; k < RIGHT; k++) {
        const double x[3] = {s->candidates[k].x1, s->candidates[k].y1, 1};
        double y[3];
        asj_apply3(g->matrix, x, y);
        assert_true(y[2] > 0);
        unit_near("x", (int)k, 0, y[0] / y[2], s->candidates[k].x2, 5);
        unit_near("y", (int)k, 0, y[1] / y[2], s->candidates[k].y2, 5);
    }
}

static void a_turn_has_a_rotation_and_no_translation(void **state)
{
    (void)state;
    static const double so_far[3] = {0.001, 0, 0.001}; /* thousands of baselines away: as good as none */
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene *s = malloc(sizeof *s);
    const asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, 1);
    double sum = 0;
    for (uint64_t n = 0; n < SEEDS; n++) {
        make(s, n % 2 ? so_far : none, n < SEEDS / 2 ? 0.5 : 1, 100 + n);
        const asj_geometry g = estimate(context, s, &o);
        check_turn(&g, s, 0.3);
        assert_true(g.cameras[0].fx == camera.fx && g.cameras[1].cy == camera.cy && g.focal_sd == 0);
        sum += n < SEEDS / 2 ? squared_error(&g, s) : 0;
    }
    unit_near("mean squared error over what is told", 0, 0, sum / (SEEDS / 2), 0.75, 0.5); /* as in test_geometry.c */
    free(s);
    unit_context_free(&counter, &context);
}

static void a_step_that_shows_is_told(void **state)
{
    (void)state;
    static const double steps[2][3] = {{0.35, 0.05, 0.1}, {0.2, 0.03, 0.05}};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene *s = malloc(sizeof *s);
    int out = 0;
    for (uint64_t n = 0; n < 2 * SEEDS; n++) {
        const double *step = steps[n % 2];
        const asj_geometry_options o = options_for(n % 4 < 2 ? ASJ_GEOMETRY_AUTO : ASJ_GEOMETRY_ESSENTIAL, 1);
        make(s, step, 1, 200 + n);
        const asj_geometry g = estimate(context, s, &o);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        assert_int_equal(g.model, ASJ_GEOMETRY_ESSENTIAL);
        assert_true(!g.only_turns && g.has_pose);
        const double along = asj_dot3(g.translation, step) / sqrt(asj_dot3(step, step));
        if (n % 2 && turn_error(&g, s) > 1.5) { /* planes suit the errors of the smaller step, and another motion */
            out++;
            continue;
        }
        unit_near("rotation, deg", (int)n, 0, turn_error(&g, s), 0, 1.5);
        unit_near("translation, deg", (int)n, 0, acos(fmin(1, along)) * 180 / UNIT_PI, 0, 12);
    }
    assert_in_range(out, 0, 1);
    free(s);
    unit_context_free(&counter, &context);
}

static void an_essential_matrix_stays_open(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene *s = malloc(sizeof *s);
    for (uint64_t n = 0; n < 8; n++) {
        asj_geometry_options o = options_for(ASJ_GEOMETRY_ESSENTIAL, n % 2 == 0);
        o.find_focal = n % 2;
        make(s, none, 1, 300 + n);
        const asj_geometry g = estimate(context, s, &o);
        assert_int_equal(g.status, ASJ_GEOMETRY_DEGENERATE);
        assert_true(g.only_turns && !g.has_pose && asj_dot3(g.translation, g.translation) == 0);
        unit_near("rotation, deg", (int)n, 0, turn_error(&g, s), 0, o.find_focal ? 0.8 : 0.3);
    }
    free(s);
    unit_context_free(&counter, &context);
}

static void a_turn_tells_the_focal_length(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene *s = malloc(sizeof *s);
    asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, 0);
    make(s, none, 1, 400);
    const asj_geometry blind = estimate(context, s, &o);
    assert_int_equal(blind.model, ASJ_GEOMETRY_HOMOGRAPHY);
    assert_true(!blind.only_turns && blind.cameras[0].fx == 0 && asj_dot3(blind.rotation, blind.rotation) == 0);
    o.find_focal = 1;
    for (uint64_t n = 0; n < 4; n++) {
        make(s, none, 1, 400 + n);
        const asj_geometry g = estimate(context, s, &o);
        check_turn(&g, s, 0.8);
        unit_near("focal length", (int)n, 0, g.cameras[0].fx / camera.fx, 1, 0.03);
        assert_true(g.cameras[1].fx == g.cameras[0].fx && g.focal_sd > 0.003 && g.focal_sd < 0.05);
    }
    free(s);
    unit_context_free(&counter, &context);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    scene *s = malloc(sizeof *s);
    asj_geometry first;
    make(s, none, 1, 500);
    for (int32_t find_focal = 0; find_focal < 2; find_focal++)
        for (int32_t threads = 1; threads <= 3; threads++) {
            unit_counter counter = {0};
            asj_context *context = unit_context(&counter, threads);
            asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, !find_focal);
            o.find_focal = find_focal;
            const asj_geometry g = estimate(context, s, &o);
            if (threads == 1)
                first = g;
            assert_memory_equal(&g, &first, sizeof g);
            unit_context_free(&counter, &context);
        }
    free(s);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    scene *s = malloc(sizeof *s);
    make(s, none, 1, 600);
    for (int32_t find_focal = 0; find_focal < 2; find_focal++) {
        long calls = 0;
        for (long at = 0; at <= calls; at += at < 8 ? 1 : find_focal ? 97 : 17) {
            unit_counter counter = {0};
            asj_context *context = unit_context(&counter, 1);
            asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, !find_focal);
            asj_geometry g;
            o.find_focal = find_focal;
            o.samples = 20;
            const long before = counter.calls;
            counter.fail_at = at > 0 ? before + at : 0;
            const asj_status status = asj_geometry_estimate(context, s->candidates, COUNT, &o, NULL, &g);
            assert_true(status == ASJ_OK || (at > 0 && status == ASJ_ERROR_MEMORY));
            calls = at == 0 ? counter.calls - before : calls;
            counter.fail_at = 0;
            unit_context_free(&counter, &context);
        }
        assert_true(calls > 20);
    }
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_turn_has_a_rotation_and_no_translation),
        cmocka_unit_test(a_step_that_shows_is_told),
        cmocka_unit_test(an_essential_matrix_stays_open),
        cmocka_unit_test(a_turn_tells_the_focal_length),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("pure rotation", tests, NULL, NULL);
}
