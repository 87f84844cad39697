/* SPDX-License-Identifier: BSD-2-Clause */
/* The L-junctions of one image as the matcher works on them: frames, length hypotheses, places. */
#ifndef ASJ_SRC_CORNERS_H
#define ASJ_SRC_CORNERS_H

#include "affine.h"
#include "core/context.h"

#include <asj/match.h>

#define ASJ_MAX_HYPOTHESES 4

/* Lengths that a branch may have, its own first, then falling. */
typedef struct asj_lengths {
    int32_t count;
    float length[ASJ_MAX_HYPOTHESES];
} asj_lengths;

typedef struct asj_corners {
    asj_l_junction *l;           /* as asj_decompose() gives them */
    uint32_t count;
    asj_lengths *lengths;        /* [2 * i] of branch a, [2 * i + 1] of branch b */
    double *direction;           /* [4 * i]: unit vectors of branch a and of branch b */
    uint32_t *first_frame;       /* frames of L-junction i: first_frame[i] .. first_frame[i + 1] - 1; own lengths come first */
    asj_affine_frame *frames;
    uint32_t frame_count;

    /* Places: distinct locations. L-junctions of one junction share theirs; so do records of a file with the same coordinates. */
    uint32_t *place;             /* of each L-junction */
    uint32_t place_count;        /* in order of x */
    uint32_t *first_of_place;    /* place p has l_of_place[first_of_place[p]] .. l_of_place[first_of_place[p + 1] - 1] */
    uint32_t *l_of_place;
    uint8_t *stem;               /* of each L-junction: is it part of a T? One of its branches goes on beyond the location */
    double *place_x, *place_y;
    uint32_t *neighbour;         /* [k * place .. + neighbour_count[place]]: nearest other places, nearest first */
    uint32_t *neighbour_count;
    uint32_t neighbour_limit;    /* k */
} asj_corners;

/* Makes everything from junctions. `which` (1 or 2) is for messages.
 * ASJ_ERROR_ARGUMENT (see asj_match()), ASJ_ERROR_LIMIT, ASJ_ERROR_MEMORY. On failure the caller still frees. */
asj_status asj_corners_create(asj_context *context, const asj_junction *junctions, size_t count, int32_t width, int32_t height,
                              const asj_match_options *options, int32_t which, asj_corners *corners);
void asj_corners_free(asj_memory *memory, asj_corners *corners);

/* The first place that is not left of x. */
uint32_t asj_first_place(const asj_corners *corners, double x);

#endif
