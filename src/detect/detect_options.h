/* SPDX-License-Identifier: BSD-2-Clause */
/* The options of the detector and their check. */
#ifndef ASJ_SRC_DETECT_OPTIONS_H
#define ASJ_SRC_DETECT_OPTIONS_H

#include "core/option_table.h"

#include <asj/detect.h>

/* The one place where the detector's options are checked: ASJ_OK, or ASJ_ERROR_OPTION and a sentence. */
asj_status asj_detect_options_check(const asj_detect_options *options, char *message, size_t message_size);

#endif
