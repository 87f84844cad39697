/* SPDX-License-Identifier: BSD-2-Clause */
/* The manual page holds a paragraph for every row of the library's option tables, with range and defaults, and no other.
 * `ninja update-manual` (test_manual asj-options.7 --update) writes these paragraphs anew. */
#include <asj/match.h>
#include <asj/options.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MANUAL_SIZE = 1 << 17, WIDTH = 78 };

static const char *path;

/* A text that grows. */
typedef struct page {
    char text[MANUAL_SIZE];
    size_t used;
} page;

static void add(page *p, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(p->text + p->used, sizeof p->text - p->used, format, arguments);
    va_end(arguments);
    if (length < 0 || (size_t)length >= sizeof p->text - p->used)
        exit(99);
    p->used += (size_t)length;
}

/* Broken into lines; every sentence begins with a capital letter and a new line. */
static void add_sentence(page *p, const char *text)
{
    char sentence[512];
    snprintf(sentence, sizeof sentence, "%s.", text);
    if (sentence[0] >= 'a' && sentence[0] <= 'z')
        sentence[0] = (char)(sentence[0] - 'a' + 'A');
    for (char *line = sentence; *line;) {
        size_t length = strlen(line);
        if (length > WIDTH)
            for (length = WIDTH; length > 0 && line[length] != ' '; length--)
                ;
        add(p, "%.*s\n", (int)length, line);
        line += length + (line[length] == ' ');
    }
}

/* The matcher's options that have a namesake in the detector begin with "match-". */
static int is_detector_key(const char *key)
{
    for (size_t i = 0; i < asj_detect_option_count(); i++)
        if (strcmp(asj_detect_option(i)->key, key) == 0)
            return 1;
    return 0;
}

static void add_head(page *p, const char *prefix, const asj_option_info *row)
{
    add(p, ".It Fl -%s", prefix);
    for (const char *c = row->key; *c; c++)
        add(p, "%c", *c == '_' ? '-' : *c);
    if (row->type == ASJ_OPTION_SWITCH)
        add(p, " Cm yes | Cm no\n");
    else if (row->type == ASJ_OPTION_CHOICE)
        for (int i = 0; row->choices[i]; i++)
            add(p, "%s Cm %s%s", i ? " |" : "", row->choices[i], row->choices[i + 1] ? "" : "\n");
    else
        add(p, " Ar %s\n", row->type == ASJ_OPTION_RADII ? "list" : "n");
}

/* values[preset]: those that differ from the default are told. */
static void add_values(page *p, const asj_option_info *row, char values[3][64])
{
    static const char *const presets[] = {"default", "paper", "match"};
    char text[256] = "";
    int used;
    if (row->type != ASJ_OPTION_SWITCH && row->type != ASJ_OPTION_CHOICE) {
        snprintf(text, sizeof text, "from %g to %g%s%s", row->minimum, row->maximum, *row->unit ? " " : "", row->unit);
        add_sentence(p, text);
    }
    used = snprintf(text, sizeof text, "%s: %s", presets[0], values[0]);
    for (int preset = 1; preset < 3; preset++)
        if (strcmp(values[preset], values[0]) != 0)
            used += snprintf(text + used, sizeof text - (size_t)used, "; %s: %s", presets[preset], values[preset]);
    add_sentence(p, text);
}

/* A heading for each group of options: a list of its own. */
static void add_group(page *p, const asj_option_info *row, const asj_option_info *before)
{
    if (before && strcmp(before->group, row->group) == 0)
        return;
    add(p, "%s.Pp\n", before ? ".El\n" : "");
    snprintf(p->text + p->used, sizeof p->text - p->used, "%s:\n", row->group);
    if (p->text[p->used] >= 'a' && p->text[p->used] <= 'z')
        p->text[p->used] = (char)(p->text[p->used] - 'a' + 'A');
    p->used += strlen(p->text + p->used);
    add(p, ".Bl -tag -width Ds\n");
}

