/* SPDX-License-Identifier: BSD-2-Clause */
/* An edge joins junctions i and j when a branch of either points at the other: with t the distance from i to j along the branch
 * of i,
 *   - j lies at most max(OFF_LINE, OFF_SHARE t) px off that branch's line, and i off the line of the other branch;
 *   - the two point against each other to within ASJ_ONE_WAY;
 *   - one of them reaches the other junction (its length is t or more, but for the uncertainty of its end), the other goes at
 *     least half of the way: the scan may lose a fading edge from one side that it follows from the other;
 *   - the part between is meaningful: log NFA <= log epsilon (edge_evidence.c), by the branch that reaches.
 *
 * Junctions on a line. Branches run on through other junctions (ray_walk.c), so along a line every branch points at many. Joined
 * are neighbours: j is the nearest junction on the way of i that fulfils the above, and i that of j. At first a junction on the
 * way counts only if it divides the edge: if the branch ends there, or another one of its own goes on. One whose branch to the
 * other side was not found must not keep apart what both ends say is one. Then the same without that condition among branches
 * that are left: where a scan has overshot a corner, only the other branch knows where the edge ends. */
#include "edges.h"
#include "strip.h"
#include "core/angle.h"
#include "core/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define OFF_LINE 2.0   /* px of the branch's octave: as branches snap (ends.c) */
#define OFF_SHARE 0.01 /* of the length: 0.6 degrees. Lenses bend long edges */
#define END_NEAR 4.0   /* px of the branch's octave, or .. */
#define END_SURE 3.0   /* .. standard uncertainties of the end, .. */
#define END_MOST 8.0   /* .. but no more than this: where an edge fades they may be fifty pixels */
#define LEAST 3.0      /* px */
#define ROUNDING 1e-3  /* px: more than a sum of coordinates is off */
#define LEAST_JUNCTIONS 32 /* for a thread: one takes about 1 us */

typedef struct graph {
    asj_watch *watch;
    const asj_evidence *evidence;
    const asj_hypothesis *hypotheses;
    const asj_junction_grid *grid;
    int32_t *nearest;      /* of each branch: junction * ASJ_MAX_BRANCHES + branch of what it may be joined with, -1 = none */
    int32_t *joined;       /* the same of what it is joined with */
    int own_octave;        /* whether those of other octaves count as not there */
    int must_divide;       /* whether junctions on the way count only if they divide the edge */
    double log_epsilon, log_tests[2 * (ASJ_MAX_OCTAVES - ASJ_FIRST_OCTAVE)]; /* by asj_octave_index() */
} graph;

/* One branch, seen from its junction. */
typedef struct way {
    size_t junction;
    const asj_hypothesis *from;
    const asj_hypothesis_branch *along;
    double ux, uy;
    double off;     /* OFF_LINE, in px of the image */
    int32_t octave; /* whose junctions count, asj_octave_index(); -1 = of all */
} way;

size_t asj_edges_scratch(size_t count)
{
    return 2 * ASJ_MAX_BRANCHES * count;
}

static double end_tolerance(const asj_hypothesis_branch *branch)
{
    const double scale = asj_octave_scale(branch->octave);
    return fmax(END_NEAR * scale, fmin(END_SURE * sqrt(branch->end_variance), END_MOST * scale));
}

static double larger(double a, double b)
{
    return a > b ? a : b;
}

static double off_tolerance(const asj_hypothesis_branch *branch, double distance)
{
    return larger(OFF_LINE * asj_octave_scale(branch->octave), OFF_SHARE * distance);
}

static int ends_at(const asj_hypothesis_branch *branch, double distance)
{
    return fabs(branch->length - distance) <= end_tolerance(branch);
}

static int reaches(const asj_hypothesis_branch *branch, double distance)
{
    return branch->length >= distance - end_tolerance(branch);
}

/* Whether a junction has a branch in this direction. */
static int goes_on(const asj_hypothesis *hypothesis, double angle)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        if (asj_angle_distance(hypothesis->branches[i].angle, angle) <= ASJ_ONE_WAY)
            return 1;
    return 0;
}

static double log_nfa(const graph *g, const asj_hypothesis_branch *branch, double distance)
{
    return asj_edge_evidence_log_nfa(&g->evidence[branch->evidence], distance / asj_octave_scale(branch->octave),
                                     g->log_tests[asj_octave_index(branch->octave)]);
}

/* Of the two branches those that reach the other junction tell what lies between; the surer one of both. */
static double between(const graph *g, const asj_hypothesis_branch *a, const asj_hypothesis_branch *b, double distance)
{
    const double one = reaches(a, distance) ? log_nfa(g, a, distance) : HUGE_VAL;
    return fmin(one, reaches(b, distance) ? log_nfa(g, b, distance) : HUGE_VAL);
}

static int covers(const asj_hypothesis_branch *a, const asj_hypothesis_branch *b, double distance)
{
    return (reaches(a, distance) && b->length >= 0.5 * distance) || (reaches(b, distance) && a->length >= 0.5 * distance);
}

