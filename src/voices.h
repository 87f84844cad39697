/* SPDX-License-Identifier: BSD-2-Clause */
/* Which candidates agree with which. */
#ifndef ASJ_SRC_VOICES_H
#define ASJ_SRC_VOICES_H

#include "distance.h"

/* Candidates of each place of one image: order[start[p]] .. order[start[p + 1] - 1]. */
typedef struct asj_place_index {
    uint32_t *start;
    uint32_t *order;
} asj_place_index;

/* Of the candidates with such a number or a larger one; side 1 or 2. */
asj_status asj_place_index_create(asj_context *context, const asj_corners *corners, const asj_candidates *candidates, int32_t side,
                                  uint32_t least_number, asj_place_index *index);
void asj_place_index_free(asj_memory *memory, asj_place_index *index);

/* A candidate at a neighbour place that agrees. */
typedef struct asj_voice {
    uint32_t number; /* of the candidate, less 1 */
    uint16_t weight; /* agreement in 1/ASJ_VOICE_ONE; not 0 */
    uint16_t place;  /* which of the neighbour places it belongs to */
} asj_voice;
#define ASJ_VOICE_ONE 65535.0f

/* What candidates hear from the neighbour places of one image, neighbour place by neighbour place. That of number n + 1 hears
 * voices[offset[n]] .. voices[offset[n] + heard[n] - 1]. */
typedef struct asj_hearing {
    size_t *offset;
    uint32_t *heard;
    asj_voice *voices;
} asj_hearing;

/* Agreement never changes, so it is kept while candidates become more. All zero at first. */
typedef struct asj_voices {
    asj_hearing side[2];
    uint32_t count;  /* of candidates that are heard: numbers 1 .. count */
} asj_voices;

/* Gives numbers to the candidates that have none, and adds what they say and hear. */
asj_status asj_voices_extend(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                             asj_candidates *candidates, asj_voices *voices);
void asj_voices_free(asj_memory *memory, asj_voices *voices);

#endif
