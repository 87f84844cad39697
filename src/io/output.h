/* SPDX-License-Identifier: BSD-2-Clause */
/* What writers in this library ask of an output, besides asj/io.h. */
#ifndef ASJ_IO_OUTPUT_H
#define ASJ_IO_OUTPUT_H

#include <asj/io.h>

/* Its path as the caller gave it, for messages. */
const char *asj_output_path(const asj_output *output);

/* Hands on what was written so far, so that who reads standard output or a pipe has it now. ASJ_ERROR_FILE as of
 * asj_output_write(). */
asj_status asj_output_flush(asj_output *output);

/* What was written ends in the middle of something for this errno: writes nothing more, and asj_output_commit() will fail. */
void asj_output_spoil(asj_output *output, int error);

#endif
