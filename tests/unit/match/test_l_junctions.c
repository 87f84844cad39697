/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/locations.c and frames.c against the plain way to find the same: neighbours of locations, lengths of branches. */
#include "match/l_junctions_create.h"
#include "random.h"
#include "unit_test.h"

#include <math.h>

#define SIDE 300
#define COUNT 150

/* Corners on a lattice of 5 px, so that many are equally far from each other, or lie on one line. */
static void scatter(uint64_t seed, asj_junction *junctions)
{
    synth_random random;
    synth_random_seed(&random, seed);
    memset(junctions, 0, COUNT * sizeof *junctions);
    for (int32_t k = 0; k < COUNT; k++) {
        asj_junction *j = &junctions[k];
        j->x = 5 * (float)floor(synth_random_between(&random, 0, SIDE / 5));
        j->y = 5 * (float)floor(synth_random_between(&random, 0, SIDE / 5));
        j->branch_count = 2;
        j->branches[0].angle = (float)(floor(synth_random_between(&random, 0, 8)) * UNIT_PI / 4);
        j->branches[1].angle = j->branches[0].angle + (float)synth_random_between(&random, 0.5, 2.5);
        for (int32_t b = 0; b < 2; b++)
            j->branches[b].length = (float)synth_random_between(&random, 4, 150);
    }
}

static double square_between(const asj_l_junctions *all, uint32_t p, uint32_t q)
{
    const double dx = all->location_x[p] - all->location_x[q], dy = all->location_y[p] - all->location_y[q];
    return dx * dx + dy * dy;
}

/* Neighbour n of location p comes before every later one and every other location, ties by number, and none is missing. */
static void check_neighbours(const asj_l_junctions *all, uint32_t p, double separation)
{
    const uint32_t *neighbour = all->neighbour + (size_t)p * all->neighbour_limit;
    uint32_t before = 0, far = 0;
    for (uint32_t q = 0; q < all->location_count; q++)
        far += square_between(all, p, q) > separation * separation;
    assert_int_equal(all->neighbour_count[p], far < all->neighbour_limit ? far : all->neighbour_limit);
    for (uint32_t n = 0; n < all->neighbour_count[p]; n++, before = 0) {
        const double square = square_between(all, p, neighbour[n]);
        for (uint32_t q = 0; q < all->location_count; q++) {
            const double other = square_between(all, p, q);
            before += other > separation * separation && (other < square || (other == square && q < neighbour[n]));
        }
        assert_int_equal(before, n);
    }
}

static void neighbours_are_the_nearest(void **state)
{
    (void)state;
    asj_junction junctions[COUNT];
    asj_match_options options;
    asj_match_options_init(&options);
    for (int32_t limit = 1; limit <= 64; limit += 21)
        for (uint64_t seed = 1; seed <= 3; seed++) {
            unit_counter counter = {0, 0, 0, 0};
            asj_context *context = unit_context(&counter, 1);
            asj_l_junctions all;
            scatter(seed, junctions);
            const asj_image_junctions input = {junctions, seed == 3 ? 20 : COUNT, SIDE, SIDE, 1, 0};
            options.neighbours = limit;
            options.separation = seed == 1 ? 0 : 5.0 * (double)seed;
            assert_int_equal(asj_l_junctions_create(context, &options, &input, &all), ASJ_OK);
            for (uint32_t p = 0; p < all.location_count; p++)
                check_neighbours(&all, p, options.separation);
            asj_l_junctions_free(&context->memory, &all);
            unit_context_free(&counter, &context);
        }
}

/* The longest distance up to `most` of a location within 3 px of the branch; 0 = none. */
static double longest(const asj_l_junctions *all, uint32_t l, const double *u, double most)
{
    double best = 0;
    for (uint32_t q = 0; q < all->location_count; q++) {
        const double dx = all->location_x[q] - (double)all->l[l].x, dy = all->location_y[q] - (double)all->l[l].y;
        const double along = dx * u[0] + dy * u[1];
        if (along >= 10 && along <= most && fabs(dx * u[1] - dy * u[0]) < 3)
            best = along > best ? along : best;
    }
    return best;
}

