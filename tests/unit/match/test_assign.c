/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/assign.c against the rules in front of it, evaluated candidate by candidate over the whole list. */
#include "match/assign.h"
#include "match/consensus.h"
#include "random_pair.h"

static random_pair pair;

static const asj_candidate *candidate(size_t k)
{
    return &pair.run.candidates.list[k];
}

static int same_location(size_t k, size_t m, int32_t side)
{
    const uint32_t *location = pair.image[side].l_junctions.location;
    return location[asj_candidate_l(candidate(k), side)] == location[asj_candidate_l(candidate(m), side)];
}

static int better(size_t k, size_t m)
{
    return candidate(k)->score > candidate(m)->score || (candidate(k)->score == candidate(m)->score && k < m);
}

/* The point of the other image that the candidate says is the location of its L-junction in image `side`. From image 1, with
 * p1 + move1 -> p2 + move2 under the map A: p1 -> p2 + move2 - A move1. From image 2 the same with the inverse. */
static void partner_of(size_t k, int32_t side, double at[2])
{
    const asj_candidate *c = candidate(k);
    const asj_l_junction *l = side == 0 ? &pair.image[1].l_junctions.l[c->j] : &pair.image[0].l_junctions.l[c->i];
    const double *a = side == 0 ? c->map.to : c->map.from, *mine = side == 0 ? c->move1 : c->move2;
    const double *theirs = side == 0 ? c->move2 : c->move1;
    at[0] = (double)l->x + theirs[0] - (a[0] * mine[0] + a[1] * mine[1]);
    at[1] = (double)l->y + theirs[1] - (a[2] * mine[0] + a[3] * mine[1]);
}

/* Is it the best of its location, and what is the best score of those that mean another point? */
static int is_best(size_t k, int32_t side, double *second)
{
    double at[2], to[2];
    partner_of(k, side, at);
    *second = 0;
    for (size_t m = 0; m < pair.run.candidates.count; m++) {
        if (m == k || !same_location(k, m, side))
            continue;
        if (better(m, k))
            return 0;
        partner_of(m, side, to);
        if (hypot(to[0] - at[0], to[1] - at[1]) > pair.options.separation)
            *second = fmax(*second, (double)candidate(m)->score);
    }
    return 1;
}

/* Does it pass on its own; *ratio as the result has it. */
static int passes(size_t k, double *ratio)
{
    const asj_candidate *c = candidate(k);
    double second1, second2 = 0;
    if (!is_best(k, 0, &second1) || (pair.options.mutual && !is_best(k, 1, &second2)))
        return 0;
    const double second = fmax(second1, second2);
    *ratio = second > 0 ? (double)c->score / second : HUGE_VAL;
    return c->score > 0 && *ratio >= pair.options.ratio && c->support >= asj_needed_support(&pair.run);
}

/* Of several that pass and stand at one location of image 2 the best one is chosen. */
static int chosen(size_t k, double *ratio)
{
    double other;
    if (!passes(k, ratio))
        return 0;
    for (size_t m = 0; m < pair.run.candidates.count; m++)
        if (m != k && same_location(k, m, 1) && better(m, k) && passes(m, &other))
            return 0;
    return 1;
}

static const asj_choice *find(size_t k)
{
    const asj_choice *found = NULL;
    for (size_t n = 0; n < pair.run.choices.count; n++)
        if (pair.run.choices.list[n].candidate == k) {
            assert_null(found); /* no candidate is chosen twice */
            found = &pair.run.choices.list[n];
        }
    return found;
}

static void choices_are_those_of_the_rules(void **state)
{
    (void)state;
    asj_match_options options;
    size_t total = 0, dropped = 0;
    asj_match_options_init(&options);
    options.ratio = 1.25;
    options.minimum_support = 1;
    for (int round = 0; round < 12; round++) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, 1);
        options.mutual = round % 2;
        options.separation = round % 3 == 0 ? 0 : round % 3 == 1 ? 6 : 40;
        random_pair_create(context, (uint64_t)round + 1, 60, &options, &pair);
        random_pair_candidates((uint64_t)round + 50, 1 + round % 3, &pair);
        for (int again = 0; again < 2; again++) /* choices of before do not matter */
            assert_int_equal(asj_assign(&pair.run), ASJ_OK);
        for (size_t k = 0; k < pair.run.candidates.count; k++) {
            double ratio = 0;
            const asj_choice *choice = find(k);
            const int wanted = chosen(k, &ratio);
            assert_int_equal(choice != NULL, wanted);
            assert_true(!wanted || choice->ratio == (float)ratio || fabs((double)choice->ratio - ratio) < 1e-6 * ratio);
            total += (size_t)wanted;
            dropped += (size_t)(!wanted && passes(k, &ratio));
        }
        random_pair_free(&pair);
        unit_context_free(&counter, &context);
    }
    assert_true(total > 100 && dropped > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(choices_are_those_of_the_rules),
    };
    return cmocka_run_group_tests_name("assign", tests, NULL, NULL);
}
