/* SPDX-License-Identifier: BSD-2-Clause */
/* Runs asj-cli as a program, in an empty folder of its own. */
#ifndef ASJ_TEST_PROGRAM_H
#define ASJ_TEST_PROGRAM_H

#include <stddef.h>
#include <sys/types.h>

typedef struct outcome {
    int code;   /* exit code, or -1 */
    int signal; /* that ended it, or 0 */
    char *out;  /* what it wrote to standard output, with a zero behind */
    size_t out_size;
    char *err;
    size_t err_size;
} outcome;

enum { MOST_ARGUMENTS = 600 };

/* 1 when the build cannot plot: argv[2] is "without-cairo". */
extern int without_cairo;

/* Finds asj-cli as argv[1], makes a folder and goes there. Ends the test program where that fails. */
void program_start(int argc, char **argv);

/* Removes the folder and passes `failures` on. */
int program_end(int failures);

/* Runs asj-cli with the arguments, the last of which is followed by NULL. Valid until the next run. */
const outcome *run_cli(const char *argument, ...);
const outcome *run_cli_list(const char *const *arguments);

/* The same with standard output going to an open file, which stays open. */
const outcome *run_cli_to(int standard_output, const char *argument, ...);

/* Starts without waiting; finish_cli() waits and gives the outcome. An open file may take the place of a capture. */
enum { CAPTURED = -1, CLOSED = -2 /* as a program without such a stream is started */ };
pid_t start_cli(int standard_output, int standard_error, const char *const *arguments);
const outcome *finish_cli(pid_t process);

/* Fail the running test, with all that the program said. */
void expect_code(const outcome *result, int code);
void expect_in(const outcome *result, const char *where, const char *text);
void expect_empty(const outcome *result, const char *where, const char *text);

#endif
