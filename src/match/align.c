/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, alignment: the affine map of a candidate pair, refined on the images.
 *
 * The map from branch ends is as wrong as the ends are: 5 % in a length, a degree in a direction. For a true pair a few
 * Gauss-Newton steps on a disc around the junction find the map under which both images agree; for a false one nothing is
 * found. Afterwards the correlation tells them apart far better than before, the map predicts where neighbours must be
 * (consensus.c), and the location in the other image is good to a fraction of a pixel.
 *
 * Inverse compositional form (Baker and Matthews 2004): derivatives belong to the template and are computed once for each location,
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

#define GRID_SIDE (2 * ASJ_DISC_RADIUS + 3) /* one sample more each way, for differences */

/* The normal equations. Their sums are of a template of unit norm: curvatures are in 1/px^2, about (1/20)^2 to 1 for texture. */
#define DAMPING 0.01          /* Levenberg: part of the mean curvature in t_x and t_y */
#define DAMPING_FLOOR 1e-6    /* 1/px^2: keeps the equations of a flat disc regular */
#define LEAST_PIVOT 1e-12     /* a millionth of that floor: below it only rounding is left */
#define LEAST_ENERGY 1e-12f   /* of a template of unit norm; a flat one has less */

/* One step. */
#define CONVERGED 0.02        /* px at the centre, and px at the disc's border for the linear part: an order below what locations
                               * are good to */
#define MOST_STEPS 2.0        /* samples: the farthest that one step moves the centre; farther out the linearisation says nothing */
#define LEAST_INCREMENT 0.3   /* determinant of a step's linear part: a step that changes the area threefold is no small one */
#define MOST_INCREMENT 3.0

/* The result. A frame whose two lengths are wrong by a factor of 1.58 each, far beyond any true pair, is 2.5 in area. */
#define LEAST_AREA_CHANGE 0.4 /* of the map's area, against the start */
#define MOST_AREA_CHANGE 2.5

/* Floors of 1 - similarity and of the squared canonical distance 2 (1 - similarity): 0.01 in either distance, which is what grey
 * levels of 8 bits leave of identical patches. */
#define LEAST_UNLIKENESS 1e-4f
#define LEAST_DISTANCE2 2e-4f

/* Pairs without a usable disc (similarity -1), or whose discs are each other's negatives, would only slow the consensus down. */
#define LEAST_SIMILARITY (-0.5f)

/* Three quarters of a disc must lie in the image: as for patches (patch.h). */
static int32_t inside_enough(int32_t inside, int32_t all)
{
    return 4 * inside >= 3 * all;
}

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
            else if (s > LEAST_PIVOT)
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
    float along = product(descent, value) / (energy + LEAST_ENERGY);
    for (int32_t i = 0; i < ASJ_DISC_SAMPLES; i++)
        descent[i] = (descent[i] - along * value[i]) * scale;
}

