/* SPDX-License-Identifier: BSD-2-Clause */
/* Between steps 3 and 4: sub-pixel location of isotropic junctions, rejection of edge artefacts. */
#ifndef ASJ_SRC_LOCATE_H
#define ASJ_SRC_LOCATE_H

#include "line_fit.h"

/* Fits the branches' lines near the junction and moves it to where they meet; branch_count 0 when it is no junction. First a
 * guess, with some slack in what is asked of its lines, then the fit that counts. units: cosine and sine of the branches' angles,
 * where they are known; NULL = they are not. */
void asj_locate_guess(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                      const double (*units)[2], asj_hypothesis *hypothesis);
void asj_locate(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis);

/* px that a junction with these branches may move while it is located: max_move, or somewhat more at sharp corners. */
double asj_locate_most_move(const asj_detect_options *options, const asj_hypothesis *hypothesis);

/* The most that it says of any branches. */
double asj_locate_farthest_move(const asj_detect_options *options);

/* The least-squares meeting point of the branches' lines becomes the location; the offsets become those from there.
 * Returns 0, and changes nothing, when the lines are too parallel to say where they meet, or, in coarse octaves and without the
 * strip test, all but one of them too uncertain. */
int asj_locate_meet(const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis);

#endif
