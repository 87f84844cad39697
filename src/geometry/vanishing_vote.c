/* SPDX-License-Identifier: BSD-2-Clause */
/* Vanishing points by an a-contrario vote.
 *
 * A branch votes for a point v (homogeneous) when the direction from its middle m to v differs from its own by no more than a
 * tolerance TAU: with its line l (unit normal), sin = (l' v) / |v_xy - v_w m|. Background: directions are independent and uniform,
 * so a vote has the chance p = 2 TAU / pi, and the expected number of points with k votes of n, of those that two branches define,
 * is
 *
 *     NFA = tests B(n - 2, k - 2, p),     tests = n (n - 1) / 2 for each TAU,
 *
 * B the binomial tail (Almansa, Desolneux and Vamech, "Vanishing point detection without any a priori information", PAMI 2003, with
 * points in place of regions of the plane). Only branches take part that are known better than TAU; those of one line, which
 * would vote with one voice, count once: the longest stays.
 *
 * Points are defined by pairs of the LONGEST longest branches, the surest is refined (least squares of the sines), its voters
 * leave, and so on. Coordinates: K^-1 of pixels where the camera is known, else pixels from the middle over half the longer
 * side. */
#include "vanishing_vote.h"
#include "core/angle.h"
#include "core/context.h"
#include "core/sort.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define LEAST_LENGTH 10.0            /* px */
#define ACROSS 0.4                   /* px that the end of a branch is out, across, when its uncertainty is not known */
#define LONGEST 60
#define SAME_LINE 2.0                /* px, and .. */
#define SAME_ANGLE (1.5 * ASJ_DEGREE) /* .. branches nearer than that are on one line */
#define ROUNDS 4
#define AT_ONCE 1024                 /* lines, before the caller may be asked whether to go on */

static const double tau[ASJ_VOTE_LEVELS] = {0.5 * ASJ_DEGREE, 1.0 * ASJ_DEGREE, 2.0 * ASJ_DEGREE};

/* --- lines ------------------------------------------------------------------------------------------------------------------- */

/* The longest last; of equals the first. */
static int by_length(const void *left, const void *right)
{
    const asj_vote_line *p = left, *q = right;
    if (p->length != q->length)
        return p->length < q->length ? -1 : 1;
    return p->source > q->source ? -1 : p->source < q->source;
}

static double apart(double a, double b)
{
    const double d = fabs(a - b);
    return fmin(d, ASJ_PI - d);
}

/* On the line of a longer one? */
static int32_t is_known(const asj_vote_line *lines, int32_t count, const asj_vote_line *one)
{
    for (int32_t k = 0; k < count; k++) {
        const asj_vote_line *o = &lines[k];
        const double nx = -sin(o->angle), ny = cos(o->angle), same = SAME_LINE * fmax(o->pixel, one->pixel);
        if (apart(o->angle, one->angle) < SAME_ANGLE && fabs(nx * (one->x - o->x) + ny * (one->y - o->y)) < same &&
            fabs(nx * (one->ex - o->x) + ny * (one->ey - o->y)) < same)
            return 1;
    }
    return 0;
}

/* The line in coordinates (x - cx) / fx, (y - cy) / fy. */
static void place(asj_vote_line *one, const asj_camera *k)
{
    const double x = (one->x - k->cx) / k->fx, y = (one->y - k->cy) / k->fy;
    const double ex = (one->ex - k->cx) / k->fx, ey = (one->ey - k->cy) / k->fy, size = hypot(ex - x, ey - y);
    one->l[0] = (y - ey) / size;
    one->l[1] = (ex - x) / size;
    one->l[2] = -(one->l[0] * x + one->l[1] * y);
    one->mx = 0.5 * (x + ex);
    one->my = 0.5 * (y + ey);
}

static int stops(asj_watch *watch)
{
    return watch && asj_watch_stops(watch, NULL);
}

static void swap(asj_vote_line *a, asj_vote_line *b)
{
    const asj_vote_line kept = *a;
    *a = *b;
    *b = kept;
}

/* Leaves the longest one of each line, the longest first. Returns how many. `watch` may be NULL. From a heap, since of very
 * many only the first few hundred are looked at; what is kept stands behind it, the last one first. */