/* Whether a branch is part of an edge. */
static int is_joined(const graph *g, int32_t junction, int32_t branch)
{
    return g->joined[(size_t)junction * ASJ_MAX_BRANCHES + (size_t)branch] >= 0;
}

/* Whether a place lies on the line of w. *distance: px along it. */
static int is_on(const way *w, const asj_grid_place *place, double *distance)
{
    const double dx = place->x - w->from->x, dy = place->y - w->from->y;
    *distance = dx * w->ux + dy * w->uy;
    return *distance >= LEAST && fabs(dy * w->ux - dx * w->uy) <= larger(w->off, OFF_SHARE * *distance);
}

/* The branch of junction `index`, t px along w, that comes back; -1 = none. */
static int32_t comes_back(const graph *g, const way *w, int32_t index, double t)
{
    const asj_hypothesis *to = &g->hypotheses[index];
    const double dx = to->x - w->from->x, dy = to->y - w->from->y, back = w->along->angle + ASJ_PI;
    double least = ASJ_ONE_WAY;
    int32_t found = -1;
    for (int32_t i = 0; i < to->branch_count; i++) {
        const asj_hypothesis_branch *branch = &to->branches[i];
        const double turn = asj_angle_distance(branch->angle, back);
        if (turn > least || is_joined(g, index, i) || !covers(w->along, branch, t))
            continue;
        const double back_off = fabs(dy * cos(branch->angle) - dx * sin(branch->angle));
        if (back_off > off_tolerance(branch, t) || between(g, w->along, branch, t) > g->log_epsilon)
            continue;
        least = turn;
        found = i;
    }
    return found;
}

/* Looks at the junctions of one cell; the nearest so far is *nearest px away. Returns it as junction * ASJ_MAX_BRANCHES + branch.
 * Hardly one in a hundred lies on the line: only of these more than the place is read. */
static int32_t look_in(const graph *g, const way *w, int32_t cell, double *nearest, int32_t found)
{
    for (int32_t k = g->grid->first[cell]; k < g->grid->first[cell + 1]; k++) {
        const asj_grid_place *place = &g->grid->places[k];
        double distance;
        if ((w->octave >= 0 && place->octave != w->octave) || !is_on(w, place, &distance) || !(distance < *nearest) ||
            (size_t)place->junction == w->junction)
            continue;
        const int32_t branch = comes_back(g, w, place->junction, distance);
        if (branch >= 0 && (!g->must_divide || ends_at(w->along, distance) ||
                            goes_on(&g->hypotheses[place->junction], w->along->angle))) {
            *nearest = distance;
            found = place->junction * ASJ_MAX_BRANCHES + branch;
        }
    }
    return found;
}

/* May a place of this cell lie on the line of w, nearer than `nearest`? Of cells at the border that is not asked: they hold what
 * lies outside, too. */
static int may_hold(const graph *g, const way *w, int32_t column, int32_t row, double nearest)
{
    if (column < 2 || row < 2 || column > g->grid->columns - 3 || row > g->grid->rows - 3)
        return 1;
    const double dx = (column - 0.5) * ASJ_GRID_CELL - w->from->x, dy = (row - 0.5) * ASJ_GRID_CELL - w->from->y;
    const double along = dx * w->ux + dy * w->uy, half = 0.5 * ASJ_GRID_CELL * (fabs(w->ux) + fabs(w->uy)) + ROUNDING;
    return along + half >= LEAST && along - half <= nearest &&
           fabs(dy * w->ux - dx * w->uy) <= half + larger(w->off, OFF_SHARE * (along + half));
}

/* The nearest junction on the way of a branch that it may be joined with; -1 = none. At t along the way all junctions up to
 * t + ASJ_GRID_CELL / 2 that lie near enough to the line are in the cells around, `ring` to either side, of which those around the
 * place before have been looked at. */
static int32_t find_nearest(const graph *g, size_t junction, int32_t branch)
{
    const asj_hypothesis *from = &g->hypotheses[junction];
    const asj_hypothesis_branch *along = &from->branches[branch];
    const way w = {junction, from, along, cos(along->angle), sin(along->angle), OFF_LINE * asj_octave_scale(along->octave),
                   g->own_octave ? asj_octave_index(from->octave) : -1};
    const double last = 2 * along->length + end_tolerance(along);
    const int32_t columns = g->grid->columns, rows = g->grid->rows;
    const int32_t ring = (int32_t)ceil(hypot(off_tolerance(along, last), ASJ_GRID_CELL / 2) / ASJ_GRID_CELL);
    double nearest = HUGE_VAL;
    int32_t found = -1, column_before = -1 - ring, row_before = -1 - ring;
    for (double t = 0; t < last + ASJ_GRID_CELL && nearest > t - ASJ_GRID_CELL / 2; t += ASJ_GRID_CELL) {
        const double x = from->x + t * w.ux, y = from->y + t * w.uy;
        if (x < -ASJ_GRID_CELL || y < -ASJ_GRID_CELL || x > columns * ASJ_GRID_CELL || y > rows * ASJ_GRID_CELL)
            break;
        const int32_t column = asj_grid_cell(x, columns), row = asj_grid_cell(y, rows);
        const int32_t left = column > ring ? column - ring : 0, right = column + ring < columns ? column + ring : columns - 1;
        const int32_t upper = row > ring ? row - ring : 0, lower = row + ring < rows ? row + ring : rows - 1;
        for (int32_t y_cell = upper; y_cell <= lower; y_cell++)
            for (int32_t x_cell = left; x_cell <= right; x_cell++)
                if ((abs(y_cell - row_before) > ring || abs(x_cell - column_before) > ring) &&
                    may_hold(g, &w, x_cell, y_cell, nearest))
                    found = look_in(g, &w, y_cell * columns + x_cell, &nearest, found);
        column_before = column;
        row_before = row;
    }
    return found;
}

