/* SPDX-License-Identifier: BSD-2-Clause */
/* Which junctions of an image are found again in a changed copy of it, one to one, closest first. By the paper's criterion
 * (section "Comparison with ACJ") junction 1 of the image and junction 2 of the copy, which is s times as large, correspond when
 * they have the same number of branches and
 *     |s p1 - p2| < 3 px,  max over theta1 of min over theta2 of d(theta1, theta2) < pi / 20,
 *     max over r1 of min over r2 of |s r1 - r2| < 3 px. */
#ifndef ASJ_TESTS_ACCURACY_CORRESPOND_H
#define ASJ_TESTS_ACCURACY_CORRESPOND_H

#include <asj/junction.h>

#define CORRESPOND_DISTANCE 3.0 /* px */

enum {
    CORRESPOND_WHOLE,  /* the paper's */
    CORRESPOND_PAIRED, /* angle and length have to agree branch by branch */
    CORRESPOND_PLACE   /* the location alone */
};

/* Why junctions at one place do not correspond by the paper's criterion: what is asked first counts. */
enum { CORRESPOND_AGREES, CORRESPOND_BRANCHES, CORRESPOND_ANGLES, CORRESPOND_LENGTHS, CORRESPOND_FAULTS };

typedef struct correspond_list {
    const asj_junction *junctions;
    uint32_t count;
} correspond_list;

/* The point (x, y) of the image is at (x sx + tx, y sy + ty) of the copy. */
typedef struct correspond_map {
    double sx, sy, tx, ty;
} correspond_map;

/* Of a copy scaled about the image's corner, so that pixels' areas map. */
correspond_map correspond_scaling(double sx, double sy);

/* CORRESPOND_...: the fault of junction b of a copy that is `scale` times as large, seen as junction a. */
int correspond_fault(const asj_junction *a, const asj_junction *b, double scale);

/* Number of correspondences, or -1 (memory). partner[i]: the junction of the copy that is junction i, or UINT32_MAX; NULL = not
 * asked for. */
int32_t correspond(const correspond_list *image, const correspond_list *copy, const correspond_map *map, int criterion,
                   uint32_t *partner);

#endif
