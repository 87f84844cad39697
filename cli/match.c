/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli match: two images, their junctions from the detector or from files, or features from files; the matches. */
#include "match.h"
#include "interrupt.h"
#include "match_arguments.h"
#include "match_cameras.h"
#include "match_checks.h"
#include "match_input.h"
#include "message.h"
#include "platform.h"
#include "read_image.h"
#include "timing.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { FEW = 8, LARGER = 4, STEPS = 3 /* on the progress line: two detections and the matching */ };

typedef struct run {
    const cli_match_arguments *arguments;
    cli_session session;
    cli_match_input inputs[2];
    asj_geometry_options geometry;
    asj_match_result *result;
    asj_segment_match *segments; /* with --lines */
    size_t segment_count;
    const char *at;              /* the file in hand, for the message after an interrupt */
    int finished;                /* everything is written */
} run;

static int read_inputs(run *r)
{
    int result = CLI_SUCCESS;
    for (int v = 0; v < 2 && !cli_interrupted(); v++) { /* the second one is looked at even when the first is bad */
        r->at = r->arguments->images[v];
        const int one = cli_match_input_read(&r->session, r->arguments, v, &r->inputs[v]);
        result = one > result ? one : result;
    }
    return cli_interrupted() ? CLI_FAILED : result;
}

static int detect(run *r)
{
    int result = CLI_SUCCESS;
    for (int v = 0; v < 2 && result == CLI_SUCCESS && !r->arguments->look; v++) {
        r->at = r->inputs[v].name;
        cli_progress_next(&r->session.progress, (size_t)v, r->at);
        result = cli_match_input_detect(&r->session, r->arguments, v, &r->inputs[v]);
    }
    return result;
}

/* Where one of both is features, the other becomes features too. */
static asj_status match_features(run *r, const asj_match_options *options)
{
    asj_status status = ASJ_OK;
    for (int v = 0; v < 2 && status == ASJ_OK; v++)
        status = cli_match_input_describe(&r->session, r->arguments, &r->inputs[v]);
    if (status != ASJ_OK)
        return status;
    return asj_match_features(r->session.context, r->inputs[0].features, r->inputs[1].features, options, &r->result);
}

static asj_status match_images(run *r, const asj_match_options *options)
{
    size_t counts[2];
    const asj_junction *first = cli_match_input_junctions(&r->inputs[0], &counts[0]);
    const asj_junction *second = cli_match_input_junctions(&r->inputs[1], &counts[1]);
    return asj_match(r->session.context, &r->inputs[0].pixels, first, counts[0], &r->inputs[1].pixels, second, counts[1], options,
                     &r->result);
}

/* From the pixels on, both at once. */
static asj_status match_looks(run *r, const asj_match_options *options)
{
    return asj_match_images(r->session.context, &r->inputs[0].pixels, &r->inputs[1].pixels, &r->arguments->stretch,
                            &r->arguments->detect_options, options, &r->result);
}

static int match(run *r)
{
    char both[2 * CLI_MESSAGE_SIZE];
    asj_match_options options = r->arguments->options;
    const int features = r->inputs[0].features || r->inputs[1].features;
    options.geometry = r->geometry;
    r->at = "the matching";
    cli_progress_next(&r->session.progress, STEPS - 1, "matching");
    asj_status status = r->arguments->look ? match_looks(r, &options)
                        : features         ? match_features(r, &options)
                                           : match_images(r, &options);
    if (status == ASJ_OK)
        return CLI_SUCCESS;
    if (status == ASJ_ERROR_OPTION && !features)
        return cli_usage_error("match", "%s", asj_context_message(r->session.context));
    if (status == ASJ_ERROR_CANCELLED)
        return CLI_FAILED;
    snprintf(both, sizeof both, "%s, %s", r->inputs[0].name, r->inputs[1].name);
    return cli_session_fail(&r->session, both, asj_context_message(r->session.context), status);
}

