/* SPDX-License-Identifier: BSD-2-Clause */
/* Which options of `asj-cli match` go with each other. */
#ifndef ASJ_CLI_MATCH_CHECKS_H
#define ASJ_CLI_MATCH_CHECKS_H

#include "match_arguments.h"

/* What cli_match_arguments_read() has read: fills in what follows from it, and opens nothing but the beginnings of files.
 * CLI_SUCCESS, or CLI_USAGE or CLI_FAILED after saying why. */
int cli_match_check(cli_match_arguments *arguments);

#endif