void asj_template_create(const asj_disc *disc, const asj_pyramid *pyramid, double x, double y, asj_template *t)
{
    uint16_t grid[GRID_SIDE * GRID_SIDE];
    t->x = x;
    t->y = y;
    t->usable = inside_enough(sample_grid(disc, pyramid, x, y, grid), GRID_SIDE * GRID_SIDE);
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
    double damping = DAMPING * 0.5 * (t->factor[0] + t->factor[7]) + DAMPING_FLOOR;
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

static double determinant(const double m[4])
{
    return m[0] * m[3] - m[1] * m[2];
}

static asj_disc_map map_of(const asj_disc *disc, const asj_pyramid *source, const asj_disc_pose *pose)
{
    const double *l = pose->linear, area = fabs(determinant(l));
    return (asj_disc_map){asj_pyramid_level(source, area * (double)disc->step * (double)disc->step), (float)pose->x,
                          (float)pose->y, {(float)l[0], (float)l[1], (float)l[2], (float)l[3]}};
}

/* One step: the map followed by the inverse of the increment. Returns 0 when nothing is left to gain or the increment is wild. */
static int32_t step(const asj_disc *disc, const asj_template *t, const float descent[6], asj_disc_pose *pose)
{
    double b[6];
    for (int32_t k = 0; k < 6; k++)
        b[k] = (double)descent[k];
    solve(t->factor, b);
    const double radius = (double)disc->radius, limit = MOST_STEPS * (double)disc->step;
    const double length = sqrt(b[0] * b[0] + b[1] * b[1]), change = fabs(b[2]) + fabs(b[3]) + fabs(b[4]) + fabs(b[5]);
    if (length < CONVERGED && change < CONVERGED)
        return 0;
    const double shorten = length > limit ? limit / length : 1;
    const double increment[4] = {1 + b[2] / radius, b[3] / radius, b[4] / radius, 1 + b[5] / radius};
    const double area = determinant(increment);
    double inverse[4];
    if (!(area > LEAST_INCREMENT && area < MOST_INCREMENT) || !asj_affine_invert(increment, inverse))
        return 0;
    const double tx = -(inverse[0] * b[0] + inverse[1] * b[1]) * shorten, ty = -(inverse[2] * b[0] + inverse[3] * b[1]) * shorten;
    double *l = pose->linear;
    pose->x += l[0] * tx + l[1] * ty;
    pose->y += l[2] * tx + l[3] * ty;
    const double next[4] = {l[0] * inverse[0] + l[1] * inverse[2], l[0] * inverse[1] + l[1] * inverse[3],
                            l[2] * inverse[0] + l[3] * inverse[2], l[2] * inverse[1] + l[3] * inverse[3]};
    memcpy(l, next, sizeof next);
    return 1;
}

/* Did the alignment stay where it may? */
static int32_t within_limits(const asj_disc_pose *start, const asj_disc_pose *end, double max_move)
{
    const double area = determinant(end->linear) / determinant(start->linear), dx = end->x - start->x, dy = end->y - start->y;
    return area >= LEAST_AREA_CHANGE && area <= MOST_AREA_CHANGE && dx * dx + dy * dy <= max_move * max_move;
}

asj_alignment asj_align(const asj_aligner *aligner, const asj_template *t, const asj_pyramid *source, const asj_disc_pose *start)
{
    const asj_disc *disc = aligner->disc;
    asj_disc_pose now = *start;
    asj_alignment best = {*start, 0, 0, 0};
    int32_t best_inside = 0;
    for (int32_t n = 0; n <= aligner->iterations; n++) {
        const asj_disc_map map = map_of(disc, source, &now);
        asj_disc_sums sums;
        source->ops->disc->compare(disc, t, source, &map, &sums);
        if (n == 0 || sums.similarity > best.similarity) {
            best = (asj_alignment){now, n == 0 ? sums.similarity : best.first, sums.similarity, n > 0};
            best_inside = sums.inside;
        }
        if (n == aligner->iterations || !t->solvable || !step(disc, t, sums.descent, &now))
            break;
    }
    if (!within_limits(start, &best.pose, aligner->max_move) || !inside_enough(best_inside, disc->count))
        best = (asj_alignment){*start, best.first, best.first, 0};
    return best;
}

/* --- all candidates --------------------------------------------------------------------------------------------------------- */

/* The image whose corner is smaller: 0 or 1. */
static int32_t template_side(const asj_candidate *c)
{
    return determinant(c->map.to) >= determinant(c->map.from) ? 0 : 1;
}

/* sqrt(d_c d_r): the geometric mean of the canonical distance and of the aligned one, floored; squared. */
static float combine(float canonical2, float similarity)
{
    const float rest = 1 - similarity > LEAST_UNLIKENESS ? 1 - similarity : LEAST_UNLIKENESS;
    const float canonical = canonical2 > LEAST_DISTANCE2 ? canonical2 : LEAST_DISTANCE2;
    return sqrtf(canonical * 2 * rest);
}

/* `side` is the image of the template. */
static void align_one(const asj_match_run *run, const asj_aligner *aligner, const asj_template *t, int32_t side, asj_candidate *c)
{
    if (!t->usable) {
        c->similarity = -1;
    } else {
        const asj_l_junction *l = asj_match_run_l(run, c, 1 - side);
        const double *map = asj_candidate_map(c, side);
        const asj_disc_pose start = {(double)l->x, (double)l->y, {map[0], map[1], map[2], map[3]}};
        const asj_alignment found = asj_align(aligner, t, &run->image[1 - side]->pyramid, &start);
        asj_linear forth;
        c->similarity = found.similarity;
        if (found.moved && asj_affine_invert(found.pose.linear, forth.from)) {
            double *move = side == 0 ? c->move2 : c->move1;
            memcpy(forth.to, found.pose.linear, sizeof forth.to);
            memcpy(c->map.to, side == 0 ? forth.to : forth.from, sizeof forth.to);
            memcpy(c->map.from, side == 0 ? forth.from : forth.to, sizeof forth.to);
            move[0] = found.pose.x - start.x;
            move[1] = found.pose.y - start.y;
        }
    }
    c->distance2 = combine(c->distance2, c->similarity);
}

static void drop_unlike(asj_match_run *run, size_t first)
{
    asj_candidates *candidates = &run->candidates;
    size_t kept = first;
    for (size_t k = first; k < candidates->count; k++)
        if (candidates->list[k].similarity >= LEAST_SIMILARITY)
            candidates->list[kept++] = candidates->list[k];
    candidates->count = kept;
}

/* Candidates by the location of their template, those of image 1 before those of image 2: order[start[p]] .. are those of
 * location p, as numbers from `first` on. They are worked on together, so that each template is made once. */
typedef struct grouping {
    uint32_t *start, *order, *group;
} grouping;

static void group_by_template(const asj_match_run *run, size_t first, const grouping *g)
{
    const size_t count = run->candidates.count - first;
    const uint32_t count1 = run->image[0]->l_junctions.location_count;
    const uint32_t locations = count1 + run->image[1]->l_junctions.location_count;
    for (size_t k = 0; k < count; k++) {
        const asj_candidate *c = &run->candidates.list[first + k];
        const int32_t side = template_side(c);
        g->group[k] = (side ? count1 : 0) + run->image[side]->l_junctions.location[asj_candidate_l(c, side)];
        g->start[g->group[k] + 2]++;
    }
    for (uint32_t p = 2; p < locations + 2; p++)
        g->start[p] += g->start[p - 1];
    for (size_t k = 0; k < count; k++)
        g->order[g->start[g->group[k] + 1]++] = (uint32_t)k;
}

static void align_groups(asj_match_run *run, size_t first, const grouping *g, const asj_aligner *aligner)
{
    const int64_t count1 = run->image[0]->l_junctions.location_count;
    const int64_t locations = count1 + run->image[1]->l_junctions.location_count;
#pragma omp parallel for num_threads(run->context->threads) schedule(dynamic, 4)
    for (int64_t p = 0; p < locations; p++) {
        asj_template t;
        const int32_t side = p >= count1;
        const asj_image_features *features = run->image[side];
        const int64_t at = side ? p - count1 : p;
        if (g->start[p] == g->start[p + 1])
            continue;
        asj_template_create(aligner->disc, &features->pyramid, features->l_junctions.location_x[at],
                            features->l_junctions.location_y[at], &t);
        for (uint32_t k = g->start[p]; k < g->start[p + 1]; k++)
            align_one(run, aligner, &t, side, &run->candidates.list[first + g->order[k]]);
    }
}

asj_status asj_align_candidates(asj_match_run *run, size_t first)
{
    asj_memory *memory = &run->context->memory;
    const size_t count = run->candidates.count - first;
    const size_t locations = (size_t)run->image[0]->l_junctions.location_count + run->image[1]->l_junctions.location_count;
    const grouping g = {asj_allocate_zero(memory, locations + 2, sizeof *g.start), asj_allocate(memory, count, sizeof *g.order),
                        asj_allocate(memory, count, sizeof *g.group)};
    asj_disc *disc = asj_allocate(memory, 1, sizeof *disc);
    asj_status status = ASJ_OK;
    if (!g.start || !g.order || !g.group || !disc) {
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to align %zu candidates", count);
    } else {
        const asj_aligner aligner = {disc, run->options->align_iterations, run->options->max_move};
        asj_disc_create(run->options->align_radius, disc);
        group_by_template(run, first, &g);
        align_groups(run, first, &g, &aligner);
        drop_unlike(run, first);
    }
    asj_release(memory, g.start);
    asj_release(memory, g.order);
    asj_release(memory, g.group);
    asj_release(memory, disc);
    return status;
}

const asj_disc_ops asj_disc_reference = {.compare = asj_disc_compare};