static int find_segments(run *r)
{
    const int32_t minimum_end = r->arguments->minimum_end;
    r->segment_count = asj_match_segments(r->result, minimum_end, NULL, 0);
    r->segments = calloc(r->segment_count + 1, sizeof *r->segments);
    if (!r->segments) {
        cli_error("out of memory");
        return CLI_FAILED;
    }
    asj_match_segments(r->result, minimum_end, r->segments, r->segment_count);
    if (r->arguments->lines == ASJ_LINES_JOINED)
        r->segment_count = asj_join_segment_matches(r->segments, r->segment_count);
    return CLI_SUCCESS;
}

static int write_matches(run *r, const char *path)
{
    const cli_match_arguments *arguments = r->arguments;
    char message[CLI_MESSAGE_SIZE] = "";
    asj_match_report report;
    memset(&report, 0, sizeof report);
    report.result = r->result;
    report.lines = arguments->lines;
    report.minimum_end = arguments->minimum_end;
    report.options = &arguments->options;
    report.stretch[0] = arguments->look ? r->result->stretch[0] : 0;
    report.stretch[1] = arguments->look ? r->result->stretch[1] : 0;
    if (r->inputs[0].detection || r->inputs[1].detection || arguments->look)
        report.detect_options = &arguments->detect_options;
    for (int v = 0; v < 2; v++) {
        report.image_names[v] = arguments->images[v];
        report.junction_names[v] = arguments->junctions[v];
        report.widths[v] = r->inputs[v].pixels.width;
        report.heights[v] = r->inputs[v].pixels.height;
    }
    asj_status status = asj_matches_write(path, cli_match_file_format(arguments), &report, message, sizeof message);
    return status == ASJ_OK ? CLI_SUCCESS : cli_session_fail(&r->session, path, message, status);
}

static int write_plot(run *r)
{
    const cli_match_arguments *arguments = r->arguments;
    char message[CLI_MESSAGE_SIZE] = "";
    cli_plot_match_content content = {.images = {&r->inputs[0].pixels, &r->inputs[1].pixels},
                                      .result = r->result,
                                      .segments = r->segments,
                                      .segment_count = r->segment_count};
    cli_plot_match_style style = arguments->style;
    if (!content.images[0]->data || !content.images[1]->data)
        style.background = CLI_PLOT_WHITE; /* features are no photograph */
    asj_status status = cli_plot_match(arguments->plot, arguments->plot_format, &content, &style, message, sizeof message);
    if (status == ASJ_ERROR_CANCELLED)
        return CLI_FAILED;
    return status == ASJ_OK ? CLI_SUCCESS : cli_session_fail(&r->session, arguments->plot, message, status);
}

static int write_results(run *r)
{
    const cli_match_arguments *arguments = r->arguments;
    int result = CLI_SUCCESS;
    if (arguments->output || !arguments->plot)
        result = write_matches(r, arguments->output ? arguments->output : "-");
    if (arguments->plot)
        r->at = arguments->plot;
    if (arguments->plot && (cli_interrupted() || write_plot(r) != CLI_SUCCESS))
        result = CLI_FAILED;
    r->finished = result == CLI_SUCCESS;
    return result;
}

static void print_summary(const run *r)
{
    const cli_match_arguments *arguments = r->arguments;
    const char *file = arguments->output && strcmp(arguments->output, "-") != 0 ? arguments->output : NULL;
    char lines[64] = "";
    if (arguments->lines)
        snprintf(lines, sizeof lines, ", %zu line%s", r->segment_count, r->segment_count == 1 ? "" : "s");
    cli_note("%s, %s: %lu match%s%s%s%s%s%s", r->inputs[0].name, r->inputs[1].name, (unsigned long)r->result->match_count,
             r->result->match_count == 1 ? "" : "es", lines, file || arguments->plot ? " -> " : "", file ? file : "",
             file && arguments->plot ? ", " : "", arguments->plot ? arguments->plot : "");
}

