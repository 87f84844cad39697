/* SPDX-License-Identifier: BSD-2-Clause */
/* What such a decoder and the libraries below it do to a process (abort, take memory, write to standard error) cannot be told, and
 * is one refused file when it has a process of its own.
 *
 * The bytes of the file go to the program over a socket, then its answer (decoder_answer.h) comes back. No file of this process but
 * that socket is open there, and standard error is not: where the system can close the others (the C library of GNU from 2.34 on,
 * FreeBSD, macOS); elsewhere those that have FD_CLOEXEC. */
#define _GNU_SOURCE
#include "decoder_answer.h"
#include "decoder_process.h"

#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

/* How long a program that says nothing is waited for: its own limit is one of processor time, a second and another one for each
 * megapixel (heif_program.c), and the machine may be busy. */
enum { PATIENCE_MS = 60000, PATIENCE_PIXELS = 250, MOST_PATH = 4096 }; /* and a millisecond for so many pixels */

/* Linux and the BSDs say with a call what macOS says of a socket (open_sockets()). */
#ifndef MSG_NOSIGNAL
#define MSG_NOSIGNAL 0
#endif

/* The program's end of the talk. */
typedef struct talk {
    int socket, patience_ms;
} talk;

static int is_there(char *path, const char *folder, size_t folder_size, const char *name)
{
    return snprintf(path, MOST_PATH, "%.*s%s", (int)folder_size, folder, name) < MOST_PATH && access(path, X_OK) == 0;
}

/* In a folder beside this library, where it is installed; in the folder of this library, as it is built; or where the build was
 * told to install it, when this library is part of a program. */
static int find_program(char *path, const char *program)
{
    Dl_info library;
    const char *slash = NULL;
    char beside[64];

    snprintf(beside, sizeof beside, "asj/%s", program);
    if (dladdr((void *)(size_t)asj_decode_elsewhere, &library) && library.dli_fname)
        slash = strrchr(library.dli_fname, '/');
    if (slash) {
        size_t folder = (size_t)(slash - library.dli_fname) + 1;
        if (is_there(path, library.dli_fname, folder, beside) || is_there(path, library.dli_fname, folder, program))
            return 1;
    }
    return is_there(path, ASJ_IO_PROGRAMS "/", sizeof ASJ_IO_PROGRAMS, program);
}

