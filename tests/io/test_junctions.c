/* SPDX-License-Identifier: BSD-2-Clause */
/* Junction files that are sound: what is written reads back, in every locale. */
#define _XOPEN_SOURCE 700
#include "io_test.h"

#include <asj/version.h>

#include <glob.h>
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#define COUNT 300

static char message[512];
static asj_junction junctions[COUNT];
static asj_l_junction pairs[10 * COUNT];
static asj_edge edges[COUNT];
static asj_detect_options options;
static asj_detection detection;
static asj_detection_report report;

static uint32_t random_state = 1;
static float random_float(float low, float high)
{
    random_state = random_state * 1664525u + 1013904223u;
    return low + (high - low) * ((float)(random_state >> 8) / 16777216.0f);
}

static void fill_branch(asj_branch *branch, int32_t b, int32_t count)
{
    branch->angle = (float)b * 6.28f / (float)count + random_float(0, 1);
    branch->length = random_float(0, 500);
    branch->strength = random_float(-3, 30);
    branch->log10_nfa = random_float(-300, 5);
    branch->angle_sd = random_float(0, 0.01f);
    branch->width = random_float(0, 10);
    branch->length_sd = random_float(0, 5);
    branch->end = b % 6;
}

/* Random junctions, the first with the most awkward floats. */
static void fill_detection(void)
{
    static const asj_detection_report none = {0};
    uint32_t i;
    int32_t b, count;

    memset(junctions, 0, sizeof junctions);
    for (i = 0; i < COUNT; i++) {
        asj_junction *junction = &junctions[i];
        junction->x = random_float(0, 999);
        junction->y = random_float(0, 799);
        junction->scale = i % 2 ? 7.0f : random_float(3, 30);
        junction->log10_nfa = random_float(-500, 0);
        junction->location_sd = random_float(0, 1);
        junction->octave = (int32_t)(i % 6) - 1;
        count = junction->branch_count = 2 + (int32_t)(i % 4);
        for (b = 0; b < count; b++)
            fill_branch(&junction->branches[b], b, count);
    }
    junctions[0].x = 0.1f;
    junctions[0].y = 1e-30f;
    junctions[0].log10_nfa = -1.17549435e-38f;
    junctions[0].branches[0].angle = 0;
    junctions[0].branches[1].angle = 6.28318501f; /* the last float below 2 pi */
    junctions[0].branches[1].strength = 3.40282347e38f;
    memset(edges, 0, sizeof edges);
    for (i = 0; i < COUNT / 2; i++) { /* the first branch of each of the first half with the second of one of the rest */
        edges[i].junction_a = i;
        edges[i].junction_b = COUNT - 1 - i;
        edges[i].branch_b = 1;
        edges[i].log10_nfa = random_float(-300, 0);
    }
    memset(&detection, 0, sizeof detection);
    detection.edges = edges;
    detection.edge_count = COUNT / 2;
    detection.junctions = junctions;
    detection.junction_count = COUNT;
    detection.l_junctions = pairs;
    detection.l_junction_count = (uint32_t)asj_decompose(junctions, COUNT, 25, pairs, 10 * COUNT);
    assert_true(detection.l_junction_count > COUNT);
    detection.width = 1000;
    detection.height = 800;
    detection.backend = ASJ_BACKEND_CPU;
    detection.total_ms = 12.3456;
    detection.stage_ms[ASJ_STAGE_SCAN] = 3.25;
    detection.candidates = 5000000000u;
    asj_detect_options_init(&options);
    report = none;
    report.detection = &detection;
    report.options = &options;
    report.image_name = "a \"quoted\" name\n\xc3\xa9";
}

