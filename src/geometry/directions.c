/* SPDX-License-Identifier: BSD-2-Clause */
/* The directions of a room ("Manhattan frame": Coughlan and Yuille 1999) from its straight edges, with a camera that is known.
 *
 * vanishing_vote.c asks of each direction by itself whether chance brings as many edges; in a photograph of a room, with a dozen
 * edges along each of its directions among two hundred others, two of the three are seldom that sure. All three together are: with
 * axes d_1, d_2, d_3 and the angle a_k between an edge and the vanishing point of d_k, seen from the edge's middle, the likelihood
 * ratio of an edge is
 *
 *     r = 1 - w + w / 3 sum over k of pi N(a_k; 0, s^2),     s^2 = sd^2 + b^2,
 *
 * N the normal density and 1 / pi the flat one: right edges err by what they are out across (sd: vanishing_vote.c), and by what is
 * not quite at right angles (walls, lenses), b. How many edges belong to the directions, w, is one of SHARES, each as likely, and
 * so is b one of BENDS: score = log of the mean over the shares of the product of all r, at the best b. Edges of rendered rooms fit
 * the smallest ones, those of video frames 1 degree and more, and directions are as sure as that (with 1 degree for all of them AUC
 * at 1 degree is 55.6 for 66.2: tests/accuracy/tried/geometry.md, "How straight the edges are"). Where the focal length is not
 * known, b is 1 degree: with one that is a little wrong nothing is at right angles.
 *
 * Search: vanishing points that pairs of the PAIRED longest edges define; those MOST_POINTS of them that explain most, more than
 * APART from each other, are one axis, and the other two are turned around it in steps, all that with b = BENDS[SEARCHED]; the best
 * STARTS of it, more than DIFFERENT from each other, are refined: expectation and maximisation as in adjust.c, over the turn of the
 * three axes, with one b after the other, the largest first, until a smaller one explains less. Their covariance is the inverse of
 * the information matrix, times TOGETHER, both with the largest share. Edges of one direction alone have sets too, with the other
 * two axes where a few of them happen to point.
 *
 * A set of directions costs little when it is wrong (manhattan.c), and a room with a desk across has two of them: the best
 * ASJ_MOST_DIRECTIONS are kept. */
#include "directions.h"
#include "core/angle.h"
#include "core/context.h"
#include "core/sort.h"
#include "elementary.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define SHORTEST 0.045 /* of the longer side: an edge that is looked at, and .. */
#define LEAST_EDGES 6
#define MOST_EDGES 200
#define TOGETHER 2.0 /* edges that err as one: both sides of a board */
#define BENDS 5
#define SEARCHED 1
#define PAIRED 40
#define MOST_POINTS 20
#define APART (1.5 * ASJ_DEGREE)
#define STEPS 60
#define STARTS 6
#define DIFFERENT (4 * ASJ_DEGREE)
#define SAME (3 * ASJ_DEGREE)
#define ROUNDS 8
#define FAR 16.0 /* squared residual beyond which an edge counts as none of an axis */
#define SHARES 3
#define LARGE 1e200 /* one more factor is no more than 1e5 */

static const double shares[SHARES] = {0.1, 0.3, 0.6};
static const double bends[BENDS] = {2 * ASJ_DEGREE, 1 * ASJ_DEGREE, 0.5 * ASJ_DEGREE, 0.25 * ASJ_DEGREE, 0.125 * ASJ_DEGREE};

/* Edges, and how exact they are with one of BENDS. */
typedef struct scene {
    const asj_vote_line *lines;
    int32_t count;
    double precision[MOST_EDGES], peak[MOST_EDGES]; /* 1 / s^2; pi / (sqrt(2 pi) s) */
} scene;

typedef struct ranked {
    double score;
    double axes[9];
    int32_t bend; /* of BENDS */
} ranked;

/* Density of the edge's direction under an axis over the flat one; the angle is as good as its sine where it counts. */
static double ratio(const scene *s, int32_t k, const double d[3])
{
    const asj_vote_line *one = &s->lines[k];
    const double dx = d[0] - d[2] * one->mx, dy = d[1] - d[2] * one->my, at = asj_dot3(one->l, d);
    const double square = at * at * s->precision[k], size2 = dx * dx + dy * dy;
    return square < FAR * size2 ? s->peak[k] * asj_exp_falling(-0.5 * square / size2) : 0;
}

