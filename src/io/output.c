/* SPDX-License-Identifier: BSD-2-Clause */
/* Output files that appear whole or not at all: written under another name in the same folder, renamed at the end. What is no
 * regular file (standard output, a pipe, a device) cannot be renamed over and is written directly. */
#define _XOPEN_SOURCE 700
#include <asj/io.h>

#include "message.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

struct asj_output {
    FILE *stream;
    int error;       /* errno of the first failed write, or 0 */
    char *path;      /* as the caller gave it, for messages */
    char *target;    /* what is replaced at the end: path with symbolic links followed */
    char *temporary; /* what is written; NULL = the target itself */
};

static void output_free(asj_output *output)
{
    if (output->temporary)
        unlink(output->temporary);
    free(output->temporary);
    free(output->target);
    free(output->path);
    free(output);
}

static char *copy_text(const char *text)
{
    size_t size = strlen(text) + 1;
    char *copy = malloc(size);
    if (copy)
        memcpy(copy, text, size);
    return copy;
}

/* -1, or the number of the open file that a path stands for. Opening /dev/stdout anew would start again at the beginning of a file
 * that the shell has opened for appending, so the open file itself is used. */
static int open_file_of_path(const char *path)
{
    static const char prefix[] = "/dev/fd/";
    if (!strcmp(path, "-") || !strcmp(path, "/dev/stdout"))
        return STDOUT_FILENO;
    if (!strcmp(path, "/dev/stderr"))
        return STDERR_FILENO;
    if (!strncmp(path, prefix, sizeof prefix - 1)) {
        char *end;
        long number = strtol(path + sizeof prefix - 1, &end, 10);
        if (end != path + sizeof prefix - 1 && !*end && number >= 0 && number < INT_MAX)
            return (int)number;
    }
    return -1;
}

/* The folder of `path` and then `name`; `name` alone when it begins at the root. */
static char *beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    size_t folder = slash && name[0] != '/' ? (size_t)(slash - path) + 1 : 0, size = folder + strlen(name) + 1;
    char *joined = malloc(size);
    if (joined) {
        memcpy(joined, path, folder);
        memcpy(joined + folder, name, size - folder);
    }
    return joined;
}

/* A path whose last part is no symbolic link: the links of `path` followed to the end, which need not exist. */
static char *follow_links(const char *path)
{
    enum { MOST_LINKS = 40, MOST_BYTES = 4096 };
    char *at = copy_text(path), name[MOST_BYTES];
    int i;

    for (i = 0; at && i < MOST_LINKS; i++) {
        ssize_t length = readlink(at, name, sizeof name - 1);
        char *next;
        if (length < 0)
            return at;
        name[length] = '\0';
        next = beside(at, name);
        free(at);
        at = next;
    }
    free(at);
    errno = i == MOST_LINKS ? ELOOP : ENOMEM;
    return NULL;
}

/* Creates a file of a new name beside the target. open() and not mkstemp(): it gives the permissions that the umask of the process
 * asks for, and the umask cannot be read without changing it. */
