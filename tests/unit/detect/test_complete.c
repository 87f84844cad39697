/* SPDX-License-Identifier: BSD-2-Clause */
/* Option complete_junctions: branches that the isotropic test misses, one place at a time and over whole images. */
#include "detect/complete.h"
#include "scenes.h"
#include "truth.h"
#include "unit_test.h"

#include <asj/asj.h>

#define SIDE 200
#define SCENES 40
#define DEGREE (UNIT_PI / 180)

typedef unit_fixture fixture;

/* Two clear edges and one of `step` grey levels, turned by `turn`. */
static void three_edges(synth_scene *scene, double turn, double step)
{
    const double angles[] = {turn, turn + 100 * DEGREE, turn + 215 * DEGREE}, grays[] = {70, 150, 150 + step};
    synth_scene_init(scene, SIDE, SIDE, 70);
    synth_add_star(scene, (synth_point){100.3, 99.6}, angles, grays, 3, 70);
}

/* ---- at one place ---- */

static int set_up_place(void **state)
{
    synth_scene scene;
    three_edges(&scene, 20 * DEGREE, 12);
    return unit_set_up_scene(state, &scene, 1, 1);
}

static asj_hypothesis junction_of(const double *degrees, int32_t count)
{
    asj_hypothesis h;
    memset(&h, 0, sizeof h);
    h.x = 99.8; /* pixel centres lie at integers here, at halves in scenes */
    h.y = 99.1;
    h.radius = 7;
    h.location_variance = 0.01;
    h.branch_count = count;
    for (int32_t i = 0; i < count; i++) {
        h.branches[i].angle = degrees[i] * DEGREE;
        h.branches[i].length = 60;
    }
    return h;
}

/* The direction that is missed, and no others: not those of the branches that there are. */
static void test_look(void **state)
{
    static const double all[] = {20, 120, 235};
    fixture *f = *state;
    asj_missed missed;
    for (int left_out = 0; left_out < 3; left_out++) {
        double degrees[2] = {all[left_out == 0], all[left_out == 2 ? 1 : 2]};
        const asj_hypothesis h = junction_of(degrees, 2);
        asj_complete_look(f->context, &f->frame, &f->options, &h, &missed);
        assert_int_equal(missed.count, 1);
        unit_near("direction", all[left_out], 0, missed.list[0].angle / DEGREE, all[left_out], 5);
    }
    const asj_hypothesis whole = junction_of(all, 3);
    asj_complete_look(f->context, &f->frame, &f->options, &whole, &missed);
    assert_int_equal(missed.count, 0);
    const asj_hypothesis rejected = junction_of(all, 0);
    asj_complete_look(f->context, &f->frame, &f->options, &rejected, &missed);
    assert_int_equal(missed.count, 0);
}

/* Nothing is looked for where a junction has as many branches as it may have. */
static void test_room(void **state)
{
    static const double others[] = {60, 63, 66, 69, 72};
    fixture *f = *state;
    asj_missed missed;
    for (int32_t count = 3; count <= 5; count++) {
        const asj_hypothesis h = junction_of(others, count);
        asj_complete_look(f->context, &f->frame, &f->options, &h, &missed);
        assert_int_equal(missed.count, count < f->options.max_branches ? 3 : 0);
        for (int32_t i = 1; i < missed.count; i++)
            assert_true(missed.list[i].meaning <= missed.list[i - 1].meaning);
        asj_hypothesis full = junction_of(others, count), only;
        if (count < 5)
            continue;
        asj_complete_start(&full, &(asj_missed_direction){120 * DEGREE, 40}, &only);
        only.branches[0].length = 60;
        asj_complete_add(f->context, &f->frame, &f->options, &only, &full);
        assert_int_equal(full.branch_count, 5);
    }
}

static asj_hypothesis followed(const asj_hypothesis *of, double degrees, double offset)
{
    asj_hypothesis h;
    asj_complete_start(of, &(asj_missed_direction){0, 40}, &h);
    assert_true(h.branch_count == 1 && h.x == of->x && h.y == of->y && h.branches[0].length > 0);
    h.branches[0].angle = degrees * DEGREE;
    h.branches[0].length = 60;
    h.branches[0].offset = offset;
    return h;
}

/* A branch is added between those of smaller and larger angles; not one that is no edge, that passes the junction, or that is near
 * another one. */
static void test_add(void **state)
{
    static const double two[] = {20, 235}, cases[][3] = {{120, 0.1, 3}, {120, -0.45, 3}, {120, 0.55, 2}, {160, 0, 2}, {70, 0, 2},
                                                         {38, 0, 2}};
    fixture *f = *state;
    for (size_t i = 0; i < UNIT_COUNT(cases); i++) {
        asj_hypothesis h = junction_of(two, 2);
        const asj_hypothesis branch_only = followed(&h, cases[i][0], cases[i][1]);
        asj_complete_add(f->context, &f->frame, &f->options, &branch_only, &h);
        assert_int_equal(h.branch_count, (int32_t)cases[i][2]);
        unit_near("second", cases[i][0], cases[i][1], h.branches[1].angle / DEGREE, cases[i][2] > 2 ? 120 : 235, 1e-9);
        if (h.branch_count > 2)
            assert_true(h.branches[1].log_nfa < -20 && h.branches[1].strength > 3);
    }
}

/* ---- over images ---- */

typedef struct tally {
    int true_branches, found, reported;
} tally;

static asj_detection *detect(asj_context *context, const asj_image *image, int32_t complete, int32_t refinement)
{
    asj_detect_options options;
    asj_detection *found = NULL;
    asj_detect_options_init(&options);
    options.complete_junctions = complete;
    options.refinement = refinement;
    assert_int_equal(asj_detect(context, image, &options, &found), ASJ_OK);
    return found;
}

