/* SPDX-License-Identifier: BSD-2-Clause */
/* Which corners stay: by the sum of steady.c, here written out once more. */
#include "detect/steady.h"
#include "core/context.h"
#include "detect/strip.h"
#include "detect/tilt.h"
#include "parallelogram.h"

typedef unit_fixture fixture;

static int set_up(void **state)
{
    return set_up_parallelogram(state, 100);
}

/* Slats, an edge every 6 px, that run along x and end at something upright: x = 29.5, where one of them begins at y = 59.8. */
static int set_up_slats(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, SIZE, SIZE, 100);
    for (int y = 0; y < SIZE; y += 12)
        synth_add_rectangle(&scene, (synth_point){-10, y - 0.2}, SIZE + 20, 6, 0, 160);
    synth_add_rectangle(&scene, (synth_point){-10, -10}, 39.5, SIZE + 20, 0, 130);
    return unit_set_up_scene(state, &scene, 1, 2);
}

/* Side b of the corner, turned. */
static asj_hypothesis_branch side(int b, double turn)
{
    asj_hypothesis_branch branch;
    memset(&branch, 0, sizeof branch);
    branch.angle = angles[b] + turn;
    branch.length = sides[b];
    return branch;
}

/* The n-th of many corners that differ in everything that counts. */
static asj_hypothesis corner(int n)
{
    asj_hypothesis hypothesis;
    memset(&hypothesis, 0, sizeof hypothesis);
    hypothesis.x = corner_x;
    hypothesis.y = corner_y;
    hypothesis.x0 = corner_x + 0.35 * (n % 17);
    hypothesis.y0 = corner_y;
    hypothesis.log_nfa = -(n % 37) * ASJ_LN_10;
    hypothesis.location_variance = exp(2 * (0.3 * (n % 19) - 4));
    hypothesis.branch_count = 2;
    hypothesis.branches[0] = side(0, 0.02 * (n % 5));
    hypothesis.branches[1] = side(1, 0.06 * (n % 11));
    hypothesis.branches[0].log_nfa = -(n % 13) * ASJ_LN_10;
    hypothesis.branches[1].log_nfa = -(n % 23) * ASJ_LN_10;
    return hypothesis;
}

static asj_strip strip_of(const fixture *f, const asj_hypothesis *hypothesis, int b)
{
    const asj_strip_line line = {hypothesis->x, hypothesis->y, hypothesis->branches[b].angle, hypothesis->branches[b].length};
    return asj_strip_test(f->context, &f->frame, &f->options, &line);
}

static double between(double value, double least, double most)
{
    return value < least ? least : value > most ? most : value;
}

/* Of the strip's gradients the slope and the correlation, multiplied, in units of six degrees. */
static double tilt_of(const asj_strip *strip)
{
    const asj_strip_sums *s = &strip->sums;
    return fabs(s->un / s->nn) * fabs(s->un) / sqrt(s->uu * s->nn) / tan(6 * ASJ_DEGREE);
}

static double naive_sum(const fixture *f, const asj_hypothesis *hypothesis)
{
    const asj_hypothesis_branch *a = &hypothesis->branches[0], *b = &hypothesis->branches[1];
    const asj_strip p = strip_of(f, hypothesis, 0), q = strip_of(f, hypothesis, 1);
    const double isotropic = between(-hypothesis->log_nfa / ASJ_LN_10, -10, 30);
    const double strip = between(fmin(-a->log_nfa, -b->log_nfa) / ASJ_LN_10, -3, 15);
    const double uncertain = between(log(sqrt(hypothesis->location_variance)), -3.5, 0.7);
    const double near = between(fmin(p.near_strength, q.near_strength), -2, 5);
    const double share = between(fmin(p.near_share, q.near_share), 0, 1);
    const double tilt = between(fmax(tilt_of(&p), tilt_of(&q)), 0, 3);
    const double turn = sin(b->angle - a->angle), moved = between(hypothesis->x0 - hypothesis->x, 0, 5);
    if (f->frame.octave <= 0)
        return -2 + 0.06 * isotropic + 0.12 * strip - 0.4 * uncertain + 0.14 * near - 0.9 * tilt + 0.9 * turn - 0.2 * moved;
    const double sum = -4.05 + 0.03 * strip - uncertain + 0.25 * near + 3 * share - 0.8 * tilt + 1.5 * turn - 0.25 * moved;
    return f->frame.octave >= 2 ? sum - 1 : sum;
}

