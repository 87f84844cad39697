/* SPDX-License-Identifier: BSD-2-Clause */
/* Decoders in processes of their own. */
#ifndef ASJ_IO_DECODER_PROCESS_H
#define ASJ_IO_DECODER_PROCESS_H

#include "image_buffer.h"

/* Has `program` decode the file, for which the probe knows the size: an image of that size, or, when the file turns or crops it,
 * one of no more pixels and no longer sides. ASJ_ERROR_UNSUPPORTED when the program is not installed or lacks a codec. */
asj_status asj_decode_elsewhere(const char *program, const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels,
                                asj_image_buffer *buffer, const asj_message *message);

#endif
