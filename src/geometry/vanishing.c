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
 * leave, and so on. Coordinates: K^-1 of pixels where the camera is known, else pixels from the middle over half the longer side.
 *
 * Directions at right angles: with a focal length, the set of two or three points at right angles (within SQUARE) with the
 * largest sum of -log NFA, turned together to fit their branches. Without one, two finite points of directions at right angles give
 * f^2 = -(v1 - c)'(v2 - c) (Caprile and Torre 1990): the pair and focal length are taken that have the largest sum, with the vote
 * for the third direction that they define. */
#include <asj/vanishing.h>

#include "core/angle.h"
#include "core/context.h"
#include "small_matrix.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define LEAST_LENGTH 10.0            /* px */
#define ACROSS 0.4                   /* px that the end of a branch is out, across, when its uncertainty is not known */
#define MOST_LINES 300
#define LONGEST 60
#define SAME_LINE 2.0                /* px, and .. */
#define SAME_ANGLE (1.5 * ASJ_DEGREE) /* .. branches nearer than that are on one line */
#define TAUS 3
#define FOUND 6                      /* points looked at before right angles */
#define SQUARE (4 * ASJ_DEGREE)
#define ROUNDS 4
#define SHORTEST_FOCAL 0.6           /* of the longer side, and .. */
#define LONGEST_FOCAL 4.0
#define DIRECTION_SD (0.3 * ASJ_DEGREE)
#define FOCAL_SD 0.05                /* relative: a focal length known worse than this is none */

static const double tau[TAUS] = {0.5 * ASJ_DEGREE, 1.0 * ASJ_DEGREE, 2.0 * ASJ_DEGREE};

typedef struct line {
    double l[3];      /* unit normal and distance, in the coordinates of the vote */
    double mx, my;    /* middle */
    double sd;        /* rad */
    double length;    /* px */
    double angle;     /* px coordinates, [0, pi) */
    double x, y, ex, ey; /* px: both ends */
    uint32_t source;
    int32_t taken;
} line;

typedef struct vote {
    double v[3];
    double log_nfa;
    int32_t votes, level; /* index of tau */
} vote;

typedef struct search {
    line *lines;
    int32_t count;
    double *tail;     /* log binomial tails of the level at hand, by k */
    int32_t members[TAUS];
} search;

void asj_vanishing_options_init(asj_vanishing_options *options)
{
    if (!options)
        return;
    memset(options, 0, sizeof *options);
    options->epsilon = 0.01;
}

/* --- lines ------------------------------------------------------------------------------------------------------------------- */

static int longer(const void *left, const void *right)
{
    const line *p = left, *q = right;
    if (p->length != q->length)
        return p->length > q->length ? -1 : 1;
    return p->source < q->source ? -1 : p->source > q->source;
}

static double apart(double a, double b)
{
    const double d = fabs(a - b);
    return fmin(d, ASJ_PI - d);
}

/* On the line of a longer one? */
static int32_t is_known(const line *lines, int32_t count, const line *one)
{
    for (int32_t k = 0; k < count; k++) {
        const line *o = &lines[k];
        const double nx = -sin(o->angle), ny = cos(o->angle);
        if (apart(o->angle, one->angle) < SAME_ANGLE && fabs(nx * (one->x - o->x) + ny * (one->y - o->y)) < SAME_LINE &&
            fabs(nx * (one->ex - o->x) + ny * (one->ey - o->y)) < SAME_LINE)
            return 1;
    }
    return 0;
}

/* The line in coordinates (x - cx) / fx, (y - cy) / fy. */
static void place(line *one, const asj_camera *k)
{
    const double x = (one->x - k->cx) / k->fx, y = (one->y - k->cy) / k->fy;
    const double ex = (one->ex - k->cx) / k->fx, ey = (one->ey - k->cy) / k->fy, size = hypot(ex - x, ey - y);
    one->l[0] = (y - ey) / size;
    one->l[1] = (ex - x) / size;
    one->l[2] = -(one->l[0] * x + one->l[1] * y);
    one->mx = 0.5 * (x + ex);
    one->my = 0.5 * (y + ey);
}

