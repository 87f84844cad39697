/* SPDX-License-Identifier: BSD-2-Clause */
/* The one output of `asj-cli detect -f jsonl`: a line for each image, in their order, whether it was done or not. */
#ifndef ASJ_CLI_JSON_LINES_H
#define ASJ_CLI_JSON_LINES_H

#include "common.h"

#include <asj/io.h>

/* All zero: there is none. */
typedef struct cli_json_lines {
    asj_output *output;
    const char *path;
    size_t count; /* lines so far */
    int broken;   /* no line can be written any more, .. */
    int short_of_memory; /* .. for want of memory */
} cli_json_lines;

/* CLI_SUCCESS, or CLI_FAILED after saying why. */
int cli_json_lines_begin(cli_json_lines *lines, cli_session *session, const char *path);

/* The line of an image. The message is empty where cli_json_lines_end() will say why it could not be written. */
asj_status cli_json_lines_add(cli_json_lines *lines, const asj_detection_report *report, char *message, size_t message_size);

/* The line of an image that failed, with what was said of it. */
void cli_json_lines_add_failure(cli_json_lines *lines, const char *image, const char *cause);

/* Lets the file appear, or where it is not to be kept leaves none. CLI_SUCCESS, or CLI_FAILED after saying why. */
int cli_json_lines_end(cli_json_lines *lines, cli_session *session, int keep);

#endif
