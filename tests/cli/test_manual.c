/* SPDX-License-Identifier: BSD-2-Clause */
/* The manual page holds a paragraph for every row of the library's option table, with range and defaults, and no other.
 * `ninja update-manual` (test_manual asj-cli.1 --update) writes these paragraphs anew. */
#include <asj/options.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#define BEGIN ".\\\" Begin of the option table"
#define END ".\\\" End of the option table"
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

static void add_head(page *p, const asj_option_info *row)
{
    add(p, ".It Fl -");
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

static void add_row(page *p, const asj_option_info *row)
{
    asj_detect_options options;
    char standard[64] = "", paper[64] = "", values[256] = "";
    asj_detect_options_preset(&options, ASJ_PRESET_DEFAULT);
    asj_detect_options_get(&options, row->key, standard, sizeof standard);
    asj_detect_options_preset(&options, ASJ_PRESET_PAPER);
    asj_detect_options_get(&options, row->key, paper, sizeof paper);
    add_head(p, row);
    add_sentence(p, row->help);
    if (row->type != ASJ_OPTION_SWITCH && row->type != ASJ_OPTION_CHOICE) {
        snprintf(values, sizeof values, "from %g to %g%s%s", row->minimum, row->maximum, *row->unit ? " " : "", row->unit);
        add_sentence(p, values);
    }
    snprintf(values, sizeof values, strcmp(standard, paper) == 0 ? "default: %s" : "default: %s; paper: %s", standard, paper);
    add_sentence(p, values);
}

static void add_table(page *p)
{
    for (size_t i = 0; i < asj_detect_option_count(); i++)
        add_row(p, asj_detect_option(i));
}

/* The page up to the table, the table, and the rest. */
static void read_manual(page *p, char **begin, char **end)
{
    FILE *file = fopen(path, "rb");
    p->used = file ? fread(p->text, 1, sizeof p->text - 1, file) : 0;
    p->text[p->used] = '\0';
    if (file)
        fclose(file);
    *begin = strstr(p->text, BEGIN);
    *begin = *begin ? strchr(*begin, '\n') : NULL;
    *end = strstr(p->text, END);
    if (!*begin || !*end || *end < *begin) {
        fprintf(stderr, "%s: no such page, or without the two comments around the option table\n", path);
        exit(99);
    }
    ++*begin;
}

static page manual, expected;

static void the_option_table_is_in_the_manual(void **state)
{
    (void)state;
    char *begin, *end;
    read_manual(&manual, &begin, &end);
    for (size_t i = 0; i < asj_detect_option_count(); i++) {
        expected.used = 0;
        add_row(&expected, asj_detect_option(i));
        if (!strstr(begin, expected.text))
            print_error("%s should have:\n%s(ninja update-manual writes it)\n", path, expected.text);
        assert_non_null(strstr(begin, expected.text));
    }
    *end = '\0';
    expected.used = 0;
    add_table(&expected);
    assert_string_equal(begin, expected.text);
}

static int update(void)
{
    char *begin, *end;
    read_manual(&manual, &begin, &end);
    add_table(&expected);
    FILE *file = fopen(path, "wb");
    if (!file)
        return 1;
    fwrite(manual.text, 1, (size_t)(begin - manual.text), file);
    fputs(expected.text, file);
    fputs(end, file);
    return fclose(file) != 0;
}

int main(int argc, char **argv)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(the_option_table_is_in_the_manual)};
    if (argc < 2)
        return 99;
    path = argv[1];
    if (argc > 2 && strcmp(argv[2], "--update") == 0)
        return update();
    return cmocka_run_group_tests(tests, NULL, NULL);
}
