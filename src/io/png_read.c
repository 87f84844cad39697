/* SPDX-License-Identifier: BSD-2-Clause */
/* PNG through libpng. Every kind of PNG becomes one of three:
 *   gray of 1 to 8 bits, gray with alpha   GRAY8   (1, 2 and 4 bits are spread over 0 .. 255)
 *   gray of 16 bits                        GRAY16
 *   palette, RGB, RGBA of 8 bits           RGB8
 *   RGB, RGBA of 16 bits                   GRAY16, as luma: the library looks at luma only, and 8 bits would lose depth
 * Alpha and transparent colours are ignored: the stored colours count. Gamma is left as stored, as every other decoder here does.
 *
 * Errors leave libpng by longjmp(). All state lives in the png_reader, outside the function that calls setjmp(), so that nothing
 * there can be clobbered; what must be freed hangs on it. */
#include "image_buffer.h"

#include "bytes.h"
#include "exif.h"

#include <png.h>
#include <setjmp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct png_reader {
    jmp_buf error_exit;
    const asj_message *message;
    asj_status status;
    png_structp png;
    png_infop info;
    const unsigned char *next; /* unread bytes of the file */
    size_t left;
    uint64_t max_pixels;
    char warning[128];         /* libpng's first warning: it often tells the cause of the error that follows */
    asj_image_buffer *buffer;
    unsigned char *raw;        /* rows as libpng gives them */
    size_t raw_row;            /* bytes of one */
    int colour16;              /* raw rows are 16-bit RGB, still to be reduced */
    int out_of_memory;         /* libpng has no status for it */
} png_reader;

static void leave(png_reader *reader, asj_status status)
{
    reader->status = status;
    longjmp(reader->error_exit, 1);
}

static png_voidp on_allocate(png_structp png, png_alloc_size_t size)
{
    png_reader *reader = png_get_mem_ptr(png);
    void *block = malloc(size);
    reader->out_of_memory |= !block;
    return block;
}

static void on_release(png_structp png, png_voidp block)
{
    (void)png;
    free(block);
}

static void on_error(png_structp png, png_const_charp text)
{
    png_reader *reader = png_get_error_ptr(png);
    const char *cause = reader->warning[0] ? reader->warning : NULL;
    if (reader->out_of_memory)
        leave(reader, asj_message_fail(reader->message, ASJ_ERROR_MEMORY, "out of memory for PNG"));
    leave(reader, asj_message_fail(reader->message, ASJ_ERROR_FORMAT, "damaged PNG: %s%s%s%s", text, cause ? " (" : "",
                                   cause ? cause : "", cause ? ")" : ""));
}

static void on_warning(png_structp png, png_const_charp text)
{
    png_reader *reader = png_get_error_ptr(png);
    if (!reader->warning[0])
        snprintf(reader->warning, sizeof reader->warning, "%s", text);
}

static void on_read(png_structp png, png_bytep bytes, size_t size)
{
    png_reader *reader = png_get_io_ptr(png);
    if (size > reader->left)
        leave(reader, asj_message_fail(reader->message, ASJ_ERROR_FORMAT, "truncated PNG: the file ends too early"));
    memcpy(bytes, reader->next, size);
    reader->next += size;
    reader->left -= size;
}

/* Memory for `rows` rows, or leaves. */
static unsigned char *allocate_rows(png_reader *reader, size_t rows, size_t row)
{
    unsigned char *memory = row && rows > SIZE_MAX / row ? NULL : malloc(rows * row);
    if (!memory)
        leave(reader, asj_message_fail(reader->message, ASJ_ERROR_MEMORY, "out of memory for the pixels"));
    return memory;
}

/* Chunks that say nothing about the pixels are not kept: compressed text and profiles can unpack to a thousand times their size.
 * Their checksums are looked at all the same. */
static void skip_descriptions(png_structp png)
{
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, NULL, -1);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_AS_DEFAULT, (png_const_bytep)"eXIf", 1);
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_ALWAYS, (png_const_bytep)"acTL", 1);
    png_set_chunk_malloc_max(png, 1 << 20);
}

