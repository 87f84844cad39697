/* SPDX-License-Identifier: BSD-2-Clause */
/* Arcs that look like corners (not in the paper).
 *
 * On the rim of a disc, a plate, a wheel, a lamp, two tangents are straight enough for the few px that short branches have, and
 * they meet at an angle: in each octave discs of 8 to 12 of its px have up to eleven such junctions. But along a corner's branches
 * the edge keeps its direction, and along an arc's it turns all the way. With t px along a branch and n across (line_fit.c), an
 * edge of curvature k, 1/px, that leaves the direction of the branch by alpha at t = 0 has gradients with
 *
 *     g_u / g_n = -tan(alpha + k t)  ~  -(alpha + k t),
 *
 * so weighted least squares of g_u / g_n over t, with weights g_n^2 (each pixel has the same noise), give k. From the middle of one
 * branch to that of the other, at the means of t, a corner whose branches open by phi turns by theta = pi - phi. An arc turns by
 * k t_a + k t_b on the way, if both turn towards each other, so
 *
 *     (k_a t_a + k_b t_b) / theta
 *
 * is the share of the turn that is made evenly: 1.0 to 1.6 on rims of discs, 0 +- 0.05 at corners of straight edges. A junction of
 * which each two branches that open have an arc's share is none; a T whose stem meets an arc is one.
 *
 * Discs of 100 grey levels in noise of 2, 3 to 50 px large, edges of .7 px, 36 of each of thirteen sizes: 2186 junctions without
 * this, 43 with it (test_curvature.c has some). Of 10464 junctions of 91 photographs, most of things that people make, it takes
 * 2.0 %, most of them from leaves. The standard deviation is about twice what corners have: g_u is a difference along the edge, so
 * that its noise is less alike there than from pixel to pixel. Not where strips do not judge (preset match): what is found on an
 * arc in both images matches. */
#include "curvature.h"
#include "blurred_corner.h"
#include "core/angle.h"
#include "strip.h"

#include <math.h>

#define FIRST 2.0      /* px: what is nearer to a corner, blur and the gradient's differences make round, */
#define FIRST_SOFT 2.0 /* and so many widths of a soft edge's blur */
#define LAST 30.0      /* px: arcs of a radius of 40 px are left by their tangents there */
#define BEYOND 6.0     /* px before the end: what the scan goes beyond another corner, and what that one makes round; */
#define SHORT 7.5      /* not of branches that are as short as this: rims are followed no farther */
#define STRAIGHT 13.0  /* px: see is_short_and_soft() */
#define HALF_BAND 2.5  /* px across */
#define FEWEST 8       /* pixels */

/* An arc: the share is surely above HALF, and at least EVEN in all and EVEN_EACH for either branch. */
#define HALF 0.5
#define SURELY 2.0 /* standard deviations */
#define EVEN 0.7
#define EVEN_EACH 0.25

/* Over pixels with the weight w = g_n^2: sums of w, w t, w t^2, g_u g_n, g_u g_n t, g_u^2. */
typedef struct sums {
    double w, t, tt, un, unt, uu;
    int32_t count;
} sums;

static void add(sums *to, double t, double along, double across)
{
    const double w = across * across, un = along * across;
    to->w += w;
    to->t += w * t;
    to->tt += w * t * t;
    to->un += un;
    to->unt += un * t;
    to->uu += along * along;
    to->count++;
}

/* What a branch turns by per px, and the mean of t; sd of the former. */
typedef struct bend {
    double curvature, middle, sd;
} bend;

/* Of the gradients' two signs apart. */
static void add_up(const asj_frame *frame, const asj_strip_line *line, double first, sums both[2])
{
    const asj_strip_walk walk = asj_strip_walk_along(frame, line, HALF_BAND, 0);
    for (int32_t i = walk.first; i <= walk.last; i++) {
        int32_t from, to;
        asj_strip_step(frame, &walk, i, &from, &to);
        for (int32_t j = from; j <= to; j++) {
            const int32_t x = walk.along_x ? i : j, y = walk.along_x ? j : i;
            const double dx = x - walk.x, dy = y - walk.y, t = dx * walk.ux + dy * walk.uy;
            const double gx = frame->gradient_x[y * frame->stride + x], gy = frame->gradient_y[y * frame->stride + x];
            const double along = gx * walk.ux + gy * walk.uy, across = gy * walk.ux - gx * walk.uy;
            if (t >= first && t <= line->length && fabs(across) > fabs(along))
                add(&both[across > 0], t, along, across);
        }
    }
}

