/* SPDX-License-Identifier: BSD-2-Clause */
/* What the straight edges of both images say of the focal length that they share, before any candidate is looked at. */
#ifndef ASJ_SRC_GEOMETRY_FOCAL_PRIOR_H
#define ASJ_SRC_GEOMETRY_FOCAL_PRIOR_H

#include "core/context.h"
#include "directions.h"

/* Focal lengths are told as factors of those of a pair of cameras. The prior is known for the COUNT factors from SHORTEST on whose
 * logarithms are STEP apart (up to 3.99), and flat over the logarithm between the first and the last of them. */
#define ASJ_FOCAL_SHORTEST 0.4
#define ASJ_FOCAL_STEP 0.05
#define ASJ_FOCAL_COUNT 47
#define ASJ_FOCAL_RANGE ((ASJ_FOCAL_COUNT - 1) * ASJ_FOCAL_STEP)

typedef struct asj_focal_prior {
    asj_camera cameras[2];      /* of factor 1 */
    const asj_edge_list *edges; /* of both images; NULL: the prior is flat */
    asj_directions_list directions[2][ASJ_FOCAL_COUNT];
    double log_edges[ASJ_FOCAL_COUNT]; /* log of the density by edges alone over the flat one */
} asj_focal_prior;

/* edges: lists of both images, which stay where they are as long as the prior is used, or NULL. set: who stops is asked there.
 * ASJ_ERROR_MEMORY. */
asj_status asj_focal_prior_make(asj_context *context, const asj_pairs *set, const asj_edge_list *edges, const asj_camera cameras[2],
                                asj_focal_prior *prior);

/* The n-th factor, 0 .. ASJ_FOCAL_COUNT - 1, and the cameras of any. */
double asj_focal_factor(int32_t n);
void asj_focal_cameras(const asj_focal_prior *prior, double factor, asj_camera cameras[2]);

/* The number of the likeliest factor; -1 when edges say nothing. */
int32_t asj_likeliest_focal(const asj_focal_prior *prior);

/* Log of the density of a factor over the flat one, whatever the rotation. */
double asj_log_focal_prior(const asj_focal_prior *prior, double factor);

/* Log of what densities of rotations between directions (asj_likely_rotation) are to be multiplied with, so that their prior times
 * that of the factor is the joint one: focal_prior.c. */
double asj_log_focal_share(const asj_focal_prior *prior, double factor);

/* Directions of both images with cameras of that factor. ASJ_ERROR_MEMORY. */
asj_status asj_focal_directions(asj_context *context, const asj_focal_prior *prior, double factor,
                                asj_directions_list directions[2]);

#endif
