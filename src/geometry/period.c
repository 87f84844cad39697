/* SPDX-License-Identifier: BSD-2-Clause */
/* A floor of tiles that is matched with itself, shifted by a tile, has matches as many and as exact as the right ones, and since
 * all come together, each of them counts for nothing beside the first; evidence counts them one by one. A search for other
 * geometries need not find the right one either: of fifty crossings that look the same the sixteen that a list of candidates has
 * (shortlist.c) are chosen by chance, and for one shift they may be all and for another hardly any.
 *
 * But what repeats shows. With a plane n'X = 1 (coordinates of camera 1) of a motion X2 = R X + t, points of the plane in
 * coordinates of camera 2 lie on n2'X2 = 1, n2 = R n / (1 + t'R n). If what is on the plane repeats by w, which lies in it, the
 * motion R, t + w explains the same matches, each a period farther. So a vector w is looked for by which nearly ALL the matches on
 * a plane have another candidate: one that has their place in image 1 and lies where w takes their place in image 2, or the other
 * way round. And where it takes places of image 2 that are still inside the image, nearly all find something there. Of a plane
 * that ends, or that has anything of its own on it, that is never so. And there must be hardly anything matched ELSEWHERE, which
 * would say which of the shifts it is.
 *
 * Of 85 motions of rendered rooms three have nearly all of their shifted places filled, of which two are wrong; of others that
 * have, two fifths and more of the matches lie elsewhere or have no other candidate (tests/accuracy/tried/geometry.md, "What
 * repeats"). */
#include "period.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define PROBABLE 0.5
#define FEWEST 6         /* matches on a plane */
#define OFF_PLANE 6.0    /* px from where the plane takes a match */
#define ELSEWHERE 3.0    /* matches */
#define SAME_THING 8.0   /* px: what is nearer is no other place */
#define SAME_PERIOD 4.0  /* px */
#define FILLED 5.0       /* px: a place that is taken so near another one finds it */
#define BORDER 5.0       /* px */
#define ALL 0.9
#define MOST_OUTSIDE 0.5 /* of the matches on the plane */
#define STARTS 4         /* matches whose other candidates tell w */

/* Another candidate of a match's place in image `side`. */
typedef struct other {
    int32_t match;
    const asj_pair *pair;
    int32_t side;
} other;

/* A match on the plane, and where w takes it. */
typedef struct on_plane {
    const asj_pair *pair;
    double point[2][3];  /* in coordinates of either camera */
    double taken[2][2];  /* px: its partner in image 1 of the place in image 2, and in image 2 of that in image 1 */
    int32_t is_held;
} on_plane;

typedef struct repeat {
    const asj_pairs *set;
    const asj_model *motion;
    double normal[2][3]; /* n and n2 */
    on_plane *matches;
    other *others;
    int32_t count, other_count, most_others;
} repeat;

/* Where the ray of a pixel meets the plane; 0 behind the camera. */
static int32_t meet(const repeat *r, int32_t side, double x, double y, double point[3])
{
    asj_ray(&r->motion->cameras[side], x, y, point);
    const double inverse = asj_dot3(r->normal[side], point);
    for (int32_t k = 0; k < 3; k++)
        point[k] /= inverse;
    return inverse > 0 && isfinite(point[2]);
}

/* Pixel of a point, moved; far outside behind the camera. */
static void see(const asj_camera *c, const double point[3], const double move[3], double xy[2])
{
    const double z = point[2] + move[2];
    xy[0] = z > 0 ? c->fx * (point[0] + move[0]) / z + c->cx : -HUGE_VAL;
    xy[1] = z > 0 ? c->fy * (point[1] + move[1]) / z + c->cy : -HUGE_VAL;
}

static int32_t set_plane(repeat *r, int32_t plane)
{
    const asj_model *m = r->motion;
    memcpy(r->normal[0], m->planes[plane], sizeof r->normal[0]);
    asj_apply3(m->rotation, r->normal[0], r->normal[1]);
    const double scale = 1 + asj_dot3(r->normal[1], m->translation);
    for (int32_t k = 0; k < 3; k++)
        r->normal[1][k] /= scale;
    return scale > 0;
}

static int is_within(double px, double x, double y)
{
    return x * x + y * y < px * px;
}

/* Is a candidate where the plane takes it? */
static int is_taken(const repeat *r, int32_t plane, const asj_pair *c)
{
    const double *h = r->motion->view.planes[plane], w = h[6] * c->x1 + h[7] * c->y1 + h[8];
    return is_within(OFF_PLANE, (h[0] * c->x1 + h[1] * c->y1 + h[2]) / w - c->x2, (h[3] * c->x1 + h[4] * c->y1 + h[5]) / w - c->y2);
}

/* The matches on a plane; how many there are elsewhere. */
static double collect_matches(repeat *r, int32_t plane, const double *probability)
{
    double elsewhere = 0;
    r->count = 0;
    for (int32_t k = 0; k < r->set->count; k++) {
        const asj_pair *c = &r->set->list[k];
        on_plane *m = &r->matches[r->count];
        if (probability[k] < PROBABLE)
            continue;
        m->pair = c;
        if (is_taken(r, plane, c) && meet(r, 0, c->x1, c->y1, m->point[0]) && meet(r, 1, c->x2, c->y2, m->point[1]))
            r->count++;
        else
            elsewhere += probability[k];
    }
    return elsewhere;
}

