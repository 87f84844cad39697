/* SPDX-License-Identifier: BSD-2-Clause */
/* The ends of branches are known to about a pixel when the edge breaks off in plain sight, and worse where others are in the way:
 * at acute corners, and with the scan's own ends (end_contrast = 0) at all corners, since the local junctions there hold several
 * branches, and which one is closest to the ray is a matter of noise. The corner itself is located to a few tenths of a pixel. So
 * when a junction lies on the line of a branch (within OFF_LINE px) and within snap_distance of its end, that is where the branch
 * ends; px of the branch's octave both. A wide reach makes ends depend on whether the junction was found: on 24 photographs and
 * their copies (zoom, shift, blur, noise, compression, gain) 45.8 % of the junctions repeat with 8 px, 47.7 with 4, 48.6 with 3, by
 * the paper's criterion, while 4 px are what ends at rounded corners of rendered scenes need. The paper has no such step
 * (snap_distance = 0); there such ends are only told to be at a junction.
 *
 * A junction that is beyond doubt is found in every copy, and where a branch of its own comes back and none goes on, the edge ends
 * at it: another branch that leaves it at a small angle is what carried the end beyond. So the end moves onto such a junction from
 * up to SURE_REACH px away. Stars and the rendered room (tests/accuracy): .912 and .870 of the lengths right without it, .937 and
 * .880 with it; on the photographs as many junctions repeat. If all junctions counted as sure it would be 2 in 100 less. */
#include "ends.h"
#include "core/angle.h"

#include <math.h>
#include <stdlib.h>

#define OFF_LINE 2.0 /* px */
#define AT_END 4.0   /* px: a junction so near is what is at the end, whether the end moves or not */
#define SURE_REACH 8.0 /* px */
#define SURE_LOG_NFA (-60 * 2.302585092994046) /* natural logarithm: of the second of its branches, best first */
#define TURN (15 * ASJ_DEGREE) /* default of merge_angle: closer branches would be one */

static int by_row(const void *a, const void *b)
{
    const asj_hypothesis *p = *(const asj_hypothesis *const *)a, *q = *(const asj_hypothesis *const *)b;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p->x < q->x ? -1 : p->x > q->x;
}

/* First hypothesis in `order` with y >= least. */
static size_t lower_bound(const asj_hypothesis *const *order, size_t count, double least)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (order[middle]->y < least)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Whether an edge that comes at this angle surely ends at the junction. */
static int surely_ends(const asj_hypothesis *junction, double angle)
{
    int sure = 0, back = 0;
    for (int32_t i = 0; i < junction->branch_count; i++) {
        const asj_hypothesis_branch *branch = &junction->branches[i];
        if (asj_angle_distance(branch->angle, angle) <= TURN)
            return 0;
        back |= asj_angle_distance(branch->angle, angle + ASJ_PI) <= TURN;
        sure += branch->log_nfa <= SURE_LOG_NFA;
    }
    return back && sure >= 2;
}

/* The junction on the line of a branch nearest to its end, less than `reach` px away, of those at which it `surely` ends or of all;
 * NULL = none. *distance: px to it. With own_octave only junctions of the hypothesis' own octave count. */
static const asj_hypothesis *find_end(const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch, double reach,
                                      int surely, int own_octave, const asj_hypothesis *const *order, size_t count,
                                      double *distance)
{
    const double ux = cos(branch->angle), uy = sin(branch->angle), end_y = hypothesis->y + branch->length * uy;
    const double off_line = OFF_LINE * (1 << branch->octave), around = reach + off_line;
    const asj_hypothesis *found = NULL;
    double best = reach;
    for (size_t i = lower_bound(order, count, end_y - around); i < count && order[i]->y <= end_y + around; i++) {
        const double dx = order[i]->x - hypothesis->x, dy = order[i]->y - hypothesis->y;
        const double t = dx * ux + dy * uy, off = fabs(dy * ux - dx * uy);
        if (own_octave && order[i]->octave != hypothesis->octave)
            continue;
        if (order[i] != hypothesis && t > 0 && off <= off_line && fabs(t - branch->length) < best &&
            (!surely || surely_ends(order[i], branch->angle))) {
            best = fabs(t - branch->length);
            *distance = t;
            found = order[i];
        }
    }
    return found;
}

static void sort_by_row(const asj_hypothesis *hypotheses, size_t count, const asj_hypothesis **order)
{
    for (size_t i = 0; i < count; i++)
        order[i] = &hypotheses[i];
    if (count > 1)
        qsort(order, count, sizeof *order, by_row);
}

void asj_ends_mark(asj_hypothesis *hypotheses, size_t count, double reach, const asj_hypothesis **order, asj_watch *watch)
{
    double distance;
    sort_by_row(hypotheses, count, order);
    for (size_t i = 0; i < count && !(watch && asj_watch_stops(watch, NULL)); i++)
        for (int32_t b = 0; b < hypotheses[i].branch_count; b++) {
            asj_hypothesis_branch *branch = &hypotheses[i].branches[b];
            if (find_end(&hypotheses[i], branch, fmax(reach, AT_END), 0, 0, order, count, &distance))
                branch->end = ASJ_BRANCH_END_JUNCTION;
        }
}

static void snap(const asj_hypothesis *hypothesis, double reach, int own_octave, const asj_hypothesis *const *order, size_t count,
                 asj_hypothesis_branch *branch)
{
    const double scale = 1 << branch->octave;
    const int surely = reach > 0 && reach < SURE_REACH;
    double distance = 0;
    const asj_hypothesis *end = NULL;
    if (surely)
        end = find_end(hypothesis, branch, scale * SURE_REACH, 1, own_octave, order, count, &distance);
    reach = end ? SURE_REACH : reach;
    end = end ? end : find_end(hypothesis, branch, scale * fmax(reach, AT_END), 0, own_octave, order, count, &distance);
    if (!end) {
        branch->end = branch->end == ASJ_BRANCH_END_JUNCTION ? ASJ_BRANCH_END_UNKNOWN : branch->end; /* of another octave, gone */
        return;
    }
    branch->end = ASJ_BRANCH_END_JUNCTION;
    if (fabs(distance - branch->length) >= scale * reach)
        return;
    branch->length = distance;
    branch->end_variance = hypothesis->location_variance + end->location_variance;
}

void asj_ends_snap(asj_hypothesis *hypotheses, size_t count, double reach, int own_octave, const asj_hypothesis **order,
                   asj_watch *watch)
{
    sort_by_row(hypotheses, count, order);
    for (size_t i = 0; i < count && !(watch && asj_watch_stops(watch, NULL)); i++)
        for (int32_t b = 0; b < hypotheses[i].branch_count; b++)
            snap(&hypotheses[i], reach, own_octave, order, count, &hypotheses[i].branches[b]);
}