/* Log of the mean over the shares: `near`, of each, the sum of log(1 + w / (1 - w) mean ratio). */
static double over_shares(const double near[SHARES], int32_t count)
{
    double each[SHARES], largest = -HUGE_VAL, sum = 0;
    for (int32_t i = 0; i < SHARES; i++) {
        each[i] = near[i] + count * log(1 - shares[i]);
        largest = fmax(largest, each[i]);
    }
    for (int32_t i = 0; i < SHARES; i++)
        sum += exp(each[i] - largest);
    return largest + log(sum / SHARES);
}

/* known: of each edge, what other axes say of it; NULL: there are no others. One logarithm is taken of many factors together. */
static double score_beside(const scene *s, const double *known, const double *axes, int32_t axis_count)
{
    double near[SHARES] = {0}, product[SHARES];
    for (int32_t i = 0; i < SHARES; i++)
        product[i] = 1;
    for (int32_t k = 0; k < s->count; k++) {
        double sum = known ? known[k] : 0;
        for (int32_t a = 0; a < axis_count; a++)
            sum += ratio(s, k, axes + 3 * a);
        for (int32_t i = 0; i < SHARES && sum > 0; i++) {
            product[i] *= 1 + shares[i] / (1 - shares[i]) * sum / 3;
            if (product[i] > LARGE) {
                near[i] += log(product[i]);
                product[i] = 1;
            }
        }
    }
    for (int32_t i = 0; i < SHARES; i++)
        near[i] += log(product[i]);
    return over_shares(near, s->count);
}

static double score_of(const scene *s, const double *axes, int32_t axis_count)
{
    return score_beside(s, NULL, axes, axis_count);
}

static int better(const void *left, const void *right)
{
    const ranked *p = left, *q = right;
    if (p->score != q->score)
        return p->score > q->score ? -1 : 1;
    for (int32_t k = 0; k < 9; k++)
        if (p->axes[k] != q->axes[k])
            return p->axes[k] > q->axes[k] ? -1 : 1;
    return 0;
}

/* Is the least turn that takes one set of directions to the other, whatever their names, less than `angle`? The largest trace over
 * the signed permutations tells, which takes the largest products in absolute value. (Those with determinant -1 are the same
 * directions.) */