static void open_png(png_reader *reader)
{
    reader->png = png_create_read_struct_2(PNG_LIBPNG_VER_STRING, reader, on_error, on_warning, reader, on_allocate, on_release);
    reader->info = reader->png ? png_create_info_struct(reader->png) : NULL;
    if (!reader->info)
        leave(reader, asj_message_fail(reader->message, ASJ_ERROR_MEMORY, "out of memory"));
    png_set_read_fn(reader->png, reader, on_read);
    skip_descriptions(reader->png);
    png_set_crc_action(reader->png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
    png_set_user_limits(reader->png, 0x7fffffff, 0x7fffffff); /* the declared size is checked below, with a better message */
}

/* Animated PNG: acTL, before the pixels, begins with the number of frames. */
static int has_more(const png_reader *reader)
{
    png_unknown_chunkp chunks = NULL;
    const int count = png_get_unknown_chunks(reader->png, reader->info, &chunks);
    return count > 0 && chunks[0].size >= 4 && asj_big32(chunks[0].data) > 1;
}

/* Everything before the pixels; asks libpng for one of the forms above. */
static void read_header(png_reader *reader)
{
    png_structp png = reader->png;
    png_infop info = reader->info;
    asj_image_buffer *buffer = reader->buffer;
    int type, depth;

    png_read_info(png, info);
    reader->status = asj_check_declared_size(png_get_image_width(png, info), png_get_image_height(png, info), reader->max_pixels,
                                             reader->message);
    if (reader->status != ASJ_OK)
        leave(reader, reader->status);
    type = png_get_color_type(png, info);
    depth = png_get_bit_depth(png, info);
    if (type == PNG_COLOR_TYPE_PALETTE)
        png_set_palette_to_rgb(png);
    if (type == PNG_COLOR_TYPE_GRAY && depth < 8)
        png_set_expand_gray_1_2_4_to_8(png);
    png_set_strip_alpha(png);
    if (depth == 16) {
        const uint16_t one = 1;
        if (*(const unsigned char *)&one)
            png_set_swap(png);
    }
    buffer->has_more = has_more(reader);
    reader->colour16 = depth == 16 && (type & PNG_COLOR_MASK_COLOR);
    buffer->format = depth == 16 ? ASJ_FORMAT_GRAY16 : type & PNG_COLOR_MASK_COLOR ? ASJ_FORMAT_RGB8 : ASJ_FORMAT_GRAY8;
    buffer->width = (int32_t)png_get_image_width(png, info);
    buffer->height = (int32_t)png_get_image_height(png, info);
}

static void reduce_row(uint16_t *gray, const unsigned char *rgb, int32_t width)
{
    int32_t x;
    for (x = 0; x < width; x++) {
        uint16_t sample[3];
        memcpy(sample, rgb + 6 * (size_t)x, sizeof sample);
        gray[x] = asj_luma16(sample[0], sample[1], sample[2]);
    }
}

/* Passes of an interlaced file build every row up bit by bit, so the raw image is then kept whole; else one raw row will do. */
static void read_pixels(png_reader *reader)
{
    asj_image_buffer *buffer = reader->buffer;
    size_t row = (size_t)buffer->width * (size_t)asj_pixel_size(buffer->format);
    int passes = png_set_interlace_handling(reader->png), pass;
    int32_t y;

    png_read_update_info(reader->png, reader->info);
    reader->raw_row = png_get_rowbytes(reader->png, reader->info);
    if (reader->raw_row != (reader->colour16 ? 3 * row : row))
        leave(reader, asj_message_fail(reader->message, ASJ_ERROR_FORMAT, "damaged PNG: rows of an unexpected length"));
    buffer->pixels = allocate_rows(reader, (size_t)buffer->height, row);
    if (reader->colour16)
        reader->raw = allocate_rows(reader, passes > 1 ? (size_t)buffer->height : 1, reader->raw_row);
    for (pass = 0; pass < passes; pass++)
        for (y = 0; y < buffer->height; y++) {
            unsigned char *target = buffer->pixels + (size_t)y * row;
            unsigned char *raw = reader->raw ? reader->raw + (passes > 1 ? (size_t)y * reader->raw_row : 0) : target;
            png_read_row(reader->png, raw, NULL);
            if (reader->raw && pass == passes - 1)
                reduce_row((uint16_t *)(void *)target, raw, buffer->width);
        }
}

/* Everything after the pixels: a file that lacks it is cut off, and eXIf may stand there. */
static void read_end(png_reader *reader)
{
    png_bytep block = NULL;
    png_uint_32 size = 0;

    png_read_end(reader->png, reader->info);
    reader->buffer->orientation = 1;
    if (!png_get_eXIf_1(reader->png, reader->info, &size, &block))
        return;
    reader->buffer->orientation = asj_exif_orientation(block, size);
#ifdef ASJ_IO_HAVE_EXIF
    asj_exif_lens(block, size, &reader->buffer->lens);
#endif
}

static asj_status decode(png_reader *reader)
{
    if (setjmp(reader->error_exit))
        return reader->status;
    open_png(reader);
    read_header(reader);
    read_pixels(reader);
    read_end(reader);
    return ASJ_OK;
}

asj_status asj_png_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                          const asj_message *message)
{
    png_reader *reader = calloc(1, sizeof *reader);
    asj_status status;

    (void)probe;
    if (!reader)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory");
    reader->message = message;
    reader->next = input->bytes;
    reader->left = input->size;
    reader->max_pixels = max_pixels;
    reader->buffer = buffer;
    status = decode(reader);
    if (reader->png)
        png_destroy_read_struct(&reader->png, &reader->info, NULL);
    free(reader->raw);
    free(reader);
    return status;
}
