/* SPDX-License-Identifier: BSD-2-Clause */
/* How cost grows: points, the exponent fitted to them, and their picture. */
#ifndef ASJ_TESTS_BENCHMARK_GROWTH_PLOT_H
#define ASJ_TESTS_BENCHMARK_GROWTH_PLOT_H

#include <stdint.h>

#define GROWTH_POINTS 16

typedef struct growth_curve {
    const char *title, *x_label, *y_label;
    int32_t count;
    double x[GROWTH_POINTS], y[GROWTH_POINTS]; /* positive, x rising */
} growth_curve;

/* y = factor x^exponent through the points from `first` on, by least squares of the logarithms. At least two points. */
void growth_fit(const growth_curve *curve, int32_t first, double *factor, double *exponent);

/* Four curves, two by two, on logarithmic axes, each with the line fitted to all its points; PNG, SVG or PDF by the end of the
 * name. 0, or -1 with a line on standard error; -1 as well in a build without cairo. */
int growth_plot(const char *path, const growth_curve curves[4]);

#endif
