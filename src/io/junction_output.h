/* SPDX-License-Identifier: BSD-2-Clause */
/* The writers of junction files. They ignore failed writes: asj_output_commit() tells. */
#ifndef ASJ_IO_JUNCTION_OUTPUT_H
#define ASJ_IO_JUNCTION_OUTPUT_H

#include <asj/io.h>

#include "message.h"

void asj_write_text(asj_output *output, const asj_detection *detection, int whole);

/* ASJ_ERROR_MEMORY */
asj_status asj_write_csv(asj_output *output, const asj_detection *detection, const asj_message *message);
void asj_write_segments_csv(asj_output *output, const asj_segment_list *list);
asj_status asj_write_json(asj_output *output, const asj_detection_report *report, const asj_message *message);

/* Whole lines, handed on at once: ASJ_ERROR_FILE where that fails, without a message. After ASJ_ERROR_MEMORY within a line the
 * output cannot be committed. */
asj_status asj_write_json_line(asj_output *output, const asj_detection_report *report, const asj_message *message);
asj_status asj_write_json_failure(asj_output *output, const char *image_name, const char *cause, const asj_message *message);

#endif
