/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_FIELD_H
#define ASJ_FIELD_H

#include <asj/detect.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ASJ_FIELD_BRANCHES 4

/* The very local junction at one pixel: its branches, strongest first. */
typedef struct asj_local_branch {
    float angle;     /* rad in [0, 2 pi) */
    float strength;  /* standard deviations of the null model; 0 = no branch in this slot */
    float log10_nfa; /* log10 of (sectors of the pixel) x tail */
} asj_local_branch;

/* The dense field, for those who want step 2 alone: `branches` receives width x height x ASJ_FIELD_BRANCHES records, row by
 * row, owned by the caller. Uses the options of steps 1 and 2; octaves are none of these: it is the field of the image as it is.
 * One call at a time for a context. Statuses as asj_detect(); ASJ_ERROR_ARGUMENT also when branches is NULL. After
 * ASJ_ERROR_CANCELLED and ASJ_ERROR_DEVICE a part of `branches` may have been written. */
ASJ_API asj_status asj_local_field(asj_context *context, const asj_image *image, const asj_detect_options *options,
                                   asj_local_branch *branches);

#ifdef __cplusplus
}
#endif
#endif
