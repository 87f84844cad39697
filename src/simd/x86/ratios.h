/* SPDX-License-Identifier: BSD-2-Clause */
/* Likelihood ratios of candidates under an epipolar geometry or a homography (likelihood.c), in lanes of 4: each operation of its
 * formulas in its order, so that the bits are its own. */
#ifndef ASJ_SRC_X86_RATIOS_H
#define ASJ_SRC_X86_RATIOS_H

#include "geometry/elementary.h"
#include "geometry/ratios.h"

#include <immintrin.h>
#include <math.h>

static inline __m256d ratio_set(double x)
{
    return _mm256_set1_pd(x);
}

static inline __m256d ratio_add(__m256d a, __m256d b)
{
    return _mm256_add_pd(a, b);
}

static inline __m256d ratio_mul(__m256d a, __m256d b)
{
    return _mm256_mul_pd(a, b);
}

/* a x + b y, and + c */
static inline __m256d ratio_two(__m256d a, __m256d x, __m256d b, __m256d y)
{
    return ratio_add(ratio_mul(a, x), ratio_mul(b, y));
}

static inline __m256d ratio_three(double a, __m256d x, double b, __m256d y, double c)
{
    return ratio_add(ratio_two(ratio_set(a), x, ratio_set(b), y), ratio_set(c));
}

/* a x - b y */
static inline __m256d ratio_cross(__m256d a, __m256d x, __m256d b, __m256d y)
{
    return _mm256_sub_pd(ratio_mul(a, x), ratio_mul(b, y));
}

/* Four candidates' numbers that stand side by side, number by number. */
static inline void ratio_columns(const double *const rows[4], __m256d out[4])
{
    const __m256d a = _mm256_loadu_pd(rows[0]), b = _mm256_loadu_pd(rows[1]), c = _mm256_loadu_pd(rows[2]);
    const __m256d d = _mm256_loadu_pd(rows[3]);
    const __m256d ab0 = _mm256_unpacklo_pd(a, b), ab1 = _mm256_unpackhi_pd(a, b), cd0 = _mm256_unpacklo_pd(c, d);
    const __m256d cd1 = _mm256_unpackhi_pd(c, d);
    out[0] = _mm256_permute2f128_pd(ab0, cd0, 0x20);
    out[1] = _mm256_permute2f128_pd(ab1, cd1, 0x20);
    out[2] = _mm256_permute2f128_pd(ab0, cd0, 0x31);
    out[3] = _mm256_permute2f128_pd(ab1, cd1, 0x31);
}

typedef struct ratio_four {
    __m256d at[4]; /* x1, y1, x2, y2 */
    __m256d affine[4];
} ratio_four;

/* The candidates which[0 .. 3]; of fewer the last one again. */
static inline void ratio_load(const asj_pairs *set, const uint32_t *which, int32_t count, ratio_four *four)
{
    const double *at[4], *affine[4];
    for (int32_t k = 0; k < 4; k++) {
        const asj_pair *c = &set->list[which[k < count ? k : count - 1]];
        at[k] = &c->x1;
        affine[k] = c->affine;
    }
    ratio_columns(at, four->at);
    ratio_columns(affine, four->affine);
}

/* asj_exp_falling() of numbers above -690. */
static inline __m256d ratio_exp(__m256d x)
{
    const __m256d shifted = ratio_add(ratio_mul(x, ratio_set(0x1.71547652b82fep+0)), ratio_set(0x1.8p52));
    const __m256d k = _mm256_sub_pd(shifted, ratio_set(0x1.8p52));
    const __m256d about = _mm256_sub_pd(x, ratio_mul(k, ratio_set(ASJ_LOG2_HIGH)));
    const __m256d r = _mm256_sub_pd(about, ratio_mul(k, ratio_set(ASJ_LOG2_LOW)));
    const __m256d r2 = ratio_mul(r, r), r4 = ratio_mul(r2, r2);
    const __m256d middle = ratio_add(ratio_add(ratio_set(1.0 / 24), ratio_mul(r, ratio_set(1.0 / 120))),
                                     ratio_mul(r2, ratio_add(ratio_set(1.0 / 720), ratio_mul(r, ratio_set(1.0 / 5040)))));
    const __m256d low = ratio_add(ratio_add(ratio_add(ratio_set(1), r),
                                            ratio_mul(r2, ratio_add(ratio_set(0.5), ratio_mul(r, ratio_set(1.0 / 6))))),
                                  ratio_mul(r4, middle));
    const __m256d high = ratio_add(ratio_add(ratio_set(1.0 / 40320), ratio_mul(r, ratio_set(1.0 / 362880))),
                                   ratio_mul(r2, ratio_add(ratio_set(1.0 / 3628800), ratio_mul(r, ratio_set(1.0 / 39916800)))));
    const __m256i power = _mm256_slli_epi64(_mm256_add_epi64(_mm256_castpd_si256(shifted), _mm256_set1_epi64x(1023)), 52);
    return ratio_mul(ratio_add(low, ratio_mul(ratio_mul(r4, r4), high)), _mm256_castsi256_pd(power));
}

