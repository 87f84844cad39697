/* SPDX-License-Identifier: BSD-2-Clause */
/* Two motions that cannot both be right and whose matches contradict each other in nothing: pictures say which one it is, or
 * the way that is up, or it stays open. */
#include "unit_test.h"
#include "tiled_wall.h"

#include "core/angle.h"
#include "geometry/ambiguity.h"
#include "geometry/contradiction.h"
#include "geometry/manhattan.h"
#include "geometry/strike_out.h"

enum { RIGHT_ONE, WRONG_ONE, TWIN };

/* An estimation that has found both motions. */
static asj_estimation *prepare(asj_context *context, int32_t channels, int32_t contrast, asj_geometry_options *options)
{
    asj_estimation *e = create_tiled(context, TILED_SHIFTED, channels, contrast, options);
    e->finalists[RIGHT_ONE] = right_motion(120);
    e->finalists[WRONG_ONE] = wrong_motion(TILED_SHIFTED, 130);
    e->count = 2;
    return e;
}

static asj_comparison compare(asj_estimation *e, int32_t first, int32_t other)
{
    asj_compare_from(e, first);
    return asj_compare_with(e, &e->finalists[other]);
}

/* In colours that know something, of two motions that are far apart. */
static void test_pictures_prefer_the_right_motion(void **state)
{
    static const struct {
        int32_t channels, contrast, prefers;
    } cases[] = {{3, 100, 1}, {3, 0, 0}, {1, 100, 0}, {0, 100, 0}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_geometry_options options;
        int32_t doubt = 0;
        asj_estimation *e = prepare(context, cases[k].channels, cases[k].contrast, &options);
        const asj_comparison from_wrong = compare(e, WRONG_ONE, RIGHT_ONE);
        const asj_agreement right = *asj_agreement_of_other(e);
        print_message("%d channels, contrast %d: agreement %.2f of %.0f nats and %.2f of %.0f, contrary %.2f, preference %.1f\n",
                      (int)cases[k].channels, (int)cases[k].contrast, e->first.agreement.share, e->first.agreement.known,
                      right.share, right.known, from_wrong.contrary, from_wrong.preference);
        assert_true(from_wrong.contrary < 0.01);
        assert_int_equal(from_wrong.preference > 0, cases[k].prefers);
        assert_int_equal(asj_strongest_rival(e, WRONG_ONE, &doubt), cases[k].prefers ? RIGHT_ONE : -1);
        assert_int_equal(asj_strongest_rival(e, RIGHT_ONE, &doubt), -1);
        const asj_comparison from_right = compare(e, RIGHT_ONE, WRONG_ONE);
        assert_true(from_right.preference == -from_wrong.preference);
        release_estimation(context, e);
    }
}

/* Motions that are near each other do not exclude each other: which planes they have is all that pictures tell. */
static void test_only_motions_far_apart_exclude_each_other(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_geometry_options options;
    asj_estimation *e = prepare(context, 3, 100, &options);
    const asj_model wrong = e->finalists[WRONG_ONE];
    for (int32_t degrees = 5; degrees <= 175; degrees += 10) {
        const double turn = degrees * ASJ_DEGREE;
        e->finalists[WRONG_ONE] = wrong;
        e->finalists[WRONG_ONE].translation[0] = cos(turn);
        e->finalists[WRONG_ONE].translation[1] = sin(turn);
        assert_int_equal(compare(e, WRONG_ONE, RIGHT_ONE).preference > 0, degrees > 15);
    }
    release_estimation(context, e);
}

/* What has less than half of the evidence is not preferred, whatever pictures say. */
static void test_much_evidence_is_not_outweighed(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_geometry_options options;
    asj_estimation *e = prepare(context, 3, 100, &options);
    e->finalists[WRONG_ONE].evidence = 239;
    assert_true(compare(e, WRONG_ONE, RIGHT_ONE).preference > 0);
    e->finalists[WRONG_ONE].evidence = 241;
    assert_true(compare(e, WRONG_ONE, RIGHT_ONE).preference == 0);
    release_estimation(context, e);
}

