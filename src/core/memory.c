/* SPDX-License-Identifier: BSD-2-Clause */
/* The allocator with its checks and counts, and blocks that are kept from call to call. */
#ifdef __linux__
#define _GNU_SOURCE /* madvise() */
#endif
#include "memory.h"

#include <stdlib.h>
#include <string.h>
#ifdef __linux__
#include <sys/mman.h>
#endif

#define LARGE_PAGE ((size_t)2 << 20) /* bytes, where pages are 4096 bytes; elsewhere the advice below means nothing */

/* The first touch of a page costs a microsecond or two, a good part of the first image of a process. So large blocks begin where a
 * large page may, and ask for such pages; the last one is whole where the block fills half of it. */
static void *allocate_default(void *user, size_t size)
{
    (void)user;
#if defined(__linux__) && defined(MADV_HUGEPAGE)
    void *block = NULL;
    const size_t large = (size + LARGE_PAGE / 2) / LARGE_PAGE * LARGE_PAGE, whole = size > large ? size : large;
    if (size >= LARGE_PAGE && size <= SIZE_MAX - LARGE_PAGE && posix_memalign(&block, LARGE_PAGE, whole) == 0) {
        madvise(block, large, MADV_HUGEPAGE);
        return block;
    }
#endif
    return malloc(size);
}

static void release_default(void *user, void *memory)
{
    (void)user;
    free(memory);
}

int asj_memory_allocator(const asj_context_options *options, asj_allocator *allocator)
{
    *allocator = (asj_allocator){allocate_default, release_default, NULL};
    if (options && (options->allocator.allocate || options->allocator.release))
        *allocator = options->allocator;
    /* asj_context_options_init() leaves the defaults there, and who replaces one of them has given one of his own. */
    return allocator->allocate && allocator->release &&
           (allocator->allocate == allocate_default) == (allocator->release == release_default);
}

/* What the sanitizer is told about blocks that are kept: nobody may touch them. */
#ifdef ASJ_ADDRESS_SANITIZER
#include <sanitizer/asan_interface.h>
#define FORBID(block, size) ASAN_POISON_MEMORY_REGION(block, size)
#define ALLOW(block, size) ASAN_UNPOISON_MEMORY_REGION(block, size)
#define GAP ASJ_ALIGNMENT /* bytes between blocks of a shelf that nobody may touch */
#else
#define FORBID(block, size) ((void)(block), (void)(size))
#define ALLOW(block, size) ((void)(block), (void)(size))
#define GAP 0
#endif

#define LEAST_MORE 4 /* elements: a list of one is soon one of two */

#define CALLS_KEPT 8 /* calls that a block may be of no use to before it is given back */
#define MUCH ((size_t)4 << 20) /* bytes: asj_release_much() */

/* Of smaller blocks, two thirds of the pages that a first image touches, those that are kept share large pages: of 4096 bytes each
 * takes 1.2 us here, 2 MB of them 630 us, and as one page 30 to 240. What is given back of a shelf is not used again before all of
 * it is, but for a large block at the end of the first one; so there are few, and for small images none (asj_memory_share()). Not
 * with an allocator of the caller's, who knows better. */
#define MOST_SHELVES 4
#define LEAST_ON_SHELF 16384u           /* bytes */
#define MOST_ON_SHELF (LARGE_PAGE / 2)  /* of those that stand one behind the other */

typedef struct asj_shelf {
    struct asj_shelf *next;
    size_t size;
    size_t used, end; /* bytes from its beginning on that are taken, and where what stands at its end begins */
    size_t blocks;    /* that have not been given back */
} shelf;

/* Before each aligned block stands what is needed to release and to count it. */
typedef struct asj_spare {
    void *start;
    size_t bytes;
    shelf *on;              /* NULL: a block of the allocator's */
    struct asj_spare *next; /* of a block that is kept */
    uint64_t call;          /* that released it */
} header;

#define EXTRA (ASJ_ALIGNMENT + sizeof(header))

static void *block_of(header *head)
{
    return head + 1;
}

static size_t size_of(const header *head)
{
    return (size_t)((char *)head->start + head->bytes - (const char *)(head + 1));
}

static void count(asj_memory *memory, size_t bytes)
{
    memory->now += bytes;
    if (memory->now > memory->peak)
        memory->peak = memory->now;
}

