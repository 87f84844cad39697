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

#define ASJ_ROTATIONS 24

/* Candidates, the likeliest first, and what is known beforehand. */
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
    double rotations[ASJ_ROTATIONS][9]; /* manhattan.c */
    int32_t rotation_count;  /* 0 or ASJ_ROTATIONS */
    int32_t reserved;
} asj_pairs;

/* What a geometry says of one candidate: squared residual in standard deviations, HUGE_VAL where a sign is wrong. */
typedef struct asj_residuals {
    double value[6];         /* divided by their standard deviations: three of an epipolar geometry, six of a homography */
    double square;
} asj_residuals;

#define ASJ_MOST_PLANES 4
#define ASJ_MOST_PARTS (1 + ASJ_MOST_PLANES)

/* A two-view geometry as candidates meet it. */
typedef struct asj_two_view {
    int32_t planar;          /* 0: matrix is fundamental, 1: a homography, image 1 -> image 2 */
    int32_t plane_count;     /* of a fundamental matrix: planes that lie in it */
    double matrix[9];
    double planes[ASJ_MOST_PLANES][9]; /* their homographies, positive where they are in front of camera 1 */
    double in_front[ASJ_MOST_PLANES][3]; /* a pixel (x, y, 1) of the plane is in front of camera 1 when its product is positive */
    int32_t has_motion;      /* what follows is known: which side of the cameras a point is */
    int32_t reserved;
    double turned[9];        /* R K1^-1 */
    double translation[3];
    double ray2[4];          /* 1 / fx, 1 / fy, cx, cy of camera 2 */
    double parallax2;        /* squared sine of the angle between rays below which a point is too far to have a side */
} asj_two_view;

void asj_epipolar_residuals(const double f[9], const asj_pairs *set, const asj_pair *pair, asj_residuals *r);
void asj_planar_residuals(const double h[9], const asj_pairs *set, const asj_pair *pair, asj_residuals *r);

/* What a candidate may be: part 0 is anywhere in a geometry without planes or on the plane of a homography, part k on its k-th
 * plane. */
static inline int32_t asj_part_is_planar(const asj_two_view *view, int32_t part)
{
    return view->planar || part > 0;
}
void asj_part_residuals(const asj_two_view *view, int32_t part, const asj_pairs *set, const asj_pair *pair, asj_residuals *r);

/* Logarithm of the largest likelihood ratio of the parts, where all residuals are zero, with their shares; standard deviations
 * times `loose`. */
typedef struct asj_peaks {
    double first, plane; /* of part 0 and of the planes */
    double loose;
} asj_peaks;
asj_peaks asj_likelihood_peaks(const asj_pairs *set, const asj_two_view *view, double loose);

/* Likelihood if right over likelihood if wrong; parts: NULL, or what each part has of it. */
double asj_likelihood_ratio(const asj_two_view *view, const asj_pairs *set, const asj_pair *pair, const asj_peaks *peaks,
                            double *parts);

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
