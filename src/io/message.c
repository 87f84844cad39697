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