/* All branches that are known well, the longest of each line. Returns how many. */
static int32_t collect(const asj_junction *junctions, size_t count, const asj_camera *camera, line *lines)
{
    size_t all = 0;
    int32_t kept = 0;
    for (size_t i = 0; i < count; i++)
        for (int32_t b = 0; b < junctions[i].branch_count; b++) {
            const asj_branch *branch = &junctions[i].branches[b];
            const double a = (double)branch->angle, length = (double)branch->length;
            const double sd = branch->angle_sd > 0 ? (double)branch->angle_sd : ACROSS / fmax(length, 1);
            if (!(length >= LEAST_LENGTH) || !(sd <= tau[TAUS - 1]))
                continue;
            line *one = &lines[all];
            memset(one, 0, sizeof *one);
            one->x = (double)junctions[i].x;
            one->y = (double)junctions[i].y;
            one->ex = one->x + length * cos(a);
            one->ey = one->y + length * sin(a);
            one->angle = fmod(a, ASJ_PI);
            one->length = length;
            one->sd = fmax(sd, 0.1 * ASJ_DEGREE);
            one->source = (uint32_t)all++;
        }
    if (all > 1)
        qsort(lines, all, sizeof *lines, longer);
    for (size_t i = 0; i < all && kept < MOST_LINES; i++)
        if (!is_known(lines, kept, &lines[i])) {
            lines[kept] = lines[i];
            place(&lines[kept++], camera);
        }
    return kept;
}

/* --- the vote ---------------------------------------------------------------------------------------------------------------- */

static double sine(const line *one, const double v[3])
{
    const double dx = v[0] - v[2] * one->mx, dy = v[1] - v[2] * one->my, size2 = dx * dx + dy * dy;
    return size2 > 0 ? fabs(asj_dot3(one->l, v)) / sqrt(size2) : 1;
}

static int32_t votes_for(const line *one, const double v[3], int32_t level)
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

static double log_nfa(const search *s, int32_t level, int32_t votes)
{
    const double n = s->members[level];
    return votes < 3 ? HUGE_VAL : log(TAUS * n * (n - 1) / 2) + s->tail[level * (MOST_LINES + 1) + votes - 2];
}

static void count_members(search *s)
{
    for (int32_t level = 0; level < TAUS; level++) {
        s->members[level] = 0;
        for (int32_t k = 0; k < s->count; k++)
            s->members[level] += !s->lines[k].taken && s->lines[k].sd <= tau[level];
        if (s->members[level] >= 2)
            tails(s->members[level] - 2, 2 * tau[level] / ASJ_PI, s->tail + level * (MOST_LINES + 1));
    }
}

