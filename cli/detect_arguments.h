/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of `asj-cli detect`. */
#ifndef ASJ_CLI_DETECT_ARGUMENTS_H
#define ASJ_CLI_DETECT_ARGUMENTS_H

#include "common.h"
#include "image_list.h"
#include "parse.h"
#include "plot.h"
#include "region.h"
#include "settings.h"

#include <asj/options.h>
#include <asj/vanishing.h>

typedef struct cli_detect_arguments {
    cli_common common;
    asj_detect_options options;
    int32_t preset;
    cli_settings settings;
    const char *output;    /* -o; NULL = none */
    const char *out_dir;   /* NULL = none */
    int keep_folders;      /* results stand in the folders of their images, below out_dir */
    const char *format;    /* "asj", "json", "jsonl", "csv", "asjf"; NULL = by the name of `output` */
    int whole;
    int lines;             /* straight edges: CSV and plot have them in place of the branches, JSON beside them */
    int vanishing_points;  /* into JSON and the plot */
    asj_camera camera;     /* fx = 0: not known */
    cli_region region;
    const char *plot;      /* a file, or with out_dir a format; NULL = none */
    int32_t plot_format;   /* CLI_PLOT_... */
    cli_plot_style style;
    int has_color;         /* --plot-color was given */
    const char *plot_option; /* the name of one that says how the plot looks; NULL = none was given */
    const char *files_from; /* NULL = none */
    int skip_existing;     /* images that have their results in out_dir are left out */
    cli_image_list images;
} cli_detect_arguments;

/* Reads argv[1 ..] (argv[0] is "detect"). CLI_SUCCESS, CLI_HELP after printing the help, CLI_USAGE or CLI_FAILED after saying why.
 * cli_detect_arguments_free() in every case. */
int cli_detect_arguments_read(int argc, char **argv, const cli_other *other, cli_detect_arguments *arguments);
void cli_detect_arguments_free(cli_detect_arguments *arguments);

/* Whether `asj-cli detect` has an option of that name, `length` characters without the dashes. */
int cli_detect_has_option(const char *name, size_t length);

/* The format of the result files: ASJ_FILE_... or one of these, and the end of their names. */
#define CLI_FILE_FEATURES 100
#define CLI_FILE_JSON_LINES 101 /* all images in one file */
int32_t cli_detect_file_format(const cli_detect_arguments *arguments);
const char *cli_detect_extension(const cli_detect_arguments *arguments);

#endif
