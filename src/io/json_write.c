/* SPDX-License-Identifier: BSD-2-Clause */
/* JSON, schema "asj-junctions-1", as a file and as a line of many: asj-formats(5). */
#include "junction_output.h"

#include "c_locale.h"
#include "json_options.h"
#include "json_output.h"
#include "junction_graph.h"
#include "output.h"

#include <asj/version.h>

#include <errno.h>

/* These repeat from image to image: lines have none. */
static void put_options_and_timing(asj_json_output *json, const asj_detection_report *report)
{
    const asj_detection *found = report->detection;
    if (report->options) {
        json_t *options = asj_json_options(report->options, asj_detect_option_count(), asj_detect_option);
        asj_json_put(json, ",\n\"options\": ", options, asj_json_precision(options));
    }
    asj_json_put(json, ",\n\"timing\": ",
        asj_json_timing(found->total_ms, found->stage_ms, ASJ_STAGE_GRADIENT, ASJ_STAGE_DECOMPOSE), JSON_REAL_PRECISION(15));
}

static void put_head(asj_json_output *json, const asj_detection_report *report)
{
    const asj_detection *found = report->detection;
    json_t *image = json_object();

    if (report->image_name)
        image = asj_json_set(image, "name", asj_json_name(report->image_name));
    image = asj_json_set(image, "width", json_integer(found->width));
    image = asj_json_set(image, "height", json_integer(found->height));
    asj_json_put(json, "{\n\"schema\": ", json_string("asj-junctions-1"), 0);
    asj_json_put(json, ",\n\"library\": ", json_pack("{s:s, s:s}", "name", "libasj", "version", asj_version_string()), 0);
    asj_json_put(json, ",\n\"image\": ", image, 0);
    asj_json_put(json, ",\n\"units\": ",
        json_pack("{s:s, s:s, s:s, s:s, s:s}", "locations and lengths", "px", "angles", "rad", "strength", "standard deviations",
                  "log10_nfa", "log10 of the number of false alarms", "times", "ms"), 0);
    asj_json_put(json, ",\n\"backend\": ", json_string(asj_json_backend(found->backend)), 0);
    if (!json->compact)
        put_options_and_timing(json, report);
    asj_json_put(json, ",\n\"counts\": ",
        json_pack("{s:I, s:I, s:I, s:I, s:o*, s:I}", "candidates", (json_int_t)found->candidates, "isotropic",
                  (json_int_t)found->isotropic, "junctions", (json_int_t)found->junction_count, "edges",
                  (json_int_t)found->edge_count, "lines",
                  report->segments ? json_integer((json_int_t)report->segments->count) : NULL,
                  "l_junctions", (json_int_t)found->l_junction_count), 0);
}

static json_t *junction_value(const asj_junction *junction)
{
    json_t *branches = json_array();
    int32_t b;
    for (b = 0; b < junction->branch_count && branches; b++) {
        const asj_branch *branch = &junction->branches[b];
        json_t *value = json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:s*}", "angle", (double)branch->angle,
                                  "length", (double)branch->length,
                                  "strength", (double)branch->strength, "log10_nfa", (double)branch->log10_nfa,
                                  "angle_sd", (double)branch->angle_sd, "width", (double)branch->width,
                                  "length_sd", (double)branch->length_sd, "end", asj_end_word(branch->end));
        branches = asj_json_append(branches, value);
    }
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:i, s:o}", "x", (double)junction->x, "y", (double)junction->y,
                     "scale", (double)junction->scale, "log10_nfa", (double)junction->log10_nfa,
                     "location_sd", (double)junction->location_sd, "octave", (int)junction->octave, "branches", branches);
}

static json_t *edge_value(const asj_edge *edge)
{
    return json_pack("{s:I, s:i, s:I, s:i, s:f}", "junction_a", (json_int_t)edge->junction_a, "branch_a", (int)edge->branch_a,
                     "junction_b", (json_int_t)edge->junction_b, "branch_b", (int)edge->branch_b,
                     "log10_nfa", (double)edge->log10_nfa);
}

static json_t *end_value(uint32_t junction)
{
    return junction == ASJ_NO_JUNCTION ? json_null() : json_integer((json_int_t)junction);
}

static json_t *segment_value(const asj_segment *s)
{
    return json_pack("{s:f, s:f, s:f, s:f, s:f, s:f, s:s*, s:s*, s:o, s:o, s:f, s:I, s:i, s:i}", "x1", (double)s->x1,
                     "y1", (double)s->y1, "x2", (double)s->x2, "y2", (double)s->y2, "sd1", (double)s->sd1, "sd2", (double)s->sd2,
                     "end1", asj_end_word(s->end1), "end2", asj_end_word(s->end2), "junction1", end_value(s->junction1),
                     "junction2", end_value(s->junction2), "log10_nfa", (double)s->log10_nfa,
                     "junction", (json_int_t)s->junction, "branch", (int)s->branch, "branches", (int)s->branch_count);
}

