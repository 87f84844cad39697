/* SPDX-License-Identifier: BSD-2-Clause */
/* The matches of two images and those of the upsampled ones under one geometry, whichever of them has it. */
#include "upsampled_results.h"

static int is_at(const asj_junction_match *a, const asj_junction_match *b, float tolerance)
{
    return fabsf(a->x1 - b->x1) <= tolerance && fabsf(a->y1 - b->y1) <= tolerance && fabsf(a->x2 - b->x2) <= tolerance &&
           fabsf(a->y2 - b->y2) <= tolerance;
}

static uint32_t times_in(const asj_junction_match *list, size_t count, const asj_junction_match *m, float tolerance)
{
    uint32_t times = 0;
    for (size_t k = 0; k < count; k++)
        times += (uint32_t)is_at(&list[k], m, tolerance);
    return times;
}

static void assert_list(const asj_match_result *r, const asj_junction_match *list, size_t count)
{
    for (size_t k = 0; k < count; k++) {
        const asj_junction_match *m = &list[k];
        assert_true(k == 0 || list[k - 1].distance <= m->distance);
        assert_true(m->l1 < r->l_junction_count1 && m->l2 < r->l_junction_count2);
        assert_true(m->x1 == r->l_junctions1[m->l1].x && m->y1 == r->l_junctions1[m->l1].y);
        assert_int_equal(m->junction1, r->l_junctions1[m->l1].junction);
        assert_int_equal(m->junction2, r->l_junctions2[m->l2].junction);
    }
}

/* What the images' own geometry contradicts is still there when the upsampled images are the answer, each once: under that
 * geometry, and under another one that contradicts it, too. */
static void check_rejected(asj_context *context, int32_t both)
{
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, both);
    asj_junction_match *list = (asj_junction_match *)(uintptr_t)own->matches;
    const uint32_t first = upsampled->l_junction_count1;
    float *probability = calloc(own->match_count, sizeof *probability);
    assert_non_null(probability);
    assert_true(own->match_count >= 12);
    for (uint32_t k = 0; k < own->match_count; k++)
        if (k % 3 == 1) {
            list[k].y2 += 40; /* across the lines of a camera that moves sideways */
            list[k].affine[5] += 40;
            probability[k] = -1;
        } else {
            probability[k] = 0.5F;
        }
    assert_int_equal(asj_match_result_judge(context, own, probability, NULL), ASJ_OK);
    free(probability);
    const size_t rejected_count = (size_t)own->rejected_count;
    asj_junction_match *rejected = calloc(rejected_count, sizeof *rejected);
    assert_non_null(rejected);
    assert_true(rejected_count >= 4);
    memcpy(rejected, own->rejected, rejected_count * sizeof *rejected);
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
    assert_true(own->l_junction_count1 > first); /* that of the upsampled images */
    assert_int_equal(own->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    for (size_t k = 0; k < rejected_count; k++)
        assert_int_equal(times_in(own->rejected, (size_t)own->rejected_count, &rejected[k], 0), 1);
    for (size_t k = 0; k < own->rejected_count; k++)
        assert_int_equal(times_in(own->matches, own->match_count, &own->rejected[k], 4), 0);
    assert_list(own, own->matches, own->match_count);
    assert_list(own, own->rejected, (size_t)own->rejected_count);
    free(rejected);
    asj_match_result_free(&own);
}

static void what_is_rejected_stays_so(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    check_rejected(context, 0);
    check_rejected(context, 1);
}

/* What only one look rejects, and the other one has, is a match. */
static void what_is_kept_is_not_rejected(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 0);
    float *probability = calloc(own->match_count, sizeof *probability);
    assert_non_null(probability);
    for (uint32_t k = 0; k < own->match_count; k++)
        probability[k] = k % 3 == 1 ? -1 : 0.5F;
    assert_int_equal(asj_match_result_judge(context, own, probability, NULL), ASJ_OK);
    free(probability);
    uint32_t again = 0;
    for (size_t k = 0; k < own->rejected_count; k++)
        again += times_in(upsampled->matches, upsampled->match_count, &own->rejected[k], 4) > 0;
    assert_true(again >= 3);
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
    for (size_t k = 0; k < own->rejected_count; k++)
        assert_int_equal(times_in(own->matches, own->match_count, &own->rejected[k], 4), 0);
    assert_list(own, own->rejected, (size_t)own->rejected_count);
    asj_match_result_free(&own);
}

