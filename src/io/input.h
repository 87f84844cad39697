/* SPDX-License-Identifier: BSD-2-Clause */
/* Whole files in memory. */
#ifndef ASJ_IO_INPUT_H
#define ASJ_IO_INPUT_H

#include "message.h"

/* Longest file that is read: what OpenCV's decoder takes. */
#define ASJ_INPUT_MAX_BYTES 2147483647u

typedef struct asj_input {
    unsigned char *bytes;
    size_t size;
    int is_regular; /* 0: a pipe or a device, which cannot be opened a second time */
} asj_input;

/* Reads message->path. On success the caller frees input->bytes.
 * ASJ_ERROR_FILE    missing, a directory, unreadable
 * ASJ_ERROR_FORMAT  empty
 * ASJ_ERROR_LIMIT   longer than ASJ_INPUT_MAX_BYTES
 * ASJ_ERROR_MEMORY */
asj_status asj_input_read(asj_input *input, const asj_message *message);

#endif