static int32_t keep(asj_vote_line *lines, size_t all, const asj_camera *camera, asj_watch *watch)
{
    size_t kept = 0;
    for (size_t at = all / 2; at-- > 0 && (at % AT_ONCE != 0 || !stops(watch));)
        asj_heap_sink(lines, at, all, sizeof *lines, by_length);
    for (size_t left = all; left > 0 && kept < ASJ_VOTE_LINES && !stops(watch); left--) {
        const asj_vote_line longest = lines[0];
        lines[0] = lines[left - 1];
        asj_heap_sink(lines, 0, left - 1, sizeof *lines, by_length);
        if (!is_known(&lines[all - kept], (int32_t)kept, &longest)) {
            lines[all - ++kept] = longest;
            place(&lines[all - kept], camera);
        }
    }
    for (size_t k = 0; k < kept && k < all / 2; k++)
        swap(&lines[k], &lines[all - 1 - k]);
    return (int32_t)kept;
}

/* All branches that are known well, the longest of each line. Returns how many. */
int32_t asj_vanishing_lines(const asj_junction *junctions, size_t count, const asj_camera *camera, asj_watch *watch,
                            asj_vote_line *lines)
{
    size_t all = 0;
    for (size_t i = 0; i < count && !asj_watch_stops(watch, NULL); i++)
        for (int32_t b = 0; b < junctions[i].branch_count; b++) {
            const asj_branch *branch = &junctions[i].branches[b];
            const double a = (double)branch->angle, length = (double)branch->length;
            const double sd = branch->angle_sd > 0 ? (double)branch->angle_sd : ACROSS / fmax(length, 1);
            if (!(length >= LEAST_LENGTH) || !(sd <= tau[ASJ_VOTE_LEVELS - 1]))
                continue;
            asj_vote_line *one = &lines[all];
            memset(one, 0, sizeof *one);
            one->x = (double)junctions[i].x;
            one->y = (double)junctions[i].y;
            one->ex = one->x + length * cos(a);
            one->ey = one->y + length * sin(a);
            one->angle = fmod(a, ASJ_PI);
            one->angle += one->angle < 0 ? ASJ_PI : 0;
            one->length = length;
            one->pixel = 1;
            one->sd = fmax(sd, 0.1 * ASJ_DEGREE);
            one->source = (uint32_t)all++;
        }
    return keep(lines, all, camera, watch);
}

int32_t asj_vote_lines(const asj_straight_edge *edges, size_t count, double shortest, const asj_camera *camera,
                       asj_vote_line *lines)
{
    size_t all = 0;
    for (size_t i = 0; i < count; i++) {
        const asj_straight_edge *e = &edges[i];
        const double length = hypot(e->x2 - e->x1, e->y2 - e->y1), angle = atan2(e->y2 - e->y1, e->x2 - e->x1);
        if (!(length >= shortest) || !(length > 0))
            continue;
        asj_vote_line *one = &lines[all];
        memset(one, 0, sizeof *one);
        one->x = e->x1;
        one->y = e->y1;
        one->ex = e->x2;
        one->ey = e->y2;
        one->angle = angle < 0 ? angle + ASJ_PI : angle;
        one->length = length;
        one->pixel = e->pixel;
        one->sd = ACROSS * e->pixel / length;
        one->source = (uint32_t)all++;
    }
    return keep(lines, all, camera, NULL);
}

/* --- the vote ---------------------------------------------------------------------------------------------------------------- */

static double sine(const asj_vote_line *one, const double v[3])
{
    const double dx = v[0] - v[2] * one->mx, dy = v[1] - v[2] * one->my, size2 = dx * dx + dy * dy;
    return size2 > 0 ? fabs(asj_dot3(one->l, v)) / sqrt(size2) : 1;
}

int32_t asj_line_votes_for(const asj_vote_line *one, const double v[3], int32_t level)
{
    return !one->taken && one->sd <= tau[level] && sine(one, v) <= sin(tau[level]);
}

/* Natural logarithm of sum over i >= k of C(n, i) p^i (1 - p)^(n - i), for all k, from the last term on. */
static void tails(int32_t n, double p, double *tail)
{
    double sum = -HUGE_VAL, term = n * log(p);
    for (int32_t k = n; k >= 0; k--) {
        const double high = fmax(sum, term), low = fmin(sum, term);
        sum = high + log(1 + exp(low - high));
        tail[k] = fmin(sum, 0);
        term += log(k) - log(n - k + 1.0) + log(1 - p) - log(p); /* the one before; after k = 0 none */
    }
}

static double log_nfa(const asj_vote_search *s, int32_t level, int32_t votes)
{
    const double n = s->members[level];
    return votes < 3 ? HUGE_VAL : log(ASJ_VOTE_LEVELS * n * (n - 1) / 2) + s->tail[level * (ASJ_VOTE_LINES + 1) + votes - 2];
}

