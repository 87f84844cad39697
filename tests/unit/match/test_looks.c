/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/looks.c: of two poses that contradict each other the one with which the pictures agree better is the answer, whatever
 * evidence says; where they agree alike, or nobody has looked, evidence decides as it does without. (What evidence decides:
 * test_upsampled_geometry.c.) */
#include "unit_test.h"

#include "match/looks.h"

#include <asj/asj.h>

/* A motion along x, turned by `degrees` about y, known to .3 degrees. */
static void make(asj_match_result *r, int32_t status, double log10_nfa, double degrees, double agreement)
{
    asj_geometry *g = &r->geometry;
    const double angle = degrees * 3.14159265358979323846 / 180, sd = 0.005;
    memset(r, 0, sizeof *r);
    r->match_count = 20;
    g->status = status;
    g->model = ASJ_GEOMETRY_ESSENTIAL;
    g->has_pose = 1;
    g->log10_nfa = log10_nfa;
    g->picture_agreement = agreement;
    g->picture_knowledge = agreement > 0 ? 30 : 0;
    g->rotation[0] = g->rotation[8] = cos(angle);
    g->rotation[2] = sin(angle);
    g->rotation[6] = -sin(angle);
    g->rotation[4] = g->translation[0] = 1;
    for (int k = 0; k < 6; k++)
        g->covariance[7 * k] = sd * sd;
}

static void pictures_decide_between_poses(void **state)
{
    static const struct {
        double own, upsampled, own_nfa, upsampled_nfa;
        asj_looks looks;
    } cases[] = {{.8, .5, -40, -90, ASJ_LOOKS_BY_IMAGES},  {.5, .8, -90, -40, ASJ_LOOKS_RESOLVED},
                 {.8, .7, -40, -90, ASJ_LOOKS_DISPUTED},   {.7, .8, -90, -40, ASJ_LOOKS_DISPUTED},
                 {.8, .5, -30, -90, ASJ_LOOKS_BY_IMAGES},  {.8, .7, -30, -90, ASJ_LOOKS_RESOLVED},
                 {.8, 0, -30, -90, ASJ_LOOKS_RESOLVED},     {0, .8, -40, -90, ASJ_LOOKS_DISPUTED}};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result own, upsampled;
        make(&own, ASJ_GEOMETRY_ACCEPTED, cases[k].own_nfa, 20, cases[k].own);
        make(&upsampled, ASJ_GEOMETRY_ACCEPTED, cases[k].upsampled_nfa, 0, cases[k].upsampled);
        assert_int_equal(asj_looks_of(&own, &upsampled), cases[k].looks);
        make(&own, ASJ_GEOMETRY_ACCEPTED, cases[k].own_nfa, .1, cases[k].own); /* no contradiction */
        const asj_looks same = asj_looks_of(&own, &upsampled);
        assert_true(same == ASJ_LOOKS_BY_UPSAMPLED || same == ASJ_LOOKS_BY_IMAGES);
    }
}

/* The images' pose is known to `sd`, rad, and is a few degrees from that of the upsampled ones, known to .005: where that is four
 * times as well, and there is 1.25 times the evidence, it is the answer, whatever their matches are. */
static void what_is_surer_by_far_is_taken(void **state)
{
    static const struct {
        double sd, degrees, own_nfa, upsampled_nfa;
        asj_looks looks;
    } cases[] = {{.13, 7, -72, -131, ASJ_LOOKS_RESOLVED},      {.13, 7, -72, -91, ASJ_LOOKS_RESOLVED},
                 {.13, 7, -72, -89, ASJ_LOOKS_BY_UPSAMPLED},  {.13, 3, -72, -131, ASJ_LOOKS_BY_UPSAMPLED},
                 {.003, 7, -72, -131, ASJ_LOOKS_DISPUTED},    {.13, 7, -20, -34, ASJ_LOOKS_BY_UPSAMPLED},
                 {.018, 5, -72, -131, ASJ_LOOKS_BY_UPSAMPLED}};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result own, upsampled;
        make(&own, ASJ_GEOMETRY_ACCEPTED, cases[k].own_nfa, cases[k].degrees, .6);
        for (int i = 0; i < 6; i++)
            own.geometry.covariance[7 * i] = cases[k].sd * cases[k].sd;
        make(&upsampled, ASJ_GEOMETRY_ACCEPTED, cases[k].upsampled_nfa, 0, .65);
        assert_int_equal(asj_looks_of(&own, &upsampled), cases[k].looks);
    }
}