static void lengths_are_those_of_junctions_on_the_branch(void **state)
{
    (void)state;
    asj_junction junctions[COUNT];
    asj_match_options options;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_l_junctions all;
    const asj_image_junctions input = {junctions, COUNT, SIDE, SIDE, 1, 0};
    int32_t found = 0;
    asj_match_options_init(&options);
    scatter(4, junctions);
    assert_int_equal(asj_l_junctions_create(context, &options, &input, &all), ASJ_OK);
    for (uint32_t b = 0; b < 2 * all.count; b++) {
        const asj_lengths *lengths = &all.lengths[b];
        double before = (double)lengths->length[0] - 8;
        for (int32_t n = 1; n < options.length_hypotheses && n <= lengths->count; n++, before -= 4) {
            const double next = longest(&all, b / 2, all.direction + 2 * (size_t)b, before);
            assert_true(n < lengths->count ? lengths->length[n] == (float)next : next <= 0);
            found += n < lengths->count;
            before = next;
        }
    }
    assert_true(found > COUNT / 2);
    asj_l_junctions_free(&context->memory, &all);
    unit_context_free(&counter, &context);
}

/* A location of another L-junction with a branch that is opposite to u to within 12 degrees. */
static int goes_on(const asj_l_junctions *all, uint32_t l, const double *u)
{
    for (uint32_t m = 0; m < all->count; m++)
        for (int32_t b = 0; b < 2 && m != l && all->location[m] == all->location[l]; b++) {
            const double *v = all->direction + 4 * (size_t)m + 2 * b;
            if (u[0] * v[0] + u[1] * v[1] < -0.978147601)
                return 1;
        }
    return 0;
}

/* A lattice of side^2 crossings, 15 px apart, each branch over a dozen others: frames of all lengths, or of the own ones alone. */
static uint32_t frames_of_lattice(asj_context *context, const asj_match_options *options, int32_t side, uint32_t *l_count)
{
    const size_t count = (size_t)side * (size_t)side;
    asj_junction *lattice = calloc(count, sizeof *lattice);
    asj_l_junctions all;
    assert_non_null(lattice);
    for (size_t k = 0; k < count; k++) {
        lattice[k].x = 15 * (float)(k % (size_t)side);
        lattice[k].y = 15 * (float)(k / (size_t)side);
        lattice[k].branch_count = 4;
        for (int32_t b = 0; b < 4; b++)
            lattice[k].branches[b] = (asj_branch){.angle = (float)(b * UNIT_PI / 2), .length = 200};
    }
    const asj_image_junctions input = {lattice, count, 15 * side, 15 * side, 1, 0};
    assert_int_equal(asj_l_junctions_create(context, options, &input, &all), ASJ_OK);
    const uint32_t frames = all.frame_count;
    *l_count = all.count;
    for (uint32_t k = 0; k < 2 * all.count && frames == all.count; k++)
        assert_true(all.lengths[k].count == 1 && all.lengths[k].length[0] == 200);
    asj_l_junctions_free(&context->memory, &all);
    free(lattice);
    return frames;
}

static void what_repeats_has_its_own_lengths_alone(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_options options;
    uint32_t l_count;
    asj_match_options_init(&options);
    uint32_t frames = frames_of_lattice(context, &options, 42, &l_count);
    assert_int_equal(l_count, 4 * 42 * 42);
    assert_in_range(frames, 8 * l_count, 0x10000);
    frames = frames_of_lattice(context, &options, 48, &l_count);
    assert_int_equal(l_count, 4 * 48 * 48);
    assert_int_equal(frames, l_count); /* 8 times as many they would be */
    unit_context_free(&counter, &context);
}

