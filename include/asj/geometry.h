/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_GEOMETRY_H
#define ASJ_GEOMETRY_H

#include <asj/context.h>

#ifdef __cplusplus
extern "C" {
#endif

/* What relates two images. */
enum {
    ASJ_GEOMETRY_NONE = 0,        /* nothing is estimated */
    ASJ_GEOMETRY_AUTO = 1,        /* what the candidates speak for most: a homography, or else an essential matrix (cameras known)
                                   * or a fundamental matrix (not known) */
    ASJ_GEOMETRY_ESSENTIAL = 2,   /* cameras with known focal length: rotation and direction of the translation */
    ASJ_GEOMETRY_FUNDAMENTAL = 3, /* any cameras without lens distortion */
    ASJ_GEOMETRY_HOMOGRAPHY = 4   /* a plane, or a camera that only turns */
};

/* How an estimation ended. */
enum {
    ASJ_GEOMETRY_NOT_ASKED = 0,
    ASJ_GEOMETRY_ACCEPTED = 1,
    ASJ_GEOMETRY_CHANCE = 2,      /* none stands out from what chance brings */
    ASJ_GEOMETRY_TOO_FEW = 3,     /* fewer than two places with candidates in either image */
    ASJ_GEOMETRY_AMBIGUOUS = 4,   /* another one with other matches explains almost as much, or less, but more than chance
                                   * can (src/geometry/ambiguity.h): things that repeat; or all that is matched lies on a
                                   * plane on which it repeats; or the images and the upsampled ones tell two motions
                                   * (match.h) */
    ASJ_GEOMETRY_DEGENERATE = 5   /* what matches leaves it open: a camera that only turns has no translation where model essential
                                   * asks for one; or, with cameras that are known, fewer than 15 matches that tell no pose */
};

/* A pin-hole camera without distortion. px; pixel centres at integers. fx = fy = 0: not known, and then cx and cy say nothing. A
 * camera that a caller gives has focal lengths of 1 .. 10^7 and a principal point within +-10^7, else ASJ_ERROR_OPTION. */
typedef struct asj_camera {
    double fx, fy; /* focal lengths */
    double cx, cy; /* principal point */
} asj_camera;

/* A candidate: perhaps these two points are one. */
typedef struct asj_geometry_candidate {
    uint32_t place1, place2; /* candidates with the same place in an image are rivals: one of them is right at most. Below 2^24 */
    double x1, y1, x2, y2;   /* px */
    double affine[4];        /* linear part of the map from image 1 to image 2, row by row: a11 a12 a21 a22; must not mirror */
    double probability;      /* that it is right, from what it looks like alone: 0 .. 1. Those of a place are brought to a sum
                              * of 0.9 where they are more */
} asj_geometry_candidate;

/* Fill with asj_geometry_options_init(), then change fields. */
typedef struct asj_geometry_options {
    int32_t model;           /* ASJ_GEOMETRY_...; auto */
    int32_t samples;         /* minimal sets of candidates that are tried for each kind: 1 .. 100000; 1000. Where all that
                              * these find is chance, others too, but with find_focal or a focal_sd */
    uint64_t seed;           /* of the samples; 1 */
    asj_camera cameras[2];   /* of image 1 and image 2; not known. Without them the middle of the image and the larger side as focal
                              * length serve as a guess for samples, which nothing rests on */
    int32_t widths[2], heights[2]; /* px of the images; must be given */
    double epsilon;          /* a geometry is accepted when chance brings one as good at most this often, in pairs of unrelated
                              * images: 1e-12 .. 1; 1e-7 */
    double location_sd;      /* px: standard deviation of a location, of the worst fifth of the candidates; a half and a quarter of
                              * it for the others. The next two likewise. 0.1 .. 10; 1.5 */
    double angle_sd;         /* deg: of a map's rotation. 1 .. 45; 9 */
    double scale_sd;         /* of the log of a map's scale. 0.02 .. 1; 0.22 */
    double directions[2][9]; /* of image 1 and image 2: three directions of the scene at right angles to each other, in camera
                              * coordinates, one after the other, in any order and of either sign (vanishing.h finds them); zero,
                              * the default: not known. With cameras only */
    int32_t find_focal;      /* 1 = no camera is known, but both have pixels as `aspects` says, the principal point in the middle of
                              * the image and the same focal length, as a part of the longer side: it is found with the motion,
                              * between 0.4 and 4 of the longer side. Where images are matched their straight edges are asked, too:
                              * those of a room are at right angles at its focal length only. Model auto and essential only. Where
                              * all that leaves it open, auto gives a fundamental matrix or a homography, and essential ends
                              * degenerate. 0 */
    int32_t reserved_integer;/* zero */
    double aspects[2];       /* of image 1 and image 2: fy / fx of a camera that is not known, 1 = square pixels. The longer side is
                              * that of the image with square pixels as wide as its own. 0.01 .. 100; 1 */
    double focal_sd;         /* how well the focal lengths of `cameras` are known: the standard deviation of their logarithms, which
                              * are wrong in the same way (0.03: by 3 %; both by the same factor). More than 0: that factor is found
                              * with the motion. 0 .. 0.25, below 0.0001 exactly; 0. It says nothing without both cameras, or
                              * of model fundamental and homography */
    double reserved[12];     /* zero */
} asj_geometry_options;

/* Fills in the defaults. NULL is left alone. */
ASJ_API void asj_geometry_options_init(asj_geometry_options *options);

/* Two-view geometry. */
typedef struct asj_geometry {
    int32_t status;          /* ASJ_GEOMETRY_ACCEPTED, ...: only when accepted are the fields below those of an answer; otherwise
                              * they tell of the best that was found, or are 0 */
    int32_t model;           /* ASJ_GEOMETRY_ESSENTIAL, _FUNDAMENTAL, _HOMOGRAPHY */
    int32_t has_pose;        /* rotation and translation are known, to 10 degrees or better: the covariance says how well */
    int32_t has_rival;       /* rival_log10_nfa is known */
    double matrix[9];        /* row by row, of norm 1. Homography: image 1 -> image 2. Else the fundamental matrix: x2' F x1 = 0
                              * with pixels (x, y, 1); the essential matrix is K2' F K1 */
    double rotation[9];      /* x2 ~ R x1 + t in camera coordinates (x right, y down, z forward), row by row. Known with a pose, and
                              * where the camera only turns */
    double translation[3];   /* of length 1: how far is not known. 0 where the camera only turns */
    double covariance[36];   /* of the rotation (vector w with R_true = exp([w]x) R, rad) and the translation, 6 x 6, row by row;
                              * from the spread of all motions that the candidates allow. (asj_match(): before the pose was finished
                              * from where the matches lie, src/match/final_pose.c) */
    asj_camera cameras[2];   /* of image 1 and image 2: those that the motion was estimated with, given or found; fx is 0 without a
                              * motion */
    double log10_nfa;        /* log10 of how often chance brings such a geometry in a pair of unrelated images; where its matches
                              * alone leave that open, such a geometry with pictures that agree so well */
    double rival_log10_nfa;  /* .. the best other one, which has other matches: its rival */
    double inliers;          /* sum of the candidates' probabilities */
    double focal_sd;         /* of the log of the focal length, where it was found; 0 where it was given exactly */
    double rival_rotation[9];/* the rival's motion, as the best one's above; zero where it has none, or nothing determines its
                              * translation; the translation alone where the camera only turns. How well it is known nobody says */
    double rival_translation[3];
    int32_t only_turns;      /* 1 = the camera only turns, as far as matches tell: a homography K2 R K1^-1, which a wall that a long
                              * lens sees obeys, too. The rotation and its block of the covariance are known, has_pose is 0. With
                              * cameras or find_focal; model auto or, where it is degenerate then, essential */
    int32_t reserved_integer;
    double picture_agreement;/* how well the images agree between the matches, of what they could: about 1 as well as possible, 0.6
                              * where they know nothing (bare walls, no plane), 0.3 and less where only corners are alike; 0:
                              * nobody has looked (asj_geometry_estimate(); model fundamental). src/geometry/picture_agreement.c */
    double picture_knowledge;/* nats: what they could say at most, 15 and more where that is worth something */
} asj_geometry;

/* Estimates the two-view geometry of candidate matches.
 *
 * candidates     may be NULL when count is 0; only read
 * probabilities  NULL, or room for `count` numbers: the probability of each candidate given the geometry, with ambiguous and
 *                degenerate under the best one; 0 with any other status that is not accepted, and of all but the 3000
 *                likeliest candidates, which are all that is looked at
 * result         it and the probabilities are written when ASJ_OK is returned
 *
 * src/geometry/likelihood.c says what is maximised, search.c how, evidence.c what log10_nfa rests on. The result depends on the
 * input and the seed, not on the number of threads. One call at a time for a context.
 *
 * ASJ_ERROR_ARGUMENT   a NULL pointer; a candidate that is not finite, lies 10^6 px away, mirrors or collapses, or a probability
 *                      outside 0 .. 1
 * ASJ_ERROR_OPTION     an option outside its range; a camera that cannot be (asj_camera); directions that are not three of
 *                      length 1 at right angles; model essential without cameras; find_focal with one, with focal_sd, or with model
 *                      fundamental or homography; a reserved field that is not zero
 * ASJ_ERROR_LIMIT      more than 2^24 candidates or places
 * ASJ_ERROR_CANCELLED  the progress callback, which is called every 50 ms, wants to stop
 * ASJ_ERROR_MEMORY */
ASJ_API asj_status asj_geometry_estimate(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                                         const asj_geometry_options *options, double *probabilities, asj_geometry *result);

/* "essential", "fundamental", "homography", "auto", "none"; "unknown" outside the range. A static string. */
ASJ_API const char *asj_geometry_model_name(int32_t model);
/* "accepted", "chance", "too few", "ambiguous", "degenerate", "not asked"; "unknown". */
ASJ_API const char *asj_geometry_status_name(int32_t status);

#ifdef __cplusplus
}
#endif
#endif
