/* SPDX-License-Identifier: BSD-2-Clause */
/* Features with some of their frames only, for steps that look at all pairs. */
#ifndef ASJ_SRC_SUBSET_H
#define ASJ_SRC_SUBSET_H

#include "match_run.h"

/* Everything but what is named here is shared with the features that it is of. */
typedef struct asj_subset {
    asj_image_features features;
    asj_affine_frame *frames;
    uint32_t *first_frame;
    uint32_t *patch_of;
    uint8_t *usable;
} asj_subset;

/* Of image `side`, without the frames of guests (l_junctions.h); with `first_only` with the first frame of each L-junction only;
 * with `most` > 0 of the so many most meaningful L-junctions only, and their equals. L-junctions keep their numbers; those without
 * a frame are compared with nothing. Canonical patches. Free it either way. */
asj_status asj_subset_create(const asj_match_run *run, int32_t side, int32_t first_only, uint32_t most, asj_subset *subset);
void asj_subset_free(asj_memory *memory, asj_subset *subset);

#endif
