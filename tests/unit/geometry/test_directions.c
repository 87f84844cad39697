/* SPDX-License-Identifier: BSD-2-Clause */
/* Three directions at right angles from straight edges: synthetic edges of known directions among others, none from too few, the
 * density of rotations that they make likely, which way is up, and the focal length at which they are at right angles. */
#include "unit_test.h"

#include "geometry/directions.h"
#include "geometry/focal_prior.h"
#include "geometry/manhattan.h"
#include "geometry/planes.h"
#include "geometry/small_matrix.h"
#include "geometry/upright.h"

#define WIDTH 640
#define HEIGHT 480
#define DEGREE (UNIT_PI / 180)

static const asj_camera camera = {560, 560, 0.5 * (WIDTH - 1), 0.5 * (HEIGHT - 1)};

static double normal(synth_random *random)
{
    const double u = synth_random_between(random, 1e-12, 1);
    return sqrt(-2 * log(u)) * cos(2 * UNIT_PI * synth_random_between(random, 0, 1));
}

static void random_rotation(synth_random *random, double rotation[9])
{
    double w[3];
    for (int k = 0; k < 3; k++)
        w[k] = synth_random_between(random, -1, 1);
    asj_rotation_of(w, rotation);
}

/* An edge of `length` px from a random place towards the vanishing point of d, its ends out by `across` px. */
static asj_straight_edge edge_along(synth_random *random, const double d[3], double length, double across)
{
    const double x = synth_random_between(random, 60, WIDTH - 60), y = synth_random_between(random, 60, HEIGHT - 60);
    const double dx = camera.fx * d[0] + (camera.cx - x) * d[2], dy = camera.fy * d[1] + (camera.cy - y) * d[2];
    const double size = hypot(dx, dy), e = across * normal(random), f = across * normal(random);
    const double ux = dx / size, uy = dy / size;
    return (asj_straight_edge){x - e * uy, y + e * ux, x + length * ux - f * uy, y + length * uy + f * ux, 1};
}

static asj_straight_edge any_edge(synth_random *random)
{
    const double angle = synth_random_between(random, 0, 2 * UNIT_PI), length = synth_random_between(random, 35, 90);
    const double x = synth_random_between(random, 60, WIDTH - 60), y = synth_random_between(random, 60, HEIGHT - 60);
    return (asj_straight_edge){x, y, x + length * cos(angle), y + length * sin(angle), 1};
}

/* rad; whatever the directions are called. */
static double apart(const double a[9], const double b[9])
{
    static const int order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    double most = 0;
    for (int n = 0; n < 6; n++) {
        double trace = 0;
        for (int k = 0; k < 3; k++)
            trace += fabs(asj_dot3(a + 3 * k, b + 3 * order[n][k]));
        most = fmax(most, trace);
    }
    return acos(fmin(1, 0.5 * (most - 1)));
}

/* A third of 120 edges in the directions, fourteen along each, as no vanishing point by itself would be sure. */
static void directions_among_other_edges(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_memory memory = unit_memory(&counter);
    synth_random random;
    int good = 0;
    double square = 0;
    synth_random_seed(&random, 5);
    for (int i = 0; i < 20; i++) {
        asj_straight_edge edges[120];
        asj_directions_list found, again;
        double axes[9];
        random_rotation(&random, axes);
        for (int k = 0; k < 120; k++)
            edges[k] = k >= 42 ? any_edge(&random)
                               : edge_along(&random, axes + 3 * (k % 3), synth_random_between(&random, 35, 110), 0.4);
        assert_true(asj_find_directions(&memory, &(asj_edge_list){edges, 120, 1, WIDTH}, &camera, 1, &found));
        assert_true(asj_find_directions(&memory, &(asj_edge_list){edges, 120, 1, WIDTH}, &camera, 1, &again));
        assert_memory_equal(&found, &again, sizeof found);
        assert_in_range(found.count, 1, 2);
        const double off = apart(found.list[0].axes, axes);
        good += off < 1.5 * DEGREE;
        const double *covariance = found.list[0].covariance;
        if (off < 1.5 * DEGREE)
            square += off * off / (covariance[0] + covariance[4] + covariance[8]);
        for (int a = 0; a < 3; a++)
            unit_near("right angles", i, a, asj_dot3(found.list[0].axes + 3 * a, found.list[0].axes + 3 * ((a + 1) % 3)), 0, 1e-9);
    }
    assert_in_range(good, 18, 20);
    unit_near("variance over the one told", 0, 0, square / good, 0.75, 0.75); /* at most 1.5 */
}

