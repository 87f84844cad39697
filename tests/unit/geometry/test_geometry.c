/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_geometry_estimate(): known motions among wrong candidates, what is degenerate, what is bad, what is chance. */
#include "unit_test.h"

#include "geometry/estimate.h"
#include "geometry/small_matrix.h"

#include <asj/geometry.h>

#define WIDTH 640
#define HEIGHT 480
#define MOST 1024

static const asj_camera camera = {600, 600, 319.5, 239.5};

/* What the candidates show. */
enum { SOLID, PLANE, TURN, SAME, LINE };

typedef struct scene {
    double rotation[9], translation[3];
    asj_geometry_candidate candidates[MOST];
    uint32_t count, right; /* the first `right` ones are right */
} scene;

static void view(const scene *s, const double p[3], double xy[2])
{
    double q[3];
    asj_apply3(s->rotation, p, q);
    for (int k = 0; k < 3; k++)
        q[k] += s->translation[k];
    xy[0] = camera.fx * q[0] / q[2] + camera.cx;
    xy[1] = camera.fy * q[1] / q[2] + camera.cy;
}

/* Where the plane at this depth with this normal goes, for a pixel. */
static void map(const scene *s, double x, double y, const double point[3], const double normal[3], double xy[2])
{
    const double ray[3] = {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy, 1};
    const double depth = asj_dot3(normal, point) / asj_dot3(normal, ray), p[3] = {depth * ray[0], depth * ray[1], depth};
    view(s, p, xy);
}

static asj_geometry_candidate right_one(const scene *s, synth_random *random, int kind, uint32_t number)
{
    asj_geometry_candidate c;
    memset(&c, 0, sizeof c);
    const double x = kind == LINE ? 40 + 30.0 * number : synth_random_between(random, 20, WIDTH - 20);
    const double y = kind == LINE ? 240 : synth_random_between(random, 20, HEIGHT - 20);
    const double depth = kind == PLANE || kind == LINE ? 5 : synth_random_between(random, 3, 8);
    const double point[3] = {depth * (x - camera.cx) / camera.fx, depth * (y - camera.cy) / camera.fy, depth};
    const double facing[3] = {0, 0, -1};
    const double normal[3] = {synth_random_between(random, -0.7, 0.7), synth_random_between(random, -0.7, 0.7), -1};
    const double *n = kind == SOLID ? normal : facing;
    double at[2], along[2][2];
    map(s, x, y, point, n, at);
    map(s, x + 0.01, y, point, n, along[0]);
    map(s, x, y + 0.01, point, n, along[1]);
    c.x1 = x;
    c.y1 = y;
    c.x2 = at[0] + 0.5 * synth_random_normal(random);
    c.y2 = at[1] + 0.5 * synth_random_normal(random);
    for (int k = 0; k < 2; k++)
        for (int j = 0; j < 2; j++)
            c.affine[2 * j + k] = (along[k][j] - at[j]) / 0.01 * (1 + 0.05 * synth_random_normal(random));
    return c;
}

/* `right` right candidates and as many places again that have none; every place has three wrong ones beside. */
static void make(scene *s, int kind, uint32_t right, uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    const double w[3] = {0.1, kind == SAME ? 0 : -0.5, 0.05}, none[3] = {0, 0, 0};
    memset(s, 0, sizeof *s);
    asj_rotation_of(kind == SAME ? none : w, s->rotation);
    if (kind == SOLID || kind == PLANE || kind == LINE) {
        s->translation[0] = 2;
        s->translation[2] = 0.6;
    }
    for (uint32_t k = 0; k < right; k++) {
        s->candidates[k] = right_one(s, &random, kind, k);
        s->candidates[k].place1 = s->candidates[k].place2 = k;
        s->candidates[k].probability = 0.2;
    }
    s->count = s->right = right;
    const uint32_t places = kind == LINE || kind == SAME ? 0 : 2 * right + 20;
    for (uint32_t k = 0; k < 2 * places; k++) { /* wrong: anything to anywhere */
        asj_geometry_candidate *c = &s->candidates[s->count++];
        const double turn = synth_random_between(&random, 0, 2 * UNIT_PI), size = exp(synth_random_between(&random, -1, 1));
        c->place1 = k % places;
        c->place2 = (k * 7 + 3) % places;
        c->x1 = c->place1 < right ? s->candidates[c->place1].x1 : 7.0 * c->place1;
        c->y1 = c->place1 < right ? s->candidates[c->place1].y1 : synth_random_between(&random, 0, HEIGHT);
        c->x2 = synth_random_between(&random, 0, WIDTH);
        c->y2 = synth_random_between(&random, 0, HEIGHT);
        c->affine[0] = c->affine[3] = size * cos(turn);
        c->affine[2] = size * sin(turn);
        c->affine[1] = -c->affine[2];
        c->probability = 0.1;
    }
}

