/* SPDX-License-Identifier: BSD-2-Clause */
/* Alignments that are known: one for each key, however many there are. */
#include "match/alignments.h"
#include "unit_test.h"

#define KEYS 5000

/* Every part of a key tells it from others. */
static asj_alignment_key key_of(int32_t k)
{
    asj_alignment_key key = {{1, 0, 0, 1}, 10, 20, 30, 40, 0, 6, {0, 0}};
    switch (k % 8) {
    case 0: key.linear[k / 8 % 4] += 1 + k; break;
    case 1: key.x += 1 + k; break;
    case 2: key.y += 1 + k; break;
    case 3: key.to_x += (float)(1 + k); break;
    case 4: key.to_y += (float)(1 + k); break;
    case 5: key.side = 1; key.x -= 1 + k; break;
    case 6: key.steps = (uint16_t)(7 + k); break;
    default: key.upsampled[k / 8 % 2] = 1; key.y -= 1 + k; break;
    }
    return key;
}

static void each_key_has_one_number(void **state)
{
    unit_fixture *f = *state;
    asj_alignments known = {NULL, NULL, 0, 0, 0};
    assert_int_equal(sizeof(asj_alignment_key) % sizeof(uint64_t), 0); /* the hash goes by whole words */
    for (int32_t k = 0; k < KEYS; k++) {
        const asj_alignment_key key = key_of(k);
        assert_int_equal(asj_alignments_reserve(f->context, &known, 1), ASJ_OK);
        assert_int_equal(asj_alignments_number(&known, &key, (uint32_t)(2 * k)), k);
    }
    assert_int_equal(known.count, KEYS);
    for (int32_t k = 0; k < KEYS; k++) {
        const asj_alignment_key key = key_of(k);
        assert_int_equal(asj_alignments_number(&known, &key, 1), k);
        assert_int_equal(known.list[k].first, 2 * k);
    }
    assert_int_equal(known.count, KEYS);
    asj_alignments_free(&f->context->memory, &known);
    assert_true(!known.list && !known.slots && known.count == 0);
}

/* What is known stays so. */
static void memory_runs_out(void **state)
{
    unit_fixture *f = *state;
    for (long n = 1, reached = 1; reached; n++) {
        asj_alignments known = {NULL, NULL, 0, 0, 0};
        const asj_alignment_key key = key_of(0);
        assert_int_equal(asj_alignments_reserve(f->context, &known, 1), ASJ_OK);
        asj_alignments_number(&known, &key, 3);
        f->counter.fail_at = f->counter.calls + n;
        const asj_status status = asj_alignments_reserve(f->context, &known, 1 << 20);
        reached = unit_reached(&f->counter);
        assert_int_equal(status, reached ? ASJ_ERROR_MEMORY : ASJ_OK);
        assert_int_equal(asj_alignments_number(&known, &key, 4), 0);
        assert_int_equal(known.list[0].first, 3);
        asj_alignments_free(&f->context->memory, &known);
    }
    if (sizeof(size_t) > sizeof(uint32_t)) {
        asj_alignments none = {NULL, NULL, 0, 0, 0};
        assert_int_equal(asj_alignments_reserve(f->context, &none, (size_t)UINT32_MAX + 1), ASJ_ERROR_MEMORY);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(each_key_has_one_number),
        cmocka_unit_test(memory_runs_out),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