/* Rivals of the images, which the upsampled ones or colours resolve. */
static void pictures_resolve_what_is_ambiguous(void **state)
{
    static const struct {
        double own, other, own_nfa, other_nfa, rival_nfa;
        int32_t resolved;
    } cases[] = {{.5, .8, -40, -20, -38, 1},   {.7, .8, -40, -20, -38, 0},   {.8, .5, -40, -60, -38, 0},
                 {.8, .7, -40, -60, -38, 0},   {.74, .7, -40, -60, -38, 1},  {.54, .5, -40, -60, -38, 0},
                 {0, .8, -40, -20, -38, 0},    {.5, 0, -40, -60, -38, 1},    {.5, .8, -140, -20, -130, 0},
                 {.7, .8, -140, -250, -130, 0}};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result own, other;
        make(&own, ASJ_GEOMETRY_AMBIGUOUS, cases[k].own_nfa, 20, cases[k].own);
        own.geometry.has_rival = 1;
        own.geometry.rival_log10_nfa = cases[k].rival_nfa;
        make(&other, ASJ_GEOMETRY_ACCEPTED, cases[k].other_nfa, 0, cases[k].other);
        const asj_looks looks = asj_looks_of(&own, &other);
        assert_int_equal(looks == ASJ_LOOKS_RESOLVED, cases[k].resolved);
        const int32_t repeats = cases[k].rival_nfa < -100; /* then colours are not asked */
        assert_int_equal(asj_looks_take(&own, &other), cases[k].resolved && !repeats);
        assert_int_equal(asj_looks_want_other(&own), !repeats);
    }
}

/* Upsampled images that repeat themselves, with another motion or the same one in front: twice the evidence is in doubt of what the
 * images accept, unless pictures agree better with that. */
static void rivals_with_much_evidence_are_a_dispute(void **state)
{
    static const struct {
        double own, upsampled, own_nfa, upsampled_nfa, degrees;
        asj_looks looks;
    } cases[] = {{.5, .5, -50, -101, 90, ASJ_LOOKS_DISPUTED},  {.5, .5, -50, -99, 90, ASJ_LOOKS_BY_IMAGES},
                 {.7, .5, -50, -101, 90, ASJ_LOOKS_BY_IMAGES}, {.5, .7, -50, -99, 90, ASJ_LOOKS_BY_IMAGES},
                 {.5, .5, -50, -101, 7, ASJ_LOOKS_BY_IMAGES},  {0, 0, -50, -101, 9, ASJ_LOOKS_DISPUTED}};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result own, upsampled;
        make(&own, ASJ_GEOMETRY_ACCEPTED, cases[k].own_nfa, cases[k].degrees, cases[k].own);
        make(&upsampled, ASJ_GEOMETRY_AMBIGUOUS, cases[k].upsampled_nfa, 0, cases[k].upsampled);
        assert_int_equal(asj_looks_of(&own, &upsampled), cases[k].looks);
        upsampled.geometry.status = ASJ_GEOMETRY_CHANCE;
        assert_int_equal(asj_looks_of(&own, &upsampled), ASJ_LOOKS_BY_IMAGES);
    }
}

/* .. and 1.25 times where their rival, by so many degrees, is another motion than what the images accept, too. */
static void rivals_of_which_none_is_accepted_are_a_dispute(void **state)
{
    static const struct {
        double upsampled_nfa, degrees;
        asj_looks looks;
    } cases[] = {{-64, 45, ASJ_LOOKS_DISPUTED}, {-62, 45, ASJ_LOOKS_BY_IMAGES}, {-99, 91, ASJ_LOOKS_BY_IMAGES}};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result own, upsampled, rival;
        make(&own, ASJ_GEOMETRY_ACCEPTED, -50, 90, .5);
        make(&upsampled, ASJ_GEOMETRY_AMBIGUOUS, cases[k].upsampled_nfa, 0, .5);
        make(&rival, ASJ_GEOMETRY_ACCEPTED, -20, cases[k].degrees, .5);
        upsampled.geometry.has_rival = 1;
        memcpy(upsampled.geometry.rival_rotation, rival.geometry.rotation, sizeof rival.geometry.rotation);
        memcpy(upsampled.geometry.rival_translation, rival.geometry.translation, sizeof rival.geometry.translation);
        assert_int_equal(asj_looks_of(&own, &upsampled), cases[k].looks);
    }
}

