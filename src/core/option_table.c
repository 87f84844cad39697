/* SPDX-License-Identifier: BSD-2-Clause */
/* Options as rows of a table: values of presets, ranges, numbers as text in any locale. */
#include "option_table.h"
#include "number_text.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void say(char *message, size_t size, const char *format, ...)
{
    if (!message || size == 0)
        return;
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, size, format, arguments);
    va_end(arguments);
}

double asj_option_load(const asj_option_info *row, const void *options)
{
    const char *field = (const char *)options + row->offset;
    double number;
    int32_t integer;
    uint32_t bits;
    switch (row->type) {
    case ASJ_OPTION_NUMBER: memcpy(&number, field, sizeof number); return number;
    case ASJ_OPTION_RADII: memcpy(&bits, field, sizeof bits); return bits;
    default: memcpy(&integer, field, sizeof integer); return integer;
    }
}

static void store(const asj_option_info *row, void *options, double value)
{
    char *field = (char *)options + row->offset;
    int32_t integer;
    uint32_t bits;
    switch (row->type) {
    case ASJ_OPTION_NUMBER: value += 0.0; memcpy(field, &value, sizeof value); break; /* -0 is 0 */
    case ASJ_OPTION_RADII: bits = (uint32_t)value; memcpy(field, &bits, sizeof bits); break;
    default: integer = (int32_t)value; memcpy(field, &integer, sizeof integer); break;
    }
}

static int in_range(const asj_option_info *row, double value)
{
    if (row->type != ASJ_OPTION_RADII)
        return value >= row->minimum && value <= row->maximum && /* false for NaN */
               (row->step <= 0 || fmod(value - row->minimum, row->step) == 0);
    uint32_t allowed = (uint32_t)(((uint64_t)2 << (int)row->maximum) - ((uint64_t)1 << (int)row->minimum));
    uint32_t bits = (uint32_t)value;
    return bits != 0 && (bits & ~allowed) == 0;
}

static void say_range(const asj_option_info *row, const char *value, char *message, size_t message_size)
{
    if (row->step > 1)
        say(message, message_size, "%s: %s is not one of %s, %s .. %s", row->key, value, ASJ_TEXT_NINE(row->minimum),
            ASJ_TEXT_NINE(row->minimum + row->step), ASJ_TEXT_NINE(row->maximum));
    else
        say(message, message_size, "%s: %s is outside %s .. %s", row->key, value, ASJ_TEXT_NINE(row->minimum),
            ASJ_TEXT_NINE(row->maximum));
}

asj_status asj_option_table_preset(const asj_option_table *table, void *options, int32_t preset)
{
    if (!options)
        return ASJ_ERROR_ARGUMENT;
    if (preset != ASJ_PRESET_DEFAULT && preset != ASJ_PRESET_PAPER && preset != ASJ_PRESET_MATCH)
        return ASJ_ERROR_OPTION;
    memset(options, 0, table->size);
    for (size_t i = 0; i < table->count; i++) {
        const asj_option_info *row = &table->rows[i];
        const double values[] = {row->default_value, row->paper_value, row->match_value}; /* in the order of ASJ_PRESET_... */
        store(row, options, values[preset]);
    }
    return ASJ_OK;
}

const asj_option_info *asj_option_table_row(const asj_option_table *table, size_t index)
{
    return index < table->count ? &table->rows[index] : NULL;
}

static int print_radii(char *text, size_t size, uint32_t bits)
{
    char buffer[128] = "";
    int used = 0;
    for (int r = 0; r < 32; r++) {
        if (!(bits >> r & 1))
            continue;
        int last = r;
        while (last < 31 && (bits >> (last + 1) & 1))
            last++;
        const char *comma = used ? "," : "";
        if (last - r >= 2)
            used += snprintf(buffer + used, sizeof buffer - (size_t)used, "%s%d-%d", comma, r, last);
        else
            used += snprintf(buffer + used, sizeof buffer - (size_t)used, last > r ? "%s%d,%d" : "%s%d", comma, r, last);
        r = last;
    }
    return snprintf(text, size, "%s", buffer);
}

