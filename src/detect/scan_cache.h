/* SPDX-License-Identifier: BSD-2-Clause */
/* The local junctions of the pixels that rays visit (a few hundredths of an indoor photograph) are computed when first needed, and
 * kept: both scans of an image, and rays along one edge, visit the same ones. Each thread keeps its own. */
#ifndef ASJ_SRC_SCAN_CACHE_H
#define ASJ_SRC_SCAN_CACHE_H

#include "field.h"

#include <string.h>

typedef asj_field_branch asj_pixel_branches[ASJ_FIELD_BRANCHES];

typedef struct asj_scan_cache {
    int32_t bits;                 /* 2^bits pixels for each thread */
    uint32_t *keys;               /* of the pixels held; 0 = empty */
    asj_pixel_branches *branches;
    size_t capacity;              /* pixels that there is memory for */
} asj_scan_cache;

/* Makes an empty cache for an image; keeps the memory when it is large enough. `cache` is zero before the first time. */
asj_status asj_scan_cache_prepare(asj_context *context, const asj_frame *frame, int32_t threads, asj_scan_cache *cache);
void asj_scan_cache_free(asj_memory *memory, asj_scan_cache *cache);

/* Never 0: sides are at most 65535. */
static inline uint32_t asj_scan_cache_key(asj_pixel pixel)
{
    return ((uint32_t)pixel.y << 16 | (uint32_t)pixel.x) + 1;
}

static inline size_t asj_scan_cache_slot(const asj_scan_cache *cache, size_t thread, uint32_t key)
{
    return (thread << cache->bits) + (key * 2654435769u >> (32 - cache->bits)); /* Fibonacci hashing */
}

/* Whether the thread knows the branches of a pixel, and these. */
static inline int asj_scan_cache_get(const asj_scan_cache *cache, size_t thread, asj_pixel pixel, asj_field_branch *branches)
{
    const uint32_t key = asj_scan_cache_key(pixel);
    const size_t slot = asj_scan_cache_slot(cache, thread, key);
    if (cache->keys[slot] != key)
        return 0;
    memcpy(branches, cache->branches[slot], sizeof cache->branches[slot]);
    return 1;
}

static inline void asj_scan_cache_put(const asj_scan_cache *cache, size_t thread, asj_pixel pixel, const asj_field_branch *branches)
{
    const uint32_t key = asj_scan_cache_key(pixel);
    const size_t slot = asj_scan_cache_slot(cache, thread, key);
    cache->keys[slot] = key;
    memcpy(cache->branches[slot], branches, sizeof cache->branches[slot]);
}

#endif
