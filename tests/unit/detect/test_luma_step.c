/* SPDX-License-Identifier: BSD-2-Clause */
/* The luma of an image that is looked at with colours afterwards: kept where it can be, and taken over without a trace. */
#include "detect/luma_step.h"
#include "unit_test.h"

#include <asj/asj.h>

#define SIDE 160
#define FIRST 50 /* px: of the square that grey levels show; .. */
#define END 110
#define INNER 20 /* px from it: one of another colour as bright */

typedef unit_fixture fixture;

static const asj_image *picture(void)
{
    static uint8_t pixels[SIDE][SIDE][3];
    static const uint8_t ground[3] = {60, 60, 60}, square[3] = {120, 120, 120}, reddish[3] = {159, 100, 120};
    static const asj_image image = {pixels, ASJ_FORMAT_RGB8, SIDE, SIDE, 0, 0};
    synth_random random;
    synth_random_seed(&random, 5);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const int side = x < y ? x : y, far = x < y ? y : x;
            const uint8_t *colour = side >= FIRST + INNER && far < END - INNER ? reddish :
                                    side >= FIRST && far < END ? square : ground;
            for (int c = 0; c < 3; c++)
                pixels[y][x][c] = (uint8_t)(colour[c] + floor(synth_random_between(&random, 0, 3)));
        }
    return &image;
}

static void set_options(asj_detect_options *options, int32_t colours)
{
    assert_int_equal(asj_detect_options_preset(options, ASJ_PRESET_MATCH), ASJ_OK);
    options->colours = colours;
}

static void assert_same(const asj_detection *a, const asj_detection *b)
{
    assert_true(a->junction_count == b->junction_count && a->edge_count == b->edge_count);
    assert_true(a->candidates == b->candidates && a->isotropic == b->isotropic);
    for (uint32_t k = 0; k < a->junction_count; k++)
        assert_memory_equal(&a->junctions[k], &b->junctions[k], sizeof a->junctions[k]);
    for (uint32_t k = 0; k < a->edge_count; k++)
        assert_memory_equal(&a->edges[k], &b->edges[k], sizeof a->edges[k]);
}

static void luma_is_taken_over(void **state)
{
    fixture *f = *state;
    asj_luma_found luma = {.is_known = 0};
    asj_detection *plain = NULL, *kept = NULL, *whole = NULL, *again = NULL;
    set_options(&f->options, 0);
    assert_int_equal(asj_detect(f->context, picture(), &f->options, &plain), ASJ_OK);
    assert_int_equal(asj_detect_with_luma(f->context, picture(), &f->options, &luma, &kept), ASJ_OK);
    assert_true(luma.is_known && luma.found_count > 0);
    assert_same(plain, kept);
    set_options(&f->options, 1);
    assert_int_equal(asj_detect(f->context, picture(), &f->options, &whole), ASJ_OK);
    assert_true(whole->junction_count > plain->junction_count);
    for (int time = 0; time < 2; time++) { /* it stays known */
        assert_int_equal(asj_detect_with_luma(f->context, picture(), &f->options, &luma, &again), ASJ_OK);
        assert_same(whole, again);
        asj_detection_free(&again);
    }
    asj_luma_found_free(&f->context->memory, &luma);
    assert_true(!luma.is_known && !luma.found && !luma.evidence);
    asj_detection_free(&plain);
    asj_detection_free(&kept);
    asj_detection_free(&whole);
}

/* Where colours change what is found in the luma, or with them from the start. */
static void luma_is_not_always_kept(void **state)
{
    static const struct {
        int32_t colours, independent_octaves, three_sizes, is_kept;
    } cases[] = {{0, 1, 0, 1}, {1, 1, 0, 0}, {0, 0, 0, 0}, {0, 1, 1, 0}};
    fixture *f = *state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_luma_found luma = {.is_known = 0};
        asj_detection *found = NULL;
        set_options(&f->options, cases[k].colours);
        f->options.independent_octaves = cases[k].independent_octaves;
        f->options.three_sizes = cases[k].three_sizes;
        assert_int_equal(asj_detect_with_luma(f->context, picture(), &f->options, &luma, &found), ASJ_OK);
        assert_int_equal(luma.is_known, cases[k].is_kept);
        asj_luma_found_free(&f->context->memory, &luma);
        asj_detection_free(&found);
    }
}

/* Every allocation fails once, while the luma is kept or taken over: the status says so, and what is known is freed or whole. */
static void memory_runs_out(void **state)
{
    (void)state;
    for (long n = 1, reached = 1; reached; n += UNIT_ALLOCATION_STEP) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, 1);
        asj_luma_found luma = {.is_known = 0};
        asj_detect_options options;
        reached = 0;
        for (int32_t colours = 0; colours < 2; colours++) {
            asj_detection *found = NULL;
            set_options(&options, colours);
            counter.fail_at = counter.calls + n;
            const asj_status status = asj_detect_with_luma(context, picture(), &options, &luma, &found);
            reached |= unit_reached(&counter);
            assert_true(status == ASJ_OK || status == ASJ_ERROR_MEMORY);
            assert_true(!luma.is_known || (luma.found && luma.evidence));
            asj_detection_free(&found);
        }
        asj_luma_found_free(&context->memory, &luma);
        unit_context_free(&counter, &context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(luma_is_taken_over),
        cmocka_unit_test(luma_is_not_always_kept),
        cmocka_unit_test(memory_runs_out),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
