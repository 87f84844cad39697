/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches of stretched images (core/stretch.h) in pixels of the images themselves. */
#ifndef ASJ_SRC_UNSTRETCH_H
#define ASJ_SRC_UNSTRETCH_H

#include <asj/geometry.h>
#include <asj/match.h>

/* A pixel of the image is by->x times by->y pixels of the stretched one. */
void asj_unstretch_matches(asj_junction_match *matches, size_t count, const asj_stretch by[2]);
void asj_unstretch_l_junctions(asj_l_junction *list, uint32_t count, const asj_stretch *by);
/* The other way round, for a candidate's locations and map. */
void asj_stretch_candidate(asj_geometry_candidate *g, const asj_stretch by[2]);
void asj_unstretch_geometry(asj_geometry *geometry, const asj_stretch by[2]);
/* By rows, to the norm 1. */
void asj_unstretch_fundamental(double matrix[9], const asj_stretch by[2]);

/* The camera of the stretched image. */
asj_camera asj_stretch_camera(const asj_camera *camera, const asj_stretch *by);

#endif
