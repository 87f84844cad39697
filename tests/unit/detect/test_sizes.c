/* SPDX-License-Identifier: BSD-2-Clause */
/* Option three_sizes: what two of three sizes of an image have. */
#include "detect/sizes.h"
#include "unit_test.h"

#include <asj/asj.h>

enum { SIDE = 300, MOST = 8 };

/* Hypotheses along a row, 20 px from one to the next, `moved` px aside; bit i of `there`: whether number i is. */
static size_t put(asj_hypothesis *list, unsigned there, double moved)
{
    size_t count = 0;
    for (int i = 0; i < MOST; i++)
        if (there >> i & 1)
            list[count++] = (asj_hypothesis){.x = 40 + 20 * i + moved, .y = 100, .log_nfa = -i, .branch_count = 2};
    return count;
}

typedef struct scene {
    asj_hypothesis lists[ASJ_SIZES][MOST], agreed[ASJ_SIZES * MOST];
    asj_sizes sizes;
    int32_t *cells, *others;
} scene;

static void make(scene *s, int32_t count, const unsigned *there, const double *moved)
{
    memset(s, 0, sizeof *s);
    s->sizes.count = count;
    for (int32_t i = 0; i < count; i++)
        s->sizes.found[i] = (asj_size_found){s->lists[i], put(s->lists[i], there[i], moved[i])};
    s->cells = malloc(asj_sizes_cells(&s->sizes, SIDE, SIDE) * sizeof *s->cells);
    s->others = malloc(asj_octave_grid_cells(asj_sizes_total(&s->sizes), SIDE, SIDE) * sizeof *s->others);
    assert_non_null(s->cells);
    assert_non_null(s->others);
    asj_sizes_mark(&s->sizes, SIDE, SIDE, s->cells);
}

static void clear(scene *s)
{
    free(s->cells);
    free(s->others);
}

/* Every combination of three sizes, one place each; the image's own place is taken where it has one. */
static void two_of_three_stay(void **state)
{
    const unsigned there[] = {0xf0, 0xcc, 0xaa};
    const double moved[] = {0, 1.5, -1.25};
    scene s;
    (void)state;
    make(&s, ASJ_SIZES, there, moved);
    const size_t count = asj_sizes_agreed(&s.sizes, SIDE, SIDE, s.others, s.agreed);
    int seen[MOST] = {0};
    assert_int_equal(count, 4);
    for (size_t i = 0; i < count; i++) {
        const int place = (int)floor((s.agreed[i].x - 40) / 20 + 0.5);
        const int own = there[0] >> place & 1;
        seen[place]++;
        unit_near("x", place, 0, s.agreed[i].x, 40 + 20 * place + (own ? 0 : moved[1]), 1e-9);
    }
    for (int place = 0; place < MOST; place++)
        assert_int_equal(seen[place], (there[0] >> place & 1) + (there[1] >> place & 1) + (there[2] >> place & 1) >= 2);
    clear(&s);
}

/* Places farther apart than 3 px are two. */
static void far_ones_do_not_agree(void **state)
{
    const unsigned there[] = {0xff, 0xff};
    const double moved[] = {0, 3.25};
    asj_size_place places[2 * MOST];
    scene s;
    (void)state;
    make(&s, 2, there, moved);
    assert_int_equal(asj_sizes_agreed(&s.sizes, SIDE, SIDE, s.others, s.agreed), 0);
    assert_int_equal(asj_sizes_disputed(&s.sizes, places), 2 * MOST);
    clear(&s);
}

/* What two copies have beside a place that stays is the same corner, up to 5 px from it. */
static void copies_add_none_beside(void **state)
{
    static const double aside[] = {3.5, 4.75, 5.25};
    (void)state;
    for (size_t k = 0; k < UNIT_COUNT(aside); k++) {
        const unsigned there[] = {1, 1, 1};
        const double moved[] = {0, aside[k] - 2.5, aside[k]};
        scene s;
        make(&s, ASJ_SIZES, there, moved);
        assert_int_equal(asj_sizes_agreed(&s.sizes, SIDE, SIDE, s.others, s.agreed), aside[k] < 5 ? 1 : 2);
        unit_near("x", 0, 0, s.agreed[0].x, 40, 1e-9);
        clear(&s);
    }
}

/* What one of two sizes has is disputed. */
static void disputed_places(void **state)
{
    const unsigned there[] = {0x0f, 0x3c};
    const double moved[] = {0, 1};
    asj_size_place places[2 * MOST];
    scene s;
    (void)state;
    make(&s, 2, there, moved);
    assert_int_equal(asj_sizes_disputed(&s.sizes, places), 4);
    for (int i = 0; i < 4; i++)
        unit_near("y", i, 0, places[i].y, 100, 1e-9);
    clear(&s);
}

/* Votes of a copy count, and are no junctions by themselves, nor disputed. */
static void votes(void **state)
{
    const unsigned there[] = {0x0f, 0x3f};
    const double moved[] = {0, 1};
    asj_size_place places[2 * MOST];
    scene s;
    (void)state;
    make(&s, 2, there, moved);
    for (size_t i = 0; i < s.sizes.found[1].count; i++)
        s.lists[1][i].is_vote = 1;
    assert_int_equal(asj_sizes_agreed(&s.sizes, SIDE, SIDE, s.others, s.agreed), 4);
    assert_int_equal(asj_sizes_disputed(&s.sizes, places), 0);
    assert_true(asj_sizes_have(&s.sizes, &(asj_size_place){140, 104, 0}, 5));
    assert_false(asj_sizes_have(&s.sizes, &(asj_size_place){140, 104, 0}, 4));
    clear(&s);
}

