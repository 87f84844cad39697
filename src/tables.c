/* SPDX-License-Identifier: BSD-2-Clause */
/* The tables of operations, filled with the reference and a vector form; which forms this processor runs. */
#include "tables.h"
#include "simd/variants.h"

/* The build says which forms it holds: ASJ_HAVE_SSE2, ASJ_HAVE_AVX2, ASJ_HAVE_AVX512, ASJ_HAVE_NEON,
 * ASJ_HAVE_VECTORS. */

static void fill_reference(asj_tables *t)
{
    t->image = asj_image_reference;
    t->pyramid = asj_pyramid_reference;
    t->gradient = asj_gradient_reference;
    t->field = asj_field_reference;
    t->isotropic = asj_isotropic_reference;
    t->line = asj_line_reference;
    t->arc = asj_arc_reference;
    t->scan = asj_scan_reference;
    t->strip = asj_strip_reference;
    t->wedge = asj_wedge_reference;
    t->edge = asj_edge_reference;
    t->patch = asj_patch_reference;
    t->describe = asj_describe_reference;
    t->bound = asj_bound_reference;
    t->rank = asj_rank_reference;
    t->disc = asj_disc_reference;
    t->gate = asj_gate_reference;
    t->near = asj_near_reference;
    t->ratio = asj_ratio_reference;
    t->ops = (asj_ops){
        .image = &t->image, .pyramid = &t->pyramid, .gradient = &t->gradient, .field = &t->field, .isotropic = &t->isotropic,
        .line = &t->line, .arc = &t->arc, .scan = &t->scan, .strip = &t->strip, .wedge = &t->wedge, .edge = &t->edge,
        .patch = &t->patch, .describe = &t->describe, .bound = &t->bound, .rank = &t->rank, .disc = &t->disc, .gate = &t->gate,
        .near = &t->near, .ratio = &t->ratio};
}

int asj_tables_has(int32_t simd)
{
    switch (simd) {
    case ASJ_SIMD_REFERENCE:
#ifdef ASJ_HAVE_SSE2
    case ASJ_SIMD_SSE2:
#endif
#ifdef ASJ_HAVE_AVX2
    case ASJ_SIMD_AVX2:
#endif
#ifdef ASJ_HAVE_AVX512
    case ASJ_SIMD_AVX512:
#endif
#ifdef ASJ_HAVE_NEON
    case ASJ_SIMD_NEON:
#endif
#ifdef ASJ_HAVE_VECTORS
    case ASJ_SIMD_VECTORS:
#endif
        return 1;
    default:
        return 0;
    }
}

#if defined(ASJ_HAVE_AVX2) || defined(ASJ_HAVE_AVX512)
static int processor_has_avx2(void)
{
    return __builtin_cpu_supports("avx2") != 0;
}
#endif

#ifdef ASJ_HAVE_AVX512
static int processor_has_avx512(void)
{
    return processor_has_avx2() && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
           __builtin_cpu_supports("avx512vl");
}
#endif

int asj_tables_runs(int32_t simd)
{
    switch (simd) {
#ifdef ASJ_HAVE_AVX2
    case ASJ_SIMD_AVX2: return processor_has_avx2();
#endif
#ifdef ASJ_HAVE_AVX512
    case ASJ_SIMD_AVX512: return processor_has_avx512();
#endif
    default: return asj_tables_has(simd);
    }
}

/* Overwrites what the form has. */
static void fill_form(int32_t simd, const asj_ops *ops)
{
    (void)ops;
    switch (simd) {
#ifdef ASJ_HAVE_SSE2
    case ASJ_SIMD_SSE2: asj_fill_sse2(ops); break;
#endif
#ifdef ASJ_HAVE_AVX2
    case ASJ_SIMD_AVX2: asj_fill_avx2(ops); break;
#endif
#ifdef ASJ_HAVE_AVX512
    case ASJ_SIMD_AVX512:
        fill_form(ASJ_SIMD_AVX2, ops); /* what 16 lanes do better */
        asj_fill_avx512(ops);
        break;
#endif
#ifdef ASJ_HAVE_NEON
    case ASJ_SIMD_NEON: asj_fill_neon(ops); break;
#endif
#ifdef ASJ_HAVE_VECTORS
    case ASJ_SIMD_VECTORS: asj_fill_vectors(ops); break;
#endif
    default: break;
    }
}

int asj_tables_fill(int32_t simd, asj_tables *tables)
{
    if (!asj_tables_runs(simd))
        return 0;
    fill_reference(tables);
    fill_form(simd, &tables->ops);
    tables->ops.name = asj_simd_name(simd);
    return 1;
}

int32_t asj_tables_best(void)
{
    static const int32_t worst_first[] = {ASJ_SIMD_REFERENCE, ASJ_SIMD_VECTORS, ASJ_SIMD_SSE2,
                                          ASJ_SIMD_AVX2,      ASJ_SIMD_AVX512,  ASJ_SIMD_NEON};
    int32_t best = ASJ_SIMD_REFERENCE;
    for (size_t i = 0; i < sizeof worst_first / sizeof *worst_first; i++)
        best = asj_tables_runs(worst_first[i]) ? worst_first[i] : best;
    return best;
}
