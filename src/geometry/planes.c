/* SPDX-License-Identifier: BSD-2-Clause */
/* Planes in a motion, and motions of a plane.
 *
 * A plane n'X = 1 (coordinates of camera 1, |t| = 1) seen by two cameras has the homography N = R + t n' between rays (x, y, 1) =
 * K^-1 of pixels. The other way: with the singular values of N brought to s1 >= 1 >= s3 (its second one is 1 for a true plane), the
 * vectors v1, v2, v3 of N'N and
 *
 *     u = (sqrt(1 - s3^2) v1 +- sqrt(s1^2 - 1) v3) / sqrt(s1^2 - s3^2)
 *
 * N keeps the length of v2 and u, so R carries v2, u, v2 x u to N v2, N u, N v2 x N u; n is along v2 x u and t = (N - R) n (Ma,
 * Soatto, Kosecka and Sastry, "An Invitation to 3-D Vision", theorem 5.19). Of each sign of u one sign of n sees what is there. R
 * is no reflection, whatever N is: R = G F' with columns F of v2, u, v2 x u and G of what they become, and its determinant is
 * |v2 x u|^2 |N v2 x N u|^2.
 *
 * A motion receives planes one by one. Hypotheses: every candidate that the motion makes probable stands for three points (as in
 * minimal.c); with y2 ~ R y1 + s t each has an inverse depth s = n'y1, and three give n. So do a candidate and its two nearest
 * ones. The plane that raises the likelihood of the candidates near the motion most is refined together with the motion (adjust.c)
 * and stays if the evidence has risen. */
#include "planes.h"
#include "elementary.h"
#include "evidence.h"
#include "minimal.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define MOST_NEAR 160
#define MOST_PLANE_STARTS 48
#define PROBABLE 0.2
#define POSSIBLE 0.02
#define LOOSE 2.0
#define ROUNDS 4
#define NO_PLANE 1e-3 /* of the singular values of N: nearer than this to 1, the camera only turns */
#define DEEPEST 10.0  /* base over distance: planes nearer than a tenth of the base are none */

/* --- motions of a homography ------------------------------------------------------------------------------------------------- */

/* Sign of n: most of what the homography makes probable is seen. */
static double sign_of(const asj_pairs *set, const asj_model *homography, const asj_camera *camera, const double n[3])
{
    const asj_peaks peaks = asj_likelihood_peaks(set, &homography->view, 1);
    double sum = 0;
    for (int32_t k = 0; k < set->count; k++) {
        const asj_pair *c = &set->list[k];
        const double ratio = asj_likelihood_ratio(&homography->view, set, c, &peaks, NULL);
        double ray[3];
        asj_ray(camera, c->x1, c->y1, ray);
        if (ratio > 0)
            sum += (asj_dot3(n, ray) > 0 ? 1 : -1) * fmin(1, c->prior * ratio);
    }
    return sum < 0 ? -1 : 1;
}

/* Columns a, b, a x b. */
static void frame_of(const double a[3], const double b[3], double frame[9])
{
    double c[3];
    asj_cross3(a, b, c);
    for (int32_t i = 0; i < 3; i++) {
        frame[3 * i] = a[i];
        frame[3 * i + 1] = b[i];
        frame[3 * i + 2] = c[i];
    }
}

/* What two of them have in common. */
typedef struct decomposed {
    double n[9];                   /* N with the second singular value 1 */
    double normal[2][3];           /* of the plane, of either sign */
    double rotation[2][9];
} decomposed;

/* How many: 2, or 0 where the camera only turns. */
static int32_t decompose(const asj_model *homography, const asj_camera cameras[2], decomposed *d)
{
    double square[9], values[3], vectors[9], v2[3], nv2[3];
    asj_normal_homography(homography->view.matrix, cameras, d->n);
    asj_transposed_multiply3(d->n, d->n, square);
    asj_symmetric_eigen(square, 3, values, vectors);
    if (!(values[0] > 1e-9 * values[2]) || !isfinite(values[2]))
        return 0;
    for (int32_t k = 0; k < 9; k++)
        d->n[k] /= sqrt(values[1]);
    const double low = values[0] / values[1], high = values[2] / values[1];
    if (!(high - low > NO_PLANE))
        return 0;
    const double along1 = sqrt((1 - low) / (high - low)), along3 = sqrt((high - 1) / (high - low));
    for (int32_t i = 0; i < 3; i++)
        v2[i] = vectors[3 * i + 1];
    asj_apply3(d->n, v2, nv2);
    for (int32_t k = 0; k < 2; k++) {
        const int32_t side = 2 * k - 1;
        double u[3], nu[3], from[9], to[9];
        for (int32_t i = 0; i < 3; i++) /* vectors: of the smallest value first, which is s3 */
            u[i] = along1 * vectors[3 * i + 2] + side * along3 * vectors[3 * i];
        asj_cross3(v2, u, d->normal[k]);
        asj_apply3(d->n, u, nu);
        frame_of(v2, u, from);
        frame_of(nv2, nu, to);
        asj_multiply3_transposed(to, from, d->rotation[k]);
    }
    return 2;
}

