/* SPDX-License-Identifier: BSD-2-Clause */
/* Compiled with -mavx512f -mavx512bw; called only where the processor has it. */
#ifdef __GNUC__
#pragma GCC diagnostic ignored "-Wsign-conversion" /* without optimisation gathers are macros of gcc's, whose casts warn here */
#endif
#include "avx512_vectors.h" /* before kernels.h */
#include "simd/kernels.h"
#include "gates512.h"
#include "lines512.h"
#include "simd/variants.h"

void asj_fill_avx512(const asj_ops *ops)
{
    fill_kernels(ops);
    ops->line->sums = line_sums_avx512;
    ops->line->profile = line_profile_avx512;
    ops->gate->pass = support_gate_avx512;
}
