/* SPDX-License-Identifier: BSD-2-Clause */
/* Exact junctions of a scene, from its geometry alone. Every polygon edge is cut where it meets another edge; a piece counts
 * when the grey levels on its two sides differ; pieces that meet in a point make a junction; a branch runs on, straight through
 * any other junction, to where its line of pieces ends. */
#ifndef ASJ_TESTS_SYNTH_TRUTH_H
#define ASJ_TESTS_SYNTH_TRUTH_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SYNTH_MAX_BRANCHES 12

typedef struct synth_true_branch {
    double angle;     /* rad in [0, 2 pi), from +x towards +y */
    double length;    /* px to the branch's true end, or to the image border */
    double contrast;  /* grey levels: mean over the branch of the step across it */
    double weakest;   /* grey levels: smallest step of any of its pieces */
    double near_step; /* grey levels: step of the first piece, at the junction */
    int32_t passes;   /* junctions passed before the end */
    int32_t at_border;/* 1 = cut by the image border */
} synth_true_branch;

typedef struct synth_true_junction {
    double x, y;
    int32_t branch_count;    /* 2 .. SYNTH_MAX_BRANCHES, not counting pairs that only make one straight edge */
    int32_t reserved;
    synth_true_branch branches[SYNTH_MAX_BRANCHES]; /* by angle */
} synth_true_junction;

typedef struct synth_truth {
    synth_true_junction *junctions;
    int32_t count;
    int32_t reserved;
} synth_truth;

/* Junctions of a scene. A piece needs a step of at least `min_contrast` grey levels at its middle. 0, or -1 (memory, failed
 * scene). */
int synth_truth_of_scene(const synth_scene *scene, double min_contrast, synth_truth *truth);

/* Junctions of a drawing of `count` straight lines, each from ends[2 i] to ends[2 i + 1]: for thin lines, whose edges are too close
 * to be told apart. The contrast is 0. The lines have to lie inside the image. */
int synth_truth_of_lines(const synth_point *ends, int32_t count, int32_t width, int32_t height, synth_truth *truth);

void synth_truth_free(synth_truth *truth);

/* Largest opening in radians of any two branches that open by at least `margin` and at most pi - margin; 0 when there is none.
 * Branches shorter than `min_length` px or with a piece of less than `min_contrast` grey levels at the junction do not count.
 * So > 0 means that a detector with this minimum opening should report the junction. */
double synth_truth_opening(const synth_true_junction *junction, double margin, double min_length, double min_contrast);

/* |a - b| on the circle, in [0, pi]. */
double synth_angle_distance(double a, double b);

#ifdef __cplusplus
}
#endif
#endif
