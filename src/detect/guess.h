/* SPDX-License-Identifier: BSD-2-Clause */
/* A junction whose lines have been guessed: what is kept of the many hypotheses that the location begins with, of which every
 * tenth stays. A quarter of an asj_hypothesis. */
#ifndef ASJ_SRC_GUESS_H
#define ASJ_SRC_GUESS_H

#include "hypothesis.h"

typedef struct asj_guess {
    double x, y;                           /* px: guessed */
    double log_nfa;                        /* these as in asj_hypothesis */
    double first;
    double angle[ASJ_MAX_BRANCHES], offset[ASJ_MAX_BRANCHES], apart[ASJ_MAX_BRANCHES];
    uint16_t strength[ASJ_MAX_BRANCHES];   /* as in asj_isotropic_junction */
    uint16_t x0, y0;                       /* px: where the isotropic test found it */
    uint16_t radius;                       /* px */
    uint16_t branch_count;                 /* 0 = rejected */
} asj_guess;

/* Of a hypothesis that asj_hypothesis_start() has made and asj_locate_guess() has changed; and back, to the same hypothesis. */
asj_guess asj_guess_of(const asj_hypothesis *hypothesis);
void asj_guess_restore(const asj_guess *guess, asj_hypothesis *hypothesis);

/* Drops rejected guesses, and those of one corner but for the most meaningful: see guess.c. Sorts by meaningfulness, ties by place.
 * Returns how many stay, at the front. `cells` is scratch of asj_close_grid_cells() elements. */
size_t asj_guess_drop_twins(asj_guess *guesses, size_t count, int32_t width, int32_t height, int32_t *cells);

/* Sorts by meaningfulness, ties by place. */
void asj_guess_sort(asj_guess *guesses, size_t count);

#endif
