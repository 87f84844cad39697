/* SPDX-License-Identifier: BSD-2-Clause */
/* A junction in the making: what steps 3 to 5 pass on to each other. */
#ifndef ASJ_SRC_DRAFT_H
#define ASJ_SRC_DRAFT_H

#include "isotropic.h"

typedef struct asj_draft_branch {
    double angle;           /* rad, outwards */
    double length;          /* px; 0 before the scan */
    double scanned[3];      /* x, y, angle of the ray that gave the length */
    double strength;        /* standard deviations */
    double log_nfa;         /* natural logarithm */
    double offset;          /* px: the fitted line passes this far from the junction, along (-sin, cos) of the angle */
    double angle_variance;  /* rad^2 of the fit */
    double offset_variance; /* px^2 of the fit at the junction */
    double apart;           /* px between the two edges of a thin line, 0 = one edge */
} asj_draft_branch;

typedef struct asj_draft {
    double x, y;
    double x0, y0;             /* where the isotropic test found it */
    double radius;
    double log_nfa;
    double location_variance;  /* px^2, mean of both axes */
    int32_t branch_count;      /* 0 = rejected */
    asj_draft_branch branches[ASJ_MAX_BRANCHES];
} asj_draft;

/* Absolute difference of two angles in [0, pi]. */
double asj_angle_distance(double a, double b);

/* An angle brought into [0, 2 pi). */
double asj_angle_wrap(double angle);

/* Removes branches whose flag is 0, keeping the order. */
void asj_draft_select(asj_draft *draft, const int *keep);

/* 1 when two branches open by at least `least` radians and at most pi - least. */
int asj_draft_has_opening(const asj_draft *draft, double least);

#endif
