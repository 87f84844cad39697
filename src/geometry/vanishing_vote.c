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

double asj_vote_chance(int32_t level)
{
    return 2 * tau[level] / ASJ_PI;
}

/* From the last term on. */
void asj_binomial_tails(int32_t n, double p, double *tail)
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
            asj_binomial_tails(s->members[level] - 2, asj_vote_chance(level), s->tail + level * (ASJ_VOTE_LINES + 1));
    }
}

/* Most lines are far from a point, and their sine need not be known: its square is above that of the largest tolerance by more than
 * rounding makes of it. */
static double least_sine(const asj_vote_line *one, double points[][3], int32_t count)
{
    const double widest = sin(tau[ASJ_VOTE_LEVELS - 1]), far2 = 1.000001 * widest * widest;
    double least = 1;
    for (int32_t n = 0; n < count; n++) {
        const double *v = points[n];
        const double dx = v[0] - v[2] * one->mx, dy = v[1] - v[2] * one->my, at = asj_dot3(one->l, v);
        if (!(at * at > far2 * (dx * dx + dy * dy)))
            least = fmin(least, sine(one, v));
    }
    return least;
}

void asj_count_votes(const asj_vote_search *s, double points[][3], int32_t count, int32_t votes[ASJ_VOTE_LEVELS])
{
    double sines[ASJ_VOTE_LEVELS];
    for (int32_t level = 0; level < ASJ_VOTE_LEVELS; level++) {
        votes[level] = 0;
        sines[level] = sin(tau[level]);
    }
    for (int32_t k = 0; k < s->count; k++) {
        const asj_vote_line *one = &s->lines[k];
        const double least = one->taken ? 1 : least_sine(one, points, count);
        for (int32_t level = 0; level < ASJ_VOTE_LEVELS && least < 1; level++)
            votes[level] += one->sd <= tau[level] && least <= sines[level];
    }
}

/* The votes that the point has, at the level where they are least likely by chance. */
static asj_vote judge_point(const asj_vote_search *s, const double v[3])
{
    asj_vote best = {{v[0], v[1], v[2]}, HUGE_VAL, 0, 0};
    double points[1][3] = {{v[0], v[1], v[2]}};
    int32_t votes[ASJ_VOTE_LEVELS];
    asj_count_votes(s, points, 1, votes);
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
        const asj_vote next = judge_point(s, v);
        if (!(next.log_nfa < at.log_nfa))
            break;
        at = next;
    }
    return at;
}

/* The longest lines that are free. */
static int32_t find_longest(const asj_vote_search *s, int32_t index[ASJ_VOTE_LONGEST])
{
    int32_t count = 0;
    for (int32_t k = 0; k < s->count && count < ASJ_VOTE_LONGEST; k++)
        if (!s->lines[k].taken)
            index[count++] = k;
    return count;
}

/* The votes for where two lines meet; log_nfa HUGE_VAL where they are one. */
static asj_vote judge_pair(const asj_vote_search *s, int32_t i, int32_t k)
{
    asj_vote none = {{0, 0, 0}, HUGE_VAL, 0, 0};
    asj_cross3(s->lines[i].l, s->lines[k].l, none.v);
    return asj_normalise3(none.v) ? judge_point(s, none.v) : none;
}

static int32_t find_best(asj_vote_search *s, asj_vote *best)
{
    int32_t index[ASJ_VOTE_LONGEST];
    const int32_t count = find_longest(s, index);
    best->log_nfa = HUGE_VAL;
    for (int32_t i = 0; i < count && !stops(s->watch); i++)
        for (int32_t k = 0; k < i; k++) {
            const asj_vote next = judge_pair(s, index[i], index[k]);
            if (next.log_nfa < best->log_nfa)
                *best = next;
        }
    if (!(best->log_nfa < HUGE_VAL))
        return 0;
    *best = refine(s, *best);
    return 1;
}

int32_t asj_vote_pairs(asj_vote_search *s, asj_vote *points)
{
    int32_t index[ASJ_VOTE_LONGEST], found = 0;
    const int32_t count = find_longest(s, index);
    count_members(s);
    for (int32_t i = 0; i < count && !stops(s->watch); i++)
        for (int32_t k = 0; k < i; k++) {
            points[found] = judge_pair(s, index[i], index[k]);
            found += points[found].log_nfa < HUGE_VAL;
        }
    return found;
}

static int by_nfa(const void *left, const void *right)
{
    const asj_vote *p = left, *q = right;
    return (p->log_nfa > q->log_nfa) - (p->log_nfa < q->log_nfa);
}

void asj_vote_sort(asj_vote *points, int32_t count)
{
    asj_sort(points, (size_t)count, sizeof *points, by_nfa);
}

void asj_direction_of(const double v[3], double focal, double direction[3])
{
    direction[0] = v[0];
    direction[1] = v[1];
    direction[2] = v[2] * focal;
    asj_normalise3(direction);
}

int32_t asj_vote_distinct(asj_vote *points, int32_t count, double focal, double apart_by, int32_t most)
{
    int32_t kept = 0;
    asj_vote_sort(points, count);
    for (int32_t k = 0; k < count && kept < most; k++) {
        double d[3], e[3], nearest = 0;
        asj_direction_of(points[k].v, focal, d);
        for (int32_t i = 0; i < kept; i++) {
            asj_direction_of(points[i].v, focal, e);
            nearest = fmax(nearest, fabs(asj_dot3(d, e)));
        }
        if (nearest <= cos(apart_by))
            points[kept++] = points[k];
    }
    return kept;
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
