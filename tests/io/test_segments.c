/* SPDX-License-Identifier: BSD-2-Clause */
/* Straight edges in files: CSV in place of the branches, JSON beside them; every float comes back; what is unsound is refused. */
#include "io_test.h"

#include <asj/context.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

#define CORNERS 4

static char message[512];
static asj_junction junctions[CORNERS];
static asj_edge edge = {.junction_a = 0, .junction_b = 1, .branch_b = 1};
static asj_detection detection;
static asj_detection_report report;
static asj_segment_list *list;

/* Four corners of a frame in perspective, whose upper edge alone is known from both ends. */
static void make_list(void)
{
    static const float places[CORNERS][2] = {{10.1f, 20.3f}, {211.7f, 21.9f}, {190.2f, 149.6f}, {31.4f, 151.3f}};
    asj_context *context;
    for (uint32_t k = 0; k < CORNERS; k++) {
        asj_junction *j = &junctions[k];
        j->x = places[k][0];
        j->y = places[k][1];
        j->location_sd = 0.1f + (float)k;
        j->branch_count = 2;
        for (int32_t b = 0; b < 2; b++) {
            const float *to = places[(k + (b == 0 ? 1 : CORNERS - 1)) % CORNERS];
            const float dx = to[0] - j->x, dy = to[1] - j->y, share = k < 2 && b == (int32_t)k ? 1 : 0.4f;
            j->branches[b].angle = (float)fmod(atan2((double)dy, (double)dx) + 6.283185307179586, 6.283185307179586);
            j->branches[b].length = share * hypotf(dx, dy);
            j->branches[b].log10_nfa = -3.7f * (float)(k + 1);
            j->branches[b].length_sd = 0.7f;
            j->branches[b].end = share == 1 ? ASJ_BRANCH_END_JUNCTION : (int32_t)k + 1;
        }
    }
    detection = (asj_detection){.junctions = junctions, .junction_count = CORNERS, .edges = &edge, .edge_count = 1, .width = 240,
                                .height = 180};
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    assert_int_equal(asj_find_segments(context, junctions, CORNERS, &edge, 1, &list), ASJ_OK);
    asj_context_free(&context); /* a list outlives it */
    assert_int_equal(list->count, 7);
    report = (asj_detection_report){.detection = &detection, .segments = list};
}

