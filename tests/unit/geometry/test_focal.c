/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_geometry_estimate() with find_focal or focal_sd: focal lengths that are found, motions that leave them open, what is
 * refused. */
#include "unit_test.h"

#include "geometry/geometry_options.h"
#include "geometry/small_matrix.h"
#include "match/unstretch.h"

#include <asj/geometry.h>

#define WIDTH 640
#define HEIGHT 480
#define RIGHT 26
#define COUNT (3 * RIGHT)
#define MANY 150 /* right ones */

typedef struct scene {
    double focal, rotation[9], translation[3];
    int32_t is_flat; /* on one plane that faces camera 1 */
    int32_t is_sharp; /* MANY right candidates, known to a twentieth of a pixel, in place of RIGHT, known to half a pixel */
    double bend; /* of the lens: locations r px from the middle lie at r (1 + bend (r / focal)^2) */
    asj_geometry_candidate candidates[3 * MANY];
} scene;

/* Where a point of the plane through `point` with the normal, seen at pixel (x, y) of image 1, is in image 2. */
static void map(const scene *s, double x, double y, const double point[3], const double normal[3], double xy[2])
{
    const double ray[3] = {(x - 319.5) / s->focal, (y - 239.5) / s->focal, 1};
    const double depth = asj_dot3(normal, point) / asj_dot3(normal, ray), p[3] = {depth * ray[0], depth * ray[1], depth};
    double q[3];
    asj_apply3(s->rotation, p, q);
    for (int k = 0; k < 3; k++)
        q[k] += s->translation[k];
    xy[0] = s->focal * q[0] / q[2] + 319.5;
    xy[1] = s->focal * q[1] / q[2] + 239.5;
}

/* Through the lens. */
static void bend(const scene *s, double xy[2])
{
    const double x = xy[0] - 319.5, y = xy[1] - 239.5, times = 1 + s->bend * (x * x + y * y) / (s->focal * s->focal);
    xy[0] = 319.5 + times * x;
    xy[1] = 239.5 + times * y;
}

