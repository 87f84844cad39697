/* SPDX-License-Identifier: BSD-2-Clause */
/* Directions at right angles, found together.
 *
 * A wall, a floor and what stands on them have three directions at right angles, and few edges of some: five of forty are no surer
 * than chance (vanishing_vote.c), but with the other two directions and one focal length for all they are. So frames are tried as a
 * whole. Two points p, q of directions at right angles give the third, and where the focal length f is not known, that as well:
 * f^2 = -(p - c)'(q - c) (Caprile and Torre 1990). With k of n lines that vote for any of the three points, each with the chance
 * p = 2 TAU / pi, and d lines to define a frame (3, or 4 without a focal length; in 3 ways, which of them meet), chance brings
 *
 *     NFA = tests B(n - d, k - d, 3 p) / w,     tests = 3 C(n, d) for each TAU,     w = exp(-(log f/f0)^2 / (2 FOCAL_SPREAD^2))
 *
 * frames as good as that, where w <= 1 counts frames of unusual focal lengths, f0 the longer side, as if there were more of them
 * (w = 1 where it is given). Nor may the surest point alone be what is meant: without its lines the other two must be no chance,
 * either, with d - 2 lines to define them. And a focal length that is found must be known to FOCAL_SD. A point of the frame is told
 * when chance brings fewer than epsilon with so many votes to the line that the frame leaves it on, where one more branch defines
 * it:
 *
 *     NFA = n B(n - 1, k - 1, p) for each TAU.
 *
 * Points to try are those of all pairs of the longest lines, the CANDIDATES with most meaning that differ; the FOLLOWED best frames
 * are turned, and their focal length changed, to fit their lines: Gauss-Newton over w and log f, directions <- exp([w]x)
 * directions, where the residual (l' v) / |v_xy - v_w m| of a line with g = (l0, l1, l2 / f) and the direction d moves by
 * (d x g)' dw - l2 d2 / f dlog f. */
#include "vanishing_frame.h"
#include "core/angle.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define CANDIDATES 60
#define CANDIDATES_APART (1.5 * ASJ_DEGREE)
#define FOLLOWED 16
#define ROUNDS 6
#define SQUARE (4 * ASJ_DEGREE)
#define SHORTEST_FOCAL 1.2           /* in units of half the longer side */
#define LONGEST_FOCAL 8.0
#define FOCAL_SPREAD 0.25
#define DIRECTION_SD (0.3 * ASJ_DEGREE)
#define FOCAL_SD 0.05                /* relative: a focal length known worse than this is none */
#define FREE 4                       /* lines to define a frame without a focal length */

typedef struct frame_search {
    const asj_vote_search *s;
    double focal, most;              /* focal 0: not known */
    int32_t free;
    double frame_tail[ASJ_VOTE_LEVELS][ASJ_VOTE_LINES + 1], point_tail[ASJ_VOTE_LEVELS][ASJ_VOTE_LINES + 1];
    double log_tests[ASJ_VOTE_LEVELS];
} frame_search;

typedef struct trial {
    double axes[3][3]; /* directions; rows */
    double focal, log_nfa;
    int32_t level;     /* at which it is least likely by chance */
} trial;

static void point_of(const double d[3], double focal, double v[3])
{
    v[0] = d[0];
    v[1] = d[1];
    v[2] = d[2] / focal;
    asj_normalise3(v);
}

static double log_choose(int32_t n, int32_t k)
{
    double sum = 0;
    for (int32_t i = 0; i < k; i++)
        sum += log(n - i) - log(i + 1);
    return sum;
}

static void prepare(const asj_vote_search *s, double focal, double most, frame_search *f)
{
    memset(f, 0, sizeof *f);
    f->s = s;
    f->focal = focal;
    f->most = most;
    f->free = focal > 0 ? FREE - 1 : FREE;
    for (int32_t level = 0; level < ASJ_VOTE_LEVELS; level++) {
        const int32_t n = s->members[level];
        const double chance = asj_vote_chance(level);
        if (n <= f->free)
            continue;
        asj_binomial_tails(n - f->free, 3 * chance, f->frame_tail[level]);
        asj_binomial_tails(n - 1, chance, f->point_tail[level]);
        f->log_tests[level] = log(ASJ_VOTE_LEVELS * 3) + log_choose(n, f->free);
    }
}

