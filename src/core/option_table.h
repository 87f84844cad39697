/* SPDX-License-Identifier: BSD-2-Clause */
/* What every options struct shares: filling, checking, setting and printing fields by the rows of a table, and the macros that
 * write rows. */
#ifndef ASJ_SRC_OPTION_TABLE_H
#define ASJ_SRC_OPTION_TABLE_H

#include <asj/options.h>

#include <stddef.h>

/* A file that holds a table defines OPTIONS_TYPE as its struct before it uses these. `group` says in which step the option acts,
 * `level` is COMMON or ADVANCED, then come unit, range, the values of the presets default, paper and match, and the help. A RENAMED
 * row begins with the name that the option had. */
#define COMMON 0
#define ADVANCED 1
#define OPTION_ROW(group, level, field, type, unit, minimum, maximum, step, standard, paper, match, choices, former, help) \
    {#field, unit, help, choices, type, (uint32_t)offsetof(OPTIONS_TYPE, field), minimum, maximum, standard, paper, match, step, \
     group, former, level, 0}
#define NUMBER(group, level, field, unit, minimum, maximum, standard, paper, match, help) \
    OPTION_ROW(group, level, field, ASJ_OPTION_NUMBER, unit, minimum, maximum, 0, standard, paper, match, NULL, NULL, help)
#define RENAMED_NUMBER(former, group, level, field, unit, minimum, maximum, standard, paper, match, help) \
    OPTION_ROW(group, level, field, ASJ_OPTION_NUMBER, unit, minimum, maximum, 0, standard, paper, match, NULL, former, help)
#define INTEGER(group, level, field, unit, minimum, maximum, standard, paper, match, help) \
    OPTION_ROW(group, level, field, ASJ_OPTION_INTEGER, unit, minimum, maximum, 1, standard, paper, match, NULL, NULL, help)
#define RENAMED_INTEGER(former, group, level, field, unit, minimum, maximum, standard, paper, match, help) \
    OPTION_ROW(group, level, field, ASJ_OPTION_INTEGER, unit, minimum, maximum, 1, standard, paper, match, NULL, former, help)
#define INTEGER_STEPS(group, level, field, unit, minimum, maximum, step, standard, paper, match, help) \
    OPTION_ROW(group, level, field, ASJ_OPTION_INTEGER, unit, minimum, maximum, step, standard, paper, match, NULL, NULL, help)
#define SWITCH(group, level, field, standard, paper, match, help) \
    OPTION_ROW(group, level, field, ASJ_OPTION_SWITCH, "", 0, 1, 1, standard, paper, match, NULL, NULL, help)
#define CHOICE(group, level, field, last, standard, paper, match, words, help) \
    OPTION_ROW(group, level, field, ASJ_OPTION_CHOICE, "", 0, last, 1, standard, paper, match, words, NULL, help)
#define RADII(group, level, field, minimum, maximum, standard, paper, match, help) \
    OPTION_ROW(group, level, field, ASJ_OPTION_RADII, "px", minimum, maximum, 0, standard, paper, match, NULL, NULL, help)

typedef struct asj_option_table {
    const asj_option_info *rows;
    size_t count;
    size_t size; /* of the options struct, in bytes */
} asj_option_table;

/* See asj_detect_options_preset(): zeroes the struct and writes the values of a preset into its fields. */
asj_status asj_option_table_preset(const asj_option_table *table, void *options, int32_t preset);

/* A row, or NULL outside the table. */
const asj_option_info *asj_option_table_row(const asj_option_table *table, size_t index);

/* ASJ_OK, or ASJ_ERROR_OPTION with a sentence about the first field out of range. */
asj_status asj_option_table_check(const asj_option_table *table, const void *options, char *message, size_t message_size);

/* The value of a field. Every one fits a double exactly: integers of 32 bits, bit sets of 31 bits. */
double asj_option_load(const asj_option_info *row, const void *options);

/* See asj_detect_options_set() and asj_detect_options_get(). */
asj_status asj_option_table_set(const asj_option_table *table, void *options, const char *key, const char *text,
                                char *message, size_t message_size);
asj_status asj_option_table_get(const asj_option_table *table, const void *options, const char *key,
                                char *text, size_t text_size);

#endif
