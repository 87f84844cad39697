/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_find_vanishing_points(): the directions of rendered rooms, none in noise, bad input. */
#include "unit_test.h"

#include "core/context.h"

#include "wide_pair.h"

#include <asj/asj.h>

#define SIZE 400

/* Degrees between a direction and the nearest axis of the room, whose columns are those of the camera's rotation. */
static double from_axis(const double direction[3], const synth_camera *camera)
{
    double r[9], t[3], best = 90;
    synth_camera straight = *camera;
    straight.yaw = straight.pitch = straight.roll = 0;
    straight.position.x += 1;
    synth_relative_pose(&straight, camera, r, t);
    for (int a = 0; a < 3; a++) {
        const double dot = direction[0] * r[a] + direction[1] * r[3 + a] + direction[2] * r[6 + a];
        best = fmin(best, acos(fmin(1, fabs(dot))) * 180 / UNIT_PI);
    }
    return best;
}

static void rooms_have_three_directions(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    int points = 0, focals = 0;
    for (uint64_t seed = 9; seed <= 12; seed++) {
        synth_wide_pair pair;
        assert_int_equal(synth_wide_pair_make(&pair, seed), 0);
        const synth_camera *camera = &pair.cameras[0];
        uint8_t *pixels = synth_wide_picture(&pair, 0);
        const asj_image image = {pixels, ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
        asj_detection *found = NULL;
        asj_vanishing_options options;
        asj_vanishing_points with, without, again;
        assert_non_null(pixels);
        assert_int_equal(asj_detect(context, &image, NULL, &found), ASJ_OK);
        asj_vanishing_options_init(&options);
        options.width = SYNTH_WIDE_WIDTH;
        options.height = SYNTH_WIDE_HEIGHT;
        assert_int_equal(asj_find_vanishing_points(context, found->junctions, found->junction_count, &options, &without), ASJ_OK);
        options.camera = (asj_camera){camera->focal, camera->focal, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
        assert_int_equal(asj_find_vanishing_points(context, found->junctions, found->junction_count, &options, &with), ASJ_OK);
        assert_int_equal(asj_find_vanishing_points(context, found->junctions, found->junction_count, &options, &again), ASJ_OK);
        assert_memory_equal(&with, &again, sizeof with);
        assert_int_equal(with.focal_source, ASJ_FOCAL_GIVEN);
        assert_in_range(with.count, 2, 3);
        for (int32_t k = 0; k < with.count; k++) {
            const asj_vanishing_point *p = &with.points[k];
            unit_near("direction, deg", (double)seed, k, from_axis(p->direction, camera), 0, 0.8);
            assert_true(p->log10_nfa <= -2 && p->branch_count >= 3);
            assert_true(k == 0 || p->log10_nfa >= with.points[k - 1].log10_nfa);
            for (int32_t m = 0; m < k; m++) { /* at right angles */
                const double *q = with.points[m].direction;
                const double dot = p->direction[0] * q[0] + p->direction[1] * q[1] + p->direction[2] * q[2];
                unit_near("dot", (double)seed, k, dot, 0, 1e-6);
            }
            /* the point is the image of the direction */
            const double x = camera->focal * p->direction[0] + options.camera.cx * p->direction[2];
            unit_near("point", (double)seed, k, x * p->point[2], p->point[0] * p->direction[2], 1e-6 * camera->focal);
            points++;
        }
        if (without.focal_source == ASJ_FOCAL_FOUND) {
            unit_near("focal length", (double)seed, 0, without.camera.fx / camera->focal, 1, 0.08);
            focals++;
        }
        asj_detection_free(&found);
        free(pixels);
        synth_wide_pair_free(&pair);
    }
    assert_in_range(points, 10, 12);
    assert_in_range(focals, 3, 4);
    unit_context_free(&counter, &context);
}

/* Without a focal length: points 4 degrees apart are one direction, others two, the surer one first; with one, two that are not at
 * right angles are the surer one. */
static void near_points_are_one(void **state)
{
    static const double second[2][2] = {{1800, 420}, {1000, 900}};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    synth_random random;
    (void)state;
    synth_random_seed(&random, 78);
    for (int32_t n = 0; n < 2; n++) {
        asj_junction list[60];
        asj_vanishing_options options;
        asj_vanishing_points found;
        memset(list, 0, sizeof list);
        for (int32_t k = 0; k < 60; k++) {
            const double x = k < 25 ? 2000 : second[n][0], y = k < 25 ? 300 : second[n][1];
            list[k].x = (float)synth_random_between(&random, 0, 640);
            list[k].y = (float)synth_random_between(&random, 0, 480);
            list[k].branch_count = 1;
            list[k].branches[0].angle = (float)atan2(y - (double)list[k].y, x - (double)list[k].x);
            list[k].branches[0].length = 50;
            list[k].branches[0].angle_sd = 0.004F;
        }
        asj_vanishing_options_init(&options);
        options.width = 640;
        options.height = 480;
        assert_int_equal(asj_find_vanishing_points(context, list, 60, &options, &found), ASJ_OK);
        assert_int_equal(found.focal_source, ASJ_FOCAL_UNKNOWN);
        assert_int_equal(found.count, n + 1);
        unit_near("the surer one", n, 0, found.points[0].point[0] / found.points[0].point[2], second[n][0], 30);
        assert_true(n == 0 || found.points[0].log10_nfa < found.points[1].log10_nfa);
        options.camera = (asj_camera){500, 500, 319.5, 239.5}; /* 40 degrees apart: the surest alone */
        assert_int_equal(asj_find_vanishing_points(context, list, 60, &options, &found), ASJ_OK);
        assert_int_equal(found.focal_source, ASJ_FOCAL_GIVEN);
        assert_int_equal(found.count, 1);
        unit_near("the surest one", n, 0, found.points[0].point[0] / found.points[0].point[2], second[n][0], 30);
    }
    unit_context_free(&counter, &context);
}

/* Two points of directions at right angles, seen `angle` degrees and 90 less that from the optical axis of a camera of 1000 px, to
 * either side: the focal length is uncertain by 2 % at 80 degrees, by 7 % at 87, and known worse than 5 % it is none. */
static void a_focal_length_is_known_or_not(void **state)
{
    enum { MANY = 60 };
    static const struct {
        double angle;
        int32_t source;
    } cases[] = {{80, ASJ_FOCAL_FOUND}, {87, ASJ_FOCAL_UNKNOWN}};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (size_t n = 0; n < UNIT_COUNT(cases); n++) {
        const double tangent = tan(cases[n].angle * UNIT_PI / 180), middle = 499.5;
        const double at[2] = {middle + 1000 * tangent, middle - 1000 / tangent};
        asj_junction list[MANY];
        asj_vanishing_options options;
        asj_vanishing_points found;
        synth_random random;
        synth_random_seed(&random, 79);
        memset(list, 0, sizeof list);
        for (int32_t k = 0; k < MANY; k++) {
            list[k].x = (float)synth_random_between(&random, 0, 1000);
            list[k].y = (float)synth_random_between(&random, 0, 1000);
            list[k].branch_count = 1;
            list[k].branches[0] = (asj_branch){.length = 50, .angle_sd = 0.004F};
            list[k].branches[0].angle = (float)atan2(middle - (double)list[k].y, at[k % 2] - (double)list[k].x);
        }
        asj_vanishing_options_init(&options);
        options.width = options.height = 1000;
        assert_int_equal(asj_find_vanishing_points(context, list, MANY, &options, &found), ASJ_OK);
        assert_int_equal(found.focal_source, cases[n].source);
        assert_true(found.count >= 2);
        unit_near("focal length", cases[n].angle, 0, found.camera.fx, cases[n].source == ASJ_FOCAL_FOUND ? 1000 : 0, 30);
    }
    unit_context_free(&counter, &context);
}

/* Three directions at right angles among branches of chance. The second and third one have five lines each: less than chance brings
 * to points by themselves, but found together they are sure, and so is the focal length, within 2 %. */
static void few_lines_of_a_direction_are_enough(void **state)
{
    enum { UPRIGHT = 14, FEW = 5, CHANCE = 16, ALL = UPRIGHT + 2 * FEW + CHANCE };
    static const double focal = 600, axes[3][3] = {{0, 0.96, 0.28}, {0.6, -0.224, 0.768}, {0.8, 0.168, -0.576}};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (uint64_t seed = 1; seed <= 5; seed++) {
        asj_junction list[ALL];
        asj_vanishing_options options;
        asj_vanishing_points found;
        synth_random random;
        synth_random_seed(&random, 90 + seed);
        memset(list, 0, sizeof list);
        for (int32_t k = 0; k < ALL; k++) {
            const int32_t of = k < UPRIGHT ? 0 : k < UPRIGHT + FEW ? 1 : k < UPRIGHT + 2 * FEW ? 2 : 3;
            double angle = synth_random_between(&random, 0, 2 * UNIT_PI);
            list[k].x = (float)synth_random_between(&random, 0, 640);
            list[k].y = (float)synth_random_between(&random, 0, 480);
            if (of < 3) { /* towards the point of the direction, from here */
                const double *d = axes[of], x = (double)list[k].x - 319.5, y = (double)list[k].y - 239.5;
                angle = atan2(focal * d[1] - d[2] * y, focal * d[0] - d[2] * x);
            }
            list[k].branch_count = 1;
            list[k].branches[0] = (asj_branch){.angle = (float)angle, .length = of < 3 ? 60.0F : 40.0F, .angle_sd = 0.003F};
        }
        asj_vanishing_options_init(&options);
        options.width = 640;
        options.height = 480;
        assert_int_equal(asj_find_vanishing_points(context, list, ALL, &options, &found), ASJ_OK);
        assert_int_equal(found.focal_source, ASJ_FOCAL_FOUND);
        assert_int_equal(found.count, 3);
        unit_near("focal length", (double)seed, 0, found.camera.fx, focal, 12);
        for (int32_t k = 0; k < 3; k++) {
            double most = 0;
            for (int32_t a = 0; a < 3; a++) {
                const double *d = found.points[k].direction;
                most = fmax(most, fabs(d[0] * axes[a][0] + d[1] * axes[a][1] + d[2] * axes[a][2]));
            }
            unit_near("direction", (double)seed, k, most, 1, 1e-4);
        }
    }
    unit_context_free(&counter, &context);
}

/* What a function finds on the stack that has not written there: no number that can be. */
static int32_t fill_stack(void)
{
    volatile unsigned char bytes[60000];
    int32_t sum = 0;
    for (size_t k = 0; k < sizeof bytes; k++) {
        bytes[k] = 0x7f;
        sum += bytes[k];
    }
    return sum;
}

/* Three lines and three others at 93 degrees to them: brought to right angles, no line votes for the second direction, and those of
 * the first are as many as define a frame. */
static void a_frame_without_votes_is_none(void **state)
{
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_vanishing_options options;
    asj_vanishing_points found;
    asj_junction list[6];
    (void)state;
    memset(list, 0, sizeof list);
    for (int32_t k = 0; k < 6; k++) {
        list[k].x = (float)(k < 3 ? 40 + 150 * k : 100 + 200 * (k - 3));
        list[k].y = (float)(k < 3 ? 60 + 170 * k : 30);
        list[k].branch_count = 1;
        list[k].branches[0] = (asj_branch){.angle = k < 3 ? 0 : (float)(93 * UNIT_PI / 180), .length = 120, .angle_sd = 0.004F};
    }
    asj_vanishing_options_init(&options);
    options.width = 640;
    options.height = 480;
    options.camera = (asj_camera){500, 500, 319.5, 239.5};
    assert_int_equal(fill_stack(), 60000 * 0x7f);
    assert_int_equal(asj_find_vanishing_points(context, list, 6, &options, &found), ASJ_OK);
    assert_int_equal(found.count, 0);
    unit_context_free(&counter, &context);
}

/* Branches of any direction at any place: what is found is a false alarm; epsilon 0.01 allows none of 40 images, nearly always. */
static void chance_has_no_directions(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_junction list[120];
    synth_random random;
    int alarms = 0;
    synth_random_seed(&random, 77);
    for (int i = 0; i < 40; i++) {
        asj_vanishing_options options;
        asj_vanishing_points found;
        memset(list, 0, sizeof list);
        for (int k = 0; k < 120; k++) {
            list[k].x = (float)synth_random_between(&random, 0, SIZE);
            list[k].y = (float)synth_random_between(&random, 0, SIZE);
            list[k].branch_count = 2;
            for (int b = 0; b < 2; b++) {
                list[k].branches[b].angle = (float)synth_random_between(&random, 0, 2 * UNIT_PI);
                list[k].branches[b].length = (float)synth_random_between(&random, 15, 60);
                list[k].branches[b].angle_sd = 0.004F;
            }
        }
        asj_vanishing_options_init(&options);
        options.width = options.height = SIZE;
        assert_int_equal(asj_find_vanishing_points(context, list, 120, &options, &found), ASJ_OK);
        alarms += found.count;
    }
    assert_in_range(alarms, 0, 2);
    unit_context_free(&counter, &context);
}

static void bad_input_is_refused(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_vanishing_options options;
    asj_vanishing_points found;
    asj_junction one;
    memset(&one, 0, sizeof one);
    one.branch_count = 2;
    asj_vanishing_options_init(&options);
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_OPTION); /* no size */
    options.width = options.height = SIZE;
    assert_int_equal(asj_find_vanishing_points(context, NULL, 0, &options, &found), ASJ_OK);
    assert_int_equal(found.count, 0);
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_OK);
    assert_int_equal(found.count, 0);
    assert_int_equal(asj_find_vanishing_points(NULL, &one, 1, &options, &found), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_find_vanishing_points(context, NULL, 1, &options, &found), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, NULL, &found), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_find_vanishing_points(context, &one, SIZE_MAX / sizeof one, &options, &found), ASJ_ERROR_LIMIT);
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, NULL), ASJ_ERROR_ARGUMENT);
    one.branches[1].angle = NAN;
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_ARGUMENT);
    one.branches[1].angle = 0;
    one.branch_count = ASJ_MAX_BRANCHES + 1;
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_ARGUMENT);
    one.branch_count = 2;
    options.camera.fx = options.camera.fy = -500;
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_OPTION);
    options.camera.fx = options.camera.fy = NAN;
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_OPTION);
    options.camera = (asj_camera){500, 500, NAN, 0};
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_OPTION);
    options.camera = (asj_camera){0, 0, 1e8, NAN}; /* not known */
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_OK);
    options.camera = (asj_camera){0, 0, 0, 0};
    options.reserved[7] = 1;
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_OPTION);
    assert_non_null(strstr(asj_context_message(context), "reserved"));
    options.reserved[7] = 0;
    options.epsilon = 0;
    assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_OPTION);
    options.epsilon = 1;
    for (long at = 1; at <= 4; at++) {
        counter.fail_at = counter.calls + at;
        assert_int_equal(asj_find_vanishing_points(context, &one, 1, &options, &found), ASJ_ERROR_MEMORY);
    }
    counter.fail_at = 0;
    unit_context_free(&counter, &context);
}

