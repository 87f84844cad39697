/* SPDX-License-Identifier: BSD-2-Clause */
/* Whole-image operations on lists: rays (scan_operation.c), patches and partners (match_operations.c). As operations.h has them.
 * And what has a file of its own. */
#ifndef ASJ_TESTS_PARITY_MORE_OPERATIONS_H
#define ASJ_TESTS_PARITY_MORE_OPERATIONS_H

#include "operations.h"

size_t rays_size(const subject *s);
asj_status run_rays(asj_context *context, const subject *s, uint16_t *scratch, void *output);

/* The sums of a blurred wedge (wedge_operation.c). */
size_t wedge_size(const subject *s);
asj_status run_wedge(asj_context *context, const subject *s, uint16_t *scratch, void *output);

/* Canonical patches of random frames, and which of them can be used. */
size_t patches_size(const subject *s);
double patches_bytes(const subject *s);
asj_status run_patches(asj_context *context, const subject *s, uint16_t *scratch, void *output);

/* The best partners of random L-junctions. */
size_t partners_size(const subject *s);
asj_status run_partners(asj_context *context, const subject *s, uint16_t *scratch, void *output);

/* Parts of the matcher that instruction sets replace (patches.c): a blurred row, samples of a pyramid, discs, products of patches,
 * bounds of them, the support gate. */
size_t blur_size(const subject *s);
asj_status run_blur(asj_context *context, const subject *s, uint16_t *scratch, void *output);
size_t samples_size(const subject *s);
asj_status run_samples(asj_context *context, const subject *s, uint16_t *scratch, void *output);
size_t discs_size(const subject *s);
asj_status run_discs(asj_context *context, const subject *s, uint16_t *scratch, void *output);
size_t products_size(const subject *s);
asj_status run_products(asj_context *context, const subject *s, uint16_t *scratch, void *output);
size_t bounds_size(const subject *s);
asj_status run_bounds(asj_context *context, const subject *s, uint16_t *scratch, void *output);
size_t gate_size(const subject *s);
asj_status run_gate(asj_context *context, const subject *s, uint16_t *scratch, void *output);

/* Which candidates are near a geometry (near_operation.c). */
size_t near_size(const subject *s);
asj_status run_near(asj_context *context, const subject *s, uint16_t *scratch, void *output);

/* How likely candidates are under a geometry (ratio_operation.c). */
size_t ratio_size(const subject *s);
asj_status run_ratio(asj_context *context, const subject *s, uint16_t *scratch, void *output);

#endif