/* asj_log_normal(): k is the upper 12 bits of a sum, which stand in the upper half of each lane. */
static inline __m256d ratio_log(__m256d x)
{
    const __m256i bits = _mm256_castpd_si256(x), from = _mm256_sub_epi64(bits, _mm256_set1_epi64x(0x3fe6a09e667f3bcd));
    const __m256i upper = _mm256_srai_epi32(from, 20);
    const __m256i exponent = _mm256_slli_epi64(_mm256_srli_epi64(from, 52), 52);
    const __m256i four = _mm256_permutevar8x32_epi32(upper, _mm256_setr_epi32(1, 3, 5, 7, 1, 3, 5, 7));
    const __m256d k = _mm256_cvtepi32_pd(_mm256_castsi256_si128(four)), m = _mm256_castsi256_pd(_mm256_sub_epi64(bits, exponent));
    const __m256d f = _mm256_div_pd(_mm256_sub_pd(m, ratio_set(1)), ratio_add(m, ratio_set(1)));
    const __m256d s = ratio_mul(f, f), s2 = ratio_mul(s, s), s4 = ratio_mul(s2, s2), twice = ratio_mul(ratio_set(2), f);
    const __m256d low = ratio_add(ratio_add(ratio_set(1.0 / 3), ratio_mul(s, ratio_set(1.0 / 5))),
                                  ratio_mul(s2, ratio_add(ratio_set(1.0 / 7), ratio_mul(s, ratio_set(1.0 / 9)))));
    const __m256d high = ratio_add(ratio_add(ratio_set(1.0 / 11), ratio_mul(s, ratio_set(1.0 / 13))),
                                   ratio_mul(s2, ratio_add(ratio_set(1.0 / 15), ratio_mul(s, ratio_set(1.0 / 17)))));
    const __m256d rest = ratio_mul(ratio_mul(twice, s), ratio_add(low, ratio_mul(s4, high)));
    const __m256d fine = ratio_add(rest, ratio_mul(k, ratio_set(ASJ_LOG2_LOW)));
    return ratio_add(ratio_mul(k, ratio_set(ASJ_LOG2_HIGH)), ratio_add(twice, fine));
}

/* The densities of the sizes of errors over the peak, added up: 0 where `good` is not set or the square is too large. */
static inline __m256d ratio_sum(const asj_peaks *peaks, __m256d square, __m256d good, int32_t planar)
{
    const __m256d tight = ratio_mul(square, ratio_set(1 / (peaks->loose * peaks->loose)));
    const __m256d far = ratio_set(planar ? ASJ_FAR_PLANAR : ASJ_FAR);
    const __m256d kept = _mm256_and_pd(good, _mm256_cmp_pd(tight, far, _CMP_LT_OQ));
    const __m256d e = ratio_exp(_mm256_and_pd(kept, ratio_mul(ratio_set(-0.5), tight)));
    if (!peaks->fine)
        return _mm256_and_pd(kept, e);
    const double *peak = asj_size_peaks[planar];
    const __m256d e2 = ratio_mul(e, e), e4 = ratio_mul(e2, e2), e8 = ratio_mul(e4, e4), e16 = ratio_mul(e8, e8);
    const __m256d two = ratio_two(ratio_set(peak[0]), e, ratio_set(peak[1]), e4);
    return _mm256_and_pd(kept, ratio_add(two, ratio_mul(ratio_set(peak[2]), e16)));
}