/* What the program has: `socket` as standard input and output, and nowhere to complain to. 0, or errno. */
static int choose_files(posix_spawn_file_actions_t *files, int socket)
{
    int error = posix_spawn_file_actions_adddup2(files, socket, STDIN_FILENO);
    if (!error)
        error = posix_spawn_file_actions_adddup2(files, socket, STDOUT_FILENO);
    if (!error)
        error = posix_spawn_file_actions_addopen(files, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
#ifdef ASJ_IO_HAVE_CLOSEFROM
    if (!error)
        error = posix_spawn_file_actions_addclosefrom_np(files, STDERR_FILENO + 1);
#endif
    return error;
}

/* Signals as a program expects them. */
static void choose_attributes(posix_spawnattr_t *attributes)
{
    short flags = POSIX_SPAWN_SETSIGDEF | POSIX_SPAWN_SETSIGMASK;
    sigset_t signals;
    sigfillset(&signals);
    posix_spawnattr_setsigdefault(attributes, &signals);
    sigemptyset(&signals);
    posix_spawnattr_setsigmask(attributes, &signals);
#ifdef POSIX_SPAWN_CLOEXEC_DEFAULT
    flags |= POSIX_SPAWN_CLOEXEC_DEFAULT; /* macOS: no file but those of choose_files() */
#endif
    posix_spawnattr_setflags(attributes, flags);
}

/* 0, or errno. */
static int start(const char *path, const char *program, int socket, const char *pixels, pid_t *process)
{
    char *arguments[3] = {(char *)(size_t)program, (char *)(size_t)pixels, NULL}, *environment[1] = {NULL};
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    int error;

    if (posix_spawn_file_actions_init(&files))
        return ENOMEM;
    if (posix_spawnattr_init(&attributes)) {
        posix_spawn_file_actions_destroy(&files);
        return ENOMEM;
    }
    choose_attributes(&attributes);
    error = choose_files(&files, socket);
    if (!error)
        error = posix_spawn(process, path, &files, &attributes, arguments, environment);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return error;
}

/* Waits until the socket is ready. */
static int is_ready(const talk *with, short what)
{
    struct pollfd one = {with->socket, what, 0};
    int got;
    do
        got = poll(&one, 1, with->patience_ms);
    while (got < 0 && errno == EINTR);
    return got > 0;
}

/* All bytes, or 0. A closed socket is no signal but an error. */
static int send_all(const talk *with, const unsigned char *bytes, size_t size)
{
    while (size) {
        ssize_t sent = is_ready(with, POLLOUT) ? send(with->socket, bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT) : 0;
        if (sent < 0 && (errno == EINTR || errno == EAGAIN))
            continue;
        if (sent <= 0)
            return 0;
        bytes += sent;
        size -= (size_t)sent;
    }
    return 1;
}

static int receive_all(const talk *with, void *to, size_t size)
{
    unsigned char *bytes = to;
    while (size) {
        ssize_t got = is_ready(with, POLLIN) ? recv(with->socket, bytes, size, 0) : 0;
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            return 0;
        bytes += got;
        size -= (size_t)got;
    }
    return 1;
}

static int32_t format_of(uint32_t samples)
{
    switch (samples) {
    case ASJ_DECODER_GRAY8: return ASJ_FORMAT_GRAY8;
    case ASJ_DECODER_BGR8: return ASJ_FORMAT_BGR8;
    case ASJ_DECODER_GRAY_FLOAT: return ASJ_FORMAT_GRAY_FLOAT;
    case ASJ_DECODER_RGB8: return ASJ_FORMAT_RGB8;
    case ASJ_DECODER_GRAY16: return ASJ_FORMAT_GRAY16;
    default: return 0;
    }
}

/* As the header says; turned or cropped it may be where the format says so. */
static int is_expected(const asj_decoder_answer *answer, const asj_image_probe *probe)
{
    const uint64_t longer = probe->width > probe->height ? probe->width : probe->height;
    if (probe->kind != ASJ_KIND_HEIF)
        return answer->width == probe->width && answer->height == probe->height;
    return answer->width && answer->height && answer->width <= longer && answer->height <= longer &&
           answer->width * answer->height <= probe->width * probe->height;
}

static asj_status receive(const talk *with, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                          const asj_message *message)
{
    asj_decoder_answer answer;
    int32_t format;
    asj_status status;

    if (!receive_all(with, &answer, sizeof answer) || answer.magic != ASJ_DECODER_MAGIC)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged or unusual %s: its decoder gave up", probe->name);
    if (answer.samples == ASJ_DECODER_LACKS)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "the %s decoder here lacks the codec of this file", probe->name);
    format = format_of(answer.samples);
    if (!format || !is_expected(&answer, probe))
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged or unusual %s", probe->name);
    status = asj_image_allocate(buffer, answer.width, answer.height, format, max_pixels, message);
    const size_t bytes = (size_t)(answer.width * answer.height) * (size_t)asj_pixel_size(format);
    if (status == ASJ_OK && !receive_all(with, buffer->pixels, bytes))
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged %s: its decoder gave up", probe->name);
    return status;
}

/* Two ends of a socket that no other program inherits. 0, or errno. */
static int open_sockets(int ends[2])
{
#ifdef SOCK_CLOEXEC
    return socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) ? errno : 0;
#else
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends))
        return errno;
    for (int end = 0; end < 2; end++) {
        fcntl(ends[end], F_SETFD, FD_CLOEXEC);
#ifdef SO_NOSIGPIPE
        const int on = 1;
        setsockopt(ends[end], SOL_SOCKET, SO_NOSIGPIPE, &on, sizeof on);
#endif
    }
    return 0;
#endif
}

asj_status asj_decode_elsewhere(const char *program, const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels,
                                asj_image_buffer *buffer, const asj_message *message)
{
    char path[MOST_PATH], pixels[32];
    const uint64_t wait_ms = PATIENCE_MS + probe->width * probe->height / PATIENCE_PIXELS;
    talk with;
    int ends[2], error, state;
    pid_t process;
    asj_status status = ASJ_OK;

    if (!find_program(path, program))
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "%s is read by the program %s, which is not installed", probe->name,
                                program);
    error = open_sockets(ends);
    if (error)
        return asj_message_errno(message, error, "cannot start its decoder");
    with.socket = ends[0];
    with.patience_ms = wait_ms < INT_MAX ? (int)wait_ms : INT_MAX;
    snprintf(pixels, sizeof pixels, "%llu", (unsigned long long)(probe->width * probe->height));
    error = start(path, program, ends[1], pixels, &process);
    close(ends[1]);
    if (error) {
        status = asj_message_errno(message, error, "cannot start its decoder");
    } else {
        if (send_all(&with, input->bytes, input->size))
            shutdown(ends[0], SHUT_WR);
        status = receive(&with, probe, max_pixels, buffer, message);
        kill(process, SIGKILL); /* it has nothing more to do */
        while (waitpid(process, &state, 0) < 0 && errno == EINTR)
            continue;
    }
    close(ends[0]);
    return status;
}