static asj_geometry_options options_for(int32_t model, int with_cameras)
{
    asj_geometry_options o;
    asj_geometry_options_init(&o);
    o.model = model;
    for (int v = 0; v < 2; v++) {
        o.widths[v] = WIDTH;
        o.heights[v] = HEIGHT;
        if (with_cameras)
            o.cameras[v] = camera;
    }
    return o;
}

static int finite(const asj_geometry *g)
{
    double sum = g->log10_nfa + g->rival_log10_nfa + g->inliers + g->cameras[0].fx + g->cameras[1].fx;
    for (int k = 0; k < 9; k++)
        sum += g->matrix[k] + g->rotation[k] + g->rival_rotation[k];
    for (int k = 0; k < 3; k++)
        sum += g->rival_translation[k];
    for (int k = 0; k < 36; k++)
        sum += g->covariance[k];
    return isfinite(sum + g->translation[0] + g->translation[1] + g->translation[2]);
}

static asj_geometry estimate(asj_context *context, const scene *s, const asj_geometry_options *o, double *probabilities)
{
    asj_geometry g;
    assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, o, probabilities, &g), ASJ_OK);
    assert_true(finite(&g));
    return g;
}

static double turn_error(const asj_geometry *g, const scene *s)
{
    double turn[9];
    asj_multiply3_transposed(g->rotation, s->rotation, turn);
    return asj_rotation_angle(turn) * 180 / UNIT_PI;
}

static void a_motion_is_found_among_wrong_candidates(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene *s = malloc(sizeof *s);
    double probabilities[MOST];
    for (uint64_t seed = 1; seed <= 3; seed++) {
        make(s, SOLID, 40, seed);
        const asj_geometry_options o = options_for(ASJ_GEOMETRY_ESSENTIAL, 1);
        const asj_geometry g = estimate(context, s, &o, probabilities);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        assert_true(g.has_pose);
        const double length = sqrt(asj_dot3(s->translation, s->translation));
        const double direction = acos(fmin(1, asj_dot3(g.translation, s->translation) / length)) * 180 / UNIT_PI;
        unit_near("rotation, deg", (double)seed, 0, turn_error(&g, s), 0, 1);
        unit_near("translation, deg", (double)seed, 0, direction, 0, 2);
        uint32_t right = 0, wrong = 0;
        for (uint32_t k = 0; k < s->count; k++) {
            assert_true(probabilities[k] >= 0 && probabilities[k] <= 1);
            right += k < s->right && probabilities[k] > 0.5;
            wrong += k >= s->right && probabilities[k] > 0.5;
        }
        assert_in_range(right, 36, 40);
        assert_in_range(wrong, 0, 4);
        double trace = 0; /* errors are of the size that the covariance says */
        for (int k = 0; k < 6; k++)
            trace += g.covariance[7 * k];
        assert_true(sqrt(trace) > 1e-4 && sqrt(trace) < 0.1);
        const asj_geometry_options blind = options_for(ASJ_GEOMETRY_AUTO, 0);
        const asj_geometry f = estimate(context, s, &blind, probabilities);
        assert_int_equal(f.status, ASJ_GEOMETRY_ACCEPTED);
        assert_int_equal(f.model, ASJ_GEOMETRY_FUNDAMENTAL);
        assert_false(f.has_pose);
    }
    free(s);
    unit_context_free(&counter, &context);
}

/* deg: the larger error of rotation and translation. */
static double motion_error(const double rotation[9], const double translation[3], const scene *s)
{
    double turn[9];
    asj_multiply3_transposed(rotation, s->rotation, turn);
    const double length = sqrt(asj_dot3(s->translation, s->translation));
    return fmax(asj_rotation_angle(turn), acos(fmin(1, asj_dot3(translation, s->translation) / length))) * 180 / UNIT_PI;
}

