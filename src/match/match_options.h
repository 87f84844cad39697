/* SPDX-License-Identifier: BSD-2-Clause */
/* The options of asj_match(). */
#ifndef ASJ_SRC_MATCH_OPTIONS_H
#define ASJ_SRC_MATCH_OPTIONS_H

#include "core/context.h"

#include <asj/match.h>

/* The one place where the matcher's options are checked: ASJ_OK, or ASJ_ERROR_OPTION and a sentence. */
asj_status asj_match_options_check(const asj_match_options *options, char *message, size_t message_size);

/* That, and of the geometry if one is asked for: what a caller's options are checked by, who hears of it from the context. */
asj_status asj_match_request_check(asj_context *context, const asj_match_options *options);

/* The first key, in the order of the table, by which features of an image differ that are made with these options; NULL = they are
 * the same features. */
const char *asj_match_options_difference(const asj_match_options *left, const asj_match_options *right);

#endif