/* Where the upsampled images lose the pose, or accept nothing, the one of the images judges both. */
static void a_lost_pose_is_that_of_the_images(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    for (int32_t accepted = 0; accepted < 2; accepted++) {
        asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
        const uint32_t first = upsampled->l_junction_count1;
        const asj_geometry wanted = own->geometry;
        upsampled->geometry.has_pose = 0;
        if (!accepted)
            upsampled->geometry.status = ASJ_GEOMETRY_CHANCE;
        assert_true(wanted.has_pose && wanted.log10_nfa != upsampled->geometry.log10_nfa);
        assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
        assert_true(own->l_junction_count1 > first);
        assert_memory_equal(&own->geometry, &wanted, sizeof wanted);
        const asj_known_geometry *known = asj_match_result_geometry(own);
        assert_true(known && known->by[0].x == 1); /* of the images as they are */
        asj_match_result_free(&own);
    }
}

/* A geometry that only the upsampled images have judges the images' own matches: a wrong one goes, the others have their
 * probability. With one that is asked for both it is the same. */
static void a_geometry_judges_all(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    for (int32_t both = 0; both < 2; both++) {
        asj_match_result *own = match(context, 0, both), *upsampled = match(context, 1, 1);
        const uint32_t first = upsampled->l_junction_count1, own_count = own->match_count;
        asj_junction_match *list = (asj_junction_match *)(uintptr_t)own->matches, wrong = {.l1 = UINT32_MAX};
        const double log10_nfa = upsampled->geometry.log10_nfa;
        for (uint32_t k = 0; k < own_count && wrong.l1 == UINT32_MAX; k++)
            if (list[k].x1 > 0.8F * WIDTH && times_in(upsampled->matches, upsampled->match_count, &list[k], 12) == 0) {
                list[k].y2 += 40; /* across the lines of a camera that moves sideways */
                list[k].affine[5] += 40;
                wrong = list[k];
            }
        assert_true(wrong.l1 != UINT32_MAX);
        assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
        assert_true(own->l_junction_count1 > first);
        assert_true(own->geometry.log10_nfa == log10_nfa);
        assert_int_equal(times_in(own->matches, own->match_count, &wrong, 0), 0);
        assert_int_equal(times_in(own->rejected, (size_t)own->rejected_count, &wrong, 0), 1);
        uint32_t added = 0, probable = 0;
        for (uint32_t k = 0; k < own->match_count; k++) {
            added += own->matches[k].l1 >= first;
            probable += own->matches[k].l1 >= first && own->matches[k].probability > 0.5F;
        }
        printf("%u of %u added matches are probable\n", (unsigned)probable, (unsigned)added);
        assert_true(added >= 3 && 3 * probable >= 2 * added);
        asj_match_result_free(&own);
    }
}

/* A geometry that makes matches likely gives the images more of them, but not the upsampled ones, which were asked for none: they
 * hold although they have fewer, where there are more of both. */
static void what_a_geometry_adds_is_no_reason_against(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 0);
    const uint32_t first = upsampled->l_junction_count1, own_count = own->match_count;
    float *probability = calloc(upsampled->match_count, sizeof *probability);
    assert_non_null(probability);
    assert_true(upsampled->match_count > own_count);
    for (uint32_t k = own_count - 1; k < upsampled->match_count; k++)
        probability[k] = -1;
    assert_int_equal(asj_match_result_judge(context, upsampled, probability, NULL), ASJ_OK);
    free(probability);
    assert_true(upsampled->match_count < own_count);
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
    printf("%u matches of the images, with those of the upsampled ones %u\n", (unsigned)own_count, (unsigned)own->match_count);
    assert_true(own->l_junction_count1 > first && own->match_count > own_count);
    assert_int_equal(own->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_list(own, own->matches, own->match_count);
    asj_match_result_free(&own);
}

