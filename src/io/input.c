/* SPDX-License-Identifier: BSD-2-Clause */
/* Whole files into memory, with a limit. */
#define _POSIX_C_SOURCE 200809L
#include "input.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#ifdef _WIN32 /* bytes as they are, and not for children */
#include <io.h>
#define OPEN_FLAGS (O_RDONLY | O_BINARY | O_NOINHERIT)
#else
#define OPEN_FLAGS (O_RDONLY | O_CLOEXEC | O_NOCTTY)
#endif

enum { HEAD_BYTES = 65536, READ_AT_ONCE = 1 << 30 }; /* what the check sees; Windows reads no 2 GiB in one call */

/* Makes room for more bytes than the input holds. */
static asj_status grow(asj_input *input, size_t *capacity, const asj_message *message)
{
    size_t wanted = *capacity < ASJ_INPUT_MAX_BYTES / 2 ? 2 * *capacity : (size_t)ASJ_INPUT_MAX_BYTES + 1;
    unsigned char *moved;

    if (input->size > ASJ_INPUT_MAX_BYTES)
        return asj_message_fail(message, ASJ_ERROR_LIMIT, "longer than %u bytes", ASJ_INPUT_MAX_BYTES);
    moved = realloc(input->bytes, wanted);
    if (!moved)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for %zu bytes of the file", wanted);
    input->bytes = moved;
    *capacity = wanted;
    return ASJ_OK;
}

/* Fills the buffer from where it ends. *ended: the file has no more. */
static asj_status read_some(int file, size_t capacity, asj_input *input, int *ended, const asj_message *message)
{
    const size_t room = capacity - input->size;
    const unsigned wanted = room < READ_AT_ONCE ? (unsigned)room : READ_AT_ONCE;
    ssize_t got;
    do
        got = read(file, input->bytes + input->size, wanted);
    while (got < 0 && errno == EINTR);
    if (got < 0)
        return asj_message_errno(message, errno, "cannot read");
    input->size += (size_t)got;
    *ended = got == 0;
    return ASJ_OK;
}

static asj_status read_all(int file, size_t capacity, asj_input *input, asj_input_check *check, const asj_message *message)
{
    int ended = 0, checked = 0;
    asj_status status = ASJ_OK;

    input->bytes = malloc(capacity);
    if (!input->bytes)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for %zu bytes of the file", capacity);
    while (!ended && status == ASJ_OK) {
        status = read_some(file, capacity, input, &ended, message);
        if (status == ASJ_OK && input->size && !checked && (ended || input->size >= HEAD_BYTES)) {
            const char *fault = check(input);
            if (fault)
                status = asj_message_fail(message, ASJ_ERROR_FORMAT, "%s", fault);
            checked = 1;
        }
        if (status == ASJ_OK && input->size == capacity)
            status = grow(input, &capacity, message);
    }
    if (status == ASJ_OK && !input->size)
        status = asj_message_fail(message, ASJ_ERROR_FORMAT, "the file is empty");
    return status;
}

asj_status asj_input_read(asj_input *input, asj_input_check *check, const asj_message *message)
{
    static const asj_input none = {0};
    struct stat info;
    asj_status status;
    int file = open(message->path, OPEN_FLAGS);

    *input = none;
    if (file < 0)
        return asj_message_errno(message, errno, "cannot open");
    if (fstat(file, &info)) {
        status = asj_message_errno(message, errno, "cannot read");
    } else if (S_ISDIR(info.st_mode)) {
        status = asj_message_fail(message, ASJ_ERROR_FILE, "is a directory");
    } else if (S_ISREG(info.st_mode) && info.st_size > (off_t)ASJ_INPUT_MAX_BYTES) {
        status = asj_message_fail(message, ASJ_ERROR_LIMIT, "longer than %u bytes", ASJ_INPUT_MAX_BYTES);
    } else {
        /* one byte more than the file has, so that its end is seen without growing */
        size_t capacity = S_ISREG(info.st_mode) && info.st_size ? (size_t)info.st_size + 1 : HEAD_BYTES;
        status = read_all(file, capacity, input, check, message);
    }
    close(file);
    if (status != ASJ_OK) {
        free(input->bytes);
        *input = none;
    }
    return status;
}