/* asj_side_factor() */
static inline __m256d ratio_sides(const asj_two_view *view, const ratio_four *c)
{
    const double *m = view->turned, *t = view->translation, *ray = view->ray2;
    const __m256d a0 = ratio_three(m[0], c->at[0], m[1], c->at[1], m[2]), a1 = ratio_three(m[3], c->at[0], m[4], c->at[1], m[5]);
    const __m256d a2 = ratio_three(m[6], c->at[0], m[7], c->at[1], m[8]);
    const __m256d b0 = ratio_mul(_mm256_sub_pd(c->at[2], ratio_set(ray[2])), ratio_set(ray[0]));
    const __m256d b1 = ratio_mul(_mm256_sub_pd(c->at[3], ratio_set(ray[3])), ratio_set(ray[1]));
    const __m256d n0 = _mm256_sub_pd(a1, ratio_mul(a2, b1)), n1 = _mm256_sub_pd(ratio_mul(a2, b0), a0);
    const __m256d n2 = ratio_cross(a0, b1, a1, b0);
    const __m256d square = ratio_add(ratio_two(n0, n0, n1, n1), ratio_mul(n2, n2));
    const __m256d aa = ratio_add(ratio_two(a0, a0, a1, a1), ratio_mul(a2, a2));
    const __m256d bb = ratio_add(ratio_two(b0, b0, b1, b1), ratio_set(1));
    const __m256d t0 = ratio_set(t[0]), t1 = ratio_set(t[1]), t2 = ratio_set(t[2]), zero = _mm256_setzero_pd();
    const __m256d first = ratio_add(ratio_two(_mm256_sub_pd(ratio_mul(b1, t2), t1), n0, _mm256_sub_pd(t0, ratio_mul(b0, t2)), n1),
                                    ratio_mul(ratio_cross(b0, t1, b1, t0), n2));
    const __m256d second = ratio_add(ratio_two(ratio_cross(a1, t2, a2, t1), n0, ratio_cross(a2, t0, a0, t2), n1),
                                     ratio_mul(ratio_cross(a0, t1, a1, t0), n2));
    const __m256d front = _mm256_and_pd(_mm256_cmp_pd(first, zero, _CMP_GT_OQ), _mm256_cmp_pd(second, zero, _CMP_GT_OQ));
    const __m256d factor = _mm256_blendv_pd(ratio_set(ASJ_BEHIND), ratio_set(2 - ASJ_BEHIND), front);
    const __m256d least = ratio_mul(ratio_mul(ratio_set(view->parallax2), aa), bb);
    return _mm256_blendv_pd(ratio_set(1), factor, _mm256_cmp_pd(square, least, _CMP_GT_OQ));
}

/* epipolar_residuals() and what follows from them. */
static inline __m256d ratio_lines_four(const asj_ratio_plan *plan, const ratio_four *c)
{
    const asj_pairs *set = plan->set;
    const double *f = plan->view->matrix, loose = plan->peaks->loose, most = ASJ_FAR * loose * loose;
    const __m256d x1 = c->at[0], y1 = c->at[1], x2 = c->at[2], y2 = c->at[3], sd = ratio_set(set->location_sd);
    const __m256d n2x = ratio_three(f[0], x1, f[1], y1, f[2]), n2y = ratio_three(f[3], x1, f[4], y1, f[5]);
    const __m256d n1x = ratio_three(f[0], x2, f[3], y2, f[6]), n1y = ratio_three(f[1], x2, f[4], y2, f[7]);
    const __m256d e = ratio_add(ratio_add(ratio_add(ratio_two(x2, n2x, y2, n2y), ratio_mul(ratio_set(f[6]), x1)),
                                          ratio_mul(ratio_set(f[7]), y1)), ratio_set(f[8]));
    const __m256d s1 = ratio_two(n1x, n1x, n1y, n1y), s2 = ratio_two(n2x, n2x, n2y, n2y), least = _mm256_min_pd(s1, s2);
    const __m256d zero = _mm256_setzero_pd(), limit = ratio_mul(ratio_set(most * set->location_sd * set->location_sd), least);
    __m256d good = _mm256_and_pd(_mm256_cmp_pd(ratio_mul(e, e), limit, _CMP_LE_OQ), _mm256_cmp_pd(least, zero, _CMP_GT_OQ));
    const __m256d mx = ratio_two(c->affine[0], n2x, c->affine[2], n2y), my = ratio_two(c->affine[1], n2x, c->affine[3], n2y);
    const __m256d s = ratio_two(mx, mx, my, my), against = ratio_two(mx, n1x, my, n1y), sine = ratio_cross(my, n1x, mx, n1y);
    const __m256d angle_sd = ratio_set(set->angle_sd);
    const __m256d turned = ratio_mul(ratio_mul(ratio_mul(ratio_mul(ratio_set(most), s), s1), angle_sd), angle_sd);
    good = _mm256_and_pd(good, _mm256_and_pd(_mm256_cmp_pd(against, zero, _CMP_LT_OQ),
                                             _mm256_cmp_pd(ratio_mul(sine, sine), turned, _CMP_NGT_UQ)));
    if (_mm256_movemask_pd(good) == 0)
        return zero;
    const __m256d v0 = _mm256_div_pd(e, ratio_mul(_mm256_sqrt_pd(least), sd));
    const __m256d v1 = _mm256_div_pd(sine, ratio_mul(_mm256_sqrt_pd(ratio_mul(s, s1)), angle_sd)), two = ratio_two(v0, v0, v1, v1);
    good = _mm256_and_pd(good, _mm256_cmp_pd(two, ratio_set(most), _CMP_NGT_UQ));
    const __m256d v2 = _mm256_div_pd(ratio_mul(ratio_set(0.5), ratio_log(_mm256_div_pd(s, s1))), ratio_set(set->scale_sd));
    return ratio_sum(plan->peaks, ratio_add(two, ratio_mul(v2, v2)), good, 0);
}

