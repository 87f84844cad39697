/* SPDX-License-Identifier: BSD-2-Clause */
/* The help, the options and the checks of `asj-cli detect`. */
#include "detect_arguments.h"
#include "camera.h"
#include "ending.h"
#include "help.h"
#include "message.h"

#include <asj/io.h>

#include <string.h>

static const char introduction[] =
    "Usage: asj-cli detect [options] IMAGE...\n"
    "\n"
    "Finds the junctions of straight edges in photographs: corners where two to five edges meet, each\n"
    "edge with its direction and its own length. Made for indoor scenes.\n"
    "\n"
    "  asj-cli detect photo.jpg                            junctions to standard output, as text\n"
    "  asj-cli detect -o photo.json --plot photo.svg photo.jpg\n"
    "                                                      everything as JSON, and a picture to look at\n"
    "  asj-cli detect --out-dir out --plot png *.jpg       a result and a plot for every photograph\n"
    "  asj-cli detect --epsilon 0.01 photo.jpg             only the surest junctions\n"
    "  asj-cli detect --lines -o lines.csv photo.jpg       straight edges from end to end, each once\n"
    "  asj-cli detect -o all.jsonl *.jpg                   one line of JSON for every photograph\n"
    "  asj-cli detect -o photo.asjf photo.jpg              features: all that 'asj-cli match' needs of it\n"
    "\n"
    "Images: PNG, PNM, and the formats that asj-cli --version lists. A file that cannot be read is\n"
    "reported and the others are done.\n";

static const char conclusion[] =
    "\n"
    "NFA: expected number of false alarms in an image of noise.\n"
    "\n"
    "Exit status: 0 all images done, 1 some failed, 2 wrong usage, 130 interrupted.\n"
    "More: man asj-cli; all numbers: man asj-options; file formats: man asj-formats\n";

enum {
    OUTPUT, OUT_DIR, KEEP_FOLDERS, SKIP_EXISTING, FILES_FROM, FORMAT, LINES, WHOLE, REGION, MASK, VANISHING_POINTS, CAMERA,
    PLOT, PLOT_COLOR, PLOT_BACKGROUND, PLOT_SCALE, PRESET, FOR
};

static const cli_option output_options[] = {
    {OUTPUT, 'o', "output", "FILE",
     "where the junctions of one image go, or as jsonl of all; - is standard output (the default for one image without a plot, and "
     "for jsonl)"},
    {OUT_DIR, 'd', "out-dir", "DIR",
     "folder for the results of one or several images, made where it is missing: photo.jpg gives DIR/photo.asj"},
    {KEEP_FOLDERS, 0, "keep-folders", NULL, "below DIR the folders of the images: kitchen/photo.jpg gives DIR/kitchen/photo.asj"},
    {SKIP_EXISTING, 0, "skip-existing", NULL,
     "leave out images whose results are in DIR already: to go on where a run has ended, or with more images"},
    {FILES_FROM, 0, "files-from", "FILE",
     "more images: their names, one a line, or as find -print0 writes them; there are no comments, a name may begin with #; - is "
     "standard input"},
    {FORMAT, 'f', "format", "asj|json|jsonl|csv|asjf",
     "asj: text, one record for each pair of branches; json: everything; jsonl: one file of all images, a line of JSON each, also "
     "of those that fail; csv: one line a branch; asjf: features, all that 'asj-cli match' needs of the image. Default: by the end "
     "of FILE, else asj, and with --lines csv"},
    {LINES, 0, "lines", NULL,
     "straight edges from end to end, each once, whichever corners have a branch along it: csv has them in place of the branches, "
     "json beside them; a plot shows them"},
    {WHOLE, 0, "whole", NULL, "asj: whole junctions of two to five branches (json and csv always have them)"},
};

static const cli_option region_options[] = {
    {REGION, 0, "region", "X,Y,WIDTH,HEIGHT",
     "only junctions in this part of the image, px from the top left; branches may leave it"},
    {MASK, 0, "mask", "FILE", "no junction where this 8-bit gray image, of the size of every IMAGE, is black (0)"},
};

static const cli_option direction_options[] = {
    {VANISHING_POINTS, 0, "vanishing-points", NULL,
     "json: where parallel edges of the scene meet, up to three directions; a plot shows which edge has which"},
    {CAMERA, 0, "camera", "FX,FY,CX,CY",
     "focal lengths and principal point, px; pixel centres are at integers (COLMAP's CX and CY less 0.5). Then the directions are "
     "at right angles. Default: the focal length is found where two directions determine it"},
};

