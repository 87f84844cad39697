/* SPDX-License-Identifier: BSD-2-Clause */
/* What speaks against a geometry: matches and pictures of another one, and pictures by themselves. A first one is looked at, then
 * others are compared with it, one after the other. */
#ifndef ASJ_SRC_GEOMETRY_CONTRADICTION_H
#define ASJ_SRC_GEOMETRY_CONTRADICTION_H

#include "estimation.h"

#define ASJ_CONTRARY_ALIKE 0.15 /* of its matches, what makes another motion with as much evidence a rival */
#define ASJ_FEW_MATCHES 17.0 /* (497 rooms: with 15, 2 more have a wrong pose, by 34 and 92 degrees, and 5 a right one) */

/* Finalist `number` is what others are compared with: its probabilities (scratch), and what it says of places and pictures. */
void asj_compare_from(asj_estimation *e, int32_t number);

/* How much of another geometry's matches contradicts the first one, a part of all: it gives another partner to a place that the
 * first one has matched. Its probabilities are in e->other then, and it has looked at the pictures. */
double asj_compare_with(asj_estimation *e, const asj_model *other);

/* How much colours and pictures speak against the other geometry, or against the first one: above 1 they contradict it.
 * contrary: of asj_compare_with(). */
double asj_against_other(const asj_estimation *e, double contrary);
double asj_against_first(const asj_estimation *e, double contrary);
/* .. without what the pictures say of each by itself. */
double asj_votes_against_first(const asj_estimation *e, double contrary);

/* Do colours, pictures or the way that is up contradict finalist `rival`, the other one, in favour of finalist `best`? */
int32_t asj_is_contradicted(const asj_estimation *e, int32_t best, int32_t rival, double contrary);

/* Do colours and pictures contradict a geometry in favour of the first one? It becomes the other one. */
int32_t asj_contradicts(asj_estimation *e, const asj_model *other);

/* Do the pictures disagree with the first one, or the other one, which has such an NFA, whatever else there is? 0 without them. */
int32_t asj_pictures_disagree_with_first(const asj_estimation *e, double log10_nfa);
int32_t asj_pictures_disagree_with_other(const asj_estimation *e, double log10_nfa);

/* How well the pictures agree with the first one; 0 and 0 where nobody has shown them, or it has no planes to see them through. */
asj_agreement asj_agreement_of_first(const asj_estimation *e, const asj_model *first);

/* upright.h */
int32_t asj_finalist_turns_over(const asj_estimation *e, int32_t number);

#endif
