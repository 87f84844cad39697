/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-cli detect: image by image, read, detect, write; one that fails does not stop the others. */
#include "detect.h"
#include "camera.h"
#include "detect_arguments.h"
#include "interrupt.h"
#include "json_lines.h"
#include "message.h"
#include "outputs.h"
#include "platform.h"
#include "read_image.h"
#include "tally.h"
#include "timing.h"

#include <asj/detect.h>
#include <asj/io.h>
#include <asj/segments.h>

#include <stdio.h>
#include <string.h>

/* One image after the other with one context. */
typedef struct run {
    const cli_detect_arguments *arguments;
    cli_session session;
    asj_image_file *mask; /* of all images; NULL: none */
    cli_json_lines lines; /* of all images */
    double read_ms, lines_ms;
    asj_vanishing_points points; /* of the image in hand, with --vanishing-points */
    int camera_doubted; /* once for all images */
    cli_tally tally;
} run;

static asj_status write_features(run *r, const char *path, const asj_image *pixels, const asj_detection *detection, char *message)
{
    asj_features *features = NULL;
    asj_status status = asj_features_create(r->session.context, pixels, detection->junctions, detection->junction_count, NULL,
                                            &features);
    if (status != ASJ_OK)
        snprintf(message, CLI_MESSAGE_SIZE, "%s", asj_context_message(r->session.context));
    else
        status = asj_features_write(path, features, message, CLI_MESSAGE_SIZE);
    asj_features_free(&features);
    return status;
}

static asj_status find_directions(run *r, const asj_image *pixels, const asj_detection *detection, char *message)
{
    asj_vanishing_options options;
    asj_vanishing_options_init(&options);
    options.camera = r->arguments->camera;
    options.width = pixels->width;
    options.height = pixels->height;
    const asj_status status = asj_find_vanishing_points(r->session.context, detection->junctions, detection->junction_count,
                                                        &options, &r->points);
    if (status != ASJ_OK)
        snprintf(message, CLI_MESSAGE_SIZE, "%s", asj_context_message(r->session.context));
    return status;
}

static asj_status write_junctions(run *r, const char *image, const char *path, const asj_image *pixels,
                                  const asj_detection *detection, const asj_segment_list *segments, char *message)
{
    const int32_t format = cli_detect_file_format(r->arguments);
    asj_detection_report report = {.detection = detection, .options = &r->arguments->options, .image_name = image,
                                   .segments = segments};
    if (format == CLI_FILE_FEATURES)
        return write_features(r, path, pixels, detection, message);
    if (r->arguments->vanishing_points)
        report.vanishing_points = &r->points;
    if (format == CLI_FILE_JSON_LINES)
        return cli_json_lines_add(&r->lines, &report, message, CLI_MESSAGE_SIZE);
    return asj_junctions_write(path, format, &report, message, CLI_MESSAGE_SIZE);
}

static int write_results(run *r, const char *image, const cli_output *output, const asj_image *pixels,
                         const asj_detection *detection, const asj_segment_list *segments)
{
    const cli_detect_arguments *arguments = r->arguments;
    char message[CLI_MESSAGE_SIZE] = "";
    int result = CLI_SUCCESS;
    if (arguments->vanishing_points) {
        const asj_status status = find_directions(r, pixels, detection, message);
        if (status != ASJ_OK)
            return status == ASJ_ERROR_CANCELLED ? CLI_FAILED : cli_session_fail(&r->session, image, message, status);
    }
    if (output->junctions || r->lines.output) {
        asj_status status = write_junctions(r, image, output->junctions, pixels, detection, segments, message);
        if (status == ASJ_ERROR_CANCELLED)
            return CLI_FAILED;
        if (r->lines.broken) /* where there is no message, cli_json_lines_end() will say why */
            return message[0] ? cli_session_fail(&r->session, image, message, status) : CLI_FAILED;
        if (status != ASJ_OK)
            result = cli_session_fail(&r->session, output->junctions ? output->junctions : image, message, status);
    }
    if (output->plot && !cli_interrupted()) {
        const cli_plot_scene scene = {pixels, detection, segments, arguments->vanishing_points ? &r->points : NULL};
        asj_status status = cli_plot_write(output->plot, arguments->plot_format, &scene, &arguments->style, message,
                                           sizeof message);
        if (status == ASJ_ERROR_CANCELLED)
            return CLI_FAILED;
        if (status != ASJ_OK)
            result = cli_session_fail(&r->session, output->plot, message, status);
    }
    return result;
}

