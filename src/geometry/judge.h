/* SPDX-License-Identifier: BSD-2-Clause */
/* The geometry that was answered, for matches that were no candidates of it. */
#ifndef ASJ_SRC_GEOMETRY_JUDGE_H
#define ASJ_SRC_GEOMETRY_JUDGE_H

#include "likelihood.h"

#include <asj/geometry.h>

typedef struct asj_judge {
    asj_two_view view;
    asj_pairs scales; /* standard deviations, and where wrong partners lie; no candidates */
} asj_judge;

/* Of the geometry that `set` brought. */
asj_judge asj_judge_create(const asj_two_view *view, const asj_pairs *set);

/* The probability that a match is right, whose own is what is known without the geometry, its rivals among it. */
double asj_judge_probability(const asj_judge *judge, const asj_geometry_candidate *match);

#endif
