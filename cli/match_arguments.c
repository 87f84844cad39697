/* SPDX-License-Identifier: BSD-2-Clause */
/* The help and the options of `asj-cli match`; what goes with what: match_checks.c. */
#include "match_arguments.h"
#include "camera.h"
#include "ending.h"
#include "help.h"
#include "message.h"

#include <asj/io.h>

#include <string.h>

static const char introduction[] =
    "Usage: asj-cli match [options] IMAGE1 IMAGE2\n"
    "\n"
    "Finds the corners that two photographs of a room have in common: their junctions, taken apart into\n"
    "pairs of branches, with the affine map from one photograph to the other and the ends of the branches.\n"
    "\n"
    "  asj-cli match left.jpg right.jpg                    matches to standard output, as CSV\n"
    "  asj-cli match -o m.json --plot m.png left.jpg right.jpg\n"
    "                                                      everything as JSON, and a picture to look at\n"
    "  asj-cli match --lines -o lines.csv left.jpg right.jpg\n"
    "                                                      line segments that correspond\n"
    "  asj-cli match --junctions1 a.asj --junctions2 b.asj a.png b.png\n"
    "                                                      junctions from files instead of the detector\n"
    "  asj-cli match a.asjf b.asjf                         features that 'asj-cli detect -o a.asjf' wrote:\n"
    "                                                      each image is looked at once, for any number of pairs\n";

static const char conclusion[] =
    "\n"
    "Options of the detector have the names that they have in 'asj-cli detect'. An option of the matcher whose\n"
    "name the detector has too begins with --match-. The detector starts from its preset match.\n"
    "\n"
    "NFA: expected number of false alarms in an image of noise.\n"
    "\n"
    "Exit status: 0 done (no match is a result too), 1 failed (no file is half written), 2 wrong usage, 130 interrupted.\n"
    "More: man asj-cli; all numbers: man asj-options; file formats: man asj-formats\n";

enum {
    OUTPUT, FORMAT, LINES, LINE_ENDS, JOIN_LINES, JUNCTIONS_1, JUNCTIONS_2, REGION_1, REGION_2, MASK_1, MASK_2, STRETCH, PLOT,
    PLOT_BACKGROUND, PLOT_LINES, PLOT_EPIPOLAR, PLOT_LAYOUT, PLOT_SCALE, PRESET, DETECT_PRESET, MATCH_PRESET, GEOMETRY, CAMERA_1,
    CAMERA_2, FOCAL, FOCAL_SD
};

static const cli_option output_options[] = {
    {OUTPUT, 'o', "output", "FILE", "where the matches go; - is standard output (the default without a plot)"},
    {FORMAT, 'f', "format", "csv|json", "csv: one line a match; json: everything. Default: by the end of FILE, else csv"},
    {LINES, 0, "lines", NULL, "line segments: csv has them in place of the matches, json beside them; a plot shows them"},
    {LINE_ENDS, 0, "line-ends", "cut|inner|both",
     "line segments whose far ends are known at least so well. both: both branches end there, as the matches around see it; "
     "inner (the default): also where the end of one is a corner further inside the other; cut: all, the longer one cut to fit"},
    {JOIN_LINES, 0, "join-lines", NULL, "line segments that are parts of one edge, from each of its corners, as one"},
};

static const cli_option input_options[] = {
    {JUNCTIONS_1, 0, "junctions1", "FILE", "junctions of IMAGE1, .asj or JSON, instead of detecting them"},
    {JUNCTIONS_2, 0, "junctions2", "FILE", "the same for IMAGE2"},
    {REGION_1, 0, "region1", "X,Y,WIDTH,HEIGHT", "detect only in this part of IMAGE1, px from the top left; branches may leave it"},
    {REGION_2, 0, "region2", "X,Y,WIDTH,HEIGHT", "the same for IMAGE2"},
    {MASK_1, 0, "mask1", "FILE", "no junction where this 8-bit gray image, of the size of IMAGE1, is black (0)"},
    {MASK_2, 0, "mask2", "FILE", "the same for IMAGE2"},
    {STRETCH, 0, "stretch", "N|X,Y|auto",
     "look at both images enlarged N times (2: about three times the matches, in three to eight times the time; 1: as they "
     "are), or stretched along each axis (1,3: surfaces seen at a glancing angle, like things on a table). auto, the default of "
     "two whole images: as they are; from --upsample-from matches on also upsampled, where these hold; and where nothing comes of "
     "it by 1,3 and 3,1, then also upsampled"},
};