/* Rivals of the images' geometry are not forgotten for what is none. */
static void rivals_are_an_answer(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 0), *upsampled = match(context, 1, 0);
    const uint32_t first = upsampled->l_junction_count1;
    own->geometry.status = ASJ_GEOMETRY_AMBIGUOUS;
    own->geometry.log10_nfa = -7;
    upsampled->geometry.status = ASJ_GEOMETRY_CHANCE;
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
    assert_true(own->l_junction_count1 > first);
    assert_int_equal(own->geometry.status, ASJ_GEOMETRY_AMBIGUOUS);
    assert_true(own->geometry.log10_nfa == -7);
    asj_match_result_free(&own);
}

/* --- two poses --------------------------------------------------------------------------------------------------------------- */

static void assert_no_probability(const asj_junction_match *list, size_t count)
{
    for (size_t k = 0; k < count; k++)
        assert_true(list[k].probability == 0);
}

/* Two motions are no answer: what either contradicts goes, and the weaker one is told as the second. Matches of the upsampled
 * images are there when those of the images come again. */
static void poses_at_odds_are_ambiguous(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    for (int again = 0; again < 2; again++) {
        asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
        const uint32_t count = own->match_count, l_count = own->l_junction_count1, upsampled_l_count = upsampled->l_junction_count1;
        const uint64_t rejected_count = own->rejected_count;
        const double own_nfa = own->geometry.log10_nfa, nfa = upsampled->geometry.log10_nfa;
        asj_junction_match *list = (asj_junction_match *)(uintptr_t)own->matches;
        if (!again)
            move_along_lines(own);
        list[2].y2 += 40;
        const asj_junction_match off = list[2];
        printf("standard deviations %.2f and %.2f degrees\n", sd_of_rotation(own), sd_of_rotation(upsampled));
        change_pose(own, 3 + 5 * hypot(sd_of_rotation(own), sd_of_rotation(upsampled)), 1);
        double turned[9];
        memcpy(turned, own->geometry.rotation, sizeof turned);
        assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
        assert_int_equal(own->geometry.status, ASJ_GEOMETRY_AMBIGUOUS);
        assert_true(own->geometry.log10_nfa == nfa && own->geometry.has_rival && own->geometry.rival_log10_nfa == own_nfa);
        assert_memory_equal(own->geometry.rival_rotation, turned, sizeof turned);
        assert_int_equal(times_in(own->rejected, (size_t)own->rejected_count, &off, 0), 1);
        assert_true(2 * own->match_count > count);
        assert_true(again ? own->l_junction_count1 > upsampled_l_count : own->l_junction_count1 == l_count);
        assert_true(again || own->match_count + own->rejected_count == count + rejected_count);
        assert_null(asj_match_result_geometry(own));
        assert_list(own, own->matches, own->match_count);
        assert_no_probability(own->matches, own->match_count);
        assert_no_probability(own->rejected, (size_t)own->rejected_count);
        asj_match_result_free(&own);
    }
}

