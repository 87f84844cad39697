/* SPDX-License-Identifier: BSD-2-Clause */
#include "growth_plot.h"

#include <math.h>

void growth_fit(const growth_curve *curve, int32_t first, double *factor, double *exponent)
{
    double x = 0, y = 0, xx = 0, xy = 0;
    const double n = curve->count - first;
    for (int32_t i = first; i < curve->count; i++) {
        x += log(curve->x[i]) / n;
        y += log(curve->y[i]) / n;
    }
    for (int32_t i = first; i < curve->count; i++) {
        xx += (log(curve->x[i]) - x) * (log(curve->x[i]) - x);
        xy += (log(curve->x[i]) - x) * (log(curve->y[i]) - y);
    }
    *exponent = xy / xx;
    *factor = exp(y - *exponent * x);
}
