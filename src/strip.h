/* SPDX-License-Identifier: BSD-2-Clause */
/* Validation of a branch: the a-contrario test of the strip of pixels along it. */
#ifndef ASJ_SRC_STRIP_H
#define ASJ_SRC_STRIP_H

#include "image.h"

/* Natural logarithm of the number of false alarms of the strip from (x, y) in direction `angle` (rad), `length` px long. */
double asj_strip_log_nfa(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         double x, double y, double angle, double length);

#endif
