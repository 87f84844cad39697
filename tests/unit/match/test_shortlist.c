/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/shortlist.c, subset.c: with very many L-junctions the most meaningful ones are listed, as if there were no others. */
#include "match/compare.h"
#include "match/shortlist.h"
#include "random_pair.h"

#define JUNCTIONS 80
#define LISTED 50

static random_pair pair;

/* Fresh values, of which four L-junctions in a row have the same. */
static void make(asj_context *context, uint64_t seed)
{
    asj_match_options options;
    synth_random random;
    asj_match_options_init(&options);
    random_pair_create(context, seed, JUNCTIONS, &options, &pair);
    synth_random_seed(&random, seed);
    for (int32_t n = 0; n < 2; n++) {
        asj_l_junctions *all = &pair.image[n].l_junctions;
        assert_true(all->count > 3 * LISTED);
        for (uint32_t i = 0; i < all->count; i++)
            all->log10_nfa[i] = i % 4 ? all->log10_nfa[i - 1] : (float)-synth_random_between(&random, 1, 100);
    }
}

static uint32_t count_below(const asj_l_junctions *all, float log10_nfa)
{
    uint32_t below = 0;
    for (uint32_t k = 0; k < all->count; k++)
        below += all->log10_nfa[k] < log10_nfa;
    return below;
}

/* Is L-junction i among the LISTED most meaningful ones, or as good as the last of them? */
static int is_listed(int32_t side, uint32_t i)
{
    const asj_l_junctions *all = &pair.image[side].l_junctions;
    return count_below(all, all->log10_nfa[i]) < LISTED;
}

static int is_candidate(uint32_t i, uint32_t j)
{
    for (size_t k = 0; k < pair.run.candidates.count; k++)
        if (pair.run.candidates.list[k].i == i && pair.run.candidates.list[k].j == j)
            return 1;
    return 0;
}

/* The best partner of L-junction i of image `side`, of those that are listed. */
static uint32_t best_partner(int32_t side, uint32_t i)
{
    uint32_t best = UINT32_MAX;
    int32_t most = INT32_MIN;
    for (uint32_t j = 0; j < pair.image[1 - side].l_junctions.count; j++) {
        const int32_t score = asj_score_pair(&pair.run, side ? j : i, side ? i : j).score;
        if (is_listed(1 - side, j) && score > most) {
            most = score;
            best = j;
        }
    }
    return best;
}

static void very_many_list_the_most_meaningful(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (uint64_t seed = 1; seed <= 3; seed++) {
        make(context, seed);
        pair.run.most_listed = LISTED;
        assert_int_equal(asj_shortlist(&pair.run), ASJ_OK);
        assert_true(pair.run.candidates.count > LISTED);
        for (size_t k = 0; k < pair.run.candidates.count; k++)
            assert_true(is_listed(0, pair.run.candidates.list[k].i) && is_listed(1, pair.run.candidates.list[k].j));
        uint32_t listed = 0;
        for (int32_t side = 0; side < 2; side++)
            for (uint32_t i = 0; i < pair.image[side].l_junctions.count; i++)
                if (is_listed(side, i)) {
                    const uint32_t j = best_partner(side, i);
                    assert_true(is_candidate(side ? j : i, side ? i : j));
                    listed++;
                }
        assert_true(listed >= 2 * LISTED && listed < 2 * LISTED + 8); /* equals of the last one */
        random_pair_free(&pair);
    }
    unit_context_free(&counter, &context);
}

static void all_are_listed_where_that_is_allowed(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    size_t counts[3];
    (void)state;
    for (int32_t n = 0; n < 3; n++) {
        make(context, 4);
        const uint32_t most[3] = {0, pair.image[0].l_junctions.count + pair.image[1].l_junctions.count, LISTED};
        pair.run.most_listed = most[n];
        assert_int_equal(asj_shortlist(&pair.run), ASJ_OK);
        counts[n] = pair.run.candidates.count;
        random_pair_free(&pair);
    }
    assert_int_equal(counts[0], counts[1]);
    assert_true(counts[2] < counts[0]);
    unit_context_free(&counter, &context);
}

static void threads_change_nothing(void **state)
{
    asj_candidate *lists[2] = {NULL, NULL};
    size_t counts[2];
    (void)state;
    for (int32_t n = 0; n < 2; n++) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, n == 0 ? 1 : 3);
        make(context, 5);
        pair.run.most_listed = LISTED;
        assert_int_equal(asj_shortlist(&pair.run), ASJ_OK);
        counts[n] = pair.run.candidates.count;
        lists[n] = calloc(counts[n], sizeof **lists);
        assert_non_null(lists[n]);
        memcpy(lists[n], pair.run.candidates.list, counts[n] * sizeof **lists);
        random_pair_free(&pair);
        unit_context_free(&counter, &context);
    }
    assert_int_equal(counts[0], counts[1]);
    assert_memory_equal(lists[0], lists[1], counts[0] * sizeof **lists);
    free(lists[0]);
    free(lists[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(very_many_list_the_most_meaningful),
        cmocka_unit_test(all_are_listed_where_that_is_allowed),
        cmocka_unit_test(threads_change_nothing),
    };
    return cmocka_run_group_tests_name("shortlist", tests, NULL, NULL);
}
