/* SPDX-License-Identifier: BSD-2-Clause */
/* Which L-junctions (l_junctions.h) are part of a T. */
#ifndef ASJ_SRC_T_JUNCTIONS_H
#define ASJ_SRC_T_JUNCTIONS_H

#include "l_junctions.h"

/* Sets t_junction, from locations and directions. ASJ_ERROR_MEMORY. */
asj_status asj_t_junctions_find(asj_context *context, asj_l_junctions *all);

#endif
