/* SPDX-License-Identifier: BSD-2-Clause */
/* The last step of a pose: matches that lie exactly where the cameras put them bring it back, wrong ones and crowds do not pull it
 * away, what is told of it holds it, and where there is nothing to be said it stays as it is, bit for bit. */
#include "unit_test.h"

#include "geometry/model.h"
#include "geometry/small_matrix.h"
#include "match/final_pose.h"

#define MOST 160
#define EXACT 0.05 /* px: standard deviation of a location */
#define DEGREE (UNIT_PI / 180)

static const asj_camera cameras[2] = {{520, 500, 310, 245}, {600, 610, 330, 230}};

typedef struct scene {
    double rotation[9], translation[3];
    asj_junction_match matches[MOST];
    uint32_t count;
} scene;

static void see(const asj_camera *camera, const double p[3], double noise, synth_random *random, float xy[2])
{
    xy[0] = (float)(camera->fx * p[0] / p[2] + camera->cx + noise * synth_random_normal(random));
    xy[1] = (float)(camera->fy * p[1] / p[2] + camera->cy + noise * synth_random_normal(random));
}

/* Points 3 to 8 away. Of ten matches the last `wrong` are tens of px off. */
static void make(scene *s, uint64_t seed, uint32_t count, uint32_t wrong)
{
    static const double turn[3] = {0.1, -0.4, 0.05}, translation[3] = {0.9, -0.1, 0.42};
    synth_random random;
    synth_random_seed(&random, seed);
    memset(s, 0, sizeof *s);
    asj_rotation_of(turn, s->rotation);
    memcpy(s->translation, translation, sizeof s->translation);
    asj_normalise3(s->translation);
    for (; s->count < count; s->count++) {
        asj_junction_match *m = &s->matches[s->count];
        const double deep = synth_random_between(&random, 3, 8);
        const double x = synth_random_between(&random, -0.5, 0.5), y = synth_random_between(&random, -0.4, 0.4);
        const double p[3] = {deep * x, deep * y, deep};
        double q[3];
        float at[2][2];
        asj_apply3(s->rotation, p, q);
        for (int k = 0; k < 3; k++)
            q[k] += s->translation[k];
        see(&cameras[0], p, EXACT, &random, at[0]);
        see(&cameras[1], q, s->count % 10 < 10 - wrong ? EXACT : 30, &random, at[1]);
        m->x1 = at[0][0];
        m->y1 = at[0][1];
        m->x2 = at[1][0];
        m->y2 = at[1][1];
        m->probability = 0.9F;
    }
}

/* The scene's matches with its pose turned by `off` about an axis and moved by three times as much, which is told to `sd`, rad. */
static asj_match_result *result_of(unit_counter *counter, const scene *s, double off, double sd)
{
    static const double axis[3] = {0.5, 0.7, -0.5};
    asj_memory memory = unit_memory(counter);
    asj_own_result *r = asj_allocate_zero(&memory, 1, sizeof *r);
    assert_non_null(r);
    r->memory = memory;
    r->count = s->count;
    r->matches = asj_allocate(&memory, MOST, sizeof *r->matches);
    assert_non_null(r->matches);
    memcpy(r->matches, s->matches, sizeof s->matches);
    for (int side = 0; side < 2; side++) {
        r->places[side] = asj_allocate(&memory, MOST, sizeof *r->places[side]);
        assert_non_null(r->places[side]);
        asj_places_sort(r->places[side], r->matches, r->count, side);
    }
    r->shown.origin = (uint64_t)(uintptr_t)r;
    r->shown.matches = r->matches;
    r->shown.match_count = s->count;
    asj_geometry *g = &r->shown.geometry;
    g->status = ASJ_GEOMETRY_ACCEPTED;
    g->model = ASJ_GEOMETRY_ESSENTIAL;
    g->has_pose = 1;
    memcpy(g->cameras, cameras, sizeof g->cameras);
    double across[2][3], w[3], turn[9];
    for (int k = 0; k < 3; k++)
        w[k] = off * axis[k];
    asj_rotation_of(w, turn);
    asj_multiply3(turn, s->rotation, g->rotation);
    asj_translation_axes(s->translation, across[0], across[1]);
    for (int k = 0; k < 3; k++)
        g->translation[k] = s->translation[k] + 3 * off * across[0][k];
    asj_normalise3(g->translation);
    for (int i = 0; i < 3; i++) {
        g->covariance[7 * i] = sd * sd;
        for (int k = 0; k < 3; k++) /* nothing along itself */
            g->covariance[6 * (3 + i) + 3 + k] = 9 * sd * sd * ((i == k) - g->translation[i] * g->translation[k]);
    }
    return &r->shown;
}

