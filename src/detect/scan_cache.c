/* SPDX-License-Identifier: BSD-2-Clause */
/* Memory for the local junctions that rays have visited: how much, and an empty one for each image. */
#include "scan_cache.h"

#include <string.h>

#define LEAST_BITS 10
#define MOST_BITS 14       /* 320 kB; more does not make it faster, 12 megapixels included */
#define MOST_PIXELS 262144 /* of all threads together: 5 MB */

void asj_scan_cache_free(asj_memory *memory, asj_scan_cache *cache)
{
    asj_release(memory, cache->keys);
    asj_release(memory, cache->branches);
    memset(cache, 0, sizeof *cache);
}

asj_status asj_scan_cache_prepare(asj_context *context, const asj_frame *frame, int32_t threads, asj_scan_cache *cache)
{
    const int64_t visited = (int64_t)frame->width * frame->height / 16; /* mostly fewer */
    int32_t bits = LEAST_BITS;
    while (bits < MOST_BITS && (int64_t)1 << bits < visited && (int64_t)threads << (bits + 1) <= MOST_PIXELS)
        bits++;
    const size_t count = (size_t)threads << bits;
    if (count > cache->capacity) {
        asj_scan_cache_free(&context->memory, cache);
        cache->keys = asj_allocate(&context->memory, count, sizeof *cache->keys);
        cache->branches = asj_allocate(&context->memory, count, sizeof *cache->branches);
        if (!cache->keys || !cache->branches) {
            asj_scan_cache_free(&context->memory, cache);
            return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the local junctions of %zu pixels", count);
        }
        cache->capacity = count;
    }
    cache->bits = bits;
    memset(cache->keys, 0, count * sizeof *cache->keys);
    return ASJ_OK;
}
