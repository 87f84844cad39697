/* SPDX-License-Identifier: BSD-2-Clause */
/* A focal length that nobody knows, found with the motion: focal.c. */
#ifndef ASJ_SRC_GEOMETRY_FOCAL_H
#define ASJ_SRC_GEOMETRY_FOCAL_H

#include "estimate.h"
#include "focal_profile.h"
#include "search.h"

/* The search for it, which keeps what it knows of the images. */
typedef struct asj_focal_search asj_focal_search;

/* search: samples, seed and least count; of its cameras the principal points, and the focal lengths as the longer sides or, with an
 * sd (of their logarithms, both in the same way), about as they are. hints may be NULL. From then on set has the directions of the
 * focal length that was looked at last. All is to be freed after a failure, too. ASJ_ERROR_MEMORY. */
asj_status asj_focal_search_create(asj_context *context, asj_pairs *set, const asj_geometry_hints *hints, const asj_search *search,
                                   double sd, asj_focal_search **created);
void asj_focal_search_free(asj_memory *memory, asj_focal_search *s);

/* What homographies explain: a focal length that is about known stays as it is, but for what edges say, where that is what the
 * motion does. Before the search. */
void asj_focal_search_flat(asj_focal_search *s, const asj_model *flat, int32_t count);

/* flat: homographies that were found already, `count` of them at most ASJ_FINALISTS, whose motions are tried too. */
asj_status asj_find_focal(asj_focal_search *s, const asj_model *flat, int32_t count, asj_focal *found);

/* The same from one motion on, which has a focal length. */
asj_status asj_find_focal_of(asj_focal_search *s, const asj_model *motion, asj_focal *found);

/* The same of a camera that only turns, from the homographies on and from the motion, which has a focal length. ->model.evidence is
 * -HUGE_VAL where there is none. */
asj_status asj_find_focal_of_rotation(asj_focal_search *s, const asj_model *flat, int32_t count, const asj_model *motion,
                                      asj_focal *found);

/* The set with the directions of a focal length that was found before. ASJ_ERROR_MEMORY. */
asj_status asj_focal_search_turn(asj_focal_search *s, const asj_focal *found);

/* All motions with the focal length that was found, their evidence as that of found->model; list has room for 3 ASJ_FINALISTS. */
asj_status asj_find_with_focal(asj_focal_search *s, const asj_focal *found, const asj_model *flat, int32_t flat_count,
                               asj_model *list, int32_t *count);

#endif
