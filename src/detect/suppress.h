/* SPDX-License-Identifier: BSD-2-Clause */
/* After the location and after step 5: of hypotheses that lie close together the most meaningful one stays. */
#ifndef ASJ_SRC_SUPPRESS_H
#define ASJ_SRC_SUPPRESS_H

#include "close_grid.h"
#include "detection_run.h"

/* Of the hypotheses behind `validated` ones: drops rejected ones and all within max(3, 0.35 r) px of a validated or more meaningful
 * one of radius r. Sorts them by meaningfulness, ties by place. Returns how many there are then, validated ones
 * included, at the front. `cells` is scratch of asj_close_grid_cells() elements. */
size_t asj_suppress(asj_hypothesis *hypotheses, size_t validated, size_t count, int32_t width, int32_t height, int32_t *cells);

/* Whether one of the hypotheses in the grid suppresses what lies at (x, y), px, or `spare` px farther away from it. */
int asj_suppress_hides(const asj_hypothesis *hypotheses, const asj_close_grid *grid, double x, double y, double spare);

/* Sorts by meaningfulness, ties by place. */
void asj_suppress_sort(asj_hypothesis *hypotheses, size_t count);

/* asj_suppress() of what a run has found. */
asj_status asj_suppress_all(asj_detection_run *run);

#endif