static void collect_others(repeat *r)
{
    r->other_count = 0;
    for (int32_t n = 0; n < r->count; n++)
        for (int32_t k = 0; k < r->set->count && r->other_count < r->most_others; k++) {
            const asj_pair *c = &r->set->list[k], *m = r->matches[n].pair;
            if (c->place1 == m->place1 && !is_within(SAME_THING, c->x2 - m->x2, c->y2 - m->y2))
                r->others[r->other_count++] = (other){n, c, 0};
            else if (c->place2 == m->place2 && !is_within(SAME_THING, c->x1 - m->x1, c->y1 - m->y1))
                r->others[r->other_count++] = (other){n, c, 1};
        }
}

/* The w that another candidate of a match speaks for. */
static int32_t period_of(const repeat *r, const other *o, double w[3])
{
    const on_plane *m = &r->matches[o->match];
    const asj_pair *c = o->pair;
    double point[3], move[3];
    if (!(o->side == 0 ? meet(r, 1, c->x2, c->y2, point) : meet(r, 0, c->x1, c->y1, point)))
        return 0;
    if (o->side == 0) {
        for (int32_t k = 0; k < 3; k++)
            w[k] = point[k] - m->point[1][k];
        return 1;
    }
    for (int32_t k = 0; k < 3; k++)
        move[k] = m->point[0][k] - point[k];
    asj_apply3(r->motion->rotation, move, w);
    return 1;
}

/* How many matches on the plane have another candidate by w. */
static int32_t held_by(repeat *r, const double w[3])
{
    const double *turn = r->motion->rotation;
    double back[3]; /* -R' w, by which the places of image 1 move */
    int32_t held = 0;
    for (int32_t k = 0; k < 3; k++)
        back[k] = -(turn[k] * w[0] + turn[3 + k] * w[1] + turn[6 + k] * w[2]);
    for (int32_t n = 0; n < r->count; n++) {
        on_plane *m = &r->matches[n];
        see(&r->motion->cameras[1], m->point[1], w, m->taken[0]);
        see(&r->motion->cameras[0], m->point[0], back, m->taken[1]);
        m->is_held = 0;
    }
    for (int32_t k = 0; k < r->other_count; k++) {
        const other *o = &r->others[k];
        on_plane *m = &r->matches[o->match];
        const double x = o->side == 0 ? o->pair->x2 : o->pair->x1, y = o->side == 0 ? o->pair->y2 : o->pair->y1;
        if (m->is_held || !is_within(SAME_PERIOD, x - m->taken[o->side][0], y - m->taken[o->side][1]))
            continue;
        m->is_held = 1;
        held++;
    }
    return held;
}

/* Is there anything in image 2 where the matches were taken, as far as that is inside? */
static int32_t is_filled(const repeat *r)
{
    const double right = 2 * r->set->middle[1][0] - BORDER, bottom = 2 * r->set->middle[1][1] - BORDER;
    int32_t inside = 0, filled = 0;
    for (int32_t n = 0; n < r->count; n++) {
        const double x = r->matches[n].taken[0][0], y = r->matches[n].taken[0][1];
        int32_t found = 0;
        if (!(x > BORDER && y > BORDER && x < right && y < bottom))
            continue;
        for (int32_t k = 0; k < r->set->count && !found; k++)
            found = is_within(FILLED, r->set->list[k].x2 - x, r->set->list[k].y2 - y);
        inside++;
        filled += found;
    }
    return inside >= MOST_OUTSIDE * r->count && filled >= ALL * inside;
}

/* The w that most matches have another candidate by; how many that are. */
static int32_t find_best(repeat *r, double best[3])
{
    int32_t most = 0;
    for (int32_t k = 0; k < r->other_count; k++) {
        double w[3];
        if (r->others[k].match % ((r->count + STARTS - 1) / STARTS) != 0 || !period_of(r, &r->others[k], w))
            continue;
        const int32_t held = held_by(r, w);
        if (held > most) {
            most = held;
            memcpy(best, w, sizeof w);
        }
    }
    return most;
}

/* t + w, of length 1, and the planes with it. */
static int32_t shift(const asj_model *motion, const double w[3], asj_model *shifted)
{
    *shifted = *motion;
    shifted->settled = 0;
    for (int32_t k = 0; k < 3; k++)
        shifted->translation[k] += w[k];
    const double length = sqrt(asj_dot3(shifted->translation, shifted->translation));
    for (int32_t k = 0; k < 3; k++)
        shifted->translation[k] /= length;
    for (int32_t k = 0; k < 3 * shifted->view.plane_count; k++)
        shifted->planes[k / 3][k % 3] *= length;
    return length > 0 && asj_model_complete(shifted);
}

static int32_t repeats(repeat *r, int32_t plane, const double *probability, asj_model *shifted)
{
    double w[3];
    if (!set_plane(r, plane) || collect_matches(r, plane, probability) >= ELSEWHERE || r->count < FEWEST)
        return 0;
    collect_others(r);
    if (find_best(r, w) < ALL * r->count)
        return 0;
    held_by(r, w);
    return is_filled(r) && shift(r->motion, w, shifted);
}

int32_t asj_find_period(asj_memory *memory, const asj_pairs *set, const asj_model *motion, const double *probability,
                        asj_model *shifted)
{
    repeat r = {.set = set, .motion = motion, .most_others = 4 * set->count};
    int32_t found = 0;
    r.matches = asj_allocate(memory, (size_t)set->count, sizeof *r.matches);
    r.others = asj_allocate(memory, (size_t)r.most_others, sizeof *r.others);
    if (!r.matches || !r.others)
        found = -1;
    for (int32_t plane = 0; plane < motion->view.plane_count && found == 0; plane++)
        found = repeats(&r, plane, probability, shifted);
    asj_release(memory, r.matches);
    asj_release(memory, r.others);
    return found;
}
