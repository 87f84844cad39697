/* SPDX-License-Identifier: BSD-2-Clause */
/* Options of a command: rows written by hand in groups, and rows of the library's option tables. From the same rows come
 * the table for getopt_long() and the text of --help. */
#ifndef ASJ_CLI_PARSE_H
#define ASJ_CLI_PARSE_H

#include <asj/options.h>

typedef struct cli_option {
    int id;               /* what `take` is told */
    char letter;          /* -o, or 0 */
    const char *name;     /* without the dashes */
    const char *argument; /* "FILE"; NULL = the option takes none */
    const char *help;     /* may hold newlines */
} cli_option;

typedef struct cli_group {
    const char *title;
    const cli_option *options;
    size_t count;
    int (*take)(void *target, int id, const char *text); /* CLI_SUCCESS, or CLI_USAGE after saying why */
    void *target;
} cli_group;

/* One of the library's option tables. */
typedef struct cli_table {
    const char *title;
    const char *prefix; /* goes before names that a table before this one has too: "match" makes --match-max-move */
    size_t (*count)(void);
    const asj_option_info *(*row)(size_t index);
    asj_status (*value)(int32_t preset, const char *key, char *text, size_t text_size); /* value of an option in a preset */
    /* the key may be a former one; `name` is what it is called on the command line */
    int (*take)(void *target, const char *key, const char *name, const char *text);
    void *target;
} cli_table;

/* Another command, which may have an option that this one lacks. */
typedef struct cli_other {
    const char *command;
    int (*has_option)(const char *name, size_t length); /* cli_has_option() with its syntax */
} cli_other;

typedef struct cli_syntax {
    const char *command;      /* "detect" */
    const char *introduction; /* of the help: synopsis, what it does, examples */
    const char *conclusion;   /* of the help */
    const cli_group *groups;
    size_t group_count;
    const cli_table *tables;
    size_t table_count;
    const cli_other *other;
} cli_syntax;

/* Longest name of a table row on the command line, with its end. */
#define CLI_NAME_SIZE 64

/* What an option of tables[table] is called on the command line: "minimum_length" -> "minimum-length", after the prefix where a
 * table before has the same key. */
void cli_option_name(const cli_syntax *syntax, size_t table, const char *key, char name[CLI_NAME_SIZE]);

/* Calls `take` for every option of argv[1 .. argc-1], in order, and moves the operands to the end: *first_operand is the index of
 * the first. Returns CLI_SUCCESS, CLI_HELP (--help, --advanced or --list-options was met; the rest is not looked at), CLI_USAGE or
 * CLI_FAILED (no memory). May be called once. */
int cli_parse(const cli_syntax *syntax, int argc, char **argv, int *first_operand);

/* Whether there is an option of exactly that name, `length` characters without the dashes, or of that letter. */
int cli_has_option(const cli_syntax *syntax, const char *name, size_t length);

/* The words of a choice: index of `text` in the NULL-terminated `words`, or -1. */
int cli_find_word(const char *const *words, const char *text);

/* A decimal number that is the whole of `text`, in [minimum, maximum]: 1 = found. */
int cli_parse_number(const char *text, double minimum, double maximum, double *value);

#endif
