/* SPDX-License-Identifier: BSD-2-Clause */
/* The text of --help from the tables of options, in two columns. */
#include "help.h"

#include <stdio.h>
#include <string.h>

enum { HELP_COLUMN = 30, LINE_WIDTH = 100 };

/* Prints `text` from HELP_COLUMN on, broken at spaces and at its own newlines; `used` columns of the first line are taken. */
static void print_column(int used, const char *text)
{
    if (used + 2 > HELP_COLUMN) {
        putchar('\n');
        used = 0;
    }
    while (*text) {
        size_t room = LINE_WIDTH - HELP_COLUMN, length = strcspn(text, "\n");
        if (length > room) {
            length = room;
            while (length > 0 && text[length] != ' ')
                length--;
            if (length == 0)
                length = room;
        }
        printf("%*s%.*s\n", HELP_COLUMN - used, "", (int)length, text);
        used = 0;
        text += length;
        if (*text == ' ' || *text == '\n')
            text++;
    }
}

static void print_option(const cli_option *option)
{
    int used = option->letter ? printf("  -%c, --%s", option->letter, option->name) : printf("      --%s", option->name);
    if (option->argument)
        used += printf(" %s", option->argument);
    print_column(used, option->help);
}

void cli_row_argument(const asj_option_info *row, char *text, size_t text_size)
{
    const char *argument = "N";
    if (row->type == ASJ_OPTION_CHOICE) {
        size_t used = 0;
        for (int i = 0; row->choices[i] && used < text_size; i++)
            used += (size_t)snprintf(text + used, text_size - used, i ? "|%s" : "%s", row->choices[i]);
        return;
    }
    if (row->type == ASJ_OPTION_SWITCH)
        argument = "yes|no";
    if (row->type == ASJ_OPTION_RADII)
        argument = "LIST";
    snprintf(text, text_size, "%s", argument);
}

static void print_row(const cli_syntax *syntax, size_t t, const asj_option_info *row)
{
    const cli_table *table = &syntax->tables[t];
    static const char *const presets[] = {"default", "paper", "match"}; /* in the order of ASJ_PRESET_... */
    char name[CLI_NAME_SIZE], argument[128], values[3][64] = {"", "", ""}, range[96] = "", text[1024];
    cli_option_name(syntax, t, row->key, name);
    cli_row_argument(row, argument, sizeof argument);
    for (int32_t preset = 0; preset < 3; preset++)
        table->value(preset, row->key, values[preset], sizeof values[preset]);
    if (row->type != ASJ_OPTION_SWITCH && row->type != ASJ_OPTION_CHOICE)
        snprintf(range, sizeof range, "%g .. %g%s%s, ", row->minimum, row->maximum, *row->unit ? " " : "", row->unit);
    size_t used = (size_t)snprintf(text, sizeof text, "%s\n(%s%s %s", row->help, range, presets[0], values[0]);
    for (int32_t preset = 1; preset < 3 && used < sizeof text; preset++)
        if (strcmp(values[preset], values[0]) != 0)
            used += (size_t)snprintf(text + used, sizeof text - used, ", %s %s", presets[preset], values[preset]);
    if (used < sizeof text)
        snprintf(text + used, sizeof text - used, ")");
    print_column(printf("      --%s %s", name, argument), text);
}

/* The rows of a table, under a title for each group that shows any. */
static void print_table(const cli_syntax *syntax, size_t t, int advanced)
{
    const cli_table *table = &syntax->tables[t];
    const char *group = "";
    size_t hidden = 0;
    for (size_t i = 0; i < table->count(); i++) {
        const asj_option_info *row = table->row(i);
        hidden += row->advanced && !advanced;
        if (row->advanced && !advanced)
            continue;
        if (strcmp(group, row->group) != 0)
            printf("\n%s, %s\n", table->title, row->group);
        group = row->group;
        print_row(syntax, t, row);
    }
    if (hidden > 0)
        printf("\n%s: %zu options more with --help --advanced\n", table->title, hidden);
}

/* A line for the completions of shells: name, letter, argument, help, with tabs between them. */
static void list_option(const char *name, char letter, const char *argument, const char *help)
{
    printf("%s\t%.*s\t%s\t", name, letter != 0, &letter, argument ? argument : "");
    for (; *help; help++)
        putchar(*help == '\n' ? ' ' : *help);
    putchar('\n');
}

static void list_options(const cli_syntax *syntax)
{
    char name[CLI_NAME_SIZE], argument[128];
    for (size_t g = 0; g < syntax->group_count; g++)
        for (size_t i = 0; i < syntax->groups[g].count; i++) {
            const cli_option *option = &syntax->groups[g].options[i];
            list_option(option->name, option->letter, option->argument, option->help);
        }
    for (size_t t = 0; t < syntax->table_count; t++)
        for (size_t i = 0; i < syntax->tables[t].count(); i++) {
            const asj_option_info *row = syntax->tables[t].row(i);
            cli_option_name(syntax, t, row->key, name);
            cli_row_argument(row, argument, sizeof argument);
            list_option(name, 0, argument, row->help);
        }
}

/* Options may be cut as getopt_long() takes them: down to what no other option begins with. */
static int has_option(int argc, char **argv, const char *name, size_t least)
{
    for (int i = 1; i < argc; i++) {
        const size_t length = strlen(argv[i]);
        if (length >= least && strncmp(argv[i], name, length) == 0)
            return 1;
    }
    return 0;
}

void cli_help(const cli_syntax *syntax, int argc, char **argv)
{
    if (has_option(argc, argv, "--list-options", sizeof "--lis" - 1)) {
        list_options(syntax);
        return;
    }
    const int advanced = has_option(argc, argv, "--advanced", sizeof "--ad" - 1);
    fputs(syntax->introduction, stdout);
    for (size_t g = 0; g < syntax->group_count; g++) {
        printf("\n%s\n", syntax->groups[g].title);
        for (size_t i = 0; i < syntax->groups[g].count; i++)
            print_option(&syntax->groups[g].options[i]);
        if (g + 1 == syntax->group_count)
            print_column(printf("  -h, --help [--advanced]"), "show this text; with --advanced every option");
    }
    for (size_t t = 0; t < syntax->table_count; t++)
        print_table(syntax, t, advanced);
    fputs(syntax->conclusion, stdout);
}
