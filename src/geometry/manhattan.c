/* SPDX-License-Identifier: BSD-2-Clause */
/* Rooms are built at right angles, and the edges of each image tell its three directions (directions.c), though not which is which.
 * With the directions as rows of D1 and D2, in camera coordinates, the rotation from camera 1 to camera 2 is one of
 *
 *     R = D2' P D1,   P one of the 24 signed permutations that make R a rotation,
 *
 * and when D1 turns by w1 and D2 by w2, both with covariances C1 and C2, R turns by w = w2 - R w1, which has C = C2 + R C1 R'.
 * Directions are not quite at right angles, so the covariances count `alike` times, and `sd` in each angle comes to them. How much
 * depends on the room and on the camera: rendered rooms have their walls at right angles, and their directions are as sure as they
 * say; those of video frames are out by 1.4 to 7.5 degrees. So the density of each is a mixture of three normal ones, as with the
 * locations of candidates (likelihood.c), the narrowest with half the covariances (tests/accuracy/tried/geometry.md, "How
 * straight the edges are").
 *
 * Photographs are taken upright: where in both images a direction lies within 40 degrees of the image's downward axis, it is the
 * same one, down, in nine of ten pairs. That leaves 4 of the 24 names, whose share of the prior is so much larger; and a homography
 * has a pose, since of its two motions one is seldom upright. UPRIGHT leaves room for a camera that was turned between the
 * photographs.
 *
 * Prior density of rotations: a half of it flat, the other half about all those that the sets of directions of both images give,
 * a pair of sets as likely as both are together: of each image EVEN of the whole is shared evenly by its sets, and the rest as
 * exp(score / ASJ_SCORE_COOL), since the edges that a score counts are not independent:
 *
 *     q(R) / flat = 1/2 + 1/2 (8 pi^2) sum of share x (2 pi)^(-3/2) det(C)^(-1/2) exp(-w' C^-1 w / 2),
 *
 * w from R to each, those farther than NEAR left out: directions that are known badly lose by it. It is fixed before any candidate
 * is looked at, so the evidence (evidence.c) holds, and directions that are wrong cost no more than log 2. */
#include "manhattan.h"
#include "core/angle.h"
#include "core/context.h"
#include "labels.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define NEAR (6 * ASJ_DEGREE)
#define UPRIGHT_NAMES 4
#define UPRIGHT 0.9
#define DOWN 0.77 /* cos 40 degrees */
#define EVEN 0.1

static const double sd[ASJ_ROTATION_SIZES] = {0.8 * ASJ_DEGREE, 0.25 * ASJ_DEGREE, 0.1 * ASJ_DEGREE};
static const double alike[ASJ_ROTATION_SIZES] = {8, 2, 0.5};

void asj_directions_given(const double directions[9], asj_directions_list *list)
{
    memset(list, 0, sizeof *list);
    if (!(fabs(asj_determinant3(directions)) > 0.5))
        return;
    list->count = 1;
    memcpy(list->list[0].axes, directions, sizeof list->list[0].axes);
}

static int32_t set_rotation(const asj_directions *first, const asj_directions *second, const double matrix[9], double log_share,
                            asj_likely_rotation *r)
{
    double turned[9], together[9];
    memcpy(r->matrix, matrix, sizeof r->matrix);
    asj_multiply3(matrix, first->covariance, turned);
    asj_multiply3_transposed(turned, matrix, together);
    for (int32_t n = 0; n < ASJ_ROTATION_SIZES; n++) {
        double covariance[9];
        for (int32_t k = 0; k < 9; k++)
            covariance[k] = alike[n] * (together[k] + second->covariance[k]) + (k % 4 == 0 ? sd[n] * sd[n] : 0);
        r->log_top[n] = log_share - log(ASJ_ROTATION_SIZES) + log(8 * ASJ_PI * ASJ_PI) - 1.5 * log(2 * ASJ_PI) -
                        0.5 * log(asj_determinant3(covariance));
        if (!asj_invert3(covariance, r->precision[n]))
            return 0;
    }
    return 1;
}

/* The direction that points down in the image, if one of them does. */
static int32_t find_down(const asj_directions *of, double down[3])
{
    int32_t best = 0;
    for (int32_t k = 1; k < 3; k++)
        best = fabs(of->axes[3 * k + 1]) > fabs(of->axes[3 * best + 1]) ? k : best;
    for (int32_t k = 0; k < 3; k++)
        down[k] = of->axes[3 * best + 1] > 0 ? of->axes[3 * best + k] : -of->axes[3 * best + k];
    return down[1] > DOWN;
}

/* Log of the share of a rotation: one of 24, or one of 4 that leave down where it is. */
static double log_share_of(const asj_directions *first, const asj_directions *second, const double matrix[9])
{
    double down[2][3], turned[3];
    if (!find_down(first, down[0]) || !find_down(second, down[1]))
        return log(1.0 / ASJ_NAMES);
    asj_apply3(matrix, down[0], turned);
    return log((1 - UPRIGHT) / ASJ_NAMES + (asj_dot3(turned, down[1]) > 0.5 ? UPRIGHT / UPRIGHT_NAMES : 0));
}

