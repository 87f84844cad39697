/* SPDX-License-Identifier: BSD-2-Clause */
/* How much likelier candidates are under a geometry than by chance. */
#ifndef ASJ_SRC_LIKELIHOOD_H
#define ASJ_SRC_LIKELIHOOD_H

#include "labels.h"

/* What a geometry says of one candidate: squared residual in standard deviations, HUGE_VAL where a sign is wrong. */
typedef struct asj_residuals {
    double value[6];         /* divided by their standard deviations: three of an epipolar geometry, six of a homography */
    double square;
} asj_residuals;

#define ASJ_FAR 20.0 /* square beyond which the ratio is as good as 0: exp(-10) times the peak of about 1e4 */
#define ASJ_FAR_PLANAR 34.0
#define ASJ_SHEAR_SD 0.25 /* of either term of a map's shear */

void asj_epipolar_residuals(const double f[9], const asj_pairs *set, const asj_pair *pair, asj_residuals *r);
void asj_planar_residuals(const double h[9], const asj_pairs *set, const asj_pair *pair, asj_residuals *r);

/* What a candidate may be: part 0 is anywhere in a geometry without planes or on the plane of a homography, part k on its k-th
 * plane. Its thickness is the standard deviation of a location in it, as part of location_sd. */
static inline double asj_part_thickness(const asj_two_view *view, int32_t part)
{
    return part > 0 ? view->thickness[part - 1] : 1;
}

static inline int32_t asj_part_is_planar(const asj_two_view *view, int32_t part)
{
    return view->planar || part > 0;
}

void asj_part_residuals(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *pair, asj_residuals *r);

/* The largest likelihood ratio of the parts, where all residuals are zero and of the largest size, with their shares; standard
 * deviations times `loose`. */
typedef struct asj_peaks {
    double first, plane; /* of part 0, and of the planes if they are as thick as others' errors */
    double loose;
    int32_t fine;        /* residuals have several sizes: where `loose` is 1 */
    const asj_likely_rotation *named; /* labels.c; NULL: none */
} asj_peaks;
asj_peaks asj_likelihood_peaks(const asj_pairs *set, const asj_two_view *view, double loose);

/* Squared distance, px, from the line or place beyond which the ratio is as good as 0. */
double asj_far_limit(const asj_pairs *set, const asj_two_view *view, double loose);

/* Likelihood if right over likelihood if wrong; parts: NULL, or what each part has of it. */
double asj_likelihood_ratio(const asj_two_view *view, const asj_pairs *set, const asj_pair *pair, const asj_peaks *peaks,
                            double *parts);
/* .. of one of the parts. */
double asj_part_ratio(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *pair, const asj_peaks *peaks);

/* What it consists of: the part's peak; what labels say (labels.c), where peaks->named; the densities of the sizes of errors over
 * the peak, added up, 0 where a residual is too large; and, where a part has sides, the factor that being in front is worth. */
#define ASJ_SIZES 3
extern const double asj_size_peaks[2][ASJ_SIZES]; /* of an epipolar geometry, of a homography */
double asj_part_peak(const asj_two_view *view, int32_t part, const asj_peaks *peaks);
double asj_part_sum(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *pair, const asj_peaks *peaks);

static inline int32_t asj_part_has_sides(const asj_two_view *view, int32_t part)
{
    return view->has_motion && !asj_part_is_planar(view, part);
}

#define ASJ_BEHIND 0.1 /* of twice what chance has: of points of an epipolar line half are in front */
double asj_side_factor(const asj_two_view *view, const asj_pair *pair);

/* The ratio of a part from its factors: that of labels, asj_part_peak(), asj_part_sum(), which is above 0, and asj_side_factor(), 1
 * where the part has no sides. */
static inline double asj_part_product(const asj_peaks *peaks, const asj_pair *pair, double peak, double sum, double side)
{
    const double labels = peaks->named ? asj_label_ratio(peaks->named, pair) : 1;
    return labels * peak * sum * side;
}

/* What a residual of this square weighs in a least-squares step, where it has several sizes (asj_peaks.fine). */
double asj_size_weight(double square, int32_t planar);

#endif
