/* SPDX-License-Identifier: BSD-2-Clause */
/* The ends of branches are known to about a pixel when the edge breaks off in plain sight, and worse where others are in the way:
 * at acute corners, and with the scan's own ends (end_contrast = 0) at all corners, since the local junctions there hold several
 * branches, and which one is closest to the ray is a matter of noise. The corner itself is located to a few tenths of a pixel. So
 * when a junction lies on the line of a branch (within OFF_LINE px) and within snap_distance of its end, that is where the branch
 * ends; px of the branch's octave both, and in coarse octaves, where ends are known worse, COARSE_REACH at least. The paper has no
 * such step (snap_distance = 0); there such ends are only told to be at a junction.
 *
 * A wide reach makes ends depend on whether the junction was found: on 24 photographs and their copies (zoom, shift, blur, noise,
 * compression, gain) 45.8 % of the junctions repeat with 8 px, 47.7 with 4, 48.6 with 3, by the paper's criterion. A junction that
 * is beyond doubt is found in every copy, though, and where a branch of its own comes back and none goes on, the edge ends at it:
 * another branch that leaves it at a small angle is what carried the end beyond. So at such a junction the reach grows from
 * snap_distance to SURE_REACH as log10 NFA of the second of its branches, best first, goes from DOUBTFUL to SURE. Against one reach
 * of 4 px, and 8 from -60 on, with snap_distance = 2: 45.8 % of the junctions of six photographs repeat at zoom 0.9 and 53.9 with
 * noise (44.3 and 49.9), of eighteen more 34.6 and 50.0 (34.0 and 49.2); .877 of the rendered room's lengths are right (.880). */
#include "ends.h"
#include "core/angle.h"

#include <math.h>
#include <stdlib.h>

#define OFF_LINE 2.0 /* px */
#define AT_END 4.0   /* px: a junction so near is what is at the end, whether the end moves or not */
#define COARSE_REACH 4.0 /* px */
#define SURE_REACH 8.0   /* px */
#define DOUBTFUL (-30 * 2.302585092994046) /* natural logarithms */
#define SURE (-60 * 2.302585092994046)
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

/* Whether an edge that comes at this angle ends at the junction: a branch comes back, and none goes on. */
static int ends_at(const asj_hypothesis *junction, double angle)
{
    int back = 0;
    for (int32_t i = 0; i < junction->branch_count; i++) {
        if (asj_angle_distance(junction->branches[i].angle, angle) <= TURN)
            return 0;
        back |= asj_angle_distance(junction->branches[i].angle, angle + ASJ_PI) <= TURN;
    }
    return back;
}

/* ln NFA of the second of its branches, best first. */
static double second_log_nfa(const asj_hypothesis *junction)
{
    double first = HUGE_VAL, second = HUGE_VAL;
    for (int32_t i = 0; i < junction->branch_count; i++) {
        const double log_nfa = junction->branches[i].log_nfa;
        second = log_nfa < first ? first : fmin(second, log_nfa);
        first = fmin(first, log_nfa);
    }
    return second;
}

/* px from which the end of an edge that comes at this angle moves onto the junction; `base`: onto any. */
static double reach_of(const asj_hypothesis *junction, double angle, double base)
{
    if (!(base > 0 && base < SURE_REACH) || !ends_at(junction, angle))
        return base;
    const double sure = (DOUBTFUL - second_log_nfa(junction)) / (DOUBTFUL - SURE);
    return base + (SURE_REACH - base) * fmin(fmax(sure, 0), 1);
}

/* The junction on the line of a branch nearest to its end, less than `reach` px of its octave away, or farther from those that are
 * `sure`; NULL = none. *distance: px to it. With own_octave those of other octaves are none. */
static const asj_hypothesis *find_end(const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch, double reach, int sure,
                                      int own_octave, const asj_hypothesis *const *order, size_t count, double *distance)
{
    const double ux = cos(branch->angle), uy = sin(branch->angle), end_y = hypothesis->y + branch->length * uy;
    const double scale = asj_octave_scale(branch->octave), off_line = OFF_LINE * scale;
    const double around = scale * (sure ? fmax(reach, SURE_REACH) : reach) + off_line;
    const asj_hypothesis *found = NULL;
    double best = HUGE_VAL;
    for (size_t i = lower_bound(order, count, end_y - around); i < count && order[i]->y <= end_y + around; i++) {
        const double dx = order[i]->x - hypothesis->x, dy = order[i]->y - hypothesis->y;
        const double t = dx * ux + dy * uy, off = fabs(dy * ux - dx * uy), away = fabs(t - branch->length);
        if (own_octave && order[i]->octave != hypothesis->octave)
            continue;
        if (order[i] != hypothesis && t > 0 && off <= off_line && away < best &&
            away < scale * (sure ? reach_of(order[i], branch->angle, reach) : reach)) {
            best = away;
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

/* No branch becomes shorter than minimum_length, nor, where ends move from farther than snap_distance says, than half of what it
 * was: what is so near is no end of it. */
static void snap(const asj_hypothesis *hypothesis, const asj_detect_options *options, const asj_hypothesis *const *order,
                 size_t count, asj_hypothesis_branch *branch)
{
    const double reach = options->snap_distance, half = reach < SURE_REACH ? 0.5 * branch->length : 0;
    const double least = fmax(options->minimum_length, half);
    const int own_octave = options->octave_union;
    const double base = branch->octave > 0 && reach > 0 ? fmax(reach, COARSE_REACH) : reach;
    double distance = 0;
    const asj_hypothesis *end = find_end(hypothesis, branch, base, 1, own_octave, order, count, &distance);
    if (end && distance >= least) {
        branch->end = ASJ_BRANCH_END_JUNCTION;
        branch->length = distance;
        branch->end_variance = hypothesis->location_variance + end->location_variance;
    } else if (find_end(hypothesis, branch, AT_END, 0, own_octave, order, count, &distance)) {
        branch->end = ASJ_BRANCH_END_JUNCTION;
    } else if (branch->end == ASJ_BRANCH_END_JUNCTION) {
        branch->end = ASJ_BRANCH_END_UNKNOWN; /* of another octave, gone */
    }
}

void asj_ends_snap(asj_hypothesis *hypotheses, size_t count, const asj_detect_options *options, const asj_hypothesis **order,
                   asj_watch *watch)
{
    sort_by_row(hypotheses, count, order);
    for (size_t i = 0; i < count && !(watch && asj_watch_stops(watch, NULL)); i++)
        for (int32_t b = 0; b < hypotheses[i].branch_count; b++)
            snap(&hypotheses[i], options, order, count, &hypotheses[i].branches[b]);
}
