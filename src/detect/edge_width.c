/* SPDX-License-Identifier: BSD-2-Clause */
/* Width of an edge: the standard deviation b of the blur of an ideal step, in pixels.
 *
 * Across a step that a Gaussian has blurred the gradient is G(s) = G(0) exp(-s^2 / (2 b^2)). With the mean gradient along the
 * branch at s = -a, 0, a from its line, which may itself be d off the edge,
 *     G(-a) G(a) / G(0)^2 = exp(-((a - d)^2 + (a + d)^2 - 2 d^2) / (2 b^2)) = exp(-a^2 / b^2)   whatever d,
 * so     b^2 = -a^2 / ln(G(-a) G(a) / G(0)^2) = -a^2 / (2 ln q),   q = sqrt(G(-a) G(a)) / G(0).
 * The differences over two pixels and the interpolation between them blur as well: ASJ_EDGE_SAMPLING of that variance is theirs.
 * An edge whose gradient changes sign within a is sharp: 0. Of a thin line each of the two edges is blurred by no more than half of
 * what is between them. */
#include "edge_width.h"
#include "gray_at.h"

#include <math.h>

#define ACROSS 2.0       /* px: a. Edges of up to 3 px can be told with it, and few neighbours are so close */
#define FIRST 2.0        /* px from the junction and from the end that are left out */
#define LAST 18.0        /* px: more than enough to average noise away */
#define UNKNOWN 10.0     /* px: the same while the length is not known */
#define LEAST_SPAN 4.0   /* px */
#define FLATTEST 0.98    /* q of an edge whose width cannot be told */

/* Sums of the grey level along the branch, at -3, -1, 1 and 3 px from its line: their differences are the gradients at -2, 0 and
 * 2 px. */
static void add_up(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch, double sums[4])
{
    const double ux = cos(branch->angle), uy = sin(branch->angle);
    const double reach = branch->length > 0 ? branch->length - FIRST : UNKNOWN;
    const double last = fmax(fmin(reach, LAST), FIRST + LEAST_SPAN);
    const double step = frame->octave > 0 ? 1 : 2; /* px: where soft edges are many, neighbouring samples say much the same */
    for (double t = FIRST; t <= last; t += step)
        for (int i = 0; i < 4; i++) {
            const double s = branch->offset + ACROSS * (i - 1.5);
            sums[i] += asj_gray_at(frame, hypothesis->x + t * ux - s * uy, hypothesis->y + t * uy + s * ux);
        }
}

static double width_of(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    double sums[4] = {0, 0, 0, 0};
    if (branch->apart > 0)
        return 0.5 * branch->apart;
    add_up(frame, hypothesis, branch, sums);
    const double middle = sums[2] - sums[1], before = sums[1] - sums[0], after = sums[3] - sums[2];
    if (middle == 0)
        return ASJ_WIDEST_EDGE;
    if (before / middle <= 0 || after / middle <= 0)
        return 0;
    const double product = before / middle * (after / middle);
    if (product >= FLATTEST * FLATTEST)
        return ASJ_WIDEST_EDGE;
    const double variance = -ACROSS * ACROSS / log(product) - ASJ_EDGE_SAMPLING;
    return variance > 0 ? fmin(sqrt(variance), ASJ_WIDEST_EDGE) : 0;
}

void asj_edge_widths(const asj_frame *frame, asj_hypothesis *hypothesis)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        hypothesis->branches[i].width = width_of(frame, hypothesis, &hypothesis->branches[i]);
}
