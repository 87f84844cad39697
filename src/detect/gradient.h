/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 1: image -> normalised gradient. */
#ifndef ASJ_SRC_GRADIENT_H
#define ASJ_SRC_GRADIENT_H

#include "core/image.h"

/* Units of the normalised gradient, and the largest norm that it can have (see gradient.c). */
#define ASJ_GRADIENT_ONE 1024
#define ASJ_GRADIENT_LIMIT 3.5
#define ASJ_GRADIENT_SIGMA 7825 /* sigma_0 in 1/10000 */

/* Fills frame->gradient_x and frame->gradient_y from frame->gray. */
asj_status asj_gradient(asj_context *context, asj_frame *frame, const asj_detect_options *options);

/* ---- parts of it, for one row ---- */

/* Elements on either side of the pixels in the rows of norms and sums. */
#define ASJ_GRADIENT_PAD 32

/* A row of the gray plane. From gray, at least 1 element is readable before x = 0; from all three, as many behind x = width - 1 as
 * make whole vectors of 32, and 1. */
typedef struct asj_gradient_row {
    const uint16_t *above, *gray, *below;
    int32_t width;
    int32_t window_rows; /* rows of the 5x5 windows around this row that are inside the image */
    uint32_t epsilon;    /* in 1/256 */
} asj_gradient_row;

/* Puts |g| of a row, in 1/256, in the place of |g| of another, `norms`, and does the same in the column sums: those of the low
 * bytes and those of the high bytes. All three from x = 0 on; elements behind the last pixel are zero afterwards where
 * asj_gradient_normalise() reads them. */
void asj_gradient_slide(const asj_gradient_row *row, uint16_t *norms, uint16_t *low, uint16_t *high);

/* The normalised gradient from |g| of the row and the column sums of its windows. Elements of gx and gy behind the last pixel are
 * zero or left alone. */
void asj_gradient_normalise(const asj_gradient_row *row, const uint16_t *norms, const uint16_t *low, const uint16_t *high,
                            int16_t *gx, int16_t *gy);

/* The same for one pixel. */
void asj_gradient_pixel(const asj_gradient_row *row, int32_t x, const uint16_t *norms, const uint16_t *low, const uint16_t *high,
                        int16_t *gx, int16_t *gy);

/* What depends on the number of pixels in the window: 65536 C_c, c epsilon, c T of gradient.c. */
typedef struct asj_gradient_factors {
    uint32_t numerator, epsilon, limit;
} asj_gradient_factors;
asj_gradient_factors asj_gradient_set_factors(int32_t columns, int32_t rows, uint32_t epsilon);

/* Operations (core/ops.h): step 1 as a whole, which a device replaces, and its parts for a row. */
typedef struct asj_gradient_ops {
    /* asj_gradient() */
    asj_status (*planes)(asj_context *context, asj_frame *frame, const asj_detect_options *options);
    /* asj_gradient_slide() */
    void (*slide)(const asj_gradient_row *row, uint16_t *norms, uint16_t *low, uint16_t *high);
    /* asj_gradient_normalise() */
    void (*normalise)(const asj_gradient_row *row, const uint16_t *norms, const uint16_t *low, const uint16_t *high,
                      int16_t *gx, int16_t *gy);
} asj_gradient_ops;
extern const asj_gradient_ops asj_gradient_reference;

#endif