static void mark_end(asj_hypothesis *from, int32_t branch, const asj_hypothesis *to)
{
    asj_hypothesis_branch *along = &from->branches[branch];
    if (ends_at(along, hypot(to->x - from->x, to->y - from->y)))
        along->end = ASJ_BRANCH_END_JUNCTION;
}

static graph start(const asj_edge_search *s)
{
    graph g = {.watch = s->watch, .evidence = s->evidence, .grid = s->grid, .hypotheses = s->hypotheses, .nearest = s->scratch,
               .joined = s->scratch + s->count * ASJ_MAX_BRANCHES, .own_octave = s->options->independent_octaves,
               .log_epsilon = log(s->options->epsilon)};
    for (double o = ASJ_FIRST_OCTAVE; o < ASJ_MAX_OCTAVES; o += 0.5) {
        const int32_t columns = asj_octave_size(s->width, o), rows = asj_octave_size(s->height, o);
        g.log_tests[asj_octave_index(o)] = asj_strip_log_tests(columns > 0 ? columns : 1, rows > 0 ? rows : 1, s->octaves);
    }
    memset(g.joined, 0xff, s->count * ASJ_MAX_BRANCHES * sizeof *g.joined);
    return g;
}

static void find_some(const void *data, const asj_part *part)
{
    const graph *g = data;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(g->watch, part); i++)
        for (int32_t b = 0; b < g->hypotheses[i].branch_count; b++)
            g->nearest[i * ASJ_MAX_BRANCHES + b] = is_joined(g, (int32_t)i, b) ? -1 : find_nearest(g, (size_t)i, b);
}

static void find_all(graph *g, size_t count, int must_divide)
{
    const asj_context *context = g->watch->context;
    g->must_divide = must_divide;
    asj_parallel(context, asj_threads_for(context, (int64_t)count, LEAST_JUNCTIONS), (int64_t)count, 0, find_some, g);
}

/* Joins branches that are the nearest of each other. */
static void join_nearest(graph *g, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (int32_t b = 0; b < g->hypotheses[i].branch_count; b++) {
            const int32_t own = (int32_t)(i * ASJ_MAX_BRANCHES) + b, other = g->nearest[own];
            if (other < 0 || g->nearest[other] != own)
                continue;
            g->joined[own] = other;
            g->joined[other] = own;
        }
}

static asj_edge edge_of(const graph *g, int32_t own, int32_t other)
{
    const int32_t i = own / ASJ_MAX_BRANCHES, b = own % ASJ_MAX_BRANCHES;
    const int32_t j = other / ASJ_MAX_BRANCHES, c = other % ASJ_MAX_BRANCHES;
    const asj_hypothesis *from = &g->hypotheses[i], *to = &g->hypotheses[j];
    const double angle = from->branches[b].angle; /* along the branch, as comes_back() has measured it */
    const double distance = (to->x - from->x) * cos(angle) + (to->y - from->y) * sin(angle);
    return (asj_edge){(uint32_t)i, (uint32_t)j, (uint16_t)b, (uint16_t)c,
                      (float)(between(g, &from->branches[b], &to->branches[c], distance) / ASJ_LN_10), {0, 0}};
}

size_t asj_edges_join(const asj_edge_search *search, asj_edge *edges)
{
    asj_hypothesis *hypotheses = search->hypotheses;
    const size_t count = search->count;
    graph g = start(search);
    size_t found = 0;
    for (int32_t pass = 0; pass < 2; pass++) {
        find_all(&g, count, pass == 0);
        if (asj_watch_end(search->watch) != ASJ_OK)
            return 0;
        join_nearest(&g, count);
    }
    for (size_t i = 0; i < count; i++)
        for (int32_t b = 0; b < hypotheses[i].branch_count; b++) {
            const int32_t own = (int32_t)(i * ASJ_MAX_BRANCHES) + b, other = g.joined[own];
            if (other < own)
                continue;
            edges[found] = edge_of(&g, own, other);
            mark_end(&hypotheses[i], b, &hypotheses[edges[found].junction_b]);
            mark_end(&hypotheses[edges[found].junction_b], edges[found].branch_b, &hypotheses[i]);
            found++;
        }
    return found;
}