/* What JSON has of --vanishing-points, in short. */
static void describe_directions(const asj_vanishing_points *points, char *text, size_t size)
{
    const int used = snprintf(text, size, ", %d direction%s", (int)points->count, points->count == 1 ? "" : "s");
    if (points->focal_source == ASJ_FOCAL_FOUND)
        snprintf(text + used, size - (size_t)used, ", focal length %.0f px", points->camera.fx);
}

static void print_summary(const run *r, const char *image, const cli_output *output, const asj_detection *detection,
                          const asj_segment_list *segments)
{
    const char *junctions = output->junctions && strcmp(output->junctions, "-") != 0 ? output->junctions : NULL;
    char lines[64] = "", directions[96] = "";
    if (r->arguments->vanishing_points)
        describe_directions(&r->points, directions, sizeof directions);
    if (segments)
        snprintf(lines, sizeof lines, ", %lu line%s", (unsigned long)segments->count, segments->count == 1 ? "" : "s");
    cli_note("%s: %lu junction%s%s%s%s%s%s%s", image, (unsigned long)detection->junction_count,
             detection->junction_count == 1 ? "" : "s", lines, directions, junctions || output->plot ? " -> " : "",
             junctions ? junctions : "", junctions && output->plot ? ", " : "", output->plot ? output->plot : "");
}

static int finish_image(run *r, const char *image, const cli_output *output, const asj_image *pixels,
                        const asj_detection *detection, const asj_segment_list *segments)
{
    double start = cli_now_ms();
    int result = write_results(r, image, output, pixels, detection, segments);
    double write_ms = cli_now_ms() - start;
    cli_progress_clear(&r->session.progress);
    if (result == CLI_SUCCESS && !r->arguments->common.quiet) {
        print_summary(r, image, output, detection, segments);
        cli_tally_image(&r->tally, image, pixels, detection, &r->arguments->options);
    }
    if (result == CLI_SUCCESS && r->arguments->common.time) {
        cli_timing_detection(image, r->session.context, detection);
        if (segments)
            cli_timing_work("lines", r->lines_ms);
        cli_timing_files(r->read_ms, write_ms);
    }
    return result;
}

static int detect_pixels(run *r, const char *image, const cli_output *output, const asj_image *pixels, const asj_region *region)
{
    asj_detection *detection = NULL;
    asj_segment_list *segments = NULL;
    asj_status status = asj_detect_region(r->session.context, pixels, region, &r->arguments->options, &detection);
    if (status == ASJ_ERROR_OPTION)
        return cli_usage_error("detect", "%s", asj_context_message(r->session.context));
    const double start = cli_now_ms();
    if (status == ASJ_OK && r->arguments->lines)
        status = asj_find_segments(r->session.context, detection->junctions, detection->junction_count, detection->edges,
                                   detection->edge_count, &segments);
    r->lines_ms = cli_now_ms() - start;
    int result = CLI_FAILED;
    if (status == ASJ_OK)
        result = finish_image(r, image, output, pixels, detection, segments);
    else if (status != ASJ_ERROR_CANCELLED) /* else the loop sees the signal */
        result = cli_session_fail(&r->session, image, asj_context_message(r->session.context), status);
    asj_segment_list_free(&segments);
    asj_detection_free(&detection);
    return result;
}

static int check_camera(run *r, const char *image, const asj_image *pixels)
{
    char message[256], line[300];
    const asj_camera *camera = &r->arguments->camera;
    const int verdict = camera->fx > 0 ? cli_judge_camera(camera, pixels, message, sizeof message) : CLI_CAMERA_GOOD;
    if (verdict == CLI_CAMERA_WRONG) {
        snprintf(line, sizeof line, "--camera: %s", message);
        return cli_session_fail(&r->session, image, line, ASJ_ERROR_ARGUMENT);
    }
    if (verdict == CLI_CAMERA_DOUBTFUL && !r->camera_doubted && !r->arguments->common.quiet) {
        cli_progress_clear(&r->session.progress);
        cli_note("asj-cli detect: warning: %s: --camera: %s", image, message);
        r->camera_doubted = 1;
    }
    return CLI_SUCCESS;
}

static int detect_part(run *r, const char *image, const cli_output *output, const asj_image *pixels)
{
    asj_region region;
    const int result = cli_region_of(&r->session, &r->arguments->region, r->mask, image, pixels, &region);
    return result != CLI_SUCCESS ? result : cli_interrupted() ? CLI_FAILED : detect_pixels(r, image, output, pixels, &region);
}

