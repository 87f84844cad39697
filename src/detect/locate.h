/* SPDX-License-Identifier: BSD-2-Clause */
/* Between steps 3 and 4: sub-pixel location of isotropic junctions, rejection of edge artefacts, suppression of duplicates. */
#ifndef ASJ_SRC_LOCATE_H
#define ASJ_SRC_LOCATE_H

#include "line_fit.h"

/* Whether two of its directions open by minimum_opening: most edges that pass the isotropic test show here. */
int asj_locate_worthwhile(const asj_detect_options *options, const asj_isotropic_junction *junction);

/* Turns an isotropic junction into a draft at its pixel. */
void asj_locate_start(const asj_isotropic_junction *junction, asj_draft *draft);

/* Fits the branches' lines near the junction and moves it to where they meet; branch_count 0 when it is no junction. First a
 * guess, with some slack in what is asked of its lines, then the fit that counts. */
void asj_locate_guess(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft);
void asj_locate(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft);

/* The least-squares meeting point of the branches' lines becomes the location; the offsets become those from there.
 * Returns 0, and changes nothing, when the lines are too parallel to say where they meet. */
int asj_locate_meet(asj_draft *draft);

/* Drops rejected drafts, and those that lie within max(3, 0.35 r) px of a more meaningful one. Sorts by meaningfulness, ties by
 * place. Returns how many stay, at the front. `cells` is scratch of asj_locate_cells() elements. */
size_t asj_locate_suppress(asj_draft *drafts, size_t count, int same, int32_t width, int32_t height, int32_t *cells);
size_t asj_locate_cells(size_t count, int32_t width, int32_t height);

#endif
