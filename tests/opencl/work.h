/* SPDX-License-Identifier: BSD-2-Clause */
/* What these tests let a device do: two small images, a detection in each, the local junctions of one, a match. */
#ifndef ASJ_TESTS_OPENCL_WORK_H
#define ASJ_TESTS_OPENCL_WORK_H

#include <asj/asj.h>

#define WORK_WIDTH 80
#define WORK_HEIGHT 62

typedef struct work_images {
    asj_image of[2];
} work_images;

typedef struct work_answer {
    asj_junction *junctions[2];
    asj_local_branch *field; /* of the first image; NULL = the call did not come so far */
    asj_junction_match *matches;
    size_t counts[2], match_count;
    int32_t backend;
} work_answer;

/* 0, or -1 when memory is short. */
int work_images_make(work_images *images);
void work_images_free(work_images *images);

/* *answer is to be forgotten in any case. */
asj_status work_run(asj_context *context, const work_images *images, work_answer *answer);
void work_forget(work_answer *answer);
int work_same(const work_answer *a, const work_answer *b);

/* Exit code where there is no device: 77, a test that is skipped; 1 when ASJ_REQUIRE_OPENCL is 1. */
int work_without_device(void);

#endif
