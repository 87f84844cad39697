/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, alignment: the affine map of a candidate pair, refined on the images.
 *
 * The map from branch ends is as wrong as the ends are: 5 % in a length, a degree in a direction. For a true pair a few
 * Gauss-Newton steps on a disc around the junction find the map under which both images agree; for a false one nothing is
 * found. Afterwards the correlation tells them apart far better than before, the map predicts where neighbours must be
 * (consensus.c), and the location in the other image is good to a fraction of a pixel.
 *
 * Inverse compositional form (Baker and Matthews 2004): derivatives belong to the template and are computed once for each place,
 * and a step costs one sampling and eight products. Gain and offset: template and source are both brought to zero mean and unit
 * norm, and the derivatives are made orthogonal to the template and the constant, which is the Gauss-Newton step of correlation.
 * Levenberg damping: 1 % of the mean curvature in t_x and t_y; the linear part is scaled by the radius, so that the same number
 * fits it.
 *
 * Which image is the template: the one in which the corner is smaller (asj_align_candidates), so that the other is sampled
 * down, never up, and swapping the images changes nothing.
 *
 * Sums run in ASJ_LANE lanes in a fixed order: the same bits on any machine, and compilers can use vectors. */
#include "align.h"

#include <math.h>
#include <string.h>

#define DAMPING 0.01
#define GRID_SIDE (2 * ASJ_DISC_RADIUS + 3)
#define LEAST_AREA_CHANGE 0.4 /* of the map's area, against the start */
#define MOST_AREA_CHANGE 2.5

void asj_disc_create(double radius, asj_disc *disc)
{
    int32_t count = 0;
    memset(disc, 0, sizeof *disc);
    disc->radius = (float)radius;
    disc->step = (float)(radius / ASJ_DISC_RADIUS);
    for (int32_t j = -ASJ_DISC_RADIUS; j <= ASJ_DISC_RADIUS; j++)
        for (int32_t i = -ASJ_DISC_RADIUS; i <= ASJ_DISC_RADIUS; i++)
            if (i * i + j * j <= ASJ_DISC_RADIUS * ASJ_DISC_RADIUS) {
                disc->x[count] = (float)i * disc->step;
                disc->y[count] = (float)j * disc->step;
                disc->mask[count] = 1;
                disc->column[count] = (int16_t)(i + ASJ_DISC_RADIUS + 1);
                disc->row[count] = (int16_t)(j + ASJ_DISC_RADIUS + 1);
                count++;
            }
    disc->count = count;
    for (int32_t i = count; i < ASJ_DISC_SAMPLES; i++)
        disc->column[i] = disc->row[i] = ASJ_DISC_RADIUS + 1;
}

/* Lanes are added pairwise at the end. */
static float fold(const float lane[ASJ_LANE])
{
    return ((lane[0] + lane[4]) + (lane[2] + lane[6])) + ((lane[1] + lane[5]) + (lane[3] + lane[7]));
}

static float product(const float *a, const float *b)
{
    float lane[ASJ_LANE] = {0};
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE)
        for (int32_t l = 0; l < ASJ_LANE; l++)
            lane[l] += a[i + l] * b[i + l];
    return fold(lane);
}

static float sum(const float *a)
{
    float lane[ASJ_LANE] = {0};
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i += ASJ_LANE)
        for (int32_t l = 0; l < ASJ_LANE; l++)
            lane[l] += a[i + l];
    return fold(lane);
}

/* Zero mean over the disc, unit norm with a floor of one grey level; zero in the filling. Returns the norm with the floor. */
static float normalise(const asj_disc *disc, float *value)
{
    float mean = sum(value) / (float)disc->count;
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i++)
        value[i] = (value[i] - mean) * disc->mask[i];
    float norm = sqrtf(product(value, value)) + ASJ_GRAY_ONE * sqrtf((float)disc->count);
    float scale = 1 / norm;
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i++)
        value[i] *= scale;
    return norm;
}

/* --- normal equations ------------------------------------------------------------------------------------------------------- */

static int32_t factorise(double a[36])
{
    for (int32_t i = 0; i < 6; i++)
        for (int32_t j = 0; j <= i; j++) {
            double s = a[6 * i + j];
            for (int32_t k = 0; k < j; k++)
                s -= a[6 * i + k] * a[6 * j + k];
            if (i != j)
                a[6 * i + j] = s / a[6 * j + j];
            else if (s > 1e-12)
                a[6 * i + i] = sqrt(s);
            else
                return 0;
        }
    return 1;
}