/* Right candidates, with 5 % noise in their maps, and two wrong ones for each place. */
static void make(scene *s, const double turn[3], const double translation[3], uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    asj_rotation_of(turn, s->rotation);
    memcpy(s->translation, translation, sizeof s->translation);
    memset(s->candidates, 0, sizeof s->candidates);
    const uint32_t right = s->is_sharp ? MANY : RIGHT;
    const double noise = s->is_sharp ? 0.05 : 0.5;
    for (uint32_t i = 0; i < 3 * right; i++) {
        asj_geometry_candidate *c = &s->candidates[i];
        c->place1 = i % right;
        c->place2 = i < right ? i : (7 * i + 3) % right;
        c->probability = i < right ? 0.3 : 0.15;
        if (i >= right) {
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
        const double x = synth_random_between(&random, 20, WIDTH - 20), y = synth_random_between(&random, 20, HEIGHT - 20);
        const double depth = s->is_flat ? 5 : synth_random_between(&random, 3, 8);
        const double point[3] = {depth * (x - 319.5) / s->focal, depth * (y - 239.5) / s->focal, depth};
        const double normal[3] = {s->is_flat ? 0 : synth_random_between(&random, -0.7, 0.7),
                                  s->is_flat ? 0 : synth_random_between(&random, -0.7, 0.7), -1};
        double at[2], along[2][2], seen[2][2] = {{x, y}};
        map(s, x, y, point, normal, at);
        map(s, x + 0.01, y, point, normal, along[0]);
        map(s, x, y + 0.01, point, normal, along[1]);
        memcpy(seen[1], at, sizeof at);
        bend(s, seen[0]);
        bend(s, seen[1]);
        c->x1 = seen[0][0];
        c->y1 = seen[0][1];
        c->x2 = seen[1][0] + noise * synth_random_normal(&random);
        c->y2 = seen[1][1] + noise * synth_random_normal(&random);
        for (int k = 0; k < 2; k++)
            for (int j = 0; j < 2; j++)
                c->affine[2 * j + k] = (along[k][j] - at[j]) / 0.01 * (1 + 0.05 * synth_random_normal(&random));
    }
}

static asj_geometry_options blind_options(int32_t model)
{
    asj_geometry_options o;
    asj_geometry_options_init(&o);
    assert_int_equal(o.find_focal, 0);
    o.model = model;
    o.find_focal = 1;
    o.samples = 200;
    for (int v = 0; v < 2; v++) {
        o.widths[v] = WIDTH;
        o.heights[v] = HEIGHT;
    }
    return o;
}

/* What is accepted or left open says of candidates how probable they are, of all together its inliers. */
static void check_probabilities(const asj_geometry *g, const double probabilities[COUNT])
{
    const int told = g->status == ASJ_GEOMETRY_ACCEPTED || asj_geometry_is_open(g);
    double sum = 0;
    for (int k = 0; k < COUNT; k++) {
        assert_true(probabilities[k] >= 0 && probabilities[k] <= 1);
        sum += probabilities[k];
    }
    unit_near("sum of the probabilities", g->status, g->model, sum, told ? g->inliers : 0, 1e-6 * COUNT);
}

static double uncertainty(const asj_geometry *g)
{
    double trace = 0;
    for (int k = 0; k < 6; k++)
        trace += g->covariance[7 * k];
    return trace;
}

static asj_geometry estimate(asj_context *context, const scene *s, const asj_geometry_options *o)
{
    asj_geometry g;
    double probabilities[COUNT];
    assert_int_equal(asj_geometry_estimate(context, s->candidates, COUNT, o, probabilities, &g), ASJ_OK);
    check_probabilities(&g, probabilities);
    double sum = g.log10_nfa + g.inliers + g.cameras[0].fx + g.cameras[1].fx + g.focal_sd;
    for (int k = 0; k < 36; k++)
        sum += g.covariance[k] + g.matrix[k % 9] + g.rotation[k % 9] + g.translation[k % 3];
    assert_true(isfinite(sum));
    return g;
}

/* Cameras whose focal lengths are both out by a factor, which are known to sd. */
static asj_geometry_options about_options(int32_t model, double focal, double factor, double sd)
{
    asj_geometry_options o = blind_options(model);
    o.find_focal = 0;
    o.focal_sd = sd;
    for (int v = 0; v < 2; v++)
        o.cameras[v] = (asj_camera){factor * focal, factor * focal, 0.5 * (WIDTH - 1), 0.5 * (HEIGHT - 1)};
    return o;
}

static double rotation_off(const asj_geometry *g, const scene *s)
{
    double rest[9];
    asj_multiply3_transposed(g->rotation, s->rotation, rest);
    return asj_rotation_angle(rest) * 180 / UNIT_PI;
}

static void focal_lengths_are_found(void **state)
{
    (void)state;
    const double focal[3] = {350, 600, 1100}, turn[3] = {0.15, -0.5, 0.1}, translation[3] = {2, -0.5, 0.8};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene s = {.focal = 0};
    for (int i = 0; i < 3; i++) {
        const asj_geometry_options o = blind_options(i == 1 ? ASJ_GEOMETRY_ESSENTIAL : ASJ_GEOMETRY_AUTO);
        s.focal = focal[i];
        make(&s, turn, translation, (uint64_t)i + 1);
        const asj_geometry g = estimate(context, &s, &o);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        assert_int_equal(g.model, ASJ_GEOMETRY_ESSENTIAL);
        assert_true(g.focal_sd > 0 && g.focal_sd < 0.1 && g.cameras[0].fx == g.cameras[1].fx);
        unit_near("focal length, in standard deviations", i, focal[i], log(g.cameras[0].fx / focal[i]) / g.focal_sd, 0, 3);
        unit_near("rotation, deg", i, 0, rotation_off(&g, &s), 0, 3);
        /* who knows the focal length knows the motion better: 1.2 to 2.2 here */
        const asj_geometry_options known = about_options(o.model, focal[i], 1, 0);
        const asj_geometry surer = estimate(context, &s, &known);
        assert_true(surer.has_pose && g.has_pose && uncertainty(&surer) > 0 && uncertainty(&g) > 1.1 * uncertainty(&surer));
    }
    unit_context_free(&counter, &context);
}

/* Focal lengths that are 6 % too long or short, and known to 5 %, come to within 2 % here, and with them the rotation; taken for
 * exact, it is out by twice as much at least. Never is one believed that lies five deviations away. */
static void about_known_focal_lengths_become_better(void **state)
{
    (void)state;
    const double turn[3] = {0.15, -0.5, 0.1}, translation[3] = {2, -0.5, 0.8};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene s = {.focal = 600, .is_sharp = 1};
    for (int i = 0; i < 2; i++) {
        const double factor = i % 2 ? 1 / 1.06 : 1.06;
        asj_geometry_options o = about_options(i < 1 ? ASJ_GEOMETRY_AUTO : ASJ_GEOMETRY_ESSENTIAL, s.focal, factor, 0.05);
        asj_geometry about, exact, strict;
        make(&s, turn, translation, (uint64_t)i + 1);
        assert_int_equal(asj_geometry_estimate(context, s.candidates, 3 * MANY, &o, NULL, &about), ASJ_OK);
        assert_int_equal(about.status, ASJ_GEOMETRY_ACCEPTED);
        assert_true(about.model == ASJ_GEOMETRY_ESSENTIAL && about.has_pose && about.focal_sd > 0 && about.focal_sd < 0.03);
        unit_near("focal length", i, factor, about.cameras[0].fx / s.focal, 1, 0.02);
        unit_near("in standard deviations", i, factor, log(about.cameras[0].fx / s.focal) / about.focal_sd, 0, 3);
        o.focal_sd = 0;
        assert_int_equal(asj_geometry_estimate(context, s.candidates, 3 * MANY, &o, NULL, &exact), ASJ_OK);
        assert_true(exact.has_pose && exact.focal_sd == 0 && exact.cameras[0].fx == o.cameras[0].fx);
        assert_true(rotation_off(&exact, &s) > 2 * rotation_off(&about, &s));
        o.focal_sd = 0.01;
        assert_int_equal(asj_geometry_estimate(context, s.candidates, 3 * MANY, &o, NULL, &strict), ASJ_OK);
        assert_true(fabs(log(strict.cameras[0].fx / o.cameras[0].fx)) < 0.05);
    }
    unit_context_free(&counter, &context);
}

/* What leaves the focal length open leaves it as it was known, and has a pose all the same. */
static void open_focal_lengths_stay_about_known(void **state)
{
    (void)state;
    const double turn[3] = {0, 0, 0}, translation[3] = {1.5, 0.4, 0};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene s = {.focal = 600};
    const double sds[] = {0.02, 0.05, 0.2};
    for (size_t k = 0; k < UNIT_COUNT(sds); k++) {
        const asj_geometry_options o = about_options(k == 1 ? ASJ_GEOMETRY_AUTO : ASJ_GEOMETRY_ESSENTIAL, s.focal, 1, sds[k]);
        make(&s, turn, translation, 7);
        const asj_geometry g = estimate(context, &s, &o);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        assert_true(g.has_pose && g.focal_sd > 0.5 * sds[k] && g.focal_sd < 1.5 * sds[k]);
        unit_near("focal length", sds[k], 0, log(g.cameras[0].fx / 600), 0, 1.5 * sds[k]);
    }
    unit_context_free(&counter, &context);
}

/* One plane alone tells no focal length: what is given stays, and one that is not known is not found. (Before, what was given
 * rightly moved by 6 to 19 %, and four of five planes had a pose with a length that was 14 to 22 % too long.) */
static void a_plane_tells_none(void **state)
{
    (void)state;
    const double turn[3] = {0.05, -0.4, 0.1}, translation[3] = {1.5, -0.3, 0.5};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    int poses = 0;
    for (int i = 0; i < 3; i++) {
        scene s = {.focal = 600, .is_flat = 1, .is_sharp = i == 1};
        const int32_t count = s.is_sharp ? 3 * MANY : COUNT;
        asj_geometry_options o = about_options(i < 2 ? ASJ_GEOMETRY_AUTO : ASJ_GEOMETRY_ESSENTIAL, s.focal, 1, 0.05);
        asj_geometry g;
        make(&s, turn, translation, (uint64_t)i + 20);
        assert_int_equal(asj_geometry_estimate(context, s.candidates, (size_t)count, &o, NULL, &g), ASJ_OK);
        poses += g.has_pose;
        if (g.has_pose) {
            unit_near("focal length", i, 0, g.cameras[0].fx, 600, 1e-6);
            unit_near("known to", i, 0, g.focal_sd, 0.05, 1e-3);
        }
        o = blind_options(o.model);
        assert_int_equal(asj_geometry_estimate(context, s.candidates, (size_t)count, &o, NULL, &g), ASJ_OK);
        assert_true(!g.has_pose && g.cameras[0].fx == 0);
    }
    assert_true(poses > 0);
    unit_context_free(&counter, &context);
}

/* Model fundamental and homography have no focal length, one camera alone is none. */
static void without_both_cameras_it_says_nothing(void **state)
{
    (void)state;
    const double turn[3] = {0.15, -0.5, 0.1}, translation[3] = {2, -0.5, 0.8};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene s = {.focal = 600};
    make(&s, turn, translation, 1);
    for (int i = 0; i < 3; i++) {
        asj_geometry_options o = about_options(i == 0 ? ASJ_GEOMETRY_AUTO : i == 1 ? ASJ_GEOMETRY_FUNDAMENTAL
                                                                                    : ASJ_GEOMETRY_HOMOGRAPHY, s.focal, 1, 0.05);
        if (i == 0)
            memset(&o.cameras[1], 0, sizeof o.cameras[1]);
        const asj_geometry with = estimate(context, &s, &o);
        o.focal_sd = 0;
        const asj_geometry without = estimate(context, &s, &o);
        assert_memory_equal(&with, &without, sizeof with);
    }
    unit_context_free(&counter, &context);
}

/* Directions that somebody gives are those of a camera: without one they say nothing. */
static void directions_need_a_camera(void **state)
{
    (void)state;
    const double turn[3] = {0.15, -0.5, 0.1}, translation[3] = {2, -0.5, 0.8}, any[3] = {0.3, 0.2, 0.1};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene s = {.focal = 600};
    asj_geometry_options o = blind_options(ASJ_GEOMETRY_AUTO);
    make(&s, turn, translation, 1);
    const asj_geometry without = estimate(context, &s, &o);
    asj_rotation_of(any, o.directions[0]);
    memcpy(o.directions[1], o.directions[0], sizeof o.directions[1]);
    const asj_geometry with = estimate(context, &s, &o);
    assert_memory_equal(&with, &without, sizeof with);
    unit_context_free(&counter, &context);
}

/* Many matches that are known well tell the focal length more sharply than by the widest steps. (Refused, as of a path that breaks
 * off, before the steps became smaller.) */
static void many_sharp_matches_tell_it(void **state)
{
    (void)state;
    const double turn[3] = {0.15, -0.5, 0.1}, translation[3] = {2, -0.5, 0.8};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene s = {.focal = 600, .is_sharp = 1};
    for (uint64_t seed = 1; seed <= 2; seed++) {
        const asj_geometry_options o = blind_options(seed == 1 ? ASJ_GEOMETRY_ESSENTIAL : ASJ_GEOMETRY_AUTO);
        asj_geometry g;
        make(&s, turn, translation, seed);
        assert_int_equal(asj_geometry_estimate(context, s.candidates, 3 * MANY, &o, NULL, &g), ASJ_OK);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        assert_true(g.has_pose && g.focal_sd < 0.02);
        unit_near("focal length, in standard deviations", (double)seed, 600, log(g.cameras[0].fx / 600) / g.focal_sd, 0, 3);
    }
    unit_context_free(&counter, &context);
}

/* Cameras nearly side by side, which leave the focal length open, and a lens that is no pin hole: what its bend makes likelier is
 * no focal length. (One of the three had 939 px, known to 1 %.) */
static void lenses_that_bend_tell_none(void **state)
{
    (void)state;
    const double turn[3] = {0.002, -0.01, 0.001}, translation[3] = {1, 0.02, 0.01};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    for (uint64_t seed = 1; seed <= 3; seed++) {
        scene s = {.focal = 600, .is_sharp = 1, .bend = 0.02};
        const asj_geometry_options o = blind_options(ASJ_GEOMETRY_AUTO);
        asj_geometry g;
        make(&s, turn, translation, seed);
        assert_int_equal(asj_geometry_estimate(context, s.candidates, 3 * MANY, &o, NULL, &g), ASJ_OK);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        assert_true(!g.has_pose && g.cameras[0].fx == 0 && g.focal_sd == 0);
    }
    unit_context_free(&counter, &context);
}

/* What was seen with pixels that are not square: the same focal length, in px along x, and the same motion. */
static void pixels_need_not_be_square(void **state)
{
    (void)state;
    const double turn[3] = {0.15, -0.5, 0.1}, translation[3] = {2, -0.5, 0.8}, stretches[2][2] = {{1, 3}, {3, 1}};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    for (int i = 0; i < 2; i++) {
        scene s = {.focal = 600};
        const asj_stretch both[2] = {{stretches[i][0], stretches[i][1]}, {stretches[i][0], stretches[i][1]}};
        asj_geometry_options o = blind_options(ASJ_GEOMETRY_AUTO);
        make(&s, turn, translation, 1);
        for (int k = 0; k < COUNT; k++)
            asj_stretch_candidate(&s.candidates[k], both);
        for (int v = 0; v < 2; v++) {
            o.widths[v] = WIDTH * (int32_t)both[v].x;
            o.heights[v] = HEIGHT * (int32_t)both[v].y;
            o.aspects[v] = both[v].y / both[v].x;
        }
        const asj_geometry g = estimate(context, &s, &o);
        assert_int_equal(g.status, ASJ_GEOMETRY_ACCEPTED);
        assert_int_equal(g.model, ASJ_GEOMETRY_ESSENTIAL);
        unit_near("focal length, in standard deviations", i, 600, log(g.cameras[0].fx / both[0].x / 600) / g.focal_sd, 0, 3);
        unit_near("rotation, deg", i, 0, rotation_off(&g, &s), 0, 3);
        /* taken for square, they are another scene */
        o.aspects[0] = o.aspects[1] = 1;
        const asj_geometry square = estimate(context, &s, &o);
        assert_true(square.log10_nfa > g.log10_nfa + 5);
    }
    unit_context_free(&counter, &context);
}

/* Sideways with parallel axes, and a plane that faces the camera: any focal length explains them. A camera that only turns has no
 * translation. None is an answer with a focal length. */
static void what_leaves_it_open_has_none(void **state)
{
    (void)state;
    const double turns[3][3] = {{0, 0, 0}, {0, 0, 0.2}, {0, 0, 0}}, moves[3][3] = {{1.5, 0.4, 0}, {1, 0, 0}, {0, 0, 0}};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    scene s = {.focal = 600};
    for (int i = 0; i < 3; i++) {
        s.is_flat = i == 1;
        make(&s, turns[i], moves[i], 7);
        for (int32_t model = ASJ_GEOMETRY_AUTO; model <= ASJ_GEOMETRY_ESSENTIAL; model++) {
            const asj_geometry_options o = blind_options(model);
            const asj_geometry g = estimate(context, &s, &o);
            assert_true(g.cameras[0].fx == 0 && g.focal_sd == 0 && !g.has_pose && uncertainty(&g) == 0);
            if (model == ASJ_GEOMETRY_ESSENTIAL)
                assert_true(g.status == ASJ_GEOMETRY_DEGENERATE || (i == 1 && g.status == ASJ_GEOMETRY_CHANCE));
            else
                assert_true(g.status == ASJ_GEOMETRY_ACCEPTED && g.model != ASJ_GEOMETRY_ESSENTIAL);
        }
    }
    unit_context_free(&counter, &context);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    const double turn[3] = {0.15, -0.5, 0.1}, translation[3] = {2, -0.5, 0.8};
    const asj_geometry_options o = blind_options(ASJ_GEOMETRY_ESSENTIAL);
    scene s = {.focal = 500};
    asj_geometry first = {0}, other;
    make(&s, turn, translation, 5);
    for (int32_t threads = 1; threads <= 3; threads += 2) {
        unit_counter counter = {0};
        asj_context *context = unit_context(&counter, threads);
        other = estimate(context, &s, &o);
        if (threads > 1)
            assert_memory_equal(&first, &other, sizeof first);
        first = other;
        unit_context_free(&counter, &context);
    }
}

static void bad_options_are_refused(void **state)
{
    (void)state;
    const double none[3] = {0, 0, 0};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    scene s = {.focal = 600};
    asj_geometry g;
    make(&s, none, none, 3);
    for (int32_t model = ASJ_GEOMETRY_FUNDAMENTAL; model <= ASJ_GEOMETRY_HOMOGRAPHY; model++) {
        const asj_geometry_options o = blind_options(model);
        assert_int_equal(asj_geometry_estimate(context, s.candidates, COUNT, &o, NULL, &g), ASJ_ERROR_OPTION);
    }
    asj_geometry_options o = blind_options(ASJ_GEOMETRY_AUTO);
    o.cameras[1] = (asj_camera){600, 600, 320, 240};
    assert_int_equal(asj_geometry_estimate(context, s.candidates, COUNT, &o, NULL, &g), ASJ_ERROR_OPTION);
    o = blind_options(ASJ_GEOMETRY_AUTO);
    o.find_focal = 2;
    assert_int_equal(asj_geometry_estimate(context, s.candidates, COUNT, &o, NULL, &g), ASJ_ERROR_OPTION);
    o = blind_options(ASJ_GEOMETRY_AUTO);
    o.focal_sd = 0.05;
    assert_int_equal(asj_geometry_estimate(context, s.candidates, COUNT, &o, NULL, &g), ASJ_ERROR_OPTION);
    const double deviations[] = {-0.01, 0.26, NAN, INFINITY};
    for (size_t k = 0; k < UNIT_COUNT(deviations); k++) {
        o = about_options(ASJ_GEOMETRY_AUTO, 600, 1, deviations[k]);
        assert_int_equal(asj_geometry_estimate(context, s.candidates, COUNT, &o, NULL, &g), ASJ_ERROR_OPTION);
    }
    const double aspects[] = {0, -1, 0.001, 1000, NAN, INFINITY};
    for (size_t k = 0; k < UNIT_COUNT(aspects); k++) {
        o = blind_options(ASJ_GEOMETRY_AUTO);
        o.aspects[1] = aspects[k];
        assert_int_equal(asj_geometry_estimate(context, s.candidates, COUNT, &o, NULL, &g), ASJ_ERROR_OPTION);
    }
    o = blind_options(ASJ_GEOMETRY_AUTO);
    assert_int_equal(asj_geometry_estimate(context, s.candidates, 1, &o, NULL, &g), ASJ_OK);
    assert_int_equal(g.status, ASJ_GEOMETRY_TOO_FEW);
    o = blind_options(ASJ_GEOMETRY_ESSENTIAL);
    assert_int_equal(asj_geometry_estimate(context, s.candidates, 2, &o, NULL, &g), ASJ_OK);
    assert_int_equal(g.status, ASJ_GEOMETRY_CHANCE);
    unit_context_free(&counter, &context);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    const double turn[3] = {0.15, -0.5, 0.1}, translation[3] = {2, -0.5, 0.8};
    asj_geometry_options o = blind_options(ASJ_GEOMETRY_ESSENTIAL);
    scene s = {.focal = 500};
    asj_geometry g;
    long calls = 0;
    o.samples = 20;
    make(&s, turn, translation, 5);
    for (long at = 0; at <= calls; at += at < 8 ? 1 : 17) {
        unit_counter counter = {0};
        asj_context *context = unit_context(&counter, 1);
        const long before = counter.calls;
        counter.fail_at = at ? before + at : 0;
        const asj_status status = asj_geometry_estimate(context, s.candidates, 12, &o, NULL, &g);
        assert_true(status == ASJ_OK || (at > 0 && status == ASJ_ERROR_MEMORY));
        calls = at == 0 ? counter.calls - before : calls;
        counter.fail_at = 0;
        unit_context_free(&counter, &context);
    }
    assert_true(calls > 20);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(focal_lengths_are_found), cmocka_unit_test(about_known_focal_lengths_become_better),
        cmocka_unit_test(open_focal_lengths_stay_about_known), cmocka_unit_test(without_both_cameras_it_says_nothing),
        cmocka_unit_test(a_plane_tells_none),
        cmocka_unit_test(many_sharp_matches_tell_it), cmocka_unit_test(lenses_that_bend_tell_none),
        cmocka_unit_test(directions_need_a_camera),
        cmocka_unit_test(pixels_need_not_be_square),
        cmocka_unit_test(what_leaves_it_open_has_none),
        cmocka_unit_test(threads_change_nothing), cmocka_unit_test(bad_options_are_refused),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests_name("focal", tests, NULL, NULL);
}
