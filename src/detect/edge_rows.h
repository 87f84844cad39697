/* SPDX-License-Identifier: BSD-2-Clause */
/* The grey levels across a branch, and what its edge looks like in them. */
#ifndef ASJ_SRC_EDGE_ROWS_H
#define ASJ_SRC_EDGE_ROWS_H

#include "core/image.h"
#include "edge_fan.h"
#include "hypothesis.h"

#define ASJ_EDGE_HALF 2 /* px to either side of the line */
#define ASJ_EDGE_SAMPLES (2 * ASJ_EDGE_HALF + 1)
#define ASJ_EDGE_LEVEL (ASJ_EDGE_SAMPLES * 256.0) /* of a sample in a row: 1/ASJ_GRAY_ONE grey levels */
#define ASJ_EDGE_FIRST 3 /* px: what is nearer to the junction has other edges in it */

/* The line of a branch: (x + t ux - offset uy, y + t uy + offset ux), t px from its junction. */
typedef struct asj_edge_line {
    const asj_frame *frame;
    double x, y, ux, uy, offset;
} asj_edge_line;

asj_edge_line asj_edge_line_of(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch);

/* Rows that vector forms read at once: levels have room for so many behind the last one that is asked for. */
#define ASJ_EDGE_BATCH 8

/* The rows t = first, first + step, .. px from the junction, `count` of them at most: the grey levels at s = -ASJ_EDGE_HALF ..
 * ASJ_EDGE_HALF less their mean, in 1/ASJ_EDGE_LEVEL; sample i of row k goes to levels[i * room + k]. Returns how many there are
 * before the first outside the image, whose border is repeated around it as far as samples reach. */
int32_t asj_edge_rows(const asj_edge_line *line, int32_t first, int32_t step, int32_t count, int32_t *levels, ptrdiff_t room);

/* Of two cross-sections. */
double asj_edge_product(const double *a, const double *b);

/* How much of each of `count` rows lies along a cross-section, in 1/ASJ_EDGE_LEVEL. */
void asj_edge_parts(const int32_t *levels, ptrdiff_t room, int32_t count, const double section[ASJ_EDGE_SAMPLES], double *parts);

/* The cross-section of an edge, of norm one, from `count` means of rows along it, in 1/ASJ_GRAY_ONE grey levels; 0 when there
 * is none. */
int asj_edge_section(const double *means, int32_t count, double section[ASJ_EDGE_SAMPLES]);

/* Operations (core/ops.h). */
typedef struct asj_edge_ops {
    /* asj_edge_rows() */
    int32_t (*rows)(const asj_edge_line *line, int32_t first, int32_t step, int32_t count, int32_t *levels, ptrdiff_t room);
    /* asj_edge_fan_means() */
    void (*fan)(const asj_frame *frame, const asj_edge_fan *fan, double x, double y, double means[ASJ_FAN_RAYS]);
} asj_edge_ops;
extern const asj_edge_ops asj_edge_reference;

#endif