static void count_members(asj_vote_search *s)
{
    for (int32_t level = 0; level < ASJ_VOTE_LEVELS; level++) {
        s->members[level] = 0;
        for (int32_t k = 0; k < s->count; k++)
            s->members[level] += !s->lines[k].taken && s->lines[k].sd <= tau[level];
        if (s->members[level] >= 2)
            tails(s->members[level] - 2, 2 * tau[level] / ASJ_PI, s->tail + level * (ASJ_VOTE_LINES + 1));
    }
}

/* Votes for the point at all levels; the surest. Most lines are far from the point, and their sine need not be known: its square is
 * above that of the largest tolerance by more than rounding makes of it. */
asj_vote asj_judge_point(const asj_vote_search *s, const double v[3])
{
    const double widest = sin(tau[ASJ_VOTE_LEVELS - 1]), far2 = 1.000001 * widest * widest;
    asj_vote best = {{v[0], v[1], v[2]}, HUGE_VAL, 0, 0};
    int32_t votes[ASJ_VOTE_LEVELS] = {0};
    for (int32_t k = 0; k < s->count; k++) {
        const asj_vote_line *one = &s->lines[k];
        const double dx = v[0] - v[2] * one->mx, dy = v[1] - v[2] * one->my, at = asj_dot3(one->l, v);
        if (at * at > far2 * (dx * dx + dy * dy) || one->taken)
            continue;
        const double sin_of = sine(one, v);
        for (int32_t level = 0; level < ASJ_VOTE_LEVELS; level++)
            votes[level] += one->sd <= tau[level] && sin_of <= sin(tau[level]);
    }
    for (int32_t level = 0; level < ASJ_VOTE_LEVELS; level++) {
        const double nfa = log_nfa(s, level, votes[level]);
        if (nfa < best.log_nfa) {
            best.log_nfa = nfa;
            best.votes = votes[level];
            best.level = level;
        }
    }
    return best;
}

/* The point that its voters want: the least eigenvector of sum of l l' / (|d| sd)^2. */
static asj_vote refine(const asj_vote_search *s, asj_vote at)
{
    for (int32_t round = 0; round < ROUNDS; round++) {
        double sum[9] = {0}, values[3], vectors[9];
        for (int32_t k = 0; k < s->count; k++) {
            const asj_vote_line *one = &s->lines[k];
            if (!asj_line_votes_for(one, at.v, at.level))
                continue;
            const double dx = at.v[0] - at.v[2] * one->mx, dy = at.v[1] - at.v[2] * one->my;
            const double weight = 1 / ((dx * dx + dy * dy) * one->sd * one->sd);
            for (int32_t i = 0; i < 9; i++)
                sum[i] += weight * one->l[i / 3] * one->l[i % 3];
        }
        asj_symmetric_eigen(sum, 3, values, vectors);
        const double v[3] = {vectors[0], vectors[3], vectors[6]};
        const asj_vote next = asj_judge_point(s, v);
        if (!(next.log_nfa < at.log_nfa))
            break;
        at = next;
    }
    return at;
}

static int32_t find_best(asj_vote_search *s, asj_vote *best)
{
    int32_t index[LONGEST], count = 0;
    best->log_nfa = HUGE_VAL;
    for (int32_t k = 0; k < s->count && count < LONGEST; k++)
        if (!s->lines[k].taken)
            index[count++] = k;
    for (int32_t i = 0; i < count && !stops(s->watch); i++)
        for (int32_t k = 0; k < i; k++) {
            double v[3];
            asj_cross3(s->lines[index[i]].l, s->lines[index[k]].l, v);
            if (!asj_normalise3(v))
                continue;
            const asj_vote next = asj_judge_point(s, v);
            if (next.log_nfa < best->log_nfa)
                *best = next;
        }
    if (!(best->log_nfa < HUGE_VAL))
        return 0;
    *best = refine(s, *best);
    return 1;
}

/* Up to ASJ_VOTE_POINTS points, each without the voters of those before. All lines are free again then. */
int32_t asj_vote_points(asj_vote_search *s, double most, asj_vote *points)
{
    int32_t found = 0;
    while (found < ASJ_VOTE_POINTS && !stops(s->watch)) {
        count_members(s);
        if (!find_best(s, &points[found]) || !(points[found].log_nfa <= most))
            break;
        for (int32_t k = 0; k < s->count; k++)
            if (asj_line_votes_for(&s->lines[k], points[found].v, ASJ_VOTE_LEVELS - 1))
                s->lines[k].taken = 1;
        found++;
    }
    for (int32_t k = 0; k < s->count; k++)
        s->lines[k].taken = 0;
    count_members(s);
    return found;
}