int32_t asj_rotations_of_homography(const asj_model *homography, const asj_camera cameras[2], double rotations[2][9])
{
    decomposed d;
    const int32_t count = decompose(homography, cameras, &d);
    if (count > 0)
        memcpy(rotations, d.rotation, sizeof d.rotation);
    return count;
}

int32_t asj_motions_of_homography(const asj_pairs *set, const asj_model *homography, const asj_camera cameras[2],
                                  asj_model motions[2])
{
    decomposed d;
    int32_t found = 0;
    const int32_t count = decompose(homography, cameras, &d);
    for (int32_t k = 0; k < count; k++) {
        const double *normal = d.normal[k];
        asj_model *m = &motions[found];
        memset(m, 0, sizeof *m);
        memcpy(m->rotation, d.rotation[k], sizeof m->rotation);
        const double sign = sign_of(set, homography, &cameras[0], normal);
        for (int32_t i = 0; i < 3; i++)
            m->translation[i] = sign * (asj_dot3(d.n + 3 * i, normal) - asj_dot3(m->rotation + 3 * i, normal));
        const double length = sqrt(asj_dot3(m->translation, m->translation));
        for (int32_t i = 0; i < 3; i++)
            m->planes[0][i] = sign * length * normal[i];
        m->kind = ASJ_GEOMETRY_ESSENTIAL;
        m->parameters = 8;
        m->view.plane_count = 1;
        memcpy(m->cameras, cameras, sizeof m->cameras);
        found += length > NO_PLANE && length < DEEPEST && asj_model_complete(m);
    }
    return found;
}

/* --- planes of a motion ------------------------------------------------------------------------------------------------------ */

/* A candidate near the motion. */
typedef struct near_one {
    const asj_pair *pair;
    double probability, ratio;
    double before; /* what it has of the ratio, with one plane more, from all that is there already */
    double without; /* what it adds to gain_of() where it does not lie on that plane */
} near_one;

typedef struct neighbourhood {
    near_one list[MOST_NEAR];
    int32_t count;
} neighbourhood;

/* s of y2 ~ R y1 + s t: where |y2 x (R y1 + s t)| is least. */
static double inverse_depth(const asj_model *m, const double y1[3], const double y2[3])
{
    double turned[3], a[3], b[3];
    asj_apply3(m->rotation, y1, turned);
    asj_cross3(y2, turned, a);
    asj_cross3(y2, m->translation, b);
    return -asj_dot3(a, b) / asj_dot3(b, b);
}

/* n from three rays of image 1 and their inverse depths; 0 when they are on a line or the plane is none. */
static int32_t plane_of(const double rays[9], const double depths[3], double n[3])
{
    double inverse[9];
    if (!(fabs(asj_determinant3(rays)) > 1e-9) || !asj_invert3(rays, inverse))
        return 0;
    asj_apply3(inverse, depths, n);
    return asj_dot3(n, n) < DEEPEST * DEEPEST;
}

static int32_t plane_of_one(const asj_model *m, const asj_pair *c, double n[3])
{
    double rays[9], depths[3];
    for (int32_t k = 0; k < 3; k++) {
        double y2[3];
        asj_rays_beside(c, m->cameras, k, rays + 3 * k, y2);
        depths[k] = inverse_depth(m, rays + 3 * k, y2);
    }
    return plane_of(rays, depths, n);
}

