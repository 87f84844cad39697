/* SPDX-License-Identifier: BSD-2-Clause */
/* A libOpenCL that passes everything on to the real one, counts, and fails when it is told to. */
#ifndef ASJ_TESTS_OPENCL_STUB_H
#define ASJ_TESTS_OPENCL_STUB_H

#include <stdint.h>

enum { STUB_SITES = 4096 };
enum { STUB_CONTEXT, STUB_QUEUE, STUB_BUFFER, STUB_PROGRAM, STUB_KERNEL, STUB_EVENT, STUB_KINDS };

typedef struct stub_state {
    /* what is asked for */
    int64_t fail_at;         /* the number of the call that fails, from 1; 0 = none */
    int32_t fail_from_there; /* 1 = and all after it, but for those that release: a device that is lost */
    int32_t all_are_gpus;    /* 1 = every device says that it is a GPU */
    int32_t no_devices;      /* 1 = platforms have none */
    int32_t reserved_1;
    const char *counted;     /* only calls with this in their name are counted; NULL = all */
    /* what has happened */
    int64_t calls;
    const void *sites[STUB_SITES]; /* where each call has come from: what it returns to */
    int64_t failures;
    const char *failed;      /* the first call that has failed, "clFinish" */
    int64_t live[STUB_KINDS];/* objects made and not released */
    int32_t loaded;          /* 1 = the real library is there */
    int32_t reserved;
} stub_state;

/* One state for the process. The symbol stub_get_state() of the library. */
typedef stub_state *(*stub_getter)(void);

#endif
