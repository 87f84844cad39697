/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_STRIKE_OUT_H
#define ASJ_SRC_GEOMETRY_STRIKE_OUT_H

#include "estimation.h"

/* Takes the evidence from geometries that colours and pictures contradict: what is best then is the answer. Errors: memory. */
asj_status asj_strike_out(asj_estimation *e);

#endif
