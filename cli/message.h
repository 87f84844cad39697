/* SPDX-License-Identifier: BSD-2-Clause */
/* Everything that asj-cli says on standard error: one line each. */
#ifndef ASJ_CLI_MESSAGE_H
#define ASJ_CLI_MESSAGE_H

#include <stddef.h>

#if defined(__MINGW32__) /* as in src/core/context.h */
#define CLI_PRINTF(text, first) __attribute__((format(gnu_printf, text, first)))
#elif defined(__GNUC__)
#define CLI_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define CLI_PRINTF(text, first)
#endif

/* Exit codes, and what the functions of the command line return. */
enum { CLI_SUCCESS = 0, CLI_FAILED = 1, CLI_USAGE = 2, CLI_HELP = 3 /* --help was met; never an exit code */ };

/* Room for what the library says of a file: its longest path and the cause. */
#define CLI_MESSAGE_SIZE 8192

/* Replaces what would move the cursor of a terminal, or end the line, by '?'. */
void cli_make_harmless(char *text);

/* "asj-cli: TEXT" */
void cli_error(const char *format, ...) CLI_PRINTF(1, 2);

/* "PATH: MESSAGE", with '' for an empty path; it is not repeated where the message already starts with it. */
void cli_file_message(const char *path, const char *message, char *text, size_t text_size);

/* The same as an error. */
void cli_file_error(const char *path, const char *message);

/* TEXT alone. */
void cli_note(const char *format, ...) CLI_PRINTF(1, 2);

/* "asj-cli COMMAND: TEXT" and where to find help; command NULL = none. Returns CLI_USAGE. */
int cli_usage_error(const char *command, const char *format, ...) CLI_PRINTF(2, 3);

/* Flushes standard output. CLI_FAILED, with a message, when what was printed could not be written. */
int cli_close_output(void);

#endif
