/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli: the library's functions as a program. */
#include "detect.h"
#include "detect_arguments.h"
#include "devices.h"
#include "interrupt.h"
#include "match.h"
#include "match_arguments.h"
#include "message.h"
#include "platform.h"
#include "plot.h"
#include "spelling.h"

#include <asj/io.h>
#include <asj/version.h>

#include <stdio.h>
#include <string.h>

typedef struct command {
    const char *name;
    const char *summary;
    int (*run)(int argc, char **argv, const cli_other *other);
    cli_other other; /* whose options may be meant for this one */
} command;

static const command commands[] = {
    {"detect", "find the junctions in photographs", cli_detect, {"match", cli_match_has_option}},
    {"match", "find the same corners in two photographs", cli_match, {"detect", cli_detect_has_option}},
    {"devices", "list what can compute", cli_devices, {NULL, NULL}},
};
enum { COMMAND_COUNT = sizeof commands / sizeof commands[0] };

static void print_help(void)
{
    fputs("Usage: asj-cli COMMAND [options] ...\n"
          "\n"
          "Anisotropic-scale junctions of indoor photographs: corners of straight edges, each edge with its\n"
          "direction and its own length.\n"
          "\n", stdout);
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        printf("  asj-cli %-10s %s\n", commands[i].name, commands[i].summary);
    fputs("\n"
          "  asj-cli COMMAND --help   how to use a command; asj-cli help COMMAND is the same\n"
          "  asj-cli --version        version, and what this build can do\n"
          "\n"
          "The first try:  asj-cli detect --plot corners.png photo.png\n", stdout);
}

static void print_version(void)
{
    printf("asj-cli %d.%d.%d\n", ASJ_VERSION_MAJOR, ASJ_VERSION_MINOR, ASJ_VERSION_PATCH);
    printf("libasj %s\n", asj_version_string());
    printf("images: %s\n", asj_io_image_formats());
    printf("plots: %s\n", cli_plot_available() ? "PNG, SVG, PDF" : "none (built without cairo)");
}

/* The program takes every library that keeps what it was built with (version.h) and is not older than itself. */
static int check_version(void)
{
    uint32_t library = asj_version();
    const int kept = ASJ_VERSION_MAJOR > 0 ? 16 : 8; /* bits that do not count: MINOR and PATCH, or PATCH alone */
    if (library >> kept == (uint32_t)ASJ_VERSION >> kept && library >= (uint32_t)ASJ_VERSION)
        return 1;
    cli_error("this program was built for libasj %d.%d.%d, but found %s", ASJ_VERSION_MAJOR, ASJ_VERSION_MINOR, ASJ_VERSION_PATCH,
              asj_version_string());
    return 0;
}

/* Whether a file was named: two of them are for match. */
static int is_file(const char *name)
{
    FILE *file = fopen(name, "rb");
    if (file)
        fclose(file);
    return file != NULL || strchr(name, '.') != NULL;
}

/* Which command has this option, which stands before any; NULL: none has. */
static const char *command_of(const char *option)
{
    const size_t dashes = option[1] == '-' ? 2 : 1, length = dashes == 1 ? 1 : strcspn(option + dashes, "=");
    if (cli_detect_has_option(option + dashes, length))
        return "detect";
    return cli_match_has_option(option + dashes, length) ? "match" : NULL;
}

/* With what was probably meant. */
static int say_unknown(int argc, char **argv)
{
    const char *name = argv[1];
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (cli_spelling_is_close(cli_spelling_distance(name, strlen(name), commands[i].name), strlen(name)))
            return cli_usage_error(NULL, "there is no command '%s'; did you mean: asj-cli %s", name, commands[i].name);
    const char *owner = *name == '-' ? command_of(name) : NULL;
    if (owner)
        return cli_usage_error(NULL, "there is no option '%s' before the command; did you mean: asj-cli %s %s%s", name, owner,
                               name, argc > 2 ? " ..." : "");
    if (*name == '-')
        return cli_usage_error(NULL, "there is no option '%s'", name);
    if (is_file(name))
        return cli_usage_error(NULL, "there is no command '%s'; did you mean: asj-cli detect %s%s", name, name,
                               argc > 2 ? " ..." : "");
    return cli_usage_error(NULL, "there is no command '%s'", name);
}

/* argv[1] is a command. */
static int run_named(int argc, char **argv)
{
    for (size_t i = 0; i < COMMAND_COUNT; i++)
        if (strcmp(commands[i].name, argv[1]) == 0)
            return commands[i].run(argc - 1, argv + 1, &commands[i].other);
    return say_unknown(argc, argv);
}

/* "help detect ..." becomes "detect --help ...". */
static int help(int argc, char **argv)
{
    static char option[] = "--help";
    if (argc < 3 || strcmp(argv[2], "--advanced") == 0) {
        print_help();
        return CLI_SUCCESS;
    }
    argv[1] = argv[2];
    argv[2] = option;
    return run_named(argc, argv);
}

static int run_command(int argc, char **argv)
{
    if (argc < 2)
        return cli_usage_error(NULL, "which command?");
    const char *name = argv[1];
    if (strcmp(name, "--help") == 0 || strcmp(name, "-h") == 0 || strcmp(name, "help") == 0)
        return help(argc, argv);
    if (strcmp(name, "--version") == 0) {
        print_version();
        return CLI_SUCCESS;
    }
    return run_named(argc, argv);
}

int main(int argc, char **argv)
{
    cli_hold_streams();
    if (!check_version())
        return CLI_FAILED;
    cli_interrupt_install();
    int result = run_command(argc, argv);
    int closed = cli_close_output();
    return result == CLI_SUCCESS ? closed : result;
}
