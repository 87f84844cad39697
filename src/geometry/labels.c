/* SPDX-License-Identifier: BSD-2-Clause */
/* Corners of a room have their branches along its directions. In each image a branch within ALONG of where one of them points at
 * its place is labelled with it, and with which way it goes: six labels in each set of directions (directions.c). A rotation
 * D2' P D1 (manhattan.c) says which label of image 1 is which of image 2. Of a right candidate both branches have labels that are
 * the same then; a wrong one, whose shape and affine map fit as well, has them by chance. With the true rotations of rooms 200 to
 * 300, of 2195 right candidates and 171368 wrong ones, in brackets weighed by their priors:
 *
 *     both branches agree        right .78     wrong .10 (.22)
 *     one agrees, one differs          .04           .08 (.07)
 *     both differ                      .001          .44 (.48)
 *     one agrees, one has no label     .13           .06 (.04)
 *     one differs, one has no label    .008          .21 (.13)
 *     neither has one in both images   .04           .11 (.06)
 *
 * A label is none where one of the images has none. The ratios below are between the quotients of these, where wrong ones that look
 * right count as much as they are believed and where they count as others do; what differs keeps a chance, since directions may be
 * out. They multiply the likelihood ratio of candidates (likelihood.c), and their mean over wrong ones is about 1.
 *
 * All candidates together say which rotation it is, before any translation: the likelihood ratio of a rotation is that of
 * score.c with the ratios of labels alone,
 *
 *     log_labels = sum over the places of log(1 + sum p_c (ratio_c - 1)),
 *
 * the smaller of both images'. (161 pairs of rooms with a third in common: in 140 a rotation within 10 degrees of the true one is
 * the first, with its share.) Samples are drawn most from the first ones (search.c). It is no part of the evidence.
 *
 * A motion has the names of a rotation that is as near as branches must be to directions: with 6 degrees motions that are off by 3
 * to 5 are drawn there by what they gain, and in 806 pairs of rooms 24 poses are out by more than 3 degrees instead of 16. */
#include "labels.h"
#include "core/angle.h"
#include "core/sort.h"
#include "elementary.h"
#include "small_matrix.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define ALONG (4 * ASJ_DEGREE)
#define NEAR ALONG

/* By what the two branches do: 0 no label, 1 the same, 2 another one. */
static const double ratios[3][3] = {{1, 3, 0.15}, {3, 5, 0.3}, {0.15, 0.3, 0.02}};

static uint8_t label_of(const double axes[9], const asj_camera *camera, double x, double y, const double branch[2])
{
    const double rx = (x - camera->cx) / camera->fx, ry = (y - camera->cy) / camera->fy;
    double best = cos(ALONG);
    int32_t label = 0;
    for (int32_t a = 0; a < 3; a++) {
        /* where (rx, ry, 1) goes in the image when it moves along the axis */
        const double *d = axes + 3 * a, ux = camera->fx * (d[0] - rx * d[2]), uy = camera->fy * (d[1] - ry * d[2]);
        const double along = ux * branch[0] + uy * branch[1], length = sqrt(ux * ux + uy * uy);
        if (fabs(along) > best * length) {
            best = fabs(along) / length;
            label = ASJ_LABEL(a, along < 0);
        }
    }
    return (uint8_t)label;
}

void asj_set_labels(asj_pairs *set, const double *branches, const asj_directions_list directions[2], const asj_camera cameras[2])
{
    set->has_labels = 1;
    for (int32_t k = 0; k < set->count; k++) {
        asj_pair *c = &set->list[k];
        const double *of_pair = branches + ASJ_BRANCH_NUMBERS * (size_t)c->source;
        for (int32_t side = 0; side < 2; side++)
            for (int32_t n = 0; n < 2 * directions[side].count; n++)
                c->label[side][n / 2][n % 2] =
                    label_of(directions[side].list[n / 2].axes, &cameras[side], side == 0 ? c->x1 : c->x2,
                             side == 0 ? c->y1 : c->y2, of_pair + 4 * (ptrdiff_t)side + 2 * (ptrdiff_t)(n % 2));
    }
}

double asj_label_ratio(const asj_likely_rotation *rotation, const asj_pair *c)
{
    const uint8_t *first = c->label[0][rotation->of_set[0]], *second = c->label[1][rotation->of_set[1]];
    int32_t does[2];
    for (int32_t b = 0; b < 2; b++)
        does[b] = first[b] == 0 || second[b] == 0 ? 0 : rotation->name[first[b]] == second[b] ? 1 : 2;
    return ratios[does[0]][does[1]];
}

/* The trace of R2 R1' is 1 + 2 cos(angle), and rows differ by no more than the angle: most rotations fail by the first. */
const asj_likely_rotation *asj_named_rotation(const asj_pairs *set, const double rotation[9])
{
    const double least = cos(NEAR);
    for (int32_t k = 0; k < set->rotation_count; k++) {
        const double *m = set->rotations[k].matrix, first = asj_dot3(m, rotation);
        if (first > least && first + asj_dot3(m + 3, rotation + 3) + asj_dot3(m + 6, rotation + 6) > 1 + 2 * least)
            return &set->rotations[k];
    }
    return NULL;
}

/* sum: room for the places of an image. */
static double log_labels(const asj_pairs *set, const asj_likely_rotation *rotation, double *sum)
{
    double least = HUGE_VAL;
    for (int32_t side = 0; side < 2; side++) {
        double total = 0;
        memset(sum, 0, (size_t)set->place_count[side] * sizeof *sum);
        for (int32_t k = 0; k < set->count; k++) {
            const asj_pair *c = &set->list[k];
            sum[side == 0 ? c->place1 : c->place2] += c->prior * (asj_label_ratio(rotation, c) - 1);
        }
        for (int32_t p = 0; p < set->place_count[side]; p++)
            total += asj_log_normal(1 + sum[p]);
        least = total < least ? total : least;
    }
    return least;
}

static int likelier(const void *left, const void *right)
{
    const asj_likely_rotation *p = left, *q = right;
    const double a = p->log_labels + p->log_share, b = q->log_labels + q->log_share;
    if (a != b)
        return a > b ? -1 : 1;
    for (int32_t k = 0; k < 9; k++) /* no two are the same */
        if (p->matrix[k] != q->matrix[k])
            return p->matrix[k] < q->matrix[k] ? -1 : 1;
    return 0;
}

int32_t asj_order_rotations(asj_memory *memory, asj_pairs *set)
{
    const int32_t places = set->place_count[0] > set->place_count[1] ? set->place_count[0] : set->place_count[1];
    double *sum = asj_allocate(memory, (size_t)places, sizeof *sum);
    for (int32_t k = 0; k < set->rotation_count && sum; k++)
        set->rotations[k].log_labels = log_labels(set, &set->rotations[k], sum);
    if (set->rotation_count > 1 && sum)
        asj_sort(set->rotations, (size_t)set->rotation_count, sizeof *set->rotations, likelier);
    asj_release(memory, sum);
    return sum != NULL;
}
