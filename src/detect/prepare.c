/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_prepare(): what a first call takes longer for is done ahead: kernels are built, tables and planes made. */
#include "core/backend.h"
#include "core/image.h"

#include <string.h>

/* The kernels of the device, if there is one. */
static asj_status build_kernels(asj_context *context)
{
    asj_status status;
    asj_backend_begin(context);
    do
        status = asj_backend_prepare(context);
    while (asj_backend_retry(context, status));
    return status;
}

/* Dark with a bright rectangle: every step of the detector has something to do. Of three bytes for a pixel with colours. */
static void draw_test_picture(uint8_t *pixels, int32_t width, int32_t height, int32_t bytes)
{
    const size_t row = (size_t)width * (size_t)bytes, left = (size_t)width / 4 * (size_t)bytes;
    memset(pixels, 60, row * (size_t)height);
    for (int32_t y = height / 4; y < height / 2; y++)
        memset(pixels + (size_t)y * row + left, 200, (size_t)width / 2 * (size_t)bytes - left);
    for (size_t k = 0; bytes > 1 && k < row * (size_t)height; k += (size_t)bytes)
        pixels[k] = (uint8_t)(255 - pixels[k]);
}

/* Junctions of the test picture, whose planes nobody wants to see. */
static asj_status detect_without_dumps(asj_context *context, const asj_detect_options *options, const asj_image *image)
{
    const asj_dump_callback dump = context->options.dump;
    asj_detection *found = NULL;
    context->options.dump = NULL;
    const asj_status status = asj_detect(context, image, options, &found);
    context->options.dump = dump;
    asj_detection_free(&found);
    return status;
}

asj_status asj_prepare(asj_context *context, const asj_detect_options *options, int32_t width, int32_t height)
{
    const uint8_t pixel = 0;
    asj_image image = {&pixel, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    asj_status status = asj_image_check(context, &image);
    if (status == ASJ_OK)
        status = build_kernels(context);
    if (status != ASJ_OK)
        return status;
    const int32_t bytes = options && options->colours ? 3 : 1;
    uint8_t *pixels = asj_allocate(&context->memory, (size_t)width * (size_t)height, (size_t)bytes);
    if (!pixels)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for a test picture of %d x %d", (int)width, (int)height);
    draw_test_picture(pixels, width, height, bytes);
    image.format = bytes == 3 ? ASJ_FORMAT_RGB8 : ASJ_FORMAT_GRAY8;
    image.data = pixels;
    status = detect_without_dumps(context, options, &image);
    asj_release(&context->memory, pixels);
    return status;
}