/* Of candidate `at` and its two nearest ones of other places. */
static int32_t plane_of_three(const asj_model *m, const neighbourhood *near, int32_t at, double n[3])
{
    const asj_pair *c[3] = {near->list[at].pair, NULL, NULL};
    double rays[9], depths[3];
    for (int32_t k = 1; k < 3; k++) {
        double best = HUGE_VAL;
        for (int32_t i = 0; i < near->count; i++) {
            const asj_pair *o = near->list[i].pair;
            const double dx = o->x1 - c[0]->x1, dy = o->y1 - c[0]->y1, d2 = dx * dx + dy * dy;
            if (near->list[i].probability < PROBABLE || o->place1 == c[0]->place1 || (k == 2 && o->place1 == c[1]->place1))
                continue;
            if (k == 2) { /* not on a line with the two */
                const double ex = c[1]->x1 - c[0]->x1, ey = c[1]->y1 - c[0]->y1, area = ex * dy - ey * dx;
                if (area * area < 0.1 * d2 * (ex * ex + ey * ey))
                    continue;
            }
            if (d2 < best) {
                best = d2;
                c[k] = o;
            }
        }
        if (!c[k])
            return 0;
    }
    for (int32_t k = 0; k < 3; k++) {
        double y2[3];
        asj_ray(&m->cameras[0], c[k]->x1, c[k]->y1, rays + 3 * k);
        asj_ray(&m->cameras[1], c[k]->x2, c[k]->y2, y2);
        depths[k] = inverse_depth(m, rays + 3 * k, y2);
    }
    return plane_of(rays, depths, n);
}

static void find_near(const asj_pairs *set, const asj_model *m, asj_adjust_scratch *scratch, neighbourhood *near)
{
    const asj_peaks peaks = asj_likelihood_peaks(set, &m->view, LOOSE);
    asj_probabilities(set, &m->view, LOOSE, &scratch->score, scratch->probability);
    near->count = 0;
    for (int32_t k = 0; k < set->count && near->count < MOST_NEAR; k++)
        if (scratch->probability[k] > POSSIBLE)
            near->list[near->count++] = (near_one){.pair = &set->list[k], .probability = scratch->probability[k],
                                                   .ratio = asj_likelihood_ratio(&m->view, set, &set->list[k], &peaks, NULL)};
}

static double gain(const near_one *o, double ratio)
{
    return asj_log_normal(1 + o->probability * (ratio / o->ratio - 1));
}

/* All hypotheses of one plane more share what the motion and its planes so far say. Returns the peaks of their likelihoods. */
static asj_peaks prepare_gains(const asj_pairs *set, const asj_model *model, neighbourhood *near)
{
    asj_two_view more = model->view;
    more.plane_count++;
    const asj_peaks peaks = asj_likelihood_peaks(set, &more, LOOSE);
    for (int32_t k = 0; k < near->count; k++) {
        near_one *o = &near->list[k];
        o->before = asj_likelihood_ratio(&model->view, set, o->pair, &peaks, NULL);
        o->without = gain(o, o->before);
    }
    return peaks;
}

static int32_t with_plane(const asj_model *model, const double n[3], asj_model *more)
{
    *more = *model;
    memcpy(more->planes[model->view.plane_count], n, sizeof more->planes[0]);
    more->view.plane_count++;
    more->parameters += 3;
    return asj_model_complete(more);
}

/* How much likelier the near candidates are with the last plane, roughly: each place by itself. */
static double gain_of(const asj_pairs *set, const asj_model *more, const asj_peaks *peaks, const neighbourhood *near)
{
    double sum = 0;
    for (int32_t k = 0; k < near->count; k++) {
        const near_one *o = &near->list[k];
        const double ratio = asj_part_ratio(&more->view, more->view.plane_count, set, o->pair, peaks);
        sum += ratio > 0 ? gain(o, o->before + ratio) : o->without;
    }
    return sum;
}

static int32_t best_plane(const asj_pairs *set, const asj_model *model, neighbourhood *near, asj_model *best)
{
    const asj_peaks peaks = prepare_gains(set, model, near);
    double most = 0;
    for (int32_t k = 0, starts = 0; k < near->count && starts < MOST_PLANE_STARTS; k++) {
        if (near->list[k].probability < PROBABLE)
            continue;
        starts++;
        for (int32_t way = 0; way < 2; way++) {
            double n[3];
            asj_model more;
            if (!(way == 0 ? plane_of_one(model, near->list[k].pair, n) : plane_of_three(model, near, k, n)) ||
                !with_plane(model, n, &more))
                continue;
            const double sum = gain_of(set, &more, &peaks, near);
            if (sum > most) {
                most = sum;
                *best = more;
            }
        }
    }
    return most > 0;
}

void asj_add_planes(const asj_pairs *set, asj_model *model, asj_adjust_scratch *scratch)
{
    neighbourhood near;
    asj_model best;
    while (model->view.plane_count < ASJ_MOST_PLANES) {
        find_near(set, model, scratch, &near);
        if (!best_plane(set, model, &near, &best))
            break;
        asj_adjust(set, &best, ROUNDS, scratch);
        best.evidence = asj_log_evidence(set, &best, scratch);
        if (!(best.evidence > model->evidence))
            break;
        *model = best;
    }
}
