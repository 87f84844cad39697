/* SPDX-License-Identifier: BSD-2-Clause */
/* An image and its junctions for match. */
#include "match_input.h"
#include "message.h"

#include <stdio.h>

enum { MESSAGE_SIZE = 1024 };

static int is_outside(const asj_junction *junction, const asj_image *image)
{
    return junction->x < -ASJ_MAX_OUTSIDE || junction->y < -ASJ_MAX_OUTSIDE ||
           junction->x > (float)(image->width - 1 + ASJ_MAX_OUTSIDE) || junction->y > (float)(image->height - 1 + ASJ_MAX_OUTSIDE);
}

static int check_places(cli_session *session, const char *path, const cli_match_input *input)
{
    char message[MESSAGE_SIZE];
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

int cli_match_input_read(cli_session *session, const cli_match_arguments *arguments, int v, cli_match_input *input)
{
    char message[MESSAGE_SIZE] = "";
    const char *path = arguments->junctions[v];
    double start = cli_now_ms();
    input->name = arguments->images[v];
    asj_status status = asj_image_file_read(input->name, arguments->common.max_pixels, &input->image, message, sizeof message);
    if (status != ASJ_OK)
        return cli_session_fail(session, input->name, message, status);
    if (path && (status = asj_junctions_read(path, &input->file, message, sizeof message)) != ASJ_OK)
        return cli_session_fail(session, path, message, status);
    input->read_ms = cli_now_ms() - start;
    return path ? check_places(session, path, input) : CLI_SUCCESS;
}

int cli_match_input_detect(cli_session *session, const cli_match_arguments *arguments, cli_match_input *input)
{
    if (input->file)
        return CLI_SUCCESS;
    asj_status status = asj_detect(session->context, &input->image->image, &arguments->detect_options, &input->detection);
    if (status == ASJ_OK)
        return CLI_SUCCESS;
    if (status == ASJ_ERROR_OPTION)
        return cli_usage_error("match", "%s", asj_context_message(session->context));
    if (status == ASJ_ERROR_CANCELLED)
        return CLI_FAILED;
    return cli_session_fail(session, input->name, asj_context_message(session->context), status);
}

const asj_junction *cli_match_input_junctions(const cli_match_input *input, size_t *count)
{
    *count = input->file ? input->file->junction_count : input->detection->junction_count;
    return input->file ? input->file->junctions : input->detection->junctions;
}

void cli_match_input_free(cli_match_input *input)
{
    asj_image_file_free(&input->image);
    asj_junction_file_free(&input->file);
    asj_detection_free(&input->detection);
}
