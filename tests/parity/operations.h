/* SPDX-License-Identifier: BSD-2-Clause */
/* The operations of the table, each brought into one form: from a subject to bytes. */
#ifndef ASJ_TESTS_PARITY_OPERATIONS_H
#define ASJ_TESTS_PARITY_OPERATIONS_H

#include "subject.h"

typedef struct operation {
    const char *name;
    int whole;                          /* over the whole image: devices have it */
    size_t (*size)(const subject *s);   /* bytes that run() may write */
    double (*pixels)(const subject *s); /* of the image that one run() serves */
    double (*bytes)(const subject *s);  /* least traffic of one run(): what goes in and comes out; NULL = not worth telling */
    asj_status (*run)(asj_context *context, const subject *s, uint16_t *scratch, void *output); /* by context->ops */
} operation;

extern const operation operations[];
extern const size_t operation_count;

#endif