static int32_t stop(void *user, int32_t stage, double done)
{
    (void)user;
    assert_int_equal(stage, ASJ_STAGE_DECOMPOSE);
    assert_true(done == 0);
    return 1;
}

static void it_can_be_cancelled(void **state)
{
    enum { MANY = 20000 };
    asj_junction *many = calloc(MANY, sizeof *many);
    asj_context_options options;
    asj_vanishing_options wishes;
    asj_vanishing_points points = {.count = 7};
    asj_context *context;
    (void)state;
    assert_non_null(many);
    for (int32_t k = 0; k < MANY; k++) {
        many[k] = (asj_junction){.x = (float)(k % 1000), .y = (float)(k / 1000), .branch_count = 2};
        for (int32_t b = 0; b < 2; b++)
            many[k].branches[b] = (asj_branch){.angle = (float)b, .length = 50 + (float)(k % 97)};
    }
    asj_vanishing_options_init(&wishes);
    wishes.width = 1000;
    wishes.height = 1000;
    asj_context_options_init(&options);
    options.progress = stop;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    assert_int_equal(asj_find_vanishing_points(context, many, MANY, &wishes, &points), ASJ_ERROR_CANCELLED);
    assert_int_equal(points.count, 7); /* nothing is written */
    asj_context_free(&context);
    free(many);
}

