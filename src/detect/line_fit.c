/* SPDX-License-Identifier: BSD-2-Clause */
/* Weighted line fit to an edge, the work of steps 3 and 5 (replaces the paper's search over +-0.1 rad, which is kept as the option
 * refinement = search: search.c).
 *
 * In the frame of the branch (t along u, s along n = u turned by +90 degrees) samples lie at t = first, first + 1, .., or as many
 * as there is room for, farther apart on a long branch, and evenly from s = -w to w, about a pixel apart. Each has the weight of
 * its raw gradient's agreement with the branch, w(t, s) = max(|g.n| - |g.u|, 0), the same form as the junction-ness. Per t:
 * centroid c(t) = sum w s / sum w and weight W(t) = sum w. Weighted least squares c = a + b t gives the line; it is repeated around
 * the line found, in a narrower band.
 *
 * The two signs of g.n (dark to bright, bright to dark) are fitted apart. Indoor scenes are full of narrow bands, the two edges of
 * a door jamb or a skirting board, and a fit that mixes them follows neither. The stronger sign gives the line; when both are
 * strong and no more than THIN px apart all along, the branch is a thin line, and the middle of both is taken.
 *
 * Covariance: with residuals e(t), variance s^2 = sum W e^2 / (n - 2) per unit of weight; then cov(a, b) = s^2 (X' W X)^-1.
 * Neighbouring samples share pixels, so s^2 is multiplied by factors that make errors and stated uncertainties agree on synthetic
 * scenes (tests/accuracy). */
#include "line_fit.h"

#include <math.h>

#define MAX_SAMPLES ASJ_PROFILE_SAMPLES

#define OFFSET_CORRELATION 3.0 /* factors of s^2: see above */
#define ANGLE_CORRELATION 10.0
#define LEAST_ERROR 0.03       /* px: systematic error of a centroid (sampling, interpolation), at either end of a line */

/* The weaker sign makes a thin line of the two if it has this share of the stronger one's weight. Chosen: less takes faint edges
 * beside a strong one for its partner, more leaves bands between unlike surfaces to one of their edges. */
#define BOTH_STRONG 0.4

/* px: the largest distance of the edges of a thin line, and the largest half-width of the band in which both are looked for, for
 * which a profile has room: 2 ceil(4.5) + 1 = ASJ_PROFILE_OFFSETS. */
#define THIN 4.5
#define WIDEST 4.5

/* Least variance of t over the weights, relative to its mean square from the junction: of a fit over samples, and of one over whole
 * pixels, which asks for a few pixels of the branch. Below, rounding or a single pixel decides. */
#define LEAST_SPREAD 1e-5
#define LEAST_PIXEL_SPREAD 1e-2

/* Where a line is looked for: from (x, y) along (ux, uy). */
typedef struct axis {
    double x, y, ux, uy;
} axis;

/* The samples of a band around the line s = a + b t: of sign 1 where the gradient points along +n, of sign 0 along -n. Centroids
 * are r(t) from there; no sum needs one, but for the residuals. */
typedef struct samples {
    asj_line_profile profile;
    asj_profile_sums sums; /* W(t) and W(t) r(t) */
    double first, step, a, b;
} samples;

/* Of the samples of one sign: how many, sums of W, W t, W t^2, W r, W t r. */
typedef struct moments {
    int32_t count;
    double w, t, tt, r, tr;
} moments;

typedef struct line {
    double a, b; /* s = a + b t */
    double a_variance, b_variance;
} line;

static void place_samples(const axis *along, const asj_line_range *range, double half_width, const line *around, samples *out)
{
    const int32_t reach = (int32_t)ceil(half_width);
    asj_line_profile *profile = &out->profile;
    out->first = range->first;
    out->step = fmax((range->last - range->first) / (MAX_SAMPLES - 1), 1);
    out->a = around->a;
    out->b = around->b;
    profile->ux = (float)along->ux;
    profile->uy = (float)along->uy;
    profile->first = (float)range->first;
    profile->step = (float)out->step;
    profile->a = (float)around->a;
    profile->b = (float)around->b;
    for (int32_t i = -reach; i <= reach; i++)
        profile->offset[i + reach] = (float)(half_width * i / reach);
    profile->offsets = 2 * reach + 1;
    profile->count = (int32_t)((range->last - range->first) / out->step + 1e-9) + 1;
    profile->x = (int32_t)floor(along->x);
    profile->y = (int32_t)floor(along->y);
    profile->origin_x = (float)(along->x - profile->x);
    profile->origin_y = (float)(along->y - profile->y);
}

/* From sums over k: t = first + k step. */
static moments moments_of(const samples *in, int32_t side)
{
    const struct asj_profile_totals *sums = &in->sums.totals[side];
    const double first = in->first, step = in->step, w = (double)sums->w, k = step * (double)sums->k, r = (double)sums->r;
    return (moments){in->sums.counts[side], w, first * w + k, first * (first * w + 2 * k) + step * step * (double)sums->kk, r,
                     first * r + step * (double)sums->kr};
}