/* Twenty draws of sixty edges along the directions among forty others, turned by `bend` besides, every other one seen in pixels
 * that wide: mean square of the error over the told one, and what is told in the mean, degrees. */
static void errors_of_bent_edges(double bend, double pixel, int32_t exact, double *square, double *told)
{
    unit_counter counter = {0};
    asj_memory memory = unit_memory(&counter);
    synth_random random;
    synth_random_seed(&random, 9);
    *square = *told = 0;
    for (int i = 0; i < 20; i++) {
        asj_straight_edge edges[100];
        asj_directions_list found;
        double axes[9];
        random_rotation(&random, axes);
        for (int k = 0; k < 100; k++) {
            edges[k] = k >= 60 ? any_edge(&random)
                               : edge_along(&random, axes + 3 * (k % 3), synth_random_between(&random, 60, 200),
                                            k % 2 ? 0.2 * pixel : 0.2);
            edges[k].pixel = k % 2 ? pixel : 1;
            const double off = bend * normal(&random), x = edges[k].x2 - edges[k].x1, y = edges[k].y2 - edges[k].y1;
            edges[k].x2 -= off * y;
            edges[k].y2 += off * x;
        }
        assert_true(asj_find_directions(&memory, &(asj_edge_list){edges, 100, 1, WIDTH}, &camera, exact, &found));
        const double *covariance = found.list[0].covariance, all = covariance[0] + covariance[4] + covariance[8];
        const double off = apart(found.list[0].axes, axes);
        *square += off * off / all / 20;
        *told += sqrt(all) / DEGREE / 20;
    }
}

/* Edges that are straight to a twentieth of a degree tell their directions several times as well as those of a room that is not
 * quite at right angles, and both say so. Where the camera is not known each counts for a degree. */
static void edges_say_how_exact_they_are(void **state)
{
    (void)state;
    double square, straight, bent, of_any, mixed;
    errors_of_bent_edges(0.05 * DEGREE, 1, 1, &square, &straight);
    unit_near("variance over the one told, straight", 0, 0, square, 0.85, 0.65);
    errors_of_bent_edges(1.5 * DEGREE, 1, 1, &square, &bent);
    unit_near("variance over the one told, bent", 0, 0, square, 0.85, 0.65);
    unit_near("told of bent ones, degrees", 0, 0, bent, 0.6, 0.2);
    assert_true(straight < 0.25 * bent);
    errors_of_bent_edges(0.05 * DEGREE, 1, 0, &square, &of_any);
    assert_true(of_any > 3 * straight && square < 0.3);
    errors_of_bent_edges(0.05 * DEGREE, 8, 1, &square, &mixed);
    unit_near("variance over the one told, half of them seen in pixels 8 px wide", 0, 0, square, 0.85, 0.65);
    printf("told: straight %.3f, half of them coarse %.3f degrees\n", straight, mixed);
    assert_true(mixed > straight && mixed < 1.8 * straight); /* the others still count in full */
}