/* Two motions of the same points, the second of fewer of them: ambiguous, and both are told. */
static void a_rival_tells_its_motion(void **state)
{
    (void)state;
    const double w[3] = {0, 0.35, -0.1};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene *s = malloc(sizeof *s), *second = malloc(sizeof *second);
    const asj_geometry_options o = options_for(ASJ_GEOMETRY_ESSENTIAL, 1);
    synth_random random;
    make(s, SOLID, 40, 1);
    const asj_geometry alone = estimate(context, s, &o, NULL);
    assert_false(alone.has_rival && alone.rival_log10_nfa < -5);
    asj_rotation_of(w, second->rotation);
    second->translation[0] = -1.5;
    second->translation[1] = 0.3;
    second->translation[2] = 0.5;
    synth_random_seed(&random, 1); /* .. so that the points are those of the first */
    for (uint32_t k = 0; k < 36; k++) {
        asj_geometry_candidate c = right_one(second, &random, SOLID, k);
        assert_true(c.x1 == s->candidates[k].x1 && c.y1 == s->candidates[k].y1);
        c.place1 = k;
        c.place2 = 1000 + k;
        c.probability = 0.2;
        s->candidates[s->count++] = c;
    }
    const asj_geometry g = estimate(context, s, &o, NULL);
    assert_int_equal(g.status, ASJ_GEOMETRY_AMBIGUOUS);
    assert_true(g.has_rival && g.rival_log10_nfa < -20 && g.rival_log10_nfa > g.log10_nfa);
    unit_near("the best one's motion, deg", 1, 0, motion_error(g.rotation, g.translation, s), 0, 2);
    unit_near("the rival's motion, deg", 1, 0, motion_error(g.rival_rotation, g.rival_translation, second), 0, 2);
    free(s);
    free(second);
    unit_context_free(&counter, &context);
}

/* A match that has no rivals is as likely by itself as among the candidates, and what is on no line is wrong. */
static void what_was_accepted_judges_others(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene *s = malloc(sizeof *s);
    double probabilities[MOST];
    for (int32_t model = ASJ_GEOMETRY_ESSENTIAL; model <= ASJ_GEOMETRY_HOMOGRAPHY; model++) {
        const asj_geometry_options o = options_for(model, 1);
        asj_geometry g;
        asj_judge judge;
        make(s, model == ASJ_GEOMETRY_HOMOGRAPHY ? PLANE : SOLID, 40, 1);
        s->count = s->right;
        assert_int_equal(asj_estimate_with_hints(context, s->candidates, s->count, NULL, &o, probabilities, &judge, &g), ASJ_OK);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        for (uint32_t k = 0; k < s->count; k++) {
            asj_geometry_candidate c = s->candidates[k];
            unit_near("probability", model, k, asj_judge_probability(&judge, &c), probabilities[k], 1e-12);
            c.probability = 0.9;
            assert_true(asj_judge_probability(&judge, &c) >= probabilities[k]);
            c.x2 += 100;
            c.y2 += 100;
            assert_true(asj_judge_probability(&judge, &c) < 0.9);
            c.probability = 0;
            assert_true(asj_judge_probability(&judge, &c) == 0);
        }
    }
    free(s);
    unit_context_free(&counter, &context);
}

/* Squared Mahalanobis distance of the true rotation, over its 3 degrees of freedom: 1 on average when errors are as told. */
static double squared_error(const asj_geometry *g, const scene *s)
{
    double turn[9], covariance[9], inverse[9], weighed[3];
    asj_multiply3_transposed(s->rotation, g->rotation, turn);
    const double w[3] = {0.5 * (turn[7] - turn[5]), 0.5 * (turn[2] - turn[6]), 0.5 * (turn[3] - turn[1])};
    for (int k = 0; k < 9; k++)
        covariance[k] = g->covariance[k / 3 * 6 + k % 3];
    assert_true(asj_invert3(covariance, inverse));
    asj_apply3(inverse, w, weighed);
    return asj_dot3(w, weighed) / 3;
}

