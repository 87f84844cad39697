/* SPDX-License-Identifier: BSD-2-Clause */
/* The reference form of a fan of rays. */
#include "edge_fan.h"
#include "gradient.h"
#include "strip.h"

#include <math.h>

static double mean_along(const asj_frame *frame, double x, double y, double ux, double uy)
{
    double sum = 0;
    for (int32_t r = ASJ_FAN_FIRST; r <= ASJ_FAN_LAST; r++) {
        const int32_t px = asj_strip_floor(x + r * ux + 0.5), py = asj_strip_floor(y + r * uy + 0.5);
        const ptrdiff_t at = py * frame->stride + px;
        const double gx = frame->gradient_x[at], gy = frame->gradient_y[at];
        const double gamma = fabs(gy * ux - gx * uy) - fabs(gx * ux + gy * uy);
        sum += gamma + fabs(gamma); /* twice what is above 0, without a jump that cannot be foreseen */
    }
    return 0.5 * sum / ((ASJ_FAN_LAST - ASJ_FAN_FIRST + 1) * ASJ_GRADIENT_ONE);
}

void asj_edge_fan_means(const asj_frame *frame, const asj_edge_fan *fan, double x, double y, double means[ASJ_FAN_RAYS])
{
    for (int32_t i = 0; i < fan->count; i++)
        means[i] = mean_along(frame, x, y, fan->ux[i], fan->uy[i]);
}