static size_t room_of(size_t bytes)
{
    return (bytes + ASJ_ALIGNMENT - 1) / ASJ_ALIGNMENT * ASJ_ALIGNMENT + GAP;
}

/* A block of a shelf has been given back. */
static void leave_shelf(asj_memory *memory, const header *head)
{
    shelf **link = &memory->shelves, *s = head->on;
    if ((char *)head->start == (char *)s + s->end)
        s->end += room_of(head->bytes);
    if (--s->blocks > 0)
        return;
    while (*link != s)
        link = &(*link)->next;
    *link = s->next;
    memory->now -= s->size;
    memory->shelf_count--;
    ALLOW(s, s->size);
    memory->allocator.release(memory->allocator.user, s);
}

/* With room for a block, or NULL. */
static shelf *make_shelf(asj_memory *memory, size_t room)
{
    const size_t pages = memory->shelves ? 1 : (memory->sharing + LARGE_PAGE - 1) / LARGE_PAGE, size = pages * LARGE_PAGE;
    if (memory->shelf_count >= MOST_SHELVES || room > size - ASJ_ALIGNMENT)
        return NULL;
    shelf *s = memory->allocator.allocate(memory->allocator.user, size);
    if (!s)
        return NULL;
    *s = (shelf){memory->shelves, size, ASJ_ALIGNMENT, size, 0};
    memory->shelves = s;
    memory->shelf_count++;
    count(memory, size);
    return s;
}

/* Room for a block, or NULL. */
static char *take_from_shelf(asj_memory *memory, size_t bytes, shelf **on)
{
    *on = NULL;
    if (!memory->open || memory->sharing == 0 || memory->allocator.allocate != allocate_default || bytes < LEAST_ON_SHELF ||
        bytes > SIZE_MAX / 2)
        return NULL;
    const size_t room = room_of(bytes), from_end = bytes > MOST_ON_SHELF ? room : 0;
    shelf *s = memory->shelves;
    while (s && s->end - s->used < room)
        s = s->next;
    if (!s && (from_end == 0 || !memory->shelves))
        s = make_shelf(memory, room);
    if (!s)
        return NULL;
    s->end -= from_end;
    char *start = (char *)s + (from_end > 0 ? s->end : s->used);
    s->used += room - from_end;
    s->blocks++;
    *on = s;
    FORBID(start + bytes, room - bytes);
    return start;
}

static void give_back(asj_memory *memory, header *head)
{
    ALLOW(block_of(head), size_of(head));
    if (head->on) {
        leave_shelf(memory, head);
        return;
    }
    memory->now -= head->bytes;
    memory->allocator.release(memory->allocator.user, head->start);
}

/* Gives back what is kept, but for blocks released since call `since`. */
static void trim(asj_memory *memory, uint64_t since)
{
    for (header **link = &memory->spare; *link;) {
        header *head = *link;
        if (head->call >= since) {
            link = &head->next;
            continue;
        }
        *link = head->next;
        give_back(memory, head);
    }
}

/* The smallest kept block that is large enough, and not far too large. */
static void *take_spare(asj_memory *memory, size_t bytes)
{
    header **best = NULL;
    for (header **link = &memory->spare; *link; link = &(*link)->next)
        if ((*link)->bytes >= bytes && (*link)->bytes / 4 <= bytes && (!best || (*link)->bytes < (*best)->bytes))
            best = link;
    if (!best)
        return NULL;
    header *head = *best;
    *best = head->next;
    ALLOW(block_of(head), size_of(head));
    return block_of(head);
}

/* A list that grows from call to call leaves the block that it has outgrown. Blocks of this call are not it: the next call needs
 * them again. */
static void drop_outgrown(asj_memory *memory, size_t bytes)
{
    header **largest = NULL;
    for (header **link = &memory->spare; *link; link = &(*link)->next)
        if ((*link)->call < memory->call && (*link)->bytes < bytes && (*link)->bytes >= bytes / 2 &&
            (!largest || (*link)->bytes > (*largest)->bytes))
            largest = link;
    if (!largest)
        return;
    header *head = *largest;
    *largest = head->next;
    give_back(memory, head);
}

