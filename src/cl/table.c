/* SPDX-License-Identifier: BSD-2-Clause */
/* Tables on the device, and memory of the host for transfers. */
#include "table.h"

#include <string.h>

asj_status asj_cl_table_begin(asj_context *context, asj_cl_table *table, size_t most, int32_t **numbers)
{
    if (asj_grow(&context->memory, &table->draft, &table->draft_capacity, most, sizeof **numbers, 0) != ASJ_OK)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a table of %zu numbers", most);
    *numbers = table->draft;
    return ASJ_OK;
}

asj_status asj_cl_table_end(asj_context *context, asj_cl_table *table, size_t count)
{
    const size_t bytes = count * sizeof(int32_t);
    if (table->held_count == count && memcmp(table->held, table->draft, bytes) == 0)
        return ASJ_OK;
    table->held_count = 0;
    asj_status status = asj_cl_reserve(context, &table->buffer, bytes);
    if (status == ASJ_OK)
        status = asj_cl_write(context, &table->buffer, 0, table->draft, bytes);
    if (status != ASJ_OK)
        return status;
    void *held = table->draft;
    const size_t capacity = table->draft_capacity;
    table->draft = table->held;
    table->draft_capacity = table->held_capacity;
    table->held = held;
    table->held_capacity = capacity;
    table->held_count = count;
    return ASJ_OK;
}

void asj_cl_table_free(asj_context *context, asj_cl_table *table)
{
    asj_cl_release(context, &table->buffer);
    asj_release(&context->memory, table->held);
    asj_release(&context->memory, table->draft);
    memset(table, 0, sizeof *table);
}

asj_status asj_cl_host_reserve(asj_context *context, asj_cl_host_buffer *buffer, size_t bytes)
{
    if (asj_grow(&context->memory, &buffer->memory, &buffer->capacity, bytes, 1, 0) != ASJ_OK)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu bytes of the device", bytes);
    return ASJ_OK;
}
