/* SPDX-License-Identifier: BSD-2-Clause */
/* The extent of a JSON value, without memory for what is in it. */
#ifndef ASJ_IO_JSON_SKIP_H
#define ASJ_IO_JSON_SKIP_H

/* The end of the value that begins at `at`, or NULL when it is damaged or the text ends before it. *stop: where the damage is.
 * Bytes of a string are not checked to be UTF-8. */
const char *asj_json_skip(const char *at, const char *end, const char **stop);

#endif
