/* SPDX-License-Identifier: BSD-2-Clause */
/* Which directions of a room the branches of corners point along, and which way they go: corners that two cameras see have the same
 * labels under the true rotation, whatever the sets call their directions, and corners of one image with others' branches in the
 * other one say nothing for it. */
#include "unit_test.h"

#include "geometry/labels.h"
#include "geometry/manhattan.h"
#include "geometry/small_matrix.h"

#define RIGHT 12
#define WRONG 60
#define COUNT (RIGHT + WRONG)
#define DEGREE (UNIT_PI / 180)
#define BOTH_AGREE 5.0 /* as labels.c */
#define BOTH_DIFFER 0.02

static const asj_camera cameras[2] = {{560, 560, 319.5, 239.5}, {610, 590, 300.5, 250.5}};

/* Image 2 sees x2 ~ R x1 + t; the set of image 1 calls its directions as they are, that of image 2 otherwise. */
typedef struct scene {
    double rotation[9], translation[3];
    asj_directions_list directions[2];
    asj_pair list[COUNT];
    double branches[ASJ_BRANCH_NUMBERS * COUNT];
    uint8_t label[COUNT][2]; /* of the branches in image 1 */
    asj_pairs set;
    unit_counter counter;
    asj_memory memory;
} scene;

static void project(const scene *s, int view, const double point[3], double pixel[2])
{
    double q[3];
    memcpy(q, point, sizeof q);
    if (view == 1) {
        asj_apply3(s->rotation, point, q);
        for (int k = 0; k < 3; k++)
            q[k] += s->translation[k];
    }
    pixel[0] = cameras[view].cx + cameras[view].fx * q[0] / q[2];
    pixel[1] = cameras[view].cy + cameras[view].fy * q[1] / q[2];
}

/* A corner in one image: where it is, and the unit vectors of two branches along directions of the room or against them. */
static void see(const scene *s, int view, const double point[3], const int axis[2], const int sign[2], double at[2],
                double branch[4])
{
    project(s, view, point, at);
    for (int b = 0; b < 2; b++) {
        double end[3], pixel[2];
        for (int k = 0; k < 3; k++)
            end[k] = point[k] + 1e-6 * sign[b] * s->directions[0].list[0].axes[3 * axis[b] + k];
        project(s, view, end, pixel);
        const double x = pixel[0] - at[0], y = pixel[1] - at[1], length = hypot(x, y);
        branch[2 * b] = x / length;
        branch[2 * b + 1] = y / length;
    }
}

static void any_corner(synth_random *random, double point[3], int axis[2], int sign[2])
{
    point[2] = synth_random_between(random, 3, 6);
    point[0] = point[2] * synth_random_between(random, -0.4, 0.4);
    point[1] = point[2] * synth_random_between(random, -0.3, 0.3);
    axis[0] = (int)synth_random_between(random, 0, 2.999);
    axis[1] = (axis[0] + 1 + (int)synth_random_between(random, 0, 1.999)) % 3;
    for (int b = 0; b < 2; b++)
        sign[b] = synth_random_between(random, -1, 1) < 0 ? -1 : 1;
}

/* D2' = R D1', the rows in another order, one of them the other way. */
static void name_otherwise(const double first[9], const double rotation[9], double second[9])
{
    for (int k = 0; k < 9; k++)
        second[k] = (k / 3 == 1 ? -1 : 1) * asj_dot3(rotation + 3 * (k % 3), first + 3 * ((k / 3 + 1) % 3));
}

/* The first RIGHT candidates are corners that both images see; of the others image 2 sees another corner. */
static void make(scene *s, uint64_t seed)
{
    const double of_room[3] = {0.3, 0.5, 0.1}, turn[3] = {0.1, 0.6, -0.05}, translation[3] = {-0.8, 0.1, 0.3};
    synth_random random;
    synth_random_seed(&random, seed);
    memset(s, 0, sizeof *s);
    s->memory = unit_memory(&s->counter);
    asj_directions sets[2] = {{.score = 0}};
    asj_rotation_of(of_room, sets[0].axes);
    asj_rotation_of(turn, s->rotation);
    memcpy(s->translation, translation, sizeof translation);
    name_otherwise(sets[0].axes, s->rotation, sets[1].axes);
    for (int v = 0; v < 2; v++) {
        for (int k = 0; k < 3; k++)
            sets[v].covariance[4 * k] = 1e-5;
        asj_directions_add(&s->directions[v], &sets[v]);
    }
    for (uint32_t k = 0; k < COUNT; k++) {
        double point[3], at[2][2];
        int axis[2], sign[2];
        any_corner(&random, point, axis, sign);
        see(s, 0, point, axis, sign, at[0], s->branches + ASJ_BRANCH_NUMBERS * k);
        for (int b = 0; b < 2; b++)
            s->label[k][b] = (uint8_t)ASJ_LABEL(axis[b], sign[b] < 0);
        if (k >= RIGHT)
            any_corner(&random, point, axis, sign);
        see(s, 1, point, axis, sign, at[1], s->branches + ASJ_BRANCH_NUMBERS * k + 4);
        s->list[k] = (asj_pair){.x1 = at[0][0], .y1 = at[0][1], .x2 = at[1][0], .y2 = at[1][1], .prior = 0.2,
                                .place1 = k, .place2 = k, .source = k};
    }
    s->set = (asj_pairs){.list = s->list, .count = COUNT, .place_count = {COUNT, COUNT}};
    asj_set_labels(&s->set, s->branches, s->directions, cameras);
    assert_true(asj_manhattan_rotations(&s->memory, s->directions, &s->set));
    assert_int_equal(s->set.rotation_count, 24);
}

