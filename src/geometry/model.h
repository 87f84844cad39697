/* SPDX-License-Identifier: BSD-2-Clause */
/* Geometries with parameters: what hypotheses are and what refinement moves. */
#ifndef ASJ_SRC_MODEL_H
#define ASJ_SRC_MODEL_H

#include "likelihood.h"

#include <asj/geometry.h>

#include <math.h>

#define ASJ_MODEL_PARAMETERS (5 + 3 * ASJ_MOST_PLANES)

/* Why a finalist is no answer, and no rival of one, whatever its evidence: strike_out.c. */
typedef enum asj_struck {
    ASJ_NOT_STRUCK,
    ASJ_STRUCK_BY_PICTURES,  /* they disagree with it by themselves */
    ASJ_STRUCK_FOR_ANOTHER,  /* colours and pictures contradict it in favour of one with less evidence */
    ASJ_STRUCK_AS_RIVAL      /* it contradicts the best one, and is contradicted in favour of that */
} asj_struck;

typedef struct asj_model {
    int32_t kind;             /* ASJ_GEOMETRY_ESSENTIAL, _FUNDAMENTAL or _HOMOGRAPHY */
    int32_t parameters;       /* 5 (essential) and 3 for each plane, 7 (fundamental), 8 (homography, or 3 where the
                               * camera only turns) */
    asj_camera cameras[2];    /* fundamental, homography: what brings pixels to numbers near 1 */
    double rotation[9];       /* essential: x2 ~ R x1 + t in camera coordinates, |t| = 1; of a camera that only turns, too */
    double translation[3];
    double planes[ASJ_MOST_PLANES][3]; /* essential: n of n'X = 1 with |t| = 1, in coordinates of camera 1; view.plane_count */
    int32_t thick;            /* essential: locations on its planes are known no better than others (pure_rotation.c) */
    asj_two_view view;
    double score;             /* asj_score() */
    double evidence;          /* asj_log_evidence() */
    double peak;              /* the evidence by Laplace's method, from the peak alone (asj_settle() has climbed to it) */
    double covariance[25];    /* of the motion's parameters, once asj_settle() has seen it: 5 x 5, or 3 x 3 of a turn */
    int32_t settled;
    asj_struck struck;
} asj_model;

/* May it be an answer, or a rival of one? */
static inline int32_t asj_model_stands(const asj_model *m)
{
    return m->evidence > -HUGE_VAL && m->struck == ASJ_NOT_STRUCK;
}

/* A homography K2 R K1^-1, which has three parameters. */
static inline int32_t asj_model_only_turns(const asj_model *m)
{
    return m->kind == ASJ_GEOMETRY_HOMOGRAPHY && m->parameters == 3;
}

/* Does it have a rotation, which the images' directions may make likely? */
static inline int32_t asj_model_has_rotation(const asj_model *m)
{
    return m->kind == ASJ_GEOMETRY_ESSENTIAL || asj_model_only_turns(m);
}

/* (x, y, 1) = K^-1 of a pixel. */
static inline void asj_ray(const asj_camera *k, double x, double y, double ray[3])
{
    ray[0] = (x - k->cx) / k->fx;
    ray[1] = (y - k->cy) / k->fy;
    ray[2] = 1;
}

/* K2^-T E K1^-1; and F, that of norm 1, and E = K2' F K1; the same for a homography: H = K2 N K1^-1, N = K2^-1 H K1. */
void asj_pixel_fundamental(const double essential[9], const asj_camera cameras[2], double f[9]);
void asj_fundamental_of(const double essential[9], const asj_camera cameras[2], double f[9]);
void asj_essential_of(const double f[9], const asj_camera cameras[2], double essential[9]);
void asj_pixel_homography(const double normal[9], const asj_camera cameras[2], double h[9]);
void asj_normal_homography(const double h[9], const asj_camera cameras[2], double normal[9]);

/* The four motions of an essential matrix (Hartley and Zisserman, result 9.19): rotations[0 or 1], +- translation. 0 for a matrix
 * that is none. */
int32_t asj_motions_of(const double essential[9], double rotations[2][9], double translation[3]);

/* Is a point in front of both cameras? Rays as asj_ray() gives them; 1, -1 behind one of them, 0 too far to say. */
int32_t asj_in_front(const double rotation[9], const double translation[3], const double ray1[3], const double ray2[3]);

/* Fills view from rotation, translation and planes (essential), or checks it. 0 when it cannot be. */
int32_t asj_model_complete(asj_model *model);

/* How far two essential matrices are apart: the larger angle of rotation and translation, rad. */
double asj_motions_apart(const asj_model *a, const asj_model *b);

/* The two directions, at right angles to t and to each other, in which a translation of length 1 moves. */
void asj_translation_axes(const double t[3], double axis[3], double other[3]);

/* The model moved by `delta`, one number for each parameter: radians and entries of the planes' n (essential), radians and the
 * change of the log of a ratio (fundamental), entries or, where the camera only turns, radians (homography). */
int32_t asj_model_move(const asj_model *model, const double *delta, asj_model *moved);

#endif
