/* SPDX-License-Identifier: BSD-2-Clause */
/* Found junctions against true ones.
 *
 * A true junction is expected when two of its branches open by at least `minimum_opening` and at most pi minus that, are at
 * least MINIMUM_LENGTH = 10 px long, and have a step of at least `minimum_step` grey levels at the junction, and when no other
 * true junction lies within `clearance` px; others are optional: finding them is neither asked for nor wrong.
 *
 * Junctions are paired one to one, closest pairs first, up to LOCATION_LIMIT = 3 px; found ones that pair with nothing are false,
 * and so is the second of two at one corner. recall = paired expected / expected; precision = 1 - false / found.
 *
 * Branches of a pair of junctions are paired likewise by angle, up to ANGLE_LIMIT = 10 deg. Angle and length errors are taken
 * over paired branches of expected junctions, the length against the branch's true end; branches cut by the image border count
 * for the angle only.
 *
 * A long branch is a true one that passes at least one other junction before its end. It is reached when its junction is found
 * and one of its branches, paired with it, ends within FAR_LIMIT = 8 px of the true length. */
#ifndef ASJ_TESTS_ACCURACY_SCORE_H
#define ASJ_TESTS_ACCURACY_SCORE_H

#include "sample.h"
#include "truth.h"

#include <asj/junction.h>

typedef struct score {
    double minimum_opening; /* rad */
    double minimum_step;    /* grey levels */
    double clearance;       /* px */
    int64_t scenes, expected, found, paired, false_found;
    int64_t branches, branches_paired, branches_extra; /* of paired expected junctions */
    int64_t long_branches, long_reached; /* of paired junctions */
    int64_t full_branches, full_reached; /* the long ones that start at the end of their line */
    sample location;      /* px */
    sample angle;         /* deg */
    sample length;        /* px, found minus true */
    sample location_sds;  /* location error / stated uncertainty, where one is stated */
    sample angle_sds;     /* angle error / stated uncertainty */
} score;

void score_init(score *s, double minimum_opening_deg);
void score_free(score *s);

/* Called for every expected junction that was missed and every false one: a line of text. NULL = nothing. */
typedef void (*score_report)(void *user, const char *what, double x, double y);

/* Adds one scene. 0, or -1 (memory). */
int score_add(score *s, const synth_truth *truth, const asj_junction *found, uint32_t count, score_report report, void *user);

double score_recall(const score *s);
double score_precision(const score *s);

#endif
