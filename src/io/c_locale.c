/* SPDX-License-Identifier: BSD-2-Clause */
/* The "C" locale for one thread: POSIX 2008, macOS in a header of its own, Windows by a locale of the thread's own. */
#define _POSIX_C_SOURCE 200809L
#include "c_locale.h"

#include <locale.h>
#ifdef __APPLE__
#include <xlocale.h>
#endif

#ifdef _WIN32

#include <stdlib.h>
#include <string.h>

asj_status asj_c_locale_begin(asj_c_locale *locale, const asj_message *message)
{
    const char *name = setlocale(LC_ALL, NULL);
    const size_t size = name ? strlen(name) + 1 : 0;
    char *before = size ? malloc(size) : NULL;
    if (!before)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory");
    memcpy(before, name, size);
    locale->before = before;
    locale->own = _configthreadlocale(_ENABLE_PER_THREAD_LOCALE);
    setlocale(LC_ALL, "C");
    return ASJ_OK;
}

void asj_c_locale_end(asj_c_locale *locale)
{
    setlocale(LC_ALL, locale->before);
    _configthreadlocale(locale->own);
    free(locale->before);
}

#else

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

#endif
