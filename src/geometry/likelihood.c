/* SPDX-License-Identifier: BSD-2-Clause */
/* The model of candidates (Bayes' rule over rivals, one place at a time).
 *
 * An epipolar geometry F (x2' F x1 = 0) and an affine correspondence (x1, x2, A) give three equations (Raposo and Barreto, "Theory
 * and practice of structure-from-motion using affine correspondences", CVPR 2016; Barath et al. on the same subject): with the
 * epipolar lines l2 = F x1 and l1 = F' x2, their normals n2, n1 (first two entries), and because x2' F x1 stays 0 when x1 moves by
 * d and x2 by A d,
 *
 *     x2' F x1 = 0      and      A' n2 + n1 = 0.
 *
 * Residuals, each over its standard deviation:
 *
 *     |x2' F x1| / min(|n1|, |n2|)               px: distance from the line, in the image where it is larger
 *     sine of the angle between A' n2 and -n1    and the cosine must be positive
 *     log |A' n2| - log |n1|                     the map scales the distance from the line as the geometry says
 *
 * Right candidates: normal in all three. Wrong ones: the distance is anywhere up to `spread` px, the angle anywhere, the log of the
 * scale anywhere in a width of SCALE_WIDTH. Likelihood ratio = the quotient.
 *
 * A homography H gives six: with J its derivative at x1, B = J^-1 A (the identity if A is right): displacement of x2 (two, px, in
 * the image where it is larger), the angle of the rotation in B, half the log of det B, and the two terms of its shear. Wrong ones
 * lie anywhere in the image; angle and scale as above; shear anywhere in SHEAR_WIDTH squared.
 *
 * Rooms are made of planes. An essential matrix [t]x R may have some, n'X = 1 in coordinates of camera 1: on each lies what obeys
 * its homography K2 (R + t n') K1^-1 (Hartley and Zisserman, 13.1), with the plane's thickness as part of the standard deviation of
 * its location (model.c). A right candidate lies on one of them in ON_PLANES of all cases, on each as likely, or else anywhere: its
 * likelihood is the sum of the parts.
 *
 * What is right lies in front of both cameras; of the points of an epipolar line half do. So the ratio is multiplied by 2 - BEHIND
 * or by BEHIND, and by 1 where rays are so nearly parallel that locations do not tell.
 *
 * Where branches point along directions of the room, and the motion says which of image 1 is which of image 2, the ratio is
 * multiplied by what labels.c says of that.
 *
 * How large errors are differs from image to image and from corner to corner: of matches in rendered rooms half lie within .3 px of
 * their epipolar lines and a twentieth beyond 2 px, in frames of a video half within .9 px. So a right candidate has one of SIZES
 * sizes of errors, all its standard deviations divided by 1, 2 and 4 (a scale mixture of normal distributions: Andrews and Mallows
 * 1974): with d residuals of square q and the shares w_k,
 *
 *     likelihood ~ sum w_k 2^(kd) exp(-4^k q / 2),     -2 d log(likelihood) / dq = sum of 4^k, each weighed by its part of the sum,
 *
 * so that exact matches speak the louder where there are any, and none is believed to be exact. Where standard deviations are
 * loosened, geometries are still some way off, and the largest size stands for all. */
#include "likelihood.h"
#include "core/angle.h"
#include "elementary.h"

#include <math.h>
#include <stddef.h>

#define SCALE_WIDTH 2.5
#define SHEAR_WIDTH 1.5
#define WIDEST 3.0 /* largest `loose` */
#define ON_PLANES 0.75
#define SHARE_1 0.2 /* of the largest errors, .. */
#define SHARE_2 0.4
#define SHARE_4 0.4 /* .. and of those a quarter as large */

const double asj_size_peaks[2][ASJ_SIZES] = {{SHARE_1, SHARE_2 * 8, SHARE_4 * 64}, {SHARE_1, SHARE_2 * 64, SHARE_4 * 4096}};

/* The square is HUGE_VAL also where some of the residuals are too large for a ratio above 0 with standard deviations times `loose`:
 * those that cost least are looked at first. */
