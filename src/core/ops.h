/* SPDX-License-Identifier: BSD-2-Clause */
/* The operations that other forms replace: one small table for each step that has any, declared in the step's header, with the
 * reference form in the step's file, which is the definition: every other form gives the same bits (tests/parity). Vector forms
 * (simd) and devices (cl) fill in what they do better; tables.h, above all of them, puts them together. Decisions on small data
 * are in no table: they exist once. */
#ifndef ASJ_SRC_CORE_OPS_H
#define ASJ_SRC_CORE_OPS_H

typedef struct asj_ops {
    const char *name;                   /* of the form: "avx2", "opencl" .. */
    struct asj_image_ops *image;         /* core/image.h */
    struct asj_pyramid_ops *pyramid;     /* core/pyramid.h */
    struct asj_gradient_ops *gradient;   /* detect/gradient.h */
    struct asj_field_ops *field;         /* detect/field.h */
    struct asj_isotropic_ops *isotropic; /* detect/isotropic.h */
    struct asj_line_ops *line;           /* detect/line_sums.h */
    struct asj_arc_ops *arc;             /* detect/ray_walk.h */
    struct asj_scan_ops *scan;           /* detect/scan.h */
    struct asj_strip_ops *strip;         /* detect/strip.h */
    struct asj_wedge_ops *wedge;         /* detect/blurred_wedge.h */
    struct asj_edge_ops *edge;           /* detect/edge_rows.h */
    struct asj_patch_ops *patch;         /* match/patch.h */
    struct asj_describe_ops *describe;   /* match/describe.h */
    struct asj_bound_ops *bound;         /* match/product_bound.h */
    struct asj_rank_ops *rank;           /* match/shortlist.h */
    struct asj_disc_ops *disc;           /* match/disc.h */
    struct asj_gate_ops *gate;           /* match/support_gate.h */
    struct asj_near_ops *near;           /* geometry/near.h */
    struct asj_ratio_ops *ratio;         /* geometry/ratios.h */
} asj_ops;

#endif