static const cli_option plot_options[] = {
    {PLOT, 'p', "plot", "FILE",
     "draw the junctions: FILE.png, FILE.svg or FILE.pdf; with --out-dir only png, svg or pdf: photo.jpg gives DIR/photo.plot.png"},
    {PLOT_COLOR, 0, "plot-color", "nfa|branch|edge|direction",
     "branches, or lines, coloured by how sure they are (the default), or branches by their number, or edges between two junctions "
     "by how sure they are; direction: by the vanishing point that they run to (the default with --vanishing-points)"},
    {PLOT_BACKGROUND, 0, "plot-background", "photo|color|white",
     "over the pale photograph in grey (the default) or in its colours, or on white"},
    {PLOT_SCALE, 0, "plot-scale", "N", "pixels of the plot for one of the image, 0.01 .. 16; default: small images are enlarged"},
};

static const cli_option preset_options[] = {
    {PRESET, 0, "preset", "default|paper|match",
     "start from these values of the options below, wherever this stands: our recommendation, the paper's way, or what "
     "'asj-cli match' detects: weaker junctions too (the default for asjf; without coarse octaves for asj, which cannot "
     "tell them)"},
    {FOR, 0, "for", "matching", "the same as --preset match"},
};

void cli_detect_arguments_free(cli_detect_arguments *arguments)
{
    cli_settings_free(&arguments->settings);
    cli_image_list_free(&arguments->images);
}

static const char *const formats[] = {"asj", "json", "jsonl", "csv", "asjf", NULL};

static int take_output(void *target, int id, const char *text)
{
    cli_detect_arguments *arguments = target;
    switch (id) {
    case OUTPUT: arguments->output = text; break;
    case OUT_DIR: arguments->out_dir = text; break;
    case KEEP_FOLDERS: arguments->keep_folders = 1; break;
    case SKIP_EXISTING: arguments->skip_existing = 1; break;
    case FILES_FROM: arguments->files_from = text; break;
    case LINES: arguments->lines = 1; break;
    case WHOLE: arguments->whole = 1; break;
    default:
        if (cli_find_word(formats, text) < 0)
            return cli_usage_error("detect", "--format: '%s' is not asj, json, jsonl, csv or asjf", text);
        arguments->format = text;
    }
    return CLI_SUCCESS;
}

static int take_region(void *target, int id, const char *text)
{
    cli_detect_arguments *arguments = target;
    if (id == REGION)
        return cli_region_take("detect", "region", text, &arguments->region);
    arguments->region.mask = text;
    return CLI_SUCCESS;
}

static int take_directions(void *target, int id, const char *text)
{
    cli_detect_arguments *arguments = target;
    if (id == CAMERA)
        return cli_take_camera("detect", "camera", text, &arguments->camera);
    arguments->vanishing_points = 1;
    return CLI_SUCCESS;
}

static int take_plot(void *target, int id, const char *text)
{
    static const char *const colors[] = {"nfa", "branch", "edge", "direction", NULL};
    cli_detect_arguments *arguments = target;
    if (id != PLOT)
        arguments->plot_option = plot_options[id - PLOT].name;
    switch (id) {
    case PLOT:
        arguments->plot = text;
        break;
    case PLOT_COLOR:
        if ((arguments->style.color = cli_find_word(colors, text)) < 0)
            return cli_usage_error("detect", "--plot-color: '%s' is not nfa, branch, edge or direction", text);
        arguments->has_color = 1;
        break;
    case PLOT_BACKGROUND:
        return cli_plot_take_background("detect", text, &arguments->style.background);
    default:
        return cli_plot_take_scale("detect", text, &arguments->style.scale);
    }
    return CLI_SUCCESS;
}

static int take_preset(void *target, int id, const char *text)
{
    cli_detect_arguments *arguments = target;
    if (id == FOR) {
        if (strcmp(text, "matching") != 0)
            return cli_usage_error("detect", "--for: '%s' is not matching", text);
        arguments->preset = ASJ_PRESET_MATCH;
        return CLI_SUCCESS;
    }
    return cli_take_preset("detect", "preset", text, &arguments->preset);
}

static int check_plot(cli_detect_arguments *arguments)
{
    if (!arguments->plot)
        return cli_plot_check_without("detect", arguments->plot_option);
    const char *word = arguments->plot;
    if (!arguments->out_dir || !cli_plot_available())
        return cli_plot_format_of_name("detect", word, &arguments->plot_format);
    arguments->plot_format = cli_plot_format_of_word(word);
    if (arguments->plot_format < 0)
        return cli_usage_error("detect", "--plot: with --out-dir it takes png, svg or pdf, not '%s'", word);
    return CLI_SUCCESS;
}

static int is_json(int32_t format)
{
    return format == ASJ_FILE_JSON || format == CLI_FILE_JSON_LINES;
}