/* Of the stronger sign only: the other side of a thin line turns otherwise. */
static bend bend_of(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    const double soft = FIRST_SOFT * branch->width, last = fmax(branch->length - BEYOND, fmin(branch->length, SHORT));
    const asj_strip_line line = {hypothesis->x - branch->offset * sin(branch->angle),
                                 hypothesis->y + branch->offset * cos(branch->angle), branch->angle, fmin(last, LAST + soft)};
    sums both[2] = {{0}};
    add_up(frame, &line, FIRST + soft, both);
    const sums *m = &both[both[1].w > both[0].w];
    const double determinant = m->w * m->tt - m->t * m->t;
    if (m->count < FEWEST || !(determinant > 0))
        return (bend){0, 1, HUGE_VAL};
    const double slope = (m->w * m->unt - m->t * m->un) / determinant, mean = (m->un - slope * m->t) / m->w;
    const double left = fmax(m->uu - mean * m->un - slope * m->unt, 0);
    return (bend){-slope, m->t / m->w, sqrt(left / (m->count - 2) * m->w / determinant)};
}

/* From one branch to the other, -pi to pi. */
static double signed_turn(const asj_hypothesis_branch *a, const asj_hypothesis_branch *b)
{
    const double turn = asj_angle_wrap(b->angle - a->angle);
    return turn > ASJ_PI ? turn - ASJ_TWO_PI : turn;
}

/* What a branch has of the turn to the other one of its pair; `sign`: of the way that it would turn on an arc. */
static double share_of(const bend *branch, double turn, double sign)
{
    return (turn > 0 ? sign : -sign) * branch->curvature * branch->middle / (ASJ_PI - fabs(turn));
}

static int on_arc(const bend *a, const bend *b, double turn)
{
    const double shares[2] = {share_of(a, turn, 1), share_of(b, turn, -1)}, all = shares[0] + shares[1];
    const double sd = hypot(a->sd * a->middle, b->sd * b->middle) / (ASJ_PI - fabs(turn));
    return all >= EVEN && all - SURELY * sd >= HALF && fmin(shares[0], shares[1]) >= EVEN_EACH;
}

/* Between what blur makes round at both ends nothing of a short side is straight. (Corners of 25 grey levels blurred by 5 px:
 * recall .80 otherwise, .87 as it is.) */
static int is_short_and_soft(const asj_hypothesis *hypothesis)
{
    double shortest = HUGE_VAL, softest = 0;
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        shortest = fmin(shortest, hypothesis->branches[i].length);
        softest = fmax(softest, hypothesis->branches[i].width);
    }
    return shortest < STRAIGHT && softest > ASJ_SOFT_FROM;
}

/* Branches of a hypothesis and what is known of their bends: most are straight, and with one of them no pair is on an arc. */
typedef struct bends {
    const asj_frame *frame;
    const asj_hypothesis *hypothesis;
    int32_t known; /* the bends of so many are */
    bend list[ASJ_MAX_BRANCHES];
} bends;

static const bend *find_bend(bends *b, int32_t branch)
{
    for (; b->known <= branch; b->known++)
        b->list[b->known] = bend_of(b->frame, b->hypothesis, &b->hypothesis->branches[b->known]);
    return &b->list[branch];
}

int asj_is_arc(const asj_frame *frame, const asj_hypothesis *hypothesis, double least)
{
    bends found = {.frame = frame, .hypothesis = hypothesis};
    int seen = 0; /* a pair on an arc */
    if (is_short_and_soft(hypothesis))
        return 0;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        for (int32_t j = i + 1; j < hypothesis->branch_count; j++) {
            const double turn = signed_turn(&hypothesis->branches[i], &hypothesis->branches[j]);
            if (fabs(turn) < least || fabs(turn) > ASJ_PI - least)
                continue;
            if (!(share_of(find_bend(&found, i), turn, 1) >= EVEN_EACH) ||
                !on_arc(find_bend(&found, i), find_bend(&found, j), turn))
                return 0;
            seen = 1;
        }
    return seen;
}
