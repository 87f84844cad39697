/* SPDX-License-Identifier: BSD-2-Clause */
/* Places of output files where there is Windows. Symbolic links are rare there and not followed; the folder gives permissions. */
#include "place.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <windows.h>

enum { STANDARD_OUTPUT = 1, RAW = _O_BINARY | _O_NOINHERIT };

/* The number of bytes of the folder that `path` begins with, the separator included. */
static size_t folder_length(const char *path)
{
    size_t length = strlen(path);
    while (length > 0 && !strchr("/\\:", path[length - 1]))
        length--;
    return length;
}

/* Creates a file of a new name beside the target. */
static int create_temporary(asj_place *place)
{
    const size_t folder = folder_length(place->target), size = folder + 64;
    int error;

    place->temporary = malloc(size);
    if (!place->temporary)
        return -1;
    memcpy(place->temporary, place->target, folder);
    for (unsigned number = 0; number < 10000; number++) {
        snprintf(place->temporary + folder, size - folder, ".asj-%d-%u.tmp", _getpid(), number);
        const int file = _open(place->temporary, _O_WRONLY | _O_CREAT | _O_EXCL | RAW, _S_IREAD | _S_IWRITE);
        if (file >= 0)
            return file;
        if (errno != EEXIST)
            break;
    }
    error = errno;
    free(place->temporary); /* not ours: never to be removed */
    place->temporary = NULL;
    errno = error;
    return -1;
}

/* -1 with errno set when that fails. */
static int open_path(asj_place *place, const char *path)
{
    if (strcmp(path, "-") == 0) {
        fflush(stdout);
        const int file = _dup(STANDARD_OUTPUT);
        if (file >= 0)
            _setmode(file, _O_BINARY);
        return file;
    }
    const int existing = _open(path, _O_WRONLY | RAW);
    if (existing >= 0 && GetFileType((HANDLE)_get_osfhandle(existing)) != FILE_TYPE_DISK) /* a console, NUL, a pipe */
        return existing;
    if (existing >= 0) {
        _close(existing);
    } else if (errno != ENOENT) { /* folders and protected files among them */
        const DWORD facts = GetFileAttributesA(path);
        if (facts != INVALID_FILE_ATTRIBUTES && facts & FILE_ATTRIBUTE_DIRECTORY)
            errno = EISDIR;
        return -1;
    }
    place->target = _fullpath(NULL, path, 0);
    return place->target ? create_temporary(place) : -1;
}

FILE *asj_place_open(asj_place *place, const char *path)
{
    const int file = open_path(place, path);
    FILE *stream = file >= 0 ? _fdopen(file, "wb") : NULL;
    if (file >= 0 && !stream) {
        const int error = errno;
        _close(file);
        errno = error;
    }
    return stream;
}

int asj_place_keep(asj_place *place)
{
    if (!place->temporary)
        return 0;
    if (!MoveFileExA(place->temporary, place->target, MOVEFILE_REPLACE_EXISTING))
        return EACCES; /* in use by another program, as a rule */
    free(place->temporary); /* it has the final name now */
    place->temporary = NULL;
    return 0;
}

void asj_place_free(asj_place *place)
{
    if (place->temporary)
        _unlink(place->temporary);
    free(place->temporary);
    free(place->target);
}

asj_status asj_place_resolve(const char *path, char *target, size_t target_size)
{
    char *absolute = _fullpath(NULL, path, 0);
    const size_t size = absolute ? strlen(absolute) + 1 : 0, folder = absolute ? folder_length(absolute) : 0;
    asj_status status = ASJ_ERROR_FILE;
    if (!absolute)
        return ASJ_ERROR_MEMORY;
    if (size <= target_size) { /* also when the folder is there */
        memcpy(target, absolute, size);
        target[folder] = '\0';
        if (GetFileAttributesA(target) != INVALID_FILE_ATTRIBUTES)
            status = ASJ_OK;
        memcpy(target, absolute, size);
        CharLowerA(target); /* names that differ in case are one file */
    }
    free(absolute);
    return status;
}
