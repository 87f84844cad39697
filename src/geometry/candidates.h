/* SPDX-License-Identifier: BSD-2-Clause */
/* Candidates and two-view geometries as data. */
#ifndef ASJ_SRC_GEOMETRY_CANDIDATES_H
#define ASJ_SRC_GEOMETRY_CANDIDATES_H

#include <stdint.h>

#define ASJ_MOST_DIRECTIONS 2 /* sets of them, of one image */
#define ASJ_NAMES 24          /* ways to name the directions of one image by those of another one */
#define ASJ_MOST_ROTATIONS (ASJ_NAMES * ASJ_MOST_DIRECTIONS * ASJ_MOST_DIRECTIONS)
#define ASJ_BRANCH_NUMBERS 8  /* x and y of both branches in both images */

/* A candidate match, px; affine: linear part of the map from image 1 to image 2, row by row. */
typedef struct asj_pair {
    double x1, y1, x2, y2;
    double affine[4];
    double prior;            /* probability that it is right, before any geometry */
    uint32_t place1, place2; /* from 0 */
    uint32_t source;         /* index in the caller's list */
    float colour;            /* how well colours agree: estimate.h */
    uint8_t label[2][ASJ_MOST_DIRECTIONS][2]; /* of each image, in each set of its directions: of both branches (labels.c) */
} asj_pair;

/* A rotation that the images' directions make likely: manhattan.c. */
#define ASJ_ROTATION_SIZES 3
typedef struct asj_likely_rotation {
    double matrix[9];
    double precision[ASJ_ROTATION_SIZES][9]; /* rad^-2: inverse covariances of w with exp([w]x) matrix the true one */
    double log_top[ASJ_ROTATION_SIZES];      /* of their densities at the middle over the flat one, each with its share */
    double log_share;        /* before any candidate is looked at */
    double log_labels;       /* what the labels of all candidates say of it */
    int32_t of_set[2];       /* which set of directions it is from, in either image */
    uint8_t name[8];         /* labels.c: the label in image 2 of each label of image 1 */
} asj_likely_rotation;

/* Candidates, the likeliest first, and what is known beforehand. */
typedef struct asj_pairs {
    asj_pair *list;
    int32_t count;
    int32_t place_count[2];
    double *prior[2];        /* of each place: sum over its candidates, below 1 */
    double *log_rest[2];     /* of each place: log(1 - prior) */
    double empty[2];         /* sum over the places of log(1 - prior): the score of a geometry that nothing fits */
    double location_sd;      /* px */
    double angle_sd;         /* rad */
    double scale_sd;         /* of half the log of a ratio of squares */
    double spread;           /* px: wrong partners lie anywhere within this distance from an epipolar line */
    double area;             /* px^2: .. or anywhere in the image */
    asj_likely_rotation *rotations; /* where there are labels, in falling order of what these say, with the shares */
    int32_t rotation_count;
    int32_t has_colours;
    int32_t has_down;
    int32_t has_labels;
    double down[2][3];       /* of either camera, where has_down: the direction that points down in its image */
    double middle[2][2];     /* px: of image 1 and image 2 */
    float *at;               /* near.c: all x1, all y1, x2, y2, from the middles */
    const struct asj_near_ops *near;   /* near.h */
    const struct asj_ratio_ops *ratio; /* ratios.h */
    double farthest[4];      /* the largest of each */
    struct asj_watch *watch; /* stop.h; NULL = nobody asks whether to go on */
} asj_pairs;

#define ASJ_MOST_PLANES 4
#define ASJ_MOST_PARTS (1 + ASJ_MOST_PLANES)

/* A two-view geometry as candidates meet it. */
typedef struct asj_two_view {
    int32_t planar;          /* 0: matrix is fundamental, 1: a homography, image 1 -> image 2 */
    int32_t plane_count;     /* of a fundamental matrix: planes that lie in it; of a camera that only turns 1, or 0: model.c */
    double matrix[9];
    double planes[ASJ_MOST_PLANES][9]; /* their homographies, positive where they are in front of camera 1 */
    double thickness[ASJ_MOST_PLANES];   /* sd of a location on it, as part of that of others: model.c */
    double in_front[ASJ_MOST_PLANES][3]; /* a pixel (x, y, 1) of the plane is in front of camera 1 when its product is positive */
    int32_t has_motion;      /* what follows is known: which side of the cameras a point is */
    double rotation[9];
    double turned[9];        /* R K1^-1 */
    double translation[3];
    double ray2[4];          /* 1 / fx, 1 / fy, cx, cy of camera 2 */
    double parallax2;        /* squared sine of the angle between rays below which a point is too far to have a side */
} asj_two_view;

#endif
