/* SPDX-License-Identifier: BSD-2-Clause */
/* The vector forms: each puts into the tables what it does better. Call one only where the processor has its instructions. */
#ifndef ASJ_SRC_SIMD_VARIANTS_H
#define ASJ_SRC_SIMD_VARIANTS_H

#include "core/ops.h"

void asj_fill_vectors(const asj_ops *ops);
void asj_fill_sse2(const asj_ops *ops);
void asj_fill_avx2(const asj_ops *ops);
void asj_fill_avx512(const asj_ops *ops); /* on top of asj_fill_avx2() */
void asj_fill_neon(const asj_ops *ops);

#endif
