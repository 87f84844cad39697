/* SPDX-License-Identifier: BSD-2-Clause */
/* The detector's option table against its struct, and both tables against what include/asj/options.h and match.h say about each
 * field (arguments: these files). */
#include "detect/detect_options.h"
#include "unit_test.h"

#include <asj/match.h>

static char *header, *match_header;

/* The fields as the header declares them, with the places that their types give them. */
typedef struct field {
    char name[48];
    size_t offset, size;
} field;

enum { MOST_FIELDS = 100 };
static field fields[MOST_FIELDS];
static size_t field_count;

/* "    int32_t name; " -> its size and name; 0 when the line declares nothing. */
static size_t read_declaration(const char *line, char name[48])
{
    char type[48];
    if (sscanf(line, " %47[a-z0-9_] %47[a-z0-9_]", type, name) != 2)
        return 0;
    const char *after = strstr(line, name) + strlen(name);
    if (*after != ';' && *after != '[')
        return 0;
    return strcmp(type, "double") == 0 ? 8 : strcmp(type, "int32_t") == 0 || strcmp(type, "uint32_t") == 0 ? 4 : 0;
}

static void read_fields(void)
{
    size_t end = 0;
    const char *line = strstr(header, "typedef struct asj_detect_options {");
    field_count = 0;
    for (line = line ? strchr(line, '\n') : NULL; line && strncmp(line, "\n}", 2) != 0; line = strchr(line + 1, '\n')) {
        char name[48];
        const size_t size = read_declaration(line + 1, name);
        if (!size || strcmp(name, "reserved") == 0 || field_count == MOST_FIELDS)
            continue;
        field *f = &fields[field_count];
        f->size = size;
        f->offset = (end + size - 1) / size * size;
        end = f->offset + size;
        memcpy(f->name, name, sizeof name);
        field_count += strncmp(name, "reserved_", 9) != 0;
    }
    assert_int_equal(offsetof(asj_detect_options, reserved), end); /* the header was read right */
    assert_int_equal(sizeof(asj_detect_options), end + sizeof ((asj_detect_options *)0)->reserved);
}

/* Every field has exactly one row, of its name, place and size. */
static void test_rows_match_fields(void **state)
{
    (void)state;
    read_fields();
    assert_in_range(field_count, 20, MOST_FIELDS - 1);
    assert_int_equal(asj_detect_option_count(), field_count);
    assert_null(asj_detect_option(field_count));
    assert_null(asj_detect_option(SIZE_MAX));
    for (size_t i = 0; i < field_count; i++) {
        int rows = 0;
        for (size_t k = 0; k < asj_detect_option_count(); k++) {
            const asj_option_info *row = asj_detect_option(k);
            if (strcmp(row->key, fields[i].name) != 0)
                continue;
            rows++;
            assert_int_equal(row->offset, fields[i].offset);
            assert_int_equal(row->type == ASJ_OPTION_NUMBER ? 8 : 4, fields[i].size);
        }
        if (rows != 1)
            fail_msg("%s has %d rows", fields[i].name, rows);
    }
}

/* The rows of one table: sound, those of a group beside each other, a dozen common ones at most. */
static void check_rows(size_t count, const asj_option_info *(*row_at)(size_t index))
{
    size_t common = 0;
    for (size_t k = 0; k < count; k++) {
        const asj_option_info *row = row_at(k);
        common += !row->advanced;
        assert_true(row->advanced == 0 || row->advanced == 1);
        assert_true(row->reserved == 0 && row->step >= 0 && strlen(row->group) > 4);
        for (size_t i = 0; i + 1 < k; i++)
            assert_true(strcmp(row_at(i)->group, row->group) != 0 || strcmp(row_at(k - 1)->group, row->group) == 0);
        for (size_t i = 0; i < count; i++)
            assert_true(!row->former_key || strcmp(row->former_key, row_at(i)->key) != 0);
        assert_non_null(row->unit);
        assert_true(strlen(row->help) > 10);
        assert_true(row->help[strlen(row->help) - 1] != '.');
        assert_in_range(row->type, ASJ_OPTION_NUMBER, ASJ_OPTION_RADII);
        assert_int_equal(row->choices != NULL, row->type == ASJ_OPTION_CHOICE);
        assert_true(row->minimum < row->maximum);
        if (row->type == ASJ_OPTION_SWITCH)
            assert_true(row->minimum == 0 && row->maximum == 1);
        if (row->type == ASJ_OPTION_CHOICE)
            assert_true(row->choices[(int)row->maximum] && !row->choices[(int)row->maximum + 1]);
        for (const char *c = row->key; *c; c++)
            assert_true((*c >= 'a' && *c <= 'z') || *c == '_');
    }
    assert_in_range(common, 4, 12);
}

static void test_rows_are_sound(void **state)
{
    (void)state;
    check_rows(asj_detect_option_count(), asj_detect_option);
    check_rows(asj_match_option_count(), asj_match_option);
}

/* ---- the header's comments ---- */

