/* SPDX-License-Identifier: BSD-2-Clause */
/* Validation of a branch: the a-contrario test of the strip of pixels along it. */
#ifndef ASJ_SRC_STRIP_H
#define ASJ_SRC_STRIP_H

#include "image.h"

typedef struct asj_strip {
    double log_nfa;   /* natural logarithm of the number of false alarms */
    double deviation; /* rad in [0, pi/2]: between the strip's dominant gradient direction and the normal of the branch */
    double near_strength; /* standard deviations above the null model in the part next to the junction */
} asj_strip;

/* The strip from (x, y) in direction `angle` (rad), `length` px long. */
asj_strip asj_strip_test(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         double x, double y, double angle, double length);

/* Its log_nfa alone. */
double asj_strip_log_nfa(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         double x, double y, double angle, double length);

#endif