static int check_lines(const cli_detect_arguments *arguments)
{
    const int32_t format = cli_detect_file_format(arguments);
    if (arguments->lines && format != ASJ_FILE_CSV && !is_json(format))
        return cli_usage_error("detect", "--lines go into CSV or JSON: --format csv, or --output FILE.json");
    if (arguments->lines && arguments->style.color != CLI_PLOT_COLOR_NFA && arguments->style.color != CLI_PLOT_COLOR_DIRECTION)
        return cli_usage_error("detect", "--plot-color: with --lines it takes nfa or direction");
    return CLI_SUCCESS;
}

static int check_directions(cli_detect_arguments *arguments)
{
    const int wanted = arguments->vanishing_points;
    if (!wanted && arguments->style.color == CLI_PLOT_COLOR_DIRECTION)
        return cli_usage_error("detect", "--plot-color direction takes --vanishing-points");
    if (!wanted && arguments->camera.fx > 0)
        return cli_usage_error("detect", "a camera changes nothing without --vanishing-points");
    if (wanted && !arguments->has_color)
        arguments->style.color = CLI_PLOT_COLOR_DIRECTION;
    const int shown = arguments->plot && arguments->style.color == CLI_PLOT_COLOR_DIRECTION;
    if (wanted && !shown && !is_json(cli_detect_file_format(arguments)))
        return cli_usage_error("detect", "--vanishing-points go into JSON, or a plot: --format json, or --output FILE.json");
    return CLI_SUCCESS;
}

/* Several images need a folder, but that one file can be of all of them. */
static int check_places(const cli_detect_arguments *arguments)
{
    const size_t count = arguments->images.count;
    const int of_all = cli_detect_file_format(arguments) == CLI_FILE_JSON_LINES;
    if (of_all && arguments->out_dir)
        return cli_usage_error("detect", "jsonl is one file of all images: --output FILE in place of --out-dir DIR");
    if (of_all && count > 1 && arguments->plot)
        return cli_usage_error("detect", "--plot: the plots of %zu images need --out-dir DIR, and jsonl goes without", count);
    if (!of_all && count > 1 && !arguments->out_dir)
        return cli_usage_error("detect", "%zu images need --out-dir DIR for their results (or --format jsonl, a line of JSON each)",
                               count);
    return CLI_SUCCESS;
}

/* Options that say how something is written which nobody has asked for. */
static int check_useful(const cli_detect_arguments *arguments)
{
    if ((arguments->format || arguments->whole) && arguments->plot && !arguments->output && !arguments->out_dir)
        return cli_usage_error("detect", "--%s changes nothing: with --plot alone no junctions are written (--output - does)",
                               arguments->format ? "format" : "whole");
    if (arguments->whole && strcmp(cli_detect_extension(arguments), "asj") != 0)
        return cli_usage_error("detect", "--whole changes nothing: it is for asj, where junctions are taken apart else");
    if (arguments->keep_folders && !arguments->out_dir)
        return cli_usage_error("detect", "--keep-folders changes nothing without --out-dir");
    if (arguments->skip_existing && !arguments->out_dir)
        return cli_usage_error("detect", "--skip-existing changes nothing without --out-dir");
    return CLI_SUCCESS;
}

static int check(cli_detect_arguments *arguments)
{
    if (arguments->images.count == 0 && arguments->files_from)
        return cli_usage_error("detect", "--files-from: %s names no image", arguments->files_from);
    if (arguments->images.count == 0)
        return cli_usage_error("detect", "which image?");
    if (arguments->output && arguments->out_dir)
        return cli_usage_error("detect", "--output and --out-dir exclude each other");
    if (arguments->out_dir && !*arguments->out_dir)
        return cli_usage_error("detect", "--out-dir: an empty path names no folder (. is this one)");
    if (check_useful(arguments) != CLI_SUCCESS)
        return CLI_USAGE;
    if (check_places(arguments) != CLI_SUCCESS)
        return CLI_USAGE;
    for (size_t i = 0; i < arguments->images.count; i++)
        if (strcmp(arguments->images.names[i], "-") == 0)
            return cli_usage_error("detect", "images are not read from standard input (a file named - is ./-)");
    int result = cli_common_check(&arguments->common);
    if (result == CLI_SUCCESS)
        result = cli_check_ending("detect", "junctions", arguments->output, arguments->format, formats);
    if (result == CLI_SUCCESS)
        result = check_lines(arguments);
    if (result == CLI_SUCCESS)
        result = check_directions(arguments);
    return result == CLI_SUCCESS ? check_plot(arguments) : result;
}

const char *cli_detect_extension(const cli_detect_arguments *arguments)
{
    if (arguments->format)
        return arguments->format;
    const char *named = cli_format_of_name(arguments->output, formats);
    return named ? named : arguments->lines ? "csv" : "asj";
}