static void solve(const double a[36], double b[6])
{
    for (int32_t i = 0; i < 6; i++) {
        for (int32_t k = 0; k < i; k++)
            b[i] -= a[6 * i + k] * b[k];
        b[i] /= a[6 * i + i];
    }
    for (int32_t i = 5; i >= 0; i--) {
        for (int32_t k = i + 1; k < 6; k++)
            b[i] -= a[6 * k + i] * b[k];
        b[i] /= a[6 * i + i];
    }
}

/* --- template --------------------------------------------------------------------------------------------------------------- */

static int32_t sample_grid(const asj_disc *disc, const asj_pyramid *pyramid, double x, double y, uint16_t *grid)
{
    float grid_x[GRID_SIDE * GRID_SIDE], grid_y[GRID_SIDE * GRID_SIDE];
    const int32_t level = asj_pyramid_level(pyramid, (double)disc->step * (double)disc->step);
    for (int32_t j = 0; j < GRID_SIDE; j++)
        for (int32_t i = 0; i < GRID_SIDE; i++) {
            grid_x[j * GRID_SIDE + i] = (float)x + (float)(i - ASJ_DISC_RADIUS - 1) * disc->step;
            grid_y[j * GRID_SIDE + i] = (float)y + (float)(j - ASJ_DISC_RADIUS - 1) * disc->step;
        }
    return asj_pyramid_sample(pyramid, level, grid_x, grid_y, GRID_SIDE * GRID_SIDE, grid);
}

/* Makes a derivative orthogonal to the constant and to the template, in units of the normalised template. */
static void project(const asj_disc *disc, const float *value, float energy, float scale, float *descent)
{
    float mean = sum(descent) / (float)disc->count;
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i++)
        descent[i] = (descent[i] - mean) * disc->mask[i];
    float along = product(descent, value) / (energy + 1e-12f);
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i++)
        descent[i] = (descent[i] - along * value[i]) * scale;
}

void asj_template_create(const asj_disc *disc, const asj_pyramid *pyramid, double x, double y, asj_template *t)
{
    uint16_t grid[GRID_SIDE * GRID_SIDE];
    t->x = x;
    t->y = y;
    t->usable = 4 * sample_grid(disc, pyramid, x, y, grid) >= 3 * GRID_SIDE * GRID_SIDE;
    const float half = 0.5f / disc->step, inverse = 1 / disc->radius;
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i++) {
        const uint16_t *p = grid + disc->row[i] * GRID_SIDE + disc->column[i];
        float gx = (float)(p[1] - p[-1]) * half * disc->mask[i], gy = (float)(p[GRID_SIDE] - p[-GRID_SIDE]) * half * disc->mask[i];
        float u = disc->x[i] * inverse, v = disc->y[i] * inverse;
        t->value[i] = (float)p[0] * disc->mask[i];
        t->descent[0][i] = gx;
        t->descent[1][i] = gy;
        t->descent[2][i] = gx * u;
        t->descent[3][i] = gx * v;
        t->descent[4][i] = gy * u;
        t->descent[5][i] = gy * v;
    }
    float scale = 1 / normalise(disc, t->value), energy = product(t->value, t->value);
    for (int32_t k = 0; k < 6; k++)
        project(disc, t->value, energy, scale, t->descent[k]);
    for (int32_t i = 0; i < 6; i++)
        for (int32_t j = 0; j <= i; j++)
            t->factor[6 * i + j] = (double)product(t->descent[i], t->descent[j]);
    double damping = DAMPING * 0.5 * (t->factor[0] + t->factor[7]) + 1e-6;
    for (int32_t i = 0; i < 6; i++)
        t->factor[7 * i] += damping;
    t->solvable = factorise(t->factor);
}

/* --- alignment -------------------------------------------------------------------------------------------------------------- */

static int32_t sample_source(const asj_disc *disc, const asj_pyramid *pyramid, const asj_disc_map *map, float *value)
{
    float x[ASJ_DISC_SAMPLES], y[ASJ_DISC_SAMPLES];
    uint16_t grey[ASJ_DISC_SAMPLES];
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i++) {
        x[i] = map->x + map->linear[0] * disc->x[i] + map->linear[1] * disc->y[i];
        y[i] = map->y + map->linear[2] * disc->x[i] + map->linear[3] * disc->y[i];
    }
    const int32_t inside = asj_pyramid_sample(pyramid, map->level, x, y, disc->count, grey);
    for (int32_t i = 0; i < disc->count; i++)
        value[i] = (float)grey[i];
    for (int32_t i = disc->count; i < ASJ_DISC_SAMPLES; i++)
        value[i] = 0;
    return inside;
}