static int has(const asj_junction *j, double angle)
{
    for (int32_t b = 0; b < j->branch_count; b++)
        if (unit_turn((double)j->branches[b].angle, angle) < 5 * DEGREE)
            return 1;
    return 0;
}

/* The three branches of the corner in the middle. */
static void count_branches(const asj_detection *found, double turn, tally *sum)
{
    const double angles[] = {turn, turn + 100 * DEGREE, turn + 215 * DEGREE};
    for (uint32_t i = 0; i < found->junction_count; i++) {
        const asj_junction *j = &found->junctions[i];
        if (hypot((double)j->x - 99.8, (double)j->y - 99.1) > 1.5)
            continue;
        sum->true_branches += 3;
        sum->reported += j->branch_count;
        for (int k = 0; k < 3; k++)
            sum->found += has(j, angles[k]);
    }
}

/* Junctions stay, and so do their branches. */
static void check_kept(const asj_detection *before, const asj_detection *after)
{
    for (uint32_t i = 0; i < before->junction_count; i++) {
        const asj_junction *a = &before->junctions[i];
        const asj_junction *same = NULL;
        for (uint32_t k = 0; k < after->junction_count; k++)
            if (after->junctions[k].x == a->x && after->junctions[k].y == a->y)
                same = &after->junctions[k];
        assert_non_null(same);
        for (int32_t b = 0; b < a->branch_count; b++)
            assert_true(has(same, (double)a->branches[b].angle));
    }
}

/* An edge of 10 grey levels between two of 80 and 90 is left out by the isotropic test in nearly all corners. */
static void test_faint_edges(void **state)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 2);
    tally without = {0, 0, 0}, with = {0, 0, 0};
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const double turn = i * 9 * DEGREE;
        synth_scene scene;
        three_edges(&scene, turn, 10);
        uint8_t *pixels = unit_picture(&scene, 1, 1.5, (uint64_t)i + 1);
        const asj_image image = unit_gray8(pixels, SIDE, SIDE);
        asj_detection *before = detect(context, &image, 0, ASJ_REFINE_LINE_FIT);
        asj_detection *after = detect(context, &image, 1, ASJ_REFINE_LINE_FIT);
        check_kept(before, after);
        count_branches(before, turn, &without);
        count_branches(after, turn, &with);
        asj_detection_free(&before);
        asj_detection_free(&after);
        free(pixels);
    }
    printf("of %d branches %d without and %d with it\n", with.true_branches, without.found, with.found);
    assert_true(with.true_branches >= 3 * (SCENES - 1) && without.true_branches == with.true_branches);
    assert_true(without.found < 0.8 * without.true_branches);
    assert_true(with.found >= 0.98 * with.true_branches);
    assert_true(with.reported <= with.found + 1);
    unit_context_free(&counter, &context);
}

/* Where nothing is missed nothing is added, and the paper's search has no use for it. */
static void test_nothing_to_add(void **state)
{
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (int i = 0; i < SCENES; i++) {
        const int32_t refinement = i % 4 ? ASJ_REFINE_LINE_FIT : ASJ_REFINE_SEARCH;
        synth_scene scene;
        if (refinement == ASJ_REFINE_SEARCH)
            three_edges(&scene, i * 9 * DEGREE, 10);
        else
            synth_parallelograms(&scene, 60, (uint64_t)i + 1);
        const int32_t width = scene.width, height = scene.height;
        uint8_t *pixels = unit_picture(&scene, 1, 2, (uint64_t)i + 1);
        const asj_image image = unit_gray8(pixels, width, height);
        asj_detection *before = detect(context, &image, 0, refinement), *after = detect(context, &image, 1, refinement);
        assert_true(before->junction_count > 0);
        assert_int_equal(after->junction_count, before->junction_count);
        assert_memory_equal(after->junctions, before->junctions, before->junction_count * sizeof *before->junctions);
        asj_detection_free(&before);
        asj_detection_free(&after);
        free(pixels);
    }
    unit_context_free(&counter, &context);
}

/* The same bits with any number of threads. */
static void test_threads(void **state)
{
    unit_counter counter, other;
    asj_context *one = unit_context(&counter, 1), *four = unit_context(&other, 4);
    (void)state;
    for (uint64_t seed = 1; seed < 6; seed++) {
        synth_scene scene;
        synth_tiles(&scene, SYNTH_RANDOM_TILES, seed);
        const int32_t width = scene.width, height = scene.height;
        uint8_t *pixels = unit_picture(&scene, 1, 4, seed);
        const asj_image image = unit_gray8(pixels, width, height);
        asj_detection *a = detect(one, &image, 1, ASJ_REFINE_LINE_FIT), *b = detect(four, &image, 1, ASJ_REFINE_LINE_FIT);
        assert_true(a->junction_count > 20 && a->junction_count == b->junction_count);
        assert_memory_equal(a->junctions, b->junctions, a->junction_count * sizeof *a->junctions);
        asj_detection_free(&a);
        asj_detection_free(&b);
        free(pixels);
    }
    unit_context_free(&counter, &one);
    unit_context_free(&other, &four);
}

int main(void)
{
    const struct CMUnitTest at_one_place[] = {cmocka_unit_test(test_look), cmocka_unit_test(test_room), cmocka_unit_test(test_add)};
    const struct CMUnitTest over_images[] = {cmocka_unit_test(test_faint_edges), cmocka_unit_test(test_nothing_to_add),
                                             cmocka_unit_test(test_threads)};
    const int failed = cmocka_run_group_tests(at_one_place, set_up_place, unit_tear_down);
    return failed + cmocka_run_group_tests(over_images, NULL, NULL);
}
