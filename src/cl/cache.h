/* SPDX-License-Identifier: BSD-2-Clause */
/* Compiled programs in the caller's store (asj_kernel_cache): keys, and entries that say what they are. */
#ifndef ASJ_SRC_CL_CACHE_H
#define ASJ_SRC_CL_CACHE_H

#include "core/context.h"
#include "source.h"

#define ASJ_CL_KEY_SIZE 96

/* The key of a source on the device with this identity. */
void asj_cl_cache_key(const char *identity, const asj_cl_source *source, char key[ASJ_CL_KEY_SIZE]);

/* Bytes of an entry that holds a binary of this size. */
size_t asj_cl_cache_entry_size(const char *identity, const asj_cl_source *source, size_t binary_size);

/* Writes an entry of that size. */
void asj_cl_cache_pack(const char *identity, const asj_cl_source *source, const void *binary, size_t binary_size, uint8_t *entry);

/* The binary in an entry, and its size; NULL when the entry is damaged, cut, or made for anything else. */
const uint8_t *asj_cl_cache_unpack(const char *identity, const asj_cl_source *source, const uint8_t *entry, size_t entry_size,
                                   size_t *binary_size);

/* The entry that the caller has for a source, to be released; NULL when there is none. */
uint8_t *asj_cl_cache_get(asj_context *context, const asj_cl_source *source, size_t *entry_size);

/* Gives the caller an entry to keep. */
void asj_cl_cache_put(asj_context *context, const asj_cl_source *source, const void *binary, size_t binary_size);

#endif