/* .. but where one of them is upside down, or has very much more evidence. */
static void poses_at_odds_are_decided(void **state)
{
    static const struct {
        double own, upsampled, log10_nfa; /* degrees; of the images, where the upsampled ones have -100 */
        asj_looks looks;
    } cases[] = {{30, 0, -50, ASJ_LOOKS_DISPUTED},   {30, 0, -35, ASJ_LOOKS_RESOLVED},   {180, 0, -90, ASJ_LOOKS_RESOLVED},
                 {180, 0, -300, ASJ_LOOKS_DISPUTED}, {0, 180, -62, ASJ_LOOKS_BY_IMAGES}, {0, 180, -35, ASJ_LOOKS_RESOLVED},
                 {180, 150, -90, ASJ_LOOKS_DISPUTED}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
        change_pose(own, cases[k].own, 1);
        change_pose(upsampled, cases[k].upsampled, 1);
        own->geometry.log10_nfa = cases[k].log10_nfa;
        upsampled->geometry.log10_nfa = -100;
        assert_int_equal(asj_looks_of(own, upsampled), cases[k].looks);
        const int32_t disputed = cases[k].looks == ASJ_LOOKS_DISPUTED;
        const double told = cases[k].looks == ASJ_LOOKS_BY_IMAGES ? cases[k].log10_nfa : -100;
        assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
        assert_int_equal(own->geometry.status, disputed ? ASJ_GEOMETRY_AMBIGUOUS : ASJ_GEOMETRY_ACCEPTED);
        assert_true(own->geometry.log10_nfa == told && (asj_match_result_geometry(own) == NULL) == disputed);
        assert_list(own, own->matches, own->match_count);
        assert_list(own, own->rejected, (size_t)own->rejected_count);
        asj_match_result_free(&own);
    }
}

static void make_turn(asj_geometry *g)
{
    g->model = ASJ_GEOMETRY_HOMOGRAPHY;
    g->has_pose = 0;
    g->only_turns = 1;
    memset(g->translation, 0, sizeof g->translation);
}

/* Two turns are compared as two poses are; what the images say of a camera that only turns no motion undoes. */
static void turns_are_motions(void **state)
{
    static const struct {
        double own;
        int32_t of_own, of_upsampled, status; /* is it a turn? */
        asj_looks looks;
    } cases[] = {{30, 1, 1, ASJ_GEOMETRY_ACCEPTED, ASJ_LOOKS_DISPUTED}, {180, 1, 1, ASJ_GEOMETRY_ACCEPTED, ASJ_LOOKS_RESOLVED},
                 {30, 1, 0, ASJ_GEOMETRY_ACCEPTED, ASJ_LOOKS_BY_IMAGES}, {0, 1, 0, ASJ_GEOMETRY_ACCEPTED, ASJ_LOOKS_BY_IMAGES},
                 {30, 0, 1, ASJ_GEOMETRY_ACCEPTED, ASJ_LOOKS_BY_IMAGES}, {0, 1, 0, ASJ_GEOMETRY_DEGENERATE, ASJ_LOOKS_LOST}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
        change_pose(own, cases[k].own, 1);
        own->geometry.log10_nfa = -50;
        upsampled->geometry.log10_nfa = -100;
        if (cases[k].of_own)
            make_turn(&own->geometry);
        if (cases[k].of_upsampled)
            make_turn(&upsampled->geometry);
        own->geometry.status = cases[k].status;
        if (cases[k].status == ASJ_GEOMETRY_DEGENERATE)
            own->geometry.model = ASJ_GEOMETRY_ESSENTIAL;
        assert_int_equal(asj_looks_of(own, upsampled), cases[k].looks);
        asj_match_result_free(&own);
        asj_match_result_free(&upsampled);
    }
}

/* The axis of half a turn is that of no antisymmetric part. */
static void half_a_turn_is_at_odds(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
    for (int32_t axis = 0; axis < 3; axis++) {
        own->geometry = upsampled->geometry;
        for (int32_t k = 0; k < 9; k++)
            own->geometry.rotation[k] *= k / 3 == axis ? 1 : -1;
        assert_int_equal(asj_looks_of(own, upsampled), axis == 1 ? ASJ_LOOKS_DISPUTED : ASJ_LOOKS_RESOLVED);
    }
    asj_match_result_free(&own);
    asj_match_result_free(&upsampled);
}