/* Votes for the point at all levels; the surest. */
static vote judge(const search *s, const double v[3])
{
    vote best = {{v[0], v[1], v[2]}, HUGE_VAL, 0, 0};
    int32_t votes[TAUS] = {0};
    for (int32_t k = 0; k < s->count; k++) {
        const line *one = &s->lines[k];
        const double sin_of = one->taken ? 1 : sine(one, v);
        for (int32_t level = 0; level < TAUS; level++)
            votes[level] += !one->taken && one->sd <= tau[level] && sin_of <= sin(tau[level]);
    }
    for (int32_t level = 0; level < TAUS; level++) {
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
static vote refine(const search *s, vote at)
{
    for (int32_t round = 0; round < ROUNDS; round++) {
        double sum[9] = {0}, values[3], vectors[9];
        for (int32_t k = 0; k < s->count; k++) {
            const line *one = &s->lines[k];
            if (!votes_for(one, at.v, at.level))
                continue;
            const double dx = at.v[0] - at.v[2] * one->mx, dy = at.v[1] - at.v[2] * one->my;
            const double weight = 1 / ((dx * dx + dy * dy) * one->sd * one->sd);
            for (int32_t i = 0; i < 9; i++)
                sum[i] += weight * one->l[i / 3] * one->l[i % 3];
        }
        asj_symmetric_eigen(sum, 3, values, vectors);
        const double v[3] = {vectors[0], vectors[3], vectors[6]};
        const vote next = judge(s, v);
        if (!(next.log_nfa < at.log_nfa))
            break;
        at = next;
    }
    return at;
}

static int32_t find_best(search *s, vote *best)
{
    int32_t index[LONGEST], count = 0;
    best->log_nfa = HUGE_VAL;
    for (int32_t k = 0; k < s->count && count < LONGEST; k++)
        if (!s->lines[k].taken)
            index[count++] = k;
    for (int32_t i = 0; i < count; i++)
        for (int32_t k = 0; k < i; k++) {
            double v[3];
            asj_cross3(s->lines[index[i]].l, s->lines[index[k]].l, v);
            if (!asj_normalise3(v))
                continue;
            const vote next = judge(s, v);
            if (next.log_nfa < best->log_nfa)
                *best = next;
        }
    if (!(best->log_nfa < HUGE_VAL))
        return 0;
    *best = refine(s, *best);
    return 1;
}

/* Up to FOUND points, each without the voters of those before. All lines are free again then. */
static int32_t find_points(search *s, double most, vote *points)
{
    int32_t found = 0;
    while (found < FOUND) {
        count_members(s);
        if (!find_best(s, &points[found]) || !(points[found].log_nfa <= most))
            break;
        for (int32_t k = 0; k < s->count; k++)
            if (votes_for(&s->lines[k], points[found].v, TAUS - 1))
                s->lines[k].taken = 1;
        found++;
    }
    for (int32_t k = 0; k < s->count; k++)
        s->lines[k].taken = 0;
    count_members(s);
    return found;
}

/* --- right angles ------------------------------------------------------------------------------------------------------------ */

/* Direction of a point when the coordinates of the vote are rays times `focal`. */
static void direction_of(const double v[3], double focal, double d[3])
{
    d[0] = v[0];
    d[1] = v[1];
    d[2] = v[2] * focal;
    asj_normalise3(d);
}

static void point_of(const double d[3], double focal, double v[3])
{
    v[0] = d[0];
    v[1] = d[1];
    v[2] = d[2] / focal;
    asj_normalise3(v);
}

/* Relative standard deviation of a focal length from two directions that are known to DIRECTION_SD. With tan t = r / f for each, r
 * the distance of its point from the principal point, and `a` the angle between both points seen from there,
 * f^2 = -r1 r2 cos a, so dlog f = (dt1 / (sin t1 cos t1) + dt2 / (sin t2 cos t2) - tan a da) / 2, da = dt / sin t. */
static double focal_error(const double p[3], const double q[3], double focal)
{
    const double r1 = hypot(p[0], p[1]) / fabs(p[2]), r2 = hypot(q[0], q[1]) / fabs(q[2]);
    const double s1 = r1 / hypot(r1, focal), s2 = r2 / hypot(r2, focal);
    const double c1 = focal / hypot(r1, focal), c2 = focal / hypot(r2, focal);
    const double cosine = (p[0] * q[0] + p[1] * q[1]) / (p[2] * q[2] * r1 * r2), tangent2 = 1 / (cosine * cosine) - 1;
    const double sum = 1 / (s1 * s1 * c1 * c1) + 1 / (s2 * s2 * c2 * c2) + tangent2 * (1 / (s1 * s1) + 1 / (s2 * s2));
    return 0.5 * DIRECTION_SD * sqrt(sum);
}

typedef struct frame {
    double axes[3][3];  /* directions; rows */
    vote points[3];
    double log_nfa;     /* sum of those that are sure */
    double focal;
    int32_t count;      /* of points that are sure; they come first */
} frame;

/* Turns the axes to their branches: one Gauss-Newton step over w, axes <- exp([w]x) axes, where a branch's sine moves by
 * (l x w)'d. */
static void turn_frame(const search *s, double focal, double axes[3][3])
{
    double normal[9] = {0}, right[3] = {0}, turn[9];
    for (int32_t a = 0; a < 3; a++) {
        double v[3];
        point_of(axes[a], focal, v);
        for (int32_t k = 0; k < s->count; k++) {
            const line *one = &s->lines[k];
            if (!votes_for(one, v, TAUS - 1))
                continue;
            /* l in ray coordinates: l'v = g'd with g = (l0, l1, l2 / focal), over the distance |v - m| */
            const double g[3] = {one->l[0], one->l[1], one->l[2] / focal}, *d = axes[a];
            const double dx = d[0] - d[2] / focal * one->mx, dy = d[1] - d[2] / focal * one->my, size = hypot(dx, dy);
            double slope[3];
            asj_cross3(d, g, slope); /* d/dw of g'(w x d) = w'(d x g) */
            const double weight = 1 / (size * size * one->sd * one->sd), at = asj_dot3(g, d);
            for (int32_t i = 0; i < 3; i++) {
                right[i] -= weight * slope[i] * at;
                for (int32_t j = 0; j < 3; j++)
                    normal[3 * i + j] += weight * slope[i] * slope[j];
            }
        }
    }
    for (int32_t i = 0; i < 3; i++)
        normal[4 * i] += 1;
    if (!asj_cholesky_solve(normal, 3, right, NULL))
        return;
    asj_rotation_of(right, turn);
    for (int32_t a = 0; a < 3; a++)
        asj_apply3(turn, axes[a], axes[a]);
}

static int by_nfa(const void *left, const void *right)
{
    const vote *p = left, *q = right;
    return (p->log_nfa > q->log_nfa) - (p->log_nfa < q->log_nfa);
}

/* The frame of two directions nearly at right angles, turned to fit. */
static frame frame_of(const search *s, const double first[3], const double second[3], double focal, double most)
{
    frame f;
    memset(&f, 0, sizeof f);
    f.focal = focal;
    memcpy(f.axes[0], first, sizeof f.axes[0]);
    asj_cross3(first, second, f.axes[2]);
    asj_normalise3(f.axes[2]);
    asj_cross3(f.axes[2], first, f.axes[1]);
    for (int32_t round = 0; round < ROUNDS; round++)
        turn_frame(s, focal, f.axes);
    for (int32_t a = 0; a < 3; a++) {
        double v[3];
        point_of(f.axes[a], focal, v);
        f.points[a] = judge(s, v);
    }
    qsort(f.points, 3, sizeof f.points[0], by_nfa);
    for (int32_t a = 0; a < 3; a++) {
        direction_of(f.points[a].v, focal, f.axes[a]);
        f.count += f.points[a].log_nfa <= most;
        f.log_nfa += fmin(0, f.points[a].log_nfa);
    }
    return f;
}

/* The best frame of two of the points; focal 0: found from the pair. count 0 when there is none. */
static frame best_frame(const search *s, const vote *points, int32_t found, double focal, double most)
{
    frame best;
    memset(&best, 0, sizeof best);
    for (int32_t i = 0; i < found; i++)
        for (int32_t k = 0; k < i; k++) {
            const double *p = points[k].v, *q = points[i].v;
            double f = focal, d[3], e[3];
            if (!(f > 0)) {
                const double w2 = p[2] * q[2], f2 = w2 != 0 ? -(p[0] * q[0] + p[1] * q[1]) / w2 : 0;
                f = f2 > 0 ? sqrt(f2) : 0;
                if (f < 2 * SHORTEST_FOCAL || f > 2 * LONGEST_FOCAL || focal_error(p, q, f) > FOCAL_SD)
                    continue; /* unit: half the longer side */
            }
            direction_of(p, f, d);
            direction_of(q, f, e);
            if (fabs(asj_dot3(d, e)) > sin(SQUARE))
                continue;
            const frame next = frame_of(s, d, e, f, most);
            if (next.count >= 2 && next.log_nfa < best.log_nfa)
                best = next;
        }
    return best;
}

/* --- answer ------------------------------------------------------------------------------------------------------------------ */

static void fill(const vote *at, const double direction[3], const asj_camera *vote_camera, asj_vanishing_point *out)
{
    out->point[0] = vote_camera->fx * at->v[0] + vote_camera->cx * at->v[2];
    out->point[1] = vote_camera->fy * at->v[1] + vote_camera->cy * at->v[2];
    out->point[2] = at->v[2];
    asj_normalise3(out->point);
    if (direction)
        memcpy(out->direction, direction, sizeof out->direction);
    out->log10_nfa = at->log_nfa / log(10);
    out->branch_count = (uint32_t)at->votes;
}

static void answer(search *s, const asj_vanishing_options *options, const asj_camera *camera, asj_vanishing_points *result)
{
    vote points[FOUND];
    const int32_t given = options->camera.fx > 0;
    const double most = log(options->epsilon);
    const int32_t found = find_points(s, most, points);
    const frame f = best_frame(s, points, found, given ? 1 : 0, most);
    result->focal_source = given ? ASJ_FOCAL_GIVEN : f.count >= 2 ? ASJ_FOCAL_FOUND : ASJ_FOCAL_UNKNOWN;
    if (given)
        result->camera = options->camera;
    else if (f.count >= 2)
        result->camera = (asj_camera){f.focal * camera->fx, f.focal * camera->fy, camera->cx, camera->cy};
    if (f.count >= 2) {
        result->count = f.count;
        for (int32_t a = 0; a < f.count; a++)
            fill(&f.points[a], f.axes[a], camera, &result->points[a]);
        return;
    }
    /* no two at right angles: with a focal length the surest alone, without one the surest three */
    result->count = given ? (found > 0) : found < ASJ_MOST_VANISHING ? found : ASJ_MOST_VANISHING;
    for (int32_t k = 0; k < result->count; k++) {
        double d[3];
        direction_of(points[k].v, 1, d);
        fill(&points[k], given ? d : NULL, camera, &result->points[k]);
    }
}

static asj_status check(asj_context *context, const asj_junction *junctions, size_t count, const asj_vanishing_options *o)
{
    const asj_camera *c = &o->camera;
    const int32_t none = c->fx == 0 && c->fy == 0;
    if (o->width < 1 || o->height < 1)
        return asj_fail(context, ASJ_ERROR_OPTION, "the image has no size");
    if (!(o->epsilon >= 1e-12 && o->epsilon <= 1))
        return asj_fail(context, ASJ_ERROR_OPTION, "epsilon %g is not 1e-12 .. 1", o->epsilon);
    if (!(fabs(c->cx) <= 1e7 && fabs(c->cy) <= 1e7) || (!none && !(c->fx >= 1 && c->fx <= 1e7 && c->fy >= 1 && c->fy <= 1e7)))
        return asj_fail(context, ASJ_ERROR_OPTION, "the camera cannot be: fx %g, fy %g, cx %g, cy %g", c->fx, c->fy, c->cx, c->cy);
    for (size_t k = 0; k < count; k++) {
        const asj_junction *j = &junctions[k];
        double sum = (double)j->x + (double)j->y;
        if (j->branch_count < 0 || j->branch_count > ASJ_MAX_BRANCHES)
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu has %d branches", k, (int)j->branch_count);
        for (int32_t b = 0; b < j->branch_count; b++)
            sum += (double)j->branches[b].angle + (double)j->branches[b].length + (double)j->branches[b].angle_sd;
        if (!isfinite(sum))
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu is not finite", k);
    }
    return ASJ_OK;
}

asj_status asj_find_vanishing_points(asj_context *context, const asj_junction *junctions, size_t count,
                                     const asj_vanishing_options *options, asj_vanishing_points *result)
{
    if (!context)
        return ASJ_ERROR_ARGUMENT;
    if (!options || !result || (!junctions && count > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the junctions, the options or the result is NULL");
    asj_status status = check(context, junctions, count, options);
    if (status != ASJ_OK)
        return status;
    const double half = 0.5 * (options->width > options->height ? options->width : options->height);
    const asj_camera guess = {half, half, 0.5 * (options->width - 1), 0.5 * (options->height - 1)};
    const asj_camera *camera = options->camera.fx > 0 ? &options->camera : &guess;
    asj_memory *memory = &context->memory;
    asj_vanishing_points found;
    search s = {0};
    memset(&found, 0, sizeof found);
    s.lines = asj_allocate(memory, count, ASJ_MAX_BRANCHES * sizeof *s.lines);
    s.tail = asj_allocate(memory, TAUS * (MOST_LINES + 1), sizeof *s.tail);
    if (s.lines && s.tail) {
        s.count = collect(junctions, count, camera, s.lines);
        answer(&s, options, camera, &found);
        *result = found;
    } else {
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the branches of %zu junctions", count);
    }
    asj_release(memory, s.lines);
    asj_release(memory, s.tail);
    return status;
}
