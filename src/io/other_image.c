/* SPDX-License-Identifier: BSD-2-Clause */
/* Image formats other than PNG: looked at by image_probe.c, decoded by OpenCV, brought into one of this library's formats here.
 *   8 bits    GRAY8 or BGR8
 *   16 bits   GRAY16; colour as luma
 *   floats    GRAY_FLOAT; colour as luma; 1.0 is white */
#include <asj/io.h>

#include "exif.h"
#include "image_buffer.h"
#include "image_probe.h"

#include <stdlib.h>
#include <string.h>

#ifdef ASJ_IO_HAVE_OPENCV
#include "opencv_shim.h"

int32_t asj_io_has_opencv(void)
{
    return 1;
}

static float sample_float(const asj_opencv_image *image, const unsigned char *row, size_t index)
{
    float single;
    double wide;
    if (image->sample == ASJ_OPENCV_F32) {
        memcpy(&single, row + 4 * index, sizeof single);
        return single;
    }
    memcpy(&wide, row + 8 * index, sizeof wide);
    return (float)wide;
}

static void convert_row(const asj_opencv_image *image, const unsigned char *row, unsigned char *target)
{
    size_t channels = (size_t)image->channels, x;

    for (x = 0; x < (size_t)image->width; x++) {
        if (image->sample == ASJ_OPENCV_U8) {
            memcpy(target + (channels < 3 ? 1 : 3) * x, row + channels * x, channels < 3 ? 1 : 3);
        } else if (image->sample == ASJ_OPENCV_U16) {
            uint16_t s[3];
            memcpy(s, row + 2 * channels * x, channels < 3 ? 2 : 6);
            if (channels >= 3)
                s[0] = asj_luma16(s[2], s[1], s[0]);
            memcpy(target + 2 * x, s, 2);
        } else {
            float value = sample_float(image, row, channels * x);
            if (channels >= 3)
                value = (77.0f * sample_float(image, row, channels * x + 2) + 150.0f * sample_float(image, row, channels * x + 1) +
                         29.0f * value) / 256.0f;
            memcpy(target + 4 * x, &value, 4);
        }
    }
}

static asj_status convert(const asj_opencv_image *image, asj_image_buffer *buffer, const asj_message *message)
{
    size_t row;
    int32_t y;

    if (image->sample == ASJ_OPENCV_OTHER)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "its samples are signed integers");
    buffer->width = image->width;
    buffer->height = image->height;
    buffer->format = image->sample == ASJ_OPENCV_U8 ? (image->channels < 3 ? ASJ_FORMAT_GRAY8 : ASJ_FORMAT_BGR8)
                     : image->sample == ASJ_OPENCV_U16 ? ASJ_FORMAT_GRAY16 : ASJ_FORMAT_GRAY_FLOAT;
    row = (size_t)buffer->width * asj_pixel_size(buffer->format);
    buffer->pixels = malloc((size_t)buffer->height * row);
    if (!buffer->pixels)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for the pixels");
    for (y = 0; y < buffer->height; y++)
        convert_row(image, image->pixels + (size_t)y * image->stride, buffer->pixels + (size_t)y * row);
    return ASJ_OK;
}

static asj_status decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                         const asj_message *message)
{
    asj_opencv_image image;
    char cause[256];
    asj_status status;

    if (probe->is_tiff)
        asj_tiff_set_upright(input->bytes, input->size);
    if (probe->needs_path && !input->is_regular)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "%s is read from regular files only", probe->name);
    status = asj_opencv_decode(input->bytes, input->size, probe->needs_path ? message->path : NULL, &image, cause, sizeof cause);
    if (status == ASJ_ERROR_MEMORY)
        return asj_message_fail(message, status, "out of memory for the pixels");
    if (status != ASJ_OK && probe->is_uncommon)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "%s is not read by this build of OpenCV", probe->name);
    if (status != ASJ_OK)
        return asj_message_fail(message, status, "damaged or unusual %s%s%s", probe->name, cause[0] ? ": " : "", cause);
    status = asj_check_declared_size((uint64_t)image.width, (uint64_t)image.height, max_pixels, message);
    if (status == ASJ_OK)
        status = convert(&image, buffer, message);
    asj_opencv_release(&image);
    return status;
}

#else

int32_t asj_io_has_opencv(void)
{
    return 0;
}

static asj_status decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                         const asj_message *message)
{
    (void)input;
    (void)max_pixels;
    (void)buffer;
    return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "%s: this build reads PNG only (it was made without OpenCV)",
                            probe->name);
}

#endif

asj_status asj_other_decode(const asj_input *input, uint64_t max_pixels, asj_image_buffer *buffer, const asj_message *message)
{
    asj_image_probe probe;
    asj_status status;

    asj_probe_image(input, &probe);
    if (!probe.name)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "not an image: its content is of no known image format");
    if (probe.has_size) {
        status = asj_check_declared_size(probe.width, probe.height, max_pixels, message);
        if (status != ASJ_OK)
            return status;
    }
    if (probe.is_truncated)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "truncated %s: the file ends before the image does", probe.name);
    buffer->orientation = probe.orientation;
    return decode(input, &probe, max_pixels, buffer, message);
}