static void epipolar_residuals(const double f[9], const asj_pairs *set, const asj_pair *c, double loose, asj_residuals *r)
{
    const double n2x = f[0] * c->x1 + f[1] * c->y1 + f[2], n2y = f[3] * c->x1 + f[4] * c->y1 + f[5];
    const double n1x = f[0] * c->x2 + f[3] * c->y2 + f[6], n1y = f[1] * c->x2 + f[4] * c->y2 + f[7];
    const double e = c->x2 * n2x + c->y2 * n2y + f[6] * c->x1 + f[7] * c->y1 + f[8];
    const double s1 = n1x * n1x + n1y * n1y, s2 = n2x * n2x + n2y * n2y, least = s1 < s2 ? s1 : s2;
    const double sd = set->location_sd, most = ASJ_FAR * loose * loose;
    r->square = HUGE_VAL;
    if (!(e * e <= most * sd * sd * least) || !(least > 0))
        return;
    const double mx = c->affine[0] * n2x + c->affine[2] * n2y, my = c->affine[1] * n2x + c->affine[3] * n2y;
    const double s = mx * mx + my * my, cosine = -(mx * n1x + my * n1y), sine = my * n1x - mx * n1y;
    if (!(cosine > 0) || sine * sine > most * s * s1 * set->angle_sd * set->angle_sd)
        return;
    r->value[0] = e / (sqrt(least) * sd);
    r->value[1] = sine / (sqrt(s * s1) * set->angle_sd);
    if (r->value[0] * r->value[0] + r->value[1] * r->value[1] > most)
        return;
    r->value[2] = 0.5 * asj_log_normal(s / s1) / set->scale_sd;
    r->square = r->value[0] * r->value[0] + r->value[1] * r->value[1] + r->value[2] * r->value[2];
}

static void planar_residuals(const double h[9], const asj_pairs *set, double sd, const asj_pair *c, double loose, asj_residuals *r)
{
    const double w = h[6] * c->x1 + h[7] * c->y1 + h[8], x = (h[0] * c->x1 + h[1] * c->y1 + h[2]) / w;
    const double y = (h[3] * c->x1 + h[4] * c->y1 + h[5]) / w, dx = c->x2 - x, dy = c->y2 - y;
    r->square = HUGE_VAL;
    const double most = ASJ_FAR_PLANAR * loose * loose;
    if (!(w > 0) || !(dx * dx + dy * dy <= most * sd * sd))
        return;
    /* J and B = J^-1 A */
    const double j0 = (h[0] - x * h[6]) / w, j1 = (h[1] - x * h[7]) / w, j2 = (h[3] - y * h[6]) / w, j3 = (h[4] - y * h[7]) / w;
    const double det = j0 * j3 - j1 * j2;
    if (!(det > 1e-12))
        return;
    const double *a = c->affine;
    const double b0 = (j3 * a[0] - j1 * a[2]) / det, b1 = (j3 * a[1] - j1 * a[3]) / det;
    const double b2 = (j0 * a[2] - j2 * a[0]) / det, b3 = (j0 * a[3] - j2 * a[1]) / det, area = b0 * b3 - b1 * b2;
    const double ex = (j3 * dx - j1 * dy) / det, ey = (j0 * dy - j2 * dx) / det;
    const int back = ex * ex + ey * ey > dx * dx + dy * dy;
    if (!(area > 0))
        return;
    const double scale = sqrt(area);
    r->value[0] = (back ? ex : dx) / sd;
    r->value[1] = (back ? ey : dy) / sd;
    r->value[4] = 0.5 * (b0 - b3) / (scale * ASJ_SHEAR_SD);
    r->value[5] = 0.5 * (b1 + b2) / (scale * ASJ_SHEAR_SD);
    if (r->value[0] * r->value[0] + r->value[1] * r->value[1] + r->value[4] * r->value[4] + r->value[5] * r->value[5] > most)
        return;
    r->value[2] = atan2(b2 - b1, b0 + b3) / set->angle_sd;
    r->value[3] = asj_log_normal(scale) / set->scale_sd;
    r->square = 0;
    for (int32_t k = 0; k < 6; k++)
        r->square += r->value[k] * r->value[k];
}

void asj_epipolar_residuals(const double f[9], const asj_pairs *set, const asj_pair *c, asj_residuals *r)
{
    epipolar_residuals(f, set, c, WIDEST, r);
}

void asj_planar_residuals(const double h[9], const asj_pairs *set, const asj_pair *c, asj_residuals *r)
{
    planar_residuals(h, set, set->location_sd, c, WIDEST, r);
}

static void part_residuals(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *c, double loose,
                           asj_residuals *r)
{
    const double sd = asj_part_thickness(view, part) * set->location_sd;
    if (asj_part_is_planar(view, part))
        planar_residuals(part > 0 ? view->planes[part - 1] : view->matrix, set, sd, c, loose, r);
    else
        epipolar_residuals(view->matrix, set, c, loose, r);
}

void asj_part_residuals(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *c, asj_residuals *r)
{
    part_residuals(view, part, set, c, WIDEST, r);
}

asj_peaks asj_likelihood_peaks(const asj_pairs *set, const asj_two_view *view, double loose)
{
    const double sd = loose * set->location_sd, normal = sqrt(2 * ASJ_PI);
    const double shape = 2 * ASJ_PI / (normal * loose * set->angle_sd) * SCALE_WIDTH / (normal * loose * set->scale_sd);
    const double shear = SHEAR_WIDTH * SHEAR_WIDTH / (2 * ASJ_PI * loose * ASJ_SHEAR_SD * loose * ASJ_SHEAR_SD);
    const double line = 2 * set->spread / (normal * sd) * shape;
    const double plane = set->area / (2 * ASJ_PI * sd * sd) * shape * shear;
    asj_peaks peaks = {view->planar ? plane : line, plane, loose, !(loose > 1), NULL};
    if (set->has_labels && view->has_motion)
        peaks.named = asj_named_rotation(set, view->rotation);
    if (view->plane_count > 0) {
        peaks.first *= 1 - ON_PLANES;
        peaks.plane *= ON_PLANES / view->plane_count;
    }
    return peaks;
}

