/* SPDX-License-Identifier: BSD-2-Clause */
/* src/geometry/around_rotation.c: of a motion with another rotation, the translation and the planes, however far these were. */
#include "unit_test.h"

#include "core/angle.h"
#include "geometry/around_rotation.h"
#include "geometry/evidence.h"
#include "geometry/pairs.h"
#include "geometry/small_matrix.h"

#define PLANES 2
#define ON_PLANE 30
#define COUNT (PLANES * ON_PLANE)
#define FOCAL 900.0

static const asj_camera camera = {FOCAL, FOCAL, 319.5, 239.5};

typedef struct wall_scene {
    asj_model right;
    asj_geometry_candidate list[COUNT];
} wall_scene;

/* A wall and a floor, the camera turned by 30 degrees. */
static void make_motion(int32_t planes, asj_model *m)
{
    static const double turn[3] = {0.03, -0.5, 0.02}, normals[PLANES][3] = {{0.06, 0, 0.19}, {0.02, 0.45, 0.05}};
    memset(m, 0, sizeof *m);
    m->kind = ASJ_GEOMETRY_ESSENTIAL;
    m->parameters = 5 + 3 * planes;
    m->cameras[0] = m->cameras[1] = camera;
    asj_rotation_of(turn, m->rotation);
    m->translation[0] = 0.9;
    m->translation[1] = -0.1;
    m->translation[2] = 0.42;
    memcpy(m->planes, normals, sizeof normals);
    m->view.plane_count = planes;
    assert_true(asj_model_complete(m));
}

static void map(const asj_model *m, const double n[3], double x, double y, double at[2])
{
    double ray[3], q[3];
    asj_ray(&camera, x, y, ray);
    const double nearness = asj_dot3(n, ray);
    asj_apply3(m->rotation, ray, q);
    for (int32_t k = 0; k < 3; k++)
        q[k] += nearness * m->translation[k];
    at[0] = FOCAL * q[0] / q[2] + camera.cx;
    at[1] = FOCAL * q[1] / q[2] + camera.cy;
}

/* Corners in a part of the image that is so wide, px; all on the first plane where there is one. */
static void make(wall_scene *s, int32_t planes, double wide, double noise)
{
    synth_random random;
    synth_random_seed(&random, 4);
    memset(s, 0, sizeof *s);
    make_motion(planes, &s->right);
    for (uint32_t k = 0; k < COUNT; k++) {
        asj_geometry_candidate *c = &s->list[k];
        const double *n = s->right.planes[k % (uint32_t)planes], step = 0.01;
        double at[2], along[2][2];
        c->x1 = camera.cx + synth_random_between(&random, -wide / 2, wide / 2);
        c->y1 = camera.cy + synth_random_between(&random, 20, 200);
        map(&s->right, n, c->x1, c->y1, at);
        map(&s->right, n, c->x1 + step, c->y1, along[0]);
        map(&s->right, n, c->x1, c->y1 + step, along[1]);
        for (int32_t i = 0; i < 4; i++)
            c->affine[i] = (along[i % 2][i / 2] - at[i / 2]) / step;
        c->x2 = at[0] + noise * synth_random_normal(&random);
        c->y2 = at[1] + noise * synth_random_normal(&random);
        c->place1 = c->place2 = k;
        c->probability = 0.5;
    }
}

static asj_adjust_scratch *start(asj_context *context, const wall_scene *s, asj_pairs *set)
{
    asj_geometry_options options;
    asj_geometry_options_init(&options);
    for (int32_t v = 0; v < 2; v++) {
        options.widths[v] = 640;
        options.heights[v] = 480;
        options.cameras[v] = camera;
    }
    assert_int_equal(asj_pairs_create(context, s->list, COUNT, NULL, &options, set), ASJ_OK);
    asj_adjust_scratch *scratch = asj_adjust_scratches_create(&context->memory, set, context->threads);
    assert_non_null(scratch);
    return scratch;
}

