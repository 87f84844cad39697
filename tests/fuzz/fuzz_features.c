/* SPDX-License-Identifier: BSD-2-Clause */
/* Features from bytes: as they are, and with the size and the checksum that they should have, so that what is behind them is
 * reached. What is read can be saved and read again, and matched. */
#include "fuzz.h"

#include <stdlib.h>
#include <string.h>

enum { CHECKSUM = 12, SIZE = 16, HEADER = 40 };

static void put(uint8_t *to, uint32_t value)
{
    int i;
    for (i = 0; i < 4; i++)
        to[i] = (uint8_t)(value >> 8 * i);
}

static uint32_t checksum(const uint8_t *bytes, size_t size)
{
    uint32_t rest = 0xffffffffu;
    for (; size > 0; size--, bytes++) {
        int bit;
        rest ^= *bytes;
        for (bit = 0; bit < 8; bit++)
            rest = rest & 1 ? rest >> 1 ^ 0xedb88320u : rest >> 1;
    }
    return ~rest;
}

static void match_with_itself(const asj_features *features)
{
    asj_match_result *result = NULL;
    asj_features_info info;
    uint32_t i;
    asj_status status = asj_match_features(fuzz_context(), features, features, NULL, &result);
    asj_features_get_info(features, &info);
    fuzz_check(status == ASJ_OK, "features that were read cannot be matched");
    for (i = 0; i < result->match_count; i++)
        fuzz_check(result->matches[i].l1 < info.l_junction_count && result->matches[i].l2 < info.l_junction_count,
                   "a match of nothing");
    asj_match_result_free(&result);
}

static void try(const uint8_t *bytes, size_t size)
{
    asj_features *features = NULL, *again = NULL;
    asj_status status = asj_features_load(fuzz_context(), bytes, size, &features);
    size_t saved = asj_features_save(features, NULL, 0);
    uint8_t *copy;
    fuzz_check((status == ASJ_OK) == (features != NULL), "a status and a result that do not fit");
    fuzz_check(status == ASJ_OK || *asj_context_message(fuzz_context()), "a failure without a message");
    if (!features)
        return;
    copy = malloc(saved);
    fuzz_check(copy && asj_features_save(features, copy, saved) == saved, "features that cannot be saved");
    fuzz_check(asj_features_load(fuzz_context(), copy, saved, &again) == ASJ_OK, "saved features that cannot be read");
    match_with_itself(again);
    asj_features_free(&features);
    asj_features_free(&again);
    free(copy);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    uint8_t *sealed = malloc(size + 1);
    fuzz_check(sealed != NULL, "no memory");
    memcpy(sealed, data, size);
    try(sealed, size);
    if (size > HEADER) {
        put(sealed + SIZE, (uint32_t)size);
        put(sealed + SIZE + 4, 0);
        put(sealed + CHECKSUM, checksum(sealed + SIZE, size - SIZE));
        try(sealed, size);
    }
    free(sealed);
    return 0;
}
