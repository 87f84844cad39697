/* SPDX-License-Identifier: BSD-2-Clause */
#include "detect/close_grid.h"
#include "detect/suppress.h"
#include "unit_test.h"

static int before(const asj_hypothesis *p, const asj_hypothesis *q)
{
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa;
    return p->y != q->y ? p->y < q->y : p->x < q->x;
}

static size_t naive_suppress(asj_hypothesis *hypotheses, size_t count, asj_hypothesis *kept)
{
    size_t n = 0;
    for (size_t i = 0; i < count; i++)
        for (size_t k = i; k > 0 && before(&hypotheses[k], &hypotheses[k - 1]); k--) {
            const asj_hypothesis swap = hypotheses[k];
            hypotheses[k] = hypotheses[k - 1];
            hypotheses[k - 1] = swap;
        }
    for (size_t i = 0; i < count; i++) {
        int near = hypotheses[i].branch_count < 2;
        for (size_t k = 0; k < n; k++)
            near |= hypot(kept[k].x - hypotheses[i].x, kept[k].y - hypotheses[i].y) < fmax(3, 0.35 * kept[k].radius);
        if (!near)
            kept[n++] = hypotheses[i];
    }
    return n;
}

/* Also just outside the image, where line fits may end. */
static void test_close(void **state)
{
    enum { COUNT = 200 };
    static const int32_t sizes[][2] = {{100, 80}, {1, 1}, {11, 200}, {22, 22}, {300, 7}};
    static asj_hypothesis hypotheses[COUNT], copy[COUNT], expected[COUNT];
    synth_random random;
    (void)state;
    synth_random_seed(&random, 21);
    for (int round = 0; round < 50; round++) {
        const int32_t width = sizes[round % 5][0], height = sizes[round % 5][1];
        const size_t count = (size_t)(round * 4);
        memset(hypotheses, 0, sizeof hypotheses);
        for (size_t i = 0; i < count; i++) {
            hypotheses[i].x = synth_random_between(&random, -9, width + 9);
            hypotheses[i].y = synth_random_between(&random, -9, height + 9);
            hypotheses[i].radius = floor(synth_random_between(&random, 3, 31));
            hypotheses[i].branch_count = (int32_t)synth_random_between(&random, 0, 6);
            hypotheses[i].log_nfa = -floor(synth_random_between(&random, 0, 30));
        }
        memcpy(copy, hypotheses, sizeof copy);
        int32_t *cells = malloc(asj_close_grid_cells(count, width, height) * sizeof *cells);
        assert_non_null(cells);
        const size_t kept = asj_suppress(hypotheses, 0, count, width, height, cells);
        assert_int_equal(kept, naive_suppress(copy, count, expected));
        for (size_t i = 0; i < kept; i++)
            assert_memory_equal(&hypotheses[i], &expected[i], sizeof hypotheses[i]);
        free(cells);
    }
}

/* What an earlier choice has validated stays where it is and hides what is more meaningful; nothing else changes. */
static void test_validated(void **state)
{
    asj_hypothesis h[] = {{.x = 20, .y = 20, .radius = 7, .branch_count = 2, .log_nfa = -5},
                          {.x = 40, .y = 20, .radius = 7, .branch_count = 2, .log_nfa = -9},
                          {.x = 42, .y = 21, .radius = 7, .branch_count = 2, .log_nfa = -50},
                          {.x = 22, .y = 20, .radius = 7, .branch_count = 2, .log_nfa = -40},
                          {.x = 30, .y = 20, .radius = 7, .branch_count = 2, .log_nfa = -8},
                          {.x = 30, .y = 21, .radius = 7, .branch_count = 2, .log_nfa = -9}};
    static const double left[] = {-5, -9, -9};
    int32_t cells[400];
    (void)state;
    assert_true(asj_close_grid_cells(6, 60, 60) <= 400);
    assert_int_equal(asj_suppress(h, 2, 6, 60, 60, cells), 3);
    for (int i = 0; i < 3; i++)
        assert_true(h[i].log_nfa == left[i]);
    assert_true(h[2].x == 30 && h[2].y == 21);
}