/* Degrees: of the rotation and of the translation, the larger. */
static double error_of(const scene *s, const asj_geometry *g)
{
    double rest[9], apart[3];
    asj_multiply3_transposed(g->rotation, s->rotation, rest);
    for (int k = 0; k < 3; k++)
        apart[k] = g->translation[k] - s->translation[k];
    return fmax(asj_rotation_angle(rest), sqrt(asj_dot3(apart, apart))) / DEGREE;
}

static void expect_consistent(const asj_geometry *g)
{
    double essential[9], cross[9], sum = 0;
    asj_skew3(g->translation, cross);
    asj_multiply3(cross, g->rotation, essential);
    unit_near("length", 0, 0, sqrt(asj_dot3(g->translation, g->translation)), 1, 1e-12);
    unit_near("determinant", 0, 0, asj_determinant3(g->rotation), 1, 1e-9);
    for (int k = 0; k < 9; k++)
        sum += g->matrix[k] * g->matrix[k];
    unit_near("norm", 0, 0, sum, 1, 1e-12);
    double at1[3] = {100, 400, 1}, ray[3], line[3], expected[3];
    asj_ray(&cameras[0], at1[0], at1[1], ray); /* the epipolar line of a pixel, by the pose and by the matrix */
    asj_apply3(essential, ray, expected);
    const double a = expected[0] / cameras[1].fx, b = expected[1] / cameras[1].fy;
    const double by_pose[3] = {a, b, expected[2] - a * cameras[1].cx - b * cameras[1].cy};
    asj_apply3(g->matrix, at1, line);
    unit_near("direction of a line", 0, 0, (line[0] * by_pose[1] - line[1] * by_pose[0]) / hypot(line[0], line[1]) /
              hypot(by_pose[0], by_pose[1]), 0, 1e-9);
    unit_near("line", 0, 0, line[2] / line[1], by_pose[2] / by_pose[1], 1e-6 * fabs(by_pose[2] / by_pose[1]));
}

/* One call; the errors before and after, degrees. */
static void finish(asj_context *context, unit_counter *counter, const scene *s, double off, double sd, double errors[2])
{
    asj_match_result *r = result_of(counter, s, off * DEGREE, sd * DEGREE);
    double told[36];
    memcpy(told, r->geometry.covariance, sizeof told);
    errors[0] = error_of(s, &r->geometry);
    assert_int_equal(asj_finish_pose(context, &r), ASJ_OK);
    errors[1] = error_of(s, &r->geometry);
    assert_memory_equal(told, r->geometry.covariance, sizeof told);
    expect_consistent(&r->geometry);
    asj_match_result_free(&r);
}

static void exact_matches_bring_it_back(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    static scene s;
    double errors[2];
    for (uint32_t wrong = 0; wrong < 4; wrong++) {
        make(&s, 3 + wrong, 120, wrong);
        finish(context, &counter, &s, 0.6, 0.6, errors);
        assert_true(errors[0] > 1.5);
        unit_near("error, deg, with so many of ten wrong", wrong, 0, errors[1], 0, 0.06);
    }
    unit_context_free(&counter, &context);
}

/* Sixty matches of one corner that are a pixel off weigh as one. */
static void a_crowd_weighs_as_one(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    static scene s;
    double errors[2];
    make(&s, 5, 100, 0);
    for (uint32_t k = 0; k < 60; k++) {
        s.matches[s.count] = s.matches[0];
        s.matches[s.count].x1 += 0.04F * (float)k;
        s.matches[s.count++].y2 += 1 + 0.02F * (float)k;
    }
    finish(context, &counter, &s, 0.3, 0.3, errors);
    unit_near("error beside a crowd, deg", 0, 0, errors[1], 0, 0.1);
    unit_context_free(&counter, &context);
}