static void ratio_lines_avx2(const asj_ratio_plan *plan, const uint32_t *which, int32_t count, double *sums, double *sides)
{
    const int32_t has_sides = asj_part_has_sides(plan->view, plan->part);
    for (int32_t n = 0; n < count; n += 4) {
        double sum[4], side[4] = {1, 1, 1, 1};
        ratio_four four;
        ratio_load(plan->set, which + n, count - n, &four);
        const __m256d found = ratio_lines_four(plan, &four);
        _mm256_storeu_pd(sum, found);
        if (has_sides && _mm256_movemask_pd(_mm256_cmp_pd(found, _mm256_setzero_pd(), _CMP_GT_OQ)) != 0)
            _mm256_storeu_pd(side, ratio_sides(plan->view, &four));
        for (int32_t k = 0; k < 4 && n + k < count; k++) {
            sums[n + k] = sum[k];
            sides[n + k] = side[k];
        }
    }
}

/* atan2() of those that are `good`, by the library that likelihood.c calls. */
static inline __m256d ratio_angles(__m256d y, __m256d x, int good)
{
    double ys[4], xs[4], angles[4] = {0, 0, 0, 0};
    _mm256_storeu_pd(ys, y);
    _mm256_storeu_pd(xs, x);
    for (int k = 0; k < 4; k++)
        if (good >> k & 1)
            angles[k] = atan2(ys[k], xs[k]);
    return _mm256_loadu_pd(angles);
}

/* planar_residuals() and what follows from them: J, B = J^-1 A and the residuals of those that are `good`, near where h puts
 * them. */