/* The pose of a plane is open: the plane stays. */
static void planes_at_odds_have_no_pose(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
    const double nfa = upsampled->geometry.log10_nfa;
    own->geometry.model = upsampled->geometry.model = ASJ_GEOMETRY_HOMOGRAPHY;
    change_pose(own, 30, 1);
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
    assert_int_equal(own->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_int_equal(own->geometry.has_pose, 0);
    assert_true(own->geometry.log10_nfa == nfa);
    asj_match_result_free(&own);
}

/* From each allocation on there is no memory: the result, whole or changed in part, is there to be freed, and nothing leaks. */
static void poses_at_odds_without_memory(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *pair[2] = {match(context, 0, 1), match(context, 1, 1)};
    uint32_t failed = 0;
    int reached = 1;
    change_pose(pair[0], 3 + 5 * hypot(sd_of_rotation(pair[0]), sd_of_rotation(pair[1])), 1);
    for (long n = 1; reached; n++) {
        unit_counter counter = {0};
        asj_context *poor = unit_context(&counter, 1);
        asj_match_result *own = match(poor, 0, 0), *upsampled = match(poor, 1, 0);
        own->geometry = pair[0]->geometry;
        upsampled->geometry = pair[1]->geometry;
        assert_int_equal(asj_looks_of(own, upsampled), ASJ_LOOKS_DISPUTED);
        counter.fail_at = counter.calls + n;
        counter.for_good = 1;
        const asj_status status = asj_upsampled_choose(poor, &own, &upsampled, 0);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK || (reached && status == ASJ_ERROR_MEMORY));
        assert_true(own && !upsampled);
        failed += status != ASJ_OK;
        asj_match_result_free(&own);
        unit_context_free(&counter, &poor);
    }
    assert_true(failed > 0);
    asj_match_result_free(&pair[0]);
    asj_match_result_free(&pair[1]);
}

/* The other way along the same line, where the covariance says nothing: of 40 directions rounding leaves some a variance of 0 or
 * less. */
static void opposite_translations_are_at_odds(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
    asj_geometry *a = &own->geometry, *b = &upsampled->geometry;
    memcpy(b->rotation, a->rotation, sizeof a->rotation);
    for (int k = 0; k < 40; k++) {
        double axes[2][3];
        const double u = 0.3 * k, v = 0.7 + 0.05 * k, t[3] = {cos(u) * cos(v), sin(u) * cos(v), sin(v)};
        asj_translation_axes(t, axes[0], axes[1]);
        memset(a->covariance, 0, sizeof a->covariance);
        for (int n = 0; n < 9; n++)
            a->covariance[6 * (3 + n / 3) + 3 + n % 3] = 1e-4 * (axes[0][n / 3] * axes[0][n % 3] + axes[1][n / 3] * axes[1][n % 3]);
        memcpy(b->covariance, a->covariance, sizeof a->covariance);
        for (int n = 0; n < 3; n++) {
            a->translation[n] = t[n];
            b->translation[n] = -t[n];
        }
        assert_int_equal(asj_looks_of(own, upsampled), ASJ_LOOKS_DISPUTED);
    }
    asj_match_result_free(&own);
    asj_match_result_free(&upsampled);
}

static double apart(const asj_geometry *a, const asj_geometry *b)
{
    double turn[9];
    asj_multiply3_transposed(a->rotation, b->rotation, turn);
    return asj_rotation_angle(turn);
}

/* As far apart, and no wonder: neither knows better. And less than 3 degrees, however sure. Then the answer lies between them, a
 * fifth of the way from the one that is known twice as well. */
