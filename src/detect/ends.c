/* SPDX-License-Identifier: BSD-2-Clause */
/* The ends of branches are known to about a pixel when the edge breaks off in plain sight, and worse where others are in the way:
 * at acute corners, and with the scan's own ends (end_contrast = 0) at all corners, since the local junctions there hold several
 * branches, and which one is closest to the ray is a matter of noise. The corner itself is located to a few tenths of a pixel. So
 * when a junction lies on the line of a branch (within OFF_LINE px) and within snap_distance of its end, that is where the branch
 * ends; px of the branch's octave both, and in coarse octaves, where ends are known worse, COARSE_REACH at least. The paper has no
 * such step (snap_distance = 0); there such ends are only told to be at a junction.
 *
 * A wide reach makes ends depend on whether the junction was found: of 24 photographs and their copies 45.8 % of the junctions
 * repeat with 8 px, 48.6 with 3, by the paper's criterion. A junction that is beyond doubt is found in every copy, though, and
 * where a branch of its own comes back and none goes on, the edge ends at it: another branch that leaves it at a small angle is
 * what carried the end beyond. So at such a junction the reach grows from snap_distance to SURE_REACH as log10 NFA of the second of
 * its branches, best first, goes from DOUBTFUL to SURE (against one reach: tests/accuracy/tried/detection.md, "The reach of
 * ends"). */
#include "ends.h"
#include "core/angle.h"

#include <math.h>

#define OFF_LINE 2.0 /* px */
#define AT_END 4.0   /* px: a junction so near is what is at the end, whether the end moves or not */
#define COARSE_REACH 4.0 /* px */
#define SURE_REACH 8.0   /* px */
#define DOUBTFUL (-30 * ASJ_LN_10) /* natural logarithms */
#define SURE (-60 * ASJ_LN_10)

/* Whether an edge that comes at this angle ends at the junction: a branch comes back, and none goes on. */
static int ends_at(const asj_hypothesis *junction, double angle)
{
    int back = 0;
    for (int32_t i = 0; i < junction->branch_count; i++) {
        if (asj_angle_distance(junction->branches[i].angle, angle) <= ASJ_ONE_WAY)
            return 0;
        back |= asj_angle_distance(junction->branches[i].angle, angle + ASJ_PI) <= ASJ_ONE_WAY;
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

/* What is asked of junctions near the end of a branch. */
typedef struct question {
    const asj_junction_grid *grid;
    const asj_hypothesis *junctions;
    size_t self;          /* the branch's own */
    const asj_hypothesis_branch *branch;
    double ux, uy, scale; /* its direction; px of the image for one of its octave */
    double reach;         /* px of its octave from its end, more to those that are `sure` */
    int sure, own_octave; /* own_octave: those of other octaves are none */
} question;

/* Of two as far from the end, the upper one. */
static int is_before(const asj_grid_place *p, const asj_grid_place *q)
{
    return p->y != q->y ? p->y < q->y : p->x < q->x;
}

/* Looks at the junctions of one cell. */
static void look_in(const question *q, int32_t cell, double *best, double *distance, const asj_grid_place **found)
{
    const asj_hypothesis *from = &q->junctions[q->self];
    for (int32_t k = q->grid->first[cell]; k < q->grid->first[cell + 1]; k++) {
        const asj_grid_place *place = &q->grid->places[k];
        const double dx = place->x - from->x, dy = place->y - from->y;
        const double t = dx * q->ux + dy * q->uy, off = fabs(dy * q->ux - dx * q->uy), away = fabs(t - q->branch->length);
        if (!(off <= OFF_LINE * q->scale && t > 0) || (size_t)place->junction == q->self ||
            (q->own_octave && place->octave != asj_octave_index(from->octave)))
            continue;
        if (!(away < *best || (*found && away == *best && is_before(place, *found))))
            continue;
        const asj_hypothesis *junction = &q->junctions[place->junction];
        if (away < q->scale * (q->sure ? reach_of(junction, q->branch->angle, q->reach) : q->reach)) {
            *best = away;
            *distance = t;
            *found = place;
        }
    }
}

/* The junction on the line of a branch nearest to its end; NULL = none. *distance: px to it. */
static const asj_hypothesis *find_end(const question *q, double *distance)
{
    const asj_hypothesis *from = &q->junctions[q->self];
    const double around = q->scale * ((q->sure ? fmax(q->reach, SURE_REACH) : q->reach) + OFF_LINE);
    const double x = from->x + q->branch->length * q->ux, y = from->y + q->branch->length * q->uy;
    const int32_t columns = q->grid->columns, rows = q->grid->rows;
    const int32_t left = asj_grid_cell(x - around, columns), right = asj_grid_cell(x + around, columns);
    const int32_t upper = asj_grid_cell(y - around, rows), lower = asj_grid_cell(y + around, rows);
    const asj_grid_place *found = NULL;
    double best = HUGE_VAL;
    for (int32_t row = upper; row <= lower; row++)
        for (int32_t column = left; column <= right; column++)
            look_in(q, row * columns + column, &best, distance, &found);
    return found ? &q->junctions[found->junction] : NULL;
}

static question ask(const asj_ends *ends, size_t self, const asj_hypothesis_branch *branch, double reach, int sure, int own_octave)
{
    return (question){ends->grid, ends->hypotheses, self, branch, cos(branch->angle), sin(branch->angle),
                      asj_octave_scale(branch->octave), reach, sure, own_octave};
}

void asj_ends_mark(const asj_ends *ends, size_t index)
{
    asj_hypothesis *hypothesis = &ends->hypotheses[index];
    double distance;
    for (int32_t b = 0; b < hypothesis->branch_count; b++) {
        const question q = ask(ends, index, &hypothesis->branches[b], fmax(ends->options->snap_distance, AT_END), 0, 0);
        if (find_end(&q, &distance))
            hypothesis->branches[b].end = ASJ_BRANCH_END_JUNCTION;
    }
}

/* No branch becomes shorter than minimum_length, nor, where ends move from farther than snap_distance says, than half of what it
 * was: what is so near is no end of it. */
static void snap(const asj_ends *ends, size_t index, asj_hypothesis_branch *branch)
{
    const double reach = ends->options->snap_distance, half = reach < SURE_REACH ? 0.5 * branch->length : 0;
    const double least = fmax(ends->options->minimum_length, half);
    const int own_octave = ends->options->independent_octaves;
    const double base = branch->octave > 0 && reach > 0 ? fmax(reach, COARSE_REACH) : reach;
    const question far = ask(ends, index, branch, base, 1, own_octave), near = ask(ends, index, branch, AT_END, 0, own_octave);
    double distance = 0;
    const asj_hypothesis *end = find_end(&far, &distance);
    if (end && distance >= least) {
        branch->end = ASJ_BRANCH_END_JUNCTION;
        branch->length = distance;
        branch->end_variance = ends->hypotheses[index].location_variance + end->location_variance;
    } else if (find_end(&near, &distance)) {
        branch->end = ASJ_BRANCH_END_JUNCTION;
    } else if (branch->end == ASJ_BRANCH_END_JUNCTION) {
        branch->end = ASJ_BRANCH_END_UNKNOWN; /* of another octave, gone */
    }
}

void asj_ends_snap(const asj_ends *ends, size_t index)
{
    for (int32_t b = 0; b < ends->hypotheses[index].branch_count; b++)
        snap(ends, index, &ends->hypotheses[index].branches[b]);
}
