/* SPDX-License-Identifier: BSD-2-Clause */
/* The command line of `asj-cli match`. */
#ifndef ASJ_CLI_MATCH_ARGUMENTS_H
#define ASJ_CLI_MATCH_ARGUMENTS_H

#include "common.h"
#include "parse.h"
#include "plot_match.h"
#include "region.h"
#include "settings.h"

#include <asj/match.h>

/* Where focal lengths come from that --camera1 and --camera2 do not say. */
enum { CLI_FOCAL_AUTO = 0 /* EXIF data, if both images have them */, CLI_FOCAL_GIVEN, CLI_FOCAL_EXIF, CLI_FOCAL_ESTIMATE,
       CLI_FOCAL_NONE };
#define CLI_EXIF_FOCAL_SD 0.05 /* as the help says */
#define CLI_LARGEST_FOCAL_SD 0.25

typedef struct cli_match_arguments {
    cli_common common;
    asj_detect_options detect_options;
    asj_match_options options;
    int32_t detect_preset, match_preset; /* ASJ_PRESET_...; -1 until all options are read = `preset` */
    int32_t preset;
    cli_settings detect_settings, match_settings;
    const char *output;       /* -o; NULL = none */
    const char *format;       /* "csv", "json"; NULL = by the name of `output` */
    const char *junctions[2]; /* files; NULL = detect */
    cli_region regions[2];    /* where junctions are detected */
    asj_stretch stretch;      /* of both images, if `look` says so; 0 = automatic */
    int look;                 /* both images are looked at together, for asj_match_images() */
    int stretch_given;
    int32_t geometry;         /* ASJ_GEOMETRY_... */
    asj_camera cameras[2];    /* fx 0 = not given */
    int32_t focal_from;       /* CLI_FOCAL_... */
    double focal;             /* px, CLI_FOCAL_GIVEN */
    double focal_sd;          /* of the log of focal lengths; -1 = by where they come from */
    int32_t lines;            /* ASJ_LINES_... */
    int join_lines;
    int32_t minimum_end;      /* ASJ_END_...; -1 until all options are read = inner */
    const char *plot;         /* a file; NULL = none */
    int32_t plot_format;      /* CLI_PLOT_... */
    cli_plot_match_style style;
    const char *plot_option;  /* the name of one that says how the plot looks; NULL = none was given */
    const char *images[2];
} cli_match_arguments;

/* The words of --format, up to NULL. */
extern const char *const cli_match_formats[];

/* Reads argv[1 ..] (argv[0] is "match"); match_checks.h says what goes with what. CLI_SUCCESS, CLI_HELP after printing the help,
 * CLI_USAGE or CLI_FAILED after saying why. cli_match_arguments_free() in every case. */
int cli_match_arguments_read(int argc, char **argv, const cli_other *other, cli_match_arguments *arguments);
void cli_match_arguments_free(cli_match_arguments *arguments);

/* Whether `asj-cli match` has an option of that name, `length` characters without the dashes. */
int cli_match_has_option(const char *name, size_t length);

/* ASJ_FILE_CSV or ASJ_FILE_JSON */
int32_t cli_match_file_format(const cli_match_arguments *arguments);

#endif
