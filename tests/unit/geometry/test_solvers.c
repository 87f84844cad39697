/* SPDX-License-Identifier: BSD-2-Clause */
/* Elementary functions, small matrices, roots of polynomials, and minimal solvers against motions that are known. */
#include "unit_test.h"

#include "geometry/elementary.h"
#include "geometry/five_point.h"
#include "geometry/minimal.h"
#include "geometry/planes.h"
#include "geometry/polynomial.h"
#include "geometry/small_matrix.h"
#include "geometry/turned.h"

static void exp_and_log_are_those_of_the_library(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 2);
    for (int i = 0; i < 20000; i++) {
        const double x = -pow(10, synth_random_between(&random, -12, 2.83)), y = exp(synth_random_between(&random, -1, 1) * -x);
        const double log_y = log(y);
        unit_near("exp", i, 0, asj_exp_falling(x) / exp(x), 1, 2e-14);
        unit_near("log", i, 0, asj_log_normal(y), log_y, 4e-15 * fabs(log_y));
    }
    unit_near("exp of 0", 0, 0, asj_exp_falling(0), 1, 0);
    unit_near("log of 1", 0, 0, asj_log_normal(1), 0, 0);
    unit_near("exp far out", 0, 0, asj_exp_falling(-1e9), 0, 0);
    unit_near("exp of minus infinity", 0, 0, asj_exp_falling(-HUGE_VAL), 0, 0);
}

/* --- matrices ---------------------------------------------------------------------------------------------------------------- */

static void random_matrix(synth_random *random, double m[9])
{
    for (int k = 0; k < 9; k++)
        m[k] = synth_random_between(random, -2, 2);
}

static void singular_values_rebuild(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 1);
    for (int i = 0; i < 300; i++) {
        double m[9], u[9], s[3], v[9], scaled[9], back[9];
        random_matrix(&random, m);
        if (i % 3 == 1) /* rank 2, and rank 1 */
            for (int k = 0; k < 3; k++)
                m[6 + k] = m[k] - 2 * m[3 + k];
        if (i % 3 == 2)
            for (int k = 0; k < 9; k++)
                m[k] = (1 + k / 3) * (k % 3 - 0.5);
        asj_svd3(m, u, s, v);
        unit_near("det U", i, 0, asj_determinant3(u), 1, 1e-9);
        unit_near("det V", i, 0, asj_determinant3(v), 1, 1e-9);
        assert_true(s[0] >= s[1] - 1e-12 && s[1] >= fabs(s[2]) - 1e-7);
        for (int k = 0; k < 9; k++)
            scaled[k] = u[k] * s[k % 3];
        asj_multiply3_transposed(scaled, v, back);
        for (int k = 0; k < 9; k++)
            unit_near("U S V'", i, k, back[k], m[k], 1e-7);
    }
}

/* The vector of the smallest eigenvalue, by both ways; none where two eigenvalues are 0. */
static void the_least_vector_is_an_eigenvector(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 12);
    for (int i = 0; i < 200; i++) {
        double a[81] = {0}, values[9], vectors[81], copy[81], v[9], along = 0;
        const int rows = i % 3 == 0 ? 7 : i % 3 == 1 ? 8 : 12;
        for (int r = 0; r < rows; r++) {
            double row[9];
            for (int k = 0; k < 9; k++)
                row[k] = synth_random_between(&random, -2, 2);
            for (int k = 0; k < 81; k++)
                a[k] += row[k / 9] * row[k % 9];
        }
        asj_symmetric_eigen(a, 9, values, vectors);
        memcpy(copy, a, sizeof a);
        assert_int_equal(asj_least_vector9(copy, v), rows > 7);
        if (rows == 7)
            continue;
        for (int k = 0; k < 9; k++)
            along += v[k] * vectors[9 * k];
        /* four rounds of iteration leave what the second smallest has, by the fourth power of the ratio and better */
        unit_near("along the eigenvector", i, rows, fabs(along), 1, rows == 8 ? 1e-9 : 2 * pow(values[0] / values[1], 4) + 1e-9);
    }
}

