/* SPDX-License-Identifier: BSD-2-Clause */
/* How much likelier candidates are under a geometry than by chance. */
#ifndef ASJ_SRC_LIKELIHOOD_H
#define ASJ_SRC_LIKELIHOOD_H

#include <stdint.h>

/* A candidate match, px; affine: linear part of the map from image 1 to image 2, row by row. */
typedef struct asj_pair {
    double x1, y1, x2, y2;
    double affine[4];
    double prior;            /* probability that it is right, before any geometry */
    uint32_t place1, place2; /* from 0 */
    uint32_t source;         /* index in the caller's list */
    uint32_t reserved;
} asj_pair;

/* Candidates, the likeliest first. */
typedef struct asj_pairs {
    asj_pair *list;
    int32_t count;
    int32_t place_count[2];
    double *prior[2];        /* of each place: sum over its candidates, below 1 */
    double empty[2];         /* sum over the places of log(1 - prior): the score of a geometry that nothing fits */
    double location_sd;      /* px */
    double angle_sd;         /* rad */
    double scale_sd;         /* of half the log of a ratio of squares */
    double spread;           /* px: wrong partners lie anywhere within this distance from an epipolar line */
    double area;             /* px^2: .. or anywhere in the image */
} asj_pairs;

/* What a geometry says of one candidate: squared residual in standard deviations, HUGE_VAL where a sign is wrong. */
typedef struct asj_residuals {
    double value[6];         /* divided by their standard deviations: three of an epipolar geometry, six of a homography */
    double square;
} asj_residuals;

/* A two-view geometry as candidates meet it. */
typedef struct asj_two_view {
    int32_t planar;          /* 0: matrix is fundamental, 1: a homography, image 1 -> image 2 */
    double matrix[9];
    double inverse[9];       /* planar: of the homography */
} asj_two_view;

void asj_epipolar_residuals(const double f[9], const asj_pairs *set, const asj_pair *pair, asj_residuals *r);
void asj_planar_residuals(const asj_two_view *view, const asj_pairs *set, const asj_pair *pair, asj_residuals *r);
void asj_residuals_of(const asj_two_view *view, const asj_pairs *set, const asj_pair *pair, asj_residuals *r);

/* Logarithm of the largest likelihood ratio, where all residuals are zero; standard deviations times `loose`. */
double asj_likelihood_peak(const asj_pairs *set, int32_t planar, double loose);

/* Likelihood if right over likelihood if wrong; peak: asj_likelihood_peak(). */
double asj_likelihood_ratio(const asj_two_view *view, const asj_pairs *set, const asj_pair *pair, double peak, double loose);

/* Scratch for a score: place by place, and a list of those touched. */
typedef struct asj_score_scratch {
    double *sum[2];
    uint32_t *touched[2];
} asj_score_scratch;

/* Log of likelihood with the geometry over likelihood without: likelihood.c. Of the first `count` candidates. */
double asj_score(const asj_pairs *set, int32_t count, const asj_two_view *view, double loose, asj_score_scratch *scratch);

/* For every candidate the probability that it is right, given the geometry and its rivals at both places. */
void asj_probabilities(const asj_pairs *set, const asj_two_view *view, double loose, asj_score_scratch *scratch,
                       double *probability);

#endif
