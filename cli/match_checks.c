/* SPDX-License-Identifier: BSD-2-Clause */
/* Which options of `asj-cli match` go with each other, and with its files. What would change nothing is refused. */
#include "match_checks.h"
#include "ending.h"
#include "message.h"
#include "outputs.h"

#include <string.h>

/* --- upsampled images --------------------------------------------------------------------------------------------------------- */

/* Will there be junctions of octave -1, or may a file have some? */
static int may_have_upsampled(const cli_match_arguments *arguments)
{
    int may = arguments->detect_options.first_octave < 0 && arguments->detect_options.octaves > 1;
    for (int v = 0; v < 2; v++)
        may = may || arguments->junctions[v] || asj_features_probe(arguments->images[v]);
    return may;
}

/* What was given of how upsampled images are looked at; NULL = nothing. Where their partners are looked for matters to junctions of
 * octave -1 as well. */
static const char *asked_of_upsampled(const cli_match_arguments *arguments)
{
    const cli_settings *given = &arguments->match_settings;
    const int only_upsampled = !may_have_upsampled(arguments);
    return cli_settings_have(given, "upsampled_half_octaves")                    ? "--upsampled-half-octaves" :
           cli_settings_have(given, "upsampled_max_junctions")                   ? "--upsampled-max-junctions" :
           only_upsampled && cli_settings_have(given, "upsampled_search_radius") ? "--upsampled-search-radius" :
           only_upsampled && cli_settings_have(given, "upsampled_shortlist")     ? "--upsampled-shortlist" : NULL;
}

/* The same, and of when they are. */
static const char *asked_of_upsampling(const cli_match_arguments *arguments)
{
    return cli_settings_have(&arguments->match_settings, "upsample_from") ? "--upsample-from" : asked_of_upsampled(arguments);
}

/* One octave, or another first one, says how images are looked at. */
static int check_upsampling(const cli_match_arguments *arguments)
{
    const int32_t first = arguments->detect_options.first_octave, one = arguments->detect_options.octaves == 1;
    const char *asked = asked_of_upsampling(arguments);
    if (asked && (first != 0 || one))
        return cli_usage_error("match", "%s changes nothing with %s", asked,
                               first < 0 ? "--first-octave -1, which upsamples the images anyway" :
                               first > 0 ? "--first-octave above 0" : "one octave");
    const char *upsampled = asked_of_upsampled(arguments);
    if (upsampled && arguments->options.upsample_from == 0)
        return cli_usage_error("match", "%s changes nothing with --upsample-from 0, as it is with the preset paper", upsampled);
    if (arguments->options.upsampled_search_radius == 0 && cli_settings_have(&arguments->match_settings, "upsampled_shortlist"))
        return cli_usage_error("match", "--upsampled-shortlist changes nothing with --upsampled-search-radius 0");
    if (one && cli_settings_have(&arguments->detect_settings, "half_octaves"))
        return cli_usage_error("match", "--half-octaves changes nothing with one octave");
    return CLI_SUCCESS;
}

/* --- files ------------------------------------------------------------------------------------------------------------------- */

static int check_files(const cli_match_arguments *arguments)
{
    const char *inputs[6];
    cli_planned outputs[2];
    size_t input_count = 0, output_count = 0;
    for (int v = 0; v < 2; v++) {
        inputs[input_count++] = arguments->images[v];
        if (arguments->junctions[v])
            inputs[input_count++] = arguments->junctions[v];
        if (arguments->regions[v].mask)
            inputs[input_count++] = arguments->regions[v].mask;
    }
    if (arguments->output && strcmp(arguments->output, "-") != 0)
        outputs[output_count++] = (cli_planned){arguments->output, "the matches", NULL};
    if (arguments->plot)
        outputs[output_count++] = (cli_planned){arguments->plot, "the plot", NULL};
    const int result = cli_check_collisions("match", "", outputs, output_count, inputs, input_count);
    return result == CLI_SUCCESS ? cli_check_folders(outputs, output_count) : result;
}

/* Options of the detector when it has nothing to do. */
static int check_detector(const cli_match_arguments *arguments)
{
    int known[2]; /* junctions, which come from a file of their own or with features */
    for (int v = 0; v < 2; v++)
        known[v] = arguments->junctions[v] || asj_features_probe(arguments->images[v]);
    for (int v = 0; v < 2; v++)
        if (known[v] && (arguments->regions[v].mask || arguments->regions[v].width > 0))
            return cli_usage_error("match", "--%s%d changes nothing: the junctions of that image come from a file",
                                   arguments->regions[v].mask ? "mask" : "region", v + 1);
    if (arguments->common.white > 0 && asj_features_probe(arguments->images[0]) && asj_features_probe(arguments->images[1]))
        return cli_usage_error("match", "--white changes nothing: features have no pixels");
    if (!known[0] || !known[1])
        return CLI_SUCCESS;
    if (arguments->detect_settings.count > 0)
        return cli_usage_error("match", "--%s changes nothing: the junctions of both images come from files",
                               arguments->detect_settings.list[0].name);
    if (arguments->detect_preset >= 0)
        return cli_usage_error("match", "--detect-preset changes nothing: the junctions of both images come from files");
    return CLI_SUCCESS;
}

/* Two whole images are looked at together. */
static int looks_by_itself(const cli_match_arguments *arguments)
{
    const int32_t matcher = arguments->match_preset < 0 ? arguments->preset : arguments->match_preset;
    int images = matcher != ASJ_PRESET_PAPER; /* which has nothing of it */
    for (int v = 0; v < 2; v++)
        images = images && !arguments->junctions[v] && !arguments->regions[v].mask && arguments->regions[v].width == 0 &&
                 !asj_features_probe(arguments->images[v]);
    return images;
}