/* All ways to name the directions. */
static int32_t add_names(const asj_directions *first, const asj_directions *second, double log_share, asj_likely_rotation *list)
{
    static const int32_t order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    int32_t count = 0;
    for (int32_t n = 0; n < 48; n++) {
        const int32_t *p = order[n / 8];
        double permuted[9], matrix[9];
        for (int32_t k = 0; k < 9; k++)
            permuted[k] = (n >> (k / 3) & 1 ? -1 : 1) * first->axes[3 * p[k / 3] + k % 3];
        asj_transposed_multiply3(second->axes, permuted, matrix);
        if (!(asj_determinant3(matrix) > 0) || count == ASJ_NAMES)
            continue;
        asj_likely_rotation *r = &list[count];
        r->log_share = log_share + log_share_of(first, second, matrix);
        for (int32_t k = 0; k < 6; k++) /* row k / 2 of D2 is row p[k / 2] of D1, or minus it */
            r->name[ASJ_LABEL(p[k / 2], k % 2)] = (uint8_t)ASJ_LABEL(k / 2, k % 2 ^ (n >> (k / 2) & 1));
        count += set_rotation(first, second, matrix, r->log_share, r);
    }
    return count;
}

/* Log of the share of each set of directions. */
static void log_shares_of_sets(const asj_directions_list *of, double log_share[ASJ_MOST_DIRECTIONS])
{
    double sum = 0;
    for (int32_t k = 0; k < of->count; k++)
        sum += exp((of->list[k].score - of->list[0].score) / ASJ_SCORE_COOL);
    for (int32_t k = 0; k < of->count; k++)
        log_share[k] = log(EVEN / of->count + (1 - EVEN) * exp((of->list[k].score - of->list[0].score) / ASJ_SCORE_COOL) / sum);
}

int32_t asj_manhattan_rotations(asj_memory *memory, const asj_directions_list directions[2], asj_pairs *set)
{
    const int32_t pairs = directions[0].count * directions[1].count;
    double log_share[2][ASJ_MOST_DIRECTIONS];
    set->rotation_count = 0;
    if (pairs == 0)
        return 1;
    set->has_down = find_down(&directions[0].list[0], set->down[0]) && find_down(&directions[1].list[0], set->down[1]);
    set->rotations = asj_allocate_zero(memory, ASJ_NAMES * (size_t)pairs, sizeof *set->rotations);
    for (int32_t v = 0; v < 2; v++)
        log_shares_of_sets(&directions[v], log_share[v]);
    for (int32_t i = 0; i < pairs && set->rotations; i++) {
        const int32_t of_set[2] = {i % directions[0].count, i / directions[0].count};
        asj_likely_rotation *list = &set->rotations[set->rotation_count];
        const int32_t count = add_names(&directions[0].list[of_set[0]], &directions[1].list[of_set[1]],
                                        log_share[0][of_set[0]] + log_share[1][of_set[1]], list);
        for (int32_t k = 0; k < count; k++)
            memcpy(list[k].of_set, of_set, sizeof of_set);
        set->rotation_count += count;
    }
    return set->rotations != NULL;
}

/* w with exp([w]x) R = the k-th of set->rotations; 0 when that is too far away to count. */
static int32_t is_near(const asj_pairs *set, int32_t k, const double rotation[9], double w[3])
{
    const double *m = set->rotations[k].matrix;
    const double trace = asj_dot3(m, rotation) + asj_dot3(m + 3, rotation + 3) + asj_dot3(m + 6, rotation + 6);
    double turn[9];
    if (trace < 1 + 2 * cos(NEAR))
        return 0;
    asj_multiply3_transposed(m, rotation, turn);
    asj_vector_of_rotation(turn, w);
    return 1;
}

/* Its part of the density over the flat one, without the half. */
static double part_of(const asj_likely_rotation *r, const double w[3])
{
    double sum = 0;
    for (int32_t n = 0; n < ASJ_ROTATION_SIZES; n++) {
        double moved[3];
        asj_apply3(r->precision[n], w, moved);
        sum += exp(r->log_top[n] - 0.5 * asj_dot3(w, moved));
    }
    return sum;
}

int32_t asj_nearest_rotation(const asj_pairs *set, const double rotation[9], double w[3])
{
    double best = 0;
    int32_t found = -1;
    for (int32_t k = 0; k < set->rotation_count; k++) {
        double at[3];
        if (!is_near(set, k, rotation, at))
            continue;
        const double part = part_of(&set->rotations[k], at);
        if (part <= best)
            continue;
        best = part;
        found = k;
        memcpy(w, at, sizeof at);
    }
    return found;
}

double asj_rotation_prior(const asj_pairs *set, const double rotation[9])
{
    double sum = 0, w[3];
    if (set->rotation_count == 0)
        return 0;
    for (int32_t k = 0; k < set->rotation_count; k++)
        if (is_near(set, k, rotation, w))
            sum += part_of(&set->rotations[k], w);
    return log(0.5 + 0.5 * sum);
}

/* One that is as likely as no direction at all pulls half as much; so with the sizes of its errors, each as far as it is likely. */
void asj_add_rotation_prior(const asj_pairs *set, const double rotation[9], int32_t n, double *normal, double *right)
{
    double w[3];
    const int32_t nearest = asj_nearest_rotation(set, rotation, w);
    if (nearest < 0)
        return;
    const asj_likely_rotation *r = &set->rotations[nearest];
    const double all = 1 + part_of(r, w);
    for (int32_t size = 0; size < ASJ_ROTATION_SIZES; size++) {
        double pull[3];
        asj_apply3(r->precision[size], w, pull);
        const double weight = exp(r->log_top[size] - 0.5 * asj_dot3(w, pull)) / all;
        for (int32_t i = 0; i < 3; i++) {
            right[i] += weight * pull[i];
            for (int32_t k = 0; k < 3; k++)
                normal[i * n + k] += weight * r->precision[size][3 * i + k];
        }
    }
}
