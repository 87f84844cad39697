/* SPDX-License-Identifier: BSD-2-Clause */
/* JPEG through libjpeg (libjpeg-turbo): gray becomes GRAY8, colour RGB8; four inks (CMYK, YCCK) become RGB8. The inverse transform
 * is libjpeg's accurate integer one and chroma is interpolated: libjpeg's defaults.
 *
 * What libjpeg makes up in place of damaged data it tells by warnings, and goes on; the first of them ends the reading here
 * (is_damage(): broken codes, data that end early or lose their restart markers). Others tell of what does no harm.
 * Errors leave libjpeg by longjmp(): see png_read.c. */
#include "image_buffer.h"

#include <setjmp.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <jpeglib.h>

#include <jerror.h>

/* More scans than any encoder writes: each costs a walk over the whole image and can be a few bytes long. */
enum { MOST_SCANS = 100 };

typedef struct jpeg_reader {
    struct jpeg_decompress_struct jpeg;
    struct jpeg_error_mgr errors;
    struct jpeg_progress_mgr progress;
    jmp_buf error_exit;
    const asj_message *message;
    asj_status status;
    uint64_t max_pixels;
    asj_image_buffer *buffer;
} jpeg_reader;

static void leave(jpeg_reader *reader, asj_status status)
{
    reader->status = status;
    longjmp(reader->error_exit, 1);
}

static void on_error(j_common_ptr jpeg)
{
    jpeg_reader *reader = jpeg->client_data;
    char cause[JMSG_LENGTH_MAX];

    if (jpeg->err->msg_code == JERR_OUT_OF_MEMORY)
        leave(reader, asj_message_fail(reader->message, ASJ_ERROR_MEMORY, "out of memory for the pixels"));
    jpeg->err->format_message(jpeg, cause);
    leave(reader, asj_message_fail(reader->message, ASJ_ERROR_FORMAT, "damaged or unusual JPEG: %s", cause));
}

/* Surplus bytes before the end marker (0xd9) are no fault: telephones leave them there, and every pixel has been read before. */
static int is_damage(const struct jpeg_error_mgr *errors)
{
    switch (errors->msg_code) {
    case JWRN_ARITH_BAD_CODE:
    case JWRN_HIT_MARKER:
    case JWRN_HUFF_BAD_CODE:
    case JWRN_JPEG_EOF:
    case JWRN_MUST_RESYNC: return 1;
    case JWRN_EXTRANEOUS_DATA: return errors->msg_parm.i[1] != 0xd9;
    default: return 0;
    }
}

static void on_message(j_common_ptr jpeg, int level)
{
    if (level < 0 && is_damage(jpeg->err))
        on_error(jpeg);
}

static void on_output(j_common_ptr jpeg)
{
    (void)jpeg;
}

static void on_progress(j_common_ptr jpeg)
{
    jpeg_reader *reader = jpeg->client_data;
    if (jpeg->is_decompressor && reader->jpeg.input_scan_number > MOST_SCANS)
        leave(reader, asj_message_fail(reader->message, ASJ_ERROR_LIMIT, "a JPEG of more than %d scans", MOST_SCANS));
}

static void open_jpeg(jpeg_reader *reader, const asj_input *input)
{
    struct jpeg_decompress_struct *jpeg = &reader->jpeg;

    jpeg->err = jpeg_std_error(&reader->errors);
    reader->errors.error_exit = on_error;
    reader->errors.emit_message = on_message;
    reader->errors.output_message = on_output;
    jpeg->client_data = reader;
    jpeg_create_decompress(jpeg);
    reader->progress.progress_monitor = on_progress;
    jpeg->progress = &reader->progress;
    jpeg_mem_src(jpeg, input->bytes, (unsigned long)input->size);
}

static void read_header(jpeg_reader *reader)
{
    struct jpeg_decompress_struct *jpeg = &reader->jpeg;
    asj_image_buffer *buffer = reader->buffer;
    asj_status status;

    jpeg_read_header(jpeg, TRUE);
    jpeg->out_color_space = jpeg->num_components == 4 ? JCS_CMYK : jpeg->num_components == 1 ? JCS_GRAYSCALE : JCS_RGB;
    status = asj_image_allocate(buffer, jpeg->image_width, jpeg->image_height,
                                jpeg->num_components == 1 ? ASJ_FORMAT_GRAY8 : ASJ_FORMAT_RGB8, reader->max_pixels,
                                reader->message);
    if (status != ASJ_OK)
        leave(reader, status);
}

/* Adobe's programs store inks inverted, 255 = none; as other readers do (Pillow, OpenCV), so it is taken for every file. */
static void inks_to_rgb(unsigned char *rgb, const unsigned char *inks, int32_t width)
{
    int32_t x;
    for (x = 0; x < width; x++, rgb += 3, inks += 4) {
        rgb[0] = (unsigned char)((inks[0] * inks[3] + 127) / 255);
        rgb[1] = (unsigned char)((inks[1] * inks[3] + 127) / 255);
        rgb[2] = (unsigned char)((inks[2] * inks[3] + 127) / 255);
    }
}

static void read_pixels(jpeg_reader *reader)
{
    struct jpeg_decompress_struct *jpeg = &reader->jpeg;
    asj_image_buffer *buffer = reader->buffer;
    size_t row = (size_t)buffer->width * (size_t)asj_pixel_size(buffer->format);
    JSAMPARRAY inks = NULL;

    jpeg_start_decompress(jpeg);
    if (jpeg->output_width != (JDIMENSION)buffer->width || jpeg->output_height != (JDIMENSION)buffer->height)
        leave(reader, asj_message_fail(reader->message, ASJ_ERROR_FORMAT, "damaged JPEG: its size changes"));
    if (jpeg->out_color_space == JCS_CMYK)
        inks = jpeg->mem->alloc_sarray((j_common_ptr)jpeg, JPOOL_IMAGE, 4 * jpeg->output_width, 1);
    while (jpeg->output_scanline < jpeg->output_height) {
        unsigned char *target = buffer->pixels + (size_t)jpeg->output_scanline * row;
        jpeg_read_scanlines(jpeg, inks ? inks : &target, 1);
        if (inks)
            inks_to_rgb(target, inks[0], buffer->width);
    }
    jpeg_finish_decompress(jpeg);
}

static asj_status decode(jpeg_reader *reader, const asj_input *input)
{
    if (setjmp(reader->error_exit))
        return reader->status;
    open_jpeg(reader, input);
    read_header(reader);
    read_pixels(reader);
    return ASJ_OK;
}

asj_status asj_jpeg_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                           const asj_message *message)
{
    jpeg_reader *reader = calloc(1, sizeof *reader);
    asj_status status;

    if (!reader)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory");
    (void)probe;
    reader->message = message;
    reader->max_pixels = max_pixels;
    reader->buffer = buffer;
    status = decode(reader, input);
    jpeg_destroy_decompress(&reader->jpeg);
    free(reader);
    return status;
}
