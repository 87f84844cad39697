/* SPDX-License-Identifier: BSD-2-Clause */
/* JSON, schema "asj-junctions-1": README.md, "File formats". The frame is written here and each value in it by jansson, junction by
 * junction, so that memory does not grow with the result. */
#include "junction_output.h"

#include "json_options.h"

#include <asj/version.h>

#include <jansson.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Nine digits give every float back. */
#define FLOAT_FLAGS (JSON_COMPACT | JSON_REAL_PRECISION(9))

typedef struct json_output {
    asj_output *output;
    int out_of_memory;
} json_output;

static int on_text(const char *text, size_t size, void *user)
{
    asj_output_write(user, text, size);
    return 0;
}

/* Writes a value after some text, and lets go of it. NULL: jansson had no memory for it. */
static void put(json_output *json, const char *before, json_t *value, size_t flags)
{
    asj_output_text(json->output, before);
    if (!value || json_dump_callback(value, on_text, json->output, flags | JSON_ENCODE_ANY))
        json->out_of_memory = 1;
    json_decref(value);
}

/* A file name need not be UTF-8, JSON must be: other bytes become '?'. */
static json_t *name_value(const char *name)
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

static const char *backend_name(int32_t backend)
{
    return backend == ASJ_BACKEND_CPU ? "cpu" : backend == ASJ_BACKEND_OPENCL ? "opencl" : "unknown";
}

/* Microseconds are more than a clock can tell, and short to read. */
static double round_ms(double ms)
{
    return isfinite(ms) ? floor(ms * 1000.0 + 0.5) / 1000.0 : 0.0;
}

static json_t *timing_value(const asj_detection *detection)
{
    json_t *stages = json_object();
    int32_t stage;
    for (stage = ASJ_STAGE_GRADIENT; stage <= ASJ_STAGE_DECOMPOSE; stage++)
        if (stages)
            json_object_set_new(stages, asj_stage_name(stage), json_real(round_ms(detection->stage_ms[stage])));
    return json_pack("{s:f, s:o}", "total_ms", round_ms(detection->total_ms), "stages", stages);
}

static void put_head(json_output *json, const asj_detection_report *report)
{
    const asj_detection *found = report->detection;
    json_t *image = json_object();

    if (report->image_name)
        json_object_set_new(image, "name", name_value(report->image_name));
    json_object_set_new(image, "width", json_integer(found->width));
    json_object_set_new(image, "height", json_integer(found->height));
    put(json, "{\n\"schema\": ", json_string("asj-junctions-1"), 0);
    put(json, ",\n\"library\": ", json_pack("{s:s, s:s}", "name", "libasj", "version", asj_version_string()), 0);
    put(json, ",\n\"image\": ", image, 0);
    put(json, ",\n\"units\": ",
        json_pack("{s:s, s:s, s:s, s:s, s:s}", "locations and lengths", "px", "angles", "rad", "strength", "standard deviations",
                  "log10_nfa", "log10 of the number of false alarms", "times", "ms"), 0);
    put(json, ",\n\"backend\": ", json_string(backend_name(found->backend)), 0);
    if (report->options) {
        json_t *options = asj_json_options(report->options);
        put(json, ",\n\"options\": ", options, asj_json_precision(options));
    }
    put(json, ",\n\"timing\": ", timing_value(found), JSON_REAL_PRECISION(15));
    put(json, ",\n\"counts\": ",
        json_pack("{s:I, s:I, s:I, s:I}", "candidates", (json_int_t)found->candidates, "isotropic", (json_int_t)found->isotropic,
                  "junctions", (json_int_t)found->junction_count, "l_junctions", (json_int_t)found->l_junction_count), 0);
}

static json_t *junction_value(const asj_junction *junction)
{
    json_t *branches = json_array();
    int32_t b;
    for (b = 0; b < junction->branch_count && branches; b++) {
        const asj_branch *branch = &junction->branches[b];
        json_t *value = json_pack("{s:f, s:f, s:f, s:f, s:f}", "angle", (double)branch->angle, "length", (double)branch->length,
                                  "strength", (double)branch->strength, "log10_nfa", (double)branch->log10_nfa,
                                  "angle_sd", (double)branch->angle_sd);
        if (json_array_append_new(branches, value)) {
            json_decref(branches);
            branches = NULL;
        }
    }
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:o}", "x", (double)junction->x, "y", (double)junction->y,
                     "scale", (double)junction->scale, "log10_nfa", (double)junction->log10_nfa,
                     "location_sd", (double)junction->location_sd, "branches", branches);
}

static json_t *pair_value(const asj_l_junction *pair)
{
    return json_pack("{s:I, s:i, s:i, s:f, s:f, s:f, s:f, s:f, s:f}", "junction", (json_int_t)pair->junction, "a",
                     (int)pair->branch_a, "b", (int)pair->branch_b, "x", (double)pair->x, "y", (double)pair->y, "ax",
                     (double)pair->ax, "ay", (double)pair->ay, "bx", (double)pair->bx, "by", (double)pair->by);
}

asj_status asj_write_json(asj_output *output, const asj_detection_report *report, const asj_message *message)
{
    const asj_detection *found = report->detection;
    json_output json = {output, 0};
    uint32_t i;

    put_head(&json, report);
    asj_output_text(output, ",\n\"junctions\": [");
    for (i = 0; i < found->junction_count && !json.out_of_memory; i++)
        put(&json, i ? ",\n" : "\n", junction_value(&found->junctions[i]), FLOAT_FLAGS);
    asj_output_text(output, "],\n\"l_junctions\": [");
    for (i = 0; i < found->l_junction_count && !json.out_of_memory; i++)
        put(&json, i ? ",\n" : "\n", pair_value(&found->l_junctions[i]), FLOAT_FLAGS);
    asj_output_text(output, "]\n}\n");
    return json.out_of_memory ? asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for JSON") : ASJ_OK;
}
