/* SPDX-License-Identifier: BSD-2-Clause */
/* The nearest locations, all within a radius, and the last one that a branch passes, against all of them asked one by one. */
#include "match/location_grid.h"
#include "unit_test.h"
#include "core/context.h"

enum { MOST = 600, ASKED = 12 };

static asj_location_place places[MOST];

/* Some at places of whole pixels, so that distances are equal, and some beside others. */
static void scatter(synth_random *random, uint32_t count, double width, double height)
{
    for (uint32_t p = 0; p < count; p++) {
        asj_location_place *place = &places[p];
        *place = (asj_location_place){synth_random_between(random, -20, width), synth_random_between(random, -20, height), p};
        if (p % 3 == 0)
            place->x = floor(place->x), place->y = floor(place->y);
        if (p % 10 == 9)
            place->x = places[p - 1].x + 0.25, place->y = places[p - 1].y;
    }
}

static uint32_t naive_nearest(uint32_t all, double x, double y, double separation, uint32_t *out)
{
    uint32_t count = 0;
    double before = -1;
    for (uint32_t k = 0; k < ASKED; k++) {
        double best = HUGE_VAL;
        uint32_t found = UINT32_MAX;
        for (uint32_t p = 0; p < all; p++) {
            const double dx = places[p].x - x, dy = places[p].y - y, square = dx * dx + dy * dy;
            int taken = 0;
            for (uint32_t n = 0; n < count; n++)
                taken |= out[n] == p;
            if (!taken && (separation < 0 || square > separation * separation) && square >= before && square < best) {
                best = square;
                found = p;
            }
        }
        if (found == UINT32_MAX)
            break;
        out[count++] = found;
        before = best;
    }
    return count;
}

static void check_within(const asj_location_grid *grid, uint32_t all, double x, double y, double radius)
{
    uint32_t found[MOST], count = 0;
    const uint32_t given = asj_location_grid_within(grid, x, y, radius, MOST, found);
    for (uint32_t p = 0; p < all; p++) {
        const double dx = places[p].x - x, dy = places[p].y - y;
        if (dx * dx + dy * dy > radius * radius)
            continue;
        assert_true(count < given && found[count] == p);
        count++;
    }
    assert_int_equal(given, count);
    if (count > 0)
        assert_int_equal(asj_location_grid_within(grid, x, y, radius, count - 1, found), count);
}

static double naive_last(uint32_t all, double x, double y, const double u[2], double most)
{
    double last = 0;
    for (uint32_t p = 0; p < all; p++) {
        const double dx = places[p].x - x, dy = places[p].y - y, along = dx * u[0] + dy * u[1];
        if (along >= 10 && along <= most && along > last && fabs(dx * u[1] - dy * u[0]) < 3)
            last = along;
    }
    return last;
}

static void against_all(void **state)
{
    static const double sizes[][2] = {{300, 200}, {2000, 30}, {-20, 400}, {40, 40}, {5000, 4000}};
    asj_context *context = NULL;
    synth_random random;
    int passed = 0;
    (void)state;
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    synth_random_seed(&random, 5);
    for (uint32_t round = 0; round < 60; round++) {
        const double *size = sizes[round % 5];
        const uint32_t all = round < 5 ? round : round * 10;
        asj_location_grid grid;
        scatter(&random, all, size[0], size[1]);
        assert_int_equal(asj_location_grid_make(&context->memory, places, all, &grid), ASJ_OK);
        for (uint32_t k = 0; k < 60; k++) {
            const int of_one = k % 2 && all > 0;
            const uint32_t p = of_one ? k % all : 0;
            const double x = of_one ? places[p].x : synth_random_between(&random, -100, size[0] + 100);
            const double y = of_one ? places[p].y : synth_random_between(&random, -100, size[1] + 100);
            const double angle = k % 5 == 0 ? k / 5 % 4 * UNIT_PI / 2 : synth_random_between(&random, 0, 2 * UNIT_PI);
            const double u[2] = {cos(angle), sin(angle)}, most = synth_random_between(&random, 5, 1.5 * (size[0] + size[1] + 60));
            const double separation = k % 3 - 1 ? 6 : -1;
            uint32_t found[ASKED], wanted[ASKED];
            const uint32_t count = asj_location_grid_nearest(&grid, x, y, separation, ASKED, found);
            assert_int_equal(count, naive_nearest(all, x, y, separation, wanted));
            assert_memory_equal(found, wanted, count * sizeof *found);
            check_within(&grid, all, x, y, k % 4 * 15.0 + 1);
            const double last = asj_location_grid_last(&grid, x, y, u, 10, most, 3);
            assert_true(last == naive_last(all, x, y, u, most));
            passed += last > 0;
        }
        asj_location_grid_free(&context->memory, &grid);
    }
    assert_true(passed > 500);
    asj_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(against_all)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