asj_status asj_option_table_check(const asj_option_table *table, const void *options, char *message, size_t message_size)
{
    for (size_t i = 0; i < table->count; i++) {
        const asj_option_info *row = &table->rows[i];
        double value = asj_option_load(row, options);
        if (!in_range(row, value)) {
            char text[128];
            if (row->type == ASJ_OPTION_RADII)
                print_radii(text, sizeof text, (uint32_t)value);
            else
                asj_number_text(text, 9, value);
            say_range(row, text[0] ? text : "an empty set", message, message_size);
            return ASJ_ERROR_OPTION;
        }
    }
    return ASJ_OK;
}

/* '-' in the wanted key stands for '_'. */
static int is_key(const char *key, const char *wanted)
{
    while (*key && (*key == *wanted || (*key == '_' && *wanted == '-')))
        key++, wanted++;
    return *key == *wanted;
}

static const asj_option_info *find(const asj_option_table *table, const char *key)
{
    for (size_t i = 0; i < table->count; i++)
        if (is_key(table->rows[i].key, key) || (table->rows[i].former_key && is_key(table->rows[i].former_key, key)))
            return &table->rows[i];
    return NULL;
}

/* Longest number that is read: more than any number needs, exact binary fractions included. */
#define LONGEST_NUMBER 400

static const char *skip_digits(const char *text, int *digits)
{
    for (; *text >= '0' && *text <= '9'; text++)
        ++*digits;
    return text;
}

/* Whether `text` is a decimal number and nothing else; where its point is, or NULL. strtod() alone would take hexadecimal numbers,
 * "inf" and leading blanks too. */
static int is_number(const char *text, const char **point)
{
    int digits = 0, power_digits = 0;
    *point = NULL;
    if (*text == '-' || *text == '+')
        text++;
    text = skip_digits(text, &digits);
    if (*text == '.') {
        *point = text;
        text = skip_digits(text + 1, &digits);
    }
    if (digits == 0)
        return 0;
    if (*text == 'e' || *text == 'E') {
        text++;
        if (*text == '-' || *text == '+')
            text++;
        text = skip_digits(text, &power_digits);
        if (power_digits == 0)
            return 0;
    }
    return *text == '\0';
}

/* A decimal number that is the whole of `text`, independent of the locale, to the nearest double; 0 when it is not one. */
static int parse_number(const char *text, double *value)
{
    char copy[LONGEST_NUMBER + 1 + ASJ_DECIMAL_POINT], point[ASJ_DECIMAL_POINT];
    const char *at;
    if (strlen(text) > LONGEST_NUMBER || !is_number(text, &at))
        return 0;
    asj_decimal_point(point);
    if (at)
        snprintf(copy, sizeof copy, "%.*s%s%s", (int)(at - text), text, point, at + 1);
    *value = strtod(at ? copy : text, NULL);
    return 1;
}

/* "5,7,10,14", "3-12", or a mixture. */
static int parse_radii(const char *text, double *value)
{
    uint32_t bits = 0;
    while (1) {
        int bound[2], n = 0;
        do {
            int number = 0, digits = 0;
            for (; *text >= '0' && *text <= '9' && digits < 3; text++, digits++)
                number = number * 10 + (*text - '0');
            if (digits == 0 || number > 30)
                return 0;
            bound[n++] = number;
        } while (n < 2 && *text == '-' && text++);
        if (bound[0] > bound[n - 1])
            return 0;
        for (int r = bound[0]; r <= bound[n - 1]; r++)
            bits |= (uint32_t)1 << r;
        if (*text == '\0')
            break;
        if (*text++ != ',')
            return 0;
    }
    *value = bits;
    return bits != 0;
}

static int parse_word(const char *const *words, const char *text, double *value)
{
    for (int i = 0; words[i]; i++)
        if (strcmp(words[i], text) == 0) {
            *value = i;
            return 1;
        }
    return 0;
}

