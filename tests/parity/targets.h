/* SPDX-License-Identifier: BSD-2-Clause */
/* What is compared with the reference: every variant of the CPU, and every OpenCL device in each of its forms. Each has a context
 * of its own. */
#ifndef ASJ_TESTS_PARITY_TARGETS_H
#define ASJ_TESTS_PARITY_TARGETS_H

#include "tables.h"

/* How a device is used. */
enum {
    FORM_NONE,  /* no device */
    FORM_OWN,   /* as the library does */
    FORM_OTHER, /* with the kernels made for another type of device */
    FORM_BANDS  /* as if only few rows of an image fit */
};

typedef struct target {
    char name[64];
    asj_context *context; /* NULL = not available here */
    int32_t form;
    long compared;
} target;

#define MOST_TARGETS 32

/* The first is the reference. */
typedef struct target_list {
    target targets[MOST_TARGETS];
    int32_t count;
    int devices; /* the targets are devices, else variants of the CPU */
} target_list;

/* Opens the reference and either the variants or the devices; one thread each. Returns how many there are beside the reference, or
 * -1 with a line on standard error. */
int32_t targets_open(int devices, target_list *list);
void targets_close(target_list *list);

/* What an exit status says when there is nothing to compare: 77, or 1 when a device is required (ASJ_REQUIRE_OPENCL). */
int targets_missing(const target_list *list);

/* Prints how many `things` were compared on every target, and the verdict on what was `found` in all. Returns the exit status: 1
 * when something has failed or nothing was found. */
int targets_report(const target_list *list, const char *things, size_t count, const char *found, int failed);

/* Before an operation on planes of `stride` samples a row whose contents the target has not seen. */
void target_prepare(target *t, ptrdiff_t stride);

#endif