/* A pose that is told to a thousandth of a degree moves no farther than that goes; one told to a degree does. */
static void what_is_told_holds_it(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    static scene s;
    double sure[2], unsure[2];
    make(&s, 7, 110, 1);
    finish(context, &counter, &s, 0.5, 0.0005, sure);
    finish(context, &counter, &s, 0.5, 1, unsure);
    assert_true(fabs(sure[1] - sure[0]) < 0.2 && unsure[1] < 0.1 * sure[1]);
    unit_context_free(&counter, &context);
}

static void expect_as_it_was(asj_context *context, asj_match_result *r)
{
    const asj_geometry before = r->geometry;
    assert_int_equal(asj_finish_pose(context, &r), ASJ_OK);
    assert_memory_equal(&before, &r->geometry, sizeof before);
    asj_match_result_free(&r);
}

static void otherwise_it_stays(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    static scene s;
    make(&s, 9, 110, 0);
    asj_match_result *r = result_of(&counter, &s, 0.01, 0.01);
    memset(r->geometry.cameras, 0, sizeof r->geometry.cameras);
    expect_as_it_was(context, r);
    r = result_of(&counter, &s, 0.01, 0.01);
    r->geometry.status = ASJ_GEOMETRY_AMBIGUOUS;
    expect_as_it_was(context, r);
    r = result_of(&counter, &s, 0.01, 0.01);
    r->geometry.has_pose = 0;
    expect_as_it_was(context, r);
    r = result_of(&counter, &s, 0.01, 0.01);
    r->geometry.focal_sd = 0.02;
    expect_as_it_was(context, r);
    r = result_of(&counter, &s, 0.01, 0.01);
    r->geometry.covariance[0] = NAN;
    expect_as_it_was(context, r);
    for (uint32_t k = 0; k < s.count; k++)
        s.matches[k].probability = k < 20 ? 0.9F : 0.5F; /* too few that are probable */
    expect_as_it_was(context, result_of(&counter, &s, 0.01, 0.01));
    s.count = 0;
    expect_as_it_was(context, result_of(&counter, &s, 0.01, 0.01));
    unit_context_free(&counter, &context);
}

/* A homography is of a plane, and stays; the pose that goes with it does not. */
static void a_homography_stays(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    static scene s;
    make(&s, 11, 110, 0);
    asj_match_result *r = result_of(&counter, &s, 0.01, 0.01);
    r->geometry.model = ASJ_GEOMETRY_HOMOGRAPHY;
    const asj_geometry before = r->geometry;
    assert_int_equal(asj_finish_pose(context, &r), ASJ_OK);
    assert_memory_equal(before.matrix, r->geometry.matrix, sizeof before.matrix);
    assert_true(error_of(&s, &r->geometry) < 0.2 * error_of(&s, &before));
    asj_match_result_free(&r);
    unit_context_free(&counter, &context);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    static scene s;
    make(&s, 13, 40, 0);
    for (long fail_at = 1; fail_at <= 2; fail_at++) {
        unit_counter counter = {0}, of_result = {0};
        asj_context *context = unit_context(&counter, 1);
        asj_match_result *r = result_of(&of_result, &s, 0.01, 0.01);
        counter.calls = 0;
        counter.fail_at = fail_at;
        assert_int_equal(asj_finish_pose(context, &r), ASJ_ERROR_MEMORY);
        assert_null(r);
        assert_int_equal(of_result.live, 0);
        assert_true(unit_reached(&counter));
        unit_context_free(&counter, &context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_matches_bring_it_back), cmocka_unit_test(a_crowd_weighs_as_one),
        cmocka_unit_test(what_is_told_holds_it), cmocka_unit_test(otherwise_it_stays), cmocka_unit_test(a_homography_stays),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("final_pose", tests, NULL, NULL);
}
