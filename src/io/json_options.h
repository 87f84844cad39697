/* SPDX-License-Identifier: BSD-2-Clause */
/* Options as JSON. */
#ifndef ASJ_IO_JSON_OPTIONS_H
#define ASJ_IO_JSON_OPTIONS_H

#include <asj/options.h>

#include <jansson.h>

/* An object with every option of a table of `count` rows by its key: numbers, true or false, words, lists of radii. `options` is
 * the struct that the table is about. NULL = out of memory. */
json_t *asj_json_options(const void *options, size_t count, const asj_option_info *(*row_at)(size_t index));

/* The flag of the smallest precision at which every number of an object of asj_json_options() reads back to the same double: 0.4
 * is to be read as 0.4, and not as 0.40000000000000002. */
size_t asj_json_precision(json_t *options);

#endif
