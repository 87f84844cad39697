/* SPDX-License-Identifier: BSD-2-Clause */
/* The pose once more, from where the matches lie.
 *
 * likelihood.c weighs candidates: hundreds of pairs of spots, most of them wrong, known to a pixel or so, with maps that are good
 * to some degrees. That finds the motion, and how far it is known. The matches that are left are more, nearly all are right, and in
 * sharp images they lie within some hundredths of a pixel of their epipolar lines; how near differs from pair to pair, and they
 * tell it themselves. So, with d_k the first-order distance of a match k that is likelier right than wrong from the geometry
 * (Sampson 1982; Hartley and Zisserman, 11.4.3),
 *
 *     d = x2' F x1 / sqrt(|first two of F x1|^2 + |first two of F' x2|^2)  px,     F = K2'^-1 [t]x R K1^-1,
 *
 * the pose is that of the least
 *
 *     sum of w_k log(1 + (d_k / s)^2) + 1/2 p' C^-1 p,
 *
 * p = (turn, two parts of the translation) from the pose that was found, C what is told of it: what candidates say of planes and
 * of maps stays in there. Distances are about normal, with Cauchy's tails, some few matches being wrong, and s is
 * their median times 1.48, w_k one over how many such matches lie within SAME_PLACE of match k in an image: corners of one place
 * err together. Weights of the squares are 2 w / (s^2 + d^2) (iteratively reweighted least squares; Holland and Welsch 1977).
 *
 * The scale s is that of few where places are few, and these lie on edges that err together: the first sum counts a share of what
 * it says, 0 up to FEW places (the sum of the w_k), rising to 1 at MANY. (With 1 for all of them poses of few places get worse.)
 *
 * Where the focal length was found with the motion, it is as far off as the motion is, and locations tell nothing more (rooms 1000
 * to 1119, 101 poses: 37 rotations nearer, 45 farther, translations 40 and 39): the pose stays.
 *
 * The covariance stays C: errors of locations are shared by more than those of a place (an edge that is thick, a lens), and what
 * the curvature above promises is half of what poses err by. (tests/accuracy/tried/geometry.md, "Where the matches lie".) */
#include "final_pose.h"
#include "pose_parameters.h"
#include "geometry/model.h"
#include "geometry/small_matrix.h"
#include "core/sort.h"

#include <math.h>
#include <string.h>

#define MOTION ASJ_POSE_PARAMETERS
#define FEW 20.0            /* places */
#define MANY 80.0
#define LEAST_PROBABLE 0.5F
#define SAME_PLACE 5.0F     /* px */
#define LEAST_SCALE 0.05    /* px: locations are no surer */
#define TO_SD 1.4826        /* of normal errors, a standard deviation over the median size */
#define MOST_ROUNDS 15
#define STILL 1e-8          /* rad */

/* A match. */
typedef struct sight {
    double x1[3], x2[3]; /* (x, y, 1), px */
    double weight;
    double off;          /* px: its distance d, */
    double over;         /* .. and one over the root below the line of it; 0 where there is no epipolar line */
    double l1[2], l2[2]; /* first two of F' x2 and of F x1 */
} sight;

typedef struct distance {
    double size, weight;
} distance;

typedef struct fit {
    asj_camera cameras[2];
    asj_pose_origin origin;                         /* what was found */
    double information[MOTION * MOTION];            /* C^-1 */
    double share;                                   /* of what distances say */
    double at[MOTION];                              /* p */
    sight *sights;
    distance *sorted; /* room for as many */
    size_t count;
} fit;

/* --- what is asked ------------------------------------------------------------------------------------------------------------ */

static double weight_of(const asj_around *around, uint32_t n)
{
    const asj_junction_match *m = &around->matches[n];
    int32_t near = 0;
    for (int32_t side = 0; side < 2; side++) {
        const float x = side ? m->x2 : m->x1, y = side ? m->y2 : m->y1;
        asj_place_walk walk = asj_places_near(around->places[side], around->place_count, x, y, (double)SAME_PLACE);
        for (uint32_t k; asj_places_next(&walk, &k);) {
            const asj_junction_match *o = &around->matches[k];
            if (o->probability <= LEAST_PROBABLE)
                continue;
            const int in1 = fabsf(o->x1 - m->x1) <= SAME_PLACE && fabsf(o->y1 - m->y1) <= SAME_PLACE;
            const int in2 = fabsf(o->x2 - m->x2) <= SAME_PLACE && fabsf(o->y2 - m->y2) <= SAME_PLACE;
            near += side == 0 ? in1 : (in2 && !in1);
        }
    }
    return 1.0 / (near > 0 ? near : 1);
}

static void collect(const asj_match_result *result, fit *f)
{
    const asj_around around = asj_match_result_around(result);
    for (uint32_t n = 0; n < result->match_count; n++) {
        const asj_junction_match *m = &result->matches[n];
        if (m->probability <= LEAST_PROBABLE)
            continue;
        const double weight = around.places[0] && around.places[1] ? weight_of(&around, n) : 1;
        f->sights[f->count++] = (sight){.x1 = {(double)m->x1, (double)m->y1, 1},
                                        .x2 = {(double)m->x2, (double)m->y2, 1},
                                        .weight = weight};
    }
}

/* --- the steps ---------------------------------------------------------------------------------------------------------------- */

