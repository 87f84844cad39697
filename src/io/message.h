/* SPDX-License-Identifier: BSD-2-Clause */
/* The one line of text that a failing function of libasj-io hands to its caller. */
#ifndef ASJ_IO_MESSAGE_H
#define ASJ_IO_MESSAGE_H

#include <asj/status.h>

/* Where a caller wants the line; text may be NULL. */
typedef struct asj_message {
    char *text;
    size_t size;
    const char *path; /* the file that every line names first */
} asj_message;

#if defined(__MINGW32__) /* as in src/core/context.h */
#define ASJ_IO_PRINTF(text, first) __attribute__((format(gnu_printf, text, first)))
#elif defined(__GNUC__)
#define ASJ_IO_PRINTF(text, first) __attribute__((format(printf, text, first)))
#else
#define ASJ_IO_PRINTF(text, first)
#endif

/* An empty line for `path`, so that a caller never reads an old one. */
asj_message asj_message_start(char *text, size_t size, const char *path);

/* Writes "path: cause", with '' for an empty path, and returns `status`. Control characters, which a hostile file name or file may
 * hold, become '?'. */
asj_status asj_message_fail(const asj_message *message, asj_status status, const char *format, ...) ASJ_IO_PRINTF(3, 4);

/* ASJ_ERROR_OPTION, with a line that says so, where a reserved field of a report is not zero. */
asj_status asj_message_reserved(const asj_message *message, const uint64_t reserved[2]);

/* Writes "path: what: complaint" of a decoder that has no status for memory that runs out, and returns ASJ_ERROR_FORMAT; where its
 * complaint is one of memory, or there is none, ASJ_ERROR_MEMORY. `complaint` has no line ends. */
asj_status asj_decoder_fail(const asj_message *message, const char *what, const char *complaint);

/* Writes "path: action: text of errno `error`" and returns ASJ_ERROR_FILE, or ASJ_ERROR_MEMORY for ENOMEM. */
asj_status asj_message_errno(const asj_message *message, int error, const char *action);

#endif