static void too_few_have_none(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_memory memory = unit_memory(&counter);
    synth_random random;
    asj_straight_edge edges[40];
    asj_directions_list found;
    synth_random_seed(&random, 6);
    assert_true(asj_find_directions(&memory, &(asj_edge_list){NULL, 0, 1, WIDTH}, &camera, 1, &found));
    assert_int_equal(found.count, 0);
    for (int k = 0; k < 40; k++) { /* short ones */
        edges[k] = any_edge(&random);
        edges[k].x2 = edges[k].x1 + 0.1 * (edges[k].x2 - edges[k].x1);
        edges[k].y2 = edges[k].y1 + 0.1 * (edges[k].y2 - edges[k].y1);
    }
    assert_true(asj_find_directions(&memory, &(asj_edge_list){edges, 40, 1, WIDTH}, &camera, 1, &found));
    assert_int_equal(found.count, 0);
    for (int k = 0; k < 40; k++)
        edges[k] = (asj_straight_edge){100, 100, 200, 150, 1}; /* one line */
    assert_true(asj_find_directions(&memory, &(asj_edge_list){edges, 40, 1, WIDTH}, &camera, 1, &found));
    assert_int_equal(found.count, 0);
    counter.fail_at = counter.calls + 1;
    assert_false(asj_find_directions(&memory, &(asj_edge_list){edges, 40, 1, WIDTH}, &camera, 1, &found));
}

static void one_set_is_added_once(void **state)
{
    (void)state;
    asj_directions_list list = {.count = 0};
    asj_directions one = {.axes = {1, 0, 0, 0, 1, 0, 0, 0, 1}}, renamed = {.axes = {0, 0, 1, -1, 0, 0, 0, 1, 0}}, other = one;
    const double w[3] = {0.2, 0.1, 0};
    asj_rotation_of(w, other.axes);
    asj_directions_add(&list, &one);
    asj_directions_add(&list, &renamed);
    assert_int_equal(list.count, 1);
    asj_directions_add(&list, &other);
    assert_int_equal(list.count, 2);
    for (int k = 0; k < 9; k++) {
        const double turn[3] = {0, 0.08 * k, 0.3};
        asj_rotation_of(turn, other.axes);
        asj_directions_add(&list, &other);
    }
    assert_int_equal(list.count, ASJ_MOST_DIRECTIONS);
}

/* The density has mass one: the integral over rotations near one of its middles, drawn by their angle so that narrow parts are
 * seen, times their part of all. */
static void rotations_have_a_density(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_memory memory = unit_memory(&counter);
    synth_random random;
    asj_directions_list both[2] = {{.count = 1}, {.count = 1}};
    asj_pairs set = {.count = 0};
    double truth[9], w[3], sum = 0;
    synth_random_seed(&random, 8);
    random_rotation(&random, both[0].list[0].axes);
    random_rotation(&random, truth);
    asj_multiply3_transposed(both[0].list[0].axes, truth, both[1].list[0].axes); /* D2 = D1 R' */
    for (int v = 0; v < 2; v++)
        for (int k = 0; k < 3; k++)
            both[v].list[0].covariance[4 * k] = 1e-6 * (1 + 10 * k);
    assert_true(asj_manhattan_rotations(&memory, both, &set));
    assert_int_equal(set.rotation_count, 24);
    assert_in_range(asj_nearest_rotation(&set, truth, w), 0, 23);
    unit_near("the right one", 0, 0, sqrt(asj_dot3(w, w)), 0, 1e-6);
    const int draws = 20000;
    const double half = 0.105; /* rad: beyond that no rotation counts */
    for (int n = 0; n < draws; n++) {
        double turn[9], moved[9];
        for (int k = 0; k < 3; k++)
            w[k] = normal(&random);
        const double angle = synth_random_between(&random, 0, half), size = sqrt(asj_dot3(w, w));
        for (int k = 0; k < 3; k++)
            w[k] *= angle / size;
        asj_rotation_of(w, turn);
        asj_multiply3(turn, truth, moved);
        sum += 2 * (exp(asj_rotation_prior(&set, moved)) - 0.5) * 4 * UNIT_PI * angle * angle;
    }
    unit_near("mass of one of 24", 0, 0, sum / draws * half / (8 * UNIT_PI * UNIT_PI) * 24, 1, 0.04);
    set.rotation_count = 0;
    unit_near("none", 0, 0, asj_rotation_prior(&set, truth), 0, 0);
    asj_release(&memory, set.rotations);
    both[1].count = 0;
    assert_true(asj_manhattan_rotations(&memory, both, &set));
    assert_int_equal(set.rotation_count, 0);
}

