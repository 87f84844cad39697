/* SPDX-License-Identifier: BSD-2-Clause */
/* The estimation as the matcher calls it. */
#ifndef ASJ_SRC_GEOMETRY_ESTIMATE_H
#define ASJ_SRC_GEOMETRY_ESTIMATE_H

#include <asj/geometry.h>

/* asj_geometry_estimate(), and what colours say of geometries that contradict each other (colour_vote.c). colours: of each
 * candidate, how well they agree, as a logarithm, 0 where nothing is known; their priors have it already. NULL = images without
 * colours. */
asj_status asj_estimate_with_colours(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                                     const double *colours, const asj_geometry_options *options, double *probabilities,
                                     asj_geometry *result);

#endif
