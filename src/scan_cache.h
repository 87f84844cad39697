/* SPDX-License-Identifier: BSD-2-Clause */
/* The local junctions of the pixels that rays visit (5 to 10 % of an indoor photograph) are computed in runs of ASJ_LANES pixels
 * when first needed, and kept: both scans of an image, and rays along one edge, visit the same ones. Each thread keeps its own. */
#ifndef ASJ_SRC_SCAN_CACHE_H
#define ASJ_SRC_SCAN_CACHE_H

#include "field.h"

typedef asj_field_branch asj_run_branches[ASJ_LANES][ASJ_FIELD_BRANCHES];

typedef struct asj_scan_cache {
    int32_t threads;
    int32_t bits;               /* 2^bits runs for each thread */
    uint32_t *keys;             /* 1 + number of the run; 0 = empty */
    asj_run_branches *branches;
    size_t capacity;            /* runs that there is memory for */
} asj_scan_cache;

/* Makes an empty cache for an image; keeps the memory when it is large enough. `cache` is zero before the first time. */
asj_status asj_scan_cache_prepare(asj_context *context, const asj_frame *frame, int32_t threads, asj_scan_cache *cache);
void asj_scan_cache_free(asj_memory *memory, asj_scan_cache *cache);

#endif
