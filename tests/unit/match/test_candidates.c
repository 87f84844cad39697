/* SPDX-License-Identifier: BSD-2-Clause */
/* Lists of candidates: from pairs in any order, merged, found; against a table of all pairs. No memory, cancelling. */
#include "unit_test.h"
#include "match/pair_list.h"
#include "scene.h"

enum { I = 40, J = 60 };

static uint8_t in_first[I][J], in_second[I][J];

static void draw(uint64_t seed, int32_t count, uint8_t (*in)[J], asj_context *context, asj_pair_list *list)
{
    synth_random random;
    synth_random_seed(&random, seed);
    memset(in, 0, I * sizeof *in);
    *list = (asj_pair_list){NULL, 0, 0};
    for (int32_t n = 0; n < count; n++) {
        const uint32_t i = (uint32_t)synth_random_between(&random, 0, I), j = (uint32_t)synth_random_between(&random, 0, J);
        assert_int_equal(asj_pair_list_add(context, list, i, j), ASJ_OK);
        in[i][j] = 1;
    }
}

static void make(asj_context *context, uint64_t seed, int32_t count, uint8_t (*in)[J], size_t more, asj_candidates *candidates)
{
    asj_pair_list list;
    draw(seed, count, in, context, &list);
    assert_int_equal(asj_pair_list_candidates(context, &list, I, more, ASJ_STAGE_ALIGN, candidates), ASJ_OK);
    assert_int_equal(candidates->capacity, candidates->count + more);
    asj_release(&context->memory, list.pairs);
}

/* All pairs of the table, in order; `mark` tells which list one is of. */
static void assert_candidates(const asj_candidates *candidates, int of_both)
{
    size_t n = 0;
    for (uint32_t i = 0; i < I; i++)
        for (uint32_t j = 0; j < J; j++) {
            const asj_candidate *found = asj_candidates_find(candidates, i, j);
            if (!in_first[i][j] && !(of_both && in_second[i][j])) {
                assert_null(found);
                continue;
            }
            assert_true(n < candidates->count && found == &candidates->list[n]);
            assert_true(found->i == i && found->j == j && found->number == 0 && found->support == 0);
            assert_true(found->score == (in_first[i][j] ? 0 : 1));
            n++;
        }
    assert_int_equal(n, candidates->count);
    assert_null(asj_candidates_find(candidates, I, 0));
}

static void each_pair_once_in_order(void **state)
{
    unit_fixture *f = *state;
    for (uint64_t seed = 1; seed < 40; seed++) {
        asj_candidates first, second;
        make(f->context, seed, (int32_t)(seed * seed), in_first, 0, &first);
        assert_candidates(&first, 0);
        const size_t more = seed % 3 ? first.count : first.count - 1; /* of all others these are merged where they are */
        make(f->context, 100 + seed, (int32_t)(1600 / seed), in_second, more, &second);
        const asj_candidate *room = second.list;
        for (size_t k = 0; k < second.count; k++)
            second.list[k].score = 1;
        assert_int_equal(asj_candidates_merge(f->context, &first, &second, ASJ_STAGE_ALIGN), ASJ_OK);
        assert_candidates(&first, 1);
        assert_true((first.list == room) == (seed % 3 != 0) && (second.list == NULL) == (seed % 3 != 0));
        for (size_t k = 0; k < first.count; k += 2) { /* out of order, and back */
            const asj_candidate kept = first.list[k];
            first.list[k] = first.list[first.count - 1 - k];
            first.list[first.count - 1 - k] = kept;
        }
        asj_candidates_sort(&first);
        assert_candidates(&first, 1);
        assert_true((first.list == room) == (seed % 3 != 0) && (second.list == NULL) == (seed % 3 != 0));
        asj_release(&f->context->memory, first.list);
        asj_release(&f->context->memory, second.list);
    }
}

/* Two lists to merge, and pairs. */
typedef struct lists {
    asj_candidates first, second;
    asj_pair_list pairs;
} lists;

static void lists_make(asj_context *context, size_t more, lists *all)
{
    make(context, 7, 500, in_first, 0, &all->first);
    make(context, 8, 500, in_second, more, &all->second);
    draw(9, 500, in_second, context, &all->pairs);
}

static void lists_free(asj_context *context, const lists *all)
{
    asj_release(&context->memory, all->first.list);
    asj_release(&context->memory, all->second.list);
    asj_release(&context->memory, all->pairs.pairs);
}

static void without_memory_nothing_changes(void **state)
{
    unit_fixture *f = *state;
    asj_candidates none;
    lists all;
    lists_make(f->context, 0, &all);
    asj_memory_trim(&f->context->memory);
    for (long n = 1, reached = 1; reached; n++) {
        f->counter.fail_at = f->counter.calls + n;
        const asj_status status = asj_pair_list_candidates(f->context, &all.pairs, I, 0, ASJ_STAGE_ALIGN, &none);
        reached = unit_reached(&f->counter);
        assert_int_equal(status, reached ? ASJ_ERROR_MEMORY : ASJ_OK);
        assert_true((none.list == NULL) == (reached != 0) && (none.count > 0) == !reached);
        asj_release(&f->context->memory, none.list);
        asj_memory_trim(&f->context->memory);
    }
    f->counter.fail_at = f->counter.calls + 1;
    assert_int_equal(asj_candidates_merge(f->context, &all.first, &all.second, ASJ_STAGE_ALIGN), ASJ_ERROR_MEMORY);
    assert_true(unit_reached(&f->counter));
    assert_candidates(&all.first, 0);
    lists_free(f->context, &all);
}

static int32_t stop(void *user, int32_t stage, double done)
{
    (void)user;
    (void)done;
    assert_int_equal(stage, ASJ_STAGE_ALIGN);
    return 1;
}

static void it_can_be_cancelled(void **state)
{
    unit_fixture *f = *state;
    asj_candidates none;
    lists all;
    for (size_t more = 0; more <= 500; more += 500) {
        lists_make(f->context, more, &all);
        f->context->options.progress = stop;
        f->context->asked_ms = 0;
        assert_int_equal(asj_pair_list_candidates(f->context, &all.pairs, I, 0, ASJ_STAGE_ALIGN, &none), ASJ_ERROR_CANCELLED);
        assert_null(none.list);
        f->context->asked_ms = 0;
        assert_int_equal(asj_candidates_merge(f->context, &all.first, &all.second, ASJ_STAGE_ALIGN), ASJ_ERROR_CANCELLED);
        assert_candidates(&all.first, 0);
        f->context->options.progress = NULL;
        lists_free(f->context, &all);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(each_pair_once_in_order, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(without_memory_nothing_changes, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(it_can_be_cancelled, unit_set_up, unit_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
