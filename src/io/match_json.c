/* SPDX-License-Identifier: BSD-2-Clause */
/* JSON, schema "asj-matches-1": asj-formats(5). */
#include "match_output.h"

#include "c_locale.h"
#include "json_options.h"
#include "json_output.h"

#include <asj/version.h>

#include <math.h>

static json_t *image_value(const asj_match_report *report, int v)
{
    json_t *image = json_object();
    if (report->image_names[v])
        image = asj_json_set(image, "name", asj_json_name(report->image_names[v]));
    if (report->widths[v] > 0 && report->heights[v] > 0) {
        image = asj_json_set(image, "width", json_integer(report->widths[v]));
        image = asj_json_set(image, "height", json_integer(report->heights[v]));
    }
    if (report->junction_names[v])
        image = asj_json_set(image, "junctions", asj_json_name(report->junction_names[v]));
    return image;
}

static void put_options(asj_json_output *json, const asj_match_report *report)
{
    json_t *options;
    if (report->options) {
        options = asj_json_options(report->options, asj_match_option_count(), asj_match_option);
        asj_json_put(json, ",\n\"options\": ", options, asj_json_precision(options));
    }
    if (report->detect_options) {
        options = asj_json_options(report->detect_options, asj_detect_option_count(), asj_detect_option);
        asj_json_put(json, ",\n\"detect_options\": ", options, asj_json_precision(options));
    }
}

static json_t *numbers(const double *values, int count)
{
    json_t *list = json_array();
    int k;
    for (k = 0; k < count; k++)
        list = asj_json_append(list, json_real(values[k]));
    return list;
}

static void put_head(asj_json_output *json, const asj_match_report *report, const asj_match_lines *segments)
{
    const asj_match_result *result = report->result;
    /* asj_match_images() detects, too */
    const int32_t first = result->stage_ms[ASJ_STAGE_GRADIENT] > 0 ? ASJ_STAGE_GRADIENT : ASJ_STAGE_PATCHES;
    json_t *counts = json_pack("{s:I, s:I, s:I, s:I}", "l_junctions1", (json_int_t)result->l_junction_count1, "l_junctions2",
                               (json_int_t)result->l_junction_count2, "candidates", (json_int_t)result->candidates, "matches",
                               (json_int_t)result->match_count);
    if (report->lines)
        counts = asj_json_set(counts, "lines", json_integer((json_int_t)segments->count));
    asj_json_put(json, "{\n\"schema\": ", json_string("asj-matches-1"), 0);
    asj_json_put(json, ",\n\"library\": ", json_pack("{s:s, s:s}", "name", "libasj", "version", asj_version_string()), 0);
    asj_json_put(json, ",\n\"images\": ", json_pack("[o, o]", image_value(report, 0), image_value(report, 1)), 0);
    if (report->stretch[0] > 0)
        asj_json_put(json, ",\n\"stretch\": ", numbers(report->stretch, 2), JSON_REAL_PRECISION(15));
    asj_json_put(json, ",\n\"upsampled\": ", json_boolean(result->upsampled), 0);
    asj_json_put(json, ",\n\"coloured\": ", json_boolean(result->coloured), 0);
    asj_json_put(json, ",\n\"units\": ", json_pack("{s:s, s:s, s:s}", "locations and lengths", "px", "affine",
                 "x2 = h11 x1 + h12 y1 + h13, y2 = h21 x1 + h22 y1 + h23", "times", "ms"), 0);
    asj_json_put(json, ",\n\"backend\": ", json_string(asj_json_backend(result->backend)), 0);
    put_options(json, report);
    asj_json_put(json, ",\n\"timing\": ",
                 asj_json_timing(result->total_ms, result->stage_ms, first, ASJ_STAGE_ASSIGN), JSON_REAL_PRECISION(15));
    asj_json_put(json, ",\n\"counts\": ", counts, 0);
}