static void end(asj_context *context, asj_pairs *set, asj_adjust_scratch *scratch)
{
    asj_adjust_scratches_free(&context->memory, scratch, context->threads);
    asj_pairs_free(&context->memory, set);
}

/* From the other side, at right angles, with planes ten times as near: all comes back, and the rotation stays. */
static void test_what_is_far_comes_back(void **state)
{
    static const double starts[][3] = {{-0.9, 0.1, -0.42}, {0.42, 0, -0.9}, {0, 1, 0}, {0.9, -0.1, 0.42}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(starts); k++)
        for (int32_t planes = 1; planes <= PLANES; planes++) {
            wall_scene s;
            asj_pairs set;
            make(&s, planes, 500, 0);
            asj_adjust_scratch *scratch = start(context, &s, &set);
            asj_model m = s.right;
            memcpy(m.translation, starts[k], sizeof m.translation);
            for (int32_t i = 0; i < 3 * planes; i++)
                m.planes[i / 3][i % 3] *= 10;
            assert_true(asj_model_complete(&m));
            asj_adjust_around_rotation(&set, &m, &s.right, scratch);
            for (int32_t i = 0; i < 9; i++)
                unit_near("rotation", (double)k, i, m.rotation[i], s.right.rotation[i], 1e-15);
            unit_near("motion", (double)k, planes, asj_motions_apart(&m, &s.right) / ASJ_DEGREE, 0, 0.01);
            for (int32_t i = 0; i < 3 * planes; i++)
                unit_near("plane", (double)k, i, m.planes[i / 3][i % 3], s.right.planes[i / 3][i % 3], 1e-3);
            end(context, &set, scratch);
        }
}

/* Of a small piece of a wall, with .3 px of noise, a motion that turns by up to 9 degrees more explains nearly as much; it has the
 * camera and the wall elsewhere. */
static void test_small_walls_allow_other_rotations(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    wall_scene s;
    asj_pairs set;
    make(&s, 1, 100, 0.3);
    asj_adjust_scratch *scratch = start(context, &s, &set);
    asj_model right = s.right;
    asj_adjust(&set, &right, 10, scratch);
    right.evidence = asj_log_evidence(&set, &right, scratch);
    for (int32_t degrees = -9; degrees <= 9; degrees += 3) {
        const double turn[3] = {0, degrees * ASJ_DEGREE, 0};
        double moved[9];
        asj_model m = right;
        asj_rotation_of(turn, moved);
        asj_multiply3(moved, right.rotation, m.rotation);
        assert_true(asj_model_complete(&m));
        asj_adjust_around_rotation(&set, &m, &right, scratch);
        m.evidence = asj_log_evidence(&set, &m, scratch);
        print_message("%+d degrees: %.1f of %.1f nats, translation %.1f degrees on\n", (int)degrees, m.evidence, right.evidence,
                      acos(fmin(1, asj_dot3(m.translation, right.translation))) / ASJ_DEGREE);
        assert_true(m.evidence > 0.8 * right.evidence);
    }
    end(context, &set, scratch);
}

/* A camera that only turns has no translation, and a plane no depth: whatever comes is finite. */
static void test_no_parallax(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    wall_scene s;
    asj_pairs set;
    make(&s, 1, 500, 0);
    for (uint32_t k = 0; k < COUNT; k++) {
        static const double far[3] = {0, 0, 0};
        double at[2];
        map(&s.right, far, s.list[k].x1, s.list[k].y1, at);
        s.list[k].x2 = at[0];
        s.list[k].y2 = at[1];
    }
    asj_adjust_scratch *scratch = start(context, &s, &set);
    asj_model m = s.right;
    asj_adjust_around_rotation(&set, &m, &s.right, scratch);
    for (int32_t i = 0; i < 3; i++)
        assert_true(isfinite(m.translation[i]) && isfinite(m.planes[0][i]));
    end(context, &set, scratch);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_what_is_far_comes_back),
        cmocka_unit_test(test_small_walls_allow_other_rotations),
        cmocka_unit_test(test_no_parallax),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
