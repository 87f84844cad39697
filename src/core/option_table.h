/* SPDX-License-Identifier: BSD-2-Clause */
/* What every options struct shares: filling, checking, setting and printing fields by the rows of a table. */
#ifndef ASJ_SRC_OPTION_TABLE_H
#define ASJ_SRC_OPTION_TABLE_H

#include <asj/options.h>

typedef struct asj_option_table {
    const asj_option_info *rows;
    size_t count;
} asj_option_table;

/* Writes the values of a preset into the fields of `options`. */
void asj_option_table_fill(const asj_option_table *table, void *options, int32_t preset);

/* ASJ_OK, or ASJ_ERROR_OPTION with a sentence about the first field out of range. */
asj_status asj_option_table_check(const asj_option_table *table, const void *options, char *message, size_t message_size);

/* See asj_detect_options_set() and asj_detect_options_get(). */
asj_status asj_option_table_set(const asj_option_table *table, void *options, const char *key, const char *text,
                                char *message, size_t message_size);
asj_status asj_option_table_get(const asj_option_table *table, const void *options, const char *key,
                                char *text, size_t text_size);

#endif
