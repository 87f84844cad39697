/* SPDX-License-Identifier: BSD-2-Clause */
/* The writers of match files. They ignore failed writes: asj_output_commit() tells. */
#ifndef ASJ_IO_MATCH_OUTPUT_H
#define ASJ_IO_MATCH_OUTPUT_H

#include <asj/io.h>

#include "message.h"

/* Line segments of a report; none when it asks for none. */
typedef struct asj_match_lines {
    asj_segment_match *list;
    size_t count;
} asj_match_lines;

void asj_write_match_csv(asj_output *output, const asj_match_report *report, const asj_match_lines *segments);

/* ASJ_ERROR_MEMORY */
asj_status asj_write_match_json(asj_output *output, const asj_match_report *report, const asj_match_lines *segments,
                                const asj_message *message);

#endif