/* What one junction hides, with and without px to spare: within 3 px of a small one, 0.35 radii of a large one. */
static void test_hides(void **state)
{
    static const double radii[] = {7, 14, 30}, spares[] = {0, 1, 2, 4};
    int32_t cells[400];
    (void)state;
    assert_true(asj_close_grid_cells(1, 60, 60) <= 400);
    for (int n = 0; n < 12; n++) {
        const asj_hypothesis one = {.x = 33.2, .y = 21.7, .radius = radii[n % 3], .branch_count = 2};
        const double spare = spares[n / 3], reach = fmax(3, 0.35 * one.radius) - spare;
        asj_close_grid grid = asj_close_grid_start(60, 60, cells);
        assert_false(asj_suppress_hides(&one, &grid, one.x, one.y, spare));
        asj_close_grid_add(&grid, asj_close_grid_cell(&grid, one.x, one.y), 0);
        assert_int_equal(asj_suppress_hides(&one, &grid, one.x, one.y, spare), reach > 0);
        for (int turn = 0; turn < 8 && reach > 0; turn++) {
            const double ux = cos(turn * UNIT_PI / 4), uy = sin(turn * UNIT_PI / 4);
            assert_true(asj_suppress_hides(&one, &grid, one.x + (reach - 0.01) * ux, one.y + (reach - 0.01) * uy, spare));
            assert_false(asj_suppress_hides(&one, &grid, one.x + (reach + 0.01) * ux, one.y + (reach + 0.01) * uy, spare));
        }
    }
}

/* Guesses of one corner: each branch is one of the other's too. */
static void test_twins(void **state)
{
    asj_hypothesis pair[2], back;
    asj_guess guesses[2];
    int32_t cells[400];
    (void)state;
    assert_true(asj_close_grid_cells(2, 60, 60) <= 400);
    for (int n = 0; n < 64; n++) {
        const double distance = n & 1 ? 1.4 : 1.6, turn = (n & 2 ? 9 : 11) * UNIT_PI / 180, moved = n & 4 ? 1.4 : 1.6;
        const int fewer = n >> 3 & 1, order = n >> 4 & 1, seam = n >> 5;
        memset(pair, 0, sizeof pair);
        for (int i = 0; i < 2; i++) {
            asj_hypothesis *h = &pair[i];
            h->x0 = 30;
            h->y = h->y0 = 30;
            h->radius = 7;
            h->first = 2 + i;
            h->log_nfa = i == order ? -20 : -10;
            h->branch_count = 3 - i * fewer;
            for (int b = 0; b < h->branch_count; b++) {
                asj_hypothesis_branch *branch = &h->branches[(b + i) % h->branch_count];
                branch->angle = fmod((seam ? 6.2 : 1) + 2 * b + i * turn, 2 * UNIT_PI);
                branch->offset = b - 0.7;
                branch->apart = b;
                branch->strength = b + 3.25;
            }
        }
        pair[order].x = 30 + moved; /* both, so that they are as far apart as before */
        pair[!order].x = 30 + moved + (order ? -distance : distance);
        const int twins = distance < 1.5 && turn < 10 * UNIT_PI / 180 && moved < 1.5 && !fewer;
        for (int i = 0; i < 2; i++)
            guesses[i] = asj_guess_of(&pair[i]);
        assert_int_equal(asj_guess_drop_twins(guesses, 2, 60, 60, cells), twins ? 1 : 2);
        asj_guess_restore(&guesses[0], &back); /* all that guesses change */
        assert_memory_equal(&back, &pair[order], sizeof back);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_validated), cmocka_unit_test(test_close), cmocka_unit_test(test_hides),
        cmocka_unit_test(test_twins),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
