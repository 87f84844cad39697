/* SPDX-License-Identifier: BSD-2-Clause */
/* getopt_long() over the options written by hand and those of the library's tables. */
#include "parse.h"
#include "message.h"
#include "spelling.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Values that getopt_long() hands back: above every character, in the order of its table. */
enum {
    VALUE_HELP = 1000, VALUE_ADVANCED, VALUE_LIST,
    VALUE_OPTION /* + number of the option, in order of the groups, then of the tables, a former name after its row */
};

typedef struct getopt_tables {
    struct option *long_options; /* help, advanced, list-options, the groups' options, the tables' names, an end mark */
    char *short_options;
    char (*names)[CLI_NAME_SIZE]; /* of the tables' rows, former ones too */
    size_t option_count;          /* options of all groups */
    size_t name_count;            /* of all tables */
} getopt_tables;

static int has_key(const cli_table *table, const char *key)
{
    for (size_t i = 0; i < table->count(); i++)
        if (strcmp(table->row(i)->key, key) == 0)
            return 1;
    return 0;
}

void cli_option_name(const cli_syntax *syntax, size_t table, const char *key, char name[CLI_NAME_SIZE])
{
    int taken = 0;
    for (size_t t = 0; t < table; t++)
        taken |= has_key(&syntax->tables[t], key);
    snprintf(name, CLI_NAME_SIZE, "%s%s%s", taken ? syntax->tables[table].prefix : "", taken ? "-" : "", key);
    for (char *c = name; *c; c++)
        if (*c == '_')
            *c = '-';
}

int cli_find_word(const char *const *words, const char *text)
{
    for (int i = 0; words[i]; i++)
        if (strcmp(words[i], text) == 0)
            return i;
    return -1;
}

int cli_parse_number(const char *text, double minimum, double maximum, double *value)
{
    char *end;
    /* strtod() also takes hexadecimal numbers, "inf" and "nan" */
    if (*text == '\0' || strspn(text, "+-.0123456789eE") != strlen(text))
        return 0;
    *value = strtod(text, &end);
    return *end == '\0' && *value >= minimum && *value <= maximum;
}

static const cli_option *find_option(const cli_syntax *syntax, size_t number, const cli_group **group)
{
    for (size_t g = 0; g < syntax->group_count; g++) {
        *group = &syntax->groups[g];
        if (number < (*group)->count)
            return &(*group)->options[number];
        number -= (*group)->count;
    }
    return NULL;
}

/* The table and the key of a number that counts the names of all tables; NULL after the last one. */
static const char *find_key(const cli_syntax *syntax, size_t number, size_t *table)
{
    for (*table = 0; *table < syntax->table_count; ++*table)
        for (size_t i = 0; i < syntax->tables[*table].count(); i++) {
            const asj_option_info *row = syntax->tables[*table].row(i);
            if (number-- == 0)
                return row->key;
            if (row->former_key && number-- == 0)
                return row->former_key;
        }
    return NULL;
}

static struct option long_option(const char *name, int has_argument, size_t value)
{
    struct option option;
    memset(&option, 0, sizeof option);
    option.name = name;
    option.has_arg = has_argument ? required_argument : no_argument;
    option.val = (int)value;
    return option;
}

static void fill_tables(const cli_syntax *syntax, getopt_tables *tables)
{
    const cli_group *group;
    char *letters = tables->short_options;
    *letters++ = ':'; /* a missing argument is told apart from an unknown option */
    *letters++ = 'h';
    tables->long_options[0] = long_option("help", 0, VALUE_HELP);
    tables->long_options[1] = long_option("advanced", 0, VALUE_ADVANCED);
    tables->long_options[2] = long_option("list-options", 0, VALUE_LIST);
    for (size_t i = 0; i < tables->option_count; i++) {
        const cli_option *option = find_option(syntax, i, &group);
        tables->long_options[3 + i] = long_option(option->name, option->argument != NULL, VALUE_OPTION + i);
        if (option->letter) {
            *letters++ = option->letter;
            if (option->argument)
                *letters++ = ':';
        }
    }
    *letters = '\0';
    for (size_t i = 0; i < tables->name_count; i++) {
        size_t number = tables->option_count + i, table;
        const char *key = find_key(syntax, i, &table);
        cli_option_name(syntax, table, key, tables->names[i]);
        tables->long_options[3 + number] = long_option(tables->names[i], 1, VALUE_OPTION + number);
    }
}

static void free_tables(getopt_tables *tables)
{
    free(tables->long_options);
    free(tables->short_options);
    free(tables->names);
}

static int make_tables(const cli_syntax *syntax, getopt_tables *tables)
{
    memset(tables, 0, sizeof *tables);
    for (size_t g = 0; g < syntax->group_count; g++)
        tables->option_count += syntax->groups[g].count;
    for (size_t table; find_key(syntax, tables->name_count, &table);)
        tables->name_count++;
    tables->long_options = calloc(tables->option_count + tables->name_count + 4, sizeof *tables->long_options);
    tables->short_options = calloc(2 * tables->option_count + 3, 1);
    tables->names = calloc(tables->name_count + 1, sizeof *tables->names);
    if (!tables->long_options || !tables->short_options || !tables->names) {
        free_tables(tables);
        return 0;
    }
    fill_tables(syntax, tables);
    return 1;
}