/* exp(-q / 2) of each size, times its peak. */
static void sizes_of(double square, int32_t planar, double sizes[ASJ_SIZES])
{
    const double e = asj_exp_falling(-0.5 * square), e2 = e * e, e4 = e2 * e2, e8 = e4 * e4, e16 = e8 * e8;
    const double *peak = asj_size_peaks[planar];
    sizes[0] = peak[0] * e;
    sizes[1] = peak[1] * e4;
    sizes[2] = peak[2] * e16;
}

double asj_size_weight(double square, int32_t planar)
{
    double s[ASJ_SIZES];
    sizes_of(square, planar, s);
    const double sum = s[0] + s[1] + s[2];
    return sum > 0 ? (s[0] + 4 * s[1] + 16 * s[2]) / sum : 1;
}

/* The factor that being in front of both cameras is worth: see above. d1 and d2, the depths, as in asj_in_front() of model.c. */
double asj_side_factor(const asj_two_view *view, const asj_pair *c)
{
    const double *m = view->turned, *t = view->translation;
    const double a0 = m[0] * c->x1 + m[1] * c->y1 + m[2], a1 = m[3] * c->x1 + m[4] * c->y1 + m[5];
    const double a2 = m[6] * c->x1 + m[7] * c->y1 + m[8];
    const double b0 = (c->x2 - view->ray2[2]) * view->ray2[0], b1 = (c->y2 - view->ray2[3]) * view->ray2[1];
    const double n0 = a1 - a2 * b1, n1 = a2 * b0 - a0, n2 = a0 * b1 - a1 * b0; /* a x b, b = (b0, b1, 1) */
    const double square = n0 * n0 + n1 * n1 + n2 * n2, aa = a0 * a0 + a1 * a1 + a2 * a2, bb = b0 * b0 + b1 * b1 + 1;
    if (!(square > view->parallax2 * aa * bb))
        return 1;
    const double first = (b1 * t[2] - t[1]) * n0 + (t[0] - b0 * t[2]) * n1 + (b0 * t[1] - b1 * t[0]) * n2;
    const double second = (a1 * t[2] - a2 * t[1]) * n0 + (a2 * t[0] - a0 * t[2]) * n1 + (a0 * t[1] - a1 * t[0]) * n2;
    return first > 0 && second > 0 ? 2 - ASJ_BEHIND : ASJ_BEHIND;
}

double asj_part_peak(const asj_two_view *view, int32_t part, const asj_peaks *peaks)
{
    const double thickness = asj_part_thickness(view, part);
    return (part > 0 ? peaks->plane : peaks->first) / (thickness * thickness);
}

double asj_part_sum(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *c, const asj_peaks *peaks)
{
    const int32_t planar = asj_part_is_planar(view, part);
    const double *front = part > 0 ? view->in_front[part - 1] : NULL;
    asj_residuals r;
    r.square = HUGE_VAL;
    if (!front || front[0] * c->x1 + front[1] * c->y1 + front[2] > 0)
        part_residuals(view, part, set, c, peaks->loose, &r);
    const double square = r.square * (1 / (peaks->loose * peaks->loose));
    if (!(square < (planar ? ASJ_FAR_PLANAR : ASJ_FAR)))
        return 0;
    if (!peaks->fine)
        return asj_exp_falling(-0.5 * square);
    double s[ASJ_SIZES];
    sizes_of(square, planar, s);
    return s[0] + s[1] + s[2];
}

double asj_part_ratio(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *c, const asj_peaks *peaks)
{
    const double sum = asj_part_sum(view, part, set, c, peaks);
    if (!(sum > 0))
        return 0;
    const double side = asj_part_has_sides(view, part) ? asj_side_factor(view, c) : 1;
    return asj_part_product(peaks, c, asj_part_peak(view, part, peaks), sum, side);
}

double asj_likelihood_ratio(const asj_two_view *view, const asj_pairs *set, const asj_pair *c, const asj_peaks *peaks,
                            double *parts)
{
    double sum = 0;
    for (int32_t k = 0; k <= view->plane_count; k++) {
        const double ratio = asj_part_ratio(view, k, set, c, peaks);
        if (parts)
            parts[k] = ratio;
        sum += ratio;
    }
    return sum;
}

double asj_far_limit(const asj_pairs *set, const asj_two_view *view, double loose)
{
    return (view->planar ? ASJ_FAR_PLANAR : ASJ_FAR) * loose * loose * set->location_sd * set->location_sd;
}
