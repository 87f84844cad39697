/* SPDX-License-Identifier: BSD-2-Clause */
/* Messages of failures, with the name of the file. */
#define _POSIX_C_SOURCE 200809L
#include "message.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

asj_message asj_message_start(char *text, size_t size, const char *path)
{
    asj_message message = {text, size, path};
    if (text && size)
        text[0] = '\0';
    return message;
}

/* Writes "path: ", of an empty one two quotes, and of one that is too long its beginning and its end, in whole characters of UTF-8:
 * what went wrong is worth more than the middle of a name. Returns the length. */
static size_t put_path(char *text, size_t size, const char *path)
{
    enum { CAUSE = 160 }; /* bytes that stay for it, its end included, or half of a shorter text */
    path = *path ? path : "''";
    const size_t length = strlen(path), least = size / 2 < CAUSE ? size / 2 : CAUSE;
    const size_t most = size - least > 2 ? size - least - 2 : 0;
    size_t head = most > 3 ? (most - 3) / 2 : 0, tail = length > head ? length - head : length;
    int n;

    if (length <= most) {
        n = snprintf(text, size, "%s: ", path);
        return n < 0 ? 0 : (size_t)n;
    }
    while (head > 0 && ((unsigned char)path[head] & 0xc0) == 0x80)
        head--;
    while (((unsigned char)path[tail] & 0xc0) == 0x80)
        tail++;
    n = snprintf(text, size, "%.*s...%s: ", (int)head, path, path + tail);
    return n < 0 ? 0 : (size_t)n;
}

/* Control characters end or hide a line, and so do those that UTF-8 writes as C2 80 to C2 9F. */
static void make_harmless(char *text)
{
    unsigned char before = 0, here;
    for (; *text; text++, before = here) {
        here = (unsigned char)*text;
        if (here < 32 || here == 127)
            *text = '?';
        if (before == 0xc2 && here >= 0x80 && here <= 0x9f)
            text[-1] = text[0] = '?';
    }
}

asj_status asj_message_fail(const asj_message *message, asj_status status, const char *format, ...)
{
    va_list arguments;
    size_t used = 0;

    if (!message->text || !message->size)
        return status;
    if (message->path)
        used = put_path(message->text, message->size, message->path);
    if (used < message->size) {
        va_start(arguments, format);
        vsnprintf(message->text + used, message->size - used, format, arguments);
        va_end(arguments);
    }
    make_harmless(message->text);
    return status;
}

/* "Memory allocation of 9 bytes is beyond the 8 byte limit defined in open options" is libtiff's word for what a file asks beyond
 * reason (tiff_read.c): that file is damaged. */
static int is_of_memory(const char *complaint)
{
    static const char *const words[] = {"memory", "Memory", "No space", "alloc"};
    size_t i;
    if (complaint[0] == '\0')
        return 1;
    if (strstr(complaint, "limit"))
        return 0;
    for (i = 0; i < sizeof words / sizeof words[0]; i++)
        if (strstr(complaint, words[i]))
            return 1;
    return 0;
}

asj_status asj_message_reserved(const asj_message *message, const uint64_t reserved[2])
{
    if (!reserved[0] && !reserved[1])
        return ASJ_OK;
    return asj_message_fail(message, ASJ_ERROR_OPTION,
                            "not written: a reserved field of the report is not zero: never cleared, or of a later version");
}

asj_status asj_decoder_fail(const asj_message *message, const char *what, const char *complaint)
{
    if (is_of_memory(complaint))
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for its decoder");
    return asj_message_fail(message, ASJ_ERROR_FORMAT, "%s: %s", what, complaint);
}

asj_status asj_message_errno(const asj_message *message, int error, const char *action)
{
    char text[128];
#ifdef _WIN32
    if (strerror_s(text, sizeof text, error))
#else
    if (strerror_r(error, text, sizeof text))
#endif
        snprintf(text, sizeof text, "error %d", error);
    return asj_message_fail(message, error == ENOMEM ? ASJ_ERROR_MEMORY : ASJ_ERROR_FILE, "%s: %s", action, text);
}
