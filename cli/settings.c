/* SPDX-License-Identifier: BSD-2-Clause */
/* Options kept in order until the preset is known, then set. */
#include "settings.h"
#include "message.h"

#include <asj/match.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int cli_settings_create(cli_settings *settings, int argc)
{
    settings->count = 0;
    settings->list = calloc((size_t)argc + 1, sizeof *settings->list);
    if (!settings->list)
        cli_error("out of memory");
    return settings->list != NULL;
}

void cli_settings_free(cli_settings *settings)
{
    free(settings->list);
    settings->list = NULL;
    settings->count = 0;
}

int cli_settings_take(void *target, const char *key, const char *name, const char *text)
{
    cli_settings *settings = target;
    cli_setting *setting = &settings->list[settings->count++];
    setting->key = key;
    setting->text = text;
    snprintf(setting->name, sizeof setting->name, "%s", name);
    return CLI_SUCCESS;
}

int cli_settings_have(const cli_settings *settings, const char *key)
{
    for (size_t i = 0; i < settings->count; i++)
        if (strcmp(settings->list[i].key, key) == 0)
            return 1;
    return 0;
}

int cli_take_preset(const char *command, const char *option, const char *text, int32_t *preset)
{
    static const char *const presets[] = {"default", "paper", "match", NULL}; /* in the order of ASJ_PRESET_... */
    int word = cli_find_word(presets, text);
    if (word < 0)
        return cli_usage_error(command, "--%s: '%s' is not default, paper or match", option, text);
    *preset = word;
    return CLI_SUCCESS;
}

asj_status cli_detect_option_value(int32_t preset, const char *key, char *text, size_t text_size)
{
    asj_detect_options options;
    const asj_status status = asj_detect_options_preset(&options, preset);
    return status == ASJ_OK ? asj_detect_options_get(&options, key, text, text_size) : status;
}

asj_status cli_match_option_value(int32_t preset, const char *key, char *text, size_t text_size)
{
    asj_match_options options;
    const asj_status status = asj_match_options_preset(&options, preset);
    return status == ASJ_OK ? asj_match_options_get(&options, key, text, text_size) : status;
}

asj_status cli_set_detect_option(void *options, const char *key, const char *text, char *message, size_t message_size)
{
    return asj_detect_options_set(options, key, text, message, message_size);
}

asj_status cli_set_match_option(void *options, const char *key, const char *text, char *message, size_t message_size)
{
    return asj_match_options_set(options, key, text, message, message_size);
}

/* The library's sentence begins with its key, which two tables may have: here with what was typed. */
static int refuse(const char *command, const cli_setting *setting, const char *message)
{
    const char *end = strchr(message, ':');
    return end ? cli_usage_error(command, "--%s%s", setting->name, end) : cli_usage_error(command, "%s", message);
}

int cli_settings_apply(const cli_settings *settings, const char *command, int quiet, void *options,
                       asj_status (*set)(void *options, const char *key, const char *text, char *message, size_t message_size))
{
    char message[256];
    for (size_t i = 0; i < settings->count; i++) {
        if (set(options, settings->list[i].key, settings->list[i].text, message, sizeof message) != ASJ_OK)
            return refuse(command, &settings->list[i], message);
        if (*message && !quiet)
            cli_note("asj-cli %s: warning: %s", command, message);
    }
    return CLI_SUCCESS;
}

int cli_check_detector(const char *command, const asj_detect_options *options)
{
    int32_t radii = 0;
    for (uint32_t left = options->isotropic_radii; left; left &= left - 1)
        radii++;
    if (options->isotropic_persistence > radii)
        return cli_usage_error(command, "--isotropic-persistence %d finds nothing with %d --isotropic-radii",
                               (int)options->isotropic_persistence, (int)radii);
    if (options->refinement == ASJ_REFINE_SEARCH && options->complete_junctions)
        return cli_usage_error(command, "--complete-junctions changes nothing with --refinement search, nor with --preset paper");
    return CLI_SUCCESS;
}