void asj_disc_compare(const asj_disc *disc, const asj_template *t, const asj_pyramid *pyramid, const asj_disc_map *map,
                      asj_disc_sums *sums)
{
    float value[ASJ_DISC_SAMPLES];
    sums->inside = sample_source(disc, pyramid, map, value);
    normalise(disc, value);
    sums->similarity = product(value, t->value);
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i++)
        value[i] -= t->value[i];
    for (int32_t k = 0; k < 6; k++)
        sums->descent[k] = product(t->descent[k], value);
}

static asj_disc_map map_of(const asj_disc *disc, const asj_pyramid *pyramid, const asj_alignment *now)
{
    const double *l = now->linear, area = fabs(l[0] * l[3] - l[1] * l[2]);
    return (asj_disc_map){asj_pyramid_level(pyramid, area * (double)disc->step * (double)disc->step), (float)now->x, (float)now->y,
                          {(float)l[0], (float)l[1], (float)l[2], (float)l[3]}};
}

/* One step: the map followed by the inverse of the increment. Returns 0 when nothing is left to gain or the increment is wild. */
static int32_t step(const asj_disc *disc, const asj_template *t, const float descent[6], asj_alignment *now)
{
    double b[6];
    for (int32_t k = 0; k < 6; k++)
        b[k] = (double)descent[k];
    solve(t->factor, b);
    const double radius = (double)disc->radius, limit = 2 * (double)disc->step;
    double length = sqrt(b[0] * b[0] + b[1] * b[1]), change = fabs(b[2]) + fabs(b[3]) + fabs(b[4]) + fabs(b[5]);
    if (length < 0.02 && change < 0.02)
        return 0;
    double shorten = length > limit ? limit / length : 1;
    const double increment[4] = {1 + b[2] / radius, b[3] / radius, b[4] / radius, 1 + b[5] / radius};
    double determinant = increment[0] * increment[3] - increment[1] * increment[2], inverse[4];
    if (!(determinant > 0.3 && determinant < 3) || !asj_affine_invert(increment, inverse))
        return 0;
    double tx = -(inverse[0] * b[0] + inverse[1] * b[1]) * shorten, ty = -(inverse[2] * b[0] + inverse[3] * b[1]) * shorten;
    double *l = now->linear;
    now->x += l[0] * tx + l[1] * ty;
    now->y += l[2] * tx + l[3] * ty;
    double next[4] = {l[0] * inverse[0] + l[1] * inverse[2], l[0] * inverse[1] + l[1] * inverse[3],
                      l[2] * inverse[0] + l[3] * inverse[2], l[2] * inverse[1] + l[3] * inverse[3]};
    memcpy(l, next, sizeof next);
    return 1;
}

void asj_align(const asj_disc *disc, const asj_template *t, const asj_pyramid *pyramid, const double linear[4], double x, double y,
               int32_t iterations, double max_move, asj_alignment *result)
{
    const asj_alignment start = {x, y, {linear[0], linear[1], linear[2], linear[3]}, 0, 0, 0};
    asj_alignment now = start;
    int32_t best_inside = 0;
    *result = start;
    for (int32_t n = 0; n <= iterations; n++) {
        const asj_disc_map map = map_of(disc, pyramid, &now);
        asj_disc_sums sums;
        pyramid->ops->disc->compare(disc, t, pyramid, &map, &sums);
        if (n == 0 || sums.similarity > result->similarity) {
            float first = n == 0 ? sums.similarity : result->first;
            *result = now;
            result->first = first;
            result->similarity = sums.similarity;
            result->moved = n > 0;
            best_inside = sums.inside;
        }
        if (n == iterations || !t->solvable || !step(disc, t, sums.descent, &now))
            break;
    }
    const double *l = result->linear;
    double area = (l[0] * l[3] - l[1] * l[2]) / (linear[0] * linear[3] - linear[1] * linear[2]);
    double dx = result->x - x, dy = result->y - y;
    if (!(area >= LEAST_AREA_CHANGE && area <= MOST_AREA_CHANGE && dx * dx + dy * dy <= max_move * max_move) ||
        4 * best_inside < 3 * disc->count) { /* the start is what remains */
        float first = result->first;
        *result = start;
        result->first = result->similarity = first;
    }
}

/* --- all candidates --------------------------------------------------------------------------------------------------------- */

static int32_t template_is_first(const asj_candidate *c)
{
    const double *to = c->map.to, *from = c->map.from;
    return to[0] * to[3] - to[1] * to[2] >= from[0] * from[3] - from[1] * from[2];
}