static const cli_option geometry_options[] = {
    {GEOMETRY, 0, "geometry", "auto|essential|fundamental|homography|none",
     "estimate what relates the two views, and let it decide which matches hold; json has its matrix, the pose where cameras are "
     "known, and how probable each match is; none is the default"},
    {CAMERA_1, 0, "camera1", "FX,FY,CX,CY",
     "focal lengths and principal point of the camera of IMAGE1, px; pixel centres are at integers (COLMAP's CX and CY less 0.5)"},
    {CAMERA_2, 0, "camera2", "FX,FY,CX,CY", "the same for IMAGE2"},
    {FOCAL, 0, "focal", "F|exif|estimate|none",
     "focal length of both cameras, px, with the middle of the image as principal point; exif: each image's own, an error "
     "without; estimate: found with the motion. By default EXIF data count where both images have them; none: they do not"},
    {FOCAL_SD, 0, "focal-sd", "S",
     "how well focal lengths are known, 0.05: to 5 % (a standard deviation). Above 0 the factor by which both are out is found "
     "with the motion; 0.05 is the default where both are from EXIF data, else 0 (exactly)"},
};

static const cli_option plot_options[] = {
    {PLOT, 'p', "plot", "FILE", "draw both photographs with the matches: FILE.png, FILE.svg or FILE.pdf"},
    {PLOT_BACKGROUND, 0, "plot-background", "photo|color|white",
     "over the pale photographs in grey (the default) or in their colours, or on white"},
    {PLOT_LINES, 0, "plot-lines", "yes|no", "lines from one photograph to the other; yes is the default"},
    {PLOT_EPIPOLAR, 0, "plot-epipolar", "yes|no",
     "epipolar lines of up to 60 matches, where --geometry found an epipolar geometry; no is the default"},
    {PLOT_LAYOUT, 0, "plot-layout", "auto|beside|below",
     "where the second photograph stands; auto (the default): what fits a screen"},
    {PLOT_SCALE, 0, "plot-scale", "N", "pixels of the plot for one of an image, 0.01 .. 16; default: small images are enlarged"},
};

static const cli_option preset_options[] = {
    {PRESET, 0, "preset", "match|paper",
     "start from these values of the options below, wherever this stands: our recommendation for matching (the default), or the "
     "paper's way"},
    {DETECT_PRESET, 0, "detect-preset", "match|default|paper",
     "the same for the detector alone; preset default is that of 'asj-cli detect'"},
    {MATCH_PRESET, 0, "match-preset", "match|paper", "the same for the matcher alone"},
};

void cli_match_arguments_free(cli_match_arguments *arguments)
{
    cli_settings_free(&arguments->detect_settings);
    cli_settings_free(&arguments->match_settings);
}

const char *const cli_match_formats[] = {"csv", "json", NULL};

static int take_output(void *target, int id, const char *text)
{
    static const char *const ends[] = {"cut", "inner", "both", NULL}; /* in the order of ASJ_END_... */
    cli_match_arguments *arguments = target;
    switch (id) {
    case OUTPUT: arguments->output = text; break;
    case LINES: arguments->lines = ASJ_LINES_BRANCHES; break;
    case JOIN_LINES: arguments->join_lines = 1; break;
    case LINE_ENDS:
        if ((arguments->minimum_end = cli_find_word(ends, text)) < 0)
            return cli_usage_error("match", "--line-ends: '%s' is not cut, inner or both", text);
        break;
    default:
        if (cli_find_word(cli_match_formats, text) < 0)
            return cli_usage_error("match", "--format: '%s' is not csv or json", text);
        arguments->format = text;
    }
    return CLI_SUCCESS;
}

/* N, X,Y or auto */
static int take_stretch(const char *text, cli_match_arguments *arguments)
{
    char copy[64] = "";
    arguments->look = arguments->stretch_given = 1;
    arguments->stretch = (asj_stretch){0, 0};
    if (strcmp(text, "auto") == 0)
        return CLI_SUCCESS;
    const char *comma = strchr(text, ',');
    const size_t length = comma ? (size_t)(comma - text) : strlen(text);
    if (length < sizeof copy)
        memcpy(copy, text, length);
    if (!cli_parse_number(copy, ASJ_MIN_STRETCH, ASJ_MAX_STRETCH, &arguments->stretch.x) ||
        !cli_parse_number(comma ? comma + 1 : copy, ASJ_MIN_STRETCH, ASJ_MAX_STRETCH, &arguments->stretch.y))
        return cli_usage_error("match", "--stretch: '%s' is not a factor of %g to %d, one for each axis, or auto", text,
                               ASJ_MIN_STRETCH, ASJ_MAX_STRETCH);
    return CLI_SUCCESS;
}

