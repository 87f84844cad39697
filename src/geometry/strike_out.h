/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_STRIKE_OUT_H
#define ASJ_SRC_GEOMETRY_STRIKE_OUT_H

#include "estimation.h"

/* Strikes out geometries that colours and pictures contradict (asj_model.struck); what is best then is the answer, with another
 * focal length where that is another motion's. Errors: memory. */
asj_status asj_strike_out(asj_estimation *e);

#endif
