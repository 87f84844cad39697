/* SPDX-License-Identifier: BSD-2-Clause */
/* Sorting in place. The C library's qsort() may allocate as much as the list takes (glibc's does), past the context's allocator,
 * and leaves what compares equal in an order of its own. */
#ifndef ASJ_SRC_SORT_H
#define ASJ_SRC_SORT_H

#include <stddef.h>

/* As qsort(). The same order on every machine, also of what compares equal; that is not the order it came in. */
void asj_sort(void *list, size_t count, size_t size, int (*compare)(const void *, const void *));

/* Lets element `at` of a heap sink to its place, the order of what stands below it being right already: nothing stands above what
 * compare() puts after it, and the last of all is element 0. For who wants the first few of many, or is to be asked meanwhile. */
void asj_heap_sink(void *heap, size_t at, size_t count, size_t size, int (*compare)(const void *, const void *));

#endif
