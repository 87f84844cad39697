/* SPDX-License-Identifier: BSD-2-Clause */
/* A junction that is not yet certain: what the location and steps 4 and 5 pass on to each other and improve or reject. */
#ifndef ASJ_SRC_HYPOTHESIS_H
#define ASJ_SRC_HYPOTHESIS_H

#include "isotropic.h"
#include "core/angle.h"
#include "core/decade.h"

#define ASJ_MAX_OCTAVES 16 /* numbers of octaves are below this, */
#define ASJ_FIRST_OCTAVE (-1) /* and not below this: the image upsampled by two */

/* Branches that turn by no more than this are of one edge: the default of merge_angle, below which two of a junction would be one;
 * whatever that option says, since the two belong to different junctions. */
#define ASJ_ONE_WAY (15 * ASJ_DEGREE)

/* Octaves are whole numbers, or lie half-way between two (octaves.c): so many halves after the first one. */
static inline int32_t asj_octave_index(double octave)
{
    return (int32_t)(2 * (octave - ASJ_FIRST_OCTAVE));
}

/* px of the image for one of the octave: 2^octave. */
static inline double asj_octave_scale(double octave)
{
    const int32_t index = asj_octave_index(octave);
    return 0.5 * (double)(1 << index / 2) * (index % 2 ? ASJ_SQRT2 : 1);
}

static inline int32_t asj_octave_is_whole(double octave)
{
    return asj_octave_index(octave) % 2 == 0;
}

/* px of the octave for so many of the image: those that are whole, of a half octave those of the one that it is made of. */
static inline int32_t asj_octave_size(int32_t size, double octave)
{
    const int32_t index = asj_octave_index(octave), made_of = index < 2 ? 2 * size : size >> (index / 2 - 1);
    return index % 2 ? (int32_t)(made_of / ASJ_SQRT2) : made_of;
}

/* A ray that has been followed along a branch (step 4). */
typedef struct asj_scanned_ray {
    double x, y;  /* px: where it started */
    double angle; /* rad */
} asj_scanned_ray;

typedef struct asj_hypothesis_branch {
    double angle;            /* rad, outwards */
    double length;           /* px; 0 before the scan */
    asj_scanned_ray scanned; /* that gave the length */
    double strength;         /* standard deviations */
    double log_nfa;          /* natural logarithm */
    double offset;           /* px: the fitted line passes this far from the junction, along (-sin, cos) of the angle */
    double angle_variance;   /* rad^2 of the fit */
    double offset_variance;  /* px^2 of the fit at the junction */
    double apart;            /* px between the two edges of a thin line, 0 = one edge */
    double width;            /* px of its octave: standard deviation of the edge's blur (edge_width.c); 0 = sharp or not known */
    double octave;           /* that found it */
    double end_variance;     /* px^2 of the end along the branch; 0 = not known */
    int32_t end;             /* ASJ_BRANCH_END_... */
    int32_t is_another;      /* 1 = found when its junction was known (complete.c): it has no say in where that is */
    int32_t evidence;        /* where what its strip says stands in asj_detection_run.evidence, once that is measured */
} asj_hypothesis_branch;

typedef struct asj_hypothesis {
    double x, y;               /* px */
    double x0, y0;             /* where the isotropic test found it */
    double radius;             /* px: of that test */
    double log_nfa;            /* natural logarithm, of that test */
    double first;              /* px along the branches: where lines are fitted from, once they are guessed */
    double location_variance;  /* px^2, mean of both axes */
    double explained;          /* share of the gradient around that a blurred corner explains (blurred_corner.c); 0 = none */
    double octave;             /* that located it: 0 = the image itself, 1/2, 1 = the image halved, .., -1 = upsampled by two */
    int32_t branch_count;      /* 0 = rejected */
    int32_t completes;         /* complete_step.c: the junction that its only branch may be one of */
    int32_t is_vote;           /* 1 = says in a copy of another size that there is a junction (sizes.c), and nothing else of it */
    asj_hypothesis_branch branches[ASJ_MAX_BRANCHES];
} asj_hypothesis;

/* Whether two directions of an isotropic junction open by minimum_opening: most edges that pass the isotropic test fail here. */
int asj_isotropic_has_opening(const asj_detect_options *options, const asj_isotropic_junction *junction);

/* Turns an isotropic junction into a hypothesis at its pixel. */
void asj_hypothesis_start(const asj_isotropic_junction *junction, asj_hypothesis *hypothesis);

/* Absolute difference of two angles in [0, pi]. */
double asj_angle_distance(double a, double b);

/* An angle brought into [0, 2 pi). */
double asj_angle_wrap(double angle);

/* Places and lengths in other pixels, whose centres are at whole numbers too: x and y that many times as far, lengths `scale`
 * times as long. Not what is in pixels of an octave. */
void asj_hypothesis_scale(asj_hypothesis *hypothesis, double x_scale, double y_scale, double scale);

/* Whether it lies in an image of that size, or no farther outside than what meets beyond the border may (ASJ_MAX_OUTSIDE). */
int asj_hypothesis_is_inside(const asj_hypothesis *hypothesis, int32_t width, int32_t height);

/* Removes branches whose flag is 0, keeping the order. */
void asj_hypothesis_select(asj_hypothesis *hypothesis, const int *keep);

/* From any other branch to one that joins them later; merge_angle, if that is more. */
#define ASJ_JOINED_APART (20 * ASJ_DEGREE)
double asj_joined_apart(const asj_detect_options *options);

/* Whether no branch is closer to this direction than `least` radians. */
int asj_hypothesis_is_free(const asj_hypothesis *hypothesis, double angle, double least);

/* Adds a branch, for which there is room, behind those of smaller angles. */
void asj_hypothesis_insert(asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch);

/* 1 when two branches open by at least `least` radians and at most pi - least; of those whose flag is not 0. */
int asj_hypothesis_has_opening(const asj_hypothesis *hypothesis, double least);
int asj_hypothesis_opens(const asj_hypothesis *hypothesis, const int *keep, double least);

#endif