/* Directions as a camera sees them that is turned like this. */
static void turned_directions(double x, double y, double z, asj_directions_list *list)
{
    const double w[3] = {x, y, z};
    double turn[9];
    memset(list, 0, sizeof *list);
    list->count = 1;
    asj_rotation_of(w, turn);
    for (int k = 0; k < 9; k++) /* rows: R e_k */
        list->list[0].axes[k] = turn[3 * (k % 3) + k / 3];
    for (int k = 0; k < 3; k++)
        list->list[0].covariance[4 * k] = 1e-6;
}

/* Upright in both images: 4 of the 24 names have nine tenths of the density and their part of the rest. Rolled by 45 degrees:
 * nothing is known. */
static void down_stays_down(void **state)
{
    (void)state;
    for (int rolled = 0; rolled < 2; rolled++) {
        unit_counter counter = {0};
        asj_memory memory = unit_memory(&counter);
        asj_directions_list both[2];
        asj_pairs set = {.count = 0};
        int more = 0;
        turned_directions(0.2, 0.4, 0, &both[0]);
        turned_directions(0, -0.3, rolled ? UNIT_PI / 4 : 0.1, &both[1]);
        assert_true(asj_manhattan_rotations(&memory, both, &set));
        assert_int_equal(set.rotation_count, 24);
        assert_int_equal(set.has_down, !rolled);
        for (int k = 0; k < 24; k++) {
            double down[3];
            asj_apply3(set.rotations[k].matrix, set.down[0], down);
            const int stays = !rolled && asj_dot3(down, set.down[1]) > 0.9;
            const double share = rolled ? 1.0 / 24 : stays ? 0.9 / 4 + 0.1 / 24 : 0.1 / 24, sd = 0.25 * DEGREE;
            const double variance = sd * sd + 2 * 2e-6;
            unit_near("share", k, rolled, set.rotations[k].log_top[1],
                      log(share / ASJ_ROTATION_SIZES * 8 * UNIT_PI * UNIT_PI) - 1.5 * log(2 * UNIT_PI * variance), 1e-9);
            more += stays;
        }
        assert_int_equal(more, rolled ? 0 : 4);
        asj_release(&memory, set.rotations);
    }
}

/* Of two sets of directions the one that explains more of the edges has nearly all of what is not shared evenly. */
static void what_explains_more_counts_more(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_memory memory = unit_memory(&counter);
    asj_directions_list both[2], other;
    asj_pairs set = {.count = 0};
    turned_directions(0.2, 0.4, 0, &both[0]);
    turned_directions(0.2, 0.6, 0, &other);
    turned_directions(0, -0.3, 0.1, &both[1]);
    both[0].list[both[0].count++] = other.list[0];
    both[0].list[0].score = 40;
    both[0].list[1].score = 34;
    assert_true(asj_manhattan_rotations(&memory, both, &set));
    assert_int_equal(set.rotation_count, 48);
    double share[2] = {0, 0};
    for (int k = 0; k < 48; k++)
        share[set.rotations[k].of_set[0]] += exp(set.rotations[k].log_share);
    for (int n = 0; n < 2; n++)
        unit_near("share", n, 0, share[n], 0.05 + 0.9 * exp(n ? -3.0 : 0.0) / (1 + exp(-3.0)), 1e-12);
    asj_release(&memory, set.rotations);
}

