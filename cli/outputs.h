/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_OUTPUTS_H
#define ASJ_CLI_OUTPUTS_H

#include "detect_arguments.h"

/* A file that will be written, and what it is for: an image, or "the plot". */
typedef struct cli_planned {
    const char *path;
    const char *purpose;
    char *target; /* filled in by cli_check_collisions() */
} cli_planned;

/* Two results may not share a name, which is told with a hint at what may help, and none may take the place of an input. Sorts
 * `outputs`. CLI_SUCCESS, or CLI_USAGE or CLI_FAILED (no memory) after saying why. */
int cli_check_collisions(const char *command, const char *hint, cli_planned *outputs, size_t output_count,
                         const char *const *inputs, size_t input_count);

/* Whether the folders of the files are there, asked before any work. CLI_SUCCESS, or CLI_FAILED after saying which are not. */
int cli_check_folders(const cli_planned *outputs, size_t output_count);

/* Where the results of one image go; NULL = nowhere. */
typedef struct cli_output {
    char *junctions; /* "-" = standard output */
    char *plot;
} cli_output;

typedef struct cli_outputs {
    cli_output *of; /* one for each image */
    size_t count;
    char *of_all; /* one file of all images in place of their junctions, "-" = standard output; NULL = none */
} cli_outputs;

/* Plans all files of `detect` before any work. CLI_SUCCESS, or CLI_USAGE or CLI_FAILED (no such folder, no memory) after saying
 * why. cli_outputs_free() in every case. */
int cli_outputs_plan(const cli_detect_arguments *arguments, cli_outputs *outputs);
void cli_outputs_free(cli_outputs *outputs);

#endif