static void add_detect_row(page *p, const asj_option_info *row)
{
    char values[3][64] = {"", "", ""};
    for (int32_t preset = 0; preset < 3; preset++) {
        asj_detect_options options;
        asj_detect_options_preset(&options, preset);
        asj_detect_options_get(&options, row->key, values[preset], sizeof values[preset]);
    }
    add_head(p, "", row);
    add_sentence(p, row->help);
    add_values(p, row, values);
}

static void add_match_row(page *p, const asj_option_info *row)
{
    char values[3][64] = {"", "", ""};
    for (int32_t preset = 0; preset < 3; preset++) {
        asj_match_options options;
        asj_match_options_preset(&options, preset);
        asj_match_options_get(&options, row->key, values[preset], sizeof values[preset]);
    }
    add_head(p, is_detector_key(row->key) ? "match-" : "", row);
    add_sentence(p, row->help);
    add_values(p, row, values);
}

/* The tables, each between two comments of the page. */
static const struct table {
    const char *begin, *end;
    size_t (*count)(void);
    const asj_option_info *(*row)(size_t index);
    void (*add)(page *p, const asj_option_info *row);
} tables[] = {
    {".\\\" Begin of the detector's options", ".\\\" End of the detector's options", asj_detect_option_count, asj_detect_option,
     add_detect_row},
    {".\\\" Begin of the matcher's options", ".\\\" End of the matcher's options", asj_match_option_count, asj_match_option,
     add_match_row},
};
enum { TABLES = sizeof tables / sizeof tables[0] };

static void add_table(page *p, const struct table *table)
{
    for (size_t i = 0; i < table->count(); i++) {
        add_group(p, table->row(i), i > 0 ? table->row(i - 1) : NULL);
        table->add(p, table->row(i));
    }
    add(p, ".El\n");
}

static void read_manual(page *p)
{
    FILE *file = fopen(path, "rb");
    p->used = file ? fread(p->text, 1, sizeof p->text - 1, file) : 0;
    p->text[p->used] = '\0';
    if (file)
        fclose(file);
}

/* Where a table begins and ends in the page. */
static void find_table(page *p, const struct table *table, char **begin, char **end)
{
    *begin = strstr(p->text, table->begin);
    *begin = *begin ? strchr(*begin, '\n') : NULL;
    *end = *begin ? strstr(*begin, table->end) : NULL;
    if (!*end) {
        fprintf(stderr, "%s: no such page, or without the comment '%s'\n", path, *begin ? table->end : table->begin);
        exit(99);
    }
    ++*begin;
}

static page manual, expected;

static void expect_table(const struct table *table)
{
    char *begin, *end;
    read_manual(&manual);
    find_table(&manual, table, &begin, &end);
    *end = '\0';
    assert_true(table->count() > 0);
    for (size_t i = 0; i < table->count(); i++) {
        expected.used = 0;
        table->add(&expected, table->row(i));
        if (!strstr(begin, expected.text))
            print_error("%s should have:\n%s(ninja update-manual writes it)\n", path, expected.text);
        assert_non_null(strstr(begin, expected.text));
    }
    expected.used = 0;
    add_table(&expected, table);
    assert_string_equal(begin, expected.text);
}

static void the_option_tables_are_in_the_manual(void **state)
{
    (void)state;
    for (size_t t = 0; t < TABLES; t++)
        expect_table(&tables[t]);
}

static int update(void)
{
    char *begin, *end, *rest;
    read_manual(&manual);
    rest = manual.text;
    expected.used = 0;
    for (size_t t = 0; t < TABLES; t++) {
        find_table(&manual, &tables[t], &begin, &end);
        add(&expected, "%.*s", (int)(begin - rest), rest);
        add_table(&expected, &tables[t]);
        rest = end;
    }
    FILE *file = fopen(path, "wb");
    if (!file)
        return 1;
    fputs(expected.text, file);
    fputs(rest, file);
    return fclose(file) != 0;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_option_tables_are_in_the_manual)};
    if (argc < 2)
        return 99;
    path = argv[1];
    if (argc > 2 && strcmp(argv[2], "--update") == 0)
        return update();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
