/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_DETECT_H
#define ASJ_CLI_DETECT_H

#include "parse.h"

/* `asj-cli detect`: argv[0] is "detect". `other` may have options that it lacks. Returns the exit code. */
int cli_detect(int argc, char **argv, const cli_other *other);

#endif