static const char *write_report(const char *name, int32_t format)
{
    const char *path = in_folder(name);
    if (asj_junctions_write(path, format, &report, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    assert_string_equal(message, "");
    return path;
}

static asj_junction_file *read_back(const char *path)
{
    asj_junction_file *file = NULL;
    if (asj_junctions_read(path, &file, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    return file;
}

/* Fields that compare equal as numbers are the same bits but for the sign of zero: every one is compared by its bits. */
static void json_gives_every_bit_back(void **state)
{
    asj_junction_file *file = read_back(write_report("all.json", ASJ_FILE_JSON));
    uint32_t i;
    (void)state;
    assert_int_equal(file->junction_count, COUNT);
    assert_int_equal(file->width, 1000);
    assert_int_equal(file->height, 800);
    for (i = 0; i < COUNT; i++)
        assert_memory_equal(&file->junctions[i], &junctions[i], sizeof junctions[i]);
    for (i = 1; i < COUNT; i++)
        assert_int_equal(file->lines[i], file->lines[0] + i);
    assert_int_equal(file->edge_count, COUNT / 2);
    assert_memory_equal(file->edges, edges, COUNT / 2 * sizeof *edges);
    asj_junction_file_free(&file);
    assert_null(file);
}

/* The float that six decimals stand for. The test may run in any locale, so it does not ask printf. */
static float six_decimals(float value)
{
    double scaled = (double)value * 1e6, whole = (double)(long long)(scaled + (value < 0 ? -0.5 : 0.5));
    return (float)(whole / 1e6);
}

static void text_gives_six_decimals_back(void **state)
{
    asj_junction_file *file;
    uint32_t i;
    int32_t b;
    (void)state;
    junctions[0].branches[1].strength = 1;
    file = read_back(write_report("whole.asj", ASJ_FILE_ASJ_WHOLE));
    assert_int_equal(file->junction_count, COUNT);
    assert_int_equal(file->width, 0);
    for (i = 0; i < COUNT; i++) {
        const asj_junction *got = &file->junctions[i], *was = &junctions[i];
        assert_true(got->x == six_decimals(was->x) && got->y == six_decimals(was->y));
        assert_true(got->scale == was->scale && got->log10_nfa == six_decimals(was->log10_nfa));
        assert_int_equal(got->branch_count, was->branch_count);
        for (b = 0; b < was->branch_count; b++) {
            assert_true(got->branches[b].angle == six_decimals(was->branches[b].angle));
            assert_true(got->branches[b].length == six_decimals(was->branches[b].length));
            assert_true(got->branches[b].strength == six_decimals(was->branches[b].strength));
        }
    }
    asj_junction_file_free(&file);
}

static void decomposed_text_holds_the_pairs(void **state)
{
    asj_junction_file *file = read_back(write_report("pairs.asj", ASJ_FILE_ASJ));
    uint32_t i;
    (void)state;
    assert_int_equal(file->junction_count, detection.l_junction_count);
    for (i = 0; i < file->junction_count; i++) {
        const asj_junction *got = &file->junctions[i], *was = &junctions[pairs[i].junction];
        assert_int_equal(got->branch_count, 2);
        assert_true(got->x == six_decimals(was->x) && got->y == six_decimals(was->y));
        assert_true(got->branches[0].length == six_decimals(was->branches[pairs[i].branch_a].length) ||
                    got->branches[1].length == six_decimals(was->branches[pairs[i].branch_a].length));
    }
    asj_junction_file_free(&file);
}

/* The next field of a CSV line as it stands; passes the comma or the end of the line. */
static const char *next_text(char **at)
{
    char *text = *at, *end = text + strcspn(text, ",\n");
    *end = '\0';
    *at = end + 1;
    return text;
}

/* Reads the next field of a CSV line with a decimal point, and passes the comma or the end of the line. */
static float next_field(char **at)
{
    char *end = *at + strcspn(*at, ",\n");
    json_t *value;
    float number;
    *end = '\0';
    value = load_json_text(*at); /* a reader of numbers that knows no locale */
    assert_true(json_is_number(value));
    number = (float)json_number_value(value);
    json_decref(value);
    *at = end + 1;
    return number;
}

static void csv_gives_every_float_back(void **state)
{
    static const char head[] = "junction,x,y,scale,log10_nfa,location_sd,octave,branch,angle,length,strength,branch_log10_nfa,"
        "angle_sd,width,length_sd,end,to_junction,to_branch,edge_log10_nfa\n";
    static const char *const words[] = {"", "junction", "crossing", "faded", "occlusion", "border"};
    static char text[400000];
    FILE *file = fopen(write_report("all.csv", ASJ_FILE_CSV), "rb");
    char *at = text;
    uint32_t i;
    int32_t b;
    (void)state;
    assert_non_null(file);
    assert_in_range(fread(text, 1, sizeof text, file), 1, sizeof text - 1);
    fclose(file);
    assert_memory_equal(text, head, sizeof head - 1);
    at += sizeof head - 1;
    for (i = 0; i < COUNT; i++)
        for (b = 0; b < junctions[i].branch_count; b++) {
            const asj_junction *j = &junctions[i];
            const asj_branch *r = &j->branches[b];
            const float wanted[15] = {(float)i, j->x, j->y, j->scale, j->log10_nfa, j->location_sd, (float)j->octave, (float)b,
                                      r->angle, r->length, r->strength, r->log10_nfa, r->angle_sd, r->width,
                                      r->length_sd};
            const uint32_t place = i < COUNT / 2 ? i : COUNT - 1 - i;
            int field;
            for (field = 0; field < 15; field++)
                assert_true(next_field(&at) == wanted[field]);
            assert_string_equal(next_text(&at), words[r->end]);
            if (b == (i < COUNT / 2 ? 0 : 1)) {
                assert_true(next_field(&at) == (float)(COUNT - 1 - i));
                assert_true(next_field(&at) == (i < COUNT / 2 ? 1 : 0));
                assert_true(next_field(&at) == edges[place].log10_nfa);
            } else {
                for (field = 0; field < 3; field++)
                    assert_string_equal(next_text(&at), "");
            }
        }
    assert_string_equal(at, "");
}

static void golden_text_and_csv(void **state)
{
    static const char text[] = "2\n486.533356 388.250000\n2 14 14 -46.909500\n4.750000 12.660156 253.000000\n"
                               "0.062500 15.164062 126.000000\n"
                               "486.533356 388.250000\n2 14 14 -46.909500\n0.062500 15.164062 126.000000\n"
                               "3.125000 14.000000 149.500000\n";
    static const char whole[] = "1\n486.533356 388.250000\n3 14 14 -46.909500\n0.062500 15.164062 126.000000\n"
                                "3.125000 14.000000 149.500000\n4.750000 12.660156 253.000000\n";
    static const char csv[] =
        "junction,x,y,scale,log10_nfa,location_sd,octave,branch,angle,length,strength,branch_log10_nfa,"
        "angle_sd,width,length_sd,end,to_junction,to_branch,edge_log10_nfa\n"
        "0,486.53336,388.25,14,-46.9095,0.1,1,0,0.0625,126,15.1640625,-134.5,0.001,2.5,0.5,faded,,,\n"
        "0,486.53336,388.25,14,-46.9095,0.1,1,1,3.125,149.5,14,0,0,0,0,,,,\n"
        "0,486.53336,388.25,14,-46.9095,0.1,1,2,4.75,253,12.660156,0,0,0,0,border,,,\n";
    static const asj_junction junction = {486.533356f, 388.25f, 14, -46.9095f, 0.1f, 3, 1,
                                          {{0.0625f, 126, 15.1640625f, -134.5f, 0.001f, 2.5f, 0.5f,
                                            ASJ_BRANCH_END_FADED},
                                           {3.125f, 149.5f, 14, 0, 0, 0, 0, ASJ_BRANCH_END_UNKNOWN},
                                           {4.75f, 253, 12.6601562f, 0, 0, 0, 0, ASJ_BRANCH_END_BORDER}}};
    static const asj_l_junction two[2] = {{0, 2, 0, 0, 0, 0, 0, 0, 0}, {0, 0, 1, 0, 0, 0, 0, 0, 0}};
    static const char *const wanted[] = {text, whole, NULL, csv};
    static test_bytes found;
    asj_detection one = detection;
    int32_t format;
    (void)state;
    one.junctions = &junction;
    one.junction_count = 1;
    one.edge_count = 0;
    one.l_junctions = two;
    one.l_junction_count = 2;
    report.detection = &one;
    for (format = ASJ_FILE_ASJ; format <= ASJ_FILE_CSV; format++) {
        read_bytes(write_report("golden", format), &found);
        found.bytes[found.size] = '\0';
        if (wanted[format])
            assert_string_equal((char *)found.bytes, wanted[format]);
    }
    report.detection = &detection;
}

static void no_junctions_at_all(void **state)
{
    asj_detection empty = {0};
    int32_t format;
    (void)state;
    empty.width = empty.height = 1;
    report.detection = &empty;
    for (format = ASJ_FILE_ASJ; format <= ASJ_FILE_JSON; format++) {
        asj_junction_file *file = read_back(write_report("empty", format));
        assert_int_equal(file->junction_count, 0);
        assert_null(file->junctions);
        assert_null(file->lines);
        asj_junction_file_free(&file);
    }
    report.detection = &detection;
}

/* The schema as another program sees it. */
static void json_has_its_schema(void **state)
{
    json_t *root = load_json_file(write_report("schema.json", ASJ_FILE_JSON), JSON_REJECT_DUPLICATES);
    json_t *stored = json_object_get(root, "options");
    const json_t *edge;
    size_t i;
    (void)state;
    assert_non_null(root);
    assert_string_equal(json_string_value(json_object_get(root, "schema")), "asj-junctions-1");
    assert_string_equal(json_string_value(json_object_get(json_object_get(root, "image"), "name")), report.image_name);
    assert_string_equal(json_string_value(json_object_get(json_object_get(root, "library"), "version")), asj_version_string());
    assert_string_equal(json_string_value(json_object_get(root, "backend")), "cpu");
    assert_true(json_real_value(json_object_get(json_object_get(root, "timing"), "total_ms")) == 12.346);
    assert_true(json_real_value(json_object_get(json_object_get(json_object_get(root, "timing"), "stages"), "scan")) == 3.25);
    assert_true(json_integer_value(json_object_get(json_object_get(root, "counts"), "candidates")) == 5000000000LL);
    assert_int_equal(json_array_size(json_object_get(root, "l_junctions")), detection.l_junction_count);
    for (i = 0; i < detection.l_junction_count; i++) {
        const json_t *pair = json_array_get(json_object_get(root, "l_junctions"), i);
        assert_int_equal(json_integer_value(json_object_get(pair, "junction")), pairs[i].junction);
        assert_int_equal(json_integer_value(json_object_get(pair, "a")), pairs[i].branch_a);
        assert_int_equal(json_integer_value(json_object_get(pair, "b")), pairs[i].branch_b);
        assert_true((float)json_number_value(json_object_get(pair, "bx")) == pairs[i].bx);
    }
    assert_int_equal(json_object_size(stored), asj_detect_option_count());
    assert_true(json_real_value(json_object_get(stored, "gradient_epsilon")) == options.gradient_epsilon);
    assert_true(json_is_boolean(json_object_get(stored, "strip_test")));
    assert_string_equal(json_string_value(json_object_get(stored, "refinement")), "line_fit");
    assert_int_equal(json_integer_value(json_array_get(json_object_get(stored, "isotropic_radii"), 0)), 7);
    assert_int_equal(json_integer_value(json_object_get(json_object_get(root, "counts"), "edges")), COUNT / 2);
    assert_int_equal(json_array_size(json_object_get(root, "edges")), COUNT / 2);
    edge = json_array_get(json_object_get(root, "edges"), 3);
    assert_int_equal(json_integer_value(json_object_get(edge, "junction_b")), COUNT - 4);
    json_decref(root);
}

static void options_read_back_to_every_bit(void **state)
{
    json_t *root;
    (void)state;
    options.gradient_epsilon = 1.0 / 3.0;
    root = load_json_file(write_report("precise.json", ASJ_FILE_JSON), 0);
    assert_true(json_real_value(json_object_get(json_object_get(root, "options"), "gradient_epsilon")) == 1.0 / 3.0);
    json_decref(root);
    asj_detect_options_init(&options);
}

static void a_name_that_is_no_utf8(void **state)
{
    json_t *root;
    (void)state;
    report.image_name = "caf\xe9.png";
    root = load_json_file(write_report("latin.json", ASJ_FILE_JSON), 0);
    assert_string_equal(json_string_value(json_object_get(json_object_get(root, "image"), "name")), "caf?.png");
    json_decref(root);
}

static void unsound_detections_are_not_written(void **state)
{
    asj_junction bad[15];
    asj_vanishing_points nowhere = {.count = 1};
    asj_detection wrong = detection;
    asj_edge edge, twice[2];
    const char *path = in_folder("never");
    size_t i;
    (void)state;
    for (i = 0; i < 15; i++)
        bad[i] = junctions[1];
    bad[0].x = 0.0f / (float)(random_state & 0);
    bad[1].branches[1].length = 3e38f * (10.0f + random_float(0, 1));
    bad[2].branch_count = 6;
    bad[3].branch_count = -1;
    bad[4].location_sd = -bad[1].branches[1].length;
    bad[5].octave = 31;
    bad[6].branches[0].length = -1;
    bad[7].scale = -1;
    bad[8].octave = -2;
    bad[9].branch_count = 1;
    bad[10].branches[1].length = ASJ_MAX_BRANCH_LENGTH + 1;
    bad[11].branches[0].length_sd = bad[0].x;
    bad[12].branches[0].end = 42; /* which JSON would leave out */
    bad[13].branches[1].angle = 2e6f;
    bad[14].scale = bad[0].x;
    wrong.junction_count = 1;
    wrong.l_junction_count = wrong.edge_count = 0;
    {
        asj_detect_options unreadable;
        asj_detect_options_init(&unreadable);
        unreadable.epsilon = (double)bad[0].x;
        report.options = &unreadable;
        assert_int_equal(asj_junctions_write(path, ASJ_FILE_JSON, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
        assert_non_null(strstr(message, "options"));
        assert_int_equal(asj_junctions_write(in_folder("without.csv"), ASJ_FILE_CSV, &report, message, sizeof message), ASJ_OK);
        report.options = NULL;
    }
    report.detection = &wrong;
    for (i = 0; i < 15; i++) {
        wrong.junctions = &bad[i];
        assert_int_equal(asj_junctions_write(path, ASJ_FILE_JSON, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
        assert_non_null(strstr(message, "junction 0"));
    }
    wrong.junctions = junctions;
    wrong.junction_count = COUNT;
    wrong.edges = &edge;
    wrong.edge_count = 1;
    for (i = 0; i < 4; i++) {
        edge = edges[0];
        edge.junction_b = i == 0 ? COUNT : edge.junction_b;
        edge.branch_a = (uint16_t)(i == 1 ? junctions[0].branch_count : 0);
        edge.junction_a = i == 2 ? edge.junction_b : 0;
        edge.log10_nfa = i == 3 ? bad[0].x : -1;
        assert_int_equal(asj_junctions_write(path, ASJ_FILE_CSV, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
        assert_non_null(strstr(message, "edge 0"));
    }
    twice[0] = twice[1] = edges[0];
    wrong.edges = twice;
    wrong.edge_count = 2;
    assert_int_equal(asj_junctions_write(path, ASJ_FILE_JSON, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
    assert_non_null(strstr(message, "edge 1 is part"));
    wrong.edge_count = 1;
    for (i = 0; i < 3; i++) {
        wrong.width = i == 0 ? 0 : i == 1 ? ASJ_MAX_SIDE + 1 : detection.width;
        wrong.height = i == 2 ? -1 : detection.height;
        assert_int_equal(asj_junctions_write(path, ASJ_FILE_JSON, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
        assert_non_null(strstr(message, "pixels"));
    }
    wrong.edges = NULL;
    assert_int_equal(asj_junctions_write(path, ASJ_FILE_CSV, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
    wrong.edge_count = 0;
    wrong.junction_count = 1;
    wrong.junctions = &bad[5];
    wrong.l_junction_count = detection.l_junction_count; /* pairs of junctions that are not there */
    assert_int_equal(asj_junctions_write(path, ASJ_FILE_ASJ, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
    wrong.l_junctions = NULL;
    assert_int_equal(asj_junctions_write(path, ASJ_FILE_ASJ, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
    report.detection = &detection;
    nowhere.points[0].point[1] = (double)bad[0].x;
    report.vanishing_points = &nowhere;
    assert_int_equal(asj_junctions_write(path, ASJ_FILE_JSON, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
    assert_non_null(strstr(message, "vanishing points"));
    report.vanishing_points = NULL;
    report.reserved[0] = 1;
    assert_int_equal(asj_junctions_write(path, ASJ_FILE_ASJ, &report, message, sizeof message), ASJ_ERROR_OPTION);
    assert_non_null(strstr(message, "reserved"));
    report.reserved[0] = 0;
    assert_int_equal(asj_junctions_write(path, 4, &report, NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_junctions_write(path, -1, &report, NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_junctions_write(path, 0, NULL, NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_junctions_write(NULL, 0, &report, NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_null(fopen(path, "rb"));
}

/* The next line, without its end, as a JSON value. */
static json_t *next_line(char **at)
{
    char *line = *at, *end = strchr(line, '\n');
    json_t *root;
    assert_non_null(end);
    *end = '\0';
    *at = end + 1;
    root = load_json_text(line);
    assert_non_null(root);
    return root;
}

/* What the JSON file of the report has, without what repeats. */
static json_t *file_without_repetitions(void)
{
    json_t *root = load_json_file(write_report("one.json", ASJ_FILE_JSON), JSON_REJECT_DUPLICATES);
    assert_int_equal(json_object_del(root, "options"), 0);
    assert_int_equal(json_object_del(root, "timing"), 0);
    return root;
}

static void expect_next_line(char **at)
{
    json_t *line = next_line(at), *file = file_without_repetitions();
    assert_true(json_equal(line, file));
    json_decref(line);
    json_decref(file);
}

static void add_line(asj_output *output)
{
    if (asj_junctions_write_line(output, &report, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    assert_string_equal(message, "");
}

static char *text_of_file(const char *path)
{
    static char text[1000000];
    FILE *file = fopen(path, "rb");
    size_t size;
    assert_non_null(file);
    size = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    assert_in_range(size, 1, sizeof text - 2);
    text[size] = '\0';
    return text;
}

/* Each has what the file of JSON has, in the order of the calls; with a name of blanks, quotes and line ends. */
static void lines_have_what_files_have(void **state)
{
    static const char failed[] = "{\"schema\":\"asj-junctions-1\",\"image\":{\"name\":\"a \\\"b\\\"\\n\"},"
                                 "\"error\":\"no: \\\\ \\t?\"}\n";
    const asj_detection_report first = report;
    asj_vanishing_points points = {.count = 1};
    asj_detection empty = {.width = 1, .height = 1};
    const char *path = in_folder("all.jsonl");
    asj_output *output;
    char *at;
    (void)state;
    points.points[0].log10_nfa = -1.0 / 3.0;
    assert_int_equal(asj_output_begin(path, &output, message, sizeof message), ASJ_OK);
    add_line(output);
    assert_int_equal(asj_junctions_write_failed_line(output, "a \"b\"\n", "no: \\ \t\xff", message, sizeof message), ASJ_OK);
    assert_string_equal(message, "");
    report.vanishing_points = &points;
    report.image_name = NULL;
    add_line(output);
    report.detection = &empty;
    add_line(output);
    assert_null(fopen(path, "rb")); /* whole or not at all */
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);

    at = text_of_file(path);
    report = first;
    expect_next_line(&at);
    assert_memory_equal(at, failed, sizeof failed - 1);
    json_decref(next_line(&at));
    report.vanishing_points = &points;
    report.image_name = NULL;
    expect_next_line(&at);
    report.detection = &empty;
    expect_next_line(&at);
    assert_string_equal(at, "");
}

/* A line is a file of JSON, too. */
static void a_line_reads_as_a_file(void **state)
{
    const char *path = in_folder("line.jsonl");
    asj_junction_file *file;
    asj_output *output;
    (void)state;
    assert_int_equal(asj_output_begin(path, &output, message, sizeof message), ASJ_OK);
    add_line(output);
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    file = read_back(path);
    assert_int_equal(file->junction_count, COUNT);
    assert_memory_equal(file->junctions, junctions, sizeof junctions);
    assert_memory_equal(file->edges, edges, COUNT / 2 * sizeof *edges);
    asj_junction_file_free(&file);
}

/* Editors on Windows put a byte order mark before the text. */
static void a_byte_order_mark_is_passed_over(void **state)
{
    static const char text[] = "\xef\xbb\xbf" "1\n1 2\n2 7 5 -3.5\n0.5 1 10\n2.5 1 20\n";
    static const char json[] = "\xef\xbb\xbf {\"schema\":\"asj-junctions-1\",\"junctions\":[{\"x\":1,\"y\":2,\"branches\":["
                               "{\"angle\":0.5,\"length\":10},{\"angle\":2.5,\"length\":20}]}]}";
    const char *const files[] = {write_bytes("mark.asj", text, sizeof text - 1), write_bytes("mark.json", json, sizeof json - 1)};
    size_t i;
    (void)state;
    for (i = 0; i < 2; i++) {
        asj_junction_file *file = read_back(files[i]);
        assert_int_equal(file->junction_count, 1);
        assert_float_equal(file->junctions[0].branches[1].length, 20, 0);
        asj_junction_file_free(&file);
    }
}

static void expect_refused_line(asj_output *output, asj_status status, const char *cause)
{
    assert_int_equal(asj_junctions_write_line(output, &report, message, sizeof message), status);
    assert_non_null(strstr(message, "unharmed.jsonl: not written: "));
    assert_non_null(strstr(message, cause));
}

/* What is refused leaves nothing in the output, and the next line may come. */
static void unsound_lines_are_not_written(void **state)
{
    const char *path = in_folder("unharmed.jsonl");
    asj_detection wrong = detection;
    asj_vanishing_points nowhere = {.count = 1};
    asj_segment segment = {.x1 = 1e38f * (10.0f + random_float(0, 1))};
    asj_segment_list segments = {.count = 1, .segments = &segment};
    asj_output *output;
    char *at;
    (void)state;
    assert_int_equal(asj_output_begin(path, &output, message, sizeof message), ASJ_OK);
    add_line(output);
    report.detection = &wrong;
    wrong.width = 0;
    expect_refused_line(output, ASJ_ERROR_ARGUMENT, "0 x 800 pixels");
    wrong.width = 1000;
    wrong.junction_count = 1;
    expect_refused_line(output, ASJ_ERROR_ARGUMENT, "L-junction");
    report.detection = &detection;
    report.segments = &segments;
    expect_refused_line(output, ASJ_ERROR_ARGUMENT, "segment 0");
    report.segments = NULL;
    nowhere.points[0].log10_nfa = (double)segment.x1;
    report.vanishing_points = &nowhere;
    expect_refused_line(output, ASJ_ERROR_ARGUMENT, "vanishing points");
    report.vanishing_points = NULL;
    report.reserved[1] = 1;
    expect_refused_line(output, ASJ_ERROR_OPTION, "reserved");
    report.reserved[1] = 0;
    assert_int_equal(asj_junctions_write_line(output, NULL, NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_junctions_write_line(NULL, &report, message, sizeof message), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_junctions_write_failed_line(output, NULL, "a", NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_junctions_write_failed_line(output, "a", NULL, NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_junctions_write_failed_line(NULL, "a", "b", message, sizeof message), ASJ_ERROR_ARGUMENT);
    add_line(output);
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    report.options = &options;
    at = text_of_file(path);
    expect_next_line(&at);
    expect_next_line(&at);
    assert_string_equal(at, "");
}

/* Whoever reads a pipe has a line as soon as it is written; what cannot be written is told, then and at the end. */
static void lines_arrive_at_once(void **state)
{
    static char text[1000];
    char path[32];
    asj_detection empty = {.width = 1, .height = 1};
    asj_output *output;
    int ends[2];
    ssize_t size;
    (void)state;
    report.detection = &empty;
    report.options = NULL;
    assert_int_equal(pipe(ends), 0);
    snprintf(path, sizeof path, "/dev/fd/%d", ends[1]);
    assert_int_equal(asj_output_begin(path, &output, message, sizeof message), ASJ_OK);
    add_line(output);
    size = read(ends[0], text, sizeof text);
    assert_true(size > 2 && text[0] == '{' && text[size - 1] == '\n' && memchr(text, '\n', (size_t)size) == text + size - 1);
    assert_int_equal(asj_junctions_write_failed_line(output, "a", "b", message, sizeof message), ASJ_OK);
    size = read(ends[0], text, sizeof text);
    assert_true(size > 2 && text[0] == '{' && text[size - 1] == '\n');
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_OK);
    close(ends[0]);
    close(ends[1]);
    if (access("/dev/full", W_OK))
        return;
    assert_int_equal(asj_output_begin("/dev/full", &output, message, sizeof message), ASJ_OK);
    assert_int_equal(asj_junctions_write_line(output, &report, message, sizeof message), ASJ_ERROR_FILE);
    assert_int_equal(asj_junctions_write_failed_line(output, "a", "b", message, sizeof message), ASJ_ERROR_FILE);
    assert_int_equal(asj_output_commit(&output, message, sizeof message), ASJ_ERROR_FILE);
    assert_non_null(strstr(message, "/dev/full: cannot write"));
}

static void the_authors_files_are_read(void **state)
{
    const char *folder = getenv("ASJ_PAIRS");
    char pattern[1024];
    glob_t found;
    size_t i;
    uint32_t k;
    int32_t b;
    (void)state;
    snprintf(pattern, sizeof pattern, "%s/*/*.authors.asj", folder ? folder : ASJ_DEFAULT_PAIRS);
    if (glob(pattern, 0, NULL, &found)) {
        print_message("SKIPPED: no %s\n", pattern);
        skip();
    }
    for (i = 0; i < found.gl_pathc; i++) {
        asj_junction_file *file = read_back(found.gl_pathv[i]);
        FILE *stream = fopen(found.gl_pathv[i], "r");
        unsigned count;
        assert_int_equal(fscanf(stream, "%u", &count), 1);
        fclose(stream);
        assert_int_equal(file->junction_count, count);
        for (k = 0; k < count; k++)
            for (b = 0; b < file->junctions[k].branch_count; b++) {
                assert_true(file->junctions[k].branches[b].angle >= 0 && file->junctions[k].branches[b].angle < 6.28318531f);
                assert_true(!b || file->junctions[k].branches[b - 1].angle <= file->junctions[k].branches[b].angle);
            }
        asj_junction_file_free(&file);
    }
    globfree(&found);
}

static int fresh(void **state)
{
    (void)state;
    fill_detection();
    return 0;
}

static const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup(json_gives_every_bit_back, fresh),
    cmocka_unit_test_setup(text_gives_six_decimals_back, fresh),
    cmocka_unit_test_setup(decomposed_text_holds_the_pairs, fresh),
    cmocka_unit_test_setup(csv_gives_every_float_back, fresh),
    cmocka_unit_test_setup(golden_text_and_csv, fresh),
    cmocka_unit_test_setup(no_junctions_at_all, fresh),
    cmocka_unit_test_setup(json_has_its_schema, fresh),
    cmocka_unit_test_setup(options_read_back_to_every_bit, fresh),
    cmocka_unit_test_setup(a_name_that_is_no_utf8, fresh),
    cmocka_unit_test_setup(unsound_detections_are_not_written, fresh),
    cmocka_unit_test_setup(lines_have_what_files_have, fresh),
    cmocka_unit_test_setup(a_line_reads_as_a_file, fresh),
    cmocka_unit_test_setup(a_byte_order_mark_is_passed_over, fresh),
    cmocka_unit_test_setup(unsound_lines_are_not_written, fresh),
    cmocka_unit_test_setup(lines_arrive_at_once, fresh),
    cmocka_unit_test_setup(the_authors_files_are_read, fresh),
};

/* With the argument "comma" or "wide" in a locale with such a decimal separator; exit code 77 when there is none. */
int main(int argument_count, char **arguments)
{
    if (argument_count > 1 && !set_separator_locale(arguments[1])) {
        puts("SKIPPED: no such locale is installed, and localedef cannot make one");
        return 77;
    }
    return cmocka_run_group_tests_name("io: junctions", tests, make_folder, remove_folder);
}
