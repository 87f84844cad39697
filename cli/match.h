/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_MATCH_H
#define ASJ_CLI_MATCH_H

/* `asj-cli match`: argv[0] is "match". Returns the exit code. */
int cli_match(int argc, char **argv);

#endif
