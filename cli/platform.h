/* SPDX-License-Identifier: BSD-2-Clause */
/* What the program asks of the operating system, in two forms: platform_posix.c, and platform_windows.c for Windows. */
#ifndef ASJ_CLI_PLATFORM_H
#define ASJ_CLI_PLATFORM_H

#include <stdint.h>

/* Milliseconds on a clock that never goes back. */
double cli_now_ms(void);

/* Whether standard error is a terminal that understands the escape sequences of ECMA-48. */
int cli_is_terminal(void);

/* Signals that ask the program to end are handed to `note` from now on, once each: a second one of a kind ends the program at once.
 * A closed pipe and a file beyond the limit of the shell become ordinary write errors. */
void cli_catch_signals(void (*note)(int number));

/* Standard streams that are closed are held, before any file is opened: one that took the place of standard error would get the
 * program's messages between its own bytes. What is written to them fails as it does when they are closed. */
void cli_hold_streams(void);

/* Whether nobody reads standard output any more: a pipe whose reader, `head` for instance, has what it wanted. */
int cli_output_is_closed(void);

/* Makes one folder. 0, or -1 with errno set, as mkdir(). */
int cli_make_one_folder(const char *path);

/* A file that exists: equal for every name of the same file. */
typedef struct cli_identity {
    uint64_t device, number;
} cli_identity;

/* 0 when there is no file of this name, or it is none that holds bytes: a folder, a pipe, a device. */
int cli_identify(const char *path, cli_identity *identity);

/* Whether there is something of this name that is no regular file; whether it is a folder. */
int cli_is_special(const char *path);
int cli_is_folder(const char *path);

int cli_is_separator(char c);

/* What stands after the last separator of a path. */
const char *cli_base_name(const char *path);

#endif
