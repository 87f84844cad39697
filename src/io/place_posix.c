/* SPDX-License-Identifier: BSD-2-Clause */
/* Where an output is written, where there is POSIX. */
#define _XOPEN_SOURCE 700
#include "place_system.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

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

int asj_system_open(const char *path, char **target)
{
    struct stat info;
    int file = open_file_of_path(path);

    if (file >= 0) {
        const int mode = fcntl(file, F_GETFL);
        if (file == STDOUT_FILENO)
            fflush(stdout);
        if (mode >= 0 && (mode & O_ACCMODE) == O_RDONLY) {
            errno = EBADF; /* as write() has it */
            return -1;
        }
        return fcntl(file, F_DUPFD_CLOEXEC, 3);
    }
    if (stat(path, &info)) {
        if (errno != ENOENT)
            return -1;
        *target = follow_links(path); /* to where a link will point */
        return -1;
    }
    if (S_ISDIR(info.st_mode)) {
        errno = EISDIR;
        return -1;
    }
    if (!S_ISREG(info.st_mode))
        return open(path, O_WRONLY | O_CLOEXEC);
    if (faccessat(AT_FDCWD, path, W_OK, AT_EACCESS)) /* a rename would replace even a protected file */
        return -1;
    *target = realpath(path, NULL);
    return -1;
}

void asj_system_permit(int file, const char *as)
{
    struct stat info;
    if (stat(as, &info))
        return;
    if ((info.st_uid != geteuid() || info.st_gid != getegid()) && fchown(file, info.st_uid, info.st_gid))
        errno = 0; /* only root gives files away */
    if (fchmod(file, info.st_mode & 0777))
        errno = 0; /* some file systems know no permissions: the file itself matters more */
}

/* Not mkstemp(): open() gives the permissions that the umask of the process asks for, and the umask cannot be read without
 * changing it. */
int asj_system_create(const char *path)
{
    return open(path, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
}

int asj_system_replace(const char *from, const char *to)
{
    return rename(from, to);
}

int asj_system_remove(const char *path)
{
    return unlink(path);
}

int asj_system_close(int file)
{
    return close(file);
}

FILE *asj_system_stream(int file)
{
    return fdopen(file, "wb");
}

long asj_system_process(void)
{
    return (long)getpid();
}

size_t asj_system_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? (size_t)(slash - path) + 1 : 0;
}

asj_status asj_system_resolve(const char *path, char *target, size_t target_size)
{
    char *file, *folder = NULL, *absolute = NULL;
    const char *slash, *name;

    if (!*path)
        return ASJ_ERROR_FILE;
    file = follow_links(path);
    if (!file)
        return errno == ENOMEM ? ASJ_ERROR_MEMORY : ASJ_ERROR_FILE;
    slash = strrchr(file, '/');
    name = slash ? slash + 1 : file;
    folder = slash ? copy_text(file) : copy_text(".");
    if (folder && slash)
        folder[slash - file + 1] = '\0';
    absolute = folder ? realpath(folder, NULL) : NULL;
    const int no_memory = !folder || (!absolute && errno == ENOMEM);
    const char *parent = absolute && absolute[1] ? absolute : ""; /* "/" ends in its slash */
    const int fits = absolute && strlen(parent) + strlen(name) + sizeof "/" <= target_size;
    if (fits)
        snprintf(target, target_size, "%s/%s", parent, name);
    free(absolute);
    free(folder);
    free(file);
    if (no_memory)
        return ASJ_ERROR_MEMORY;
    return fits ? ASJ_OK : ASJ_ERROR_FILE;
}
