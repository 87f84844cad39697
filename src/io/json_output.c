/* SPDX-License-Identifier: BSD-2-Clause */
/* JSON written piece by piece. */
#include "json_output.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static int on_text(const char *text, size_t size, void *user)
{
    asj_output_write(user, text, size);
    return 0;
}

void asj_json_text(asj_json_output *json, const char *text)
{
    while (json->compact && *text) {
        const size_t length = strcspn(text, " \n");
        asj_output_write(json->output, text, length);
        text += length;
        text += strspn(text, " \n");
    }
    asj_output_text(json->output, text);
}

void asj_json_put(asj_json_output *json, const char *before, json_t *value, size_t flags)
{
    asj_json_text(json, before);
    if (!value || json_dump_callback(value, on_text, json->output, flags | JSON_ENCODE_ANY | (json->compact ? JSON_COMPACT : 0)))
        json->out_of_memory = 1;
    json_decref(value);
}

json_t *asj_json_name(const char *name)
{
    json_t *value = json_string(name);
    size_t size = strlen(name) + 1, i;
    char *ascii;

    if (value || !(ascii = malloc(size)))
        return value;
    for (i = 0; i < size; i++)
        ascii[i] = (char)((unsigned char)name[i] < 128 ? name[i] : '?');
    value = json_string(ascii);
    free(ascii);
    return value;
}

const char *asj_json_backend(int32_t backend)
{
    return backend == ASJ_BACKEND_CPU ? "cpu" : backend == ASJ_BACKEND_OPENCL ? "opencl" : "unknown";
}

json_t *asj_json_append(json_t *list, json_t *value)
{
    if (json_array_append_new(list, value) == 0)
        return list;
    json_decref(list);
    return NULL;
}

json_t *asj_json_set(json_t *object, const char *key, json_t *value)
{
    if (json_object_set_new(object, key, value) == 0)
        return object;
    json_decref(object);
    return NULL;
}

/* Microseconds are more than a clock can tell, and short to read. */
static double round_ms(double ms)
{
    return isfinite(ms * 1000.0) ? floor(ms * 1000.0 + 0.5) / 1000.0 : 0.0;
}

json_t *asj_json_timing(double total_ms, const double *stage_ms, int32_t first, int32_t last)
{
    json_t *stages = json_object();
    int32_t stage;
    for (stage = first; stage <= last; stage++)
        stages = asj_json_set(stages, asj_stage_name(stage), json_real(round_ms(stage_ms[stage])));
    return json_pack("{s:f, s:o}", "total_ms", round_ms(total_ms), "stages", stages);
}

json_t *asj_json_l_junction(const asj_l_junction *pair)
{
    return json_pack("{s:I, s:i, s:i, s:f, s:f, s:f, s:f, s:f, s:f}", "junction", (json_int_t)pair->junction, "a",
                     (int)pair->branch_a, "b", (int)pair->branch_b, "x", (double)pair->x, "y", (double)pair->y, "ax",
                     (double)pair->ax, "ay", (double)pair->ay, "bx", (double)pair->bx, "by", (double)pair->by);
}