static void choose_preset(cli_detect_arguments *arguments)
{
    const int features = strcmp(cli_detect_extension(arguments), "asjf") == 0;
    if (arguments->preset < 0)
        arguments->preset = features ? ASJ_PRESET_MATCH : ASJ_PRESET_DEFAULT;
    else if (features && arguments->preset == ASJ_PRESET_DEFAULT && !arguments->common.quiet)
        cli_note("asj-cli detect: warning: features of --preset default give fewer matches than those of --preset match");
}

typedef struct detect_syntax {
    cli_group groups[6];
    cli_table table;
    cli_syntax syntax;
} detect_syntax;

static void fill_syntax(cli_detect_arguments *arguments, const cli_other *other, detect_syntax *room)
{
    const cli_group groups[] = {
        {"Results", output_options, sizeof output_options / sizeof output_options[0], take_output, arguments},
        {"Where", region_options, sizeof region_options / sizeof region_options[0], take_region, arguments},
        {"Directions", direction_options, sizeof direction_options / sizeof direction_options[0], take_directions, arguments},
        {"Plot", plot_options, sizeof plot_options / sizeof plot_options[0], take_plot, arguments},
        {"Preset", preset_options, sizeof preset_options / sizeof preset_options[0], take_preset, arguments},
        {"Running", cli_common_options, cli_common_option_count, cli_common_take, &arguments->common},
    };
    memcpy(room->groups, groups, sizeof groups);
    room->table = (cli_table){"Detector", "", asj_detect_option_count, asj_detect_option, cli_detect_option_value,
                              cli_settings_take, &arguments->settings};
    room->syntax = (cli_syntax){"detect", introduction, conclusion, room->groups, sizeof groups / sizeof groups[0], &room->table, 1,
                                other};
}

int cli_detect_has_option(const char *name, size_t length)
{
    cli_detect_arguments arguments;
    detect_syntax room;
    fill_syntax(&arguments, NULL, &room);
    return cli_has_option(&room.syntax, name, length);
}

int cli_detect_arguments_read(int argc, char **argv, const cli_other *other, cli_detect_arguments *arguments)
{
    int first = argc;
    detect_syntax room;
    memset(arguments, 0, sizeof *arguments);
    cli_common_init(&arguments->common, "detect");
    arguments->preset = -1;
    if (!cli_settings_create(&arguments->settings, argc))
        return CLI_FAILED;
    fill_syntax(arguments, other, &room);
    int result = cli_parse(&room.syntax, argc, argv, &first);
    if (result == CLI_HELP)
        cli_help(&room.syntax, argc, argv);
    if (result != CLI_SUCCESS)
        return result;
    result = cli_image_list_make(argv + first, (size_t)(argc - first), arguments->files_from, &arguments->images);
    if (result != CLI_SUCCESS)
        return result;
    choose_preset(arguments);
    asj_detect_options_preset(&arguments->options, arguments->preset);
    /* the file does not say octaves, and the matcher must know which junctions are coarse */
    const int without_octaves = arguments->options.independent_octaves && (arguments->output || arguments->out_dir) &&
                                strcmp(cli_detect_extension(arguments), "asj") == 0;
    if (without_octaves)
        arguments->options.octaves = 1;
    result = cli_settings_apply(&arguments->settings, "detect", arguments->common.quiet, &arguments->options,
                                cli_set_detect_option);
    if (result == CLI_SUCCESS && arguments->options.octaves == 1 && cli_settings_have(&arguments->settings, "half_octaves"))
        return cli_usage_error("detect", "--half-octaves changes nothing with one octave%s",
                               without_octaves ? ", and an .asj file of --preset match has one: write json" : "");
    if (result == CLI_SUCCESS)
        result = cli_check_detector("detect", &arguments->options);
    if (result == CLI_SUCCESS)
        result = check(arguments);
    if (result == CLI_SUCCESS && arguments->output && !arguments->common.quiet)
        cli_warn_ending("detect", arguments->output, arguments->format, cli_detect_extension(arguments));
    return result;
}

int32_t cli_detect_file_format(const cli_detect_arguments *arguments)
{
    const char *extension = cli_detect_extension(arguments);
    if (strcmp(extension, "json") == 0)
        return ASJ_FILE_JSON;
    if (strcmp(extension, "jsonl") == 0)
        return CLI_FILE_JSON_LINES;
    if (strcmp(extension, "csv") == 0)
        return ASJ_FILE_CSV;
    if (strcmp(extension, "asjf") == 0)
        return CLI_FILE_FEATURES;
    return arguments->whole ? ASJ_FILE_ASJ_WHOLE : ASJ_FILE_ASJ;
}
