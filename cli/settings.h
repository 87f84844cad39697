/* SPDX-License-Identifier: BSD-2-Clause */
/* Options of one of the library's tables as they stand on the command line, kept until the preset is known that they change. */
#ifndef ASJ_CLI_SETTINGS_H
#define ASJ_CLI_SETTINGS_H

#include "parse.h"

#include <asj/options.h>

typedef struct cli_setting {
    const char *key;
    const char *text;
    char name[CLI_NAME_SIZE]; /* "match-max-move": the key as it is called on the command line */
} cli_setting;

typedef struct cli_settings {
    cli_setting *list;
    size_t count;
} cli_settings;

/* Room for every option of a line of `argc` words. 0 = no memory, which is said. */
int cli_settings_create(cli_settings *settings, int argc);
void cli_settings_free(cli_settings *settings);

/* The `take` of a cli_table. */
int cli_settings_take(void *settings, const char *key, const char *name, const char *text);

/* Is this option among them? */
int cli_settings_have(const cli_settings *settings, const char *key);

/* Options of the detector that contradict each other: CLI_SUCCESS, or CLI_USAGE after saying which. */
int cli_check_detector(const char *command, const asj_detect_options *options);

/* "default", "paper" or "match" as ASJ_PRESET_...; CLI_SUCCESS, or CLI_USAGE after saying why, with the name of the option. */
int cli_take_preset(const char *command, const char *option, const char *text, int32_t *preset);

/* The `value` of a cli_table: that of an option in a preset. */
asj_status cli_detect_option_value(int32_t preset, const char *key, char *text, size_t text_size);
asj_status cli_match_option_value(int32_t preset, const char *key, char *text, size_t text_size);

/* For cli_settings_apply(): one option of asj_detect_options or asj_match_options. */
asj_status cli_set_detect_option(void *options, const char *key, const char *text, char *message, size_t message_size);
asj_status cli_set_match_option(void *options, const char *key, const char *text, char *message, size_t message_size);

/* Sets them all, in order. CLI_SUCCESS, or CLI_USAGE after saying why. Former names give a warning, unless `quiet`. */
int cli_settings_apply(const cli_settings *settings, const char *command, int quiet, void *options,
                       asj_status (*set)(void *options, const char *key, const char *text, char *message, size_t message_size));

#endif
