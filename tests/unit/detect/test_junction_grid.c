/* SPDX-License-Identifier: BSD-2-Clause */
/* Every junction stands once, in its cell, in order of index. */
#include "detect/junction_grid.h"
#include "unit_test.h"

enum { COUNT = 500, WIDTH = 200, HEIGHT = 130 };

static asj_hypothesis junctions[COUNT];

static void check(asj_context *context, size_t count)
{
    static int32_t seen[COUNT];
    asj_junction_grid grid;
    memset(seen, 0, sizeof seen);
    assert_int_equal(asj_junction_grid_make(context, junctions, count, WIDTH, HEIGHT, &grid), ASJ_OK);
    assert_int_equal(grid.columns, WIDTH / ASJ_GRID_CELL + 3);
    assert_int_equal(grid.rows, HEIGHT / ASJ_GRID_CELL + 3);
    assert_int_equal(grid.first[0], 0);
    assert_int_equal(grid.first[grid.columns * grid.rows], count);
    for (int32_t cell = 0; cell < grid.columns * grid.rows; cell++)
        for (int32_t k = grid.first[cell]; k < grid.first[cell + 1]; k++) {
            const asj_grid_place *place = &grid.places[k];
            const asj_hypothesis *h = &junctions[place->junction];
            assert_true(place->x == h->x && place->y == h->y && place->octave == asj_octave_index(h->octave));
            assert_int_equal(cell % grid.columns, asj_grid_cell(h->x, grid.columns));
            assert_int_equal(cell / grid.columns, asj_grid_cell(h->y, grid.rows));
            assert_true(k == grid.first[cell] || place->junction > grid.places[k - 1].junction);
            seen[place->junction]++;
        }
    for (size_t i = 0; i < count; i++)
        assert_int_equal(seen[i], 1);
    asj_junction_grid_free(context, &grid);
}

static void each_in_its_cell(void **state)
{
    static const double edges[] = {-10, -0.5, 0, ASJ_GRID_CELL, WIDTH - 1, WIDTH + 40};
    asj_context *context = NULL;
    synth_random random;
    (void)state;
    synth_random_seed(&random, 3);
    for (int32_t i = 0; i < COUNT; i++) {
        junctions[i].x = i < 6 ? edges[i] : synth_random_between(&random, -5, WIDTH + 5);
        junctions[i].y = i < 6 ? edges[5 - i] : synth_random_between(&random, -5, HEIGHT + 5);
        junctions[i].octave = i % 9 * 0.5 - 1;
    }
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    check(context, 0);
    check(context, 1);
    check(context, COUNT);
    asj_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(each_in_its_cell)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