static void rotations_and_their_angles(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 2);
    for (int i = 0; i < 200; i++) {
        const double size = i < 100 ? pow(10, -0.1 * i) : synth_random_between(&random, 0, 3.1);
        double w[3], r[9], unit[9];
        for (int k = 0; k < 3; k++)
            w[k] = synth_random_between(&random, -1, 1);
        assert_true(asj_normalise3(w));
        for (int k = 0; k < 3; k++)
            w[k] *= size;
        asj_rotation_of(w, r);
        asj_multiply3_transposed(r, r, unit);
        for (int k = 0; k < 9; k++)
            unit_near("R R'", i, k, unit[k], k % 4 == 0, 1e-12);
        unit_near("angle", i, size, asj_rotation_angle(r), size, 1e-9);
    }
}

static void systems_are_solved_or_refused(void **state)
{
    (void)state;
    double a[9] = {4, 2, 0, 2, 5, 1, 0, 1, 3}, b[3] = {8, 15, 11}, log_determinant;
    assert_true(asj_cholesky_solve(a, 3, b, &log_determinant)); /* x = 1, 2, 3 */
    for (int k = 0; k < 3; k++)
        unit_near("x", k, 0, b[k], k + 1, 1e-12);
    unit_near("log det", 0, 0, log_determinant, log(44), 1e-12);
    double bad[4] = {1, 2, 2, 1}, right[2] = {1, 1}, nan_matrix[4] = {NAN, 0, 0, 1};
    assert_false(asj_cholesky_solve(bad, 2, right, NULL));
    assert_false(asj_cholesky_solve(nan_matrix, 2, right, NULL));
    double same[18] = {1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9}, basis[81];
    assert_false(asj_null_space9(same, 2, basis));
    double zero[3] = {0, 0, 0}, inverse[9], singular[9] = {1, 2, 3, 2, 4, 6, 0, 0, 1};
    assert_false(asj_normalise3(zero));
    assert_false(asj_invert3(singular, inverse));
}

/* --- polynomials ------------------------------------------------------------------------------------------------------------- */

static void roots_of_products(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 3);
    for (int i = 0; i < 500; i++) {
        const int degree = 1 + i % ASJ_POLYNOMIAL_DEGREE, pairs = degree > 2 ? i / 10 % 2 : 0, real = degree - 2 * pairs;
        double c[ASJ_POLYNOMIAL_DEGREE + 1] = {1}, wanted[ASJ_POLYNOMIAL_DEGREE], found[ASJ_POLYNOMIAL_DEGREE];
        int n = 0;
        for (int r = 0; r < real; r++) { /* at least 0.1 apart, inside and outside [-1, 1] */
            wanted[r] = (r - real / 2) * 0.45 + synth_random_between(&random, 0, 0.3);
            n++;
            for (int k = n; k >= 0; k--)
                c[k] = (k > 0 ? c[k - 1] : 0) - wanted[r] * (k < n ? c[k] : 0);
        }
        for (int p = 0; p < pairs; p++) { /* x^2 + x + 2 has none */
            n += 2;
            for (int k = n; k >= 0; k--)
                c[k] = (k < n - 1 ? 2 * c[k] : 0) + (k > 0 && k < n ? c[k - 1] : 0) + (k > 1 ? c[k - 2] : 0);
        }
        assert_int_equal(asj_polynomial_roots(c, degree, found), real);
        for (int r = 0; r < real; r++) {
            double nearest = HUGE_VAL;
            for (int k = 0; k < real; k++)
                nearest = fmin(nearest, fabs(found[k] - wanted[r]));
            unit_near("root", i, r, nearest, 0, 1e-6);
        }
    }
    const double around[4] = {1.5, -1, -1.5, 1}; /* (x - 1)(x + 1)(x - 1.5): beside 1 and -1 both halves of the line look */
    double three[3] = {0, 0, 0};
    assert_int_equal(asj_polynomial_roots(around, 3, three), 3);
    unit_near("sum of the roots", 0, 0, three[0] + three[1] + three[2], 1.5, 1e-9);
    unit_near("their product", 0, 0, three[0] * three[1] * three[2], -1.5, 1e-9);
    const double none[3] = {1, 0, 1}, bad[3] = {1, NAN, 1}, zero[3] = {0, 0, 0};
    double found[2];
    assert_int_equal(asj_polynomial_roots(none, 2, found), 0);
    assert_int_equal(asj_polynomial_roots(bad, 2, found), 0);
    assert_int_equal(asj_polynomial_roots(zero, 2, found), 0);
}

