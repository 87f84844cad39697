/* SPDX-License-Identifier: BSD-2-Clause */
/* What alignments have come to, for the same ones in later lists of candidates. */
#ifndef ASJ_SRC_ALIGNMENTS_H
#define ASJ_SRC_ALIGNMENTS_H

#include "core/context.h"

/* A map of the template's disc into the source: source = (x, y) + linear (template - its centre). */
typedef struct asj_disc_pose {
    double x, y;
    double linear[4];
} asj_disc_pose;

/* All that decides what an alignment comes to, of two images with the same options. No gaps: compared byte by byte. */
typedef struct asj_alignment_key {
    double linear[4], x, y; /* of the template */
    float to_x, to_y;
    uint16_t side, steps;   /* the template's image; most steps */
    uint16_t upsampled[2];  /* of either image: is it looked at upsampled? */
} asj_alignment_key;

typedef struct asj_known_alignment {
    asj_alignment_key key;
    asj_disc_pose pose;
    float similarity;
    int32_t moved;
    uint32_t first; /* which one of the list that added it has to fill it in */
} asj_known_alignment;

/* All zeros: none yet. */
typedef struct asj_alignments {
    asj_known_alignment *list;
    uint32_t *slots; /* by hash: numbers in the list and one more; 0: free */
    size_t count, capacity, slot_count;
} asj_alignments;

/* Room for so many more. ASJ_ERROR_MEMORY. */
asj_status asj_alignments_reserve(asj_context *context, asj_alignments *known, size_t more);

/* The number of the one with this key, which is added where there is none (there must be room): `first` tells for whom. */
uint32_t asj_alignments_number(asj_alignments *known, const asj_alignment_key *key, uint32_t first);

void asj_alignments_free(asj_memory *memory, asj_alignments *known);

#endif