static int has_name(const getopt_tables *tables, const char *name, size_t length)
{
    for (const struct option *option = tables->long_options; option->name; option++)
        if (strlen(option->name) == length && memcmp(option->name, name, length) == 0)
            return 1;
    return length == 1 && *name && *name != ':' && strchr(tables->short_options, *name) != NULL;
}

int cli_has_option(const cli_syntax *syntax, const char *name, size_t length)
{
    getopt_tables tables;
    if (!make_tables(syntax, &tables))
        return 0;
    const int has = has_name(&tables, name, length);
    free_tables(&tables);
    return has;
}

/* With the names that are spelled most nearly like the first `length` characters of `text`. */
static int say_like(const cli_syntax *syntax, const getopt_tables *tables, const char *text, size_t length)
{
    const char *best = NULL;
    size_t smallest = (size_t)-1;
    for (const struct option *option = tables->long_options; option->name && length > 2; option++) {
        const size_t distance = cli_spelling_distance(text + 2, length - 2, option->name);
        if (distance < smallest && cli_spelling_is_close(distance, length - 2)) {
            smallest = distance;
            best = option->name;
        }
    }
    const int elsewhere = length > 2 && syntax->other->has_option(text + 2, length - 2);
    return cli_usage_error(syntax->command, "there is no option '%s'%s%s%s%s", text, elsewhere ? ": it is one of asj-cli " : "",
                           elsewhere ? syntax->other->command : "", best ? "; did you mean: --" : "", best ? best : "");
}

/* With the names that begin so, or the first of them. */
static int say_ambiguous(const cli_syntax *syntax, const getopt_tables *tables, const char *text, size_t length, size_t beginnings)
{
    enum { MOST = 8 };
    char names[MOST * (CLI_NAME_SIZE + 4) + 16] = "";
    size_t used = 0, n = 0;
    for (const struct option *option = tables->long_options; option->name && n < MOST; option++)
        if (strncmp(option->name, text + 2, length - 2) == 0) {
            const char *before = n == 0 ? "" : n + 1 == beginnings ? " or " : ", ";
            used += (size_t)snprintf(names + used, sizeof names - used, "%s--%.*s", before, CLI_NAME_SIZE - 1, option->name);
            n++;
        }
    return cli_usage_error(syntax->command, "'%s' could be %s%s", text, names, beginnings > MOST ? ", ..." : "");
}

/* What was wrong with the option that getopt_long() stopped at: `text` is "--name" or "--name=value", or holds "-x". */
static int say_unknown(const cli_syntax *syntax, const getopt_tables *tables, const char *text)
{
    if (optopt > 0 && optopt < VALUE_HELP)
        return cli_usage_error(syntax->command, "there is no option '-%c'", optopt);
    if (optopt >= VALUE_HELP)
        return cli_usage_error(syntax->command, "--%s takes no value", tables->long_options[optopt - VALUE_HELP].name);
    size_t length = strcspn(text, "="), beginnings = 0;
    for (const struct option *option = tables->long_options; option->name && length > 2; option++)
        beginnings += strncmp(option->name, text + 2, length - 2) == 0;
    if (beginnings > 1)
        return say_ambiguous(syntax, tables, text, length, beginnings);
    return say_like(syntax, tables, text, length);
}

static int take_option(const cli_syntax *syntax, const getopt_tables *tables, size_t number, const char *text)
{
    const cli_group *group = NULL;
    if (number >= tables->option_count) {
        size_t t;
        const size_t row = number - tables->option_count;
        const char *key = find_key(syntax, row, &t);
        return syntax->tables[t].take(syntax->tables[t].target, key, tables->names[row], text);
    }
    const cli_option *option = find_option(syntax, number, &group);
    return group->take(group->target, option->id, text);
}

static size_t number_of_letter(const cli_syntax *syntax, const getopt_tables *tables, int letter)
{
    const cli_group *group;
    size_t i = 0;
    while (i < tables->option_count && find_option(syntax, i, &group)->letter != letter)
        i++;
    return i;
}

static int parse_with(const cli_syntax *syntax, const getopt_tables *tables, int argc, char **argv)
{
    int value, result = CLI_SUCCESS;
    opterr = 0;
    while (result == CLI_SUCCESS && (value = getopt_long(argc, argv, tables->short_options, tables->long_options, NULL)) != -1) {
        if (value == ':')
            result = cli_usage_error(syntax->command, "%s needs a value", argv[optind - 1]);
        else if (value == '?')
            result = say_unknown(syntax, tables, argv[optind - 1]);
        else if (value == 'h' || (value >= VALUE_HELP && value < VALUE_OPTION))
            result = CLI_HELP;
        else if (value >= VALUE_OPTION)
            result = take_option(syntax, tables, (size_t)(value - VALUE_OPTION), optarg);
        else
            result = take_option(syntax, tables, number_of_letter(syntax, tables, value), optarg);
    }
    return result;
}

int cli_parse(const cli_syntax *syntax, int argc, char **argv, int *first_operand)
{
    getopt_tables tables;
    if (!make_tables(syntax, &tables)) {
        cli_error("out of memory");
        return CLI_FAILED;
    }
    int result = parse_with(syntax, &tables, argc, argv);
    *first_operand = optind;
    free_tables(&tables);
    return result;
}
