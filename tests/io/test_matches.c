/* SPDX-License-Identifier: BSD-2-Clause */
/* Match files: what is written reads back, in every locale, and what cannot be read is not written. */
#include "io_test.h"

#include <asj/version.h>

#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define HEADER "i,j,x1,y1,ax1,ay1,bx1,by1,x2,y2,ax2,ay2,bx2,by2,distance,ratio,h11,h12,h13,h21,h22,h23\n"
enum { COUNT = 40, CORNERS = 50, COLUMNS = 22, MOST_ROWS = 2 * COUNT };

static char message[512];
static asj_junction_match matches[COUNT];
static asj_l_junction corners[2][CORNERS];
static asj_match_result result;
static asj_match_options options;
static asj_detect_options detect_options;
static asj_match_report report;

static uint32_t random_state;
static float random_float(float low, float high)
{
    random_state = random_state * 1664525u + 1013904223u;
    return low + (high - low) * ((float)(random_state >> 8) / 16777216.0f);
}

static void fill_match(asj_junction_match *m, uint32_t k)
{
    float *const places[] = {&m->x1, &m->y1, &m->ax1, &m->ay1, &m->bx1, &m->by1, &m->x2, &m->y2, &m->ax2, &m->ay2, &m->bx2,
                             &m->by2};
    size_t i;
    m->l1 = k;
    m->l2 = CORNERS - 1 - k;
    m->junction1 = 100 + k;
    m->junction2 = 200 + k;
    for (i = 0; i < 12; i++)
        *places[i] = random_float(-5, 999);
    for (i = 0; i < 6; i++)
        m->affine[i] = (double)random_float(-2, 2) * 1.0000000123;
    m->end_a = (int32_t)(k % 3);
    m->end_b = (int32_t)(k / 3 % 3);
    m->distance = random_float(0, 1);
    m->ratio = random_float(1.5f, 30);
    m->similarity = random_float(-1, 1);
    m->support = random_float(0, 10);
}

static int fill(void **state)
{
    uint32_t k;
    (void)state;
    random_state = 1;
    memset(matches, 0, sizeof matches);
    memset(corners, 0, sizeof corners);
    memset(&result, 0, sizeof result);
    memset(&report, 0, sizeof report);
    for (k = 0; k < COUNT; k++)
        fill_match(&matches[k], k);
    matches[0].x1 = 0.1f;
    matches[0].y1 = 1e-30f;
    matches[1].ratio = HUGE_VALF;
    result.matches = matches;
    result.match_count = COUNT;
    result.l_junctions1 = corners[0];
    result.l_junctions2 = corners[1];
    result.l_junction_count1 = result.l_junction_count2 = CORNERS;
    result.backend = ASJ_BACKEND_CPU;
    result.total_ms = 12.3456;
    result.stage_ms[ASJ_STAGE_ALIGN] = 3.25;
    result.candidates = 5000000000u;
    asj_match_options_init(&options);
    asj_detect_options_init(&detect_options);
    report.result = &result;
    report.options = &options;
    report.detect_options = &detect_options;
    report.image_names[0] = "a \"quoted\" name\n\xc3\xa9";
    report.image_names[1] = "not UTF-8: \xff";
    report.junction_names[1] = "two.asj";
    report.widths[0] = report.widths[1] = 1000;
    report.heights[0] = report.heights[1] = 800;
    return 0;
}

