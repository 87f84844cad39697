/* SPDX-License-Identifier: BSD-2-Clause */
/* Soft corners that are found twice. */
#ifndef ASJ_SRC_SOFT_TWINS_H
#define ASJ_SRC_SOFT_TWINS_H

#include "detection_run.h"

/* Drops those of the run's hypotheses that a far surer one beside them says as well. ASJ_ERROR_MEMORY. */
asj_status asj_drop_soft_twins(asj_detection_run *run);

#endif
