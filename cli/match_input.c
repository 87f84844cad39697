/* SPDX-License-Identifier: BSD-2-Clause */
/* An image and its junctions, or its features, for match. */
#include "match_input.h"
#include "image_name.h"
#include "message.h"
#include "platform.h"
#include "read_image.h"

#include <math.h>
#include <stdio.h>

static int is_outside(const asj_junction *junction, const asj_image *image)
{
    return junction->x < -ASJ_MAX_OUTSIDE || junction->y < -ASJ_MAX_OUTSIDE ||
           junction->x > (float)(image->width - 1 + ASJ_MAX_OUTSIDE) || junction->y > (float)(image->height - 1 + ASJ_MAX_OUTSIDE);
}

static int check_places(cli_session *session, const char *path, const cli_match_input *input)
{
    char message[CLI_MESSAGE_SIZE];
    const asj_junction_file *file = input->file;
    const asj_image *image = &input->image->image;
    for (uint32_t i = 0; i < file->junction_count; i++)
        if (is_outside(&file->junctions[i], image)) {
            snprintf(message, sizeof message, "line %lu: the junction at (%g, %g) lies outside %s, which has %d x %d pixels",
                     (unsigned long)file->lines[i], (double)file->junctions[i].x, (double)file->junctions[i].y, input->name,
                     (int)image->width, (int)image->height);
            return cli_session_fail(session, path, message, ASJ_ERROR_FORMAT);
        }
    if (file->width > 0 && (file->width != image->width || file->height != image->height)) {
        snprintf(message, sizeof message, "junctions of an image of %d x %d pixels, but %s has %d x %d", (int)file->width,
                 (int)file->height, input->name, (int)image->width, (int)image->height);
        return cli_session_fail(session, path, message, ASJ_ERROR_FORMAT);
    }
    return CLI_SUCCESS;
}

/* Junctions for looking at have an NFA below 1, and those of a photograph reach up to it; of junctions for matching thousands of
 * times as many false alarms are taken. So a list that ends within a factor of ten below 1 was cut there. 0 is what files say that
 * do not know. */
enum { FEW = 8 };

static void warn_of_few(cli_session *session, const char *path, const asj_junction_file *file)
{
    uint32_t known = 0;
    float largest = -HUGE_VALF;
    for (uint32_t i = 0; i < file->junction_count; i++) {
        const float nfa = file->junctions[i].log10_nfa;
        known += nfa != 0;
        largest = nfa > largest ? nfa : largest;
    }
    if (known < FEW || largest > 0 || largest < -1)
        return;
    cli_progress_clear(&session->progress);
    cli_note("asj-cli match: warning: %s has only the surest junctions, which give few matches; 'asj-cli detect --for matching' "
             "finds what match needs", path);
}

/* Junctions are in pixels of their own image: in another one they match nothing, or the wrong things. */
static void warn_of_swap(cli_session *session, const cli_match_arguments *arguments, int v)
{
    char name[CLI_MESSAGE_SIZE];
    const char *path = arguments->junctions[v];
    if (!cli_image_name_read(path, name, sizeof name) ||
        !cli_image_name_is_of(name, arguments->images[1 - v], arguments->images[v]))
        return;
    cli_progress_clear(&session->progress);
    cli_note("asj-cli match: warning: --junctions%d: %s has the junctions of %s, which is IMAGE%d: are they swapped?", v + 1, path,
             name, 2 - v);
}

static int read_features(cli_session *session, cli_match_input *input, const char *junctions, int v)
{
    char message[CLI_MESSAGE_SIZE] = "";
    asj_features_info info;
    if (junctions)
        return cli_usage_error("match", "--junctions%d %s changes nothing: %s is a file of features, which has its junctions",
                               v + 1, junctions, input->name);
    const asj_status status = asj_features_read(session->context, input->name, &input->features, message, sizeof message);
    if (status != ASJ_OK)
        return status == ASJ_ERROR_CANCELLED ? CLI_FAILED : cli_session_fail(session, input->name, message, status);
    asj_features_get_info(input->features, &info);
    input->pixels.width = info.width;
    input->pixels.height = info.height;
    return CLI_SUCCESS;
}

int cli_match_input_read(cli_session *session, const cli_match_arguments *arguments, int v, cli_match_input *input)
{
    char message[CLI_MESSAGE_SIZE] = "";
    const char *path = arguments->junctions[v];
    double start = cli_now_ms();
    input->name = arguments->images[v];
    if (asj_features_probe(input->name)) {
        const int result = read_features(session, input, path, v);
        input->read_ms = cli_now_ms() - start;
        return result;
    }
    if (cli_read_image(session, &arguments->common, input->name, &input->image) != CLI_SUCCESS)
        return CLI_FAILED;
    input->pixels = input->image->image;
    if (!path && arguments->detect_options.colours && !arguments->common.quiet)
        cli_warn_of_gray(session, "match", input->name, &input->pixels);
    asj_status status = ASJ_OK;
    if (path && (status = asj_junctions_read(path, &input->file, message, sizeof message)) != ASJ_OK)
        return cli_session_fail(session, path, message, status);
    input->read_ms = cli_now_ms() - start;
    if (path && !arguments->common.quiet)
        warn_of_swap(session, arguments, v);
    const int result = path ? check_places(session, path, input) : CLI_SUCCESS;
    if (path && result == CLI_SUCCESS && !arguments->common.quiet && arguments->match_preset != ASJ_PRESET_PAPER)
        warn_of_few(session, path, input->file);
    return result;
}

static int detect(cli_session *session, const cli_match_arguments *arguments, const asj_region *region, cli_match_input *input)
{
    const asj_image *image = &input->image->image;
    asj_status status = asj_detect_region(session->context, image, region, &arguments->detect_options, &input->detection);
    if (status == ASJ_OK)
        return CLI_SUCCESS;
    if (status == ASJ_ERROR_OPTION)
        return cli_usage_error("match", "%s", asj_context_message(session->context));
    if (status == ASJ_ERROR_CANCELLED)
        return CLI_FAILED;
    return cli_session_fail(session, input->name, asj_context_message(session->context), status);
}

int cli_match_input_detect(cli_session *session, const cli_match_arguments *arguments, int v, cli_match_input *input)
{
    asj_image_file *mask = NULL;
    asj_region region;
    if (input->file || input->features)
        return CLI_SUCCESS;
    const asj_image *image = &input->image->image;
    int result = cli_region_read_mask(session, &arguments->common, &arguments->regions[v], &mask);
    if (result == CLI_SUCCESS)
        result = cli_region_of(session, &arguments->regions[v], mask, input->name, image, &region);
    if (result == CLI_SUCCESS)
        result = detect(session, arguments, &region, input);
    asj_image_file_free(&mask);
    return result;
}

asj_status cli_match_input_describe(cli_session *session, const cli_match_arguments *arguments, cli_match_input *input)
{
    size_t count;
    if (input->features)
        return ASJ_OK;
    const asj_junction *junctions = cli_match_input_junctions(input, &count);
    return asj_features_create(session->context, &input->pixels, junctions, count, &arguments->options, &input->features);
}

const asj_junction *cli_match_input_junctions(const cli_match_input *input, size_t *count)
{
    *count = input->file ? input->file->junction_count : input->detection ? input->detection->junction_count : 0;
    return input->file ? input->file->junctions : input->detection ? input->detection->junctions : NULL;
}

void cli_match_input_free(cli_match_input *input)
{
    asj_image_file_free(&input->image);
    asj_junction_file_free(&input->file);
    asj_detection_free(&input->detection);
    asj_features_free(&input->features);
}