/* What a focal length that is not given costs. */
static double unusual(const frame_search *f, double focal)
{
    const double off = f->focal > 0 ? 0 : log(focal / ASJ_USUAL_FOCAL) / FOCAL_SPREAD;
    return 0.5 * off * off;
}

/* Of the three points together. log_nfa HUGE_VAL, and the level as it was: too few lines vote for them. */
static void judge(const frame_search *f, trial *t)
{
    double points[3][3];
    int32_t votes[ASJ_VOTE_LEVELS];
    for (int32_t a = 0; a < 3; a++)
        point_of(t->axes[a], t->focal, points[a]);
    asj_count_votes(f->s, points, 3, votes);
    t->log_nfa = HUGE_VAL;
    for (int32_t level = 0; level < ASJ_VOTE_LEVELS; level++) {
        if (votes[level] <= f->free)
            continue;
        const double nfa = f->log_tests[level] + f->frame_tail[level][votes[level] - f->free];
        t->level = nfa < t->log_nfa ? level : t->level;
        t->log_nfa = fmin(t->log_nfa, nfa);
    }
    t->log_nfa += unusual(f, t->focal);
}

/* Of one of them, the others and the focal length known. */
static asj_vote judge_point(const frame_search *f, const double direction[3], double focal)
{
    asj_vote best = {{0, 0, 0}, HUGE_VAL, 0, 0};
    double point[1][3];
    int32_t votes[ASJ_VOTE_LEVELS];
    point_of(direction, focal, point[0]);
    memcpy(best.v, point[0], sizeof best.v);
    asj_count_votes(f->s, point, 1, votes);
    for (int32_t level = 0; level < ASJ_VOTE_LEVELS; level++) {
        const int32_t n = f->s->members[level];
        if (n <= f->free || votes[level] < 3)
            continue;
        const double nfa = log((double)ASJ_VOTE_LEVELS * n) + f->point_tail[level][votes[level] - 1];
        if (nfa < best.log_nfa) {
            best.log_nfa = nfa;
            best.votes = votes[level];
            best.level = level;
        }
    }
    return best;
}

/* --- frames to try ----------------------------------------------------------------------------------------------------------- */

/* The frame of two points. 0: they are not at right angles, with any focal length that can be, or once they are brought there, no
 * more lines vote for them than define a frame. */
static int32_t frame_of(const frame_search *f, const double p[3], const double q[3], trial *t)
{
    double first[3], second[3];
    t->focal = f->focal;
    if (!(f->focal > 0)) {
        const double far = p[2] * q[2], square = far != 0 ? -(p[0] * q[0] + p[1] * q[1]) / far : 0;
        t->focal = square > 0 ? sqrt(square) : 0;
        if (!(t->focal >= SHORTEST_FOCAL && t->focal <= LONGEST_FOCAL))
            return 0;
    }
    asj_direction_of(p, t->focal, first);
    asj_direction_of(q, t->focal, second);
    if (fabs(asj_dot3(first, second)) > sin(SQUARE))
        return 0;
    memcpy(t->axes[0], first, sizeof first);
    asj_cross3(first, second, t->axes[2]);
    asj_normalise3(t->axes[2]);
    asj_cross3(t->axes[2], first, t->axes[1]);
    judge(f, t);
    return t->log_nfa < HUGE_VAL;
}

/* Keeps the best FOLLOWED in order; of equals the first. */
static void keep(trial *best, int32_t *count, const trial *t)
{
    if (*count == FOLLOWED && best[FOLLOWED - 1].log_nfa <= t->log_nfa)
        return;
    *count += *count < FOLLOWED;
    int32_t at = *count - 1;
    for (; at > 0 && best[at - 1].log_nfa > t->log_nfa; at--)
        best[at] = best[at - 1];
    best[at] = *t;
}