/* F of a pose, and its derivatives. */
static void set_matrices(const fit *f, double matrix[9], double slopes[MOTION][9])
{
    double rotation[9], translation[3], cross[9], essential[9];
    asj_pose_at(&f->origin, f->at, rotation, translation);
    asj_skew3(translation, cross);
    asj_multiply3(cross, rotation, essential);
    asj_pixel_fundamental(essential, f->cameras, matrix);
    for (int32_t k = 0; k < 3; k++) {
        const double axis[3] = {k == 0, k == 1, k == 2};
        double about[9];
        asj_skew3(axis, about);
        asj_multiply3(about, rotation, about);
        asj_multiply3(cross, about, essential);
        asj_pixel_fundamental(essential, f->cameras, slopes[k]);
    }
    for (int32_t k = 0; k < 2; k++) {
        asj_skew3(f->origin.axes[k], cross);
        asj_multiply3(cross, rotation, essential);
        asj_pixel_fundamental(essential, f->cameras, slopes[3 + k]);
    }
}

static int by_size(const void *left, const void *right)
{
    const double a = ((const distance *)left)->size, b = ((const distance *)right)->size;
    return (a > b) - (a < b);
}

/* s: TO_SD times the weighted median of the distances. */
static double scale_of(const fit *f)
{
    double all = 0, below = 0;
    for (size_t n = 0; n < f->count; n++) {
        f->sorted[n] = (distance){fabs(f->sights[n].off), f->sights[n].weight};
        all += f->sights[n].weight;
    }
    asj_sort(f->sorted, f->count, sizeof *f->sorted, by_size);
    size_t middle = 0;
    while (middle + 1 < f->count && below + f->sorted[middle].weight < 0.5 * all)
        below += f->sorted[middle++].weight;
    return fmax(LEAST_SCALE, TO_SD * f->sorted[middle].size);
}

static void measure(const double matrix[9], sight *s)
{
    double l1[3], l2[3];
    asj_apply3(matrix, s->x1, l2);
    asj_apply3_transposed(matrix, s->x2, l1);
    const double square = l1[0] * l1[0] + l1[1] * l1[1] + l2[0] * l2[0] + l2[1] * l2[1];
    memcpy(s->l1, l1, sizeof s->l1);
    memcpy(s->l2, l2, sizeof s->l2);
    s->over = square > 0 ? 1 / sqrt(square) : 0;
    s->off = asj_dot3(s->x2, l2) * s->over;
}

/* The derivative of d, when that of F is `slope`. */
static double slope_of(const sight *s, const double slope[9])
{
    double l1[3], l2[3];
    asj_apply3(slope, s->x1, l2);
    asj_apply3_transposed(slope, s->x2, l1);
    const double of_square = s->l1[0] * l1[0] + s->l1[1] * l1[1] + s->l2[0] * l2[0] + s->l2[1] * l2[1];
    return s->over * (asj_dot3(s->x2, l2) - s->off * s->over * of_square);
}

static void add_sight(const sight *s, double share, double scale, const double slopes[MOTION][9], double *normal, double *right)
{
    const double weight = share * 2 * s->weight / (scale * scale + s->off * s->off);
    double slope[MOTION];
    for (int32_t k = 0; k < MOTION; k++)
        slope[k] = slope_of(s, slopes[k]);
    for (int32_t i = 0; i < MOTION; i++) {
        right[i] -= weight * slope[i] * s->off;
        for (int32_t k = 0; k < MOTION; k++)
            normal[i * MOTION + k] += weight * slope[i] * slope[k];
    }
}

/* One step; 0 when it moves nothing, or cannot be made. */
static int32_t step(fit *f)
{
    double matrix[9], slopes[MOTION][9], normal[MOTION * MOTION], right[MOTION] = {0}, size = 0;
    set_matrices(f, matrix, slopes);
    for (size_t n = 0; n < f->count; n++)
        measure(matrix, &f->sights[n]);
    const double scale = scale_of(f);
    memcpy(normal, f->information, sizeof normal);
    for (int32_t i = 0; i < MOTION; i++)
        for (int32_t k = 0; k < MOTION; k++)
            right[i] -= f->information[i * MOTION + k] * f->at[k];
    for (size_t n = 0; n < f->count; n++)
        add_sight(&f->sights[n], f->share, scale, (const double (*)[9])slopes, normal, right);
    if (!asj_cholesky_solve(normal, MOTION, right, NULL))
        return 0;
    for (int32_t k = 0; k < MOTION; k++) {
        if (!isfinite(right[k]))
            return 0;
        size = fmax(size, fabs(right[k]));
    }
    for (int32_t k = 0; k < MOTION; k++)
        f->at[k] += right[k];
    return size > STILL;
}

static void run(const asj_match_result *result, fit *f, asj_geometry *g)
{
    double places = 0;
    collect(result, f);
    for (size_t n = 0; n < f->count; n++)
        places += f->sights[n].weight;
    f->share = fmin(1, (places - FEW) / (MANY - FEW));
    if (!(f->share > 0) || !asj_pose_information(&f->origin, g, f->information))
        return;
    for (int32_t round = 0; round < MOST_ROUNDS && step(f); round++) {
    }
    asj_pose_tell(&f->origin, f->at, g);
}

asj_status asj_finish_pose(asj_context *context, asj_match_result **result)
{
    asj_geometry *g = &(*result)->geometry;
    fit f = {.cameras = {g->cameras[0], g->cameras[1]}};
    if (g->status != ASJ_GEOMETRY_ACCEPTED || !g->has_pose || !(f.cameras[0].fx > 0 && f.cameras[1].fx > 0) || g->focal_sd > 0)
        return ASJ_OK;
    asj_pose_origin_of(g, &f.origin);
    f.sights = asj_allocate(&context->memory, (*result)->match_count, sizeof *f.sights);
    f.sorted = asj_allocate(&context->memory, (*result)->match_count, sizeof *f.sorted);
    const int32_t good = f.sights && f.sorted;
    if (good)
        run(*result, &f, g);
    asj_release(&context->memory, f.sights);
    asj_release(&context->memory, f.sorted);
    if (good)
        return ASJ_OK;
    asj_match_result_free(result);
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the pose");
}
