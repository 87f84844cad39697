/* SPDX-License-Identifier: BSD-2-Clause */
/* What the images leave open, or have rivals for: what the upsampled ones resolve of it, and what they do not. */
#include "upsampled_results.h"

/* The images have rivals, and none of their matches comes again: the upsampled images' motion is the answer when it is the images'
 * best or that one's rival, or has much more evidence, and otherwise not. */
static void rivals_are_confirmed(void **state)
{
    static const struct {
        double degrees, rival; /* that the images' best, and its rival, are off; rival > 180: it has no motion */
        double upsampled, own; /* log10 NFA */
        int32_t accepted;
    } cases[] = {{1, 200, -40, -40, 1}, {30, 200, -40, -33, 0}, {30, 200, -40, -31, 1}, {30, 200, -34, -17, 0},
                 {30, 3, -40, -40, 1},  {30, 5, -40, -40, 0},   {30, 30, -40, -40, 0}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
        const uint32_t own_count = own->l_junction_count1, upsampled_count = upsampled->l_junction_count1;
        move_along_lines(own);
        leave_open(own, ASJ_GEOMETRY_AMBIGUOUS);
        memset(own->geometry.rival_rotation, 0, sizeof own->geometry.rival_rotation);
        memset(own->geometry.rival_translation, 0, sizeof own->geometry.rival_translation);
        if (cases[k].rival <= 180)
            set_rival(own, &upsampled->geometry, cases[k].rival);
        own->geometry.has_rival = 1;
        own->geometry.rival_log10_nfa = 0.9 * cases[k].own;
        change_pose(own, cases[k].degrees, 1);
        own->geometry.log10_nfa = cases[k].own;
        upsampled->geometry.log10_nfa = cases[k].upsampled;
        assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
        assert_int_equal(own->geometry.status, cases[k].accepted ? ASJ_GEOMETRY_ACCEPTED : ASJ_GEOMETRY_AMBIGUOUS);
        assert_true(cases[k].accepted ? own->l_junction_count1 >= upsampled_count : own->l_junction_count1 == own_count);
        asj_match_result_free(&own);
    }
}

/* Images without any match: only their own best motion, or its rival, or much more evidence is believed, and matches alone are
 * not. */
static void without_matches_a_motion_is_resolved(void **state)
{
    static const struct {
        int32_t status; /* of the upsampled images */
        double log10_nfa, degrees, rival; /* that the images' best, and its rival, are off */
        asj_looks looks;
    } cases[] = {{ASJ_GEOMETRY_ACCEPTED, -40, 30, 30, ASJ_LOOKS_RESOLVED}, {ASJ_GEOMETRY_ACCEPTED, -34, 30, 30, ASJ_LOOKS_LOST},
                 {ASJ_GEOMETRY_ACCEPTED, -12, 1, 30, ASJ_LOOKS_RESOLVED},  {ASJ_GEOMETRY_ACCEPTED, -12, 30, 1, ASJ_LOOKS_RESOLVED},
                 {ASJ_GEOMETRY_AMBIGUOUS, -40, 1, 1, ASJ_LOOKS_LOST},     {ASJ_GEOMETRY_CHANCE, 0, 1, 1, ASJ_LOOKS_LOST}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
        const uint32_t count = own->match_count;
        leave_open(own, ASJ_GEOMETRY_AMBIGUOUS);
        change_pose(own, cases[k].degrees, 1);
        set_rival(own, &upsampled->geometry, cases[k].rival);
        own->geometry.has_rival = 1;
        own->match_count = 0;
        own->geometry.log10_nfa = own->geometry.rival_log10_nfa = -10;
        upsampled->geometry.status = cases[k].status;
        upsampled->geometry.log10_nfa = cases[k].log10_nfa;
        assert_int_equal(asj_looks_of(own, upsampled), cases[k].looks);
        own->geometry.model = ASJ_GEOMETRY_HOMOGRAPHY; /* no motion that could be resolved so */
        assert_int_equal(asj_looks_of(own, upsampled), ASJ_LOOKS_BY_UPSAMPLED);
        own->match_count = count;
        asj_match_result_free(&own);
        asj_match_result_free(&upsampled);
    }
}

/* A motion that is open says how far: what the upsampled images accept contradicts it or does not. Without a focal length it says
 * nothing. */