static inline __m256d ratio_shapes_four(const asj_ratio_plan *plan, const double *h, double sd, const ratio_four *c, __m256d w,
                                        const __m256d at[2], const __m256d off[2], __m256d good)
{
    const double loose = plan->peaks->loose, most = ASJ_FAR_PLANAR * loose * loose;
    const __m256d zero = _mm256_setzero_pd(), x = at[0], y = at[1], dx = off[0], dy = off[1], half = ratio_set(0.5);
    const __m256d j0 = _mm256_div_pd(_mm256_sub_pd(ratio_set(h[0]), ratio_mul(x, ratio_set(h[6]))), w);
    const __m256d j1 = _mm256_div_pd(_mm256_sub_pd(ratio_set(h[1]), ratio_mul(x, ratio_set(h[7]))), w);
    const __m256d j2 = _mm256_div_pd(_mm256_sub_pd(ratio_set(h[3]), ratio_mul(y, ratio_set(h[6]))), w);
    const __m256d j3 = _mm256_div_pd(_mm256_sub_pd(ratio_set(h[4]), ratio_mul(y, ratio_set(h[7]))), w);
    const __m256d det = ratio_cross(j0, j3, j1, j2), *a = c->affine;
    const __m256d b0 = _mm256_div_pd(ratio_cross(j3, a[0], j1, a[2]), det);
    const __m256d b1 = _mm256_div_pd(ratio_cross(j3, a[1], j1, a[3]), det);
    const __m256d b2 = _mm256_div_pd(ratio_cross(j0, a[2], j2, a[0]), det);
    const __m256d b3 = _mm256_div_pd(ratio_cross(j0, a[3], j2, a[1]), det);
    const __m256d area = ratio_cross(b0, b3, b1, b2);
    const __m256d ex = _mm256_div_pd(ratio_cross(j3, dx, j1, dy), det), ey = _mm256_div_pd(ratio_cross(j0, dy, j2, dx), det);
    const __m256d back = _mm256_cmp_pd(ratio_two(ex, ex, ey, ey), ratio_two(dx, dx, dy, dy), _CMP_GT_OQ);
    const __m256d scale = _mm256_sqrt_pd(area), shear = ratio_mul(scale, ratio_set(ASJ_SHEAR_SD));
    const __m256d v0 = _mm256_div_pd(_mm256_blendv_pd(dx, ex, back), ratio_set(sd));
    const __m256d v1 = _mm256_div_pd(_mm256_blendv_pd(dy, ey, back), ratio_set(sd)), first = ratio_two(v0, v0, v1, v1);
    const __m256d v4 = _mm256_div_pd(ratio_mul(half, _mm256_sub_pd(b0, b3)), shear), v44 = ratio_mul(v4, v4);
    const __m256d v5 = _mm256_div_pd(ratio_mul(half, ratio_add(b1, b2)), shear), v55 = ratio_mul(v5, v5);
    good = _mm256_and_pd(good, _mm256_cmp_pd(det, ratio_set(1e-12), _CMP_GT_OQ));
    good = _mm256_and_pd(good, _mm256_cmp_pd(area, zero, _CMP_GT_OQ));
    good = _mm256_and_pd(good, _mm256_cmp_pd(ratio_add(ratio_add(first, v44), v55), ratio_set(most), _CMP_NGT_UQ));
    const __m256d turn = ratio_angles(_mm256_sub_pd(b2, b1), ratio_add(b0, b3), _mm256_movemask_pd(good));
    const __m256d v2 = _mm256_div_pd(turn, ratio_set(plan->set->angle_sd));
    const __m256d v3 = _mm256_div_pd(ratio_log(scale), ratio_set(plan->set->scale_sd));
    const __m256d square = ratio_add(ratio_add(ratio_add(ratio_add(first, ratio_mul(v2, v2)), ratio_mul(v3, v3)), v44), v55);
    return ratio_sum(plan->peaks, square, good, 1);
}

static inline __m256d ratio_places_four(const asj_ratio_plan *plan, const double *h, const double *front, double sd,
                                        const ratio_four *c)
{
    const double loose = plan->peaks->loose, most = ASJ_FAR_PLANAR * loose * loose;
    const __m256d x1 = c->at[0], y1 = c->at[1], zero = _mm256_setzero_pd(), w = ratio_three(h[6], x1, h[7], y1, h[8]);
    const __m256d at[2] = {_mm256_div_pd(ratio_three(h[0], x1, h[1], y1, h[2]), w),
                           _mm256_div_pd(ratio_three(h[3], x1, h[4], y1, h[5]), w)};
    const __m256d off[2] = {_mm256_sub_pd(c->at[2], at[0]), _mm256_sub_pd(c->at[3], at[1])};
    const __m256d distance = ratio_two(off[0], off[0], off[1], off[1]);
    __m256d good = _mm256_cmp_pd(distance, ratio_set(most * sd * sd), _CMP_LE_OQ);
    good = _mm256_and_pd(good, _mm256_cmp_pd(w, zero, _CMP_GT_OQ));
    if (front)
        good = _mm256_and_pd(good, _mm256_cmp_pd(ratio_three(front[0], x1, front[1], y1, front[2]), zero, _CMP_GT_OQ));
    return _mm256_movemask_pd(good) == 0 ? zero : ratio_shapes_four(plan, h, sd, c, w, at, off, good);
}

static void ratio_places_avx2(const asj_ratio_plan *plan, const uint32_t *which, int32_t count, double *sums)
{
    const asj_two_view *view = plan->view;
    const double *h = plan->part > 0 ? view->planes[plan->part - 1] : view->matrix;
    const double *front = plan->part > 0 ? view->in_front[plan->part - 1] : NULL;
    const double sd = asj_part_thickness(view, plan->part) * plan->set->location_sd;
    for (int32_t n = 0; n < count; n += 4) {
        double sum[4];
        ratio_four four;
        ratio_load(plan->set, which + n, count - n, &four);
        _mm256_storeu_pd(sum, ratio_places_four(plan, h, front, sd, &four));
        for (int32_t k = 0; k < 4 && n + k < count; k++)
            sums[n + k] = sum[k];
    }
}

#endif
