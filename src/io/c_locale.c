/* SPDX-License-Identifier: BSD-2-Clause */
/* The "C" locale for one thread: POSIX 2008, and macOS in a header of its own. */
#define _POSIX_C_SOURCE 200809L
#include "c_locale.h"

#include <locale.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

asj_status asj_c_locale_begin(asj_c_locale *locale, const asj_message *message)
{
    locale_t c = newlocale(LC_ALL_MASK, "C", (locale_t)0);
    if (c == (locale_t)0)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory");
    locale->c = (void *)c;
    locale->before = (void *)uselocale(c);
    return ASJ_OK;
}

void asj_c_locale_end(asj_c_locale *locale)
{
    uselocale((locale_t)locale->before);
    freelocale((locale_t)locale->c);
}
