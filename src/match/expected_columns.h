/* SPDX-License-Identifier: BSD-2-Clause */
/* Which of many L-junctions of image 2 may be partners of one of image 1: asj_may_be_partners() of many at once. */
#ifndef ASJ_SRC_EXPECTED_COLUMNS_H
#define ASJ_SRC_EXPECTED_COLUMNS_H

#include "expected.h"

/* Of the L-junctions of image 2, number after number. */
typedef struct asj_expected_columns {
    float *x, *y;                       /* where each lies, */
    float *left, *top, *right, *bottom; /* and the box of its partners */
} asj_expected_columns;

/* Of `count` L-junctions. Free it either way. */
asj_status asj_expected_columns_create(asj_context *context, const asj_expected *expected, uint32_t count,
                                       asj_expected_columns *columns);
void asj_expected_columns_free(asj_memory *memory, asj_expected_columns *columns);

/* Bit n: whether L-junction first + n of image 2 may be a partner of i of image 1; of `count`, ASJ_EXPECTED_AT_ONCE at most. */
#define ASJ_EXPECTED_AT_ONCE 64
uint64_t asj_expected_among(const asj_expected_columns *columns, const asj_expected *expected, uint32_t i, uint32_t first,
                            uint32_t count);

#endif
