/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_DETECT_H
#define ASJ_CLI_DETECT_H

/* `asj-cli detect`: argv[0] is "detect". Returns the exit code. */
int cli_detect(int argc, char **argv);

#endif