/* Weighted least squares; returns 0 when the samples do not determine a line. */
static int solve(const samples *in, const moments *m, line *out)
{
    const double determinant = m->w * m->tt - m->t * m->t;
    if (m->count < 3 || !(determinant > LEAST_SPREAD * m->w * m->tt))
        return 0;
    *out = (line){in->a + (m->tt * m->r - m->t * m->tr) / determinant, in->b + (m->w * m->tr - m->t * m->r) / determinant, 0, 0};
    return 1;
}

/* Of a line that these samples have given. */
static void find_variances(const samples *in, const moments *m, int32_t side, line *out)
{
    const double determinant = m->w * m->tt - m->t * m->t, a = out->a - in->a, b = out->b - in->b;
    double error = 0, first = HUGE_VAL, last = 0;
    for (int32_t k = 0; k < in->profile.count; k++) {
        const double w = (double)in->sums.w[side][k], t = in->first + k * in->step;
        if (!(w > 0))
            continue;
        const double e = (double)in->sums.moment[side][k] / w - a - b * t;
        error += w * e * e;
        first = first < t ? first : t;
        last = t;
    }
    const double variance = error / (m->count - 2), span = last - first;
    out->a_variance = OFFSET_CORRELATION * variance * m->tt / determinant + LEAST_ERROR * LEAST_ERROR;
    out->b_variance = ANGLE_CORRELATION * variance * m->w / determinant + 2 * LEAST_ERROR * LEAST_ERROR / (span * span);
}

/* When the lines of both signs are no more than THIN apart all along: the line between them, and how far apart they are. */
static void take_middle(const line lines[2], double first, double last, line *middle, double *apart)
{
    const double near = fabs(lines[1].a - lines[0].a + (lines[1].b - lines[0].b) * first);
    const double far = fabs(lines[1].a - lines[0].a + (lines[1].b - lines[0].b) * last);
    if (near > THIN || far > THIN)
        return;
    *apart = 0.5 * (near + far);
    middle->a = 0.5 * (lines[0].a + lines[1].a);
    middle->b = 0.5 * (lines[0].b + lines[1].b);
    middle->a_variance = 0.25 * (lines[0].a_variance + lines[1].a_variance);
    middle->b_variance = 0.25 * (lines[0].b_variance + lines[1].b_variance);
}

/* The line of the stronger sign, or the middle of a thin line's two edges. *apart is the distance between those, else 0. With
 * variances when they are wanted. */
static int choose(const samples *in, const asj_line_range *range, int variances, line *found, double *apart)
{
    const moments list[2] = {moments_of(in, 0), moments_of(in, 1)};
    line lines[2];
    const int strong = list[1].w > list[0].w;
    *apart = 0;
    if (!solve(in, &list[strong], &lines[strong]))
        return 0;
    if (variances)
        find_variances(in, &list[strong], strong, &lines[strong]);
    *found = lines[strong];
    if (list[!strong].w < BOTH_STRONG * list[strong].w || !solve(in, &list[!strong], &lines[!strong]))
        return 1;
    if (variances)
        find_variances(in, &list[!strong], !strong, &lines[!strong]);
    take_middle(lines, range->first, range->last, found, apart);
    return 1;
}

/* A fit under way. */
typedef struct fit {
    axis from;
    line found;
    double apart;
    samples list;
} fit;

/* One iteration for all lines that there are still; side by side: see asj_line_guess_all(). */
static void iterate(const asj_line_ops *ops, const asj_frame *frame, const asj_line_range *range, int32_t iteration, int32_t count,
                    fit *fits, int *fitted)
{
    for (int32_t i = 0; i < count; i++) {
        const double half_width = range->half_width[iteration] + 0.5 * fits[i].apart;
        if (fitted[i])
            place_samples(&fits[i].from, range, half_width < WIDEST ? half_width : WIDEST, &fits[i].found, &fits[i].list);
    }
    for (int32_t i = 0; i < count; i++)
        if (fitted[i])
            ops->profile(frame, &fits[i].list.profile, &fits[i].list.sums);
    for (int32_t i = 0; i < count; i++)
        if (fitted[i])
            fitted[i] = choose(&fits[i].list, range, iteration + 1 == range->iterations, &fits[i].found, &fits[i].apart);
}

void asj_line_fit_all(const asj_line_ops *ops, const asj_frame *frame, double x, double y, const asj_rough_line *along,
                      const asj_line_range *range, int32_t count, asj_hypothesis_branch *branches, int *fitted)
{
    fit fits[ASJ_MAX_BRANCHES];
    for (int32_t i = 0; i < count; i++) {
        fits[i].from = (axis){x, y, along[i].ux, along[i].uy};
        fits[i].found = (line){branches[i].offset, 0, 0, 0};
        fits[i].apart = branches[i].apart;
        fitted[i] = 1;
    }
    for (int32_t iteration = 0; iteration < range->iterations; iteration++)
        iterate(ops, frame, range, iteration, count, fits, fitted);
    for (int32_t i = 0; i < count; i++) {
        const line *found = &fits[i].found;
        fitted[i] = fitted[i] && fabs(found->b) < 1;
        if (!fitted[i])
            continue;
        branches[i].angle = asj_angle_wrap(branches[i].angle + atan(found->b));
        branches[i].offset = found->a / sqrt(1 + found->b * found->b);
        branches[i].apart = fits[i].apart;
        branches[i].offset_variance = found->a_variance;
        branches[i].angle_variance = found->b_variance;
    }
}

