/* SPDX-License-Identifier: BSD-2-Clause */
/* Compiled with -mavx2; called only where the processor has it. */
#include "avx2_vectors.h" /* before kernels.h */
#include "detect/blurred_wedge_sums.h"
#include "simd/kernels.h"
#include "arcs.h"
#include "colour.h"
#include "discs.h"
#include "edges.h"
#include "fans.h"
#include "gates.h"
#include "lines.h"
#include "nears.h"
#include "patches.h"
#include "ratios.h"
#include "strips.h"
#include "simd/variants.h"

void asj_fill_avx2(const asj_ops *ops)
{
    fill_kernels(ops);
    ops->image->luma = image_luma_avx2;
    ops->pyramid->blur_row = blur_row_avx2;
    ops->pyramid->sample = pyramid_sample_avx2;
    ops->line->sums = line_sums_avx2;
    ops->line->profile = line_profile_avx2;
    ops->arc->place = place_arc_avx2;
    ops->arc->sum = sum_arc_avx2;
    ops->strip->sums = strip_sums_avx2;
    ops->wedge->add_up = wedge_add_up;
    ops->edge->rows = edge_rows_avx2;
    ops->edge->fan = edge_fan_avx2;
    ops->patch->levels = patch_levels_avx2;
    ops->patch->normalise = patch_normalise_avx2;
    ops->disc->compare = disc_compare_avx2;
    ops->gate->pass = support_gate_avx2;
    ops->near->lines = near_lines_avx2;
    ops->near->places = near_places_avx2;
    ops->ratio->lines = ratio_lines_avx2;
    ops->ratio->places = ratio_places_avx2;
}