static void an_open_motion_is_found(void **state)
{
    static const struct {
        double sd, log10_nfa; /* times the standard deviation; of the images, where the upsampled ones have -100 */
        asj_looks looks;
    } cases[] = {{1, -90, ASJ_LOOKS_LOST}, {1000, -90, ASJ_LOOKS_BY_UPSAMPLED}, {0, -90, ASJ_LOOKS_BY_UPSAMPLED},
                 {1, -70, ASJ_LOOKS_RESOLVED}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
        leave_open(own, ASJ_GEOMETRY_DEGENERATE);
        change_pose(own, 10, cases[k].sd);
        own->geometry.log10_nfa = cases[k].log10_nfa;
        upsampled->geometry.log10_nfa = -100;
        if (cases[k].sd == 0)
            memset(own->geometry.rotation, 0, sizeof own->geometry.rotation);
        assert_int_equal(asj_looks_of(own, upsampled), cases[k].looks);
        assert_int_equal(asj_looks_take(own, upsampled), cases[k].looks != ASJ_LOOKS_LOST);
        own->geometry.only_turns = 1;
        assert_int_equal(asj_looks_take(own, upsampled), 0);
        own->geometry.only_turns = 0;
        upsampled->geometry.has_pose = 0;
        assert_int_equal(asj_looks_take(own, upsampled), 0);
        upsampled->geometry.has_pose = 1;
        upsampled->geometry.status = ASJ_GEOMETRY_CHANCE;
        assert_int_equal(asj_looks_take(own, upsampled), 0);
        asj_match_result_free(&own);
        asj_match_result_free(&upsampled);
    }
}

/* What a look of another kind, with colours, may answer: the status of the images, whether they have a pose, a rival, and what that
 * look's motion is off them. */
static void another_look_answers_what_is_open(void **state)
{
    static const struct {
        int32_t status, has_pose;
        double rival_log10_nfa, degrees, rival_degrees, log10_nfa; /* the last: of the other look, where the images have -30 */
        int32_t may, closes;
    } cases[] = {{ASJ_GEOMETRY_CHANCE, 0, 0, 30, 30, -10, 1, 1},       {ASJ_GEOMETRY_ACCEPTED, 1, 0, 1, 30, -37, 1, 0},
                 {ASJ_GEOMETRY_ACCEPTED, 1, 0, 1, 30, -38, 1, 1},      {ASJ_GEOMETRY_ACCEPTED, 1, 0, 30, 30, -38, 1, 1},
                 {ASJ_GEOMETRY_TOO_FEW, 0, 0, 30, 30, -10, 1, 1},      {ASJ_GEOMETRY_ACCEPTED, 0, 0, 1, 30, -10, 1, 1},
                 {ASJ_GEOMETRY_ACCEPTED, 0, 0, 30, 30, -10, 1, 0},     {ASJ_GEOMETRY_ACCEPTED, 0, 0, 30, 30, -50, 1, 1},
                 {ASJ_GEOMETRY_AMBIGUOUS, 0, -20, 1, 30, -10, 1, 1},   {ASJ_GEOMETRY_AMBIGUOUS, 0, -20, 30, 1, -10, 1, 1},
                 {ASJ_GEOMETRY_AMBIGUOUS, 0, -20, 30, 30, -30, 1, 0},  {ASJ_GEOMETRY_AMBIGUOUS, 0, -20, 30, 30, -50, 1, 1},
                 {ASJ_GEOMETRY_AMBIGUOUS, 0, -101, 1, 30, -300, 0, 0}, {ASJ_GEOMETRY_NOT_ASKED, 0, 0, 1, 1, -50, 0, 0}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result *own = match(context, 0, 1), *coloured = match(context, 1, 1);
        set_rival(own, &coloured->geometry, cases[k].rival_degrees);
        change_pose(own, cases[k].degrees, 1);
        own->geometry.status = cases[k].status;
        own->geometry.has_pose = cases[k].has_pose;
        own->geometry.has_rival = cases[k].rival_log10_nfa < 0;
        own->geometry.rival_log10_nfa = cases[k].rival_log10_nfa;
        own->geometry.log10_nfa = -30;
        coloured->geometry.log10_nfa = cases[k].log10_nfa;
        coloured->geometry.has_pose = own->geometry.status != ASJ_GEOMETRY_CHANCE && own->geometry.status != ASJ_GEOMETRY_TOO_FEW;
        assert_int_equal(asj_looks_want_other(own), cases[k].may);
        assert_int_equal(asj_looks_take(own, coloured), cases[k].closes);
        own->geometry.log10_nfa = -36; /* a pose that is sure */
        assert_true(!cases[k].has_pose || !asj_looks_want_other(own));
        coloured->geometry.status = ASJ_GEOMETRY_AMBIGUOUS;
        assert_int_equal(asj_looks_take(own, coloured), 0);
        asj_match_result_free(&own);
        asj_match_result_free(&coloured);
    }
}