static void *take_new(asj_memory *memory, size_t bytes)
{
    if (memory->open)
        drop_outgrown(memory, bytes);
    shelf *on;
    char *start = take_from_shelf(memory, bytes, &on);
    if (!start)
        start = memory->allocator.allocate(memory->allocator.user, bytes);
    if (!start && memory->spare) {
        trim(memory, UINT64_MAX);
        start = memory->allocator.allocate(memory->allocator.user, bytes);
    }
    if (!start)
        return NULL;
    const uintptr_t address = (uintptr_t)(start + EXTRA) & ~(uintptr_t)(ASJ_ALIGNMENT - 1);
    header *head = (header *)(void *)(start + (address - (uintptr_t)start)) - 1;
    *head = (header){start, bytes, on, NULL, 0};
    if (!on)
        count(memory, bytes);
    return block_of(head);
}

/* `more`: elements for which a new block has room besides. */
static void *take(asj_memory *memory, size_t count, size_t size, size_t more)
{
    if (size != 0 && (count > (SIZE_MAX - EXTRA) / size || more > (SIZE_MAX - EXTRA) / size - count))
        return NULL;
    void *block = memory->open ? take_spare(memory, count * size + EXTRA) : NULL;
    return block ? block : take_new(memory, (count + more) * size + EXTRA);
}

void *asj_allocate(asj_memory *memory, size_t count, size_t size)
{
    return take(memory, count, size, 0);
}

/* Elements that a list has room for besides, where its block will be kept. */
static size_t more_of(const asj_memory *memory, size_t count)
{
    return memory->open ? count / 2 + LEAST_MORE : 0;
}

void *asj_allocate_list(asj_memory *memory, size_t count, size_t size)
{
    return take(memory, count, size, more_of(memory, count));
}

void *asj_allocate_zero(asj_memory *memory, size_t count, size_t size)
{
    void *block = asj_allocate(memory, count, size);
    if (block)
        memset(block, 0, count * size);
    return block;
}

void asj_release(asj_memory *memory, void *block)
{
    if (!block)
        return;
    header *head = (header *)block - 1;
    if (!memory->open) {
        give_back(memory, head);
        return;
    }
    head->call = memory->call;
    head->next = memory->spare;
    memory->spare = head;
    FORBID(block, size_of(head));
}

void asj_release_much(asj_memory *memory, void *block)
{
    if (block && ((header *)block - 1)->bytes >= MUCH)
        give_back(memory, (header *)block - 1);
    else
        asj_release(memory, block);
}

void asj_memory_open(asj_memory *memory)
{
    if (memory->open++ == 0)
        memory->call++;
}

void asj_memory_share(asj_memory *memory, size_t first)
{
    memory->sharing = first;
}

void asj_memory_close(asj_memory *memory)
{
    if (--memory->open == 0 && memory->call >= CALLS_KEPT)
        trim(memory, memory->call - CALLS_KEPT + 1);
}

void asj_memory_trim(asj_memory *memory)
{
    trim(memory, UINT64_MAX);
}

/* The block that is outgrown goes to `release`. */
static asj_status grow(asj_memory *memory, void **block, size_t *capacity, size_t count, size_t most, size_t size, size_t keep,
                       void (*release)(asj_memory *memory, void *block))
{
    if (count <= *capacity)
        return ASJ_OK;
    size_t wanted = *capacity + *capacity / 2;
    if (wanted < count)
        wanted = count <= SIZE_MAX / 4 ? count + more_of(memory, count) : count;
    if (wanted > most)
        wanted = most > count ? most : count;
    void *larger = take(memory, count, size, wanted - count); /* a kept block that holds `count` will do */
    if (!larger)
        return ASJ_ERROR_MEMORY;
    const size_t room = size_of((header *)larger - 1) / size;
    wanted = room < wanted ? room : wanted;
    if (keep)
        memcpy(larger, *block, keep * size);
    release(memory, *block);
    *block = larger;
    *capacity = wanted;
    return ASJ_OK;
}

asj_status asj_grow(asj_memory *memory, void **block, size_t *capacity, size_t count, size_t size, size_t keep)
{
    return grow(memory, block, capacity, count, SIZE_MAX, size, keep, asj_release);
}

asj_status asj_grow_within(asj_memory *memory, void **block, size_t *capacity, size_t count, size_t most, size_t size, size_t keep)
{
    return grow(memory, block, capacity, count, most, size, keep, asj_release_much);
}