/* Errors of locations and maps are those of make(), not those that the options tell. */
static void errors_are_as_large_as_told(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene *s = malloc(sizeof *s);
    double sum = 0;
    const int pairs = 12;
    for (int n = 0; n < pairs; n++) {
        make(s, SOLID, 25, (uint64_t)(200 + n));
        asj_geometry_options o = options_for(ASJ_GEOMETRY_ESSENTIAL, 1);
        o.samples = 300;
        const asj_geometry g = estimate(context, s, &o, NULL);
        assert_true(g.status == ASJ_GEOMETRY_ACCEPTED && g.has_pose);
        const double square = squared_error(&g, s);
        assert_true(square < 5.4); /* exceeded once in a thousand */
        sum += square;
    }
    unit_near("mean squared error over what is told", 0, 0, sum / pairs, 0.75, 0.5);
    free(s);
    unit_context_free(&counter, &context);
}

static void planes_and_turns_are_homographies(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene *s = malloc(sizeof *s);
    const int kinds[3] = {PLANE, TURN, SAME};
    for (int i = 0; i < 3; i++) {
        make(s, kinds[i], 40, 11);
        const asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, 1);
        const asj_geometry g = estimate(context, s, &o, NULL);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        assert_int_equal(g.model, ASJ_GEOMETRY_HOMOGRAPHY);
        for (uint32_t k = 0; k < s->right; k++) {
            const asj_geometry_candidate *c = &s->candidates[k];
            const double x[3] = {c->x1, c->y1, 1};
            double y[3];
            asj_apply3(g.matrix, x, y);
            unit_near("x", i, k, y[0] / y[2], c->x2, 4);
            unit_near("y", i, k, y[1] / y[2], c->y2, 4);
        }
        if (kinds[i] != PLANE) { /* without a translation there is no direction of it */
            const asj_geometry_options e = options_for(ASJ_GEOMETRY_ESSENTIAL, 1);
            const asj_geometry turned = estimate(context, s, &e, NULL);
            assert_true(turned.status == ASJ_GEOMETRY_DEGENERATE || turned.status == ASJ_GEOMETRY_ACCEPTED);
            unit_near("rotation, deg", i, 0, turned.status == ASJ_GEOMETRY_ACCEPTED ? turn_error(&turned, s) : 0, 0, 2);
        }
    }
    free(s);
    unit_context_free(&counter, &context);
}

static void too_little_is_no_geometry(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene *s = malloc(sizeof *s);
    for (int32_t model = ASJ_GEOMETRY_AUTO; model <= ASJ_GEOMETRY_HOMOGRAPHY; model++) {
        const asj_geometry_options o = options_for(model, 1);
        make(s, SOLID, 40, 21);
        s->count = 0;
        assert_int_equal(estimate(context, s, &o, NULL).status, ASJ_GEOMETRY_TOO_FEW);
        s->count = 1;
        assert_int_equal(estimate(context, s, &o, NULL).status, ASJ_GEOMETRY_TOO_FEW);
        s->count = 2;
        assert_int_equal(estimate(context, s, &o, NULL).status, ASJ_GEOMETRY_CHANCE);
        for (uint32_t k = 1; k < 40; k++) { /* one point, forty times */
            s->candidates[k] = s->candidates[0];
            s->candidates[k].place1 = s->candidates[k].place2 = k;
        }
        s->count = 40;
        assert_int_not_equal(estimate(context, s, &o, NULL).status, ASJ_GEOMETRY_ACCEPTED);
        make(s, LINE, 18, 22);
        const asj_geometry g = estimate(context, s, &o, NULL);
        assert_true(g.status >= ASJ_GEOMETRY_ACCEPTED && g.status <= ASJ_GEOMETRY_DEGENERATE);
    }
    free(s);
    unit_context_free(&counter, &context);
}

