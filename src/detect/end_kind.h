/* SPDX-License-Identifier: BSD-2-Clause */
/* What is at the end of a branch. */
#ifndef ASJ_SRC_END_KIND_H
#define ASJ_SRC_END_KIND_H

#include "edge_rows.h"
#include "hypothesis.h"

/* Directions in which other edges are looked for: 0, 10, .. 150 degrees. */
#define ASJ_END_TURNS 16
typedef struct asj_end_rays {
    double cosine[ASJ_END_TURNS], sine[ASJ_END_TURNS];
} asj_end_rays;

void asj_end_rays_make(asj_end_rays *rays);

/* Ends all branches where their contrast has gone (end_profile.c), if the options ask for that, with its uncertainty. */
void asj_ends_by_contrast(const asj_edge_ops *ops, const asj_frame *frame, const asj_detect_options *options,
                          asj_hypothesis *hypothesis);

/* The same before the branches are judged, of a junction beyond doubt, for those that are too short for the local junctions that
 * the scan follows: they end where their contrast does, if that is farther. */
void asj_ends_of_short(const asj_edge_ops *ops, const asj_frame *frame, const asj_detect_options *options,
                       asj_hypothesis *hypothesis);

/* Sets the kind of every end that is not marked as a junction, and the uncertainty of those that the scan found. */
void asj_end_kinds(const asj_edge_ops *ops, const asj_frame *frame, const asj_end_rays *rays, const asj_detect_options *options,
                   asj_hypothesis *hypothesis);

#endif
