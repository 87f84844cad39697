/* SPDX-License-Identifier: BSD-2-Clause */
/* Junction files that must be refused: status, file, line and cause. */
#include "io_test.h"

#include <stdio.h>
#include <string.h>

#define GOOD "1 2\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n"
#define J "{\"schema\":\"asj-junctions-1\",\n\"image\":{\"width\":10,\"height\":8},\n\"junctions\":["
#define B "{\"angle\":1,\"length\":2}"
#define G "{\"x\":1,\"y\":2,\"branches\":[" B "," B "]}"

#define E(a, ba, b, bb) "{\"junction_a\":" #a ",\"branch_a\":" #ba ",\"junction_b\":" #b ",\"branch_b\":" #bb "}"

typedef struct bad_file {
    const char *text;
    int line; /* 0 = none is named */
    const char *cause;
    asj_status status;
} bad_file;

static const bad_file bad_files[] = {
    {"\n\n", 1, "no number of junctions", ASJ_ERROR_FORMAT},
    {"hello\n", 1, "first line", ASJ_ERROR_FORMAT},
    {"1.5\n" GOOD, 1, "first line", ASJ_ERROR_FORMAT},
    {"-1\n", 1, "first line", ASJ_ERROR_FORMAT},
    {"1 1\n" GOOD, 1, "first line", ASJ_ERROR_FORMAT},
    {"16777217\n", 1, "16777217", ASJ_ERROR_LIMIT},
    {"99999999999999999999\n", 1, "first line", ASJ_ERROR_FORMAT},
    {"2\n" GOOD, 5, "ends", ASJ_ERROR_FORMAT},
    {"1\n" GOOD GOOD, 6, "text after", ASJ_ERROR_FORMAT},
    {"1\n" GOOD "x\n", 6, "text after", ASJ_ERROR_FORMAT},
    {"0\n\n" GOOD, 3, "text after", ASJ_ERROR_FORMAT},
    {"1\n1\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "x y", ASJ_ERROR_FORMAT},
    {"1\n1 2 3\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "x y", ASJ_ERROR_FORMAT},
    {"1\nnan 2\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "'nan'", ASJ_ERROR_FORMAT},
    {"1\n1 inf\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "'inf'", ASJ_ERROR_FORMAT},
    {"1\n1 1e39\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "'1e39'", ASJ_ERROR_FORMAT},
    {"1\n1 1e999\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "'1e999'", ASJ_ERROR_FORMAT},
    {"1\n1 0x10\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "'0x10'", ASJ_ERROR_FORMAT},
    {"1\n468.57\xff" "834 1\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "'468.57?834'", ASJ_ERROR_FORMAT},
    {"1\n1 1,5\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 2, "'1,5'", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2 7 5\n0.5 1 10\n2.5 1 20\n", 3, "M scale", ASJ_ERROR_FORMAT},
    {"1\n1 2\n1 7 5 -3.5\n0.5 1 10\n", 3, "2 to 5", ASJ_ERROR_FORMAT},
    {"1\n1 2\n6 7 5 -3.5\n0.5 1 10\n", 3, "2 to 5", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2.5 7 5 -3.5\n0.5 1 10\n", 3, "2 to 5", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2 -7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 3, "negative scale", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2 7 5 nan\n0.5 1 10\n2.5 1 20\n", 3, "'nan'", ASJ_ERROR_FORMAT},
    {"1\n1 2\n3 7 5 -3.5\n0.5 1 10\n2.5 1 20\n", 5, "ends", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2 7 5 -3.5\n0.5 1 10\n2.5 1 -20\n", 5, "negative length", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2 7 5 -3.5\n0.5 1 10\n2.5 1 1e7\n", 2, "a branch 1 with a length of 1e+07 px, not 0 .. 262140", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2 7 5 -3.5\n0.5 1\n2.5 1 20\n", 4, "theta", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2 7 5 -3.5\n0.5 1 10\n-inf 1 20\n", 5, "'-inf'", ASJ_ERROR_FORMAT},
    {"1\n1 2\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20", 5, "within its last line", ASJ_ERROR_FORMAT},
    {"0", 1, "within its last line", ASJ_ERROR_FORMAT},
    {"{", 1, "ends", ASJ_ERROR_FORMAT},
    {"{}", 1, "schema", ASJ_ERROR_FORMAT},
    {"{ }x", 1, "text after", ASJ_ERROR_FORMAT},
    {"[1]", 1, "'{'", ASJ_ERROR_FORMAT},
    {"\xef\xbb\xbf", 1, "no number of junctions", ASJ_ERROR_FORMAT},
    {"\xef\xbb\xbf{\"junctions\":7}", 1, "'['", ASJ_ERROR_FORMAT},
    {"\xff\xfe{", 0, "UTF-16", ASJ_ERROR_FORMAT},
    {"\x89" "ASJF\r\n\x1a", 0, "features", ASJ_ERROR_FORMAT},
    {"\x89PNG\r\n\x1a\n", 0, "an image", ASJ_ERROR_FORMAT},
    {"junction,x,y,scale\n", 0, "CSV", ASJ_ERROR_FORMAT},
    {"x1,y1,x2,y2,sd1\n", 0, "CSV", ASJ_ERROR_FORMAT},
    {"{\"a\":1}", 1, "schema", ASJ_ERROR_FORMAT},
    {"{\"junctions\":[]}", 1, "schema", ASJ_ERROR_FORMAT},
    {"{\"schema\":\"asj-junctions-1\"}", 1, "junctions", ASJ_ERROR_FORMAT},
    {"{\"schema\":\"asj-junctions-2\",\"junctions\":[]}", 1, "schema", ASJ_ERROR_FORMAT},
    {"{\"schema\":\"asj-junctions-1\",\n\"schema\":\"asj-junctions-1\",\"junctions\":[]}", 2, "a second time", ASJ_ERROR_FORMAT},
    {J "],\n\"image\":{\"width\":10,\"height\":8}}", 4, "a second time", ASJ_ERROR_FORMAT},
    {"{\"schema\":7}", 1, "schema", ASJ_ERROR_FORMAT},
    {"{7:7}", 1, "key", ASJ_ERROR_FORMAT},
    {"{\"a\" 7}", 1, "':'", ASJ_ERROR_FORMAT},
    {"{\"junctions\":7}", 1, "'['", ASJ_ERROR_FORMAT},
    {"{\n\"a\":\n[1,\n2,,3]}", 4, "JSON", ASJ_ERROR_FORMAT},
    {"{\"image\":{\"width\":0,\"height\":5}}", 1, "width", ASJ_ERROR_FORMAT},
    {"{\"image\":{\"name\":\"a\"},\n\"schema\":\"asj-junctions-1\",\"junctions\":[]}", 1, "width", ASJ_ERROR_FORMAT},
    {"{\"schema\":\"asj-junctions-1\",\"image\":{\"name\":\"a\"},\"error\":\"a: gone\"}\n", 1,
     "no junctions, but why the image has none: a: gone", ASJ_ERROR_FORMAT},
    {"{\"schema\":\"asj-junctions-1\",\"image\":{\"name\":\"a\"},\"error\":7}", 1, "width", ASJ_ERROR_FORMAT},
    {J G "]}\n" J G "]}\n", 4, "of lines of JSON", ASJ_ERROR_FORMAT},
    {"{\"image\":{\"width\":5,\"height\":100000}}", 1, "height", ASJ_ERROR_FORMAT},
    {J G "\n" G "]}", 4, "']'", ASJ_ERROR_FORMAT},
    {J G "],\n\"junctions\":[]}", 4, "second time", ASJ_ERROR_FORMAT},
    {J G "]}\nx", 4, "text after", ASJ_ERROR_FORMAT},
    {J "\n7]}", 4, "no object", ASJ_ERROR_FORMAT},
    {J G ",\n{\"x\":1,\"y\":2}]}", 4, "branches", ASJ_ERROR_FORMAT},
    {J G ",\n{\"x\":1,\"y\":2,\"branches\":[" B "]}]}", 4, "2 to 5", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"branches\":[" B "," B "," B "," B "," B "," B "]}]}", 3, "2 to 5", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"branches\":[" B ",7]}]}", 3, "no object", ASJ_ERROR_FORMAT},
    {J "{\"x\":\"1\",\"y\":2,\"branches\":[" B "," B "]}]}", 3, "\"x\"", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"branches\":[" B "," B "]}]}", 3, "\"y\"", ASJ_ERROR_FORMAT},
    {J "{\"x\":NaN,\"y\":2,\"branches\":[" B "," B "]}]}", 3, "JSON", ASJ_ERROR_FORMAT},
    {J "{\"x\":1e39,\"y\":2,\"branches\":[" B "," B "]}]}", 3, "\"x\"", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"scale\":-1,\"branches\":[" B "," B "]}]}", 3, "a scale of -1", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"branches\":[" B ",{\"angle\":1,\"length\":-2}]}]}", 3, "a length of -2", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"branches\":[" B ",{\"angle\":1,\"length\":300000}]}]}", 3, "a length of 300000", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"octave\":1.7,\"branches\":[" B "," B "]}]}", 3, "whole number", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"octave\":-2,\"branches\":[" B "," B "]}]}", 3, "from -1 to 15", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"octave\":16,\"branches\":[" B "," B "]}]}", 3, "from -1 to 15", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"octave\":2147483648,\"branches\":[" B "," B "]}]}", 3, "from -1 to 15", ASJ_ERROR_FORMAT},
    {J G ",\n{\"x\":19.5,\"y\":2,\"branches\":[" B "," B "]}]}", 4, "outside", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"branches\":[" B ",{\"angle\":1,\"length\":2,\"end\":\"here\"}]}]}", 3, "no kind of end",
     ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"branches\":[" B ",{\"angle\":1,\"length\":2,\"end\":3}]}]}", 3, "no kind of end", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[7]}", 4, "no object", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[{\"junction_a\":0}]}", 4, "two junctions", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[" E(0, 0, 1, 5) "]}", 4, "two junctions", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[" E(0, 0, -1, 1) "]}", 4, "two junctions", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[" E(0, 0, 16777216, 1) "]}", 4, "two junctions", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[" E(0, 0, 1, 1) ",\n" E(0, 0, 2, 1) "]}", 5, "not there", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[" E(0, 0, 1, 2) "]}", 4, "not there", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[" E(1, 0, 0, 0) "]}", 4, "not there", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[" E(0, 0, 1, 1) ",\n" E(0, 1, 1, 1) "]}", 5, "two edges", ASJ_ERROR_FORMAT},
    {J G "," G "],\n\"edges\":[],\n\"edges\":[]}", 5, "second time", ASJ_ERROR_FORMAT},
    {J "{\"x\":1,\"y\":2,\"branches\":[" B ",{\"angle\":0.5,\"length\":2}]}," G "],\n\"edges\":[" E(0, 0, 1, 1) "]}", 4,
     "in order of angle", ASJ_ERROR_FORMAT},
    {J G ",\n{\"x\":1,\"y\":-10.5,\"branches\":[" B "," B "]}]}", 4, "outside", ASJ_ERROR_FORMAT},
};

static void check_refused(const char *path, const bad_file *bad)
{
    asj_junction_file *file = (asj_junction_file *)(size_t)16;
    char message[512] = "old", line[32] = "";
    asj_status status = asj_junctions_read(path, &file, message, sizeof message);

    if (bad->line)
        snprintf(line, sizeof line, ": line %d: ", bad->line);
    if (status != bad->status || strncmp(message, path, strlen(path)) || !strstr(message, line) || !strstr(message, bad->cause))
        fail_msg("status %d '%s' for:\n%s", (int)status, message, bad->text);
    assert_null(file);
    assert_null(strchr(message, '\n'));
}

static void every_fault_is_told_with_its_line(void **state)
{
    size_t i;
    (void)state;
    for (i = 0; i < sizeof bad_files / sizeof bad_files[0]; i++)
        check_refused(write_bytes("bad", bad_files[i].text, strlen(bad_files[i].text)), &bad_files[i]);
}

static void files_that_cannot_be_read(void **state)
{
    static const bad_file missing = {"(missing)", 0, "No such file", ASJ_ERROR_FILE};
    static const bad_file directory = {"(.)", 0, "directory", ASJ_ERROR_FILE};
    static const bad_file empty = {"", 0, "empty", ASJ_ERROR_FORMAT};
    static const bad_file zeros = {"(zeros)", 0, "not text", ASJ_ERROR_FORMAT};
    asj_junction_file *file = NULL;
    (void)state;
    check_refused(in_folder("missing"), &missing);
    check_refused(in_folder("."), &directory);
    check_refused(write_bytes("empty", "", 0), &empty);
    check_refused(write_bytes("zeros", "\0\0\0\0", 4), &zeros);
    file = (asj_junction_file *)&file; /* anything: NULL afterwards */
    assert_int_equal(asj_junctions_read(NULL, &file, NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_null(file);
    assert_int_equal(asj_junctions_read("x", NULL, NULL, 0), ASJ_ERROR_ARGUMENT);
    asj_junction_file_free(NULL);
    asj_junction_file_free(&file);
}

static const char text_sample[] = "2\n" GOOD "3 4\n3 7 5 -3.5\n0.5 1 10\n2.5 1 20\n4.5 1 300\n";
static const char json_sample[] = J G ",\n" G "],\n\"edges\": [" E(0, 0, 1, 1)
    "],\n\"more\": [1, {\"a\": \"\\u00e9\"}, null, true, -1.5e3]}";

static void cut_at_every_length(void **state)
{
    static const bad_file any = {"(cut)", 0, "", ASJ_ERROR_FORMAT};
    asj_junction_file *file = NULL;
    size_t length;
    (void)state;
    for (length = 0; length < sizeof text_sample - 1; length++)
        check_refused(write_bytes("cut", text_sample, length), &any);
    for (length = 0; length < sizeof json_sample - 1; length++)
        check_refused(write_bytes("cut", json_sample, length), &any);
    assert_int_equal(asj_junctions_read(write_bytes("whole", text_sample, sizeof text_sample - 1), &file, NULL, 0), ASJ_OK);
    assert_int_equal(file->junction_count, 2);
    assert_int_equal(file->lines[0], 2);
    assert_int_equal(file->lines[1], 6);
    asj_junction_file_free(&file);
    assert_int_equal(asj_junctions_read(write_bytes("whole", json_sample, sizeof json_sample - 1), &file, NULL, 0), ASJ_OK);
    assert_int_equal(file->junction_count, 2);
    assert_int_equal(file->lines[0], 3);
    assert_int_equal(file->lines[1], 4);
    assert_true(file->edge_count == 1 && file->edges[0].junction_b == 1 && file->edges[0].branch_b == 1);
    asj_junction_file_free(&file);
}

/* Nothing crashes, and what is taken keeps the promises of junction.h. */
static void any_byte_changed(void **state)
{
    static const unsigned char values[] = {0, ' ', '\n', '-', '9', '"', ']', 0xff};
    char copy[512];
    size_t sample, at, v;
    uint32_t i;
    int32_t b;
    (void)state;
    for (sample = 0; sample < 2; sample++) {
        const char *text = sample ? json_sample : text_sample;
        size_t size = strlen(text);
        for (at = 0; at < size; at++)
            for (v = 0; v < sizeof values; v++) {
                asj_junction_file *file = NULL;
                memcpy(copy, text, size);
                copy[at] = (char)values[v];
                if (asj_junctions_read(write_bytes("changed", copy, size), &file, NULL, 0) != ASJ_OK)
                    continue;
                for (i = 0; i < file->junction_count; i++) {
                    const asj_junction *junction = &file->junctions[i];
                    assert_in_range(junction->branch_count, 2, ASJ_MAX_BRANCHES);
                    for (b = 0; b < junction->branch_count; b++)
                        assert_true(junction->branches[b].angle >= 0 && junction->branches[b].angle < 6.28318531f &&
                                    junction->branches[b].length >= 0);
                }
                asj_junction_file_free(&file);
            }
    }
}

static void angles_and_order_are_made_regular(void **state)
{
    static const char text[] = "2\r\n 1  2 \r\n5 7 5 -3.5\r\n\r\n-0.5 1 1\r\n7 2 2\r\n3 3 3\r\n"
                               "-6.2831853071795862 4 4\r\n1e9 5 5\r\n"
                               "+1. .5\n2 0 0 1E-3\n6.28318530717958\t1 0\n0 2 0\n \t"; /* the last line is empty */
    static const float order[] = {4, 5, 2, 3, 1}; /* at 0, 1e9 mod 2 pi = 0.577, 7 - 2 pi = 0.717, 3 and -0.5 */
    asj_junction_file *file = NULL;
    char message[512];
    int32_t b;
    (void)state;
    if (asj_junctions_read(write_bytes("angles", text, sizeof text - 1), &file, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    for (b = 0; b < 5; b++)
        assert_true(file->junctions[0].branches[b].strength == order[b]);
    assert_true(file->junctions[0].branches[0].angle == 0);
    assert_true(file->junctions[0].branches[4].angle == (float)(6.283185307179586 - 0.5));
    assert_true(file->junctions[1].x == 1 && file->junctions[1].y == 0.5f);
    assert_true(file->junctions[1].branches[0].angle == 0 && file->junctions[1].branches[1].angle == 0);
    asj_junction_file_free(&file);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_fault_is_told_with_its_line), cmocka_unit_test(files_that_cannot_be_read),
        cmocka_unit_test(cut_at_every_length),               cmocka_unit_test(any_byte_changed),
        cmocka_unit_test(angles_and_order_are_made_regular),
    };
    return cmocka_run_group_tests_name("io: bad junctions", tests, make_folder, remove_folder);
}