static int take_input(void *target, int id, const char *text)
{
    cli_match_arguments *arguments = target;
    switch (id) {
    case REGION_1: return cli_region_take("match", "region1", text, &arguments->regions[0]);
    case REGION_2: return cli_region_take("match", "region2", text, &arguments->regions[1]);
    case MASK_1:
    case MASK_2: arguments->regions[id == MASK_2].mask = text; break;
    case STRETCH: return take_stretch(text, arguments);
    default: arguments->junctions[id == JUNCTIONS_2] = text;
    }
    return CLI_SUCCESS;
}

static int take_focal(const char *text, cli_match_arguments *arguments)
{
    static const char *const sources[] = {"exif", "estimate", "none", NULL}; /* from CLI_FOCAL_EXIF on */
    const int32_t source = cli_find_word(sources, text);
    arguments->focal_from = source < 0 ? CLI_FOCAL_GIVEN : CLI_FOCAL_EXIF + source;
    if (source < 0 && !cli_parse_number(text, 1, CLI_LONGEST_FOCAL, &arguments->focal))
        return cli_usage_error("match", "--focal: '%s' is not a length in px, 1 to %g, or exif, estimate or none", text,
                               (double)CLI_LONGEST_FOCAL);
    return CLI_SUCCESS;
}

static int take_geometry(void *target, int id, const char *text)
{
    static const char *const models[] = {"none", "auto", "essential", "fundamental", "homography", NULL}; /* as ASJ_GEOMETRY_... */
    cli_match_arguments *arguments = target;
    switch (id) {
    case GEOMETRY:
        if ((arguments->geometry = cli_find_word(models, text)) < 0)
            return cli_usage_error("match", "--geometry: '%s' is not auto, essential, fundamental, homography or none", text);
        break;
    case CAMERA_1: return cli_take_camera("match", "camera1", text, &arguments->cameras[0]);
    case CAMERA_2: return cli_take_camera("match", "camera2", text, &arguments->cameras[1]);
    case FOCAL_SD:
        if (!cli_parse_number(text, 0, CLI_LARGEST_FOCAL_SD, &arguments->focal_sd))
            return cli_usage_error("match", "--focal-sd: '%s' is not 0 to %g", text, CLI_LARGEST_FOCAL_SD);
        break;
    default: return take_focal(text, arguments);
    }
    return CLI_SUCCESS;
}

static int take_plot(void *target, int id, const char *text)
{
    static const char *const answers[] = {"yes", "no", NULL};
    int32_t answer;
    static const char *const layouts[] = {"auto", "beside", "below", NULL}; /* in the order of CLI_LAYOUT_... */
    cli_match_arguments *arguments = target;
    if (id != PLOT)
        arguments->plot_option = plot_options[id - PLOT].name;
    switch (id) {
    case PLOT: arguments->plot = text; break;
    case PLOT_BACKGROUND: return cli_plot_take_background("match", text, &arguments->style.background);
    case PLOT_SCALE: return cli_plot_take_scale("match", text, &arguments->style.scale);
    case PLOT_LINES:
        if ((arguments->style.without_lines = cli_find_word(answers, text)) < 0)
            return cli_usage_error("match", "--plot-lines: '%s' is not yes or no", text);
        break;
    case PLOT_EPIPOLAR:
        if ((answer = cli_find_word(answers, text)) < 0)
            return cli_usage_error("match", "--plot-epipolar: '%s' is not yes or no", text);
        arguments->style.epipolar = answer == 0;
        break;
    default:
        if ((arguments->style.layout = cli_find_word(layouts, text)) < 0)
            return cli_usage_error("match", "--plot-layout: '%s' is not auto, beside or below", text);
    }
    return CLI_SUCCESS;
}

static int take_preset(void *target, int id, const char *text)
{
    cli_match_arguments *arguments = target;
    switch (id) {
    case PRESET: return cli_take_preset("match", "preset", text, &arguments->preset);
    case DETECT_PRESET: return cli_take_preset("match", "detect-preset", text, &arguments->detect_preset);
    default: return cli_take_preset("match", "match-preset", text, &arguments->match_preset);
    }
}

