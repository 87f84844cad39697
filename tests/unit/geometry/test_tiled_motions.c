/* SPDX-License-Identifier: BSD-2-Clause */
/* src/geometry/tiled_motions.c: from a motion that sees other tiles comes the right one, and nothing where none is wanted. */
#include "unit_test.h"
#include "tiled_wall.h"

#include "core/angle.h"
#include "geometry/contradiction.h"
#include "geometry/evidence.h"
#include "geometry/tiled_motions.h"

/* How many come of `best`; *nearest: how far the nearest one is from the right motion, degrees. */
static int32_t find_from(asj_estimation *e, const asj_model *best, double *nearest)
{
    const asj_model right = right_motion(0);
    asj_model found[ASJ_TILED];
    int32_t count = -1;
    *nearest = HUGE_VAL;
    e->finalists[0] = *best;
    e->finalists[0].evidence = asj_log_evidence(&e->set, &e->finalists[0], &e->scratch);
    e->count = 1;
    assert_int_equal(asj_find_tiled_motions(e, 0, found, &count), ASJ_OK);
    for (int32_t k = 0; k < count; k++) {
        asj_compare_with(e, &found[k]);
        print_message("  %.2f degrees from the right motion, log10 NFA %.1f, agreement %.2f; from the best one %.1f degrees\n",
                      asj_motions_apart(&found[k], &right) / ASJ_DEGREE, asj_estimation_log10_nfa(e, &found[k]),
                      asj_agreement_of_other(e)->share, asj_motions_apart(&found[k], best) / ASJ_DEGREE);
        *nearest = fmin(*nearest, asj_motions_apart(&found[k], &right) / ASJ_DEGREE);
        assert_true(asj_motions_apart(&found[k], best) > 3 * ASJ_DEGREE);
        assert_true(asj_agreement_of_other(e)->share > 0.75);
    }
    return count;
}

static void test_right_motion_comes_from_a_wrong_one(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    for (int32_t way = TILED_SHIFTED; way <= TILED_TURNED; way++) {
        asj_geometry_options options;
        double nearest;
        asj_estimation *e = create_tiled(context, way, 3, 100, &options);
        const asj_model wrong = wrong_motion(way, 0);
        const int32_t count = find_from(e, &wrong, &nearest);
        print_message("agreement of the wrong one %.2f\n", e->first.agreement.share);
        assert_true(count >= 1 && count <= ASJ_TILED);
        assert_true(nearest < 1);
        release_estimation(context, e);
    }
}

/* Pictures in colours that know something have to disagree with the best motion. */
static void test_nothing_comes_where_nobody_doubts(void **state)
{
    static const struct {
        int32_t channels, contrast, right;
    } cases[] = {{3, 100, 1}, {3, 0, 0}, {1, 100, 0}, {0, 100, 0}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_geometry_options options;
        double nearest;
        asj_estimation *e = create_tiled(context, TILED_SHIFTED, cases[k].channels, cases[k].contrast, &options);
        const asj_model best = cases[k].right ? right_motion(0) : wrong_motion(TILED_SHIFTED, 0);
        assert_int_equal(find_from(e, &best, &nearest), 0);
        release_estimation(context, e);
    }
}

/* Where the right motion's matches are no more than chance, or pictures are of something else, nothing comes either. */
static void test_nothing_comes_of_chance(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_geometry_options options;
    double nearest;
    asj_estimation *e = create_tiled(context, TILED_SHIFTED, 3, 100, &options);
    const asj_model wrong = wrong_motion(TILED_SHIFTED, 0);
    options.epsilon = 0;
    assert_int_equal(find_from(e, &wrong, &nearest), 0);
    options.epsilon = 1;
    for (int32_t c = 0; c < ASJ_MOST_CHANNELS; c++) {
        const asj_pyramid kept = pyramids[0][c];
        pyramids[0][c] = pyramids[1][(c + 1) % ASJ_MOST_CHANNELS];
        pyramids[1][(c + 1) % ASJ_MOST_CHANNELS] = kept;
    }
    assert_int_equal(find_from(e, &wrong, &nearest), 0);
    release_estimation(context, e);
}

static void test_every_allocation_may_fail(void **state)
{
    unit_fixture *f = *state;
    asj_geometry_options options;
    asj_estimation *e = create_tiled(f->context, TILED_SHIFTED, 3, 100, &options);
    asj_model found[ASJ_TILED];
    int32_t count, failed = 0;
    e->finalists[0] = wrong_motion(TILED_SHIFTED, 0);
    e->count = 1;
    for (long at = 1;; at++) {
        asj_memory_trim(&f->context->memory);
        const long live = f->counter.live;
        f->counter.fail_at = f->counter.calls + at;
        const asj_status status = asj_find_tiled_motions(e, 0, found, &count);
        if (!unit_reached(&f->counter))
            break;
        failed += status == ASJ_ERROR_MEMORY;
        assert_true(status == ASJ_ERROR_MEMORY && count >= 0 && count <= ASJ_TILED);
        assert_int_equal(f->counter.live, live);
    }
    assert_true(failed > 4);
    release_estimation(f->context, e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_right_motion_comes_from_a_wrong_one),
        cmocka_unit_test(test_nothing_comes_where_nobody_doubts),
        cmocka_unit_test(test_nothing_comes_of_chance),
        cmocka_unit_test(test_every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