/* What is surely accepted is looked at once more where the pictures hardly agree with it, and so much is not believed then. */
static void little_agreement_is_looked_at_again(void **state)
{
    static const struct {
        double own, other, own_nfa;
        int32_t may_close, closes;
    } cases[] = {{.8, .9, -60, 0, 0}, {.45, .9, -60, 1, 1}, {.45, .55, -60, 1, 0}, {0, .9, -60, 0, 0}, {.8, .9, -20, 1, 0},
                 {.7, .9, -20, 1, 1}};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result own, other;
        make(&own, ASJ_GEOMETRY_ACCEPTED, cases[k].own_nfa, 20, cases[k].own);
        make(&other, ASJ_GEOMETRY_ACCEPTED, -22, 0, cases[k].other);
        assert_int_equal(asj_looks_want_other(&own), cases[k].may_close);
        assert_int_equal(asj_looks_take(&own, &other), cases[k].closes);
        make(&own, ASJ_GEOMETRY_ACCEPTED, cases[k].own_nfa, 1, cases[k].own); /* the same motion: the surer one */
        assert_int_equal(asj_looks_take(&own, &other), 0);
    }
}

/* Of one motion, what colours know better and from much more evidence is the answer. */
static void surer_poses_of_colours_are_taken(void **state)
{
    static const struct {
        double own_degrees, own_sd, other_sd, other_nfa;
        int32_t closes;
    } cases[] = {{1, 1, 0.5, -26, 1}, {1, 0.5, 1, -26, 0}, {1, 1, 0.5, -24, 0}, {2.9, 0.4, 0.3, -26, 1}, {3.1, 0.4, 0.3, -26, 0}};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result own, other;
        make(&own, ASJ_GEOMETRY_ACCEPTED, -20, cases[k].own_degrees, .7);
        make(&other, ASJ_GEOMETRY_ACCEPTED, cases[k].other_nfa, 0, .7);
        for (int i = 0; i < 6; i++) {
            own.geometry.covariance[7 * i] *= cases[k].own_sd * cases[k].own_sd;
            other.geometry.covariance[7 * i] *= cases[k].other_sd * cases[k].other_sd;
        }
        assert_int_equal(asj_looks_take(&own, &other), cases[k].closes);
        own.geometry.has_pose = 0;
        own.geometry.only_turns = 1;
        assert_int_equal(asj_looks_take(&own, &other), 0);
    }
}

/* Pictures that know little are not believed to agree better. */
static void little_knowledge_decides_nothing(void **state)
{
    asj_match_result own, upsampled;
    (void)state;
    for (int32_t which = 0; which < 2; which++) {
        make(&own, ASJ_GEOMETRY_ACCEPTED, -90, 20, .4);
        make(&upsampled, ASJ_GEOMETRY_ACCEPTED, -40, 0, .8);
        assert_int_equal(asj_looks_of(&own, &upsampled), ASJ_LOOKS_RESOLVED);
        (which ? &own : &upsampled)->geometry.picture_knowledge = 14;
        assert_int_equal(asj_looks_of(&own, &upsampled), ASJ_LOOKS_DISPUTED);
    }
}

/* A focal length that the images have found, and upsampled ones with twice the evidence leave open, is none; one that was given
 * is. */
static void focal_lengths_of_little_evidence_are_lost(void **state)
{
    static const struct {
        double focal_sd, upsampled_nfa;
        int32_t status;
        asj_looks looks;
    } cases[] = {{.02, -133, ASJ_GEOMETRY_ACCEPTED, ASJ_LOOKS_BY_UPSAMPLED},
                 {.02, -131, ASJ_GEOMETRY_ACCEPTED, ASJ_LOOKS_BY_IMAGES},
                 {0, -133, ASJ_GEOMETRY_ACCEPTED, ASJ_LOOKS_BY_IMAGES},
                 {.02, -133, ASJ_GEOMETRY_CHANCE, ASJ_LOOKS_BY_IMAGES}};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result own, upsampled;
        make(&own, ASJ_GEOMETRY_ACCEPTED, -66, 20, .6);
        own.geometry.focal_sd = cases[k].focal_sd;
        make(&upsampled, cases[k].status, cases[k].upsampled_nfa, 0, .6);
        upsampled.geometry.model = ASJ_GEOMETRY_FUNDAMENTAL;
        upsampled.geometry.has_pose = 0;
        assert_int_equal(asj_looks_of(&own, &upsampled), cases[k].looks);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(focal_lengths_of_little_evidence_are_lost),
        cmocka_unit_test(pictures_decide_between_poses),
        cmocka_unit_test(what_is_surer_by_far_is_taken),
        cmocka_unit_test(pictures_resolve_what_is_ambiguous),
        cmocka_unit_test(rivals_with_much_evidence_are_a_dispute),
        cmocka_unit_test(rivals_of_which_none_is_accepted_are_a_dispute),
        cmocka_unit_test(little_agreement_is_looked_at_again),
        cmocka_unit_test(surer_poses_of_colours_are_taken),
        cmocka_unit_test(little_knowledge_decides_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