/* A motion with a plane, as an essential matrix and as the homography of the plane. */
static void make_motion(double yaw, double roll, asj_model *motion, asj_model *plane)
{
    const double about_y[3] = {0, yaw, 0}, about_z[3] = {0, 0, roll}, t[3] = {0.8, 0.1, 0.3}, n[3] = {0.1, 0.6, 0.3};
    double turn[9], over[9], h[9];
    memset(motion, 0, sizeof *motion);
    memset(plane, 0, sizeof *plane);
    asj_rotation_of(about_y, turn);
    asj_rotation_of(about_z, over);
    asj_multiply3(over, turn, motion->rotation);
    motion->kind = ASJ_GEOMETRY_ESSENTIAL;
    plane->kind = ASJ_GEOMETRY_HOMOGRAPHY;
    for (int k = 0; k < 9; k++)
        h[k] = motion->rotation[k] + t[k / 3] * n[k % 3];
    const asj_camera cameras[2] = {camera, camera};
    asj_pixel_homography(h, cameras, plane->view.matrix);
}

static void what_turns_the_room_over(void **state)
{
    (void)state;
    const asj_camera cameras[2] = {camera, camera};
    asj_pairs set = {.has_down = 1, .down = {{0, 1, 0}, {0, 1, 0}}};
    asj_model motion, plane;
    for (int over = 0; over < 2; over++) {
        make_motion(0.5, over ? UNIT_PI : 0.1, &motion, &plane);
        assert_int_equal(asj_turns_over(&set, &motion, cameras), over);
        assert_int_equal(asj_turns_over(&set, &plane, cameras), over);
        assert_int_equal(asj_turns_over(&set, &motion, NULL), 0);
        double rotations[2][9], least = HUGE_VAL;
        assert_int_equal(asj_rotations_of_homography(&plane, cameras, rotations), 2);
        for (int n = 0; n < 2; n++) {
            double turn[9];
            asj_multiply3_transposed(rotations[n], motion.rotation, turn);
            least = fmin(least, asj_rotation_angle(turn));
        }
        unit_near("rotation", over, 0, least, 0, 1e-6);
    }
    make_motion(0.5, UNIT_PI / 2, &motion, &plane);
    assert_int_equal(asj_turns_over(&set, &motion, cameras), 1);
    set.has_down = 0;
    assert_int_equal(asj_turns_over(&set, &motion, cameras), 0);
    assert_int_equal(asj_turns_over(&set, &plane, cameras), 0);
}

/* Density of factors and rotations, q being the density of one between directions. */
static double joint(const asj_focal_prior *prior, double factor, double q)
{
    return exp(asj_log_focal_prior(prior, factor)) * (0.5 + 0.5 * exp(asj_log_focal_share(prior, factor)) * q);
}

/* Forty edges along three directions among others tell the focal length; the density has mass one over factors, and over rotations
 * at each: whether edges say something or not. */
static void edges_tell_the_focal_length(void **state)
{
    (void)state;
    const asj_camera unit[2] = {{WIDTH, WIDTH, camera.cx, camera.cy}, {WIDTH, WIDTH, camera.cx, camera.cy}};
    asj_context *context;
    synth_random random;
    asj_straight_edge edges[2][100];
    int good = 0;
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    synth_random_seed(&random, 15);
    for (int i = 0; i < 6; i++) {
        const asj_edge_list lists[2] = {{edges[0], 100, 1, WIDTH}, {edges[1], 100, 1, WIDTH}};
        const asj_pairs set = {.count = 0};
        static asj_focal_prior prior;
        double axes[9], sum = 0;
        for (int v = 0; v < 2; v++) {
            random_rotation(&random, axes);
            for (int k = 0; k < 100; k++)
                edges[v][k] = k >= 40 ? any_edge(&random)
                                      : edge_along(&random, axes + 3 * (k % 3), synth_random_between(&random, 50, 150), 0.4);
        }
        assert_int_equal(asj_focal_prior_make(context, &set, lists, unit, 0, &prior), ASJ_OK);
        const int32_t best = asj_likeliest_focal(&prior);
        good += best >= 0 && fabs(log(asj_focal_factor(&prior, best) * WIDTH / camera.fx)) < 1.5 * prior.step;
        for (int32_t k = 0; k < prior.count; k++) {
            asj_directions_list again[2];
            const double f = asj_focal_factor(&prior, k), s = 4 * joint(&prior, f, 0) - 1;
            sum += s / prior.count;
            unit_near("rotations", i, k, joint(&prior, f, 3), 0.25 + s / 4 + 3 * s / 2, 1e-9 * (1 + s));
            assert_int_equal(asj_focal_directions(context, &prior, f, again), ASJ_OK);
            assert_memory_equal(&again[1], &prior.directions[1][k], sizeof again[1]);
        }
        unit_near("mass", i, 0, sum, 1, 1e-9);
        const double between = asj_focal_factor(&prior, best) * exp(0.4 * prior.step);
        unit_near("interpolated", i, 0, asj_log_focal_share(&prior, between) + asj_log_focal_prior(&prior, between),
                  0.6 * prior.log_edges[best] + 0.4 * prior.log_edges[best + 1], 1e-9);
    }
    assert_in_range(good, 5, 6);
    static asj_focal_prior flat;
    const asj_pairs set = {.count = 0};
    assert_int_equal(asj_focal_prior_make(context, &set, NULL, unit, 0, &flat), ASJ_OK);
    assert_int_equal(asj_likeliest_focal(&flat), -1);
    unit_near("flat", 0, 0, asj_log_focal_prior(&flat, 0.7), 0, 1e-15);
    asj_context_free(&context);
}

