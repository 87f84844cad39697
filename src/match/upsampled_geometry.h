/* SPDX-License-Identifier: BSD-2-Clause */
/* What the geometry of one look (looks.h) makes of the matches of the other. */
#ifndef ASJ_SRC_UPSAMPLED_GEOMETRY_H
#define ASJ_SRC_UPSAMPLED_GEOMETRY_H

#include "looks.h"

/* The matches of the one by the accepted geometry of the other, which is that of both from now on. ASJ_ERROR_MEMORY. */
asj_status asj_looks_judge(asj_context *context, const asj_match_result *by, asj_match_result *judged);

/* Both by that of the upsampled images, where they have one, after it has chosen. ASJ_ERROR_MEMORY. */
asj_status asj_looks_judge_by_upsampled(asj_context *context, asj_match_result *own, asj_match_result *upsampled);

/* The matches of the one that the accepted geometry of the other contradicts are rejected, too. ASJ_ERROR_MEMORY. */
asj_status asj_looks_filter(asj_context *context, const asj_match_result *by, asj_match_result *judged);

/* Says of a result that its geometry is ambiguous, of two that are at odds; neither is the result's own. */
void asj_looks_leave_open(const asj_geometry *own, const asj_geometry *upsampled, asj_match_result *result);

#endif
