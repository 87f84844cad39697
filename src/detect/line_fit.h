/* SPDX-License-Identifier: BSD-2-Clause */
/* Fits a straight line to the edge under a branch. */
#ifndef ASJ_SRC_LINE_FIT_H
#define ASJ_SRC_LINE_FIT_H

#include "hypothesis.h"
#include "line_sums.h"

typedef struct asj_line_range {
    double first, last;   /* px along the branch */
    double half_width[3]; /* px across, one for each iteration */
    int32_t iterations;   /* 1 .. 3 */
} asj_line_range;

/* The line under a branch as guesses move it: by its direction, since angles take longer. */
typedef struct asj_rough_line {
    double ux, uy;
    double offset, apart; /* as in asj_hypothesis_branch */
} asj_rough_line;

/* Moves branch->angle and branch->offset to the line under the branch of a junction at (x, y); sets their variances. branch->offset
 * is where the search starts. Returns 0, and leaves the branch alone, when there is too little edge. */
int asj_line_fit(const asj_line_ops *ops, const asj_frame *frame, double x, double y, const asj_line_range *range,
                 asj_hypothesis_branch *branch);

/* The same for the branches of a junction, up to ASJ_MAX_BRANCHES, whose directions are known already: those of `along`, nothing
 * else of which counts. fitted[i]: what asj_line_fit() returns. */
void asj_line_fit_all(const asj_line_ops *ops, const asj_frame *frame, double x, double y, const asj_rough_line *along,
                      const asj_line_range *range, int32_t count, asj_hypothesis_branch *branches, int *fitted);

asj_rough_line asj_rough_line_of(const asj_hypothesis_branch *branch);
void asj_rough_line_keep(const asj_rough_line *rough, asj_hypothesis_branch *branch);

/* One iteration of the same on whole pixels, t[0] .. t[1] px along the line: a tenth of the time, no variances. */
int asj_line_guess(const asj_line_ops *ops, const asj_frame *frame, double x, double y, const double t[2], double half_width,
                   asj_rough_line *rough);

/* The same for the lines of up to ASJ_MAX_BRANCHES branches of a junction; found[i]: whether line i was. */
void asj_line_guess_all(const asj_line_ops *ops, const asj_frame *frame, double x, double y, const double t[2], double half_width,
                        int32_t count, asj_rough_line *rough, int *found);

#endif