/* Partners shuffled: what is accepted then is a false alarm. Of 40 there may be 40 epsilon. */
static void chance_is_not_accepted(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene *s = malloc(sizeof *s);
    double largest = -HUGE_VAL;
    for (uint64_t seed = 100; seed < 120; seed++) {
        make(s, SOLID, 40, seed);
        for (uint32_t k = 0; k + 1 < s->count; k++) {
            asj_geometry_candidate *a = &s->candidates[k], *b = &s->candidates[(k * 31 + 17) % s->count], keep = *a;
            a->x2 = b->x2;
            a->y2 = b->y2;
            a->place2 = b->place2;
            memcpy(a->affine, b->affine, sizeof a->affine);
            b->x2 = keep.x2;
            b->y2 = keep.y2;
            b->place2 = keep.place2;
            memcpy(b->affine, keep.affine, sizeof b->affine);
        }
        asj_geometry_options o = options_for(seed % 2 ? ASJ_GEOMETRY_AUTO : ASJ_GEOMETRY_ESSENTIAL, 1);
        o.samples = 300;
        const asj_geometry g = estimate(context, s, &o, NULL);
        assert_int_not_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        largest = fmax(largest, -g.log10_nfa);
    }
    assert_true(largest < 1.5); /* NFA 0.03 once in 20: what Markov's inequality allows, with room */
    free(s);
    unit_context_free(&counter, &context);
}

/* Samples that miss what there is are not the last word: with 10 of them 19 of 60 seeds find this motion at once, 44 in all. */
static void what_samples_miss_is_looked_for_again(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene *s = malloc(sizeof *s);
    int accepted = 0;
    make(s, SOLID, 24, 57);
    for (uint64_t seed = 1; seed <= 60; seed++) {
        asj_geometry_options o = options_for(ASJ_GEOMETRY_ESSENTIAL, 1);
        o.samples = 10;
        o.seed = seed;
        const asj_geometry g = estimate(context, s, &o, NULL);
        accepted += g.status == ASJ_GEOMETRY_ACCEPTED;
    }
    assert_true(accepted >= 38);
    free(s);
    unit_context_free(&counter, &context);
}

static void threads_and_order_change_nothing(void **state)
{
    (void)state;
    scene *s = malloc(sizeof *s);
    asj_geometry first, other;
    double p1[MOST], p2[MOST];
    make(s, SOLID, 30, 31);
    const asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, 1);
    for (int32_t threads = 1; threads <= 4; threads++) {
        unit_counter counter = {0};
        asj_context *context = unit_context(&counter, threads);
        other = estimate(context, s, &o, p2);
        if (threads == 1) {
            first = other;
            memcpy(p1, p2, sizeof p1);
        }
        assert_memory_equal(&first, &other, sizeof first);
        assert_memory_equal(p1, p2, s->count * sizeof *p1);
        unit_context_free(&counter, &context);
    }
    free(s);
}

/* Refused, with a message that says which number is wrong. */
static void expect_message(asj_context *context, const scene *s, const asj_geometry_options *o, const char *part)
{
    asj_geometry g;
    assert_true(asj_geometry_estimate(context, s->candidates, 5, o, NULL, &g) < 0);
    assert_non_null(strstr(asj_context_message(context), part));
}

