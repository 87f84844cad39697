/* SPDX-License-Identifier: BSD-2-Clause */
/* The steps of the detector over a whole image: threads, memory, progress, dumps. What a step does to one place stands in the file
 * of its name; in which order they run, in detect.c. */
#ifndef ASJ_SRC_STAGES_H
#define ASJ_SRC_STAGES_H

#include "isotropic.h"
#include "locate.h"
#include "scan.h"
#include "scan_cache.h"

/* Tables and scratch of the detector, kept in a context from image to image. */
struct asj_detector {
    asj_frame frame;
    asj_detect_options options; /* the tables below were made for these */
    int ready;
    int32_t width, height;      /* and for images of this size */
    asj_field field;
    asj_isotropic isotropic;
    asj_scan scan;
    asj_scan_cache scan_cache;
};

/* What one call of asj_detect() passes from step to step. */
typedef struct asj_detection_run {
    asj_context *context;
    struct asj_detector *detector;
    const asj_detect_options *options;
    int32_t threads;
    uint16_t *scratch;           /* `scratch_size` elements for each thread */
    size_t scratch_size;
    uint16_t *candidates;        /* one bit for each pixel: run b of row y at [y * blocks + b] */
    asj_isotropic_junction *isotropic;
    size_t isotropic_count;
    asj_draft *drafts;
    size_t draft_count;
    uint64_t candidate_total;
} asj_detection_run;

/* Rows are worked on in groups, between which progress is reported. */
#define ASJ_ROW_GROUP 128

/* Makes the tables for these options and the planes for this size. */
asj_status asj_stage_prepare(asj_detection_run *run, int32_t width, int32_t height);
void asj_stage_release(asj_detection_run *run);

/* The scratch of the calling thread, inside a parallel region. */
uint16_t *asj_stage_scratch(const asj_detection_run *run);

asj_status asj_stage_gradient(asj_detection_run *run, const asj_image *image); /* step 1 */
asj_status asj_stage_candidates(asj_detection_run *run);                       /* step 2 */
asj_status asj_stage_isotropic(asj_detection_run *run);                        /* step 3 */
asj_status asj_stage_locate(asj_detection_run *run);
asj_status asj_stage_scan(asj_detection_run *run);                             /* step 4 */
asj_status asj_stage_orient(asj_detection_run *run);                           /* step 5 */
asj_status asj_stage_validate(asj_detection_run *run);

#endif