/* Twenty L-junctions share one location, six each of a dozen others; a third of the junctions has hardly any company. */
static void t_junctions_have_one_branch_that_goes_on(void **state)
{
    (void)state;
    asj_junction junctions[COUNT];
    asj_match_options options;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_l_junctions all;
    uint32_t found = 0;
    synth_random random;
    synth_random_seed(&random, 11);
    scatter(6, junctions);
    for (int32_t k = 0; k < 2 * COUNT / 3; k++) {
        junctions[k].x = 50 + 5 * (float)(k % 15 < 3 ? 0 : k % 15);
        junctions[k].y = 60;
        junctions[k].branches[1].angle = junctions[k].branches[0].angle + (float)synth_random_between(&random, 0.5, 2.5);
    }
    const asj_image_junctions input = {junctions, COUNT, SIDE, SIDE, 1, 0};
    asj_match_options_init(&options);
    assert_int_equal(asj_l_junctions_create(context, &options, &input, &all), ASJ_OK);
    for (uint32_t l = 0; l < all.count; l++) {
        const double *u = all.direction + 4 * (size_t)l;
        assert_int_equal(all.t_junction[l], goes_on(&all, l, u) != goes_on(&all, l, u + 2));
        found += all.t_junction[l];
    }
    assert_true(found > 10 && found < all.count - 10);
    asj_l_junctions_free(&context->memory, &all);
    unit_context_free(&counter, &context);
}

/* Fewer junctions of a coarse octave between the others are nobody's neighbours and lengthen no branch: others are as without. */
static void guests_change_nothing(void **state)
{
    (void)state;
    enum { GUESTS = COUNT - 10 };
    asj_junction alone[COUNT], guests[COUNT], both[COUNT + GUESTS];
    asj_match_options options;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_l_junctions all, some;
    asj_match_options_init(&options);
    scatter(8, alone);
    scatter(9, guests);
    for (int32_t k = 0; k < COUNT; k++)
        both[k < GUESTS ? 2 * k : k + GUESTS] = alone[k];
    for (int32_t k = 0; k < GUESTS; k++) {
        guests[k].x += 1; /* off the lattice: no location is shared */
        guests[k].octave = 1;
        both[2 * k + 1] = guests[k];
    }
    const asj_image_junctions input = {alone, COUNT, SIDE, SIDE, 1, 0}, crowd = {both, COUNT + GUESTS, SIDE, SIDE, 1, 0};
    assert_int_equal(asj_l_junctions_create(context, &options, &input, &some), ASJ_OK);
    assert_int_equal(asj_l_junctions_create(context, &options, &crowd, &all), ASJ_OK);
    assert_int_equal(all.home, 0);
    assert_int_equal(all.home_locations, some.location_count);
    for (uint32_t k = 0, l = 0; k < some.count; k++, l++) {
        while (asj_is_guest(&all, l))
            l++;
        const uint32_t p = some.location[k], q = all.location[l];
        for (uint32_t b = 0; b < 2; b++) {
            assert_int_equal(all.lengths[2 * l + b].count, some.lengths[2 * k + b].count);
            for (int32_t n = 0; n < some.lengths[2 * k + b].count; n++)
                assert_true(all.lengths[2 * l + b].length[n] == some.lengths[2 * k + b].length[n]);
        }
        assert_int_equal(all.neighbour_count[q], some.neighbour_count[p]);
        for (uint32_t n = 0; n < some.neighbour_count[p]; n++) {
            const uint32_t mine = some.neighbour[p * some.neighbour_limit + n], theirs = all.neighbour[q * all.neighbour_limit + n];
            assert_true(all.location_x[theirs] == some.location_x[mine] && all.location_y[theirs] == some.location_y[mine]);
        }
    }
    asj_l_junctions_free(&context->memory, &some);
    asj_l_junctions_free(&context->memory, &all);
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(neighbours_are_the_nearest),
        cmocka_unit_test(lengths_are_those_of_junctions_on_the_branch),
        cmocka_unit_test(what_repeats_has_its_own_lengths_alone),
        cmocka_unit_test(t_junctions_have_one_branch_that_goes_on),
        cmocka_unit_test(guests_change_nothing),
    };
    return cmocka_run_group_tests_name("l_junctions", tests, NULL, NULL);
}
