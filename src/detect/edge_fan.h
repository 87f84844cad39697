/* SPDX-License-Identifier: BSD-2-Clause */
/* How much of an edge there is under short rays from one place. */
#ifndef ASJ_SRC_EDGE_FAN_H
#define ASJ_SRC_EDGE_FAN_H

#include "core/image.h"

#define ASJ_FAN_RAYS 16
#define ASJ_FAN_FIRST 2 /* px along a ray: its first sample, */
#define ASJ_FAN_LAST 8  /* and its last */

/* The unit vectors of rays; 0 where there is none. */
typedef struct asj_edge_fan {
    int32_t count;
    double ux[ASJ_FAN_RAYS], uy[ASJ_FAN_RAYS];
} asj_edge_fan;

/* Of each ray from (x, y) the mean of gamma = max(|g.n| - |g.u|, 0), n and u across and along the ray, in standard deviations of
 * noise. Outside the image the gradient is zero; its margin is wider than a ray is long. What stands behind the last ray's mean is
 * anything. */
void asj_edge_fan_means(const asj_frame *frame, const asj_edge_fan *fan, double x, double y, double means[ASJ_FAN_RAYS]);

#endif
