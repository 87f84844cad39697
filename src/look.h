/* SPDX-License-Identifier: BSD-2-Clause */
/* Two images looked at together under one stretch: what asj_match_images() is made of. */
#ifndef ASJ_SRC_LOOK_H
#define ASJ_SRC_LOOK_H

#include "core/context.h"
#include "detect/luma_step.h"
#include "match/alignments.h"

#include <asj/detect.h>
#include <asj/match.h>

/* One of the images. */
typedef struct asj_view {
    asj_image stretched;
    void *pixels; /* NULL: it is the image itself */
    asj_stretch by;
    asj_detection *found;
    asj_junction *junctions; /* with octaves that begin at the image's size */
} asj_view;

typedef struct asj_look {
    asj_context *context;
    asj_view views[2];
    asj_stretch stretch;
    asj_alignments *alignments; /* of images so stretched; NULL: none are kept */
    double progress_from, progress_part; /* of the caller's whole */
} asj_look;

/* May an image of this size be stretched so? */
int32_t asj_look_fits(const asj_image *image, const asj_stretch *stretch);

/* Stretches both images and detects in them: `progress_part` of the whole call, from `progress_from` on, is what this and
 * asj_look_match() do together. luma: NULL, or what is known of both images so stretched, or will be (detect/luma_step.h). To be
 * closed whatever comes of it. Errors as of asj_match_images(). */
asj_status asj_look_open(asj_context *context, const asj_image *const images[2], const asj_stretch *stretch,
                         const asj_detect_options *options, asj_luma_found *luma, double progress_from, double progress_part,
                         asj_look *look);

/* Matches what was detected; everything in the result is in pixels of the images as they are, but its times are those of the
 * matching alone. */
asj_status asj_look_match(const asj_look *look, const asj_match_options *options, asj_match_result **result);

/* The same of images that the detector has upsampled (first_octave -1), and of these alone, of the options->upsampled_max_junctions
 * most meaningful junctions of each, where the images' own matches put them: the witness that is to be asked
 * (match/upsampled.h). */
asj_status asj_look_match_upsampled(const asj_look *look, const asj_match_options *options, const asj_match_result *own,
                                    asj_match_result **result);

/* Adds the times of the detections, by ASJ_STAGE_.... */
void asj_look_add_times(const asj_look *look, double *stage_ms);

void asj_look_close(asj_look *look);

#endif