int asj_line_fit(const asj_line_ops *ops, const asj_frame *frame, double x, double y, const asj_line_range *range,
                 asj_hypothesis_branch *branch)
{
    const asj_rough_line along = asj_rough_line_of(branch);
    int fitted;
    asj_line_fit_all(ops, frame, x, y, &along, range, 1, branch, &fitted);
    return fitted;
}

asj_rough_line asj_rough_line_of(const asj_hypothesis_branch *branch)
{
    return (asj_rough_line){cos(branch->angle), sin(branch->angle), branch->offset, branch->apart};
}

void asj_rough_line_keep(const asj_rough_line *rough, asj_hypothesis_branch *branch)
{
    branch->angle = asj_angle_wrap(atan2(rough->uy, rough->ux));
    branch->offset = rough->offset;
    branch->apart = rough->apart;
}

/* From sums around t = `middle` and s = rough->offset. */
static int solve_sums(const asj_line_sums *sums, const asj_rough_line *rough, double middle, line *out)
{
    const double ux = rough->ux, uy = rough->uy, w = (double)sums->w, x = (double)sums->x, y = (double)sums->y;
    const double xx = (double)sums->xx, xy = (double)sums->xy, yy = (double)sums->yy;
    const double t = ux * x + uy * y, tt = ux * ux * xx + 2 * ux * uy * xy + uy * uy * yy;
    const double s = ux * y - uy * x, ts = ux * uy * (yy - xx) + (ux * ux - uy * uy) * xy;
    const double determinant = w * tt - t * t;
    if (!(determinant > LEAST_PIXEL_SPREAD * w * (tt + middle * (2 * t + middle * w))))
        return 0;
    const double b = (w * ts - t * s) / determinant;
    *out = (line){rough->offset + (tt * s - t * ts) / determinant - b * middle, b, 0, 0};
    return 1;
}

static asj_line_box box_of(double x, double y, const double t[2], double half_width, const asj_rough_line *rough)
{
    const double wide = half_width + 0.5 * rough->apart, middle = 0.5 * (t[0] + t[1]), ux = rough->ux, uy = rough->uy;
    return (asj_line_box){x + middle * ux - rough->offset * uy, y + middle * uy + rough->offset * ux, ux, uy,
                          0.5 * (t[1] - t[0]), wide < WIDEST ? wide : WIDEST};
}

/* The line that these sums give. */
static int guess_from_sums(const asj_line_sums sums[2], const double t[2], asj_rough_line *rough)
{
    const double middle = 0.5 * (t[0] + t[1]), ux = rough->ux, uy = rough->uy;
    const int strong = sums[1].w > sums[0].w;
    line lines[2], found;
    double apart = 0;
    if (!solve_sums(&sums[strong], rough, middle, &lines[strong]))
        return 0;
    found = lines[strong];
    if ((double)sums[!strong].w >= BOTH_STRONG * (double)sums[strong].w &&
        solve_sums(&sums[!strong], rough, middle, &lines[!strong]))
        take_middle(lines, t[0], t[1], &found, &apart);
    if (!(fabs(found.b) < 1))
        return 0;
    const double unit = 1 / sqrt(1 + found.b * found.b);
    *rough = (asj_rough_line){(ux - found.b * uy) * unit, (uy + found.b * ux) * unit, found.a * unit, apart};
    return 1;
}

/* What begins and what ends a guess are long chains of operations: those of all lines stand side by side, so that processors have
 * them under way together. */
void asj_line_guess_all(const asj_line_ops *ops, const asj_frame *frame, double x, double y, const double t[2], double half_width,
                        int32_t count, asj_rough_line *rough, int *found)
{
    asj_line_band bands[ASJ_MAX_BRANCHES];
    asj_line_sums sums[ASJ_MAX_BRANCHES][2];
    for (int32_t i = 0; i < count; i++) {
        const asj_line_box box = box_of(x, y, t, half_width, &rough[i]);
        asj_line_band_set(frame, &box, &bands[i]);
    }
    for (int32_t i = 0; i < count; i++)
        ops->sums(frame, &bands[i], sums[i]);
    for (int32_t i = 0; i < count; i++)
        found[i] = guess_from_sums(sums[i], t, &rough[i]);
}

int asj_line_guess(const asj_line_ops *ops, const asj_frame *frame, double x, double y, const double t[2], double half_width,
                   asj_rough_line *rough)
{
    int found;
    asj_line_guess_all(ops, frame, x, y, t, half_width, 1, rough, &found);
    return found;
}
