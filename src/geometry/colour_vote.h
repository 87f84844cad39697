/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_COLOUR_VOTE_H
#define ASJ_SRC_GEOMETRY_COLOUR_VOTE_H

#include "candidates.h"

/* How much the colours speak against the second of two geometries, given the probabilities that each gives to the candidates: above
 * 1 they contradict it, below -1 the first one; 0 where nothing is known. room: 4 numbers for each place of the image that has
 * more. */
double asj_colours_against(const asj_pairs *set, const double *first, const double *second, double *room);

#endif
