/* SPDX-License-Identifier: BSD-2-Clause */
/* Jansson reads and writes numbers by strtod() and snprintf() and then exchanges one byte for the decimal separator of the locale:
 * a separator of several bytes (ps_AF) ends the process or damages the output. While jansson works, the thread is in the "C"
 * locale; other threads and setlocale() do not notice. */
#ifndef ASJ_IO_C_LOCALE_H
#define ASJ_IO_C_LOCALE_H

#include "message.h"

typedef struct asj_c_locale {
    void *c, *before;
    int own; /* Windows: whether the thread had a locale of its own */
} asj_c_locale;

/* ASJ_OK: asj_c_locale_end() afterwards, in the same thread. ASJ_ERROR_MEMORY */
asj_status asj_c_locale_begin(asj_c_locale *locale, const asj_message *message);
void asj_c_locale_end(asj_c_locale *locale);

#endif