/* What the caller has not asked for. */
static void print_looks(const run *r)
{
    const double *by = r->result->stretch;
    if (r->arguments->look && r->arguments->stretch.x == 0 && (by[0] > 1 || by[1] > 1))
        cli_note("looked at stretched by %g,%g: as they are the images have too little in common", by[0], by[1]);
    if (r->result->coloured)
        cli_note("colours looked at, too: grey levels tell too little");
}

/* Of matches, where none is accepted. What the images and the upsampled ones tell at odds has rejected some (asj/match.h). */
static void print_no_geometry(const run *r)
{
    const asj_geometry *g = &r->result->geometry;
    const int32_t status = g->status;
    const unsigned long rejected = (unsigned long)r->result->rejected_count;
    char of_matches[96] = "; the matches are those that there are without";
    if (rejected > 0)
        snprintf(of_matches, sizeof of_matches, "; the images and the upsampled ones tell two; matches left out: %lu", rejected);
    else if (status == ASJ_GEOMETRY_AMBIGUOUS && g->has_rival)
        snprintf(of_matches, sizeof of_matches, "; several explain the views: log10 NFA %.1f and %.1f", g->log10_nfa,
                 g->rival_log10_nfa);
    else if (status == ASJ_GEOMETRY_AMBIGUOUS)
        snprintf(of_matches, sizeof of_matches, "; several explain the views as well");
    else if (status == ASJ_GEOMETRY_DEGENERATE)
        snprintf(of_matches, sizeof of_matches, "; what matches leaves the motion open");
    cli_note("geometry: none (%s)%s", asj_geometry_status_name(status), of_matches);
}

/* CSV and plots have neither. */
static const char *what_json_has(const run *r)
{
    const cli_match_arguments *arguments = r->arguments;
    const int written = arguments->output || !arguments->plot;
    if (written && cli_match_file_format(arguments) == ASJ_FILE_JSON)
        return "";
    return r->result->geometry.has_pose ? " (pose and probabilities: -o FILE.json)" : " (matrix and probabilities: -o FILE.json)";
}

static const char *what_is_left_open(const asj_geometry *g)
{
    if (g->only_turns)
        return ": the camera only turns";
    if (g->model == ASJ_GEOMETRY_HOMOGRAPHY)
        return "; matches off its plane stay, less probable";
    return g->model == ASJ_GEOMETRY_ESSENTIAL && !g->has_pose ? "; its pose stays open" : "";
}

static void print_geometry(const run *r)
{
    const asj_geometry *g = &r->result->geometry;
    char focal[80] = "";
    if (g->focal_sd > 0 && g->cameras[0].fx == g->cameras[1].fx)
        snprintf(focal, sizeof focal, ", focal length %.0f px to %.1f %%", g->cameras[0].fx, 100 * g->focal_sd);
    else if (g->focal_sd > 0)
        snprintf(focal, sizeof focal, ", focal lengths %.0f and %.0f px to %.1f %%", g->cameras[0].fx, g->cameras[1].fx,
                 100 * g->focal_sd);
    if (g->status == ASJ_GEOMETRY_ACCEPTED)
        cli_note("geometry: %s, log10 NFA %.1f%s%s%s", asj_geometry_model_name(g->model), g->log10_nfa, focal,
                 what_is_left_open(g), what_json_has(r));
    else if (g->status != ASJ_GEOMETRY_NOT_ASKED && (r->result->match_count > 0 || r->result->rejected_count > 0))
        print_no_geometry(r);
}

/* Could a focal length be told? */
static int without_focal(const asj_geometry_options *geometry)
{
    return geometry->cameras[0].fx <= 0 && !geometry->find_focal &&
           (geometry->model == ASJ_GEOMETRY_AUTO || geometry->model == ASJ_GEOMETRY_ESSENTIAL);
}

