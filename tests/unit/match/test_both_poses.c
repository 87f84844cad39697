/* SPDX-License-Identifier: BSD-2-Clause */
/* One pose of two: each of its five numbers lies between those of the two, as near to either as it is known there; from either of
 * the two it is the same; and what says nothing changes nothing, bit for bit. */
#include "unit_test.h"

#include "geometry/small_matrix.h"
#include "match/both_poses.h"
#include "match/looks.h"
#include "match/pose_parameters.h"

#define NUMBERS ASJ_POSE_PARAMETERS
#define DEGREE (UNIT_PI / 180)

/* A pose `by` the five numbers from one turned by 40 degrees, each of which is known to `sd`. */
static asj_geometry pose_at(const double by[NUMBERS], const double sd[NUMBERS])
{
    static const double turn[3] = {0.1, -0.68, 0.05}, translation[3] = {0.9, -0.1, 0.42};
    asj_geometry origin_pose, pose;
    asj_pose_origin origin;
    memset(&origin_pose, 0, sizeof origin_pose);
    memset(&pose, 0, sizeof pose);
    asj_rotation_of(turn, origin_pose.rotation);
    memcpy(origin_pose.translation, translation, sizeof translation);
    asj_normalise3(origin_pose.translation);
    asj_pose_origin_of(&origin_pose, &origin);
    pose.status = ASJ_GEOMETRY_ACCEPTED;
    pose.model = ASJ_GEOMETRY_ESSENTIAL;
    pose.has_pose = 1;
    for (int v = 0; v < 2; v++)
        pose.cameras[v] = (asj_camera){520, 500, 310, 245};
    asj_pose_tell(&origin, by, &pose);
    for (int k = 0; k < 3; k++)
        pose.covariance[7 * k] = sd[k] * sd[k];
    for (int k = 0; k < 9; k++)
        pose.covariance[6 * (3 + k / 3) + 3 + k % 3] = sd[3] * sd[3] * origin.axes[0][k / 3] * origin.axes[0][k % 3] +
                                                       sd[4] * sd[4] * origin.axes[1][k / 3] * origin.axes[1][k % 3];
    return pose;
}

static void assert_at(const asj_geometry *pose, const double expected[NUMBERS], double tolerance)
{
    static const double zero[NUMBERS] = {0}, sd[NUMBERS] = {1, 1, 1, 1, 1};
    const asj_geometry from = pose_at(zero, sd);
    asj_pose_origin origin;
    double p[NUMBERS];
    asj_pose_origin_of(&from, &origin);
    asj_pose_parameters_of(&origin, pose, p);
    for (int k = 0; k < NUMBERS; k++)
        assert_true(fabs(p[k] - expected[k]) < tolerance);
}

static const double zero[NUMBERS] = {0}, away[NUMBERS] = {.010, -.020, .015, .030, -.012};

static void each_counts_as_well_as_it_is_known(void **state)
{
    static const double sd[NUMBERS] = {.010, .020, .005, .010, .010}, of_other[NUMBERS] = {.010, .010, .010, 1, .005};
    static const double expected[NUMBERS] = {.005, -.016, .003, 0, -.0096};
    (void)state;
    for (int first = 0; first < 2; first++) {
        const asj_geometry one = pose_at(zero, sd), other = pose_at(away, of_other);
        asj_geometry pose = first ? other : one;
        const asj_geometry before = pose;
        asj_both_poses(first ? &one : &other, &pose);
        assert_at(&pose, expected, 3e-4); /* turns do not quite commute, and a sphere bends: .02 squared */
        assert_memory_equal(pose.covariance, before.covariance, sizeof pose.covariance);
        assert_true(fabs(asj_dot3(pose.translation, pose.translation) - 1) < 1e-12);
        double essential[9], skew[9], x[3] = {400, 100, 1}, line[3], again[3];
        asj_skew3(pose.translation, skew); /* the matrix is that of the pose: K'^-T [t]x R K^-1, up to a factor */
        asj_multiply3(skew, pose.rotation, essential);
        const double ray[3] = {(x[0] - 310) / 520, (x[1] - 245) / 500, 1};
        asj_apply3(essential, ray, line);
        asj_apply3(pose.matrix, x, again);
        const double factor = again[0] * 520 / line[0];
        assert_true(fabs(again[1] * 500 - factor * line[1]) < 1e-9 * fabs(factor));
    }
}

static void what_is_hardly_known_hardly_counts(void **state)
{
    static const double sd[NUMBERS] = {.002, .002, .002, .002, .002}, little[NUMBERS] = {.2, .2, .2, .2, .2};
    asj_geometry pose = pose_at(zero, sd);
    const asj_geometry other = pose_at(away, little);
    (void)state;
    asj_both_poses(&other, &pose);
    assert_at(&pose, zero, 1e-5);
}

static void what_says_nothing_changes_nothing(void **state)
{
    static const double sd[NUMBERS] = {.01, .01, .01, .01, .01};
    asj_geometry pose = pose_at(zero, sd), other = pose_at(away, sd);
    const asj_geometry before = pose;
    (void)state;
    other.covariance[0] = NAN;
    asj_both_poses(&other, &pose);
    assert_memory_equal(&pose, &before, sizeof pose);
    other.covariance[0] = -1;
    asj_both_poses(&other, &pose);
    assert_memory_equal(&pose, &before, sizeof pose);
}

/* Only estimates of one motion have a mean. */
static void poses_that_agree(void **state)
{
    static const double sd[NUMBERS] = {.004, .004, .004, .004, .004}, far[NUMBERS] = {0, 10 * DEGREE, 0, 0, 0};
    const asj_geometry one = pose_at(zero, sd), near = pose_at(away, sd), distant = pose_at(far, sd);
    (void)state;
    assert_true(asj_looks_agree(&one, &near));
    assert_false(asj_looks_agree(&one, &distant));
    asj_geometry other = near;
    other.status = ASJ_GEOMETRY_DEGENERATE;
    assert_false(asj_looks_agree(&one, &other));
    other = near;
    other.has_pose = 0;
    assert_false(asj_looks_agree(&other, &one));
    other = near;
    other.focal_sd = 0.01;
    assert_false(asj_looks_agree(&one, &other));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_counts_as_well_as_it_is_known),
        cmocka_unit_test(what_is_hardly_known_hardly_counts),
        cmocka_unit_test(what_says_nothing_changes_nothing),
        cmocka_unit_test(poses_that_agree),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