/* 40 000 branches, each on a line of its own: while they are put in order, at each of the longest, while these are paired. */
static void it_asks_all_the_time(void **state)
{
    enum { MANY = 20000 };
    asj_junction *many = calloc(MANY, sizeof *many);
    asj_context_options options;
    asj_vanishing_options wishes;
    asj_vanishing_points points;
    asj_context *context;
    long asked = 0;
    uint32_t random = 1;
    (void)state;
    assert_non_null(many);
    for (int32_t k = 0; k < MANY; k++) {
        many[k] = (asj_junction){.x = (float)(k % 1000), .y = (float)(k / 1000), .branch_count = 2};
        for (int32_t b = 0; b < 2; b++) {
            random = random * 1664525u + 1013904223u;
            many[k].branches[b] = (asj_branch){.angle = (float)(random >> 16) / 16384, .length = 50 + (float)(random >> 24)};
        }
    }
    asj_vanishing_options_init(&wishes);
    wishes.width = wishes.height = 1000;
    asj_context_options_init(&options);
    options.progress = unit_count_question;
    options.progress_user = &asked;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    context->pause_ms = 0;
    assert_int_equal(asj_find_vanishing_points(context, many, MANY, &wishes, &points), ASJ_OK);
    assert_true(asked >= MANY + 20 + 384 + 60); /* checked; put in order; until 300 are kept; paired */
    asj_context_free(&context);
    free(many);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rooms_have_three_directions), cmocka_unit_test(near_points_are_one),
        cmocka_unit_test(a_focal_length_is_known_or_not),
        cmocka_unit_test(few_lines_of_a_direction_are_enough), cmocka_unit_test(a_frame_without_votes_is_none),
        cmocka_unit_test(chance_has_no_directions),
        cmocka_unit_test(bad_input_is_refused), cmocka_unit_test(it_can_be_cancelled),
        cmocka_unit_test(it_asks_all_the_time),
    };
    return cmocka_run_group_tests_name("vanishing points", tests, NULL, NULL);
}
