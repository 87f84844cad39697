/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_OUTPUTS_H
#define ASJ_CLI_OUTPUTS_H

#include "detect_arguments.h"

/* Where the results of one image go; NULL = nowhere. */
typedef struct cli_output {
    char *junctions; /* "-" = standard output */
    char *plot;
} cli_output;

typedef struct cli_outputs {
    cli_output *of; /* one for each image */
    size_t count;
} cli_outputs;

/* Plans all files before any work: two results may not share a name, and none may take the place of an input. CLI_SUCCESS, or
 * CLI_USAGE or CLI_FAILED (no such folder, no memory) after saying why. cli_outputs_free() in every case. */
int cli_outputs_plan(const cli_detect_arguments *arguments, cli_outputs *outputs);
void cli_outputs_free(cli_outputs *outputs);

#endif