/* A rotation takes each direction, with its sign, to the one that it is called. */
static void names_are_what_rotations_do(void **state)
{
    (void)state;
    scene s;
    make(&s, 3);
    for (int r = 0; r < s.set.rotation_count; r++)
        for (int axis = 0; axis < 3; axis++)
            for (int backward = 0; backward < 2; backward++) {
                const asj_likely_rotation *rotation = &s.set.rotations[r];
                const int name = rotation->name[ASJ_LABEL(axis, backward)] - ASJ_LABEL(0, 0);
                double turned[3];
                assert_in_range(name, 0, 5);
                asj_apply3(rotation->matrix, s.directions[0].list[0].axes + 3 * axis, turned);
                const double along = asj_dot3(turned, s.directions[1].list[0].axes + 3 * (name / 2));
                unit_near("direction", r, ASJ_LABEL(axis, backward), along, backward == name % 2 ? 1 : -1, 1e-9);
            }
    asj_release(&s.memory, s.set.rotations);
    assert_int_equal(s.counter.live, 0);
}

static void labels_tell_the_rotation(void **state)
{
    (void)state;
    scene s;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        double w[3], sum = 0;
        make(&s, seed);
        assert_true(s.set.has_labels);
        assert_true(asj_order_rotations(&s.memory, &s.set));
        assert_int_equal(asj_nearest_rotation(&s.set, s.rotation, w), 0);
        for (int k = 0; k < COUNT; k++)
            assert_memory_equal(s.list[k].label[0][0], s.label[k], sizeof s.label[k]);
        for (int k = 0; k < RIGHT; k++)
            unit_near("right candidate", (int)seed, k, asj_label_ratio(&s.set.rotations[0], &s.list[k]), BOTH_AGREE, 0);
        for (int k = RIGHT; k < COUNT; k++)
            sum += asj_label_ratio(&s.set.rotations[0], &s.list[k]);
        assert_true(sum < WRONG); /* what is wrong is no likelier for it */
        asj_release(&s.memory, s.set.rotations);
        assert_int_equal(s.counter.live, 0);
    }
}

/* Branches that go the other way in image 2 are others; those along no direction say nothing. */
static void the_other_way_differs(void **state)
{
    (void)state;
    scene s;
    make(&s, 7);
    assert_true(asj_order_rotations(&s.memory, &s.set));
    for (size_t k = 0; k < RIGHT; k++)
        for (size_t n = 4; n < ASJ_BRANCH_NUMBERS; n++)
            s.branches[ASJ_BRANCH_NUMBERS * k + n] *= -1;
    asj_set_labels(&s.set, s.branches, s.directions, cameras);
    for (int k = 0; k < RIGHT; k++)
        unit_near("the other way", 0, k, asj_label_ratio(&s.set.rotations[0], &s.list[k]), BOTH_DIFFER, 0);
    for (size_t k = 0; k < RIGHT; k++)
        for (size_t n = 0; n < 4; n++) /* along none */
            s.branches[ASJ_BRANCH_NUMBERS * k + n] = 0;
    asj_set_labels(&s.set, s.branches, s.directions, cameras);
    for (int k = 0; k < RIGHT; k++)
        unit_near("no label", 0, k, asj_label_ratio(&s.set.rotations[0], &s.list[k]), 1, 0);
    asj_release(&s.memory, s.set.rotations);
    assert_int_equal(s.counter.live, 0);
}

static void motions_near_a_rotation_have_it(void **state)
{
    (void)state;
    scene s;
    make(&s, 9);
    assert_true(asj_order_rotations(&s.memory, &s.set));
    for (int degrees = 0; degrees < 45; degrees++) {
        const double w[3] = {0, (degrees + 0.5) * DEGREE, 0};
        double turn[9], turned[9];
        asj_rotation_of(w, turn);
        asj_multiply3(turn, s.rotation, turned);
        const asj_likely_rotation *named = asj_named_rotation(&s.set, turned);
        assert_true(named == (degrees < 4 ? &s.set.rotations[0] : NULL));
    }
    s.counter.fail_at = s.counter.calls + 1;
    assert_false(asj_order_rotations(&s.memory, &s.set));
    s.counter.fail_at = 0;
    asj_release(&s.memory, s.set.rotations);
    assert_int_equal(s.counter.live, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(names_are_what_rotations_do), cmocka_unit_test(labels_tell_the_rotation),
        cmocka_unit_test(the_other_way_differs), cmocka_unit_test(motions_near_a_rotation_have_it),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