/* Frames match themselves upside down in either look: both telling one such motion resolves nothing, an upright one is found. */
static void what_turns_over_resolves_nothing(void **state)
{
    static const int32_t open[] = {ASJ_GEOMETRY_DEGENERATE, ASJ_GEOMETRY_AMBIGUOUS};
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
    own->geometry = upsampled->geometry;
    for (size_t k = 0; k < UNIT_COUNT(open); k++) {
        own->geometry.status = open[k];
        assert_int_equal(asj_looks_of(own, upsampled), ASJ_LOOKS_RESOLVED);
        change_pose(own, 180, 1);
        change_pose(upsampled, 180, 1);
        assert_int_equal(asj_looks_of(own, upsampled), ASJ_LOOKS_LOST);
        assert_int_equal(asj_looks_take(own, upsampled), 0);
        change_pose(own, 180, 1);
        change_pose(upsampled, 180, 1);
    }
    asj_match_result_free(&own);
    asj_match_result_free(&upsampled);
}

/* Images with a rival that is no chance by itself repeat themselves: the upsampled ones must have twice as much evidence. */
static void what_repeats_is_not_resolved(void **state)
{
    static const int32_t models[] = {ASJ_GEOMETRY_ESSENTIAL, ASJ_GEOMETRY_FUNDAMENTAL, ASJ_GEOMETRY_HOMOGRAPHY};
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
    own->geometry = upsampled->geometry;
    own->geometry.status = ASJ_GEOMETRY_AMBIGUOUS;
    own->geometry.has_rival = 1;
    own->geometry.log10_nfa = -130;
    for (size_t k = 0; k < UNIT_COUNT(models); k++) {
        own->geometry.model = models[k];
        upsampled->geometry.log10_nfa = -255;
        own->geometry.rival_log10_nfa = -99;
        assert_int_not_equal(asj_looks_of(own, upsampled), ASJ_LOOKS_LOST);
        own->geometry.rival_log10_nfa = -101;
        upsampled->geometry.log10_nfa = -265;
        assert_int_not_equal(asj_looks_of(own, upsampled), ASJ_LOOKS_LOST);
        upsampled->geometry.log10_nfa = -255;
        assert_int_equal(asj_looks_of(own, upsampled), ASJ_LOOKS_LOST);
    }
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 1), ASJ_OK);
    assert_int_equal(own->geometry.status, ASJ_GEOMETRY_AMBIGUOUS);
    asj_match_result_free(&own);
}

/* What tells no motion is no answer where the images leave open which motion it is. */
static void a_plane_decides_no_motion(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
    const uint32_t own_count = own->l_junction_count1;
    leave_open(own, ASJ_GEOMETRY_DEGENERATE);
    upsampled->geometry.has_pose = 0;
    upsampled->geometry.model = ASJ_GEOMETRY_HOMOGRAPHY;
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
    assert_int_equal(own->geometry.status, ASJ_GEOMETRY_DEGENERATE);
    assert_int_equal(own->l_junction_count1, own_count);
    asj_match_result_free(&own);
}

/* The upsampled images were not asked: what the images say stays, also when it is nothing. */
static void chance_stays_chance(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 0), *upsampled = match(context, 1, 0);
    const uint32_t first = upsampled->l_junction_count1;
    own->geometry.status = ASJ_GEOMETRY_CHANCE;
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
    assert_true(own->l_junction_count1 >= first);
    assert_int_equal(own->geometry.status, ASJ_GEOMETRY_CHANCE);
    asj_match_result_free(&own);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rivals_are_confirmed),
        cmocka_unit_test(without_matches_a_motion_is_resolved),
        cmocka_unit_test(an_open_motion_is_found),
        cmocka_unit_test(another_look_answers_what_is_open),
        cmocka_unit_test(what_turns_over_resolves_nothing),
        cmocka_unit_test(what_repeats_is_not_resolved),
        cmocka_unit_test(a_plane_decides_no_motion),
        cmocka_unit_test(chance_stays_chance),
    };
    return cmocka_run_group_tests(tests, find_all, free_all);
}
