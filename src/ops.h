/* SPDX-License-Identifier: BSD-2-Clause */
/* The one table of operations that back ends replace. Each step's own file holds the reference in portable C, which is the
 * definition: every replacement gives the same bits (tests/parity). Decisions on small data are not in the table: they exist
 * once. */
#ifndef ASJ_SRC_OPS_H
#define ASJ_SRC_OPS_H

#include "match/agreement.h"
#include "match/align.h"
#include "match/distance.h"
#include "detect/isotropic.h"
#include "detect/line_sums.h"
#include "detect/scan.h"
#include "detect/strip.h"

typedef struct asj_ops {
    const char *name;

    /* ---- steps over whole images or bands of rows: what a device replaces, keeping its own copies of the planes ---- */

    /* asj_gradient() (gradient.h) */
    asj_status (*gradient)(asj_context *context, asj_frame *frame, const asj_detect_options *options);
    /* asj_field_rows() (field.h) */
    asj_status (*field_rows)(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                             uint16_t *scratch, size_t scratch_size, uint16_t *masks);
    /* asj_isotropic_rows() (isotropic.h) */
    asj_status (*isotropic_rows)(asj_context *context, const asj_isotropic *test, const asj_frame *frame, int32_t top,
                                 int32_t bottom, const uint16_t *masks, const size_t *starts, uint16_t *scratch,
                                 size_t scratch_size, asj_isotropic_junction *junctions);
    /* asj_scan_rays() (scan.h) */
    asj_status (*scan_rays)(asj_context *context, const asj_scan *scan, const asj_frame *frame, asj_ray *rays, size_t count);

    /* asj_describe_frames() and asj_rank_partners() (distance.h) */
    asj_status (*describe_frames)(asj_context *context, const asj_match_options *options, asj_view *view);
    asj_status (*rank_partners)(asj_context *context, const asj_match_options *options, const asj_view *view1,
                                const asj_view *view2, asj_partner *rows, asj_partner *columns);

    /* ---- parts of an image: what an instruction set of the CPU replaces ---- */

    /* asj_image_luma() (image.h) */
    void (*image_luma)(const uint8_t *pixels, int32_t width, int32_t step, int32_t red, uint16_t *gray);
    /* asj_gradient_slide() and asj_gradient_normalise() (gradient.h) */
    void (*gradient_slide)(const asj_gradient_row *row, uint16_t *norms, uint16_t *low, uint16_t *high);
    void (*gradient_normalise)(const asj_gradient_row *row, const uint16_t *norms, const uint16_t *low, const uint16_t *high,
                               int16_t *gx, int16_t *gy);

    /* asj_field_tile() and asj_field_pixels() (field.h) */
    void (*field_tile)(const asj_field *field, const asj_frame *frame, int32_t run, int32_t runs,
                       int32_t top, int32_t bottom, uint16_t *scratch, uint16_t *masks);
    void (*field_pixels)(const asj_field *field, const asj_frame *frame, const asj_pixel *pixels, int32_t count,
                         uint16_t *scratch, asj_field_branch (*branches)[ASJ_FIELD_BRANCHES]);
    /* asj_isotropic_band() (isotropic.h) */
    void (*isotropic_band)(const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom, const uint16_t *masks,
                           uint16_t *scratch, asj_isotropic_junction *junctions);
    /* asj_line_sums_of(), asj_line_profile_of() (line_sums.h) */
    void (*line_sums)(const asj_frame *frame, const asj_line_band *band, asj_line_sums sums[2]);
    void (*line_profile)(const asj_frame *frame, const asj_line_profile *profile, asj_profile_sums *sums);
    /* asj_strip_sums_of() (strip.h) */
    void (*strip_sums)(const asj_frame *frame, const asj_strip_walk *walk, asj_strip_sums *sums);

    /* asj_patch_levels(), asj_patch_normalise() and asj_patch_products() (patch.h) */
    int32_t (*patch_levels)(const asj_pyramid *pyramid, const asj_patch_grid *grid, int32_t size, uint16_t *grey);
    void (*patch_normalise)(const uint16_t *grey, int32_t size, int16_t *unit);
    void (*patch_products)(const int16_t *left, const int16_t *rights, int32_t length, const int32_t *which, int32_t count,
                           int32_t *products);
    /* asj_sketch_above() (sketch.h) */
    int32_t (*sketch_above)(const int16_t *left, const int16_t *right, const int32_t *least, int32_t most, int32_t first,
                            int32_t end, int32_t *which);
    /* asj_blur_row() and asj_pyramid_sample_reference() (pyramid.h) */
    void (*blur_row)(const uint16_t *const *rows, const int32_t *taps, int32_t radius, int32_t width, uint16_t *to);
    int32_t (*pyramid_sample)(const asj_pyramid *pyramid, int32_t level, const float *x, const float *y, int32_t count,
                              uint16_t *grey);
    /* asj_disc_compare() (align.h) */
    void (*disc_compare)(const asj_disc *disc, const asj_template *t, const asj_pyramid *pyramid, const asj_disc_map *map,
                         asj_disc_sums *sums);
    /* asj_look_at() (agreement.h) */
    uint64_t (*look_at)(const asj_look *look, const asj_spots *spots, uint32_t first, uint32_t count);
} asj_ops;

/* Sets of replacements, from weaker to stronger. */
enum {
    ASJ_VARIANT_REFERENCE = 0,
    ASJ_VARIANT_SSE2 = 1,
    ASJ_VARIANT_AVX2 = 2,
    ASJ_VARIANT_AVX512 = 3,
    ASJ_VARIANT_NEON = 4,
    ASJ_VARIANT_COUNT = 5
};

/* "reference", "sse2", ... */
const char *asj_ops_name(int32_t variant);

/* Fills the table; 0 when the variant was not built or this processor lacks it, and the table is then left alone. */
int asj_ops_fill(int32_t variant, asj_ops *ops);

/* The strongest variant that this processor has. */
void asj_ops_best(asj_ops *ops);

#endif
