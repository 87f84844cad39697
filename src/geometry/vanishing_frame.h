/* SPDX-License-Identifier: BSD-2-Clause */
/* Three directions at right angles that the lines of an image have. */
#ifndef ASJ_SRC_GEOMETRY_VANISHING_FRAME_H
#define ASJ_SRC_GEOMETRY_VANISHING_FRAME_H

#include "core/context.h"
#include "vanishing_vote.h"

#define ASJ_USUAL_FOCAL 2.0 /* where none is known: the longer side of the image, in units of half of it */

typedef struct asj_vanishing_frame {
    asj_vote points[3];
    double directions[3][3]; /* of the points, in the coordinates of the camera */
    double focal;            /* in the coordinates of the vote: 1 where the camera is known */
    double log_nfa;          /* natural logarithm: of the first point, the second one given that, and the third one, in all; and
                              * what an unusual focal length costs */
    int32_t count;           /* of points that are sure: they come first, the surest first; 0 or at least 2 */
} asj_vanishing_frame;

/* The frame that is least likely by chance, of those whose NFA has a natural logarithm of at most `most`: with that focal length,
 * or, where it is 0, with one that it determines. count 0: there is none. ASJ_ERROR_MEMORY: out of it. */
asj_status asj_find_frame(asj_context *context, asj_vote_search *s, double focal, double most, asj_vanishing_frame *frame);

#endif