/* The comment behind a field of the struct. */
static const char *comment_of(const char *text, const char *name, size_t *length)
{
    char declared[64];
    snprintf(declared, sizeof declared, " %s; ", name);
    const char *at = strstr(text, declared);
    const char *start = at ? strstr(at, "/*") : NULL, *end = start ? strstr(start, "*/") : NULL;
    if (!end || end - at > 600)
        fail_msg("%s has no comment in the header", name);
    *length = (size_t)(end - start);
    return start;
}

static int has_number(const char *text, size_t length, double value)
{
    for (const char *c = text + 2; c < text + length;) {
        char *end;
        const int starts = ((*c >= '0' && *c <= '9') || (*c == '-' && c[1] >= '0' && c[1] <= '9')) &&
                           (c[-1] == ' ' || c[-1] == '(');
        const double number = starts ? strtod(c, &end) : 0;
        if (starts && fabs(number - value) <= 1e-12 * fabs(value))
            return 1;
        c = starts ? end : c + 1;
    }
    return 0;
}

static int has_text(const char *text, size_t length, const char *wanted)
{
    const char *found = strstr(text, wanted);
    return found && found + strlen(wanted) <= text + length;
}

/* Range, default and, where they differ, the values of the other presets stand in the field's comment. */
static void check_comment(const char *text, const asj_option_info *row, const char *standard, const char *paper)
{
    size_t length;
    const char *comment = comment_of(text, row->key, &length);
    int right = (row->default_value == row->paper_value) != has_text(comment, length, " paper ") &&
                (row->default_value == row->match_value) != has_text(comment, length, "; match ");
    if (row->type == ASJ_OPTION_CHOICE || row->type == ASJ_OPTION_RADII) {
        right &= has_text(comment, length, standard) && has_text(comment, length, paper);
    } else {
        right &= has_number(comment, length, row->default_value) && has_number(comment, length, row->paper_value) &&
                 has_number(comment, length, row->match_value);
        if (row->type != ASJ_OPTION_SWITCH)
            right &= has_number(comment, length, row->minimum) && has_number(comment, length, row->maximum);
    }
    if (!right)
        fail_msg("%s: %g .. %g, default %s, paper %s is not what the header says: %.*s", row->key, row->minimum, row->maximum,
                 standard, paper, (int)length, comment);
}

static void test_header_comments(void **state)
{
    asj_detect_options standard, paper;
    (void)state;
    asj_detect_options_init(&standard);
    assert_int_equal(asj_detect_options_preset(&paper, ASJ_PRESET_PAPER), ASJ_OK);
    for (size_t k = 0; k < asj_detect_option_count(); k++) {
        const asj_option_info *row = asj_detect_option(k);
        char text[2][64];
        assert_int_equal(asj_detect_options_get(&standard, row->key, text[0], sizeof text[0]), ASJ_OK);
        assert_int_equal(asj_detect_options_get(&paper, row->key, text[1], sizeof text[1]), ASJ_OK);
        check_comment(header, row, text[0], text[1]);
    }
}

static void test_match_header_comments(void **state)
{
    asj_match_options standard, paper;
    (void)state;
    asj_match_options_init(&standard);
    assert_int_equal(asj_match_options_preset(&paper, ASJ_PRESET_PAPER), ASJ_OK);
    for (size_t k = 0; k < asj_match_option_count(); k++) {
        const asj_option_info *row = asj_match_option(k);
        char text[2][64];
        assert_int_equal(asj_match_options_get(&standard, row->key, text[0], sizeof text[0]), ASJ_OK);
        assert_int_equal(asj_match_options_get(&paper, row->key, text[1], sizeof text[1]), ASJ_OK);
        check_comment(match_header, row, text[0], text[1]);
    }
}

/* ---- presets and values ---- */

static void test_presets(void **state)
{
    asj_detect_options options, standard;
    (void)state;
    memset(&options, 0xff, sizeof options);
    asj_detect_options_init(&options);
    asj_detect_options_init(NULL);
    assert_int_equal(asj_detect_options_preset(&standard, ASJ_PRESET_DEFAULT), ASJ_OK);
    assert_memory_equal(&options, &standard, sizeof options);
    for (size_t i = 0; i < UNIT_COUNT(options.reserved); i++)
        assert_true(options.reserved[i] == 0);
    assert_int_equal(asj_detect_options_preset(NULL, ASJ_PRESET_PAPER), ASJ_ERROR_ARGUMENT);
    static const int32_t unknown[] = {-1, 3, INT32_MAX};
    for (size_t i = 0; i < UNIT_COUNT(unknown); i++) {
        assert_int_equal(asj_detect_options_preset(&options, unknown[i]), ASJ_ERROR_OPTION);
        assert_memory_equal(&options, &standard, sizeof options); /* left as it was */
    }
    for (int32_t preset = 0; preset <= 2; preset++) {
        asj_detect_options_preset(&options, preset);
        assert_int_equal(asj_detect_options_check(&options, NULL, 0), ASJ_OK);
    }
}