static const char *write_report(const char *name, int32_t format)
{
    const char *path = in_folder(name);
    if (asj_junctions_write(path, format, &report, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    return path;
}

static const char *word(int32_t end)
{
    static const char *const words[] = {"", "junction", "crossing", "faded", "occlusion", "border"};
    return words[end];
}

/* The next field of a line of CSV, which ends it. */
static char *next(char **at)
{
    char *field = *at, *end = field + strcspn(field, ",\n");
    *at = end + (*end != '\0');
    *end = '\0';
    return field;
}

static float next_float(char **at)
{
    json_t *value = load_json_text(next(at)); /* a reader of numbers that knows no locale */
    assert_true(json_is_number(value));
    const float number = (float)json_number_value(value);
    json_decref(value);
    return number;
}

static void expect_junction(char **at, uint32_t junction)
{
    if (junction == ASJ_NO_JUNCTION)
        assert_string_equal(next(at), "");
    else
        assert_true(next_float(at) == (float)junction);
}

static void csv_has_one_line_for_each(void **state)
{
    static const char head[] = "x1,y1,x2,y2,sd1,sd2,end1,end2,junction1,junction2,log10_nfa,junction,branch,branches\n";
    test_bytes file;
    char *at = (char *)file.bytes;
    (void)state;
    read_bytes(write_report("lines.csv", ASJ_FILE_CSV), &file);
    file.bytes[file.size] = '\0';
    assert_memory_equal(at, head, sizeof head - 1);
    at += sizeof head - 1;
    for (uint32_t k = 0; k < list->count; k++) {
        const asj_segment *s = &list->segments[k];
        const float wanted[] = {s->x1, s->y1, s->x2, s->y2, s->sd1, s->sd2};
        for (size_t i = 0; i < sizeof wanted / sizeof wanted[0]; i++)
            assert_true(next_float(&at) == wanted[i]);
        assert_string_equal(next(&at), word(s->end1));
        assert_string_equal(next(&at), word(s->end2));
        expect_junction(&at, s->junction1);
        expect_junction(&at, s->junction2);
        assert_true(next_float(&at) == s->log10_nfa);
        expect_junction(&at, s->junction);
        assert_true(next_float(&at) == (float)s->branch);
        assert_true(next_float(&at) == (float)s->branch_count);
    }
    assert_string_equal(at, "");
}

static double number(const json_t *object, const char *key)
{
    return json_number_value(json_object_get(object, key));
}

static const char *text(const json_t *object, const char *key)
{
    return json_string_value(json_object_get(object, key));
}

static void json_has_them_beside_the_branches(void **state)
{
    json_t *root = load_json_file(write_report("lines.json", ASJ_FILE_JSON), JSON_REJECT_DUPLICATES);
    const json_t *lines = json_object_get(root, "lines");
    asj_junction_file *file = NULL;
    (void)state;
    assert_int_equal(json_array_size(lines), list->count);
    assert_int_equal(json_integer_value(json_object_get(json_object_get(root, "counts"), "lines")), list->count);
    assert_int_equal(json_array_size(json_object_get(root, "junctions")), CORNERS);
    for (uint32_t k = 0; k < list->count; k++) {
        const asj_segment *s = &list->segments[k];
        const json_t *line = json_array_get(lines, k);
        assert_true((float)number(line, "x1") == s->x1 && (float)number(line, "y1") == s->y1);
        assert_true((float)number(line, "x2") == s->x2 && (float)number(line, "y2") == s->y2);
        assert_true((float)number(line, "sd1") == s->sd1 && (float)number(line, "sd2") == s->sd2);
        assert_true((float)number(line, "log10_nfa") == s->log10_nfa);
        assert_string_equal(text(line, "end1"), word(s->end1));
        assert_string_equal(text(line, "end2"), word(s->end2));
        assert_int_equal(json_integer_value(json_object_get(line, "junction1")), s->junction1);
        assert_int_equal(json_is_null(json_object_get(line, "junction2")), s->junction2 == ASJ_NO_JUNCTION);
        assert_int_equal(json_integer_value(json_object_get(line, "junction")), s->junction);
        assert_int_equal(json_integer_value(json_object_get(line, "branch")), s->branch);
        assert_int_equal(json_integer_value(json_object_get(line, "branches")), s->branch_count);
    }
    json_decref(root);
    assert_int_equal(asj_junctions_read(in_folder("lines.json"), &file, message, sizeof message), ASJ_OK); /* passes over them */
    assert_int_equal(file->junction_count, CORNERS);
    asj_junction_file_free(&file);
}

static void a_line_of_many_has_them_too(void **state)
{
    json_t *file = load_json_file(write_report("one.json", ASJ_FILE_JSON), 0), *line;
    const char *path = in_folder("all.jsonl");
    asj_output *output;
    (void)state;
    assert_int_equal(asj_output_begin(path, &output, message, sizeof message), ASJ_OK);
    assert_int_equal(asj_junctions_write_line(output, &report, message, sizeof message), ASJ_OK);
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    line = load_json_file(path, JSON_REJECT_DUPLICATES);
    assert_int_equal(json_array_size(json_object_get(line, "lines")), list->count);
    json_object_del(file, "timing");
    assert_true(json_equal(line, file));
    json_decref(line);
    json_decref(file);
}

static void text_has_none(void **state)
{
    test_bytes with, without;
    (void)state;
    read_bytes(write_report("with.asj", ASJ_FILE_ASJ_WHOLE), &with);
    report.segments = NULL;
    read_bytes(write_report("without.asj", ASJ_FILE_ASJ_WHOLE), &without);
    report.segments = list;
    assert_int_equal(with.size, without.size);
    assert_memory_equal(with.bytes, without.bytes, with.size);
}

static void no_edge_is_an_empty_list(void **state)
{
    static const asj_segment_list none = {0};
    test_bytes csv;
    (void)state;
    report.segments = &none;
    json_t *root = load_json_file(write_report("none.json", ASJ_FILE_JSON), 0);
    read_bytes(write_report("none.csv", ASJ_FILE_CSV), &csv);
    report.segments = list;
    assert_true(json_is_array(json_object_get(root, "lines")));
    assert_int_equal(json_array_size(json_object_get(root, "lines")), 0);
    json_decref(root);
    assert_ptr_equal(memchr(csv.bytes, '\n', csv.size), csv.bytes + csv.size - 1);
}

static void unsound_ones_are_not_written(void **state)
{
    asj_segment bad;
    asj_segment_list of_bad = {.segments = &bad, .count = 1, .junction_count = CORNERS};
    const char *path = in_folder("never");
    (void)state;
    report.segments = &of_bad;
    for (int k = 0; k < 8; k++) {
        bad = list->segments[0];
        bad.junction = k == 0 ? CORNERS : 0;
        bad.branch = k == 1 ? 2 : 0;
        bad.junction1 = k == 2 ? CORNERS : ASJ_NO_JUNCTION;
        bad.junction2 = k == 3 ? CORNERS : ASJ_NO_JUNCTION;
        bad.x2 = k == 4 ? NAN : 0;
        bad.sd1 = k == 5 ? INFINITY : 0;
        bad.sd2 = k == 7 ? NAN : 0;
        bad.log10_nfa = k == 6 ? -INFINITY : 0;
        assert_int_equal(asj_junctions_write(path, k % 2 ? ASJ_FILE_CSV : ASJ_FILE_JSON, &report, message, sizeof message),
                         ASJ_ERROR_ARGUMENT);
        assert_non_null(strstr(message, "segment 0"));
    }
    of_bad.segments = NULL;
    assert_int_equal(asj_junctions_write(path, ASJ_FILE_CSV, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
    report.segments = list;
    assert_null(fopen(path, "rb"));
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(csv_has_one_line_for_each),
        cmocka_unit_test(json_has_them_beside_the_branches),
        cmocka_unit_test(a_line_of_many_has_them_too),
        cmocka_unit_test(text_has_none),
        cmocka_unit_test(no_edge_is_an_empty_list),
        cmocka_unit_test(unsound_ones_are_not_written),
    };
    if (argc > 1 && !set_separator_locale(argv[1])) {
        puts("SKIPPED: no such locale is installed, and localedef cannot make one");
        return 77;
    }
    make_list();
    const int failed = cmocka_run_group_tests_name("io: segments", tests, make_folder, remove_folder);
    asj_segment_list_free(&list);
    return failed;
}
