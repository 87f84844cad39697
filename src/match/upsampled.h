/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches of junctions of octave -1, in the upsampled images, where they hold. */
#ifndef ASJ_SRC_UPSAMPLED_H
#define ASJ_SRC_UPSAMPLED_H

#include "alignments.h"
#include "match_result.h"

/* Whether some are of octave -1. */
int32_t asj_has_upsampled(const asj_junction *junctions, size_t count);

/* Matches of the images, which say where those of the upsampled ones lie (expected.h). */
typedef struct asj_known_matches {
    const asj_match_result *result;
    asj_stretch by[2]; /* px of the images that are looked at for a px of these; 1, 1 = the same */
} asj_known_matches;

/* Matches two images once: `upsampled` says whether those that have junctions of octave -1 are looked at upsampled; otherwise such
 * junctions are none. `known` may be NULL. Results are in pixels of the images. */
typedef asj_status (*asj_match_pass)(asj_context *context, const asj_match_options *options, const void *data, int32_t upsampled,
                                     const asj_known_matches *known, asj_match_result **result);

typedef struct asj_upsampled_match {
    asj_match_pass pass;
    const void *data;                 /* for it */
    const asj_junction *junctions[2]; /* all of both images */
    size_t counts[2];
    int32_t upsampled_only;            /* the caller asks for the witness: see asj_upsampled_choose(), */
    const asj_known_matches *known;   /* .. and has these; else NULL */
} asj_upsampled_match;

/* The passes that are needed, and the result that holds: see upsampled.c. */
asj_status asj_match_upsampled(asj_context *context, const asj_match_options *options, const asj_upsampled_match *match,
                               asj_match_result **result);

/* Leaves in *own what holds of *own, of the images as they are, and *upsampled, of the upsampled ones, which is freed. same_lists:
 * their L-junctions have the same numbers. */
asj_status asj_upsampled_choose(asj_context *context, asj_match_result **own, asj_match_result **upsampled, int32_t same_lists);

/* An image that is matched, and its junctions. */
typedef struct asj_match_source {
    const asj_image *image;
    const asj_junction *junctions;
    size_t count;
} asj_match_source;

/* asj_match() as one of several looks at two images, whose pose is not finished (final_pose.h), with options that are checked, and
 * with cameras of stretched images perhaps. `upsampled`: of the upsampled images alone; known may be NULL. alignments: NULL, or
 * those that are known of these images; more afterwards. Errors as of asj_match(). */
asj_status asj_match_look(asj_context *context, const asj_match_source sources[2], const asj_match_options *options,
                          int32_t upsampled, const asj_known_matches *known, asj_alignments *alignments,
                          asj_match_result **result);

#endif
