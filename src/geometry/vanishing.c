/* SPDX-License-Identifier: BSD-2-Clause */
/* Vanishing points of directions at right angles. The points come from a vote (vanishing_vote.c); coordinates: K^-1 of pixels where
 * the camera is known, else pixels from the middle over half the longer side.
 *
 * Directions at right angles: with a focal length, the set of two or three points at right angles (within SQUARE) with the
 * largest sum of -log NFA, turned together to fit their branches. Without one, two finite points of directions at right angles give
 * f^2 = -(v1 - c)'(v2 - c) (Caprile and Torre 1990): the pair and focal length are taken that have the largest sum, with the vote
 * for the third direction that they define. */
#include "vanishing.h"
#include "geometry_options.h"
#include "vanishing_vote.h"

#include "core/angle.h"
#include "core/decade.h"
#include "core/most_junctions.h"
#include "core/number_text.h"
#include "core/reserved.h"
#include "core/sort.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define SQUARE (4 * ASJ_DEGREE)
#define ROUNDS 4
#define SHORTEST_FOCAL 0.6           /* of the longer side, and .. */
#define LONGEST_FOCAL 4.0
#define DIRECTION_SD (0.3 * ASJ_DEGREE)
#define FOCAL_SD 0.05                /* relative: a focal length known worse than this is none */
#define USUAL_FOCAL 2                /* where none is known: the longer side of the image, and .. */
#define SAME (8 * ASJ_DEGREE)        /* .. directions nearer than that are one, which lens or vote has split */

void asj_vanishing_options_init(asj_vanishing_options *options)
{
    if (!options)
        return;
    memset(options, 0, sizeof *options);
    options->epsilon = 0.01;
}

/* --- right angles ------------------------------------------------------------------------------------------------------------ */

/* Direction of a point when the coordinates of the asj_vote are rays times `focal`. */
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
    asj_vote points[3];
    double log_nfa;     /* sum of those that are sure */
    double focal;
    int32_t count;      /* of points that are sure; they come first */
} frame;

/* Turns the axes to their branches: one Gauss-Newton step over w, axes <- exp([w]x) axes, where a branch's sine moves by
 * (l x w)'d. */
static void turn_frame(const asj_vote_search *s, double focal, double axes[3][3])
{
    double normal[9] = {0}, right[3] = {0}, turn[9];
    for (int32_t a = 0; a < 3; a++) {
        double v[3];
        point_of(axes[a], focal, v);
        for (int32_t k = 0; k < s->count; k++) {
            const asj_vote_line *one = &s->lines[k];
            if (!asj_line_votes_for(one, v, ASJ_VOTE_LEVELS - 1))
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
    const asj_vote *p = left, *q = right;
    return (p->log_nfa > q->log_nfa) - (p->log_nfa < q->log_nfa);
}

/* The frame of two directions nearly at right angles, turned to fit. */
static frame frame_of(const asj_vote_search *s, const double first[3], const double second[3], double focal, double most)
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
        f.points[a] = asj_judge_point(s, v);
    }
    asj_sort(f.points, 3, sizeof f.points[0], by_nfa);
    for (int32_t a = 0; a < 3; a++) {
        direction_of(f.points[a].v, focal, f.axes[a]);
        f.count += f.points[a].log_nfa <= most;
        f.log_nfa += fmin(0, f.points[a].log_nfa);
    }
    return f;
}