/* The detector runs on stretched images as a whole. */
static int check_stretch(cli_match_arguments *arguments)
{
    if (!arguments->stretch_given)
        arguments->look = looks_by_itself(arguments);
    for (int v = 0; v < 2 && arguments->stretch_given; v++) {
        if (arguments->junctions[v] || asj_features_probe(arguments->images[v]))
            return cli_usage_error("match", "--stretch looks at images: it does not go with junctions or features from files");
        if (arguments->regions[v].mask || arguments->regions[v].width > 0)
            return cli_usage_error("match", "--stretch looks at whole images: it does not go with --%s%d",
                                   arguments->regions[v].mask ? "mask" : "region", v + 1);
    }
    const char *asked = asked_of_upsampling(arguments);
    if ((!arguments->look || arguments->stretch.x > 0) && asked)
        return cli_usage_error("match", "%s changes nothing: it is for two whole images, without --stretch and without the preset "
                               "paper", asked);
    return CLI_SUCCESS;
}

/* Colours are looked at where a geometry is asked and not found. */
static int check_colours(const cli_match_arguments *arguments)
{
    if (!cli_settings_have(&arguments->match_settings, "look_at_colours"))
        return CLI_SUCCESS;
    if (arguments->geometry == ASJ_GEOMETRY_NONE)
        return cli_usage_error("match", "--look-at-colours changes nothing without --geometry");
    if (arguments->detect_options.colours)
        return cli_usage_error("match", "--look-at-colours changes nothing with --colours, which looks at them anyway");
    if (!arguments->look || arguments->stretch.x > 0)
        return cli_usage_error("match", "--look-at-colours changes nothing: it is for two whole images, without --stretch, "
                               "junctions or features from files, regions, masks and the preset paper");
    return CLI_SUCCESS;
}

/* Options that say how something looks which nobody has asked for. */
static int check_results(cli_match_arguments *arguments)
{
    if (arguments->minimum_end >= 0 && !arguments->lines)
        return cli_usage_error("match", "--line-ends changes nothing without --lines");
    if (arguments->join_lines && !arguments->lines)
        return cli_usage_error("match", "--join-lines changes nothing without --lines");
    if (arguments->join_lines)
        arguments->lines = ASJ_LINES_JOINED;
    if (arguments->minimum_end < 0)
        arguments->minimum_end = ASJ_END_INNER;
    if (!arguments->plot)
        return cli_plot_check_without("match", arguments->plot_option);
    if (arguments->format && !arguments->output)
        return cli_usage_error("match", "--format changes nothing: with --plot alone no matches are written (--output - does)");
    return cli_plot_format_of_name("match", arguments->plot, &arguments->plot_format);
}

/* Cameras without a geometry that uses them; match_cameras.c looks for the other way round. */
static int check_geometry(const cli_match_arguments *arguments)
{
    const int first = arguments->cameras[0].fx > 0, second = arguments->cameras[1].fx > 0;
    if ((first || second || arguments->focal_from != CLI_FOCAL_AUTO) && arguments->geometry == ASJ_GEOMETRY_NONE)
        return cli_usage_error("match", "a camera or a focal length changes nothing without --geometry");
    if (arguments->focal_sd > 0 && (arguments->geometry == ASJ_GEOMETRY_NONE || arguments->geometry > ASJ_GEOMETRY_ESSENTIAL))
        return cli_usage_error("match", "--focal-sd changes nothing without --geometry auto or essential and focal lengths");
    if (arguments->focal_sd > 0 && arguments->focal_from == CLI_FOCAL_ESTIMATE)
        return cli_usage_error("match", "--focal-sd changes nothing with --focal estimate, which takes none as known");
    if (arguments->style.epipolar && arguments->geometry == ASJ_GEOMETRY_NONE)
        return cli_usage_error("match", "--plot-epipolar changes nothing without --geometry");
    if (arguments->focal_from == CLI_FOCAL_ESTIMATE && (first || second))
        return cli_usage_error("match", "--focal estimate: --camera%d gives it", first ? 1 : 2);
    if (arguments->focal_from == CLI_FOCAL_ESTIMATE && arguments->geometry > ASJ_GEOMETRY_ESSENTIAL)
        return cli_usage_error("match", "--focal estimate changes nothing with this geometry, which has no focal length");
    return CLI_SUCCESS;
}

int cli_match_check(cli_match_arguments *arguments)
{
    for (int v = 0; v < 2; v++)
        if (strcmp(arguments->images[v], "-") == 0 || (arguments->junctions[v] && strcmp(arguments->junctions[v], "-") == 0))
            return cli_usage_error("match", "nothing is read from standard input (a file named - is ./-)");
    int result = cli_common_check(&arguments->common);
    if (result == CLI_SUCCESS)
        result = cli_check_detector("match", &arguments->detect_options);
    if (result == CLI_SUCCESS)
        result = check_upsampling(arguments);
    if (result == CLI_SUCCESS)
        result = cli_check_ending("match", "matches", arguments->output, arguments->format, cli_match_formats);
    if (result == CLI_SUCCESS)
        result = check_detector(arguments);
    if (result == CLI_SUCCESS)
        result = check_geometry(arguments);
    if (result == CLI_SUCCESS)
        result = check_stretch(arguments);
    if (result == CLI_SUCCESS)
        result = check_colours(arguments);
    if (result == CLI_SUCCESS)
        result = check_results(arguments);
    if (result == CLI_SUCCESS)
        result = check_files(arguments);
    if (result == CLI_SUCCESS && arguments->output && !arguments->common.quiet)
        cli_warn_ending("match", arguments->output, arguments->format,
                        cli_match_file_format(arguments) == ASJ_FILE_JSON ? "json" : "csv");
    return result;
}
