/* SPDX-License-Identifier: BSD-2-Clause */
/* What every command that computes has: back end, threads, limits, times, and the library's context made from them. */
#ifndef ASJ_CLI_COMMON_H
#define ASJ_CLI_COMMON_H

#include "kernel_cache.h"
#include "message.h"
#include "parse.h"
#include "progress.h"

#include <asj/context.h>

/* What --max-megapixels goes up to: the largest image that asj_detect() takes. */
#define CLI_LARGEST_MEGAPIXELS 536

/* What --white goes up to: floats may have any unit. */
#define CLI_LARGEST_WHITE 1e9

typedef struct cli_common {
    const char *command; /* that they were given to: "detect" */
    int32_t backend;
    int32_t threads;
    int32_t simd;
    const char *device;
    uint64_t max_pixels;
    double white; /* the sample value that means white; 0 = as the image's format has it */
    int time;
    int quiet;
} cli_common;

void cli_common_init(cli_common *common, const char *command);

/* The rows and the `take` of their group. */
extern const cli_option cli_common_options[];
extern const size_t cli_common_option_count;
int cli_common_take(void *common, int id, const char *text);

/* After all options are read: --device asks for OpenCL. CLI_SUCCESS, or CLI_USAGE after saying why. */
int cli_common_check(cli_common *common);

/* The library's context and the progress line that belongs to it. */
typedef struct cli_session {
    asj_context *context;
    cli_progress progress;
    cli_kernel_cache cache;
    int errors; /* said by the library's log while it made the context */
    int warned_of_gray; /* cli_warn_of_gray(): once */
    int warned_of_more; /* pictures behind the first: once */
    char failure[2 * CLI_MESSAGE_SIZE]; /* what cli_session_fail() said last */
} cli_session;

/* Makes the context for a run over `image_count` images; the library's warnings go to standard error. CLI_SUCCESS, or CLI_FAILED
 * after saying why. cli_session_close() in either case. The session may not move in between. */
int cli_session_open(cli_session *session, const cli_common *common, size_t image_count);
void cli_session_close(cli_session *session);

/* Says what went wrong with a file, or with standard output for "-"; an empty message is replaced by the status. CLI_FAILED. */
int cli_session_fail(cli_session *session, const char *path, const char *message, asj_status status);

#endif
