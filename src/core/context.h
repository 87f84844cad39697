/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_CONTEXT_H
#define ASJ_SRC_CONTEXT_H

#include "memory.h"
#include "detect/nfa.h"

#include <asj/detect.h>

struct asj_cl;       /* cl/state.h: an OpenCL device */
struct asj_ops;      /* ops.h */
struct asj_detector; /* detect.c: scratch of the detector, kept from image to image */

struct asj_context {
    asj_memory memory;
    asj_context_options options;
    int32_t threads;              /* >= 1 */
    struct asj_ops *ops;          /* the operations in the best form that this machine has */
    struct asj_cl *cl;            /* the device that works; NULL = none, the CPU does everything */
    asj_nfa *nfa;
    struct asj_detector *detector;
    double progress;              /* last value reported */
    int32_t device_failures;      /* backend.h */
    char message[512];
};

/* asj_context_create() with another libOpenCL than the system's, for tests; NULL = the system's. */
asj_status asj_context_create_from(const char *library, const asj_context_options *options, asj_context **context);

/* Stores the message of asj_context_message() and logs it as an error, unless the call may go on without the device; returns
 * `status`, so that a failing function can end with
 * `return asj_fail(context, ASJ_ERROR_IMAGE, "stride %td is shorter than a row", stride);` */
asj_status asj_fail(asj_context *context, asj_status status, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

void asj_log(asj_context *context, int32_t level, const char *format, ...)
#ifdef __GNUC__
    __attribute__((format(printf, 3, 4)))
#endif
    ;

/* Reports progress; ASJ_ERROR_CANCELLED when the caller wants to stop. */
asj_status asj_progress(asj_context *context, int32_t stage, double done);

/* Wall clock in milliseconds from an arbitrary start. */
double asj_clock_ms(void);

#endif