static int32_t try_pairs(const frame_search *f, const asj_vote *points, int32_t count, trial best[FOLLOWED])
{
    int32_t kept = 0;
    for (int32_t i = 0; i < count && !(f->s->watch && asj_watch_stops(f->s->watch, NULL)); i++)
        for (int32_t k = 0; k < i; k++) {
            trial t;
            if (frame_of(f, points[k].v, points[i].v, &t))
                keep(best, &kept, &t);
        }
    return kept;
}

/* One step to the lines that vote for it. */
static void turn(const frame_search *f, trial *t)
{
    const int32_t size = f->focal > 0 ? 3 : 4;
    double normal[16] = {0}, right[4] = {0}, rotation[9];
    for (int32_t a = 0; a < 3; a++) {
        double v[3];
        const double *d = t->axes[a];
        point_of(d, t->focal, v);
        for (int32_t k = 0; k < f->s->count; k++) {
            const asj_vote_line *one = &f->s->lines[k];
            if (!asj_line_votes_for(one, v, t->level))
                continue;
            const double g[3] = {one->l[0], one->l[1], one->l[2] / t->focal};
            const double dx = d[0] - d[2] / t->focal * one->mx, dy = d[1] - d[2] / t->focal * one->my, length = hypot(dx, dy);
            double slope[4];
            asj_cross3(d, g, slope);
            slope[3] = -g[2] * d[2];
            const double weight = 1 / (length * length * one->sd * one->sd), at = asj_dot3(g, d);
            for (int32_t i = 0; i < size; i++) {
                right[i] -= weight * slope[i] * at;
                for (int32_t j = 0; j < size; j++)
                    normal[size * i + j] += weight * slope[i] * slope[j];
            }
        }
    }
    for (int32_t i = 0; i < size; i++)
        normal[(size + 1) * i] += 1;
    if (!asj_cholesky_solve(normal, size, right, NULL))
        return;
    asj_rotation_of(right, rotation);
    for (int32_t a = 0; a < 3; a++)
        asj_apply3(rotation, t->axes[a], t->axes[a]);
    if (size > 3)
        t->focal = fmin(LONGEST_FOCAL, fmax(SHORTEST_FOCAL, t->focal * exp(fmin(0.5, fmax(-0.5, right[3])))));
}

/* Turned until it fits, even where it loses a line at the edge of a tolerance by that: the fit is exact, the count is not. */
static void follow(const frame_search *f, trial *t)
{
    trial next = *t;
    for (int32_t round = 0; round < ROUNDS; round++) {
        turn(f, &next);
        judge(f, &next);
    }
    if (next.log_nfa <= f->most)
        *t = next;
}

/* --- the answer -------------------------------------------------------------------------------------------------------------- */

/* Relative standard deviation of the focal length, where the directions that are sure are each known to DIRECTION_SD. When log f
 * grows by one, the direction m that its point has moves by u = m_z (e_z - m_z m). A turn w follows as far as it can; what is left
 * is
 *
 *     L^2 = min over w of sum |u - w x m|^2 = sum |u|^2 - b' N^-1 b,   N = sum (I - m m'),   b = sum m x u,
 *
 * and the deviation DIRECTION_SD / L. */
static double focal_sd(const asj_vanishing_frame *frame)
{
    double n[9] = {0}, b[3] = {0}, w[3], left = 0;
    for (int32_t a = 0; a < frame->count; a++) {
        const double *m = frame->directions[a];
        const double u[3] = {-m[2] * m[2] * m[0], -m[2] * m[2] * m[1], m[2] * (1 - m[2] * m[2])};
        double cross[3];
        asj_cross3(m, u, cross);
        left += asj_dot3(u, u);
        for (int32_t i = 0; i < 3; i++) {
            b[i] += cross[i];
            for (int32_t k = 0; k < 3; k++)
                n[3 * i + k] += (i == k) - m[i] * m[k];
        }
    }
    memcpy(w, b, sizeof w);
    if (!asj_cholesky_solve(n, 3, w, NULL))
        return HUGE_VAL;
    left -= asj_dot3(b, w);
    return left > 0 ? DIRECTION_SD / sqrt(left) : HUGE_VAL;
}

