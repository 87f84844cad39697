/* SPDX-License-Identifier: BSD-2-Clause */
/* Rows of an option table as JSON values. */
#include "json_options.h"

#include "json_output.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static json_t *radii_value(uint32_t bits)
{
    json_t *list = json_array();
    int radius;
    for (radius = 0; radius < 32; radius++)
        if (bits >> radius & 1)
            list = asj_json_append(list, json_integer(radius));
    return list;
}

static json_t *choice_value(const asj_option_info *row, int32_t choice)
{
    int32_t i;
    for (i = 0; i <= choice && row->choices[i]; i++)
        if (i == choice)
            return json_string(row->choices[i]);
    return json_integer(choice);
}

static json_t *option_value(const asj_option_info *row, const void *options)
{
    const char *field = (const char *)options + row->offset;
    double number;
    int32_t integer;
    uint32_t bits;

    if (row->type == ASJ_OPTION_NUMBER) {
        memcpy(&number, field, sizeof number);
        return json_real(number);
    }
    if (row->type == ASJ_OPTION_RADII) {
        memcpy(&bits, field, sizeof bits);
        return radii_value(bits);
    }
    memcpy(&integer, field, sizeof integer);
    if (row->type == ASJ_OPTION_SWITCH)
        return json_boolean(integer);
    return row->type == ASJ_OPTION_CHOICE ? choice_value(row, integer) : json_integer(integer);
}

json_t *asj_json_options(const void *options, size_t count, const asj_option_info *(*row_at)(size_t index))
{
    json_t *object = json_object();
    size_t i;
    for (i = 0; i < count && object; i++)
        object = asj_json_set(object, row_at(i)->key, option_value(row_at(i), options));
    return object;
}

size_t asj_json_precision(json_t *options)
{
    int precision = 6;
    const char *key;
    json_t *value;

    json_object_foreach (options, key, value) {
        char text[64];
        while (json_is_real(value) && precision < 17) {
            snprintf(text, sizeof text, "%.*g", precision, json_real_value(value));
            if (strtod(text, NULL) == json_real_value(value))
                break;
            precision++;
        }
    }
    return JSON_REAL_PRECISION((size_t)precision);
}