/* --- two views --------------------------------------------------------------------------------------------------------------- */

typedef struct motion {
    double rotation[9], translation[3], essential[9];
} motion;

static motion random_motion(synth_random *random)
{
    motion m;
    double w[3], skew[9];
    for (int k = 0; k < 3; k++) {
        w[k] = synth_random_between(random, -0.6, 0.6);
        m.translation[k] = synth_random_between(random, -1, 1);
    }
    assert_true(asj_normalise3(m.translation));
    asj_rotation_of(w, m.rotation);
    asj_skew3(m.translation, skew);
    asj_multiply3(skew, m.rotation, m.essential);
    return m;
}

static void transfer(const motion *m, const double point[3], double out[3])
{
    asj_apply3(m->rotation, point, out);
    for (int k = 0; k < 3; k++)
        out[k] += m->translation[k];
}

static void five_points_give_the_motion(void **state)
{
    (void)state;
    synth_random random;
    int missed = 0;
    synth_random_seed(&random, 4);
    for (int i = 0; i < 1000; i++) {
        const motion m = random_motion(&random);
        asj_ray_pair pairs[5];
        double found[ASJ_FIVE_POINT_SOLUTIONS][9], best = HUGE_VAL;
        for (int k = 0; k < 5; k++) { /* every second time all on one plane */
            const double p[3] = {synth_random_between(&random, -2, 2), synth_random_between(&random, -2, 2),
                                 i % 2 ? 5 : synth_random_between(&random, 3, 7)};
            double q[3];
            transfer(&m, p, q);
            pairs[k] = (asj_ray_pair){p[0] / p[2], p[1] / p[2], q[0] / q[2], q[1] / q[2]};
        }
        const int32_t count = asj_five_point(pairs, found);
        for (int32_t s = 0; s < count; s++) {
            double plus = 0, minus = 0;
            for (int k = 0; k < 5; k++) { /* naive: every solution fits its points and is essential */
                const double x1[3] = {pairs[k].x1, pairs[k].y1, 1}, x2[3] = {pairs[k].x2, pairs[k].y2, 1};
                double line[3];
                asj_apply3(found[s], x1, line);
                unit_near("x2' E x1", i, s, asj_dot3(x2, line), 0, 1e-6);
            }
            double u[9], values[3], v[9];
            asj_svd3(found[s], u, values, v);
            unit_near("singular values", i, s, values[1] / values[0], 1, 0.02);
            unit_near("rank", i, s, values[2] / values[0], 0, 1e-3);
            for (int k = 0; k < 9; k++) {
                plus = fmax(plus, fabs(found[s][k] - m.essential[k]));
                minus = fmax(minus, fabs(found[s][k] + m.essential[k]));
            }
            best = fmin(best, fmin(plus, minus));
        }
        missed += !(best < 1e-4);
    }
    assert_in_range(missed, 0, 15); /* of 1000: where roots nearly coincide */
    const asj_ray_pair repeated[5] = {{0.1, 0.2, 0.3, 0.4}, {0.1, 0.2, 0.3, 0.4}, {0.1, 0.2, 0.3, 0.4}, {0, 0, 0, 0}, {1, 0, 1, 0}};
    const asj_ray_pair bad[5] = {{NAN, 0, 0, 0}, {0, 1, 0, 1}, {1, 0, 1, 0}, {1, 1, 1, 1}, {0.5, 0, 0.5, 0}};
    double found[ASJ_FIVE_POINT_SOLUTIONS][9];
    assert_int_equal(asj_five_point(repeated, found), 0);
    assert_int_equal(asj_five_point(bad, found), 0);
}

static const asj_camera cameras[2] = {{600, 610, 320, 240}, {550, 550, 310, 250}};

static void project(const asj_camera *c, const double p[3], double xy[2])
{
    xy[0] = c->fx * p[0] / p[2] + c->cx;
    xy[1] = c->fy * p[1] / p[2] + c->cy;
}

