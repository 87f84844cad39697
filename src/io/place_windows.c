/* SPDX-License-Identifier: BSD-2-Clause */
/* Where an output is written, where there is Windows. Symbolic links are rare there and not followed; the folder gives
 * permissions. */
#include "place_system.h"

#include <errno.h>
#include <fcntl.h>
#include <io.h>
#include <process.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <windows.h>

enum { STANDARD_OUTPUT = 1, RAW = _O_BINARY | _O_NOINHERIT };

int asj_system_open(const char *path, char **target)
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
    *target = _fullpath(NULL, path, 0);
    return -1;
}

void asj_system_permit(int file, const char *as)
{
    (void)file;
    (void)as;
}

int asj_system_create(const char *path)
{
    return _open(path, _O_WRONLY | _O_CREAT | _O_EXCL | RAW, _S_IREAD | _S_IWRITE);
}

int asj_system_replace(const char *from, const char *to)
{
    if (MoveFileExA(from, to, MOVEFILE_REPLACE_EXISTING))
        return 0;
    errno = EACCES; /* in use by another program, as a rule */
    return -1;
}

int asj_system_remove(const char *path)
{
    return _unlink(path);
}

int asj_system_close(int file)
{
    return _close(file);
}

FILE *asj_system_stream(int file)
{
    return _fdopen(file, "wb");
}

long asj_system_process(void)
{
    return _getpid();
}

size_t asj_system_folder(const char *path)
{
    size_t length = strlen(path);
    while (length > 0 && !strchr("/\\:", path[length - 1]))
        length--;
    return length;
}

asj_status asj_system_resolve(const char *path, char *target, size_t target_size)
{
    char *absolute = _fullpath(NULL, path, 0);
    const size_t size = absolute ? strlen(absolute) + 1 : 0, folder = absolute ? asj_system_folder(absolute) : 0;
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
