/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_MATCH_H
#define ASJ_CLI_MATCH_H

#include "parse.h"

/* `asj-cli match`: argv[0] is "match". `other` may have options that it lacks. Returns the exit code. */
int cli_match(int argc, char **argv, const cli_other *other);

#endif
