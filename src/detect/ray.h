/* SPDX-License-Identifier: BSD-2-Clause */
/* Rays of step 4. */
#ifndef ASJ_SRC_DETECT_RAY_H
#define ASJ_SRC_DETECT_RAY_H

#include "field.h"

/* A ray to follow, and how far it went. */
typedef struct asj_ray {
    double x, y;    /* px */
    double angle;   /* rad in [0, 2 pi) */
    int32_t start;  /* px: first radius looked at */
    int32_t forward, axial; /* out: last radius that passed, 0 = none; axial 0 when not asked for */
} asj_ray;

/* The length that a ray's ends stand for. */
static inline double asj_ray_length(const asj_detect_options *options, const asj_ray *ray)
{
    const double length = options->scan_axial ? 0.5 * (ray->forward + ray->axial) : ray->forward;
    /* a ray that starts at the isotropic scale is as long as that already */
    return options->scan_start == 0 && length < ray->start ? ray->start : length;
}

#define ASJ_SCAN_TABLE_RADIUS 256
#define ASJ_SCAN_TABLE_WIDTH 4

/* Least sum of gamma of three pixels across a ray under which there is an edge: 1.2 in 2^-24 (of gradient and direction). */
#define ASJ_SCAN_EDGE (ASJ_GRADIENT_ONE * 16384 / 5 * 6)

/* What is the same for all rays; made once for a set of options and an image size. */
typedef struct asj_scan {
    const asj_field *field;
    const struct asj_scan_cache *cache; /* of the image at hand, for as many threads as the context has */
    int32_t half_width;  /* 2 w + 1 samples in an arc */
    int32_t tolerance;   /* failing steps in a row that a ray survives */
    int32_t axial;       /* scan by axis as well */
    int32_t longest;     /* px: rays are followed no farther; 0 = to their ends */
    int32_t rough;       /* ends where two strides fail, without a look at the steps before them */
    int32_t threshold;   /* least sum of an arc, in 1/256 standard deviations */
    int16_t unit[1024][2]; /* cos and sin of 1024 angles, 1 = 16384 */
    int32_t arc_cosine[ASJ_SCAN_TABLE_RADIUS][ASJ_SCAN_TABLE_WIDTH]; /* of d / r at [r][d], 1 = 2^30 */
    int32_t arc_sine[ASJ_SCAN_TABLE_RADIUS][ASJ_SCAN_TABLE_WIDTH];
} asj_scan;

#endif