static void poses_that_agree_are_one(void **state)
{
    static const struct {
        double own, upsampled; /* times the standard deviation */
        double degrees;    /* more than 4 standard deviations, if not multiplied; 0 = 2 degrees */
    } cases[] = {{200, 100, 1}, {100, 200, 1}, {0.2, 0.4, 0}, {0.4, 0.2, 0}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
        const double sd = hypot(sd_of_rotation(own), sd_of_rotation(upsampled));
        change_pose(own, cases[k].degrees > 0 ? 3 + 5 * sd : 2, 1);
        for (int n = 0; n < 36; n++) { /* of rotation alone, so that it is the one that is surer in all */
            const double each = n % 7 == 0 && n < 21 ? sd * ASJ_DEGREE : 0;
            own->geometry.covariance[n] = pow(cases[k].own * each, 2);
            upsampled->geometry.covariance[n] = pow(cases[k].upsampled * each, 2);
        }
        memcpy(own->geometry.translation, upsampled->geometry.translation, sizeof own->geometry.translation);
        const int own_is_surer = cases[k].own < cases[k].upsampled;
        const asj_geometry surer = own_is_surer ? own->geometry : upsampled->geometry;
        const asj_geometry other = own_is_surer ? upsampled->geometry : own->geometry;
        assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
        assert_int_equal(own->geometry.status, ASJ_GEOMETRY_ACCEPTED);
        const double far = apart(&surer, &other), from_surer = apart(&own->geometry, &surer);
        assert_true(from_surer > 0.19 * far && from_surer < 0.21 * far);
        assert_true(from_surer + apart(&own->geometry, &other) < 1.0001 * far);
        assert_memory_equal(own->geometry.covariance, surer.covariance, sizeof surer.covariance);
        asj_match_result_free(&own);
    }
}

/* None of the images' matches comes again: then theirs are the answer, and so is their pose. */
static void a_pose_whose_matches_do_not_hold_moves_none(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *own = match(context, 0, 1), *upsampled = match(context, 1, 1);
    move_along_lines(own);
    change_pose(own, 1, 1);
    const asj_geometry before = own->geometry;
    assert_true(asj_looks_agree(&own->geometry, &upsampled->geometry));
    assert_int_equal(asj_upsampled_choose(context, &own, &upsampled, 0), ASJ_OK);
    assert_memory_equal(own->geometry.rotation, before.rotation, sizeof before.rotation);
    assert_memory_equal(own->geometry.matrix, before.matrix, sizeof before.matrix);
    asj_match_result_free(&own);
}

/* The images' own matches say where those of the upsampled ones are looked for, unless the geometry that is asked is open: then the
 * upsampled images are a witness, and are not told. */
static void a_witness_is_not_told(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const int32_t statuses[] = {ASJ_GEOMETRY_ACCEPTED, ASJ_GEOMETRY_AMBIGUOUS, ASJ_GEOMETRY_CHANCE};
    asj_match_result *own = match(context, 0, 1), *anywhere = match(context, 1, 1);
    const asj_known_matches known = {own, {{1, 1}, {1, 1}}};
    for (size_t k = 0; k < UNIT_COUNT(statuses); k++) {
        own->geometry.status = statuses[k];
        asj_match_result *told = match_known(context, 1, 1, &known);
        assert_true(k == 0 ? told->candidates < anywhere->candidates : told->candidates == anywhere->candidates);
        asj_match_result_free(&told);
    }
    own->geometry.status = ASJ_GEOMETRY_ACCEPTED;
    asj_match_result_free(&own);
    asj_match_result_free(&anywhere);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_rejected_stays_so),
        cmocka_unit_test(what_is_kept_is_not_rejected),
        cmocka_unit_test(a_lost_pose_is_that_of_the_images),
        cmocka_unit_test(a_geometry_judges_all),
        cmocka_unit_test(rivals_are_an_answer),
        cmocka_unit_test(poses_at_odds_are_ambiguous),
        cmocka_unit_test(poses_at_odds_are_decided),
        cmocka_unit_test(turns_are_motions),
        cmocka_unit_test(half_a_turn_is_at_odds),
        cmocka_unit_test(planes_at_odds_have_no_pose),
        cmocka_unit_test(poses_at_odds_without_memory),
        cmocka_unit_test(opposite_translations_are_at_odds),
        cmocka_unit_test(poses_that_agree_are_one),
        cmocka_unit_test(a_pose_whose_matches_do_not_hold_moves_none),
        cmocka_unit_test(what_a_geometry_adds_is_no_reason_against),
        cmocka_unit_test(a_witness_is_not_told),
    };
    return cmocka_run_group_tests(tests, find_all, free_all);
}