static json_t *motion_value(const double rotation[9], const double translation[3], double log10_nfa)
{
    const int is_known = translation[0] != 0 || translation[1] != 0 || translation[2] != 0;
    return json_pack("{s:o, s:o, s:f}", "rotation", is_known ? numbers(rotation, 9) : json_null(), "translation",
                     is_known ? numbers(translation, 3) : json_null(), "log10_nfa", log10_nfa);
}

/* The two that an ambiguous geometry stands between. */
static void put_rivals(asj_json_output *json, const asj_geometry *g)
{
    json_t *best = motion_value(g->rotation, g->translation, g->log10_nfa);
    json_t *rival = motion_value(g->rival_rotation, g->rival_translation, g->rival_log10_nfa);
    asj_json_put(json, ",\n\"geometry_rivals\": ", json_pack("[o, o]", best, rival), JSON_REAL_PRECISION(15));
}

/* fx, fy, cx and cy of both. */
static json_t *cameras_value(const asj_camera c[2])
{
    return json_pack("[[f, f, f, f], [f, f, f, f]]", c[0].fx, c[0].fy, c[0].cx, c[0].cy, c[1].fx, c[1].fy, c[1].cx, c[1].cy);
}

/* Of a camera that only turns. Not as a rotation without a translation: whoever finds one wants the other. */
static json_t *turn_value(const asj_geometry *g)
{
    double covariance[9];
    for (int32_t k = 0; k < 9; k++)
        covariance[k] = g->covariance[6 * (k / 3) + k % 3];
    return json_pack("{s:o, s:o}", "rotation", numbers(g->rotation, 9), "covariance", numbers(covariance, 9));
}

/* What was accepted, or null; the status says why not. */
static void put_geometry(asj_json_output *json, const asj_geometry *g)
{
    const int accepted = g->status == ASJ_GEOMETRY_ACCEPTED, has_cameras = g->cameras[0].fx > 0;
    json_t *value = json_null();
    if (g->status == ASJ_GEOMETRY_NOT_ASKED)
        return;
    if (accepted)
        value = json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:f, s:f, s:o, s:b}",
                          "model", asj_geometry_model_name(g->model), "matrix", numbers(g->matrix, 9),
                          "rotation", g->has_pose ? numbers(g->rotation, 9) : json_null(),
                          "translation", g->has_pose ? numbers(g->translation, 3) : json_null(),
                          "covariance", g->has_pose ? numbers(g->covariance, 36) : json_null(),
                          "turn", g->only_turns ? turn_value(g) : json_null(),
                          "cameras", has_cameras ? cameras_value(g->cameras) : json_null(), "focal",
                          has_cameras ? json_pack("[f, f]", g->cameras[0].fx, g->cameras[1].fx) : json_null(), "focal_sd",
                          g->focal_sd > 0 ? json_real(g->focal_sd) : json_null(), "log10_nfa", g->log10_nfa,
                          "inliers", g->inliers, "picture_agreement",
                          g->picture_agreement > 0 ? json_real(g->picture_agreement) : json_null(), "ambiguous", 0);
    asj_json_put(json, ",\n\"geometry\": ", value, JSON_REAL_PRECISION(15));
    asj_json_put(json, ",\n\"geometry_status\": ", json_string(asj_geometry_status_name(g->status)), 0);
    if (g->status == ASJ_GEOMETRY_AMBIGUOUS && g->has_rival)
        put_rivals(json, g);
}

static const char *end_name(int32_t end)
{
    return end == ASJ_END_CORNER ? "corner" : end == ASJ_END_BOTH ? "both" : end == ASJ_END_INNER ? "inner" : "cut";
}

