/* SPDX-License-Identifier: BSD-2-Clause */
/* From hypotheses to the public result. */
#include "detect/result.h"
#include "core/context.h"
#include "unit_test.h"

static void fill(asj_hypothesis *hypotheses, size_t count)
{
    synth_random random;
    synth_random_seed(&random, 5);
    memset(hypotheses, 0, count * sizeof *hypotheses);
    for (size_t i = 0; i < count; i++) {
        asj_hypothesis *d = &hypotheses[i];
        d->x = synth_random_between(&random, 0, 100);
        d->y = synth_random_between(&random, 0, 100);
        d->radius = 3 + (double)i;
        d->log_nfa = -10 + (double)i;
        d->location_variance = 0.04;
        d->branch_count = 2 + (int32_t)(i % 4);
        for (int32_t b = 0; b < d->branch_count; b++) {
            asj_hypothesis_branch *branch = &d->branches[b];
            branch->angle = 0.1 + b * 1.2 + synth_random_unit(&random) * 0.1;
            branch->length = 10 + b;
            branch->strength = 4.5;
            branch->log_nfa = -20;
            branch->angle_variance = 1e-4;
            branch->end_variance = 0.25;
            branch->end = b;
        }
    }
}

static void test_conversion(void **state)
{
    enum { COUNT = 12 };
    asj_hypothesis hypotheses[COUNT];
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    fill(hypotheses, COUNT);
    hypotheses[0].branches[1].angle = nextafter(2 * UNIT_PI, 0); /* rounds to 2 pi, which is not in [0, 2 pi) */
    const asj_edge edges[2] = {{0, 3, 1, 0, -7, {0, 0}}, {2, 5, 0, 1, -9, {0, 0}}};
    const asj_findings findings = {hypotheses, COUNT, edges, 2};
    asj_detection *made = NULL;
    assert_int_equal(asj_result_fill(context, &findings, 15, &made), ASJ_OK);
    assert_non_null(made);
    asj_context_free(&context); /* the result lives on */
    assert_int_equal(made->junction_count, COUNT);
    for (uint32_t i = 0; i < COUNT; i++) {
        const asj_junction *j = &made->junctions[i];
        unit_near("x", i, 0, j->x, hypotheses[i].x, 1e-5);
        unit_near("y", i, 0, j->y, hypotheses[i].y, 1e-5);
        unit_near("scale", i, 0, j->scale, hypotheses[i].radius, 0);
        unit_near("log10 NFA", i, 0, j->log10_nfa, hypotheses[i].log_nfa / log(10), 1e-6);
        unit_near("location sd", i, 0, j->location_sd, 0.2, 1e-6);
        assert_int_equal(j->branch_count, hypotheses[i].branch_count);
        for (int32_t b = 0; b < j->branch_count; b++) {
            unit_near("angle", i, b, unit_turn(j->branches[b].angle, hypotheses[i].branches[b].angle), 0, 1e-6);
            assert_true(j->branches[b].angle >= 0 && (double)j->branches[b].angle < 2 * UNIT_PI);
            unit_near("length", i, b, j->branches[b].length, 10 + b, 0);
            unit_near("strength", i, b, j->branches[b].strength, 4.5, 0);
            unit_near("branch NFA", i, b, j->branches[b].log10_nfa, -20 / log(10), 1e-5);
            unit_near("angle sd", i, b, j->branches[b].angle_sd, 0.01, 1e-7);
            assert_true(j->branches[b].width == 0 && j->branches[b].end == b);
            unit_near("length sd", i, b, j->branches[b].length_sd, 0.5, 1e-7);
        }
        for (int32_t b = j->branch_count; b < ASJ_MAX_BRANCHES; b++)
            assert_true(j->branches[b].angle == 0 && j->branches[b].length == 0 && j->branches[b].angle_sd == 0);
    }
    asj_l_junction expected[COUNT * 10];
    assert_int_equal(made->l_junction_count, asj_decompose(made->junctions, COUNT, 15, expected, COUNT * 10));
    assert_memory_equal(made->l_junctions, expected, made->l_junction_count * sizeof *expected);
    assert_int_equal(made->edge_count, 2);
    assert_memory_equal(made->edges, edges, sizeof edges);
    asj_detection_free(&made);
    assert_null(made);
    assert_int_equal(counter.live, 0);
}

static void test_empty_and_without_l(void **state)
{
    asj_hypothesis hypotheses[3];
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    const asj_edge edge = {0, 1, 0, 0, -3, {0, 0}};
    const asj_findings nothing = {NULL, 0, NULL, 0}, three = {hypotheses, 3, &edge, 1};
    asj_detection *made = NULL;
    assert_int_equal(asj_result_fill(context, &nothing, 25, &made), ASJ_OK);
    assert_non_null(made);
    assert_true(!made->edges && made->edge_count == 0);
    assert_true(!made->junctions && !made->l_junctions && made->junction_count == 0 && made->l_junction_count == 0);
    asj_detection_free(&made);
    fill(hypotheses, 3);
    for (int i = 0; i < 3; i++) {
        hypotheses[i].branch_count = 2;
        hypotheses[i].branches[1].angle = hypotheses[i].branches[0].angle + 0.1; /* too narrow */
    }
    assert_int_equal(asj_result_fill(context, &three, 25, &made), ASJ_OK);
    assert_true(made && made->junction_count == 3 && !made->l_junctions && made->l_junction_count == 0);
    asj_detection_free(&made);
    for (long n = 1; n <= 4; n++) { /* the struct, the junctions, the L-junctions, the edges */
        const long live = counter.live;
        counter.fail_at = counter.calls + n;
        fill(hypotheses, 3);
        assert_int_equal(asj_result_fill(context, &three, 25, &made), ASJ_ERROR_MEMORY);
        assert_null(made);
        assert_int_equal(counter.live, live);
    }
    counter.fail_at = 0;
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_conversion), cmocka_unit_test(test_empty_and_without_l)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