/* Sizes and the way back. */
static void sizes_map(void **state)
{
    (void)state;
    assert_int_equal(asj_size_px(640, 0), 640);
    assert_int_equal(asj_size_px(640, 1), 538);
    assert_int_equal(asj_size_px(640, 2), 761);
    asj_hypothesis h = {.x = -0.5, .y = 9.5, .branch_count = 1, .branches = {{.length = 10, .offset = -1}}};
    asj_size_found list = {&h, 1};
    asj_size_map(&list, 50, 50, 100, 100);
    assert_int_equal(list.count, 1);
    unit_near("x", 0, 0, h.x, -0.5, 1e-12);
    unit_near("y", 0, 0, h.y, 19.5, 1e-12);
    unit_near("length", 0, 0, h.branches[0].length, 20, 1e-12);
    unit_near("offset", 0, 0, h.branches[0].offset, -2, 1e-12);
}

/* What lies farther outside of the image than junctions may goes, from each border. */
static void too_far_outside(void **state)
{
    static const double near = ASJ_MAX_OUTSIDE / 2.0, far = ASJ_MAX_OUTSIDE / 2.0 + 0.5;
    (void)state;
    for (int32_t i = 0; i < 8; i++) {
        const double beyond = i & 1 ? far : near, at = i & 2 ? 49 + beyond : -beyond;
        asj_hypothesis h[] = {{.x = i & 4 ? at : 7, .y = i & 4 ? 7 : at}, {.x = 20, .y = 20}};
        asj_size_found list = {h, 2};
        asj_size_map(&list, 50, 50, 100, 100);
        assert_int_equal(list.count, i & 1 ? 1 : 2);
        unit_near("what stays", i, 0, h[list.count - 1].x, 40.5, 1e-12);
    }
}

static uint8_t *parallelogram(double gray, double noise, uint64_t seed)
{
    static const synth_point corners[] = {{60.3, 70.2}, {220.7, 90.4}, {240.1, 210.6}, {80.2, 190.8}};
    synth_scene drawn;
    synth_scene_init(&drawn, SIDE, SIDE, 100);
    synth_scene_add(&drawn, corners, 4, synth_flat(gray), 0);
    return unit_picture(&drawn, 1, noise, seed);
}

static int32_t near_corners(const asj_detection *found)
{
    static const double corners[4][2] = {{60.3, 70.2}, {220.7, 90.4}, {240.1, 210.6}, {80.2, 190.8}};
    int32_t count = 0;
    for (int c = 0; c < 4; c++) {
        int there = 0;
        for (uint32_t i = 0; i < found->junction_count; i++)
            there |= hypot((double)found->junctions[i].x - corners[c][0], (double)found->junctions[i].y - corners[c][1]) < 2.5;
        count += there;
    }
    return count;
}

/* Clear corners are where they are without the option; of weak ones no fewer are found; and nothing leaks when memory is short. */
static void corners(void **state)
{
    unit_fixture *f = *state;
    int32_t weak[2] = {0, 0};
    for (int sizes = 0; sizes < 2; sizes++) {
        f->options.three_sizes = sizes;
        for (uint64_t seed = 0; seed < 24; seed++) {
            asj_detection *found = NULL;
            uint8_t *pixels = parallelogram(seed == 0 ? 160 : 103, 2, seed);
            const asj_image image = unit_gray8(pixels, SIDE, SIDE);
            assert_int_equal(asj_detect(f->context, &image, &f->options, &found), ASJ_OK);
            if (seed == 0) {
                assert_int_equal(found->junction_count, 4);
                assert_int_equal(near_corners(found), 4);
            } else
                weak[sizes] += near_corners(found);
            asj_detection_free(&found);
            free(pixels);
        }
    }
    assert_true(weak[1] >= weak[0]);
}

/* Images of a few pixels, a region, and any number of threads. */
static void anywhere(void **state)
{
    unit_fixture *f = *state;
    uint8_t *pixels = parallelogram(160, 2, 1);
    f->options.three_sizes = 1;
    for (int32_t size = 1; size < 60; size += 7) {
        asj_detection *found = NULL;
        const asj_image image = {pixels, ASJ_FORMAT_GRAY8, size, 61 - size, 0, SIDE};
        assert_int_equal(asj_detect(f->context, &image, &f->options, &found), ASJ_OK);
        asj_detection_free(&found);
    }
    asj_detection *found = NULL;
    const asj_image image = unit_gray8(pixels, SIDE, SIDE);
    const asj_region region = {.x = 200, .y = 60, .width = 60, .height = 60};
    assert_int_equal(asj_detect_region(f->context, &image, &region, &f->options, &found), ASJ_OK);
    assert_int_equal(found->junction_count, 1);
    unit_near("x", 0, 0, (double)found->junctions[0].x, 220.7, 0.3);
    asj_detection_free(&found);
    free(pixels);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(two_of_three_stay),
        cmocka_unit_test(far_ones_do_not_agree),
        cmocka_unit_test(copies_add_none_beside),
        cmocka_unit_test(disputed_places),
        cmocka_unit_test(votes),
        cmocka_unit_test(sizes_map),
        cmocka_unit_test(too_far_outside),
        cmocka_unit_test_setup_teardown(corners, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(anywhere, unit_set_up, unit_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