/* A candidate on the plane through `point` with the normal: locations, and the derivative of the map by differences. */
static asj_pair patch(const motion *m, const double point[3], const double normal[3])
{
    asj_pair pair;
    double x1[2], x2[2], q[3];
    memset(&pair, 0, sizeof pair);
    project(&cameras[0], point, x1);
    transfer(m, point, q);
    project(&cameras[1], q, x2);
    pair.x1 = x1[0];
    pair.y1 = x1[1];
    pair.x2 = x2[0];
    pair.y2 = x2[1];
    for (int k = 0; k < 2; k++) {
        double ends[2][2];
        for (int side = 0; side < 2; side++) {
            const double step = side ? 1e-3 : -1e-3;
            double ray[3], p[3];
            asj_ray(&cameras[0], x1[0] + (k == 0 ? step : 0), x1[1] + (k == 1 ? step : 0), ray);
            const double depth = asj_dot3(normal, point) / asj_dot3(normal, ray);
            for (int j = 0; j < 3; j++)
                p[j] = depth * ray[j];
            transfer(m, p, q);
            project(&cameras[1], q, ends[side]);
        }
        pair.affine[k] = (ends[1][0] - ends[0][0]) / 2e-3;
        pair.affine[2 + k] = (ends[1][1] - ends[0][1]) / 2e-3;
    }
    return pair;
}

static asj_pair random_patch(synth_random *random, const motion *m, int planar)
{
    const double flat[3] = {0.3, -0.2, -1};
    double normal[3] = {synth_random_between(random, -0.5, 0.5), synth_random_between(random, -0.5, 0.5), -1}, point[3];
    for (int k = 0; k < 2; k++)
        point[k] = synth_random_between(random, -1.5, 1.5);
    point[2] = planar ? 5 + flat[0] * point[0] + flat[1] * point[1] : synth_random_between(random, 4, 7);
    return patch(m, point, planar ? flat : normal);
}

/* The equations on which everything rests: x2' F x1 = 0, and A' n2 = -n1, sign included. */
static void right_candidates_have_no_residuals(void **state)
{
    (void)state;
    synth_random random;
    const asj_pairs set = {.location_sd = 1, .angle_sd = 0.1, .scale_sd = 0.1};
    synth_random_seed(&random, 5);
    for (int i = 0; i < 200; i++) {
        const motion m = random_motion(&random);
        asj_pair pair = random_patch(&random, &m, 0);
        asj_residuals r;
        double f[9];
        asj_fundamental_of(m.essential, cameras, f);
        asj_epipolar_residuals(f, &set, &pair, &r);
        unit_near("residual", i, 0, r.square, 0, 1e-3);
        for (int k = 0; k < 4; k++) /* turned by 180 degrees: the sign is wrong */
            pair.affine[k] = -pair.affine[k];
        asj_epipolar_residuals(f, &set, &pair, &r);
        assert_true(r.square > 1e30);
    }
}

static void two_candidates_give_the_motion(void **state)
{
    (void)state;
    synth_random random;
    const asj_pairs set = {.location_sd = 1.5, .angle_sd = 0.16, .scale_sd = 0.22};
    int right = 0, tried = 0;
    synth_random_seed(&random, 6);
    for (int i = 0; i < 300; i++) {
        const motion m = random_motion(&random);
        const asj_pair pairs[2] = {random_patch(&random, &m, 0), random_patch(&random, &m, 0)};
        const asj_pair *const both[2] = {&pairs[0], &pairs[1]};
        asj_model model;
        double turn[9];
        memset(&model, 0, sizeof model);
        tried++;
        if (!asj_essential_from_two(&set, both, cameras, &model))
            continue;
        asj_multiply3_transposed(model.rotation, m.rotation, turn);
        right += asj_rotation_angle(turn) < 0.05 && asj_dot3(model.translation, m.translation) > 0.995;
    }
    assert_in_range(right, 180, tried); /* 196: three points of an affine map are not quite where the camera sees them */
}

