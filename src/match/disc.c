/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, discs: what align.c compares. A template is the disc around a location of one image with all that does not depend on the
 * other image: its normalised samples, their derivatives and the factor of the normal equations (align.c says what for).
 *
 * Gain and offset: template and source are both brought to zero mean and unit norm, and the derivatives are made orthogonal to the
 * template and the constant, which is the Gauss-Newton step of correlation. Levenberg damping: DAMPING times the mean curvature in
 * t_x and t_y; the linear part is scaled by the radius, so that the same number fits it.
 *
 * Sums run in ASJ_LANE lanes in a fixed order: the same bits on any machine, and compilers can use vectors. */
#include "disc.h"

#include <math.h>
#include <string.h>

#define GRID_SIDE (2 * ASJ_DISC_RADIUS + 3) /* one sample more each way, for differences */

#define DAMPING 0.01        /* part of the mean curvature */
#define DAMPING_FLOOR 1e-6  /* 1/px^2: keeps the equations of a flat disc regular */
#define LEAST_PIVOT 1e-12   /* a millionth of that floor: below it only rounding is left */
#define LEAST_ENERGY 1e-12f /* a divisor; a template with contrast has unit energy, a flat one none */

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

/* Cholesky, in place, lower triangle; 0 when a pivot is too small. */
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
    t->usable = asj_disc_inside(sample_grid(disc, pyramid, x, y, grid), GRID_SIDE * GRID_SIDE);
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

/* --- comparison ------------------------------------------------------------------------------------------------------------ */

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

const asj_disc_ops asj_disc_reference = {.compare = asj_disc_compare};
