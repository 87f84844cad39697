/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_HELP_H
#define ASJ_CLI_HELP_H

#include "parse.h"

/* Prints the help of a command on standard output: introduction, groups, the library's option tables, conclusion. Advanced options
 * are among them when --advanced is in argv. */
void cli_help(const cli_syntax *syntax, int argc, char **argv);

/* What stands for the value of a table row: "N", "yes|no", "line_fit|search", "LIST". */
void cli_row_argument(const asj_option_info *row, char *text, size_t text_size);

#endif
