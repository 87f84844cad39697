/* SPDX-License-Identifier: BSD-2-Clause */
/* Whole files in memory. */
#ifndef ASJ_IO_INPUT_H
#define ASJ_IO_INPUT_H

#include "message.h"

/* Longest file that is read. */
#define ASJ_INPUT_MAX_BYTES 2147483647u

typedef struct asj_input {
    unsigned char *bytes;
    size_t size;
} asj_input;

/* What is wrong with a file that begins so (64 KiB, or all of a shorter one), or NULL. The text has no arguments. */
typedef const char *asj_input_check(const asj_input *head);

/* Reads message->path. What does not pass the check is read no further, however long it is.
 * On success the caller frees input->bytes.
 * ASJ_ERROR_FILE    missing, a directory, unreadable
 * ASJ_ERROR_FORMAT  empty, or refused by the check
 * ASJ_ERROR_LIMIT   longer than ASJ_INPUT_MAX_BYTES
 * ASJ_ERROR_MEMORY */
asj_status asj_input_read(asj_input *input, asj_input_check *check, const asj_message *message);

/* Whether it begins as a file of features (.asjf). */
int asj_input_is_features(const asj_input *head);

#endif
