/* SPDX-License-Identifier: BSD-2-Clause */
/* printf() follows the locale in one point only: what separates the decimals, which may be several bytes. */
#include "number_text.h"

#include <stdio.h>
#include <string.h>

/* localeconv() would tell too, but is not thread safe. */
void asj_decimal_point(char point[ASJ_DECIMAL_POINT])
{
    snprintf(point, ASJ_DECIMAL_POINT, "%.1f", 0.5);
    const size_t length = strlen(point);
    memmove(point, point + 1, length - 2);
    point[length - 2] = '\0';
}

const char *asj_number_text(char text[ASJ_NUMBER_TEXT], int digits, double value)
{
    char point[ASJ_DECIMAL_POINT];
    asj_decimal_point(point);
    snprintf(text, ASJ_NUMBER_TEXT, "%.*g", digits, value);
    char *at = strstr(text, point);
    if (at) {
        const char *decimals = at + strlen(point);
        *at = '.';
        memmove(at + 1, decimals, strlen(decimals) + 1);
    }
    return text;
}
