/* SPDX-License-Identifier: BSD-2-Clause */
/* What each instruction set puts into the table of operations. */
#ifndef ASJ_SRC_SIMD_VARIANTS_H
#define ASJ_SRC_SIMD_VARIANTS_H

#include "ops.h"

void asj_ops_sse2(asj_ops *ops);
void asj_ops_avx2(asj_ops *ops);
void asj_ops_avx512(asj_ops *ops);
void asj_ops_neon(asj_ops *ops);

#endif
