/* SPDX-License-Identifier: BSD-2-Clause */
/* Part of every x86-64 processor; on others compiled with -msse2 and called only where the processor has it. */
#include "sse2_vectors.h" /* before kernels.h */
#include "simd/kernels.h"
#include "simd/disc_kernels.h"
#include "simd/gate_kernels.h"
#include "simd/line_kernels.h"
#include "simd/normal_kernels.h"
#include "simd/patch_kernels.h"
#include "simd/sample_kernels.h"
#include "simd/variants.h"

void asj_fill_sse2(const asj_ops *ops)
{
    fill_kernels(ops);
    fill_lines(ops);
    fill_samples(ops);
    fill_discs(ops);
    fill_gate(ops);
    fill_patches(ops);
    fill_normal(ops);
}
