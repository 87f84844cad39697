/* SPDX-License-Identifier: BSD-2-Clause */
#define _XOPEN_SOURCE 700
#include "program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

static const char *program;
static char folder[] = "/tmp/asj-test-XXXXXX";
static outcome last;

int without_cairo;

void program_start(int argc, char **argv)
{
    without_cairo = argc > 2 && strcmp(argv[2], "without-cairo") == 0;
    program = argc > 1 ? argv[1] : NULL;
    if (!program || program[0] != '/' || !mkdtemp(folder) || chdir(folder) || mkdir("work", 0777) || chdir("work")) {
        fprintf(stderr, "usage: %s /path/to/asj-cli\n", argv[0]);
        exit(99);
    }
}

static void remove_tree(const char *path)
{
    char below[1024];
    DIR *list = opendir(path);
    struct dirent *entry;
    while (list && (entry = readdir(list)) != NULL) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        snprintf(below, sizeof below, "%s/%s", path, entry->d_name);
        if (unlink(below) != 0)
            remove_tree(below);
    }
    if (list)
        closedir(list);
    rmdir(path);
}

static void forget(void)
{
    free(last.out);
    free(last.err);
    memset(&last, 0, sizeof last);
}

int program_end(int failures)
{
    forget();
    if (chdir("/") == 0)
        remove_tree(folder);
    return failures;
}

/* What the program says goes to files beside its folder: a pipe would have to be read while it runs. */
static const char *capture_path(const char *name)
{
    static char path[2][64];
    char *place = path[*name == 'e'];
    snprintf(place, sizeof path[0], "%s/%s", folder, name);
    return place;
}

static char *read_capture(const char *name, size_t *size)
{
    struct stat facts;
    FILE *file = fopen(capture_path(name), "rb");
    assert_non_null(file);
    assert_int_equal(fstat(fileno(file), &facts), 0);
    char *text = calloc((size_t)facts.st_size + 1, 1);
    assert_non_null(text);
    *size = fread(text, 1, (size_t)facts.st_size, file);
    fclose(file);
    return text;
}

static void put_in_place(posix_spawn_file_actions_t *actions, int file, int stream)
{
    if (file >= 0)
        posix_spawn_file_actions_adddup2(actions, file, stream);
    else if (file == CLOSED)
        posix_spawn_file_actions_addclose(actions, stream);
}

pid_t start_cli(int standard_output, int standard_error, const char *const *arguments)
{
    char *argv[MOST_ARGUMENTS + 2];
    size_t count = 0;
    pid_t process;
    posix_spawn_file_actions_t actions;
    argv[count++] = (char *)(uintptr_t)"asj-cli";
    for (size_t i = 0; arguments[i]; i++) {
        assert_true(count <= MOST_ARGUMENTS);
        argv[count++] = (char *)(uintptr_t)arguments[i];
    }
    argv[count] = NULL;
    assert_int_equal(posix_spawn_file_actions_init(&actions), 0);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, 1, capture_path("out"), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    put_in_place(&actions, standard_output, 1);
    posix_spawn_file_actions_addopen(&actions, 2, capture_path("err"), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    put_in_place(&actions, standard_error, 2);
    assert_int_equal(posix_spawn(&process, program, &actions, NULL, argv, environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    return process;
}

const outcome *finish_cli(pid_t process)
{
    int status = 0;
    while (waitpid(process, &status, 0) < 0)
        assert_int_equal(errno, EINTR);
    forget();
    last.code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    last.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    last.out = read_capture("out", &last.out_size);
    last.err = read_capture("err", &last.err_size);
    return &last;
}

const outcome *run_cli_list(const char *const *arguments)
{
    return finish_cli(start_cli(CAPTURED, CAPTURED, arguments));
}

static void collect(const char *first, va_list rest, const char *arguments[MOST_ARGUMENTS + 1])
{
    size_t count = 0;
    for (const char *argument = first; argument && count < MOST_ARGUMENTS; argument = va_arg(rest, const char *))
        arguments[count++] = argument;
    arguments[count] = NULL;
}

const outcome *run_cli(const char *argument, ...)
{
    const char *arguments[MOST_ARGUMENTS + 1];
    va_list rest;
    va_start(rest, argument);
    collect(argument, rest, arguments);
    va_end(rest);
    return run_cli_list(arguments);
}

const outcome *run_cli_to(int standard_output, const char *argument, ...)
{
    const char *arguments[MOST_ARGUMENTS + 1];
    va_list rest;
    va_start(rest, argument);
    collect(argument, rest, arguments);
    va_end(rest);
    return finish_cli(start_cli(standard_output, CAPTURED, arguments));
}

void expect_code(const outcome *result, int code)
{
    if (result->code != code || result->signal != 0)
        fail_msg("exit code %d (signal %d) instead of %d\nstandard error:\n%s", result->code, result->signal, code, result->err);
}

void expect_in(const outcome *result, const char *where, const char *text)
{
    if (!strstr(where, text))
        fail_msg("'%s' is missing in:\n%s\nstandard error:\n%s", text, where, result->err);
}

void expect_empty(const outcome *result, const char *where, const char *text)
{
    if (*text)
        fail_msg("%s (exit code %d) is not empty:\n%s", where, result->code, text);
}
