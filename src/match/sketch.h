/* SPDX-License-Identifier: BSD-2-Clause */
/* A few numbers about a patch that tell with how many others it is worth comparing. */
#ifndef ASJ_SRC_SKETCH_H
#define ASJ_SRC_SKETCH_H

#include "distance.h"

#define ASJ_SKETCH 32       /* numbers in a sketch: 30 coefficients, the rest, the slack */
#define ASJ_SKETCH_LANES 16 /* sketches on the right lie together: number 2 k and 2 k + 1 of all of them, then the next two */

/* Of all frames of a view: normalised raw patches only. Those on the left follow each other; on the right there are
 * asj_sketch_blocks() blocks, the last one filled up with zeros. Release them. */
asj_status asj_sketch_left(asj_context *context, const asj_match_options *options, const asj_view *view, int16_t **sketches);
asj_status asj_sketch_right(asj_context *context, const asj_match_options *options, const asj_view *view, int16_t **sketches);
int32_t asj_sketch_blocks(uint32_t frames);

/* No bound is below it; thresholds lie within it and as much above zero. */
#define ASJ_SKETCH_LEAST (-0x40000000)

/* Those of `right` from first to end - 1 whose patch's product with that of `left` may be above the smaller of most and of its
 * number in `least`: writes which, in order, and returns how many. `least` has a number for each sketch of whole blocks. */
int32_t asj_sketch_above(const int16_t *left, const int16_t *right, const int32_t *least, int32_t most, int32_t first, int32_t end,
                         int32_t *which);

/* Operations (core/ops.h). */
typedef struct asj_sketch_ops {
    /* asj_sketch_above() */
    int32_t (*above)(const int16_t *left, const int16_t *right, const int32_t *least, int32_t most, int32_t first, int32_t end,
                     int32_t *which);
} asj_sketch_ops;
extern const asj_sketch_ops asj_sketch_reference;

#endif
