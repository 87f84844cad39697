/* SPDX-License-Identifier: BSD-2-Clause */
/* What is known of the focal length that both images share before any candidate is looked at: that it is near one that was given,
 * and what straight edges say of it. */
#ifndef ASJ_SRC_GEOMETRY_FOCAL_PRIOR_H
#define ASJ_SRC_GEOMETRY_FOCAL_PRIOR_H

#include "core/context.h"
#include "directions.h"

/* Focal lengths are told as factors of those of a pair of cameras. The prior is known for `count` factors from `shortest` on whose
 * logarithms are `step` apart; "flat" is flat over the logarithm between the first and the last of them. */
#define ASJ_FOCAL_MOST 47

typedef struct asj_focal_prior {
    asj_camera cameras[2];      /* of factor 1 */
    double sd;                  /* of the log of the factor, around 1; 0: nothing is known of it, 0.4 to 4 */
    double shortest, step;
    int32_t count;              /* ASJ_FOCAL_MOST at most */
    const asj_edge_list *edges; /* of both images; NULL: they say nothing */
    asj_directions_list directions[2][ASJ_FOCAL_MOST];
    double log_edges[ASJ_FOCAL_MOST]; /* log of the density by edges over that without them */
} asj_focal_prior;

/* edges: lists of both images, which stay where they are as long as the prior is used, or NULL. set: who stops is asked there.
 * ASJ_ERROR_MEMORY. */
asj_status asj_focal_prior_make(asj_context *context, const asj_pairs *set, const asj_edge_list *edges, const asj_camera cameras[2],
                                double sd, asj_focal_prior *prior);

/* The n-th factor, 0 .. count - 1, how far the logarithms of the first and the last are apart, and the cameras of any factor. */
double asj_focal_factor(const asj_focal_prior *prior, int32_t n);
double asj_focal_range(const asj_focal_prior *prior);
void asj_focal_cameras(const asj_focal_prior *prior, double factor, asj_camera cameras[2]);

/* The number of the likeliest factor; -1 when nothing is known. */
int32_t asj_likeliest_focal(const asj_focal_prior *prior);

/* Two focal lengths that are nearer to each other are one, of log f. */
#define ASJ_SAME_FOCAL 0.1

/* Do edges tell this one, and no other nearly as well? Then they are a second witness of what candidates tell. */
int32_t asj_focal_has_edges(const asj_focal_prior *prior, double factor);

/* Log of the density of a factor over the flat one, whatever the rotation. */
double asj_log_focal_prior(const asj_focal_prior *prior, double factor);

/* Mean and variance of the log of the factor, whatever the rotation. */
void asj_focal_prior_moments(const asj_focal_prior *prior, double *mean, double *variance);

/* Log of what densities of rotations between directions (asj_likely_rotation) are to be multiplied with, so that their prior times
 * that of the factor is the joint one: focal_prior.c. */
double asj_log_focal_share(const asj_focal_prior *prior, double factor);

/* Directions of both images with cameras of that factor. ASJ_ERROR_MEMORY. */
asj_status asj_focal_directions(asj_context *context, const asj_focal_prior *prior, double factor,
                                asj_directions_list directions[2]);

#endif