/* With two ways to all images in it. */
static int refuse_folder(run *r, const char *folder)
{
    char line[2 * CLI_MESSAGE_SIZE];
    int length = (int)strlen(folder);
    while (length > 1 && cli_is_separator(folder[length - 1]))
        length--;
    snprintf(line, sizeof line, "is a directory; its images are \"%.*s\"/*.jpg, or: find \"%.*s\" -name '*.jpg' | asj-cli detect "
             "--files-from - %s", length, folder, length, folder, r->lines.output ? "-f jsonl" : "-d DIR");
    return cli_session_fail(&r->session, folder, line, ASJ_ERROR_FILE);
}

static int detect_file(run *r, const char *image, const cli_output *output)
{
    asj_image_file *file = NULL;
    const double start = cli_now_ms();
    if (cli_is_folder(image))
        return refuse_folder(r, image);
    int result = cli_read_image(&r->session, &r->arguments->common, image, &file);
    r->read_ms = cli_now_ms() - start;
    if (result != CLI_SUCCESS)
        return result;
    if (r->arguments->options.colours && !r->arguments->common.quiet)
        cli_warn_of_gray(&r->session, "detect", image, &file->image);
    result = check_camera(r, image, &file->image);
    if (result == CLI_SUCCESS)
        result = detect_part(r, image, output, &file->image);
    asj_image_file_free(&file);
    return result;
}

/* Are all results of an image there? Files appear whole (asj_output_begin()), so one that is there is done. */
static int is_done(const cli_output *output)
{
    cli_identity found;
    return (!output->junctions || cli_identify(output->junctions, &found)) && (!output->plot || cli_identify(output->plot, &found));
}

/* Image by image. Returns the exit code. */
static int detect_each(run *r, const cli_outputs *outputs, size_t *skipped)
{
    const cli_detect_arguments *arguments = r->arguments;
    int result = CLI_SUCCESS;
    for (size_t i = 0; result != CLI_USAGE && i < arguments->images.count && !r->lines.broken; i++) {
        if (arguments->skip_existing && is_done(&outputs->of[i])) {
            ++*skipped;
            continue;
        }
        cli_progress_next(&r->session.progress, i, arguments->images.names[i]);
        int one = detect_file(r, arguments->images.names[i], &outputs->of[i]);
        if (cli_interrupted()) {
            cli_progress_clear(&r->session.progress);
            cli_error("interrupted at %s", arguments->images.names[i]);
            return 128 + cli_interrupted();
        }
        if (r->lines.output && r->lines.count == i && one == CLI_FAILED && !r->lines.broken)
            cli_json_lines_add_failure(&r->lines, arguments->images.names[i], r->session.failure);
        r->tally.done += one == CLI_SUCCESS;
        r->tally.failed += one != CLI_SUCCESS;
        result = one > result ? one : result;
    }
    return result;
}

static int detect_all(run *r, const cli_outputs *outputs)
{
    const cli_detect_arguments *arguments = r->arguments;
    size_t skipped = 0;
    r->tally.total = arguments->images.count;
    int result = cli_session_open(&r->session, &arguments->common, arguments->images.count);
    if (result == CLI_SUCCESS && outputs->of_all)
        result = cli_json_lines_begin(&r->lines, &r->session, outputs->of_all);
    if (result == CLI_SUCCESS)
        result = detect_each(r, outputs, &skipped);
    const int ended = !r->lines.output || cli_json_lines_end(&r->lines, &r->session, result <= CLI_FAILED) == CLI_SUCCESS;
    if (!ended)
        result = CLI_FAILED;
    cli_session_close(&r->session);
    const int whole = result != CLI_USAGE && !cli_interrupted() && !r->lines.broken && r->tally.done + r->tally.failed > 0;
    if (whole && r->tally.total > 1 && !arguments->common.quiet)
        cli_tally_print(&r->tally, &arguments->options, ended ? outputs->of_all : NULL);
    if (skipped > 0 && !arguments->common.quiet)
        cli_note("%zu of %zu images had their results in %s already", skipped, arguments->images.count, arguments->out_dir);
    return result;
}

int cli_detect(int argc, char **argv, const cli_other *other)
{
    cli_detect_arguments arguments;
    cli_outputs outputs = {0};
    run r = {0};
    int result = cli_detect_arguments_read(argc, argv, other, &arguments);
    if (result == CLI_SUCCESS) {
        r.arguments = &arguments;
        result = cli_region_read_mask(&r.session, &arguments.common, &arguments.region, &r.mask); /* before any folder */
        if (result == CLI_SUCCESS)
            result = cli_outputs_plan(&arguments, &outputs);
        if (result == CLI_SUCCESS)
            result = detect_all(&r, &outputs);
        asj_image_file_free(&r.mask);
        cli_outputs_free(&outputs);
    }
    cli_detect_arguments_free(&arguments);
    return result == CLI_HELP ? CLI_SUCCESS : result;
}
