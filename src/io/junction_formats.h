/* SPDX-License-Identifier: BSD-2-Clause */
/* Readers of junction files: text_read.c and json_read.c. */
#ifndef ASJ_IO_JUNCTION_FORMATS_H
#define ASJ_IO_JUNCTION_FORMATS_H

#include "input.h"
#include "junction_list.h"

asj_status asj_read_text(const asj_input *input, asj_junction_list *list, const asj_message *message);
asj_status asj_read_json(const asj_input *input, asj_junction_list *list, const asj_message *message);

#endif
