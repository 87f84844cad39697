/* SPDX-License-Identifier: BSD-2-Clause */
/* The counting, aligned allocations that everything else stands on. */
#include "core/context.h"
#include "unit_test.h"

static void test_alignment_and_counts(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    unsigned char *blocks[40];
    uint64_t last = 0;
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(blocks); i++) {
        blocks[i] = asj_allocate(&memory, i * 7, 3);
        assert_non_null(blocks[i]);
        assert_int_equal((uintptr_t)blocks[i] % ASJ_ALIGNMENT, 0);
        memset(blocks[i], (int)i, i * 21); /* the sanitizers watch the ends */
        assert_true(memory.now >= last + i * 21);
        last = memory.now;
    }
    assert_int_equal(counter.live, UNIT_COUNT(blocks));
    assert_true(memory.peak == memory.now);
    for (size_t i = 0; i < UNIT_COUNT(blocks); i++) {
        for (size_t k = 0; k < i * 21; k++)
            assert_int_equal(blocks[i][k], (unsigned char)i);
        asj_release(&memory, blocks[i]);
    }
    assert_int_equal(counter.live, 0);
    assert_true(memory.now == 0);
    assert_true(memory.peak == last);
}

static void test_zero(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    (void)state;
    unsigned char *dirty = asj_allocate(&memory, 1, 1000);
    assert_non_null(dirty);
    memset(dirty, 0xa5, 1000);
    asj_release(&memory, dirty);
    unsigned char *block = asj_allocate_zero(&memory, 10, 100);
    assert_non_null(block);
    for (size_t i = 0; i < 1000; i++)
        assert_int_equal(block[i], 0);
    asj_release(&memory, block);
    asj_release(&memory, NULL);
    assert_true(memory.now == 0);
}

/* Products that overflow never reach the allocator. */
static void test_overflow(void **state)
{
    static const size_t pairs[][2] = {{SIZE_MAX, 1}, {1, SIZE_MAX}, {SIZE_MAX / 2 + 1, 2}, {2, SIZE_MAX / 2 + 1},
                                      {SIZE_MAX, SIZE_MAX}, {SIZE_MAX - 8, 1},
                                      {(size_t)1 << (sizeof(size_t) * 4), (size_t)1 << (sizeof(size_t) * 4)}};
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(pairs); i++) {
        assert_null(asj_allocate(&memory, pairs[i][0], pairs[i][1]));
        assert_null(asj_allocate_zero(&memory, pairs[i][0], pairs[i][1]));
    }
    assert_int_equal(counter.calls, 0);
    assert_true(memory.now == 0 && memory.peak == 0);
}

static void test_failure(void **state)
{
    unit_counter counter = {0, 0, 1, 0};
    asj_memory memory = unit_memory(&counter);
    (void)state;
    assert_null(asj_allocate(&memory, 4, 4));
    assert_true(memory.now == 0 && memory.peak == 0);
    counter.fail_at = counter.calls + 1;
    assert_null(asj_allocate_zero(&memory, 4, 4));
    assert_int_equal(counter.live, 0);
}

static void test_grow(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    void *block = NULL;
    size_t capacity = 0;
    (void)state;
    for (size_t count = 1; count < 3000; count++) {
        assert_int_equal(asj_grow(&memory, &block, &capacity, count, sizeof(uint32_t), count - 1), ASJ_OK);
        assert_true(capacity >= count);
        ((uint32_t *)block)[count - 1] = (uint32_t)(count * 2654435761u);
    }
    for (size_t count = 1; count < 3000; count++)
        assert_int_equal(((uint32_t *)block)[count - 1], (uint32_t)(count * 2654435761u));
    assert_in_range(counter.calls, 5, 40); /* geometric */
    assert_int_equal(counter.live, 1);

    void *before = block;
    const size_t old = capacity;
    assert_int_equal(asj_grow(&memory, &block, &capacity, old, sizeof(uint32_t), old), ASJ_OK); /* enough already */
    assert_ptr_equal(block, before);
    counter.fail_at = counter.calls + 1;
    assert_int_equal(asj_grow(&memory, &block, &capacity, old + 1, sizeof(uint32_t), old), ASJ_ERROR_MEMORY);
    assert_ptr_equal(block, before);
    assert_int_equal(capacity, old);
    assert_int_equal(asj_grow(&memory, &block, &capacity, SIZE_MAX, sizeof(uint32_t), old), ASJ_ERROR_MEMORY);
    assert_int_equal(((uint32_t *)block)[17], (uint32_t)(18 * 2654435761u));
    asj_release(&memory, block);
    assert_true(memory.now == 0);
}

