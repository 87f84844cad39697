/* SPDX-License-Identifier: BSD-2-Clause */
/* PNG files from image views. See png_read.c for how libpng's errors are left. */
#include <asj/io.h>

#include "image_buffer.h"

#include <png.h>
#include <setjmp.h>
#include <stdlib.h>

typedef struct png_writer {
    jmp_buf error_exit;
    const asj_message *message;
    asj_status status;
    png_structp png;
    png_infop info;
    const asj_image *image;
    asj_output *output;
    int out_of_memory; /* libpng has no status for it */
} png_writer;

static png_voidp on_allocate(png_structp png, png_alloc_size_t size)
{
    png_writer *writer = png_get_mem_ptr(png);
    void *block = malloc(size);
    writer->out_of_memory |= !block;
    return block;
}

static void on_release(png_structp png, png_voidp block)
{
    (void)png;
    free(block);
}

static void on_error(png_structp png, png_const_charp text)
{
    png_writer *writer = png_get_error_ptr(png);
    writer->status = writer->out_of_memory ? asj_message_fail(writer->message, ASJ_ERROR_MEMORY, "out of memory for PNG")
                                           : asj_message_fail(writer->message, ASJ_ERROR_FILE, "cannot write PNG: %s", text);
    longjmp(writer->error_exit, 1);
}

static void on_warning(png_structp png, png_const_charp text)
{
    (void)png;
    (void)text;
}

/* A failed write is remembered by the output, whose commit tells the cause. */
static void on_write(png_structp png, png_bytep bytes, size_t size)
{
    png_writer *writer = png_get_io_ptr(png);
    if (asj_output_write(writer->output, bytes, size) != ASJ_OK) {
        writer->status = ASJ_OK;
        longjmp(writer->error_exit, 1);
    }
}

static void on_flush(png_structp png)
{
    (void)png;
}

static int colour_type(int32_t format)
{
    switch (format) {
    case ASJ_FORMAT_GRAY8:
    case ASJ_FORMAT_GRAY16: return PNG_COLOR_TYPE_GRAY;
    case ASJ_FORMAT_RGB8:
    case ASJ_FORMAT_BGR8: return PNG_COLOR_TYPE_RGB;
    default: return PNG_COLOR_TYPE_RGB_ALPHA;
    }
}

static void write_all(png_writer *writer)
{
    const asj_image *image = writer->image;
    const uint16_t one = 1;
    ptrdiff_t stride = image->stride ? image->stride : (ptrdiff_t)((size_t)image->width * (size_t)asj_pixel_size(image->format));
    int32_t y;

    png_set_write_fn(writer->png, writer, on_write, on_flush);
    png_set_IHDR(writer->png, writer->info, (png_uint_32)image->width, (png_uint_32)image->height,
                 image->format == ASJ_FORMAT_GRAY16 ? 16 : 8, colour_type(image->format), PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_write_info(writer->png, writer->info);
    if (image->format == ASJ_FORMAT_GRAY16 && *(const unsigned char *)&one)
        png_set_swap(writer->png);
    if (image->format == ASJ_FORMAT_BGR8 || image->format == ASJ_FORMAT_BGRA8)
        png_set_bgr(writer->png);
    for (y = 0; y < image->height; y++)
        png_write_row(writer->png, (const unsigned char *)image->data + y * stride);
    png_write_end(writer->png, writer->info);
}

static asj_status encode(png_writer *writer)
{
    if (setjmp(writer->error_exit))
        return writer->status;
    writer->png = png_create_write_struct_2(PNG_LIBPNG_VER_STRING, writer, on_error, on_warning, writer, on_allocate, on_release);
    writer->info = writer->png ? png_create_info_struct(writer->png) : NULL;
    if (!writer->info)
        return asj_message_fail(writer->message, ASJ_ERROR_MEMORY, "out of memory");
    write_all(writer);
    return ASJ_OK;
}

static asj_status check_view(const asj_image *image, const asj_message *message)
{
    if (!asj_pixel_size(image->format) || image->format == ASJ_FORMAT_GRAY_FLOAT)
        return asj_message_fail(message, ASJ_ERROR_IMAGE, "pixel format %d cannot be written as PNG", (int)image->format);
    if (!image->data || image->width < 1 || image->height < 1 || image->width > ASJ_MAX_SIDE || image->height > ASJ_MAX_SIDE)
        return asj_message_fail(message, ASJ_ERROR_IMAGE, "no pixels, or a side outside 1 .. %d", ASJ_MAX_SIDE);
    if (!asj_stride_holds_row(image))
        return asj_message_fail(message, ASJ_ERROR_IMAGE, "the stride is shorter than a row");
    if (!asj_stride_fits_memory(image))
        return asj_message_fail(message, ASJ_ERROR_IMAGE, "the rows are more than memory");
    return ASJ_OK;
}

asj_status asj_png_write(const char *path, const asj_image *image, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    png_writer *writer;
    asj_output *output;
    asj_status status;

    if (!path || !image)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no image");
    status = check_view(image, &message);
    if (status != ASJ_OK)
        return status;
    status = asj_output_begin(path, &output, text, text_size);
    if (status != ASJ_OK)
        return status;
    writer = calloc(1, sizeof *writer);
    if (!writer) {
        asj_output_abort(&output);
        return asj_message_fail(&message, ASJ_ERROR_MEMORY, "out of memory");
    }
    writer->message = &message;
    writer->image = image;
    writer->output = output;
    status = encode(writer);
    if (writer->png)
        png_destroy_write_struct(&writer->png, &writer->info);
    free(writer);
    if (status == ASJ_OK)
        return asj_output_commit(&output, text, text_size);
    asj_output_abort(&output);
    return status;
}