static json_t *triple(const double values[3])
{
    return json_pack("[f, f, f]", values[0], values[1], values[2]);
}

static void put_vanishing_points(asj_json_output *json, const asj_vanishing_points *found)
{
    static const char *const sources[] = {"unknown", "given", "found"};
    const int known = found->focal_source > 0 && found->focal_source <= 2;
    const asj_camera *c = &found->camera;
    json_t *points = json_array();
    int32_t k;
    for (k = 0; k < found->count && k < ASJ_MOST_VANISHING; k++) {
        const asj_vanishing_point *p = &found->points[k];
        json_t *value = json_pack("{s:o, s:o, s:f, s:I}", "point", triple(p->point), "direction",
                                  known ? triple(p->direction) : json_null(), "log10_nfa", p->log10_nfa, "branches",
                                  (json_int_t)p->branch_count);
        points = asj_json_append(points, value);
    }
    asj_json_put(json, ",\n\"vanishing_points\": ",
                 json_pack("{s:s, s:o, s:o}", "focal_source", sources[known ? found->focal_source : 0], "camera",
                           known ? json_pack("[f, f, f, f]", c->fx, c->fy, c->cx, c->cy) : json_null(), "points", points),
                 JSON_REAL_PRECISION(15));
}

/* The object, without what ends its line. */
static void put_object(asj_json_output *json, const asj_detection_report *report)
{
    const asj_detection *found = report->detection;
    uint32_t i;
    put_head(json, report);
    if (report->vanishing_points)
        put_vanishing_points(json, report->vanishing_points);
    asj_json_text(json, ",\n\"junctions\": [");
    for (i = 0; i < found->junction_count && !json->out_of_memory; i++)
        asj_json_put(json, i ? ",\n" : "\n", junction_value(&found->junctions[i]), ASJ_JSON_FLOATS);
    asj_json_text(json, "],\n\"edges\": [");
    for (i = 0; i < found->edge_count && !json->out_of_memory; i++)
        asj_json_put(json, i ? ",\n" : "\n", edge_value(&found->edges[i]), ASJ_JSON_FLOATS);
    if (report->segments)
        asj_json_text(json, "],\n\"lines\": [");
    for (i = 0; report->segments && i < report->segments->count && !json->out_of_memory; i++)
        asj_json_put(json, i ? ",\n" : "\n", segment_value(&report->segments->segments[i]), ASJ_JSON_FLOATS);
    asj_json_text(json, "],\n\"l_junctions\": [");
    for (i = 0; i < found->l_junction_count && !json->out_of_memory; i++)
        asj_json_put(json, i ? ",\n" : "\n", asj_json_l_junction(&found->l_junctions[i]), ASJ_JSON_FLOATS);
    asj_json_text(json, "]\n}");
}

static asj_status no_memory(const asj_message *message)
{
    return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for JSON");
}

/* Nothing is written when it fails. */
static asj_status put_in_c_locale(asj_json_output *json, const asj_detection_report *report, const asj_message *message)
{
    asj_c_locale locale;
    const asj_status status = asj_c_locale_begin(&locale, message);
    if (status != ASJ_OK)
        return status;
    put_object(json, report);
    asj_c_locale_end(&locale);
    return ASJ_OK;
}

asj_status asj_write_json(asj_output *output, const asj_detection_report *report, const asj_message *message)
{
    asj_json_output json = {output, 0, 0};
    const asj_status status = put_in_c_locale(&json, report, message);
    if (status != ASJ_OK)
        return status;
    asj_output_text(output, "\n");
    return json.out_of_memory ? no_memory(message) : ASJ_OK;
}

/* A line has a reader as soon as it is there, and half of one has none. */
static asj_status end_line(asj_json_output *json, const asj_message *message)
{
    asj_output_text(json->output, "\n");
    if (json->out_of_memory) {
        asj_output_spoil(json->output, ENOMEM);
        return no_memory(message);
    }
    return asj_output_flush(json->output);
}

asj_status asj_write_json_line(asj_output *output, const asj_detection_report *report, const asj_message *message)
{
    asj_json_output json = {output, 0, 1};
    const asj_status status = put_in_c_locale(&json, report, message);
    return status == ASJ_OK ? end_line(&json, message) : status;
}

asj_status asj_write_json_failure(asj_output *output, const char *image_name, const char *cause, const asj_message *message)
{
    asj_json_output json = {output, 0, 1};
    asj_json_put(&json, "{\"schema\": ", json_string("asj-junctions-1"), 0);
    asj_json_put(&json, ",\"image\": ", asj_json_set(json_object(), "name", asj_json_name(image_name)), 0);
    asj_json_put(&json, ",\"error\": ", asj_json_name(cause), 0);
    asj_json_text(&json, "}");
    return end_line(&json, message);
}
