/* SPDX-License-Identifier: BSD-2-Clause */
/* Tables on the device, and memory of the host for transfers. */
#ifndef ASJ_SRC_CL_TABLE_H
#define ASJ_SRC_CL_TABLE_H

#include "runtime.h"

/* Numbers that a kernel looks up, kept on the device until they change. */
typedef struct asj_cl_table {
    asj_cl_buffer buffer;
    void *held;  /* what the buffer holds: `held_count` numbers */
    void *draft; /* where new ones are written: asj_cl_table_begin() */
    size_t held_count, held_capacity, draft_capacity;
} asj_cl_table;

/* Memory of the host that only grows. */
typedef struct asj_cl_host_buffer {
    void *memory;
    size_t capacity; /* bytes */
} asj_cl_host_buffer;

/* `most` numbers to be filled. */
asj_status asj_cl_table_begin(asj_context *context, asj_cl_table *table, size_t most, int32_t **numbers);

/* The first `count` of them are the table. */
asj_status asj_cl_table_end(asj_context *context, asj_cl_table *table, size_t count);
void asj_cl_table_free(asj_context *context, asj_cl_table *table);

/* Makes it at least that large; its contents are lost. */
asj_status asj_cl_host_reserve(asj_context *context, asj_cl_host_buffer *buffer, size_t bytes);

#endif
