/* SPDX-License-Identifier: BSD-2-Clause */
/* For every processor that gcc and clang compile for and that has no form of its own. */
#include "gnu_vectors.h" /* before kernels.h */
#include "simd/kernels.h"
#include "simd/disc_kernels.h"
#include "simd/gate_kernels.h"
#include "simd/line_kernels.h"
#include "simd/patch_kernels.h"
#include "simd/sample_kernels.h"
#include "simd/variants.h"

void asj_fill_vectors(const asj_ops *ops)
{
    fill_kernels(ops);
    fill_lines(ops);
    fill_samples(ops);
    fill_discs(ops);
    fill_gate(ops);
    fill_patches(ops);
}