/* No match, and no two geometries at odds that have left them out. */
static int has_no_answer(const asj_match_result *result)
{
    return result->match_count == 0 && !(result->geometry.status == ASJ_GEOMETRY_AMBIGUOUS && result->rejected_count > 0);
}

/* Images far darker or brighter than white, which explain that there is little or nothing. Returns how many. */
static int print_white(const run *r)
{
    int count = 0;
    for (int v = 0; v < 2; v++) {
        const uint32_t level = cli_dark_level(&r->inputs[v].pixels);
        if (level > 0)
            cli_note_dark(r->inputs[v].name, level);
        const double bright = cli_bright_level(&r->inputs[v].pixels);
        if (bright > 0)
            cli_note_bright(r->inputs[v].name, bright);
        count += level > 0 || bright > 0;
    }
    return count;
}

/* Were edges of colours there to be looked at, and were not? */
static int has_colours_left(const run *r)
{
    const cli_match_arguments *arguments = r->arguments;
    const int by_itself = arguments->look && arguments->stretch.x == 0 && arguments->options.look_at_colours &&
                          r->result->geometry.status != ASJ_GEOMETRY_NOT_ASKED;
    int has = !by_itself && !arguments->detect_options.colours;
    for (int v = 0; v < 2; v++)
        has = has && !arguments->junctions[v] && cli_has_colour_edges(&r->inputs[v].pixels);
    return has;
}

/* Hints at an image, or what stands for it, with few corners. */
static void print_bare(const run *r, int v, unsigned long corners)
{
    const cli_match_arguments *arguments = r->arguments;
    const cli_region *region = &arguments->regions[v];
    const char *where = region->mask ? ", where its mask is not 0," : region->width > 0 ? ", in its region," : "";
    if (arguments->junctions[v])
        cli_note("hint: %s has %lu corner%s", arguments->junctions[v], corners, corners == 1 ? "" : "s");
    else if (cli_is_uniform(&r->inputs[v].pixels))
        cli_note("hint: %s has no contrast: all its pixels are alike", r->inputs[v].name);
    else if (corners == 0)
        cli_note("hint: %s%s has no corner that is surer than chance", r->inputs[v].name, where);
    else
        cli_note("hint: %s%s has %lu corner%s only: 'asj-cli detect --for matching --plot' shows them", r->inputs[v].name, where,
                 corners, corners == 1 ? "" : "s");
}

/* Which image has sides LARGER times those of the other or more, and the octave in which it is less than twice as large; -1: none,
 * or it is looked at smaller already. Of the neighbours that support a match nearly all are then details that the other image is
 * too small to show, and none is found though both show the same. */
static int find_larger(const run *r, double *times, int *octave)
{
    const asj_image *one = &r->inputs[0].pixels, *other = &r->inputs[1].pixels;
    if (!one->data || !other->data || r->arguments->junctions[0] || r->arguments->junctions[1] ||
        r->arguments->detect_options.first_octave > 0)
        return -1;
    const double ratio = sqrt((double)one->width * one->height / ((double)other->width * other->height));
    *times = ratio > 1 ? ratio : 1 / ratio;
    *octave = (int)log2(*times);
    return *times < LARGER ? -1 : ratio > 1 ? 0 : 1;
}