static void bad_input_is_refused(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene *s = malloc(sizeof *s);
    asj_geometry g;
    const double bad_focal[5] = {-600, NAN, HUGE_VAL, 1e-3, 1e9};
    make(s, SOLID, 10, 41);
    for (int k = 0; k < 5; k++) {
        asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, 1);
        o.cameras[k % 2].fx = bad_focal[k];
        assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g), ASJ_ERROR_OPTION);
        o = options_for(ASJ_GEOMETRY_AUTO, 1);
        o.cameras[k % 2].fy = bad_focal[k];
        assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g), ASJ_ERROR_OPTION);
    }
    asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, 1);
    o.cameras[1].cx = NAN;
    assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g), ASJ_ERROR_OPTION);
    o.cameras[0] = o.cameras[1] = (asj_camera){0, 0, NAN, 1e8}; /* not known: nobody asks for the rest */
    assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g), ASJ_OK);
    assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
    const double bad_directions[4] = {NAN, HUGE_VAL, 1e308, 2};
    for (int k = 0; k < 4; k++) {
        o = options_for(ASJ_GEOMETRY_AUTO, 1);
        o.directions[k % 2][0] = o.directions[k % 2][4] = o.directions[k % 2][8] = bad_directions[k];
        assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g), ASJ_ERROR_OPTION);
    }
    o.directions[1][0] = o.directions[1][4] = o.directions[1][8] = 1;
    assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g), ASJ_OK);
    o = options_for(ASJ_GEOMETRY_ESSENTIAL, 0);
    assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g), ASJ_ERROR_OPTION);
    o = options_for(99, 1);
    assert_int_equal(asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g), ASJ_ERROR_OPTION);
    o = options_for(ASJ_GEOMETRY_AUTO, 1);
    o.epsilon = NAN;
    expect_message(context, s, &o, "epsilon of the geometry is nan, not 1e-12 .. 1");
    o = options_for(ASJ_GEOMETRY_AUTO, 1);
    o.scale_sd = 1.0001;
    expect_message(context, s, &o, "scale_sd of the geometry is 1.0001, not 0.02 .. 1");
    o = options_for(ASJ_GEOMETRY_AUTO, 1);
    assert_int_equal(asj_geometry_estimate(context, NULL, 3, &o, NULL, &g), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_geometry_estimate(context, s->candidates, 3, &o, NULL, NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_geometry_estimate(context, s->candidates, 3, NULL, NULL, &g), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_geometry_estimate(NULL, s->candidates, 3, &o, NULL, &g), ASJ_ERROR_ARGUMENT);
    s->candidates[2].x2 = NAN;
    double probabilities[5] = {7, 7, 7, 7, 7}; /* what fails leaves them as they are */
    assert_int_equal(asj_geometry_estimate(context, s->candidates, 5, &o, probabilities, &g), ASJ_ERROR_ARGUMENT);
    assert_true(probabilities[0] == 7 && probabilities[4] == 7);
    s->candidates[2].x2 = 5;
    s->candidates[2].affine[0] = -s->candidates[2].affine[0]; /* mirrors */
    s->candidates[2].affine[1] = -s->candidates[2].affine[1];
    expect_message(context, s, &o, "the map of candidate 2 mirrors");
    make(s, SOLID, 10, 41);
    s->candidates[4].probability = 1.5;
    expect_message(context, s, &o, "candidate 4 has the probability 1.5");
    s->candidates[4].probability = 0.5;
    for (int32_t side = 0; side < 2; side++) {
        s->candidates[4].place1 = side ? 4 : UINT32_MAX;
        s->candidates[4].place2 = side ? UINT32_MAX : 4;
        assert_int_equal(asj_geometry_estimate(context, s->candidates, 5, &o, NULL, &g), ASJ_ERROR_LIMIT);
    }
    s->candidates[4].place2 = 4;
    for (int32_t k = 0; k < 2; k++) {
        o.samples = k ? 0 : 100001;
        assert_int_equal(asj_geometry_estimate(context, s->candidates, 5, &o, NULL, &g), ASJ_ERROR_OPTION);
    }
    free(s);
    unit_context_free(&counter, &context);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    scene *s = malloc(sizeof *s);
    asj_geometry g;
    long calls = 0;
    make(s, SOLID, 20, 51);
    asj_geometry_options o = options_for(ASJ_GEOMETRY_AUTO, 1);
    o.samples = 50;
    for (long at = 0; at <= calls; at++) {
        unit_counter counter = {0};
        asj_context *context = unit_context(&counter, 1);
        const long before = counter.calls;
        counter.fail_at = at ? before + at : 0;
        const asj_status status = asj_geometry_estimate(context, s->candidates, s->count, &o, NULL, &g);
        assert_true(status == ASJ_OK || (at > 0 && status == ASJ_ERROR_MEMORY));
        calls = at == 0 ? counter.calls - before : calls;
        counter.fail_at = 0;
        unit_context_free(&counter, &context);
    }
    assert_true(calls > 10);
    free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_motion_is_found_among_wrong_candidates), cmocka_unit_test(errors_are_as_large_as_told),
        cmocka_unit_test(what_was_accepted_judges_others), cmocka_unit_test(a_rival_tells_its_motion),
        cmocka_unit_test(planes_and_turns_are_homographies),
        cmocka_unit_test(too_little_is_no_geometry), cmocka_unit_test(chance_is_not_accepted),
        cmocka_unit_test(what_samples_miss_is_looked_for_again),
        cmocka_unit_test(threads_and_order_change_nothing), cmocka_unit_test(bad_input_is_refused),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("geometry", tests, NULL, NULL);
}