/* Not beyond what is known to be the most, unless more is asked for. */
static void test_grow_within(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    void *block = NULL;
    size_t capacity = 0;
    (void)state;
    asj_memory_open(&memory);
    for (size_t count = 1; count <= 1000; count++) {
        assert_int_equal(asj_grow_within(&memory, &block, &capacity, count, 1000, sizeof(uint32_t), count - 1), ASJ_OK);
        assert_in_range(capacity, count, 1000);
        ((uint32_t *)block)[count - 1] = (uint32_t)(count * 2654435761u);
    }
    assert_int_equal(asj_grow_within(&memory, &block, &capacity, 1001, 1000, sizeof(uint32_t), 1000), ASJ_OK);
    assert_int_equal(capacity, 1001);
    for (size_t count = 1; count <= 1000; count++)
        assert_int_equal(((uint32_t *)block)[count - 1], (uint32_t)(count * 2654435761u));
    asj_release(&memory, block);
    asj_memory_close(&memory);
    asj_memory_trim(&memory);
    assert_true(memory.now == 0);
}

/* Large blocks are not kept by asj_release_much(), nor what a list of asj_grow_within() has outgrown. */
static void test_much(void **state)
{
    const size_t mega = (size_t)1 << 20;
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    size_t capacity = 0;
    void *block = NULL;
    (void)state;
    asj_memory_open(&memory);
    void *small = asj_allocate(&memory, 3, mega), *five = asj_allocate(&memory, 5, mega), *six = asj_allocate(&memory, 6, mega);
    assert_true(small && five && six);
    asj_release_much(&memory, small);
    asj_release_much(&memory, five);
    asj_release(&memory, six);
    asj_release_much(&memory, NULL);
    assert_int_equal(counter.live, 2);
    assert_in_range(memory.now, 9 * mega, 10 * mega);
    assert_ptr_equal(asj_allocate(&memory, 3, mega), small);
    assert_ptr_equal(asj_allocate(&memory, 5, mega), six);
    assert_int_equal(counter.calls, 3);
    for (size_t count = 1; count <= 16; count++)
        assert_int_equal(asj_grow_within(&memory, &block, &capacity, count, 16, mega, count - 1), ASJ_OK);
    assert_in_range(memory.now, 25 * mega, 33 * mega); /* it and the two others, and what was smaller than 4 MB */
    asj_release(&memory, small);
    asj_release(&memory, six);
    asj_release_much(&memory, block);
    asj_memory_close(&memory);
    asj_memory_trim(&memory);
    assert_int_equal(counter.live, 0);
    assert_true(memory.now == 0);
}

/* While it is open: what is released comes back, if it is large enough and not far too large; after calls without use it goes. */
static void test_kept(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    (void)state;
    asj_memory_open(&memory);
    void *block = asj_allocate(&memory, 1000, 1), *other = asj_allocate(&memory, 3000, 1);
    assert_true(block && other);
    asj_release(&memory, block);
    asj_release(&memory, other);
    assert_int_equal(counter.live, 2);
    assert_ptr_equal(asj_allocate(&memory, 300, 3), block); /* the smaller one of two that fit */
    assert_ptr_equal(asj_allocate_zero(&memory, 990, 1), other);
    assert_true(((char *)other)[0] == 0 && ((char *)other)[989] == 0);
    assert_int_equal(counter.calls, 2);
    asj_release(&memory, block);
    void *small = asj_allocate(&memory, 10, 1);
    assert_ptr_not_equal(small, block);
    asj_memory_close(&memory);
    asj_release(&memory, other); /* closed: not kept */
    assert_int_equal(counter.live, 2);
    for (int call = 0; call < 20; call++) {
        asj_memory_open(&memory);
        asj_memory_close(&memory);
        assert_int_equal(counter.live, call < 7 ? 2 : 1);
    }
    asj_memory_open(&memory);
    asj_release(&memory, small);
    asj_memory_open(&memory); /* inside another */
    asj_memory_close(&memory);
    assert_int_equal(counter.live, 1);
    counter.fail_at = counter.calls + 1;
    block = asj_allocate(&memory, 5000, 1); /* refused; once more without what is kept */
    assert_non_null(block);
    assert_int_equal(counter.live, 1);
    asj_release(&memory, block);
    asj_memory_close(&memory);
    asj_memory_trim(&memory);
    assert_int_equal(counter.live, 0);
    assert_true(memory.now == 0);
}

/* A list has room for half as many again when it will be kept. */
static void test_list(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_memory memory = unit_memory(&counter);
    (void)state;
    asj_memory_open(&memory);
    asj_release(&memory, asj_allocate_list(&memory, 100, 24));
    asj_release(&memory, asj_allocate_list(&memory, 150, 24));
    assert_int_equal(counter.calls, 1);
    asj_release(&memory, asj_allocate_list(&memory, 170, 24));
    assert_int_equal(counter.calls, 2);
    assert_null(asj_allocate_list(&memory, SIZE_MAX / 24, 24));
    assert_null(asj_allocate_list(&memory, SIZE_MAX, 1));
    assert_int_equal(counter.calls, 2);
    asj_memory_close(&memory);
    asj_memory_trim(&memory);
    assert_int_equal(counter.live, 0);
}