static void three_candidates_give_the_fundamental_matrix(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 7);
    for (int i = 0; i < 200; i++) {
        const motion m = random_motion(&random);
        const asj_pair pairs[3] = {random_patch(&random, &m, 0), random_patch(&random, &m, 0), random_patch(&random, &m, 0)};
        const asj_pair *const all[3] = {&pairs[0], &pairs[1], &pairs[2]};
        const asj_pair other = random_patch(&random, &m, 0);
        const asj_pairs set = {.location_sd = 1, .angle_sd = 0.1, .scale_sd = 0.1};
        asj_model model;
        asj_residuals r;
        memset(&model, 0, sizeof model);
        assert_true(asj_fundamental_from_three(all, cameras, &model));
        asj_epipolar_residuals(model.view.matrix, &set, &other, &r);
        unit_near("a fourth one", i, 0, r.square, 0, 0.05);
        unit_near("rank", i, 0, asj_determinant3(model.view.matrix), 0, 1e-15);
    }
    const motion m = random_motion(&random);
    const asj_pair pair = random_patch(&random, &m, 0);
    const asj_pair *const same[3] = {&pair, &pair, &pair};
    asj_model model;
    assert_false(asj_fundamental_from_three(same, cameras, &model));
}

static void two_candidates_give_the_homography(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 8);
    int contradictions = 0;
    for (int i = 0; i < 200; i++) {
        const motion m = random_motion(&random);
        const asj_pair pairs[3] = {random_patch(&random, &m, 1), random_patch(&random, &m, 1), random_patch(&random, &m, 1)};
        const asj_pair *const both[2] = {&pairs[0], &pairs[1]};
        const asj_pairs set = {.location_sd = 1, .angle_sd = 0.1, .scale_sd = 0.1};
        asj_model model;
        asj_residuals r;
        memset(&model, 0, sizeof model);
        assert_true(asj_homography_from_two(&set, both, cameras, &model));
        asj_planar_residuals(model.view.matrix, &set, &pairs[2], &r);
        unit_near("a third one", i, 0, r.square, 0, 0.05);
        asj_pair wrong = pairs[1];
        for (int k = 0; k < 4; k++) /* a quarter turn more than the first one, which no plane explains */
            wrong.affine[k] = k < 2 ? -pairs[1].affine[2 + k] : pairs[1].affine[k - 2];
        const asj_pair *const apart[2] = {&pairs[0], &wrong};
        contradictions += !asj_homography_from_two(&set, apart, cameras, &model);
    }
    assert_true(contradictions > 190);
}

/* Of the motions of a plane's homography one is the motion, with the plane; both explain every candidate of the plane. */
static void a_homography_gives_its_motions(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 9);
    for (int i = 0; i < 100; i++) {
        const motion m = random_motion(&random);
        asj_pair list[12];
        asj_pairs set = {.list = list, .count = 12, .location_sd = 1, .angle_sd = 0.1, .scale_sd = 0.1, .spread = 300, .area = 3e5};
        asj_model plane, motions[2];
        for (int k = 0; k < 12; k++) {
            list[k] = random_patch(&random, &m, 1);
            list[k].prior = 0.5;
        }
        const asj_pair *const both[2] = {&list[0], &list[1]};
        memset(&plane, 0, sizeof plane);
        assert_true(asj_homography_from_two(&set, both, cameras, &plane));
        const int32_t count = asj_motions_of_homography(&set, &plane, cameras, motions);
        double least = HUGE_VAL;
        assert_in_range(count, 1, 2);
        for (int32_t n = 0; n < count; n++) {
            double turn[9];
            asj_residuals r;
            asj_multiply3_transposed(motions[n].rotation, m.rotation, turn);
            least = fmin(least, asj_rotation_angle(turn) + acos(fmin(1, asj_dot3(motions[n].translation, m.translation))));
            for (int k = 0; k < 12; k++) {
                asj_part_residuals(&motions[n].view, 1, &set, &list[k], &r);
                unit_near("on the plane", i, k, r.square, 0, 0.1);
                asj_part_residuals(&motions[n].view, 0, &set, &list[k], &r);
                unit_near("on its line", i, k, r.square, 0, 0.1);
            }
        }
        unit_near("motion", i, 0, least, 0, 0.02);
        double turned[9];
        asj_pixel_homography(m.rotation, cameras, turned); /* a camera that only turns */
        memcpy(plane.view.matrix, turned, sizeof turned);
        assert_int_equal(asj_motions_of_homography(&set, &plane, cameras, motions), 0);
    }
}

