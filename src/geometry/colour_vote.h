/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_COLOUR_VOTE_H
#define ASJ_SRC_GEOMETRY_COLOUR_VOTE_H

#include "candidates.h"

/* Do the colours contradict the second of two geometries, given the probabilities that each gives to the candidates? 1, or 0.
 * room: 4 numbers for each place of the image that has more. */
int32_t asj_colours_contradict(const asj_pairs *set, const double *first, const double *second, double *room);

#endif
