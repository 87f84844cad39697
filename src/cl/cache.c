/* SPDX-License-Identifier: BSD-2-Clause */
/* An entry of the kernel cache: written and read back, refused when it is not of this device, driver and source. */
#include "cache.h"
#include "state.h"

#include <stdio.h>
#include <string.h>

/* An entry: magic, length of the identity, size of the binary, checksum of all that follows; the device's identity, the source's
 * hash; the binary. Numbers have their low bytes first. */
enum { AT_LENGTH = 8, AT_SIZE = 16, AT_CHECKSUM = 24, HEADER = 32 };
static const char magic[8] = {'A', 'S', 'J', 'C', 'L', '0', '0', '1'};

/* Entries above this are no programs of ours. */
#define LARGEST_ENTRY ((size_t)1 << 28)

/* FNV-1a, 64 bits (Fowler, Noll and Vo). */
#define HASH_START 14695981039346656037u
static uint64_t hash(uint64_t start, const void *data, size_t size)
{
    const uint8_t *bytes = data;
    for (size_t i = 0; i < size; i++)
        start = (start ^ bytes[i]) * 1099511628211u;
    return start;
}

static void put_number(uint8_t *to, uint64_t number)
{
    for (int i = 0; i < 8; i++)
        to[i] = (uint8_t)(number >> 8 * i);
}

static uint64_t get_number(const uint8_t *from)
{
    uint64_t number = 0;
    for (int i = 0; i < 8; i++)
        number |= (uint64_t)from[i] << 8 * i;
    return number;
}

void asj_cl_cache_key(const char *identity, const asj_cl_source *source, char key[ASJ_CL_KEY_SIZE])
{
    uint64_t number = hash(HASH_START, identity, strlen(identity));
    number = hash(number, source->hash, strlen(source->hash));
    snprintf(key, ASJ_CL_KEY_SIZE, "%.32s-%08lx%08lx.clbin", source->name, (unsigned long)(number >> 32),
             (unsigned long)(number & 0xffffffff));
}

size_t asj_cl_cache_entry_size(const char *identity, const asj_cl_source *source, size_t binary_size)
{
    return HEADER + strlen(identity) + strlen(source->hash) + binary_size;
}

void asj_cl_cache_pack(const char *identity, const asj_cl_source *source, const void *binary, size_t binary_size, uint8_t *entry)
{
    const size_t first = strlen(identity), second = strlen(source->hash);
    memcpy(entry, magic, sizeof magic);
    put_number(entry + AT_LENGTH, first + second);
    put_number(entry + AT_SIZE, binary_size);
    memcpy(entry + HEADER, identity, first);
    memcpy(entry + HEADER + first, source->hash, second);
    memcpy(entry + HEADER + first + second, binary, binary_size);
    put_number(entry + AT_CHECKSUM, hash(HASH_START, entry + HEADER, first + second + binary_size));
}

const uint8_t *asj_cl_cache_unpack(const char *identity, const asj_cl_source *source, const uint8_t *entry, size_t entry_size,
                                   size_t *binary_size)
{
    const size_t first = strlen(identity), second = strlen(source->hash), start = HEADER + first + second;
    if (entry_size <= start || memcmp(entry, magic, sizeof magic) != 0 || get_number(entry + AT_LENGTH) != first + second ||
        get_number(entry + AT_SIZE) != entry_size - start || memcmp(entry + HEADER, identity, first) != 0 ||
        memcmp(entry + HEADER + first, source->hash, second) != 0 ||
        get_number(entry + AT_CHECKSUM) != hash(HASH_START, entry + HEADER, entry_size - HEADER))
        return NULL;
    *binary_size = entry_size - start;
    return entry + start;
}

static size_t get(asj_context *context, const char *key, void *entry, size_t capacity)
{
    const asj_kernel_cache *cache = &context->options.kernel_cache;
    context->in_hook++;
    const size_t size = cache->get(cache->user, key, entry, capacity);
    context->in_hook--;
    return size;
}

uint8_t *asj_cl_cache_get(asj_context *context, const asj_cl_source *source, size_t *entry_size)
{
    const asj_kernel_cache *cache = &context->options.kernel_cache;
    char key[ASJ_CL_KEY_SIZE];
    if (!cache->get)
        return NULL;
    asj_cl_cache_key(context->cl->identity, source, key);
    const size_t size = get(context, key, NULL, 0);
    if (size == 0 || size > LARGEST_ENTRY)
        return NULL;
    uint8_t *entry = asj_allocate(&context->memory, size, 1);
    if (entry && get(context, key, entry, size) != size) { /* it has changed in between */
        asj_release(&context->memory, entry);
        entry = NULL;
    }
    *entry_size = size;
    return entry;
}

void asj_cl_cache_put(asj_context *context, const asj_cl_source *source, const void *binary, size_t binary_size)
{
    const asj_kernel_cache *cache = &context->options.kernel_cache;
    const char *identity = context->cl->identity;
    char key[ASJ_CL_KEY_SIZE];
    const size_t size = asj_cl_cache_entry_size(identity, source, binary_size);
    if (!cache->put || size > LARGEST_ENTRY)
        return;
    uint8_t *entry = asj_allocate(&context->memory, size, 1);
    if (!entry)
        return;
    asj_cl_cache_key(identity, source, key);
    asj_cl_cache_pack(identity, source, binary, binary_size, entry);
    context->in_hook++;
    cache->put(cache->user, key, entry, size);
    context->in_hook--;
    asj_release(&context->memory, entry);
}