/* Of any homography that is not singular, mirrored and ill-conditioned ones too, both are rotations and no reflections. */
static void a_homography_gives_rotations(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 31);
    int some = 0;
    for (int i = 0; i < 3000; i++) {
        const double nearly = i % 3 ? pow(10, -0.5 * (i % 9)) : 1; /* as large as what the last row does not have of the others */
        double n[9], rotations[2][9], unit[9];
        asj_model plane;
        random_matrix(&random, n);
        for (int k = 0; k < 3; k++)
            n[6 + k] = nearly * n[6 + k] + (1 - nearly) * (n[k] - 0.5 * n[3 + k]);
        memset(&plane, 0, sizeof plane);
        asj_pixel_homography(n, cameras, plane.view.matrix);
        const int32_t count = asj_rotations_of_homography(&plane, cameras, rotations);
        for (int32_t k = 0; k < count; k++) {
            unit_near("determinant", i, k, asj_determinant3(rotations[k]), 1, 1e-6);
            asj_multiply3_transposed(rotations[k], rotations[k], unit);
            for (int e = 0; e < 9; e++)
                unit_near("R R'", i, e, unit[e], e % 4 == 0, 1e-6);
        }
        some += count;
    }
    assert_true(some > 2 * 2500);
}

#define CROWD 300

/* One right candidate in ten, and a rotation that is known: the others vote for the translation. Where rays are parallel nothing is
 * told. */
static void a_vote_gives_the_translation(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_memory memory = unit_memory(&counter);
    synth_random random;
    int good = 0;
    synth_random_seed(&random, 21);
    for (int i = 0; i < 50; i++) {
        const motion m = random_motion(&random), other = random_motion(&random);
        static asj_pair list[CROWD];
        asj_likely_rotation rotations[2];
        asj_pairs set = {.list = list, .count = CROWD, .rotations = rotations, .rotation_count = 2};
        asj_turned turned;
        asj_model model;
        memcpy(rotations[0].matrix, other.rotation, sizeof other.rotation);
        memcpy(rotations[1].matrix, m.rotation, sizeof m.rotation);
        for (int k = 0; k < CROWD; k++) {
            const asj_pair there = random_patch(&random, &m, 0);
            list[k] = random_patch(&random, &m, 0);
            list[k].prior = 0.02;
            if (k % 10 != 0) { /* somewhere else in image 2 */
                list[k].x2 = there.x2;
                list[k].y2 = there.y2;
            }
        }
        assert_true(asj_turned_create(&memory, &set, CROWD, NULL, cameras, &turned));
        memset(&model, 0, sizeof model);
        for (int k = 0; k < CROWD; k += 10) {
            const int told = asj_translation_by_vote(&set, &turned, 1, &list[k], cameras, &model);
            good += told && asj_dot3(model.translation, m.translation) > cos(0.03);
        }
        unit_near("rotation", i, 0, model.rotation[1], m.rotation[1], 0);
        for (int k = 0; k < 3 * CROWD; k++)
            turned.normal[3 * CROWD + k] = 0;
        assert_false(asj_translation_by_vote(&set, &turned, 1, &list[0], cameras, &model));
        asj_turned_free(&memory, &turned);
    }
    assert_true(good >= 1450); /* of 1500 */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exp_and_log_are_those_of_the_library), cmocka_unit_test(singular_values_rebuild),
        cmocka_unit_test(rotations_and_their_angles), cmocka_unit_test(the_least_vector_is_an_eigenvector),
        cmocka_unit_test(systems_are_solved_or_refused), cmocka_unit_test(roots_of_products),
        cmocka_unit_test(five_points_give_the_motion), cmocka_unit_test(right_candidates_have_no_residuals),
        cmocka_unit_test(two_candidates_give_the_motion), cmocka_unit_test(three_candidates_give_the_fundamental_matrix),
        cmocka_unit_test(two_candidates_give_the_homography), cmocka_unit_test(a_homography_gives_rotations),
        cmocka_unit_test(a_homography_gives_its_motions), cmocka_unit_test(a_vote_gives_the_translation),
    };
    return cmocka_run_group_tests_name("solvers", tests, NULL, NULL);
}
