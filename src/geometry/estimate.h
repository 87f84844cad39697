/* SPDX-License-Identifier: BSD-2-Clause */
/* The estimation as the matcher calls it. */
#ifndef ASJ_SRC_GEOMETRY_ESTIMATE_H
#define ASJ_SRC_GEOMETRY_ESTIMATE_H

#include "directions.h"
#include "judge.h"
#include "picture.h"

#include <asj/geometry.h>

/* What images tell beside their candidates. */
typedef struct asj_geometry_hints {
    const double *colours;             /* of each candidate, how well they agree, as a logarithm, 0 where nothing is known; their
                                        * priors have it already (colour_vote.c). NULL = images without colours */
    const double *branches;            /* of each candidate ASJ_BRANCH_NUMBERS, unit vectors, px: branch a and b of its L-junction
                                        * in image 1, then in image 2 (labels.c). NULL = not known */
    asj_directions_list directions[2]; /* of each image's edges, count 0 = none; options->directions are taken before them */
    const asj_edge_list *edges;        /* straight ones of both images, where their focal length is looked for; NULL = not
                                        * known */
    asj_picture pictures[2];           /* what the images look like (picture_look.c), with as many channels; 0 of these = not
                                        * known */
} asj_geometry_hints;

/* asj_geometry_estimate() with that; hints and judge may be NULL. judge: written where the geometry is accepted. */
asj_status asj_estimate_with_hints(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                                   const asj_geometry_hints *hints, const asj_geometry_options *options, double *probabilities,
                                   asj_judge *judge, asj_geometry *result);

#endif
