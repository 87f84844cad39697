/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, line segments: which parts of two matched branches correspond.
 *
 * A branch ends where the scan lost it: at a corner, behind something, or where contrast gave out. Only ends at the same scene
 * point make a segment match. The matches around (around.c) say where an end lies in the other image; ends agree when that is near
 * the other's end there, along the branch and across, in both images: NEAR px, or a sixth of end_tolerance of the length, and three
 * quarters of that when what is at the ends differs. Of all combinations of the branches' length hypotheses that agree, the longest
 * is taken. When none agrees, the longer branch is cut where the other's end is put: the part that both images show. That is put by
 * matches, whose error grows with the square of the distance. An end by a cut is no end of the edge anyway, and so it comes nearer,
 * until it is known as well as by a single match 29 px away (FARTHEST). Where the fundamental matrix of the matches is known
 * (epipolar.c), the end lies on its epipolar line, and so where that crosses the branch, unless it runs along it.
 *
 * Of segments of rendered rooms that end so 98.8 % (both) and 97.3 % (inner) are right, and 79.8 % of those cut; by the lengths
 * under the match's own map it was 96.3, 70.3 and 56.4 % (tests/accuracy/tried/matching.md, "Ends of segments"). */
#include "segments.h"

#include <math.h>

#define NEAR 4.0          /* px */
#define SHARE (1.0 / 6)   /* of end_tolerance */
#define OTHER_KIND 0.75
#define FARTHEST 35.0 /* px: sqrt(29^2 + 20^2), asj_line_place.from */
#define PARTS 10      /* of the branch: it comes nearer by one after the other */
#define LEAST_SINE 0.5     /* of the angle between the branch and the epipolar line */
#define MAPS_OFF 16.0      /* px along the branch that the maps of the matches around may be off, or .. */
#define MAPS_OFF_SHARE 0.4 /* .. this part of the length */

/* How far ends of these kinds may lie apart, as a part of what ends of one kind may. The border of the image is no place of the
 * scene. */
static double leeway(int32_t one, int32_t other)
{
    if (one == ASJ_BRANCH_END_BORDER || other == ASJ_BRANCH_END_BORDER)
        return 0;
    return one == other || one == ASJ_BRANCH_END_UNKNOWN || other == ASJ_BRANCH_END_UNKNOWN ? 1 : OTHER_KIND;
}

/* What is at the end of hypothesis m: all but the first are junctions. */
static int32_t kind_of(const asj_lengths *lengths, int32_t m)
{
    return m == 0 ? lengths->end : ASJ_BRANCH_END_JUNCTION;
}

/* Does `length` lie where the end of the other image is put, within `part` of the limit? */
static int agrees(const asj_line_place *put, double length, double part, double tolerance)
{
    const double most = part * fmax(NEAR, SHARE * tolerance * length), d = put->along - length;
    return d * d + put->off * put->off <= most * most && part > 0;
}

/* Where the epipolar line of the place `length` px along the branch in image `side` crosses the branch in the other image, px along
 * it, in place of where the matches around put it, if they do not contradict. */
static void put_on_line(const asj_around *around, const asj_matched_branch *branch, int32_t side, double length, double *along)
{
    const int32_t other = 1 - side;
    const double *f = around ? around->epipolar : NULL;
    if (!f)
        return;
    const double x = branch->x[side] + length * branch->ux[side], y = branch->y[side] + length * branch->uy[side];
    double line[3]; /* F (x, y, 1) in image 2, F' (x, y, 1) in image 1 */
    for (int32_t k = 0; k < 3; k++)
        line[k] = side == 0 ? f[3 * k] * x + f[3 * k + 1] * y + f[3 * k + 2] : f[k] * x + f[3 + k] * y + f[6 + k];
    const double across = line[0] * branch->ux[other] + line[1] * branch->uy[other], norm = hypot(line[0], line[1]);
    if (!(fabs(across) > LEAST_SINE * norm))
        return;
    const double crossing = -(line[0] * branch->x[other] + line[1] * branch->y[other] + line[2]) / across;
    if (fabs(crossing - *along) <= fmax(MAPS_OFF, MAPS_OFF_SHARE * fabs(*along)))
        *along = crossing;
}

/* The part that both images show, no farther than is known where it lies in the other image. The branch of image 0 is the longer
 * one when its end lies farther beyond the other's, as a part of the lengths, than the other's beyond it. */
static asj_common_end cut(const asj_around *around, const asj_matched_branch *branch, const double length[2],
                          const asj_line_place put[2])
{
    asj_line_place own[2] = {put[0], put[1]};
    for (int32_t side = 0; side < 2; side++)
        put_on_line(around, branch, side, length[side], &own[side].along);
    const double beyond = (own[0].along - length[1]) / length[1] - (own[1].along - length[0]) / length[0];
    const int32_t whole = beyond > 0 ? 1 : 0, other = 1 - whole;
    asj_common_end end = {{length[0], length[1]}, ASJ_END_CUT};
    asj_line_place at = own[whole];
    for (int32_t part = PARTS - 1; part > 0 && at.from > FARTHEST; part--) {
        end.length[whole] = length[whole] * part / PARTS;
        at = asj_around_place(around, branch, whole, end.length[whole]);
        put_on_line(around, branch, whole, end.length[whole], &at.along);
    }
    end.length[other] = fmin(fmax(at.along, fmin(1, length[other])), length[other]);
    return end;
}

asj_common_end asj_find_common_end(const asj_around *around, const asj_matched_branch *branch, const asj_lengths *const lengths[2],
                                   double tolerance)
{
    const asj_lengths *h1 = lengths[0], *h2 = lengths[1];
    asj_line_place put[2][ASJ_MAX_HYPOTHESES];
    asj_common_end end = {{0, 0}, ASJ_END_CUT};
    for (int32_t side = 0; side < 2; side++)
        for (int32_t m = 0; m < lengths[side]->count; m++)
            put[side][m] = asj_around_place(around, branch, side, (double)lengths[side]->length[m]);
    for (int32_t m = 0; m < h1->count; m++)
        for (int32_t n = 0; n < h2->count; n++) {
            const double l1 = (double)h1->length[m], l2 = (double)h2->length[n], part = leeway(kind_of(h1, m), kind_of(h2, n));
            if (l1 * l2 > end.length[0] * end.length[1] && agrees(&put[0][m], l2, part, tolerance) &&
                agrees(&put[1][n], l1, part, tolerance))
                end = (asj_common_end){{l1, l2}, m == 0 && n == 0 ? ASJ_END_BOTH : ASJ_END_INNER};
        }
    if (end.kind != ASJ_END_CUT || h1->count == 0 || h2->count == 0)
        return end;
    const double own[2] = {(double)h1->length[0], (double)h2->length[0]};
    const asj_line_place first[2] = {put[0][0], put[1][0]};
    return cut(around, branch, own, first);
}
