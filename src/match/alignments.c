/* SPDX-License-Identifier: BSD-2-Clause */
/* Alignments that are known already. A pair of images is looked at more than once: the candidates of a short list are among those
 * of a geometry's longer one (two_view.c), guests are proposed again when that is decided (match.c), and with colours all that the
 * luma has comes again (match_images.c). Where the same template meets the same place in the other picture under the same map, the
 * alignment comes to the same: so it is taken from here. (Of the alignments of two unrelated pairs of photographs 55 and 58 in a
 * hundred.) */
#include "alignments.h"

#include <string.h>

#define SLOTS 2 /* for an alignment at least */

static uint64_t hash_of(const asj_alignment_key *key)
{
    uint64_t words[sizeof *key / sizeof(uint64_t)], hash = 0;
    memcpy(words, key, sizeof words);
    for (size_t n = 0; n < sizeof words / sizeof *words; n++) {
        hash = (hash ^ words[n]) * UINT64_C(0x9e3779b97f4a7c15);
        hash ^= hash >> 32;
    }
    return hash;
}

/* The slot with this key, or the free one where it belongs. */
static uint32_t *slot_of(const asj_alignments *known, const asj_alignment_key *key)
{
    size_t at = (size_t)(hash_of(key) & (known->slot_count - 1));
    while (known->slots[at] != 0 && memcmp(&known->list[known->slots[at] - 1].key, key, sizeof *key) != 0)
        at = (at + 1) & (known->slot_count - 1);
    return &known->slots[at];
}

static asj_status no_memory(asj_context *context, size_t count)
{
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu alignments", count);
}

/* Slots for so many, the old ones filled in again. */
static asj_status renew_slots(asj_context *context, asj_alignments *known, size_t count)
{
    size_t wanted = 1024;
    while (wanted < SLOTS * count)
        wanted *= 2;
    if (wanted <= known->slot_count)
        return ASJ_OK;
    uint32_t *slots = asj_allocate_zero(&context->memory, wanted, sizeof *slots);
    if (!slots)
        return no_memory(context, count);
    asj_release_much(&context->memory, known->slots);
    known->slots = slots;
    known->slot_count = wanted;
    for (size_t n = 0; n < known->count; n++)
        *slot_of(known, &known->list[n].key) = (uint32_t)n + 1;
    return ASJ_OK;
}

asj_status asj_alignments_reserve(asj_context *context, asj_alignments *known, size_t more)
{
    const size_t count = known->count + more;
    void *list = known->list;
    if (count > UINT32_MAX)
        return no_memory(context, count);
    const asj_status status = asj_grow_within(&context->memory, &list, &known->capacity, count, count + count / 4,
                                              sizeof *known->list, known->count);
    known->list = list;
    return status == ASJ_OK ? renew_slots(context, known, count) : no_memory(context, count);
}

uint32_t asj_alignments_number(asj_alignments *known, const asj_alignment_key *key, uint32_t first)
{
    uint32_t *slot = slot_of(known, key);
    if (*slot == 0) {
        known->list[known->count++] = (asj_known_alignment){.key = *key, .first = first};
        *slot = (uint32_t)known->count;
    }
    return *slot - 1;
}

void asj_alignments_free(asj_memory *memory, asj_alignments *known)
{
    asj_release_much(memory, known->list);
    asj_release_much(memory, known->slots);
    memset(known, 0, sizeof *known);
}