/* The best frame of two of the points; focal 0: found from the pair. count 0 when there is none. */
static frame best_frame(const asj_vote_search *s, const asj_vote *points, int32_t found, double focal, double most)
{
    frame best;
    memset(&best, 0, sizeof best);
    for (int32_t i = 0; i < found && !asj_watch_stops(s->watch, NULL); i++)
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

static void fill(const asj_vote *at, const double direction[3], const asj_camera *vote_camera, asj_vanishing_point *out)
{
    out->point[0] = vote_camera->fx * at->v[0] + vote_camera->cx * at->v[2];
    out->point[1] = vote_camera->fy * at->v[1] + vote_camera->cy * at->v[2];
    out->point[2] = at->v[2];
    asj_normalise3(out->point);
    if (direction)
        memcpy(out->direction, direction, sizeof out->direction);
    out->log10_nfa = at->log_nfa / ASJ_LN_10;
    out->branch_count = (uint32_t)at->votes;
}

/* The surest first; of those that would be nearly one direction with a usual camera the surest stays. How many stay. */
static int32_t distinct(asj_vote *points, int32_t found)
{
    int32_t kept = 0;
    asj_sort(points, (size_t)found, sizeof *points, by_nfa);
    for (int32_t k = 0; k < found; k++) {
        double d[3], e[3], nearest = 0;
        direction_of(points[k].v, USUAL_FOCAL, d);
        for (int32_t i = 0; i < kept; i++) {
            direction_of(points[i].v, USUAL_FOCAL, e);
            nearest = fmax(nearest, fabs(asj_dot3(d, e)));
        }
        if (nearest <= cos(SAME))
            points[kept++] = points[k];
    }
    return kept;
}

static void answer(asj_vote_search *s, const asj_vanishing_options *options, const asj_camera *camera, asj_vanishing_points *result)
{
    asj_vote points[ASJ_VOTE_POINTS];
    const int32_t given = options->camera.fx > 0;
    const double most = log(options->epsilon);
    int32_t found = asj_vote_points(s, most, points);
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
    found = distinct(points, found);
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
    char fault[128];
    if (!asj_is_zero(o->reserved, sizeof o->reserved))
        return asj_fail(context, ASJ_ERROR_OPTION, ASJ_RESERVED_MESSAGE);
    if (o->width < 1 || o->height < 1)
        return asj_fail(context, ASJ_ERROR_OPTION, "the image has no size");
    if (!(o->epsilon >= 1e-12 && o->epsilon <= 1))
        return asj_fail(context, ASJ_ERROR_OPTION, "epsilon %s is not 1e-12 .. 1", ASJ_TEXT(o->epsilon));
    if (!asj_camera_can_be(c))
        return asj_fail(context, ASJ_ERROR_OPTION, "the camera cannot be: fx %s, fy %s, cx %s, cy %s", ASJ_TEXT(c->fx),
                        ASJ_TEXT(c->fy), ASJ_TEXT(c->cx), ASJ_TEXT(c->cy));
    if (count > ASJ_MOST_JUNCTIONS)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%zu junctions are too many", count);
    for (size_t k = 0; k < count; k++)
        if (asj_junction_check(&junctions[k], fault, sizeof fault) != ASJ_OK)
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu has %s", k, fault);
    return ASJ_OK;
}

asj_status asj_vanishing_points_of(asj_context *context, const asj_junction *junctions, size_t count,
                                   const asj_vanishing_options *options, int32_t stage, asj_vanishing_points *result)
{
    const double half = 0.5 * (options->width > options->height ? options->width : options->height);
    const asj_camera guess = {half, half, 0.5 * (options->width - 1), 0.5 * (options->height - 1)};
    const asj_camera *camera = options->camera.fx > 0 ? &options->camera : &guess;
    asj_memory *memory = &context->memory;
    asj_status status = ASJ_OK;
    asj_vanishing_points found;
    asj_watch watch;
    asj_vote_search s = {.watch = &watch};
    memset(&found, 0, sizeof found);
    asj_watch_start(&watch, context, stage);
    s.lines = asj_allocate(memory, count, ASJ_MAX_BRANCHES * sizeof *s.lines);
    s.tail = asj_allocate(memory, ASJ_VOTE_LEVELS * (ASJ_VOTE_LINES + 1), sizeof *s.tail);
    if (s.lines && s.tail) {
        s.count = asj_vanishing_lines(junctions, count, camera, &watch, s.lines);
        answer(&s, options, camera, &found);
        status = asj_watch_end(&watch);
        if (status == ASJ_OK)
            *result = found;
    } else {
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the branches of %zu junctions", count);
    }
    asj_release(memory, s.lines);
    asj_release(memory, s.tail);
    return status;
}

asj_status asj_find_vanishing_points(asj_context *context, const asj_junction *junctions, size_t count,
                                     const asj_vanishing_options *options, asj_vanishing_points *result)
{
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!options || !result || (!junctions && count > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the junctions, the options or the result is NULL");
    context->progress = 0; /* a call of its own */
    const asj_status status = check(context, junctions, count, options);
    return status == ASJ_OK ? asj_vanishing_points_of(context, junctions, count, options, ASJ_STAGE_DECOMPOSE, result) : status;
}
