/* SPDX-License-Identifier: BSD-2-Clause */
/* All tables of operations (core/ops.h) together. A vector form or a device fills in what it does better; the rest stays the
 * reference. */
#ifndef ASJ_SRC_TABLES_H
#define ASJ_SRC_TABLES_H

#include "core/pyramid.h"
#include "detect/gradient.h"
#include "detect/isotropic.h"
#include "detect/line_sums.h"
#include "detect/ray_walk.h"
#include "detect/scan.h"
#include "detect/blurred_wedge.h"
#include "detect/edge_rows.h"
#include "detect/strip.h"
#include "geometry/near.h"
#include "geometry/ratios.h"
#include "match/disc.h"
#include "match/describe.h"
#include "match/product_bound.h"
#include "match/shortlist.h"
#include "match/support_gate.h"

typedef struct asj_tables {
    asj_ops ops; /* points to those below */
    asj_image_ops image;
    asj_pyramid_ops pyramid;
    asj_gradient_ops gradient;
    asj_field_ops field;
    asj_isotropic_ops isotropic;
    asj_line_ops line;
    asj_arc_ops arc;
    asj_scan_ops scan;
    asj_strip_ops strip;
    asj_wedge_ops wedge;
    asj_edge_ops edge;
    asj_patch_ops patch;
    asj_describe_ops describe;
    asj_bound_ops bound;
    asj_rank_ops rank;
    asj_disc_ops disc;
    asj_gate_ops gate;
    asj_near_ops near;
    asj_ratio_ops ratio;
} asj_tables;

/* Whether this build has a form (ASJ_SIMD_..., not auto). */
int asj_tables_has(int32_t simd);

/* Whether this processor has it too. */
int asj_tables_runs(int32_t simd);

/* Fills the tables with a form, and what it lacks with the reference; 0 when it does not run here, and they are then left alone.
 * They point to themselves: fill each where it stays. */
int asj_tables_fill(int32_t simd, asj_tables *tables);

/* The strongest form that runs here. */
int32_t asj_tables_best(void);

#endif
