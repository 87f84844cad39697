/* SPDX-License-Identifier: BSD-2-Clause */
/* Introsort (Musser 1997): quicksort about the median of three (Singleton 1969), the smaller part first, so that open parts are
 * few; heapsort (Williams 1964) where parts do not get smaller, so that nothing takes long; insertion in short parts. */
#include "sort.h"

#include <stdint.h>
#include <string.h>

#define SHORT 10      /* elements that are inserted one after the other */
#define MOST_PARTS 64 /* that are open: each is at most half as long as the one before */

typedef struct list {
    size_t size;
    int (*compare)(const void *, const void *);
} list;

typedef struct part {
    char *first;
    size_t count;
    int depth; /* divisions that are left before the heap */
} part;

/* Sizes that compilers know become a few instructions, those that they do not a call. */
static inline void swap_bytes(char *a, char *b, const size_t bytes)
{
    char kept[64];
    memcpy(kept, a, bytes);
    memcpy(a, b, bytes);
    memcpy(b, kept, bytes);
}

static void swap(const list *l, char *a, char *b)
{
    size_t left = l->size;
    for (; left >= 64; left -= 64, a += 64, b += 64)
        swap_bytes(a, b, 64);
    for (; left >= 8; left -= 8, a += 8, b += 8)
        swap_bytes(a, b, 8);
    for (; left > 0; left--, a++, b++)
        swap_bytes(a, b, 1);
}

static int is_before(const list *l, const char *a, const char *b)
{
    return l->compare(a, b) < 0;
}

static void insert_all(const list *l, char *first, size_t count)
{
    const size_t bytes = count * l->size;
    for (size_t i = l->size; i < bytes; i += l->size)
        for (size_t k = i; k > 0 && is_before(l, first + k, first + k - l->size); k -= l->size)
            swap(l, first + k, first + k - l->size);
}

/* Lets element `at` of a heap sink to its place. */
static void sink(const list *l, char *first, size_t at, size_t count)
{
    for (size_t child = 2 * at + 1; child < count; child = 2 * at + 1) {
        if (child + 1 < count && is_before(l, first + child * l->size, first + (child + 1) * l->size))
            child++;
        if (!is_before(l, first + at * l->size, first + child * l->size))
            return;
        swap(l, first + at * l->size, first + child * l->size);
        at = child;
    }
}

void asj_heap_sink(void *heap, size_t at, size_t count, size_t size, int (*compare)(const void *, const void *))
{
    const list l = {size, compare};
    sink(&l, heap, at, count);
}

static void sort_heap(const list *l, char *first, size_t count)
{
    for (size_t at = count / 2; at-- > 0;)
        sink(l, first, at, count);
    for (size_t left = count - 1; left > 0; left--) {
        swap(l, first, first + left * l->size);
        sink(l, first, 0, left);
    }
}

/* Brings the median of the first, the middle and the last element to the front; the largest of them stays last. */
static void choose_pivot(const list *l, char *first, size_t count)
{
    char *middle = first + count / 2 * l->size, *last = first + (count - 1) * l->size;
    if (is_before(l, middle, first))
        swap(l, middle, first);
    if (is_before(l, last, middle)) {
        swap(l, last, middle);
        if (is_before(l, middle, first))
            swap(l, middle, first);
    }
    swap(l, first, middle);
}

/* Divides a part about its first element, which comes to its place; returns that. */
static size_t divide(const list *l, char *first, size_t count)
{
    size_t low = 0, high = count;
    choose_pivot(l, first, count);
    for (;;) {
        do
            low++;
        while (low < high && is_before(l, first + low * l->size, first));
        do
            high--;
        while (is_before(l, first, first + high * l->size));
        if (low >= high)
            break;
        swap(l, first + low * l->size, first + high * l->size);
    }
    swap(l, first, first + high * l->size);
    return high;
}

void asj_sort(void *elements, size_t count, size_t size, int (*compare)(const void *, const void *))
{
    const list l = {size, compare};
    part open[MOST_PARTS];
    int parts = 1, depth = 0;
    for (size_t n = count; n > 1; n /= 2)
        depth += 2;
    open[0] = (part){elements, count, depth};
    while (parts > 0) {
        part p = open[--parts];
        while (p.count > SHORT && p.depth > 0) {
            const size_t at = divide(&l, p.first, p.count);
            const part left = {p.first, at, p.depth - 1};
            const part right = {p.first + (at + 1) * size, p.count - at - 1, p.depth - 1};
            open[parts++] = left.count < right.count ? right : left;
            p = left.count < right.count ? left : right;
        }
        if (p.count > SHORT)
            sort_heap(&l, p.first, p.count);
        else if (p.count > 1)
            insert_all(&l, p.first, p.count);
    }
}