/* Of `count` of the points together, given the `given` ones before them, whose lines are not theirs, where so many lines define
 * them. Natural logarithm. */
static double judge_given(const frame_search *f, const asj_vote points[3], int32_t given, int32_t count, int32_t freedom)
{
    double tail[ASJ_VOTE_LINES + 1], best = HUGE_VAL;
    for (int32_t level = 0; level < ASJ_VOTE_LEVELS; level++) {
        int32_t n = f->s->members[level], votes = 0;
        for (int32_t k = 0; k < f->s->count; k++) {
            int32_t at = 0;
            while (at < given + count && !asj_line_votes_for(&f->s->lines[k], points[at].v, level))
                at++;
            n -= at < given;
            votes += at >= given && at < given + count;
        }
        if (n < freedom || votes < freedom)
            continue;
        asj_binomial_tails(n - freedom, count * asj_vote_chance(level), tail);
        best = fmin(best, log(ASJ_VOTE_LEVELS) + log_choose(n, freedom) + tail[votes - freedom]);
    }
    return best;
}

static asj_vanishing_frame describe(const frame_search *f, trial *t)
{
    asj_vanishing_frame frame;
    memset(&frame, 0, sizeof frame);
    frame.focal = t->focal;
    for (int32_t a = 0; a < 3; a++)
        frame.points[a] = judge_point(f, t->axes[a], t->focal);
    asj_vote_sort(frame.points, 3);
    for (int32_t a = 0; a < 3; a++) {
        asj_direction_of(frame.points[a].v, t->focal, frame.directions[a]);
        frame.count += frame.points[a].log_nfa <= f->most;
    }
    frame.log_nfa = judge_given(f, frame.points, 0, 1, 2) + fmin(0, judge_given(f, frame.points, 1, 1, f->free - 2)) +
                    fmin(0, judge_given(f, frame.points, 2, 1, 0)) + unusual(f, t->focal);
    if (frame.count < 2 || !(t->log_nfa <= f->most) || !(judge_given(f, frame.points, 1, 2, f->free - 2) <= f->most) ||
        (!(f->focal > 0) && focal_sd(&frame) > FOCAL_SD))
        frame.count = 0;
    return frame;
}

static void find_frame(const frame_search *f, const asj_vote *points, int32_t count, asj_vanishing_frame *frame)
{
    trial trials[FOLLOWED];
    const int32_t tried = try_pairs(f, points, count, trials);
    double best = HUGE_VAL;
    for (int32_t n = 0; n < tried; n++) {
        follow(f, &trials[n]);
        if (!(trials[n].log_nfa < best))
            continue;
        const asj_vanishing_frame next = describe(f, &trials[n]);
        if (next.count > 0) {
            *frame = next;
            best = trials[n].log_nfa;
        }
    }
}

asj_status asj_find_frame(asj_context *context, asj_vote_search *s, double focal, double most, asj_vanishing_frame *frame)
{
    asj_memory *memory = &context->memory;
    asj_vote *points = asj_allocate(memory, ASJ_VOTE_PAIRS, sizeof *points);
    frame_search *f = asj_allocate(memory, 1, sizeof *f);
    memset(frame, 0, sizeof *frame);
    if (points && f) {
        const int32_t pairs = asj_vote_pairs(s, points);
        const int32_t count = asj_vote_distinct(points, pairs, focal > 0 ? focal : ASJ_USUAL_FOCAL, CANDIDATES_APART, CANDIDATES);
        prepare(s, focal, most, f);
        find_frame(f, points, count, frame);
    }
    const asj_status status = points && f ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for vanishing points");
    asj_release(memory, points);
    asj_release(memory, f);
    return status;
}