static int parse(const asj_option_info *row, const char *text, double *value)
{
    static const char *const switches[] = {"no", "yes", "off", "on", "false", "true", "0", "1", NULL};
    switch (row->type) {
    case ASJ_OPTION_NUMBER: return parse_number(text, value);
    case ASJ_OPTION_INTEGER: return parse_number(text, value) && *value == floor(*value);
    case ASJ_OPTION_RADII: return parse_radii(text, value);
    case ASJ_OPTION_CHOICE: return parse_word(row->choices, text, value);
    default:
        if (!parse_word(switches, text, value))
            return 0;
        *value = (int)*value & 1;
        return 1;
    }
}

/* Which words there are. */
static void say_words(const asj_option_info *row, const char *text, char *message, size_t message_size)
{
    char words[256] = "";
    size_t used = 0;
    for (int i = 0; row->choices[i] && used < sizeof words; i++)
        used += (size_t)snprintf(words + used, sizeof words - used, "%s%s", i > 0 ? ", " : "", row->choices[i]);
    say(message, message_size, "%s: '%s' is none of %s", row->key, text, words);
}

/* What it should have been. */
static void say_kind(const asj_option_info *row, const char *text, char *message, size_t message_size)
{
    static const char *const kinds[] = {"", "a number", "a whole number", "yes or no", "",
                                        "a set of radii such as 5,7,10 or 3-12"};
    if (row->type == ASJ_OPTION_CHOICE)
        say_words(row, text, message, message_size);
    else
        say(message, message_size, "%s: '%s' is not %s", row->key, text, kinds[row->type]);
}

asj_status asj_option_table_set(const asj_option_table *table, void *options, const char *key, const char *text,
                                char *message, size_t message_size)
{
    say(message, message_size, "%s", "");
    if (!options || !key || !text)
        return ASJ_ERROR_ARGUMENT;
    const asj_option_info *row = find(table, key);
    if (!row) {
        say(message, message_size, "there is no option '%s'", key);
        return ASJ_ERROR_OPTION;
    }
    double value = 0;
    if (!parse(row, text, &value)) {
        say_kind(row, text, message, message_size);
        return ASJ_ERROR_OPTION;
    }
    if (!in_range(row, value)) {
        say_range(row, text, message, message_size);
        return ASJ_ERROR_OPTION;
    }
    store(row, options, value);
    if (!is_key(row->key, key))
        say(message, message_size, "%s is called %s now; the next version does not know the former name", row->former_key,
            row->key);
    return ASJ_OK;
}

/* Shortest form that reads back to the same double, with a point whatever the locale. */
static int print_number(char *text, size_t size, double value)
{
    char buffer[ASJ_NUMBER_TEXT];
    int precision;
    for (precision = 6; precision < 17; precision++) {
        snprintf(buffer, sizeof buffer, "%.*g", precision, value);
        if (strtod(buffer, NULL) == value) /* both in the locale of the process */
            break;
    }
    return snprintf(text, size, "%s", asj_number_text(buffer, precision, value));
}

asj_status asj_option_table_get(const asj_option_table *table, const void *options, const char *key,
                                char *text, size_t text_size)
{
    if (!options || !key || !text)
        return ASJ_ERROR_ARGUMENT;
    const asj_option_info *row = find(table, key);
    if (!row)
        return ASJ_ERROR_OPTION;
    double value = asj_option_load(row, options);
    int length;
    if (row->type == ASJ_OPTION_NUMBER)
        length = print_number(text, text_size, value);
    else if (row->type == ASJ_OPTION_RADII)
        length = print_radii(text, text_size, (uint32_t)value);
    else if (row->type == ASJ_OPTION_CHOICE && in_range(row, value))
        length = snprintf(text, text_size, "%s", row->choices[(int)value]);
    else if (row->type == ASJ_OPTION_SWITCH)
        length = snprintf(text, text_size, "%s", value != 0 ? "yes" : "no");
    else
        length = snprintf(text, text_size, "%d", (int)value);
    return length >= 0 && (size_t)length < text_size ? ASJ_OK : ASJ_ERROR_ARGUMENT;
}