static const char *write_report(const char *name, int32_t format)
{
    const char *path = in_folder(name);
    if (asj_matches_write(path, format, &report, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    assert_string_equal(message, "");
    return path;
}

/* --- CSV ------------------------------------------------------------------------------------------------------------------- */

static char rows[MOST_ROWS][COLUMNS][32];

static size_t read_rows(const char *path)
{
    static test_bytes bytes;
    const char *at, *end;
    size_t count = 0;
    read_bytes(path, &bytes);
    assert_true(bytes.size > sizeof HEADER - 2);
    assert_memory_equal(bytes.bytes, HEADER, sizeof HEADER - 1);
    at = (const char *)bytes.bytes + sizeof HEADER - 1;
    end = (const char *)bytes.bytes + bytes.size;
    for (; at < end; count++) {
        int c;
        assert_true(count < MOST_ROWS);
        for (c = 0; c < COLUMNS; c++) {
            size_t length = 0;
            while (at + length < end && at[length] != ',' && at[length] != '\n')
                length++;
            assert_true(at + length < end && at[length] == (c + 1 < COLUMNS ? ',' : '\n') && length < sizeof rows[0][0]);
            memcpy(rows[count][c], at, length);
            rows[count][c][length] = '\0';
            at += length + 1;
        }
    }
    return count;
}

/* A reader of numbers that knows no locale. */
static double number_of(const char *text)
{
    json_t *value = load_json_text(text);
    double number;
    if (!json_is_number(value))
        fail_msg("'%s' is no number", text);
    number = json_number_value(value);
    json_decref(value);
    return number;
}

static void expect_floats(char (*fields)[32], const float *wanted, size_t count)
{
    size_t i;
    for (i = 0; i < count; i++)
        assert_true((float)number_of(fields[i]) == wanted[i]);
}

static void expect_quality(char (*fields)[32], const asj_junction_match *m)
{
    int i;
    expect_floats(fields, &m->distance, 1);
    if (isinf(m->ratio))
        assert_string_equal(fields[1], "inf");
    else
        expect_floats(fields + 1, &m->ratio, 1);
    for (i = 0; i < 6; i++)
        assert_true(fabs(number_of(fields[2 + i]) - m->affine[i]) <= 5e-9 * fabs(m->affine[i]));
}

static void csv_gives_every_float_back(void **state)
{
    size_t k;
    (void)state;
    assert_int_equal(read_rows(write_report("all.csv", ASJ_FILE_CSV)), COUNT);
    for (k = 0; k < COUNT; k++) {
        const asj_junction_match *m = &matches[k];
        const float places[] = {m->x1, m->y1, m->ax1, m->ay1, m->bx1, m->by1, m->x2, m->y2, m->ax2, m->ay2, m->bx2, m->by2};
        assert_true(number_of(rows[k][0]) == m->l1 && number_of(rows[k][1]) == m->l2);
        expect_floats(rows[k] + 2, places, 12);
        expect_quality(rows[k] + 14, m);
    }
}

static void csv_of_lines_has_no_locations(void **state)
{
    static asj_segment_match segments[2 * COUNT];
    int32_t end;
    (void)state;
    report.lines = ASJ_LINES_BRANCHES;
    for (end = ASJ_END_CUT; end <= ASJ_END_BOTH; end++) {
        size_t count = asj_match_segments(&result, end, segments, 2 * COUNT), k;
        report.minimum_end = end;
        assert_true(count > 0 && count < 2 * COUNT + (end == ASJ_END_CUT));
        assert_int_equal(read_rows(write_report("lines.csv", ASJ_FILE_CSV)), count);
        for (k = 0; k < count; k++) {
            const asj_segment_match *s = &segments[k];
            const float first[] = {s->x1, s->y1, s->ex1, s->ey1}, second[] = {s->x2, s->y2, s->ex2, s->ey2};
            const int empty[] = {2, 3, 8, 9};
            size_t i;
            for (i = 0; i < 4; i++)
                assert_string_equal(rows[k][empty[i]], "");
            assert_true(number_of(rows[k][0]) == matches[s->match].l1 && number_of(rows[k][1]) == matches[s->match].l2);
            expect_floats(rows[k] + 4, first, 4);
            expect_floats(rows[k] + 10, second, 4);
            expect_quality(rows[k] + 14, &matches[s->match]);
        }
    }
}

static void no_match_is_a_header(void **state)
{
    (void)state;
    memset(&result, 0, sizeof result);
    assert_int_equal(read_rows(write_report("none.csv", ASJ_FILE_CSV)), 0);
    report.lines = ASJ_LINES_BRANCHES;
    assert_int_equal(read_rows(write_report("none.csv", ASJ_FILE_CSV)), 0);
}

/* --- JSON ------------------------------------------------------------------------------------------------------------------ */

static json_t *read_json(const char *path)
{
    json_t *root = load_json_file(path, JSON_REJECT_DUPLICATES);
    if (!root)
        fail_msg("%s: no JSON", path);
    return root;
}

static json_t *need(json_t *object, const char *key)
{
    json_t *value = json_object_get(object, key);
    if (!value)
        fail_msg("no \"%s\"", key);
    return value;
}

static float float_at(json_t *object, const char *key)
{
    assert_true(json_is_number(need(object, key)));
    return (float)json_number_value(need(object, key));
}

static void expect_text(json_t *object, const char *key, const char *text)
{
    assert_true(json_is_string(need(object, key)));
    assert_string_equal(json_string_value(need(object, key)), text);
}

static void expect_match(json_t *value, const asj_junction_match *m)
{
    static const char *const ends[] = {"cut", "inner", "both"};
    const char *const keys[] = {"x1", "y1", "ax1", "ay1", "bx1", "by1", "x2", "y2", "ax2", "ay2", "bx2", "by2", "distance",
                                "similarity", "support"};
    const float wanted[] = {m->x1, m->y1, m->ax1, m->ay1, m->bx1, m->by1, m->x2, m->y2, m->ax2, m->ay2, m->bx2, m->by2, m->distance,
                            m->similarity, m->support};
    size_t i;
    for (i = 0; i < sizeof keys / sizeof keys[0]; i++)
        assert_true(float_at(value, keys[i]) == wanted[i]);
    assert_int_equal(json_integer_value(need(value, "i")), m->l1);
    assert_int_equal(json_integer_value(need(value, "j")), m->l2);
    assert_int_equal(json_integer_value(need(value, "junction1")), m->junction1);
    assert_int_equal(json_integer_value(need(value, "junction2")), m->junction2);
    expect_text(value, "end_a", ends[m->end_a]);
    expect_text(value, "end_b", ends[m->end_b]);
    if (isinf(m->ratio))
        assert_true(json_is_null(need(value, "ratio")));
    else
        assert_true(float_at(value, "ratio") == m->ratio);
    assert_int_equal(json_array_size(need(value, "affine")), 6);
    for (i = 0; i < 6; i++)
        assert_true(fabs(json_number_value(json_array_get(need(value, "affine"), i)) - m->affine[i]) <= 5e-9 * fabs(m->affine[i]));
}

static void json_holds_every_match(void **state)
{
    json_t *root = read_json(write_report("all.json", ASJ_FILE_JSON));
    size_t k;
    (void)state;
    assert_int_equal(json_array_size(need(root, "matches")), COUNT);
    for (k = 0; k < COUNT; k++)
        expect_match(json_array_get(need(root, "matches"), k), &matches[k]);
    assert_null(json_object_get(root, "lines"));
    assert_int_equal(json_array_size(need(root, "l_junctions1")), CORNERS);
    assert_int_equal(json_array_size(need(root, "l_junctions2")), CORNERS);
    json_decref(root);
}

static void json_says_how_it_came_about(void **state)
{
    json_t *root = read_json(write_report("head.json", ASJ_FILE_JSON)), *first, *second;
    size_t i;
    (void)state;
    expect_text(root, "schema", "asj-matches-1");
    expect_text(need(root, "library"), "version", asj_version_string());
    expect_text(root, "backend", "cpu");
    first = json_array_get(need(root, "images"), 0);
    second = json_array_get(need(root, "images"), 1);
    expect_text(first, "name", "a \"quoted\" name\n\xc3\xa9");
    expect_text(second, "name", "not UTF-8: ?");
    expect_text(second, "junctions", "two.asj");
    assert_null(json_object_get(first, "junctions"));
    assert_int_equal(json_integer_value(need(first, "width")), 1000);
    for (i = 0; i < asj_match_option_count(); i++)
        need(need(root, "options"), asj_match_option(i)->key);
    for (i = 0; i < asj_detect_option_count(); i++)
        need(need(root, "detect_options"), asj_detect_option(i)->key);
    assert_int_equal(json_object_size(need(root, "options")), asj_match_option_count());
    assert_true(json_number_value(need(need(root, "options"), "ratio")) == options.ratio);
    assert_true(json_number_value(need(need(root, "timing"), "total_ms")) == 12.346);
    assert_int_equal(json_object_size(need(need(root, "timing"), "stages")), 4);
    assert_true(json_number_value(need(need(need(root, "timing"), "stages"), asj_stage_name(ASJ_STAGE_ALIGN))) == 3.25);
    assert_int_equal(json_integer_value(need(need(root, "counts"), "matches")), COUNT);
    assert_int_equal(json_integer_value(need(need(root, "counts"), "candidates")), 5000000000);
    json_decref(root);
}

static void json_has_the_lines_beside_the_matches(void **state)
{
    static asj_segment_match segments[2 * COUNT];
    json_t *root, *lines;
    size_t count = asj_match_segments(&result, ASJ_END_INNER, segments, 2 * COUNT);
    (void)state;
    report.lines = ASJ_LINES_BRANCHES;
    report.minimum_end = ASJ_END_INNER;
    root = read_json(write_report("lines.json", ASJ_FILE_JSON));
    lines = need(root, "lines");
    assert_true(count > 0);
    assert_int_equal(json_array_size(lines), count);
    assert_int_equal(json_array_size(need(root, "matches")), COUNT);
    assert_int_equal(json_integer_value(need(need(root, "counts"), "lines")), count);
    assert_true(float_at(json_array_get(lines, 0), "x1") ==
                matches[json_integer_value(need(json_array_get(lines, 0), "match"))].x1);
    assert_int_equal(json_integer_value(need(json_array_get(lines, count - 1), "branch1")), segments[count - 1].branch1);
    assert_int_equal(json_integer_value(need(json_array_get(lines, count - 1), "branch2")), segments[count - 1].branch2);
    assert_string_equal(json_string_value(need(json_array_get(lines, 0), "start")), "corner");
    json_decref(root);
    /* joined */
    report.lines = ASJ_LINES_JOINED;
    matches[0] = (asj_junction_match){.x1 = 10, .y1 = 10, .ax1 = 90, .ay1 = 10, .bx1 = 50, .by1 = 10, .x2 = 20, .y2 = 20,
                                      .ax2 = 180, .ay2 = 20, .bx2 = 100, .by2 = 20, .end_a = ASJ_END_BOTH, .end_b = ASJ_END_BOTH};
    count = asj_match_segments(&result, ASJ_END_INNER, segments, 2 * COUNT);
    const size_t all = count;
    count = asj_join_segment_matches(segments, count);
    assert_true(count < all);
    root = read_json(write_report("joined.json", ASJ_FILE_JSON));
    lines = need(root, "lines");
    assert_int_equal(json_array_size(lines), count);
    assert_true(float_at(json_array_get(lines, count - 1), "ex2") == segments[count - 1].ex2);
    json_decref(root);
}

/* Two geometries at odds are none, and what either contradicts is rejected. */
static void json_has_what_is_rejected_without_a_geometry(void **state)
{
    json_t *root;
    size_t k;
    (void)state;
    result.geometry.status = ASJ_GEOMETRY_AMBIGUOUS;
    root = read_json(write_report("ambiguous.json", ASJ_FILE_JSON));
    assert_null(json_object_get(root, "rejected"));
    json_decref(root);
    result.rejected = &matches[COUNT - 3];
    result.rejected_count = 3;
    result.match_count = COUNT - 3;
    root = read_json(write_report("rejected.json", ASJ_FILE_JSON));
    assert_true(json_is_null(need(root, "geometry")));
    expect_text(root, "geometry_status", "ambiguous");
    assert_int_equal(json_array_size(need(root, "rejected")), 3);
    assert_null(json_object_get(root, "geometry_rivals"));
    for (k = 0; k < COUNT; k++)
        expect_match(k < COUNT - 3 ? json_array_get(need(root, "matches"), k) :
                                     json_array_get(need(root, "rejected"), k - (COUNT - 3)), &matches[k]);
    assert_null(json_object_get(json_array_get(need(root, "matches"), 0), "probability"));
    json_decref(root);
}

/* The cameras that the motion was estimated with; of a geometry without a motion there are none. */
static void json_has_the_cameras_of_a_motion(void **state)
{
    const double wanted[2][4] = {{700.5, 701.25, 319.5, 239.5}, {650, 660, 300.125, 250}};
    asj_geometry *g = &result.geometry;
    (void)state;
    memset(g, 0, sizeof *g);
    g->status = ASJ_GEOMETRY_ACCEPTED;
    g->model = ASJ_GEOMETRY_ESSENTIAL;
    g->has_pose = 1;
    for (size_t v = 0; v < 2; v++)
        g->cameras[v] = (asj_camera){wanted[v][0], wanted[v][1], wanted[v][2], wanted[v][3]};
    json_t *root = read_json(write_report("cameras.json", ASJ_FILE_JSON));
    json_t *cameras = need(need(root, "geometry"), "cameras"), *focal = need(need(root, "geometry"), "focal");
    assert_int_equal(json_array_size(cameras), 2);
    for (size_t v = 0; v < 2; v++) {
        assert_int_equal(json_array_size(json_array_get(cameras, v)), 4);
        for (size_t k = 0; k < 4; k++)
            assert_true(json_number_value(json_array_get(json_array_get(cameras, v), k)) == wanted[v][k]);
        assert_true(json_number_value(json_array_get(focal, v)) == wanted[v][0]);
    }
    json_decref(root);
    memset(g->cameras, 0, sizeof g->cameras);
    root = read_json(write_report("no_cameras.json", ASJ_FILE_JSON));
    assert_true(json_is_null(need(need(root, "geometry"), "cameras")));
    assert_true(json_is_null(need(need(root, "geometry"), "focal")));
    json_decref(root);
    memset(g, 0, sizeof *g);
}

/* The same numbers without a camera that only turns say nothing. */
static void json_has_the_rotation_of_a_turn(void **state)
{
    const double turn[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1}, covariance[9] = {4, 1, 0, 1, 9, 2, 0, 2, 16};
    asj_geometry *g = &result.geometry;
    (void)state;
    memset(g, 0, sizeof *g);
    g->status = ASJ_GEOMETRY_ACCEPTED;
    g->model = ASJ_GEOMETRY_HOMOGRAPHY;
    memcpy(g->rotation, turn, sizeof turn);
    for (size_t k = 0; k < 9; k++)
        g->covariance[6 * (k / 3) + k % 3] = covariance[k];
    for (int32_t only_turns = 0; only_turns < 2; only_turns++) {
        g->only_turns = only_turns;
        g->picture_agreement = 0.75 * only_turns;
        json_t *root = read_json(write_report("turn.json", ASJ_FILE_JSON)), *value = need(root, "geometry");
        json_t *told = need(value, "turn");
        assert_true(json_is_null(need(value, "rotation")) && json_is_null(need(value, "translation")));
        assert_true(json_is_null(need(value, "covariance")) && json_is_object(told) == only_turns);
        assert_true(only_turns ? json_real_value(need(value, "picture_agreement")) == 0.75
                               : json_is_null(need(value, "picture_agreement")));
        for (size_t k = 0; k < 9 && only_turns; k++) {
            assert_true(json_number_value(json_array_get(need(told, "rotation"), k)) == turn[k]);
            assert_true(json_number_value(json_array_get(need(told, "covariance"), k)) == covariance[k]);
        }
        json_decref(root);
    }
    memset(g, 0, sizeof *g);
}

/* The two motions that stay, and one of which nothing is known. */
static void json_has_both_rivals(void **state)
{
    const double turn[9] = {0, -1, 0, 1, 0, 0, 0, 0, 1};
    asj_geometry *g = &result.geometry;
    size_t k;
    (void)state;
    memset(g, 0, sizeof *g);
    g->status = ASJ_GEOMETRY_AMBIGUOUS;
    g->has_rival = 1;
    g->log10_nfa = -33.5;
    g->rival_log10_nfa = -30.25;
    memcpy(g->rival_rotation, turn, sizeof turn);
    g->rival_translation[1] = 1;
    json_t *root = read_json(write_report("rivals.json", ASJ_FILE_JSON));
    json_t *rivals = need(root, "geometry_rivals"), *rival = json_array_get(rivals, 1);
    assert_int_equal(json_array_size(rivals), 2);
    assert_true(json_is_null(need(json_array_get(rivals, 0), "rotation")));
    assert_true(json_is_null(need(json_array_get(rivals, 0), "translation")));
    assert_true(json_real_value(need(json_array_get(rivals, 0), "log10_nfa")) == -33.5);
    assert_true(json_real_value(need(rival, "log10_nfa")) == -30.25);
    for (k = 0; k < 9; k++)
        assert_true(json_number_value(json_array_get(need(rival, "rotation"), k)) == turn[k]);
    for (k = 0; k < 3; k++)
        assert_true(json_number_value(json_array_get(need(rival, "translation"), k)) == (k == 1));
    json_decref(root);
    memset(g, 0, sizeof *g);
}

static void json_can_do_with_the_result_alone(void **state)
{
    static const asj_match_report none = {0};
    static const asj_match_result empty = {0};
    json_t *root;
    (void)state;
    report = none;
    report.result = &empty;
    root = read_json(write_report("alone.json", ASJ_FILE_JSON));
    assert_int_equal(json_array_size(need(root, "matches")), 0);
    assert_int_equal(json_array_size(need(root, "images")), 2);
    assert_null(json_object_get(root, "options"));
    assert_null(json_object_get(root, "detect_options"));
    json_decref(root);
}

/* --- refused --------------------------------------------------------------------------------------------------------------- */

static void expect_refusal(const char *path, int32_t format, asj_status status, const char *cause)
{
    int files = count_files();
    assert_int_equal(asj_matches_write(path, format, &report, message, sizeof message), status);
    if (!strstr(message, cause))
        fail_msg("'%s' is missing in '%s'", cause, message);
    assert_int_equal(asj_matches_write(path, format, &report, NULL, 0), status);
    assert_int_equal(count_files(), files);
}

static void wrong_arguments_are_refused(void **state)
{
    (void)state;
    expect_refusal(NULL, ASJ_FILE_CSV, ASJ_ERROR_ARGUMENT, "no path");
    expect_refusal(in_folder("never"), ASJ_FILE_ASJ, ASJ_ERROR_ARGUMENT, "no file format");
    expect_refusal(in_folder("never"), 4, ASJ_ERROR_ARGUMENT, "no file format");
    expect_refusal(in_folder("nowhere/never.csv"), ASJ_FILE_CSV, ASJ_ERROR_FILE, "nowhere/never.csv");
    assert_int_equal(asj_matches_write(in_folder("never"), ASJ_FILE_CSV, NULL, message, sizeof message), ASJ_ERROR_ARGUMENT);
    for (int32_t lines = -1; lines < 4; lines += 4) {
        const int32_t asked = report.lines;
        report.lines = lines;
        expect_refusal(in_folder("never"), ASJ_FILE_CSV, ASJ_ERROR_ARGUMENT, "there is no such");
        report.lines = asked;
    }
    report.lines = ASJ_LINES_BRANCHES;
    for (int32_t end = -1; end < 9; end += 5) {
        report.minimum_end = end;
        expect_refusal(in_folder("never"), ASJ_FILE_CSV, ASJ_ERROR_ARGUMENT, "minimum_end");
    }
    report.lines = ASJ_LINES_NONE;
    report.minimum_end = 0;
    report.reserved[1] = 1;
    expect_refusal(in_folder("never"), ASJ_FILE_CSV, ASJ_ERROR_OPTION, "reserved");
    report.reserved[1] = 0;
    report.result = NULL;
    expect_refusal(in_folder("never"), ASJ_FILE_CSV, ASJ_ERROR_ARGUMENT, "no matches");
}

static void results_that_cannot_be_read_are_refused(void **state)
{
    const asj_junction_match good = matches[7];
    int which;
    (void)state;
    for (which = 0; which < 8; which++) {
        matches[7] = good;
        switch (which) {
        case 0: matches[7].x1 = NAN; break;
        case 1: matches[7].by2 = INFINITY; break;
        case 2: matches[7].affine[5] = -INFINITY; break;
        case 3: matches[7].ratio = NAN; break;
        case 4: matches[7].similarity = NAN; break;
        case 5: matches[7].l1 = CORNERS; break;
        case 6: matches[7].probability = NAN; break;
        default: matches[7].l2 = CORNERS; break;
        }
        expect_refusal(in_folder("never"), ASJ_FILE_CSV, ASJ_ERROR_ARGUMENT, "match 7");
        expect_refusal(in_folder("never"), ASJ_FILE_JSON, ASJ_ERROR_ARGUMENT, "match 7");
    }
    matches[7] = good;
    result.geometry.status = ASJ_GEOMETRY_ACCEPTED;
    for (which = 0; which < 9; which++) {
        result.geometry.matrix[which] = NAN;
        expect_refusal(in_folder("never"), ASJ_FILE_JSON, ASJ_ERROR_ARGUMENT, "geometry");
        result.geometry.matrix[which] = 0;
    }
    result.geometry.cameras[1].cy = NAN;
    expect_refusal(in_folder("never"), ASJ_FILE_JSON, ASJ_ERROR_ARGUMENT, "geometry");
    result.geometry.cameras[1].cy = 0;
    result.geometry.picture_agreement = NAN;
    expect_refusal(in_folder("never"), ASJ_FILE_JSON, ASJ_ERROR_ARGUMENT, "geometry");
    result.geometry.picture_agreement = 0;
    result.geometry.status = ASJ_GEOMETRY_AMBIGUOUS; /* of which JSON has both motions */
    result.geometry.has_rival = 1;
    {
        double *const written[] = {&result.geometry.log10_nfa, &result.geometry.rival_log10_nfa, &result.geometry.rotation[4],
                                   &result.geometry.translation[2], &result.geometry.rival_rotation[8],
                                   &result.geometry.rival_translation[0]};
        for (which = 0; which < 6; which++) {
            const double before = *written[which];
            *written[which] = which % 2 ? NAN : INFINITY;
            expect_refusal(in_folder("never"), ASJ_FILE_JSON, ASJ_ERROR_ARGUMENT, "geometry");
            *written[which] = before;
        }
    }
    result.geometry.has_rival = 0;
    result.geometry.status = ASJ_GEOMETRY_NOT_ASKED;
    for (which = 0; which < 3; which++) {
        asj_match_options unreadable;
        asj_detect_options also;
        asj_match_report before = report;
        asj_match_options_init(&unreadable);
        asj_detect_options_init(&also);
        unreadable.ratio = which == 0 ? NAN : 1;
        also.epsilon = which == 1 ? INFINITY : 1;
        report.options = &unreadable;
        report.detect_options = &also;
        report.stretch[1] = which == 2 ? NAN : 1;
        expect_refusal(in_folder("never"), ASJ_FILE_JSON, ASJ_ERROR_ARGUMENT, which == 2 ? "stretch" : "options");
        report = before;
    }
    corners[1][3].bx = NAN;
    expect_refusal(in_folder("never"), ASJ_FILE_JSON, ASJ_ERROR_ARGUMENT, "L-junction 3 of image 2");
    result.matches = NULL;
    expect_refusal(in_folder("never"), ASJ_FILE_JSON, ASJ_ERROR_ARGUMENT, "no array");
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(csv_gives_every_float_back, fill),
        cmocka_unit_test_setup(csv_of_lines_has_no_locations, fill),
        cmocka_unit_test_setup(no_match_is_a_header, fill),
        cmocka_unit_test_setup(json_holds_every_match, fill),
        cmocka_unit_test_setup(json_says_how_it_came_about, fill),
        cmocka_unit_test_setup(json_has_the_lines_beside_the_matches, fill),
        cmocka_unit_test_setup(json_has_what_is_rejected_without_a_geometry, fill),
        cmocka_unit_test_setup(json_has_the_cameras_of_a_motion, fill),
        cmocka_unit_test_setup(json_has_the_rotation_of_a_turn, fill),
        cmocka_unit_test_setup(json_has_both_rivals, fill),
        cmocka_unit_test_setup(json_can_do_with_the_result_alone, fill),
        cmocka_unit_test_setup(wrong_arguments_are_refused, fill),
        cmocka_unit_test_setup(results_that_cannot_be_read_are_refused, fill),
    };
    if (argc > 1 && !set_separator_locale(argv[1])) {
        puts("SKIPPED: no such locale is installed, and localedef cannot make one");
        return 77;
    }
    return cmocka_run_group_tests_name("io: matches", tests, make_folder, remove_folder);
}
