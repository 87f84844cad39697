/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, where partners are expected: of the L-junctions near the right place a fifth may be partners of a given one, and asking
 * all of them costs more than comparing those. So their numbers lie in columns, of which compilers test several at once. */
#include "expected_columns.h"

#include <string.h>

asj_status asj_expected_columns_create(asj_context *context, const asj_expected *expected, uint32_t count,
                                       asj_expected_columns *columns)
{
    float *block = asj_allocate(&context->memory, count, 6 * sizeof *block);
    memset(columns, 0, sizeof *columns);
    if (!block)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the places of %u partners", (unsigned)count);
    *columns = (asj_expected_columns){block, block + count, block + 2 * (size_t)count, block + 3 * (size_t)count,
                                      block + 4 * (size_t)count, block + 5 * (size_t)count};
    for (uint32_t j = 0; j < count; j++) {
        const asj_box *box = &expected->boxes[1][j];
        columns->x[j] = expected->points[1][j].x;
        columns->y[j] = expected->points[1][j].y;
        columns->left[j] = box->left;
        columns->top[j] = box->top;
        columns->right[j] = box->right;
        columns->bottom[j] = box->bottom;
    }
    return ASJ_OK;
}

void asj_expected_columns_free(asj_memory *memory, asj_expected_columns *columns)
{
    asj_release(memory, columns->x);
    memset(columns, 0, sizeof *columns);
}

uint64_t asj_expected_among(const asj_expected_columns *columns, const asj_expected *expected, uint32_t i, uint32_t first,
                            uint32_t count)
{
    const asj_point p = expected->points[0][i];
    const asj_box box = expected->boxes[0][i];
    const float *x = columns->x + first, *y = columns->y + first, *left = columns->left + first, *top = columns->top + first;
    const float *right = columns->right + first, *bottom = columns->bottom + first;
    uint32_t may[ASJ_EXPECTED_AT_ONCE];
    uint64_t bits = 0;
    for (uint32_t n = 0; n < count; n++)
        may[n] = (uint32_t)((x[n] >= box.left) & (x[n] <= box.right) & (y[n] >= box.top) & (y[n] <= box.bottom) &
                            (p.x >= left[n]) & (p.x <= right[n]) & (p.y >= top[n]) & (p.y <= bottom[n]));
    for (uint32_t n = 0; n < count; n++)
        bits |= (uint64_t)may[n] << n;
    return bits;
}
