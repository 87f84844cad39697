/* SPDX-License-Identifier: BSD-2-Clause */
/* Every allocation of the core goes through here: the context's allocator, overflow checks, and a count of bytes held. */
#ifndef ASJ_SRC_MEMORY_H
#define ASJ_SRC_MEMORY_H

#include <asj/context.h>

typedef struct asj_memory {
    asj_allocator allocator;
    uint64_t now, peak;      /* bytes held, and the most ever held */
    struct asj_spare *spare; /* released blocks that are kept */
    int32_t open;            /* asj_memory_open() less asj_memory_close() */
    uint64_t call;           /* how often it was opened */
    struct asj_shelf *shelves; /* large pages that smaller blocks share */
    size_t sharing;            /* bytes of the first of them; 0 = new blocks do not */
    int32_t shelf_count;
} asj_memory;

/* The allocator that the options ask for; malloc() and free() when they name none or are NULL. 0 when they name only one of the
 * functions. */
int asj_memory_allocator(const asj_context_options *options, asj_allocator *allocator);

/* `count` elements of `size` bytes, aligned to ASJ_ALIGNMENT, contents undefined; NULL when out of memory or when the product
 * overflows. A count of 0 gives a valid pointer. Not thread safe: call from the calling thread only. */
#define ASJ_ALIGNMENT 64
void *asj_allocate(asj_memory *memory, size_t count, size_t size);

/* The same, all bytes zero. */
void *asj_allocate_zero(asj_memory *memory, size_t count, size_t size);

/* The same for a list whose length depends on what a picture shows: a block that will be kept has room for half as many again and
 * a few, so that the next picture's list fits as well. */
void *asj_allocate_list(asj_memory *memory, size_t count, size_t size);

/* NULL is fine. */
void asj_release(asj_memory *memory, void *block);

/* The same, but blocks of 4 MB and more are not kept for the next call. For lists of millions of which each step makes a longer
 * one: what they leave would be more than what is in use, and to touch so much memory again is little beside what is computed to
 * fill it. */
void asj_release_much(asj_memory *memory, void *block);

/* A block that grows: makes *block at least `count` elements of `size` bytes large, keeping the first `keep` elements.
 * *capacity (elements) is updated; growth is geometric. On failure nothing changes. */
asj_status asj_grow(asj_memory *memory, void **block, size_t *capacity, size_t count, size_t size, size_t keep);

/* The same to `most` elements at most, or to `count` if that is more, and with asj_release_much(). */
asj_status asj_grow_within(asj_memory *memory, void **block, size_t *capacity, size_t count, size_t most, size_t size, size_t keep);

/* Between these two released blocks are kept and handed out again, so that a call that does what the one before did allocates
 * nothing. A block that has been of no use to several calls is given back. */
void asj_memory_open(asj_memory *memory);
void asj_memory_close(asj_memory *memory);

/* Whether new blocks of up to a megabyte share large pages: a large image is ready sooner the first time, a small one takes more
 * memory. `first`: bytes of the first pages, where larger blocks have a place too while there is room; 0 = none are shared. */
void asj_memory_share(asj_memory *memory, size_t first);

/* Gives back all blocks that are kept. */
void asj_memory_trim(asj_memory *memory);

#endif
