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

asj_status asj_message_fail(const asj_message *message, asj_status status, const char *format, ...)
{
    va_list arguments;
    size_t used = 0;
    char *c;

    if (!message->text || !message->size)
        return status;
    if (message->path) {
        int n = snprintf(message->text, message->size, "%s: ", message->path);
        used = n < 0 ? 0 : (size_t)n;
    }
    if (used < message->size) {
        va_start(arguments, format);
        vsnprintf(message->text + used, message->size - used, format, arguments);
        va_end(arguments);
    }
    for (c = message->text; *c; c++)
        if ((unsigned char)*c < 32 || *c == 127)
            *c = '?';
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
