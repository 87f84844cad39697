/* SPDX-License-Identifier: BSD-2-Clause */
/* What the operations are run on: planes of a size and content, and tables for a set of options. */
#ifndef ASJ_TESTS_PARITY_SUBJECT_H
#define ASJ_TESTS_PARITY_SUBJECT_H

#include "tables.h"
#include "random.h"

enum {
    CONTENT_RANDOM,    /* gradients of any size and direction */
    CONTENT_ZERO,
    CONTENT_CONSTANT,  /* one gradient everywhere */
    CONTENT_SATURATED, /* the largest norm, along the axes and the diagonals, in patches */
    CONTENT_SPARSE,    /* mostly zero */
    CONTENT_SCENE,     /* a picture with corners and noise */
    CONTENT_COUNT
};
const char *content_name(int32_t content);

typedef struct subject {
    asj_context *context;
    asj_detect_options options;
    asj_frame frame;
    asj_frame *picture;  /* only its gray plane has contents: what asj_gradient() is run on */
    uint8_t *colours;    /* 4 bytes for each pixel of a row */
    asj_field field;
    asj_isotropic isotropic;
    int32_t content;
    uint64_t seed;
    synth_random random; /* for choices that an operation makes; the same for every variant */
    size_t scratch_size; /* elements of uint16_t */
} subject;

/* 1, or 0 with a line on standard error. All choices follow from the arguments. */
int subject_create(asj_context *context, int32_t width, int32_t height, int32_t content, int32_t radius, double tau, uint64_t seed,
                   subject *s);
void subject_free(subject *s);

#endif