/* Why there are none, as far as it can be told, and what to try. */
static void print_hint(const run *r)
{
    const int32_t status = r->result->geometry.status;
    const int bare = r->result->l_junction_count1 < FEW ? 0 : 1;
    const unsigned long corners = (unsigned long)(bare == 0 ? r->result->l_junction_count1 : r->result->l_junction_count2);
    double times;
    int octave;
    const int larger = find_larger(r, &times, &octave);
    if (corners < FEW)
        print_bare(r, bare, corners);
    else if (larger >= 0)
        cli_note("hint: %s is %.1f times as large as %s: match it by its coarse octaves, x.asjf in its place after "
                 "'asj-cli detect --first-octave %d -o x.asjf'",
                 r->inputs[larger].name, times, r->inputs[1 - larger].name, octave);
    else if (status == ASJ_GEOMETRY_NOT_ASKED)
        cli_note("hint: matches need corners that both show, from not too different sides; for views far apart try "
                 "%s--geometry auto, with --camera1 and --camera2 or --focal where they are known",
                 r->arguments->look && r->arguments->stretch.x > 0 ? "it without --stretch, or " : "");
    else if (status == ASJ_GEOMETRY_AMBIGUOUS)
        cli_note("hint: several geometries explain the views as well: things that repeat");
    else if (status == ASJ_GEOMETRY_DEGENERATE)
        cli_note("hint: what matches leaves the motion open: few of them, a plane, or a camera that only turned");
    else if (status != ASJ_GEOMETRY_ACCEPTED)
        cli_note("hint: nothing in common stands out from chance (geometry: %s)%s", asj_geometry_status_name(status),
                 without_focal(&r->geometry) ? "; cameras or --focal estimate may help" : "");
    if (has_colours_left(r))
        cli_note("hint: where surfaces differ in their colours alone, try --colours yes%s",
                 status == ASJ_GEOMETRY_NOT_ASKED ? " --geometry auto" : "");
}

static void print_times(const run *r, double write_ms)
{
    for (int v = 0; v < 2; v++)
        if (r->inputs[v].detection)
            cli_timing_detection(r->inputs[v].name, r->session.context, r->inputs[v].detection);
    cli_timing_match("matching", r->session.context, r->result);
    cli_timing_files(r->inputs[0].read_ms + r->inputs[1].read_ms, write_ms);
}

static int run_all(run *r)
{
    int result = cli_session_open(&r->session, &r->arguments->common, STEPS);
    if (result == CLI_SUCCESS)
        result = read_inputs(r);
    r->geometry = r->arguments->options.geometry;
    if (result == CLI_SUCCESS)
        result = cli_match_cameras(r->arguments, r->inputs, &r->geometry);
    if (result == CLI_SUCCESS)
        result = detect(r);
    if (result == CLI_SUCCESS)
        result = match(r);
    if (result == CLI_SUCCESS && r->arguments->lines)
        result = find_segments(r);
    if (result != CLI_SUCCESS || cli_interrupted())
        return result;
    double start = cli_now_ms();
    result = write_results(r);
    double write_ms = cli_now_ms() - start;
    cli_progress_clear(&r->session.progress);
    if (result == CLI_SUCCESS && !r->arguments->common.quiet) {
        print_summary(r);
        print_looks(r);
        print_geometry(r);
        if ((r->result->match_count >= FEW || print_white(r) == 0) && has_no_answer(r->result))
            print_hint(r);
    }
    if (result == CLI_SUCCESS && r->arguments->common.time)
        print_times(r, write_ms);
    return result;
}

int cli_match(int argc, char **argv, const cli_other *other)
{
    cli_match_arguments arguments;
    run r = {0};
    int result = cli_match_arguments_read(argc, argv, other, &arguments);
    if (result == CLI_SUCCESS)
        result = cli_match_check(&arguments);
    if (result == CLI_SUCCESS) {
        r.arguments = &arguments;
        result = run_all(&r);
        if (cli_interrupted() && !r.finished) {
            cli_progress_clear(&r.session.progress);
            cli_error("interrupted at %s", r.at ? r.at : arguments.images[0]);
            result = 128 + cli_interrupted();
        }
        cli_match_input_free(&r.inputs[0]);
        cli_match_input_free(&r.inputs[1]);
        asj_match_result_free(&r.result);
        free(r.segments);
        cli_session_close(&r.session);
    }
    cli_match_arguments_free(&arguments);
    return result == CLI_HELP ? CLI_SUCCESS : result;
}