/* Where focal lengths are known to a tenth, and are 12 % too long, the likeliest factor lies between 1 and what edges say; without
 * edges it is 1, and the density is that of a normal distribution; with them the mass is one, too. */
static void about_known_focal_lengths_have_a_density(void **state)
{
    (void)state;
    const double sd = 0.1, given = 1.12 * camera.fx;
    const asj_camera about[2] = {{given, given, camera.cx, camera.cy}, {given, given, camera.cx, camera.cy}};
    const asj_pairs set = {.count = 0};
    static asj_focal_prior prior;
    asj_straight_edge edges[2][60];
    const asj_edge_list lists[2] = {{edges[0], 60, 1, WIDTH}, {edges[1], 60, 1, WIDTH}};
    asj_context *context;
    synth_random random;
    double axes[9];
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    synth_random_seed(&random, 4);
    for (int v = 0; v < 2; v++) {
        random_rotation(&random, axes);
        for (int k = 0; k < 60; k++)
            edges[v][k] = edge_along(&random, axes + 3 * (k % 3), synth_random_between(&random, 50, 150), 0.4);
    }
    for (int with = 0; with < 2; with++) {
        assert_int_equal(asj_focal_prior_make(context, &set, with ? lists : NULL, about, sd, &prior), ASJ_OK);
        const double likeliest = log(asj_focal_factor(&prior, asj_likeliest_focal(&prior))), range = asj_focal_range(&prior);
        double mass = 0;
        for (int32_t k = 0; k < prior.count; k++) {
            const double factor = asj_focal_factor(&prior, k), z = log(factor) / sd, s = exp(prior.log_edges[k]);
            const double normal = exp(-0.5 * z * z) / (sd * sqrt(2 * UNIT_PI));
            const double density = exp(asj_log_focal_prior(&prior, factor)) / range;
            unit_near("density", with, k, density, normal * (0.5 + 0.5 * s), 1e-9 * (1 + s));
            mass += density * prior.step;
        }
        unit_near("mass", with, 0, mass, 1, 1e-3);
        unit_near("likeliest", with, 0, likeliest, with ? -0.08 : 0, with ? 0.06 : 1e-12);
    }
    asj_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(directions_among_other_edges), cmocka_unit_test(edges_say_how_exact_they_are),
        cmocka_unit_test(what_explains_more_counts_more), cmocka_unit_test(too_few_have_none),
        cmocka_unit_test(one_set_is_added_once), cmocka_unit_test(rotations_have_a_density),
        cmocka_unit_test(down_stays_down), cmocka_unit_test(what_turns_the_room_over),
        cmocka_unit_test(edges_tell_the_focal_length), cmocka_unit_test(about_known_focal_lengths_have_a_density)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
