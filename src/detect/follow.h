/* SPDX-License-Identifier: BSD-2-Clause */
/* Branches of an isotropic junction, followed outwards. */
#ifndef ASJ_SRC_FOLLOW_H
#define ASJ_SRC_FOLLOW_H

#include "detection_run.h"

/* Improves the orientations of the branches, or rejects the junction (branch_count 0). */
void asj_follow(const asj_detection_run *run, asj_hypothesis *hypothesis);

#endif