static int apply_settings(cli_match_arguments *arguments)
{
    const int quiet = arguments->common.quiet;
    /* the detector's default is not what is recommended here: only --detect-preset asks for it */
    const int32_t recommended = arguments->preset == ASJ_PRESET_DEFAULT ? ASJ_PRESET_MATCH : arguments->preset;
    asj_detect_options_preset(&arguments->detect_options, arguments->detect_preset < 0 ? recommended : arguments->detect_preset);
    asj_match_options_preset(&arguments->options, arguments->match_preset < 0 ? arguments->preset : arguments->match_preset);
    int result = cli_settings_apply(&arguments->detect_settings, "match", quiet, &arguments->detect_options, cli_set_detect_option);
    if (result == CLI_SUCCESS)
        result = cli_settings_apply(&arguments->match_settings, "match", quiet, &arguments->options, cli_set_match_option);
    return result;
}

static int take_images(cli_match_arguments *arguments, char **operands, int operand_count)
{
    if (operand_count != 2)
        return cli_usage_error("match", operand_count == 0 ? "which images?" : "it takes two images, not %d", operand_count);
    arguments->images[0] = operands[0];
    arguments->images[1] = operands[1];
    return CLI_SUCCESS;
}

static void start(cli_match_arguments *arguments)
{
    memset(arguments, 0, sizeof *arguments);
    cli_common_init(&arguments->common, "match");
    arguments->detect_preset = arguments->match_preset = -1;
    arguments->preset = ASJ_PRESET_MATCH;
    arguments->minimum_end = -1;
    arguments->focal_sd = -1;
}

typedef struct match_syntax {
    cli_group groups[6];
    cli_table tables[2];
    cli_syntax syntax;
} match_syntax;

static void fill_syntax(cli_match_arguments *arguments, const cli_other *other, match_syntax *room)
{
    const cli_group groups[] = {
        {"Results", output_options, sizeof output_options / sizeof output_options[0], take_output, arguments},
        {"Junctions", input_options, sizeof input_options / sizeof input_options[0], take_input, arguments},
        {"Geometry", geometry_options, sizeof geometry_options / sizeof geometry_options[0], take_geometry, arguments},
        {"Plot", plot_options, sizeof plot_options / sizeof plot_options[0], take_plot, arguments},
        {"Presets", preset_options, sizeof preset_options / sizeof preset_options[0], take_preset, arguments},
        {"Running", cli_common_options, cli_common_option_count, cli_common_take, &arguments->common},
    };
    const cli_table tables[] = {
        {"Detector", "detect", asj_detect_option_count, asj_detect_option, cli_detect_option_value, cli_settings_take,
         &arguments->detect_settings},
        {"Matcher", "match", asj_match_option_count, asj_match_option, cli_match_option_value, cli_settings_take,
         &arguments->match_settings},
    };
    memcpy(room->groups, groups, sizeof groups);
    memcpy(room->tables, tables, sizeof tables);
    room->syntax = (cli_syntax){"match", introduction, conclusion, room->groups, sizeof groups / sizeof groups[0], room->tables, 2,
                                other};
}

int cli_match_has_option(const char *name, size_t length)
{
    cli_match_arguments arguments;
    match_syntax room;
    fill_syntax(&arguments, NULL, &room);
    return cli_has_option(&room.syntax, name, length);
}

int cli_match_arguments_read(int argc, char **argv, const cli_other *other, cli_match_arguments *arguments)
{
    int first = argc;
    match_syntax room;
    start(arguments);
    if (!cli_settings_create(&arguments->detect_settings, argc) || !cli_settings_create(&arguments->match_settings, argc))
        return CLI_FAILED;
    fill_syntax(arguments, other, &room);
    int result = cli_parse(&room.syntax, argc, argv, &first);
    if (result == CLI_HELP)
        cli_help(&room.syntax, argc, argv);
    if (result == CLI_SUCCESS)
        result = apply_settings(arguments);
    return result == CLI_SUCCESS ? take_images(arguments, argv + first, argc - first) : result;
}

int32_t cli_match_file_format(const cli_match_arguments *arguments)
{
    const char *word = arguments->format ? arguments->format : cli_format_of_name(arguments->output, cli_match_formats);
    return word && strcmp(word, "json") == 0 ? ASJ_FILE_JSON : ASJ_FILE_CSV;
}