static void test_sum(void **state)
{
    fixture *f = *state;
    for (int octave = -1; octave <= 2; octave++) {
        int stay = 0, go = 0;
        f->frame.octave = octave;
        for (int n = 0; n < 2000; n++) {
            asj_hypothesis hypothesis = corner(n);
            const double sum = naive_sum(f, &hypothesis);
            if (fabs(sum) < 1e-9)
                continue;
            asj_keep_steady(f->context, &f->frame, &f->options, NULL, &hypothesis);
            assert_int_equal(hypothesis.branch_count, sum > 0 ? 2 : 0);
            stay += sum > 0;
            go += sum < 0;
        }
        assert_true(stay > 100 && go > 100);
    }
    f->frame.octave = 0;
}

/* A branch that crosses slats counts as one of two only where all else is beyond doubt, and goes when a corner stays without it;
 * where no tilt is asked of branches it does not matter. */
static void test_tilted(void **state)
{
    fixture *f = *state;
    static const double directions[3] = {0, 0.17, 0.5 * UNIT_PI}; /* along a slat, across some, along the upright edge */
    asj_hypothesis hypothesis = corner(0);
    hypothesis.x = hypothesis.x0 = 29.5;
    hypothesis.y = hypothesis.y0 = 59.8;
    hypothesis.log_nfa = -20 * ASJ_LN_10;
    hypothesis.location_variance = 1;
    hypothesis.branch_count = 3;
    for (int b = 0; b < 3; b++) {
        hypothesis.branches[b].angle = directions[b];
        hypothesis.branches[b].length = 40;
        hypothesis.branches[b].log_nfa = b == 1 ? 0 : -20 * ASJ_LN_10;
    }
    const asj_strip across = strip_of(f, &hypothesis, 1);
    assert_true(asj_is_tilted(&f->options, &across.sums));
    asj_hypothesis sure = hypothesis, untold = hypothesis;
    asj_keep_steady(f->context, &f->frame, &f->options, NULL, &hypothesis);
    assert_int_equal(hypothesis.branch_count, 2);
    assert_true(hypothesis.branches[0].angle == directions[0] && hypothesis.branches[1].angle == directions[2]);
    sure.location_variance = 1e-3;
    sure.branches[1].log_nfa = -40 * ASJ_LN_10;
    asj_keep_steady(f->context, &f->frame, &f->options, NULL, &sure);
    assert_int_equal(sure.branch_count, 3);
    f->options.max_tilt = 0;
    asj_keep_steady(f->context, &f->frame, &f->options, NULL, &untold);
    assert_int_equal(untold.branch_count, 3);
    asj_detect_options_init(&f->options);
}

/* Without two branches that open there is no corner. */
static void test_no_opening(void **state)
{
    const fixture *f = *state;
    asj_hypothesis hypothesis = corner(18);
    hypothesis.branches[1] = hypothesis.branches[0];
    asj_keep_steady(f->context, &f->frame, &f->options, NULL, &hypothesis);
    assert_int_equal(hypothesis.branch_count, 0);
}

int main(void)
{
    const struct CMUnitTest weak[] = {cmocka_unit_test(test_sum), cmocka_unit_test(test_no_opening)};
    const struct CMUnitTest slats[] = {cmocka_unit_test(test_tilted)};
    return cmocka_run_group_tests(weak, set_up, unit_tear_down) + cmocka_run_group_tests(slats, set_up_slats, unit_tear_down);
}