/* Two halves, joined: a json_pack() with everything could not be read. */
static json_t *match_value(const asj_junction_match *m, int geometry)
{
    const double *h = m->affine;
    json_t *value = json_pack("{s:I, s:I, s:I, s:I, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f}",
                              "i", (json_int_t)m->l1, "j", (json_int_t)m->l2, "junction1", (json_int_t)m->junction1, "junction2",
                              (json_int_t)m->junction2, "x1", (double)m->x1, "y1", (double)m->y1, "ax1", (double)m->ax1,
                              "ay1", (double)m->ay1, "bx1", (double)m->bx1, "by1", (double)m->by1, "x2", (double)m->x2,
                              "y2", (double)m->y2, "ax2", (double)m->ax2, "ay2", (double)m->ay2, "bx2", (double)m->bx2,
                              "by2", (double)m->by2);
    json_t *rest = json_pack("{s:s, s:s, s:f, s:o, s:f, s:f, s:[f, f, f, f, f, f]}", "end_a", end_name(m->end_a), "end_b",
                             end_name(m->end_b), "distance", (double)m->distance, "ratio",
                             isfinite(m->ratio) ? json_real((double)m->ratio) : json_null(), "similarity", (double)m->similarity,
                             "support", (double)m->support, "affine", h[0], h[1], h[2], h[3], h[4], h[5]);
    if (!rest || json_object_update(value, rest)) {
        json_decref(value);
        value = NULL;
    }
    json_decref(rest);
    return value && geometry ? asj_json_set(value, "probability", json_real((double)m->probability)) : value;
}

static json_t *segment_value(const asj_segment_match *s)
{
    return json_pack("{s:I, s:s, s:s, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:f, s:i, s:i}", "match", (json_int_t)s->match, "start",
                     end_name(s->start), "end", end_name(s->end), "x1", (double)s->x1, "y1", (double)s->y1, "ex1",
                     (double)s->ex1, "ey1", (double)s->ey1, "x2", (double)s->x2, "y2", (double)s->y2, "ex2", (double)s->ex2,
                     "ey2", (double)s->ey2, "branch1", s->branch1, "branch2", s->branch2);
}

static void put_corners(asj_json_output *json, const char *name, const asj_l_junction *list, uint32_t count)
{
    uint32_t i;
    asj_output_text(json->output, name);
    for (i = 0; i < count && !json->out_of_memory; i++)
        asj_json_put(json, i ? ",\n" : "\n", asj_json_l_junction(&list[i]), ASJ_JSON_FLOATS);
}

asj_status asj_write_match_json(asj_output *output, const asj_match_report *report, const asj_match_lines *segments,
                                const asj_message *message)
{
    const asj_match_result *result = report->result;
    const int geometry = result->geometry.status == ASJ_GEOMETRY_ACCEPTED;
    asj_json_output json = {output, 0, 0};
    asj_c_locale locale;
    asj_status status = asj_c_locale_begin(&locale, message);
    size_t i;

    if (status != ASJ_OK)
        return status;
    put_head(&json, report, segments);
    put_geometry(&json, &result->geometry);
    asj_output_text(output, ",\n\"matches\": [");
    for (i = 0; i < result->match_count && !json.out_of_memory; i++)
        asj_json_put(&json, i ? ",\n" : "\n", match_value(&result->matches[i], geometry), ASJ_JSON_FLOATS);
    if (geometry || result->rejected_count > 0) /* two that are at odds reject, too */
        asj_output_text(output, "],\n\"rejected\": [");
    for (i = 0; i < result->rejected_count && !json.out_of_memory; i++)
        asj_json_put(&json, i ? ",\n" : "\n", match_value(&result->rejected[i], 0), ASJ_JSON_FLOATS);
    if (report->lines)
        asj_output_text(output, "],\n\"lines\": [");
    for (i = 0; i < segments->count && !json.out_of_memory; i++)
        asj_json_put(&json, i ? ",\n" : "\n", segment_value(&segments->list[i]), ASJ_JSON_FLOATS);
    put_corners(&json, "],\n\"l_junctions1\": [", result->l_junctions1, result->l_junction_count1);
    put_corners(&json, "],\n\"l_junctions2\": [", result->l_junctions2, result->l_junction_count2);
    asj_output_text(output, "]\n}\n");
    asj_c_locale_end(&locale);
    return json.out_of_memory ? asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for JSON") : ASJ_OK;
}
