/* SPDX-License-Identifier: BSD-2-Clause */
/* printf and strtod follow the locale of the process in one point only: the decimal separator, which may be several bytes long.
 * It is exchanged here in plain text: newlocale() (c_locale.c) is not everywhere, and setlocale() is not thread safe. */
#include "number.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int is_digit(char c)
{
    return c >= '0' && c <= '9';
}

/* Replaces whatever stands for the decimal separator by a point. */
static void use_point(char *text)
{
    const char *from = text;
    char *to = text;
    while (*from) {
        if (strchr("0123456789+-einfa", *from)) {
            *to++ = *from++;
            continue;
        }
        *to++ = '.';
        while (*from && !is_digit(*from))
            from++;
    }
    *to = '\0';
}

const char *asj_number_float(char text[ASJ_NUMBER_SIZE], float value)
{
    int precision;
    for (precision = 6; precision <= 9; precision++) {
        snprintf(text, ASJ_NUMBER_SIZE, "%.*g", precision, (double)value);
        if (strtof(text, NULL) == value) /* both in the locale of the process */
            break;
    }
    use_point(text);
    return text;
}

const char *asj_number_nine(char text[ASJ_NUMBER_SIZE], double value)
{
    snprintf(text, ASJ_NUMBER_SIZE, "%.9g", value);
    use_point(text);
    return text;
}

const char *asj_number_fixed(char text[ASJ_NUMBER_SIZE], float value)
{
    snprintf(text, ASJ_NUMBER_SIZE, "%.6f", (double)value);
    use_point(text);
    return text;
}

/* Checks the form; *point receives the place of the point, or `length`. */
static int is_number(const char *text, size_t length, size_t *point)
{
    size_t i = 0, digits = 0;

    *point = length;
    if (i < length && (text[i] == '+' || text[i] == '-'))
        i++;
    for (; i < length && is_digit(text[i]); i++)
        digits++;
    if (i < length && text[i] == '.') {
        *point = i++;
        for (; i < length && is_digit(text[i]); i++)
            digits++;
    }
    if (!digits)
        return 0;
    if (i < length && (text[i] == 'e' || text[i] == 'E')) {
        i++;
        if (i < length && (text[i] == '+' || text[i] == '-'))
            i++;
        for (digits = 0; i < length && is_digit(text[i]); i++)
            digits++;
    }
    return digits && i == length;
}

int asj_number_parse(const char *text, size_t length, double *value)
{
    char separator[16], copy[256];
    size_t point, separator_length;
    double number;

    if (length >= sizeof copy - sizeof separator || !is_number(text, length, &point))
        return 0;
    snprintf(separator, sizeof separator, "%.1f", 0.5);
    separator_length = strlen(separator) - 2; /* less the digits around it */
    memcpy(copy, text, point);
    if (point < length) {
        memcpy(copy + point, separator + 1, separator_length);
        memcpy(copy + point + separator_length, text + point + 1, length - point - 1);
        length += separator_length - 1;
    }
    copy[length] = '\0';
    number = strtod(copy, NULL);
    if (!isfinite(number))
        return 0;
    *value = number;
    return 1;
}

int asj_number_parse_integer(const char *text, size_t length, long long *value)
{
    size_t i = length && (text[0] == '+' || text[0] == '-');
    long long number = 0;

    if (i == length)
        return 0;
    for (; i < length; i++) {
        if (!is_digit(text[i]) || number >= 100000000000000LL)
            return 0;
        number = 10 * number + (text[i] - '0');
    }
    *value = text[0] == '-' ? -number : number;
    return 1;
}
