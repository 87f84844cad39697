/* SPDX-License-Identifier: BSD-2-Clause */
/* What all calls with a context share. create.c, above everything, makes one and puts its parts into it. */
#ifndef ASJ_SRC_CONTEXT_H
#define ASJ_SRC_CONTEXT_H

#include "memory.h"
#include "ops.h"

#include <asj/detect.h>

/* What another part of the library keeps in a context from call to call. */
typedef struct asj_kept {
    void *state;                                    /* NULL = nothing yet */
    void (*free)(asj_memory *memory, void *state);
} asj_kept;

/* What is asked of the device that works for a context. */
typedef struct asj_device_calls {
    const char *(*name)(const asj_context *context);
    asj_status (*prepare)(asj_context *context); /* builds all programs that have not been built yet */
    void (*free)(asj_context *context);          /* context->cl is NULL afterwards */
} asj_device_calls;

struct asj_context {
    asj_memory memory;
    asj_context_options options;
    int32_t threads;              /* >= 1 */
    int32_t simd;                 /* ASJ_SIMD_...: the form that cpu_ops have */
    const asj_ops *ops;           /* those in use: the device's, where there is one, or */
    const asj_ops *cpu_ops;       /* the processor's */
    struct asj_cl *cl;            /* the device that works; NULL = none, the CPU does everything */
    struct asj_cl *cl_aside;      /* the device, and its operations, while a call does without it (backend.h) */
    const asj_ops *ops_aside;
    const asj_device_calls *device;
    asj_kept pool;                /* core/threads.h */
    asj_kept tables;              /* tables.h: what the operations above point to */
    asj_kept detector;            /* detect/detection_run.h: scratch and tables of the detector */
    double progress;              /* last value reported */
    double progress_from, progress_part; /* where the whole stands when a call begins that is a part of it, and how large that part
                                          * is; 0, 0: the call is the whole */
    double asked_ms;              /* when the caller was last asked whether to go on, */
    double pause_ms;              /* and how long not to ask again: ASJ_PAUSE; tests that count questions have 0 */
    int32_t in_hook;              /* > 0 while a function of the caller's runs (log, progress, dump, kernel cache) */
    int32_t device_failures;      /* backend.h */
    int32_t optional;             /* > 0 in steps that the answer does not need: asj_optional_begin() */
    char message[512];
};

/* Which argument is a format as printf() has it, and the first of what it names. MinGW means the printf() of old Windows by that,
 * which knows no %zu; meson.build asks for the one of C99. */
#if defined(__MINGW32__)
#define ASJ_PRINTF(text, first) __attribute__((format(gnu_printf, text, first)))
#elif defined(__GNUC__)
#define ASJ_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define ASJ_PRINTF(text, first)
#endif

/* How a public function begins. ASJ_ERROR_ARGUMENT without a context, and when a hook calls while the call that it belongs to is
 * not done: that has the context's memory. The hook is not called about it. */
asj_status asj_enter(asj_context *context);

/* Stores the message of asj_context_message() and logs it as an error, unless the call may go on without the device; returns
 * `status`, so that a failing function can end with
 * `return asj_fail(context, ASJ_ERROR_IMAGE, "stride %td is shorter than a row", stride);` */
asj_status asj_fail(asj_context *context, asj_status status, const char *format, ...)
    ASJ_PRINTF(3, 4);

/* Around a step that the answer does not need. What is beyond a limit there is left out: asj_fail() tells of it as information and
 * not as what went wrong, and the end makes ASJ_OK of ASJ_ERROR_LIMIT, which depends on the images alone. What depends on the
 * machine (memory, a device) stays an error: the answer would not be the same each time. There may be others inside. */
void asj_optional_begin(asj_context *context);
asj_status asj_optional_end(asj_context *context, asj_status status);

void asj_log(asj_context *context, int32_t level, const char *format, ...)
    ASJ_PRINTF(3, 4);

/* Hands a dump to the caller, who may want none. */
void asj_dump_out(asj_context *context, const asj_dump *dump);

/* Reports progress; ASJ_ERROR_CANCELLED when the caller wants to stop. */
asj_status asj_progress(asj_context *context, int32_t stage, double done);

/* Wall clock in milliseconds from an arbitrary start. */
double asj_clock_ms(void);

#endif
