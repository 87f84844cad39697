/* SPDX-License-Identifier: BSD-2-Clause */
/* Discs around locations, and their comparison under an affine map. */
#ifndef ASJ_SRC_DISC_H
#define ASJ_SRC_DISC_H

#include "core/pyramid.h"

/* Samples of a disc: a grid of ASJ_DISC_RADIUS steps each way, in lanes. */
#define ASJ_DISC_RADIUS 10
#define ASJ_LANE 8
#define ASJ_DISC_SAMPLES 320 /* 317 in the disc, filled up to whole lanes */

typedef struct asj_disc {
    int32_t count;                   /* 317 */
    float x[ASJ_DISC_SAMPLES];       /* px from the centre */
    float y[ASJ_DISC_SAMPLES];
    float mask[ASJ_DISC_SAMPLES];    /* 1, and 0 in the filling */
    int16_t column[ASJ_DISC_SAMPLES];/* of the grid */
    int16_t row[ASJ_DISC_SAMPLES];
    float step, radius;              /* px */
} asj_disc;

/* What is known about the disc around one location, once for all its candidates. */
typedef struct asj_template {
    float value[ASJ_DISC_SAMPLES];      /* zero mean, unit norm */
    float descent[6][ASJ_DISC_SAMPLES]; /* change of the normalised sample with t_x, t_y, and the linear part times radius */
    double factor[36];                  /* Cholesky factor of their damped normal equations */
    int32_t usable;                     /* three quarters lie in the image */
    int32_t solvable;
} asj_template;

void asj_disc_create(double radius, asj_disc *disc);
void asj_template_create(const asj_disc *disc, const asj_pyramid *pyramid, double x, double y, asj_template *t);

/* Where the samples of the disc lie in the source: (x, y) + linear sample. */
typedef struct asj_disc_map {
    int32_t level; /* of the pyramid */
    float x, y;
    float linear[4];
} asj_disc_map;

typedef struct asj_disc_sums {
    int32_t inside;   /* samples in the image */
    float similarity; /* correlation with the template */
    float descent[6]; /* products of the template's descent with what the normalised source differs by from the template */
} asj_disc_sums;

/* Compares the source with the template. */
void asj_disc_compare(const asj_disc *disc, const asj_template *t, const asj_pyramid *pyramid, const asj_disc_map *map,
                      asj_disc_sums *sums);

/* Do enough samples lie in the image? Three quarters, as for patches (patch.h). */
static inline int32_t asj_disc_inside(int32_t inside, int32_t all)
{
    return 4 * inside >= 3 * all;
}

/* Operations (core/ops.h). */
typedef struct asj_disc_ops {
    /* asj_disc_compare() */
    void (*compare)(const asj_disc *disc, const asj_template *t, const asj_pyramid *pyramid, const asj_disc_map *map,
                    asj_disc_sums *sums);
} asj_disc_ops;
extern const asj_disc_ops asj_disc_reference;

#endif