/* Writes a value into a field as the program that fills the struct by hand would. */
static void write_field(asj_detect_options *options, const asj_option_info *row, double value)
{
    char *at = (char *)options + row->offset;
    if (row->type == ASJ_OPTION_NUMBER) {
        memcpy(at, &value, sizeof value);
    } else if (row->type == ASJ_OPTION_RADII) {
        const uint32_t bits = (uint32_t)value;
        memcpy(at, &bits, sizeof bits);
    } else {
        const int32_t integer = (int32_t)value;
        memcpy(at, &integer, sizeof integer);
    }
}

/* What is written comes back bit by bit, whichever value of the range it is; no other field moves. */
static void test_round_trips(void **state)
{
    synth_random random;
    (void)state;
    synth_random_seed(&random, 9);
    for (size_t k = 0; k < asj_detect_option_count(); k++) {
        const asj_option_info *row = asj_detect_option(k);
        for (int i = 0; i < 300; i++) {
            asj_detect_options options, back;
            char text[64];
            double value = i == 0 ? row->minimum : i == 1 ? row->maximum : i == 2 ? row->default_value : row->paper_value;
            if (i > 3)
                value = synth_random_between(&random, row->minimum, row->maximum);
            if (row->type == ASJ_OPTION_RADII && i != 2 && i != 3)
                value = i < 2 ? (double)(1u << (int)value) : (double)(1u << (int)value | 1u << 9);
            else if (row->step > 0)
                value = row->minimum + floor((value - row->minimum) / row->step) * row->step;
            asj_detect_options_init(&options);
            asj_detect_options_init(&back);
            write_field(&options, row, value);
            assert_int_equal(asj_detect_options_check(&options, NULL, 0), ASJ_OK);
            assert_int_equal(asj_detect_options_get(&options, row->key, text, sizeof text), ASJ_OK);
            assert_int_equal(asj_detect_options_set(&back, row->key, text, NULL, 0), ASJ_OK);
            if (memcmp(&options, &back, sizeof options) != 0)
                fail_msg("%s: %.17g is printed as '%s', which reads as something else", row->key, value, text);
        }
    }
}

/* One step outside the range, and what is no number, by field and by text. */
static void test_out_of_range(void **state)
{
    (void)state;
    for (size_t k = 0; k < asj_detect_option_count(); k++) {
        const asj_option_info *row = asj_detect_option(k);
        double bad[4] = {row->minimum - 1, row->maximum + 1, nextafter(row->minimum, -HUGE_VAL), NAN};
        if (row->type == ASJ_OPTION_RADII)
            bad[0] = 0, bad[1] = 4, bad[2] = 2147483648.0;
        for (int i = 0; i < (row->type == ASJ_OPTION_NUMBER ? 4 : row->type == ASJ_OPTION_RADII ? 3 : 2); i++) {
            asj_detect_options options;
            char message[256] = "";
            asj_detect_options_init(&options);
            write_field(&options, row, bad[i]);
            if (row->type == ASJ_OPTION_RADII && i == 2)
                options.isotropic_radii = 0x80000020u;
            assert_int_equal(asj_detect_options_check(&options, message, sizeof message), ASJ_ERROR_OPTION);
            if (strncmp(message, row->key, strlen(row->key)) != 0)
                fail_msg("%s = %g: the message is '%s'", row->key, bad[i], message);
            if (row->type == ASJ_OPTION_RADII)
                assert_non_null(strstr(message, i == 0 ? ": an empty set is" : i == 1 ? ": 2 is" : ": 5,31 is"));
        }
    }
}

static void test_field_radius(void **state)
{
    (void)state;
    for (int32_t r = -2; r < 14; r++) {
        asj_detect_options options;
        char message[64] = "";
        asj_detect_options_init(&options);
        options.field_radius = r;
        const int good = r == 3 || r == 5 || r == 7 || r == 9;
        assert_int_equal(asj_detect_options_check(&options, message, sizeof message), good ? ASJ_OK : ASJ_ERROR_OPTION);
        assert_true(good || strstr(message, "field_radius"));
        assert_int_equal(asj_detect_options_check(&options, message, 5), good ? ASJ_OK : ASJ_ERROR_OPTION);
        assert_int_equal(asj_detect_options_check(&options, NULL, 0), good ? ASJ_OK : ASJ_ERROR_OPTION);
    }
}

static char *read_file(const char *name)
{
    FILE *file = fopen(name, "rb");
    char *text = file ? calloc(1, 1 << 17) : NULL;
    if (text && fread(text, 1, (1 << 17) - 1, file) == 0) {
        free(text);
        text = NULL;
    }
    if (file)
        fclose(file);
    return text;
}

int main(int argument_count, char **arguments)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_match_fields), cmocka_unit_test(test_rows_are_sound),
        cmocka_unit_test(test_header_comments), cmocka_unit_test(test_match_header_comments), cmocka_unit_test(test_presets),
        cmocka_unit_test(test_round_trips),     cmocka_unit_test(test_out_of_range),          cmocka_unit_test(test_field_radius),
    };
    header = argument_count > 2 ? read_file(arguments[1]) : NULL;
    match_header = argument_count > 2 ? read_file(arguments[2]) : NULL;
    if (!header || !match_header) {
        fprintf(stderr, "usage: test_options include/asj/options.h include/asj/match.h\n");
        return 2;
    }
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    free(match_header);
    free(header);
    return failed;
}