/* Kept blocks of the default allocator share large pages, up to a few; the others stand by themselves. */
static void test_shelves(void **state)
{
    enum { MOST = 150 };
    asj_memory memory = {{NULL, NULL, NULL}, 0, 0, NULL, 0, 0, NULL, 0, 0};
    unsigned char *blocks[MOST];
    (void)state;
    assert_int_equal(asj_memory_allocator(NULL, &memory.allocator), 1);
    for (int round = 0; round < 4; round++) {
        asj_memory_share(&memory, round > 0 ? 1 : 0);
        asj_memory_open(&memory);
        for (size_t i = 0; i < MOST; i++) {
            const size_t size = 1000 + 1800 * i;
            blocks[i] = asj_allocate(&memory, size, 1);
            assert_non_null(blocks[i]);
            assert_int_equal((uintptr_t)blocks[i] % ASJ_ALIGNMENT, 0);
            memset(blocks[i], (int)i, size);
        }
        for (size_t i = 0; i < MOST; i++) {
            assert_int_equal(blocks[i][0], (unsigned char)i);
            assert_int_equal(blocks[i][999 + 1800 * i], (unsigned char)i);
            asj_release(&memory, blocks[i]);
        }
        asj_memory_close(&memory);
        assert_int_equal(memory.shelf_count, round > 0 ? 4 : 0); /* of the 10 that all would need */
        assert_int_equal(memory.shelves != NULL, round > 0);
        if (round != 1)
            asj_memory_trim(&memory);
        assert_true(round == 1 || (memory.now == 0 && !memory.shelves));
    }
    asj_memory_trim(&memory);
    assert_true(memory.now == 0 && !memory.shelves);
}

/* The first large pages have room for a large block too, and again when that has been given back. */
static void test_large_on_shelf(void **state)
{
    enum { SMALL = 100000, LARGE = 4 << 20, ALL = 6 << 20 };
    asj_memory memory = {{NULL, NULL, NULL}, 0, 0, NULL, 0, 0, NULL, 0, 0};
    (void)state;
    assert_int_equal(asj_memory_allocator(NULL, &memory.allocator), 1);
    asj_memory_share(&memory, ALL - 1000);
    asj_memory_open(&memory);
    unsigned char *small = asj_allocate(&memory, SMALL, 1);
    for (int round = 0; round < 3; round++) {
        unsigned char *large = asj_allocate(&memory, LARGE, 1), *other = asj_allocate(&memory, LARGE, 1);
        assert_true(small && large && other);
        memset(small, 1, SMALL);
        memset(large, 2, LARGE);
        memset(other, 3, LARGE);
        assert_true(small[0] == 1 && small[SMALL - 1] == 1 && large[0] == 2 && large[LARGE - 1] == 2);
        assert_int_equal(memory.shelf_count, 1);
        assert_true(memory.now > ALL + LARGE && memory.now < ALL + LARGE + 1000);
        asj_release(&memory, round == 1 ? other : large);
        asj_release(&memory, round == 1 ? large : other);
        asj_memory_trim(&memory);
        assert_int_equal(memory.now, ALL);
    }
    asj_release(&memory, small);
    asj_memory_close(&memory);
    asj_memory_trim(&memory);
    assert_true(memory.now == 0 && !memory.shelves);
}

/* A list that grows from call to call leaves no block behind. */
static void test_outgrown(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    uint64_t before, now;
    (void)state;
    asj_context_memory(context, &before, NULL);
    for (size_t bytes = 100000; bytes < 1000000; bytes += bytes / 2) {
        asj_memory_open(&context->memory);
        void *list = asj_allocate(&context->memory, bytes, 1);
        assert_non_null(list);
        asj_release(&context->memory, list);
        asj_memory_close(&context->memory);
        asj_context_memory(context, &now, NULL);
        assert_true(now >= before + bytes && now <= before + bytes + 1000);
    }
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_alignment_and_counts), cmocka_unit_test(test_zero), cmocka_unit_test(test_overflow),
        cmocka_unit_test(test_failure),              cmocka_unit_test(test_grow),
        cmocka_unit_test(test_grow_within),          cmocka_unit_test(test_much),
        cmocka_unit_test(test_kept),                 cmocka_unit_test(test_outgrown),
        cmocka_unit_test(test_list),                 cmocka_unit_test(test_shelves),
        cmocka_unit_test(test_large_on_shelf),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