static int create_temporary(asj_output *output)
{
    const char *slash = strrchr(output->target, '/');
    size_t folder = slash ? (size_t)(slash - output->target) + 1 : 0;
    size_t size = folder + 64;
    unsigned number;
    int file, error;

    output->temporary = malloc(size);
    if (!output->temporary)
        return -1;
    memcpy(output->temporary, output->target, folder);
    for (number = 0; number < 10000; number++) {
        snprintf(output->temporary + folder, size - folder, ".asj-%ld-%u.tmp", (long)getpid(), number);
        file = open(output->temporary, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (file >= 0)
            return file;
        if (errno != EEXIST)
            break;
    }
    error = errno;
    free(output->temporary); /* not ours: never to be removed */
    output->temporary = NULL;
    errno = error;
    return -1;
}

/* Opens the file that will be written: -1 with errno set when that fails. */
static int open_target(asj_output *output)
{
    struct stat info;
    int file = open_file_of_path(output->path);

    if (file >= 0) {
        if (file == STDOUT_FILENO)
            fflush(stdout);
        return fcntl(file, F_DUPFD_CLOEXEC, 3);
    }
    if (stat(output->path, &info)) {
        if (errno != ENOENT)
            return -1;
        output->target = follow_links(output->path); /* to where a link will point */
        return output->target ? create_temporary(output) : -1;
    }
    if (S_ISDIR(info.st_mode)) {
        errno = EISDIR;
        return -1;
    }
    if (!S_ISREG(info.st_mode))
        return open(output->path, O_WRONLY | O_CLOEXEC);
    if (faccessat(AT_FDCWD, output->path, W_OK, AT_EACCESS)) /* a rename would replace even a protected file */
        return -1;
    output->target = realpath(output->path, NULL);
    file = output->target ? create_temporary(output) : -1;
    if (file >= 0 && fchmod(file, info.st_mode & 0777))
        errno = 0; /* some file systems know no permissions: the file itself matters more */
    return file;
}

asj_status asj_output_target(const char *path, char *target, size_t target_size)
{
    char *file, *folder = NULL, *absolute = NULL;
    const char *slash, *name;
    int length = -1;

    if (!path || !target || !target_size)
        return ASJ_ERROR_ARGUMENT;
    file = follow_links(path);
    if (!file)
        return errno == ENOMEM ? ASJ_ERROR_MEMORY : ASJ_ERROR_FILE;
    slash = strrchr(file, '/');
    name = slash ? slash + 1 : file;
    folder = slash ? copy_text(file) : copy_text(".");
    if (folder && slash)
        folder[slash - file + 1] = '\0';
    absolute = folder ? realpath(folder, NULL) : NULL;
    if (absolute)
        length = snprintf(target, target_size, "%s/%s", absolute, name);
    free(absolute);
    free(folder);
    free(file);
    return length >= 0 && (size_t)length < target_size ? ASJ_OK : ASJ_ERROR_FILE;
}

asj_status asj_output_begin(const char *path, asj_output **output, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    asj_output *opened;
    int file, error;

    if (!path || !output)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no place for the output");
    *output = NULL;
    if (!*path)
        return asj_message_fail(&message, ASJ_ERROR_FILE, "an empty path names no file");
    opened = calloc(1, sizeof *opened);
    if (!opened || !(opened->path = copy_text(path))) {
        free(opened);
        return asj_message_fail(&message, ASJ_ERROR_MEMORY, "out of memory");
    }
    errno = 0;
    file = open_target(opened);
    error = errno ? errno : ENOMEM;
    if (file >= 0) {
        opened->stream = fdopen(file, "wb");
        if (!opened->stream) {
            error = errno;
            close(file);
        }
    }
    if (!opened->stream) {
        output_free(opened);
        return asj_message_errno(&message, error, "cannot create");
    }
    *output = opened;
    return ASJ_OK;
}

asj_status asj_output_write(asj_output *output, const void *data, size_t size)
{
    if (!output || (!data && size))
        return ASJ_ERROR_ARGUMENT;
    if (output->error)
        return ASJ_ERROR_FILE;
    errno = 0;
    if (fwrite(data, 1, size, output->stream) != size) {
        output->error = errno ? errno : EIO;
        return ASJ_ERROR_FILE;
    }
    return ASJ_OK;
}

asj_status asj_output_text(asj_output *output, const char *text)
{
    return text ? asj_output_write(output, text, strlen(text)) : ASJ_ERROR_ARGUMENT;
}

asj_status asj_output_commit(asj_output **output, char *text, size_t text_size)
{
    asj_output *ending = output ? *output : NULL;
    asj_message message = asj_message_start(text, text_size, ending ? ending->path : NULL);
    asj_status status = ASJ_OK;

    if (!ending)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no output to commit");
    *output = NULL;
    errno = 0;
    if (fclose(ending->stream) && !ending->error)
        ending->error = errno ? errno : EIO;
    if (ending->error) {
        status = asj_message_errno(&message, ending->error, "cannot write");
    } else if (ending->temporary) {
        if (rename(ending->temporary, ending->target)) {
            status = asj_message_errno(&message, errno, "cannot rename into place");
        } else {
            free(ending->temporary); /* it has the final name now */
            ending->temporary = NULL;
        }
    }
    output_free(ending);
    return status;
}

void asj_output_abort(asj_output **output)
{
    if (!output || !*output)
        return;
    fclose((*output)->stream);
    output_free(*output);
    *output = NULL;
}
