/* SPDX-License-Identifier: BSD-2-Clause */
/* Options as JSON. */
#ifndef ASJ_IO_JSON_OPTIONS_H
#define ASJ_IO_JSON_OPTIONS_H

#include <asj/options.h>

#include <jansson.h>

/* An object with every option of the table by its key: numbers, true or false, words, lists of radii. NULL = out of memory. */
json_t *asj_json_options(const asj_detect_options *options);

/* The flag of the smallest precision at which every number of an object of asj_json_options() reads back to the same double: 0.4
 * is to be read as 0.4, and not as 0.40000000000000002. */
size_t asj_json_precision(json_t *options);

#endif