static int32_t are_same(const double a[9], const double b[9], double angle)
{
    static const int32_t order[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
    double most = 0;
    for (int32_t n = 0; n < 6; n++) {
        double trace = 0;
        for (int32_t k = 0; k < 3; k++)
            trace += fabs(asj_dot3(a + 3 * k, b + 3 * order[n][k]));
        most = fmax(most, trace);
    }
    return 0.5 * (most - 1) > cos(angle);
}

/* --- search ------------------------------------------------------------------------------------------------------------------ */

/* Points of pairs of edges, the best first and apart from each other, in points[]. axes[0 .. 2]: the direction. */
static int32_t find_points(const scene *s, ranked *all, ranked points[MOST_POINTS])
{
    const int32_t paired = s->count < PAIRED ? s->count : PAIRED;
    int32_t count = 0, kept = 0;
    for (int32_t i = 0; i < paired; i++)
        for (int32_t k = 0; k < i; k++) {
            ranked *r = &all[count];
            memset(r, 0, sizeof *r);
            asj_cross3(s->lines[i].l, s->lines[k].l, r->axes);
            if (!asj_normalise3(r->axes))
                continue;
            r->score = score_of(s, r->axes, 1);
            count++;
        }
    if (count > 1)
        asj_sort(all, (size_t)count, sizeof *all, better);
    for (int32_t n = 0; n < count && kept < MOST_POINTS; n++) {
        int32_t fresh = 1;
        for (int32_t k = 0; k < kept && fresh; k++)
            fresh = fabs(asj_dot3(points[k].axes, all[n].axes)) < cos(APART);
        if (fresh)
            points[kept++] = all[n];
    }
    return kept;
}

/* All turns about the point's direction. */
static void turn_about(const scene *s, const double first[3], ranked *turned)
{
    const double e[3] = {fabs(first[0]) < 0.6, fabs(first[0]) >= 0.6, 0};
    double a[3], b[3], known[MOST_EDGES];
    asj_cross3(first, e, a);
    asj_normalise3(a);
    asj_cross3(first, a, b);
    for (int32_t k = 0; k < s->count; k++)
        known[k] = ratio(s, k, first);
    for (int32_t n = 0; n < STEPS; n++) {
        const double angle = n * (ASJ_PI / 2 / STEPS), c = cos(angle), d = sin(angle);
        ranked *r = &turned[n];
        memcpy(r->axes, first, 3 * sizeof *first);
        for (int32_t k = 0; k < 3; k++) {
            r->axes[3 + k] = c * a[k] + d * b[k];
            r->axes[6 + k] = -d * a[k] + c * b[k];
        }
        r->score = score_beside(s, known, r->axes + 3, 2);
    }
}

/* --- refinement -------------------------------------------------------------------------------------------------------------- */

/* Normal equations of the turn w, axes <- exp([w]x) axes, where an edge's sine moves by (d x l)'w. */
static void set_up(const scene *s, const double axes[9], double normal[9], double right[3])
{
    const double share = shares[SHARES - 1];
    memset(normal, 0, 9 * sizeof *normal);
    memset(right, 0, 3 * sizeof *right);
    for (int32_t k = 0; k < s->count; k++) {
        double each[3], sum = 0;
        for (int32_t a = 0; a < 3; a++)
            sum += each[a] = share / 3 * ratio(s, k, axes + 3 * a);
        for (int32_t a = 0; a < 3; a++) {
            const asj_vote_line *one = &s->lines[k];
            const double *d = axes + 3 * a, dx = d[0] - d[2] * one->mx, dy = d[1] - d[2] * one->my;
            const double weight = each[a] / (1 - share + sum) * s->precision[k] / (dx * dx + dy * dy);
            double slope[3];
            if (!(each[a] > 0))
                continue;
            asj_cross3(d, one->l, slope);
            for (int32_t i = 0; i < 3; i++) {
                right[i] -= weight * slope[i] * asj_dot3(one->l, d);
                for (int32_t j = 0; j < 3; j++)
                    normal[3 * i + j] += weight * slope[i] * slope[j];
            }
        }
    }
    for (int32_t i = 0; i < 3; i++)
        normal[4 * i] += 1; /* rad^-2: nothing is known worse than this */
}

static void refine_at(const scene *s, ranked *r)
{
    double normal[9], right[3], turn[9];
    for (int32_t round = 0; round < ROUNDS; round++) {
        ranked next = *r;
        set_up(s, r->axes, normal, right);
        if (!asj_cholesky_solve(normal, 3, right, NULL))
            return;
        asj_rotation_of(right, turn);
        for (int32_t a = 0; a < 3; a++)
            asj_apply3(turn, r->axes + 3 * a, next.axes + 3 * a);
        next.score = score_of(s, next.axes, 3);
        if (!(next.score > r->score))
            return;
        *r = next;
    }
}

/* With the one of `count` BENDS from `first` on that none smaller explains the edges better than. */
static void refine(const scene scenes[BENDS], int32_t first, int32_t count, ranked *r)
{
    ranked next = *r;
    for (int32_t b = first; b < first + count; b++) {
        next.bend = b;
        next.score = score_of(&scenes[b], next.axes, 3);
        refine_at(&scenes[b], &next);
        if (b > first && !(next.score > r->score))
            break;
        *r = next;
    }
    r->score -= log(count);
}

/* Of the turn that is left; 0 when it has none. */
static int32_t find_covariance(const scene *s, const double axes[9], double covariance[9])
{
    double normal[9], right[3];
    set_up(s, axes, normal, right);
    if (!asj_invert3(normal, covariance))
        return 0;
    for (int32_t k = 0; k < 9; k++)
        covariance[k] *= TOGETHER;
    return 1;
}

void asj_directions_add(asj_directions_list *found, const asj_directions *more)
{
    for (int32_t k = 0; k < found->count; k++)
        if (are_same(found->list[k].axes, more->axes, SAME))
            return;
    if (found->count < ASJ_MOST_DIRECTIONS)
        found->list[found->count++] = *more;
}

static void search(const scene scenes[BENDS], int32_t exact, ranked *all, asj_directions_list *found)
{
    const scene *s = &scenes[SEARCHED];
    ranked points[MOST_POINTS], starts[STARTS];
    const int32_t point_count = find_points(s, all, points);
    int32_t kept = 0;
    for (int32_t k = 0; k < point_count; k++)
        turn_about(s, points[k].axes, all + (size_t)k * STEPS);
    if (point_count > 0)
        asj_sort(all, (size_t)point_count * STEPS, sizeof *all, better);
    for (int32_t n = 0; n < point_count * STEPS && kept < STARTS; n++) {
        int32_t fresh = 1;
        for (int32_t k = 0; k < kept && fresh; k++)
            fresh = !are_same(starts[k].axes, all[n].axes, DIFFERENT);
        if (fresh)
            starts[kept++] = all[n];
    }
    for (int32_t k = 0; k < kept; k++)
        refine(scenes, exact ? 0 : SEARCHED, exact ? BENDS : 1, &starts[k]);
    if (kept > 1)
        asj_sort(starts, (size_t)kept, sizeof *starts, better);
    for (int32_t k = 0; k < kept && found->count < ASJ_MOST_DIRECTIONS; k++) {
        asj_directions next;
        memcpy(next.axes, starts[k].axes, sizeof next.axes);
        next.score = starts[k].score;
        if (next.score > 0 && find_covariance(&scenes[starts[k].bend], next.axes, next.covariance))
            asj_directions_add(found, &next);
    }
}

struct asj_directions_scratch {
    asj_vote_line *lines;
    ranked *all;
    scene scenes[BENDS];
};

static void set_scene(const asj_vote_line *lines, int32_t count, double bend, scene *s)
{
    s->lines = lines;
    s->count = count;
    for (int32_t k = 0; k < count; k++) {
        const double sd = hypot(lines[k].sd, bend);
        s->precision[k] = 1 / (sd * sd);
        s->peak[k] = ASJ_PI / (sqrt(2 * ASJ_PI) * sd);
    }
}

asj_directions_scratch *asj_directions_scratch_create(asj_memory *memory, size_t count)
{
    const size_t paired = PAIRED * (PAIRED - 1) / 2, turned = MOST_POINTS * STEPS;
    asj_directions_scratch *scratch = asj_allocate_zero(memory, 1, sizeof *scratch);
    if (!scratch)
        return NULL;
    scratch->lines = asj_allocate(memory, count, sizeof *scratch->lines);
    scratch->all = asj_allocate(memory, paired > turned ? paired : turned, sizeof *scratch->all);
    if (scratch->lines && scratch->all)
        return scratch;
    asj_directions_scratch_free(memory, scratch);
    return NULL;
}

void asj_directions_scratch_free(asj_memory *memory, asj_directions_scratch *scratch)
{
    if (!scratch)
        return;
    asj_release(memory, scratch->lines);
    asj_release(memory, scratch->all);
    asj_release(memory, scratch);
}

void asj_find_directions_with(asj_directions_scratch *scratch, const asj_edge_list *edges, const asj_camera *camera, int32_t exact,
                              asj_directions_list *found)
{
    const double scale = edges->scale;
    const asj_camera of_level = {camera->fx / scale, camera->fy / scale, (camera->cx + 0.5) / scale - 0.5,
                                 (camera->cy + 0.5) / scale - 0.5};
    memset(found, 0, sizeof *found);
    int32_t count = asj_vote_lines(edges->list, edges->count, SHORTEST * edges->longer, &of_level, scratch->lines);
    count = count < MOST_EDGES ? count : MOST_EDGES;
    if (count < LEAST_EDGES)
        return;
    for (int32_t b = 0; b < BENDS; b++)
        set_scene(scratch->lines, count, bends[b], &scratch->scenes[b]);
    search(scratch->scenes, exact, scratch->all, found);
}

int32_t asj_find_directions(asj_memory *memory, const asj_edge_list *edges, const asj_camera *camera, int32_t exact,
                            asj_directions_list *found)
{
    asj_directions_scratch *scratch = asj_directions_scratch_create(memory, edges->count);
    memset(found, 0, sizeof *found);
    if (scratch)
        asj_find_directions_with(scratch, edges, camera, exact, found);
    asj_directions_scratch_free(memory, scratch);
    return scratch != NULL;
}
