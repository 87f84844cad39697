/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_JUNCTION_H
#define ASJ_JUNCTION_H

#include <asj/status.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ASJ_MAX_BRANCHES 5

/* What is at the far end of a branch. Ends at a junction or at a crossing are places of the scene, which another picture of it may
 * show too; where something hides an edge or the border cuts it that is not so, and where it fades the place is known least. */
enum {
    ASJ_BRANCH_END_UNKNOWN = 0,   /* not looked at: junctions from files that do not say it; or a junction was there that is none of
                                   * the list, since a finer octave had it already */
    ASJ_BRANCH_END_JUNCTION = 1,  /* another junction of the list */
    ASJ_BRANCH_END_CROSSING = 2,  /* edges that go on or turn away there, and no junction of the list */
    ASJ_BRANCH_END_FADED = 3,     /* nothing: the edge gets too weak, against itself (end_contrast) or noise */
    ASJ_BRANCH_END_OCCLUSION = 4, /* an edge that passes by in one line, which may hide the rest */
    ASJ_BRANCH_END_BORDER = 5     /* the border of the image */
};

/* One straight branch of a junction, pointing away from it. */
typedef struct asj_branch {
    float angle;      /* rad in [0, 2 pi), from +x (right) towards +y (down) */
    float length;     /* px from the junction to the branch's own end: the anisotropic scale */
    float strength;   /* junction-ness of the branch at the isotropic scale, in standard deviations of the null model */
    float log10_nfa;  /* log10 of the expected number of strips as good as this one in an image of noise; the smaller the surer */
    float angle_sd;   /* rad: standard uncertainty of `angle`; 0 = not known */
    float width;      /* px: standard deviation of the blur of the edge under it, when that is a step; 0 = sharp or not known */
    float length_sd;  /* px: standard uncertainty of the end along the branch; 0 = not known */
    int32_t end;      /* ASJ_BRANCH_END_...: what is there */
} asj_branch;

/* What a junction may be: asj_junction_check(). */
#define ASJ_LEAST_OCTAVE (-1)        /* the image upsampled by two */
#define ASJ_LARGEST_OCTAVE 15
#define ASJ_MAX_BRANCH_LENGTH 262140.0f /* px: four times ASJ_MAX_SIDE */
#define ASJ_MAX_BRANCH_ANGLE 1e6f    /* rad, of either sign: turns of a float that still say where it points */
#define ASJ_MAX_OUTSIDE 10           /* px outside its image, where that is known (asj_match(), JSON): branches may meet beyond the
                                      * border. The detector's most max_move */

/* A junction: a point with two to five branches, in order of angle. */
typedef struct asj_junction {
    float x, y;             /* px, sub-pixel; pixel centres at integers */
    float scale;            /* px: radius at which the isotropic test found it most meaningful */
    float log10_nfa;        /* log10 NFA of the isotropic junction */
    float location_sd;      /* px: standard uncertainty of x and of y (root mean square of the two); 0 = not known */
    int32_t branch_count;   /* 2 .. ASJ_MAX_BRANCHES */
    int32_t octave;         /* that located it: 0 = the image itself, or not known, 1 = its half, 2 = its quarter, ..,
                             * -1 = upsampled by two; half octaves rounded away from 0 */
    asj_branch branches[ASJ_MAX_BRANCHES]; /* those beyond branch_count are zero */
} asj_junction;

/* Whether there can be such a junction. Every function that takes junctions with a context, reads or writes them asks this of each
 * (asj_decompose() passes over what has a wrong count): all its numbers and those of its branches are finite; the scale is not
 * negative, the octave ASJ_LEAST_OCTAVE .. ASJ_LARGEST_OCTAVE, the branch_count 0 .. ASJ_MAX_BRANCHES (files: 2 or more); of each
 * branch the length is 0 .. ASJ_MAX_BRANCH_LENGTH, the angle within +-ASJ_MAX_BRANCH_ANGLE, the end an ASJ_BRANCH_END_....
 * Branches in another order, and angles outside of [0, 2 pi), are no fault.
 *
 * ASJ_ERROR_ARGUMENT: it cannot be, or is NULL. If message is not NULL, message_size bytes there receive what it has that cannot be
 * ("6 branches"), or "". Any thread, any time. */
ASJ_API asj_status asj_junction_check(const asj_junction *junction, char *message, size_t message_size);

/* An L-junction: two branches of a junction, ordered so that turning from a to b in the sense of growing angles (clockwise on
 * the screen) takes less than pi. The order is unique and survives every affine map that does not mirror. */
typedef struct asj_l_junction {
    uint32_t junction;          /* index of the junction it comes from */
    uint16_t branch_a, branch_b;/* indices of its branches there */
    float x, y;                 /* px: the junction's location */
    float ax, ay;               /* px: end of branch a */
    float bx, by;               /* px: end of branch b */
} asj_l_junction;

/* A straight edge of the picture between two junctions: a branch of each, which point at each other. Every branch is part of one
 * edge at most, and no other junction that has branches along the line in both directions lies between. Neither branch need end at
 * the other junction: it may stop short of it or go on, as its own `length` and `end` say, and an ASJ_BRANCH_END_JUNCTION may be
 * another junction than the edge's. */
typedef struct asj_edge {
    uint32_t junction_a, junction_b; /* indices of the junctions, a < b */
    uint16_t branch_a, branch_b;     /* indices of their branches */
    float log10_nfa;                 /* log10 of the expected number of strips as good as the part between in an image of noise */
    uint32_t reserved[2];            /* zero, also in those given to asj_find_segments() */
} asj_edge;

#ifdef __cplusplus
}
#endif
#endif