/* sqrt(d_c d_r): the geometric mean of the canonical distance and of the aligned one, floored; squared. */
static float combine(float canonical2, float similarity)
{
    float rest = 1 - similarity > 1e-4f ? 1 - similarity : 1e-4f;
    float canonical = canonical2 > 2e-4f ? canonical2 : 2e-4f;
    return sqrtf(canonical * 2 * rest);
}

static void align_one(const asj_disc *disc, const asj_match_options *options, const asj_template *t, int32_t first,
                      const asj_view *view1, const asj_view *view2, asj_candidate *c)
{
    const asj_view *source = first ? view2 : view1;
    const asj_l_junction *l = first ? &view2->corners.l[c->j] : &view1->corners.l[c->i];
    asj_alignment result;
    if (!t->usable) {
        c->similarity = -1;
    } else {
        asj_align(disc, t, &source->pyramid, first ? c->map.to : c->map.from, (double)l->x, (double)l->y,
                  options->align_iterations, options->max_move, &result);
        c->similarity = result.similarity;
        asj_linear map;
        if (result.moved && asj_affine_invert(result.linear, map.from)) {
            double *move = first ? c->move2 : c->move1;
            memcpy(map.to, result.linear, sizeof map.to);
            memcpy(c->map.to, first ? map.to : map.from, sizeof map.to);
            memcpy(c->map.from, first ? map.from : map.to, sizeof map.to);
            move[0] = result.x - (double)l->x;
            move[1] = result.y - (double)l->y;
        }
    }
    c->distance2 = combine(c->distance2, c->similarity);
}

/* Pairs without a usable disc (similarity -1), or whose discs are each other's negatives, would only slow the consensus down. */
static void drop_unlike(asj_candidates *candidates, size_t first)
{
    const float least = -0.5f;
    size_t kept = first;
    for (size_t k = first; k < candidates->count; k++)
        if (candidates->list[k].similarity >= least)
            candidates->list[kept++] = candidates->list[k];
    candidates->count = kept;
}

/* Candidates whose template stands at the same place are worked on together: `order` lists them place by place. */
asj_status asj_align_candidates(asj_context *context, const asj_match_options *options, const asj_view *view1,
                                const asj_view *view2, asj_candidates *candidates, size_t first)
{
    const uint32_t places1 = view1->corners.place_count, places = places1 + view2->corners.place_count;
    asj_memory *memory = &context->memory;
    const size_t count = candidates->count - first;
    uint32_t *start = asj_allocate_zero(memory, (size_t)places + 2, sizeof *start);
    uint32_t *order = asj_allocate(memory, count, sizeof *order), *group = asj_allocate(memory, count, sizeof *group);
    asj_disc *disc = asj_allocate(memory, 1, sizeof *disc);
    if (!start || !order || !group || !disc) {
        asj_release(memory, start);
        asj_release(memory, order);
        asj_release(memory, group);
        asj_release(memory, disc);
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory to align %zu candidates", count);
    }
    asj_disc_create(options->align_radius, disc);
    for (size_t k = 0; k < count; k++) {
        const asj_candidate *c = &candidates->list[first + k];
        group[k] = template_is_first(c) ? view1->corners.place[c->i] : places1 + view2->corners.place[c->j];
        start[group[k] + 2]++;
    }
    for (uint32_t p = 2; p < places + 2; p++)
        start[p] += start[p - 1];
    for (size_t k = 0; k < count; k++)
        order[start[group[k] + 1]++] = (uint32_t)k;
#pragma omp parallel for num_threads(context->threads) schedule(dynamic, 4)
    for (int64_t p = 0; p < (int64_t)places; p++) {
        asj_template t;
        const int32_t in_first = p < (int64_t)places1;
        const asj_view *view = in_first ? view1 : view2;
        const size_t place = in_first ? (size_t)p : (size_t)p - places1;
        if (start[p] == start[p + 1])
            continue;
        asj_template_create(disc, &view->pyramid, view->corners.place_x[place], view->corners.place_y[place], &t);
        for (uint32_t k = start[p]; k < start[p + 1]; k++)
            align_one(disc, options, &t, in_first, view1, view2, &candidates->list[first + order[k]]);
    }
    asj_release(memory, start);
    asj_release(memory, order);
    asj_release(memory, group);
    asj_release(memory, disc);
    drop_unlike(candidates, first);
    return ASJ_OK;
}

const asj_disc_ops asj_disc_reference = {.compare = asj_disc_compare};