/* The wrong one has a little more evidence, the right one is there twice: the one that is followed is the answer. */
static void test_preferred_motion_is_the_answer(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_geometry_options options;
    asj_estimation *e = prepare(context, 3, 100, &options);
    e->finalists[TWIN] = right_motion(1e6);
    e->finalists[TWIN].evidence = 121;
    e->count = 3;
    assert_int_equal(asj_strike_out(e), ASJ_OK);
    const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_AUTO);
    assert_true(best == RIGHT_ONE || best == TWIN);
    assert_true(e->finalists[best].settled);
    assert_int_equal(e->finalists[WRONG_ONE].struck != ASJ_NOT_STRUCK, 1);
    release_estimation(context, e);
}

/* The wrong one turns the wall by a quarter. */
static asj_estimation *prepare_turned(asj_context *context, int32_t channels, double right, double wrong,
                                      asj_geometry_options *options)
{
    asj_estimation *e = create_tiled(context, TILED_TURNED, channels, 10, options);
    e->finalists[RIGHT_ONE] = right_motion(right);
    e->finalists[WRONG_ONE] = wrong_motion(TILED_TURNED, wrong);
    e->count = 2;
    return e;
}

/* .. and both images stand upright. */
static asj_estimation *prepare_upright(asj_context *context, int32_t channels, double wrong, asj_geometry_options *options)
{
    asj_estimation *e = prepare_turned(context, channels, 1000, wrong, options);
    e->set.has_down = 1;
    e->set.down[0][1] = e->set.down[1][1] = 1;
    return e;
}

static void test_upright_motion_makes_doubtful(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_geometry_options options;
    int32_t doubt = 0;
    for (int32_t more = 0; more < 2; more++) {
        asj_estimation *e = prepare_upright(context, 0, more ? 1410 : 1390, &options);
        assert_int_equal(asj_is_upright_instead(e, WRONG_ONE, RIGHT_ONE), !more);
        assert_int_equal(asj_is_upright_instead(e, RIGHT_ONE, WRONG_ONE), 0);
        assert_int_equal(asj_strongest_rival(e, WRONG_ONE, &doubt), more ? -1 : RIGHT_ONE);
        e->set.has_down = 0;
        assert_int_equal(asj_is_upright_instead(e, WRONG_ONE, RIGHT_ONE), 0);
        release_estimation(context, e);
    }
}

/* Pictures prefer it by less than it lacks of evidence. */
static void test_upright_motion_is_the_answer(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    for (int32_t upright = 0; upright < 2; upright++) {
        asj_geometry_options options;
        asj_estimation *e = prepare_upright(context, 3, 1390, &options);
        e->set.has_down = upright;
        assert_int_equal(asj_strike_out(e), ASJ_OK);
        assert_int_equal(e->finalists[WRONG_ONE].struck != ASJ_NOT_STRUCK, upright);
        release_estimation(context, e);
    }
}

/* Two motions with matches of their own, and the rotation of both is likely. */
static void test_other_witness_makes_doubtful(void **state)
{
    static const double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (int32_t directions = 0; directions < 2; directions++) {
        asj_geometry_options options;
        asj_directions_list list[2];
        int32_t doubt = 0;
        asj_estimation *e = prepare_turned(context, 0, 120, 130, &options);
        for (int32_t v = 0; v < 2; v++)
            asj_directions_given(axes, &list[v]);
        if (directions)
            assert_true(asj_manhattan_rotations(&context->memory, list, &e->set));
        e->set.has_down = 0;
        assert_int_equal(asj_strongest_rival(e, WRONG_ONE, &doubt), directions ? RIGHT_ONE : -1);
        e->finalists[RIGHT_ONE].evidence = 70;
        assert_int_equal(asj_strongest_rival(e, WRONG_ONE, &doubt), -1);
        release_estimation(context, e);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures_prefer_the_right_motion),
        cmocka_unit_test(test_only_motions_far_apart_exclude_each_other),
        cmocka_unit_test(test_much_evidence_is_not_outweighed),
        cmocka_unit_test(test_preferred_motion_is_the_answer),
        cmocka_unit_test(test_upright_motion_makes_doubtful),
        cmocka_unit_test(test_upright_motion_is_the_answer),
        cmocka_unit_test(test_other_witness_makes_doubtful),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
