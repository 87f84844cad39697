/* SPDX-License-Identifier: BSD-2-Clause */
/* Image files: reads the bytes, has the decoder of their kind decode them, turns the pixels upright. */
#include <asj/io.h>

#include "exif.h"
#include "image_buffer.h"
#include "image_probe.h"

#include <stdlib.h>

/* What asj_image_file points to: the public part first. */
typedef struct owned_image {
    asj_image_file file;
    unsigned char *pixels;
} owned_image;

/* Exchanges the pixels for an upright copy. */
static asj_status turn_upright(asj_image_buffer *buffer, const asj_message *message)
{
    size_t size = (size_t)asj_pixel_size(buffer->format);
    int32_t width = buffer->width;
    unsigned char *copy;

    if (buffer->orientation == 1)
        return ASJ_OK;
    copy = malloc((size_t)buffer->width * (size_t)buffer->height * size);
    if (!copy)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for the pixels");
    asj_turn_upright(copy, buffer->pixels, (ptrdiff_t)((size_t)width * size), width, buffer->height, size, buffer->orientation);
    free(buffer->pixels);
    buffer->pixels = copy;
    if (buffer->orientation >= 5) {
        buffer->width = buffer->height;
        buffer->height = width;
    }
    return ASJ_OK;
}

/* What the file's structure says comes first; then the decoder of its kind. */
static asj_status decode(const asj_input *input, uint64_t max_pixels, asj_image_buffer *buffer, const asj_message *message)
{
    asj_image_decoder *decoder;
    asj_image_probe probe;
    asj_status status;

    asj_probe_image(input, &probe);
    decoder = asj_decoder_of(probe.kind);
    if (probe.has_size) {
        status = asj_check_declared_size(probe.width, probe.height, max_pixels, message);
        if (status != ASJ_OK)
            return status;
    }
    if (probe.is_truncated)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "truncated %s: the file ends before the image does", probe.name);
    if (probe.fault)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged or unusual %s: %s", probe.name, probe.fault);
    if (!decoder)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "%s is not read by this build, which reads %s", probe.name,
                                asj_io_image_formats());
    if (!probe.has_size && probe.kind != ASJ_KIND_PNG)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged or unusual %s: its header does not tell its size", probe.name);
    buffer->orientation = probe.orientation;
    buffer->has_more = probe.has_more;
    status = decoder(input, &probe, max_pixels, buffer, message);
#ifdef ASJ_IO_HAVE_EXIF
    if (status == ASJ_OK && probe.exif)
        asj_exif_lens(probe.exif, probe.exif_size, &buffer->lens);
#endif
    return status;
}

static asj_status wrap(const asj_image_buffer *buffer, asj_image_file **file, const asj_message *message)
{
    owned_image *owned = calloc(1, sizeof *owned);
    if (!owned)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory");
    owned->pixels = buffer->pixels;
    owned->file.image.data = buffer->pixels;
    owned->file.image.format = buffer->format;
    owned->file.image.width = buffer->width;
    owned->file.image.height = buffer->height;
    owned->file.orientation = buffer->orientation;
    owned->file.has_more = buffer->has_more;
    owned->file.focal_length = (float)asj_lens_focal(&buffer->lens, buffer->width, buffer->height, &owned->file.focal_source);
    *file = &owned->file;
    return ASJ_OK;
}

static const char *is_no_image(const asj_input *head)
{
    if (asj_input_is_features(head))
        return "not an image but a file of features (.asjf), which is for matching";
    return asj_probe_kind(head) == ASJ_KIND_UNKNOWN ? "not an image: its content is of no known image format" : NULL;
}

asj_status asj_image_file_read(const char *path, uint64_t max_pixels, asj_image_file **file, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    asj_image_buffer buffer = {0};
    asj_input input;
    asj_status status;

    if (file)
        *file = NULL;
    if (!path || !file)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no place for the image");
    if (!max_pixels)
        max_pixels = ASJ_IO_DEFAULT_MAX_PIXELS;
    status = asj_input_read(&input, is_no_image, &message);
    if (status != ASJ_OK)
        return status;
    status = decode(&input, max_pixels, &buffer, &message);
    free(input.bytes);
    if (status == ASJ_OK)
        status = turn_upright(&buffer, &message);
    if (status == ASJ_OK)
        status = wrap(&buffer, file, &message);
    if (status != ASJ_OK)
        free(buffer.pixels);
    return status;
}

void asj_image_file_free(asj_image_file **file)
{
    owned_image *owned;
    if (!file || !*file)
        return;
    owned = (owned_image *)(void *)*file;
    free(owned->pixels);
    free(owned);
    *file = NULL;
}
