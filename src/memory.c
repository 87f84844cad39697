/* SPDX-License-Identifier: BSD-2-Clause */
#include "memory.h"

#include <stdlib.h>
#include <string.h>

static void *allocate_default(void *user, size_t size)
{
    (void)user;
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
    return allocator->allocate && allocator->release;
}

/* Before each aligned block stands what is needed to release and to count it. */
typedef struct header {
    void *start;
    size_t bytes;
} header;

void *asj_allocate(asj_memory *memory, size_t count, size_t size)
{
    const size_t extra = ASJ_ALIGNMENT + sizeof(header);
    if (size != 0 && count > (SIZE_MAX - extra) / size)
        return NULL;
    size_t bytes = count * size + extra;
    char *start = memory->allocator.allocate(memory->allocator.user, bytes);
    if (!start)
        return NULL;
    uintptr_t address = (uintptr_t)(start + extra) & ~(uintptr_t)(ASJ_ALIGNMENT - 1);
    char *block = start + (address - (uintptr_t)start);
    header head = {start, bytes};
    memcpy(block - sizeof head, &head, sizeof head);
    memory->now += bytes;
    if (memory->now > memory->peak)
        memory->peak = memory->now;
    return block;
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
    header head;
    memcpy(&head, (char *)block - sizeof head, sizeof head);
    memory->now -= head.bytes;
    memory->allocator.release(memory->allocator.user, head.start);
}

asj_status asj_grow(asj_memory *memory, void **block, size_t *capacity, size_t count, size_t size, size_t keep)
{
    if (count <= *capacity)
        return ASJ_OK;
    size_t wanted = *capacity + *capacity / 2;
    if (wanted < count)
        wanted = count;
    void *larger = asj_allocate(memory, wanted, size);
    if (!larger)
        return ASJ_ERROR_MEMORY;
    if (keep)
        memcpy(larger, *block, keep * size);
    asj_release(memory, *block);
    *block = larger;
    *capacity = wanted;
    return ASJ_OK;
}
