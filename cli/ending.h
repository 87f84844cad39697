/* SPDX-License-Identifier: BSD-2-Clause */
/* Endings of names: what they promise, the file must be. */
#ifndef ASJ_CLI_ENDING_H
#define ASJ_CLI_ENDING_H

/* The one of `formats` that a name ends in, in whatever case; NULL = none of them. */
const char *cli_format_of_name(const char *name, const char *const *formats);

/* Whether --output NAME fits what is written there: --format, which wins, or one of `formats` by the ending. Without --format an
 * ending that names none of them is refused; .txt and names without an ending hold the first of them. NULL and what is no regular
 * file pass. `what` is written: "junctions". CLI_SUCCESS, or CLI_USAGE after saying why. */
int cli_check_ending(const char *command, const char *what, const char *name, const char *format, const char *const *formats);

/* Warns where the ending of --output NAME names another format that is known than the one that is `written`, and says what is in a
 * .txt that nobody asked a format for (`format` NULL). */
void cli_warn_ending(const char *command, const char *name, const char *format, const char *written);

#endif
