/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_sort(): every length and size of elements, orders that are hard for quicksort, nothing lost, no order that takes long. */
#include "unit_test.h"
#include "core/nth_smallest.h"
#include "core/sort.h"

#include <math.h>

enum { MOST = 4096, LARGEST = 200 };

static unsigned char elements[MOST * LARGEST], again[MOST * LARGEST];
static long compared;

/* Keys are the first byte, and the second where there is one. */
static int key_of(const unsigned char *element, size_t size)
{
    return size == 1 ? element[0] : element[0] << 8 | element[1];
}

static int by_byte(const void *a, const void *b)
{
    compared++;
    return key_of(a, 1) - key_of(b, 1);
}

static int by_two(const void *a, const void *b)
{
    compared++;
    return key_of(a, 2) - key_of(b, 2);
}

static void put(size_t at, size_t size, int key)
{
    unsigned char *element = elements + at * size;
    for (size_t k = 0; k < size; k++)
        element[k] = (unsigned char)(7 * at + k);
    element[0] = (unsigned char)(size == 1 ? key & 255 : key >> 8);
    if (size > 1)
        element[1] = (unsigned char)key;
}

/* A number for each set of elements, whatever their order. */
static uint64_t set_of(size_t count, size_t size)
{
    uint64_t sum = 0;
    for (size_t n = 0; n < count; n++) {
        uint64_t one = 14695981039346656037u;
        for (size_t k = 0; k < size; k++)
            one = (one ^ elements[n * size + k]) * 1099511628211u;
        sum += one * one;
    }
    return sum;
}

static void sort_and_check(size_t count, size_t size)
{
    const uint64_t before = set_of(count, size);
    const double least = count > 1 ? (double)count * log2((double)count) : 1;
    memcpy(again, elements, count * size);
    compared = 0;
    asj_sort(elements, count, size, size == 1 ? by_byte : by_two);
    assert_true((double)compared <= 5 * least + 60);
    assert_true(set_of(count, size) == before);
    for (size_t n = 1; n < count; n++)
        assert_true(key_of(elements + (n - 1) * size, size) <= key_of(elements + n * size, size));
    asj_sort(again, count, size, size == 1 ? by_byte : by_two);
    assert_memory_equal(again, elements, count * size);
}

static void every_length_and_size(void **state)
{
    static const size_t sizes[] = {1, 2, 3, 4, 8, 24, 63, 64, 65, 130, LARGEST};
    uint32_t random = 1;
    (void)state;
    for (size_t s = 0; s < UNIT_COUNT(sizes); s++)
        for (size_t count = 0; count <= MOST; count = count < 70 ? count + 1 : 2 * count + 1) {
            for (size_t n = 0; n < count; n++) {
                random = random * 1664525u + 1013904223u;
                put(n, sizes[s], (int)(random >> 16));
            }
            sort_and_check(count, sizes[s]);
        }
}

static int key_in_order(int order, int n)
{
    switch (order) {
    case 0: return n;
    case 1: return MOST - n;
    case 2: return 5;
    case 3: return n % 2;
    case 4: return n < MOST / 2 ? n : MOST - n; /* up and down */
    case 5: return n % 64;
    case 6: return n == 0 ? MOST : n;
    default: return n % 2 ? n : MOST / 2 + n / 2;
    }
}

/* The order that makes quicksort with the median of three divide off two elements each time (Musser 1997). */
static void make_killer(size_t size)
{
    const int half = MOST / 2;
    for (int k = 1; k <= half; k++) {
        put((size_t)k - 1, size, k % 2 ? k : half + k - 1);
        put((size_t)(half + k) - 1, size, 2 * k);
    }
}

static void orders_that_are_hard(void **state)
{
    (void)state;
    for (int order = 0; order < 8; order++) {
        for (int n = 0; n < MOST; n++)
            put((size_t)n, 12, key_in_order(order, n));
        sort_and_check(MOST, 12);
    }
    make_killer(12);
    sort_and_check(MOST, 12);
}

/* Answers so that the pivot is as bad as can be, whatever the sort does (McIlroy 1999): what nobody asked about yet is largest. */
static int value[MOST], solid, candidate, is_gas;

static int adversary(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    compared++;
    if (value[x] == is_gas && value[y] == is_gas)
        value[x == candidate ? x : y] = solid++;
    if (value[x] == is_gas)
        candidate = x;
    else if (value[y] == is_gas)
        candidate = y;
    return value[x] - value[y];
}

static void no_order_takes_long(void **state)
{
    static int list[MOST];
    (void)state;
    is_gas = MOST;
    solid = candidate = 0;
    for (int n = 0; n < MOST; n++) {
        list[n] = n;
        value[n] = is_gas;
    }
    compared = 0;
    asj_sort(list, MOST, sizeof list[0], adversary);
    assert_true(compared < 5 * MOST * 12);
    for (int n = 1; n < MOST; n++)
        assert_true(value[list[n - 1]] <= value[list[n]]);
}

/* Each of them, in orders that are hard, is what sorting finds there. */
static void the_nth_is_found(void **state)
{
    static const int counts[] = {1, 2, 3, 16, 17, 18, 33, 100, 257};
    static float values[MOST], sorted[MOST];
    (void)state;
    for (size_t c = 0; c < UNIT_COUNT(counts); c++)
        for (int order = 0; order < 10; order++)
            for (int n = 1; n <= counts[c]; n++) {
                uint32_t random = 7;
                for (int k = 0; k < counts[c]; k++) {
                    random = random * 1664525u + 1013904223u;
                    values[k] = sorted[k] = order == 8   ? (float)(random >> 8)
                                            : order == 9 ? -(float)(random >> 29)
                                                         : (float)key_in_order(order, k);
                }
                for (int k = 1; k < counts[c]; k++) /* plainly */
                    for (int m = k; m > 0 && sorted[m] < sorted[m - 1]; m--) {
                        const float swap = sorted[m];
                        sorted[m] = sorted[m - 1];
                        sorted[m - 1] = swap;
                    }
                assert_true(asj_nth_smallest(values, (size_t)counts[c], (size_t)n) == sorted[n - 1]);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_length_and_size), cmocka_unit_test(orders_that_are_hard),
                                       cmocka_unit_test(no_order_takes_long), cmocka_unit_test(the_nth_is_found)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
