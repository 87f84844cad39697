/* SPDX-License-Identifier: BSD-2-Clause */
/* What speaks against a geometry: matches and pictures of another one, and pictures by themselves. A finalist becomes the first one
 * (e->first), then others are compared with it, one after the other (e->other). */
#ifndef ASJ_SRC_GEOMETRY_CONTRADICTION_H
#define ASJ_SRC_GEOMETRY_CONTRADICTION_H

#include "estimation.h"

#define ASJ_CONTRARY_ALIKE 0.15 /* of its matches, what makes another motion with as much evidence a rival */
#define ASJ_AS_GOOD 0.1 /* of shares of agreement: smaller differences say nothing */
#define ASJ_FEW_MATCHES 17.0 /* (497 rooms: with 15, 2 more have a wrong pose, by 34 and 92 degrees, and 5 a right one) */

/* What there is between the first geometry and another one. Against one of them speak colours and pictures, in favour of the
 * other: above 1 they contradict it. */
typedef struct asj_comparison {
    double contrary;      /* part of the other's matches that contradict the first one: other partners of places that it matches */
    double shared;        /* part of them that are matches of the first one as well */
    double against_other;
    double against_first;
    double votes_against_first; /* .. without how well the pictures agree with each of the two by itself */
    double preference;    /* nats: so much more the pictures say for the other one, which cannot be right beside the first one;
                           * negative: for the first one; 0: they prefer neither */
} asj_comparison;

/* Finalist `number` becomes the first one. */
void asj_compare_from(asj_estimation *e, int32_t number);

/* Compares another geometry with it, which must stay until the next one is compared. */
asj_comparison asj_compare_with(asj_estimation *e, const asj_model *other);

/* How well the pictures agree with the other one. They are looked at when this is asked, or when they matter to the comparison:
 * mostly its matches contradict too little for that. */
const asj_agreement *asj_agreement_of_other(asj_estimation *e);

/* Do colours, pictures or the way that is up contradict finalist `rival`, the other one, in favour of finalist `best`, the first
 * one? */
int32_t asj_is_contradicted(const asj_estimation *e, int32_t best, int32_t rival, const asj_comparison *comparison);

/* Are these two motions of which one at most is right, whatever they have matched? */
int32_t asj_exclude_each_other(const asj_model *a, const asj_model *b);

/* Does finalist `best` turn the room over where motion `rival`, which cannot be right beside it, leaves it upright and has about
 * as much evidence? */
int32_t asj_is_upright_instead(const asj_estimation *e, int32_t best, int32_t rival);

/* Do the pictures disagree with a geometry with which they agree so well, and which has such an NFA, whatever else there is? 0
 * without them. */
int32_t asj_pictures_disagree(const asj_estimation *e, asj_agreement agreement, double log10_nfa);

/* How well the pictures agree with a model that is the first one, as it is told; 0 and 0 where nobody has shown them, or it has no
 * planes to see them through. */
asj_agreement asj_told_agreement(const asj_estimation *e, const asj_model *first);

/* upright.h */
int32_t asj_finalist_turns_over(const asj_estimation *e, int32_t number);

#endif
