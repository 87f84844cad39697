/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "input.h"

#include <errno.h>
#include <fcntl.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

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

static asj_status read_all(int file, size_t capacity, asj_input *input, const asj_message *message)
{
    asj_status status = ASJ_OK;

    input->bytes = malloc(capacity);
    if (!input->bytes)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for %zu bytes of the file", capacity);
    for (;;) {
        ssize_t got = read(file, input->bytes + input->size, capacity - input->size);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return asj_message_errno(message, errno, "cannot read");
        if (got == 0)
            break;
        input->size += (size_t)got;
        if (input->size == capacity)
            status = grow(input, &capacity, message);
        if (status != ASJ_OK)
            return status;
    }
    return input->size ? ASJ_OK : asj_message_fail(message, ASJ_ERROR_FORMAT, "the file is empty");
}

asj_status asj_input_read(asj_input *input, const asj_message *message)
{
    static const asj_input none = {0};
    struct stat info;
    asj_status status;
    int file = open(message->path, O_RDONLY | O_CLOEXEC | O_NOCTTY);

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
        input->is_regular = S_ISREG(info.st_mode);
        /* one byte more than the file has, so that its end is seen without growing */
        status = read_all(file, S_ISREG(info.st_mode) && info.st_size ? (size_t)info.st_size + 1 : 65536, input, message);
    }
    close(file);
    if (status != ASJ_OK) {
        free(input->bytes);
        *input = none;
    }
    return status;
}
