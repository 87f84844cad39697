/* SPDX-License-Identifier: BSD-2-Clause */
/* Which directions of the room the branches of candidates point along, and what that says of rotations. */
#ifndef ASJ_SRC_GEOMETRY_LABELS_H
#define ASJ_SRC_GEOMETRY_LABELS_H

#include "directions.h"

#include <asj/geometry.h>

/* Of a branch along direction `axis` (0 to 2) or, backward = 1, against it; 0 = along none. */
#define ASJ_LABEL(axis, backward) (1 + 2 * (axis) + (backward))

/* Those of all candidates, in every set of directions of either image. branches: as in asj_geometry_hints. */
void asj_set_labels(asj_pairs *set, const double *branches, const asj_directions_list directions[2], const asj_camera cameras[2]);

/* Puts set->rotations into falling order of what the labels say of them, with their shares. 0: no memory. */
int32_t asj_order_rotations(asj_memory *memory, asj_pairs *set);

/* The first of set->rotations within a few degrees of the rotation; NULL: none. */
const asj_likely_rotation *asj_named_rotation(const asj_pairs *set, const double rotation[9]);

/* How much likelier the labels of a candidate are when it is right and the rotation as well than when it is wrong. */
double asj_label_ratio(const asj_likely_rotation *rotation, const asj_pair *c);

#endif
