/* SPDX-License-Identifier: BSD-2-Clause */
/* JPEG 2000 through OpenJPEG: up to 8 bits a sample GRAY8 or RGB8, more than that GRAY16 (colour as luma), spread over the range of
 * the format. Only the codestream that the probe has found is handed on. */
#include "image_buffer.h"

#include <openjpeg.h>

#include <stdio.h>
#include <string.h>

typedef struct jpeg2000_reader {
    const unsigned char *bytes;
    size_t size, at;
    char cause[160]; /* the first complaint */
} jpeg2000_reader;

static OPJ_SIZE_T on_read(void *target, OPJ_SIZE_T size, void *data)
{
    jpeg2000_reader *reader = data;
    size_t left = reader->size - reader->at;
    size_t count = size < left ? size : left;

    if (!count)
        return (OPJ_SIZE_T)-1;
    memcpy(target, reader->bytes + reader->at, count);
    reader->at += count;
    return count;
}

static OPJ_OFF_T on_skip(OPJ_OFF_T size, void *data)
{
    jpeg2000_reader *reader = data;
    if (size < 0 || (uint64_t)size > reader->size - reader->at)
        return -1;
    reader->at += (size_t)size;
    return size;
}

static OPJ_BOOL on_seek(OPJ_OFF_T place, void *data)
{
    jpeg2000_reader *reader = data;
    if (place < 0 || (uint64_t)place > reader->size)
        return OPJ_FALSE;
    reader->at = (size_t)place;
    return OPJ_TRUE;
}

static void on_complaint(const char *text, void *data)
{
    jpeg2000_reader *reader = data;
    if (!reader->cause[0])
        snprintf(reader->cause, sizeof reader->cause, "%.*s", (int)strcspn(text, "\n"), text);
}

/* A sample as it is stored, without its sign, in 0 .. 2^bits - 1. Components may be stored at half resolution. */
static uint32_t sample(const opj_image_t *image, uint32_t component, int32_t x, int32_t y)
{
    const opj_image_comp_t *c = &image->comps[component];
    uint32_t column = (uint32_t)x / c->dx, row = (uint32_t)y / c->dy;
    int32_t value = c->data[(size_t)(row < c->h ? row : c->h - 1) * c->w + (column < c->w ? column : c->w - 1)];
    int32_t most = (int32_t)((1u << c->prec) - 1);

    if (c->sgnd)
        value += 1 << (c->prec - 1);
    return (uint32_t)(value < 0 ? 0 : value > most ? most : value);
}

/* `value` of 0 .. 2^bits - 1 in 0 .. 2^to - 1, rounded. */
static uint32_t spread(uint32_t value, uint32_t bits, uint32_t to)
{
    uint64_t from_most = (1u << bits) - 1, to_most = (1u << to) - 1;
    return bits == to ? value : (uint32_t)((value * to_most + from_most / 2) / from_most);
}

/* sYCC (IEC 61966-2-1, annex F): the YCbCr of JPEG, ITU-T T.871, section 7; `half` is the value of no colour. */
static void ycc_to_rgb(uint32_t colour[3], int32_t half, int32_t most)
{
    double y = (double)colour[0], cb = (double)((int32_t)colour[1] - half), cr = (double)((int32_t)colour[2] - half);
    double rgb[3];
    int i;

    rgb[0] = y + 1.402 * cr;
    rgb[1] = y - (0.114 * 1.772 * cb + 0.299 * 1.402 * cr) / 0.587;
    rgb[2] = y + 1.772 * cb;
    for (i = 0; i < 3; i++)
        colour[i] = rgb[i] <= 0.0 ? 0u : rgb[i] >= (double)most ? (uint32_t)most : (uint32_t)(rgb[i] + 0.5);
}

static void convert(const opj_image_t *image, int is_ycc, asj_image_buffer *buffer)
{
    uint32_t to = buffer->format == ASJ_FORMAT_GRAY16 ? 16 : 8, channels = image->numcomps < 3 ? 1 : 3, i;
    unsigned char *pixel = buffer->pixels;
    int32_t x, y;

    for (y = 0; y < buffer->height; y++)
        for (x = 0; x < buffer->width; x++) {
            uint32_t colour[3];
            for (i = 0; i < channels; i++)
                colour[i] = spread(sample(image, i, x, y), image->comps[i].prec, to);
            if (channels == 3 && is_ycc)
                ycc_to_rgb(colour, 1 << (to - 1), (1 << to) - 1);
            if (to == 16) {
                uint16_t gray = (uint16_t)colour[0];
                if (channels == 3)
                    gray = asj_luma16(colour[0], colour[1], colour[2]);
                memcpy(pixel, &gray, sizeof gray);
                pixel += sizeof gray;
            } else {
                for (i = 0; i < channels; i++)
                    *pixel++ = (unsigned char)colour[i];
            }
        }
}

/* Whether convert() can take the image: sizes and depths that make sense. */
static int is_usual(const opj_image_t *image)
{
    uint32_t channels = image->numcomps < 3 ? 1 : 3, i;
    if (!image->numcomps || image->x1 <= image->x0 || image->y1 <= image->y0)
        return 0;
    for (i = 0; i < channels; i++) {
        const opj_image_comp_t *c = &image->comps[i];
        if (!c->dx || !c->dy || c->dx > 4 || c->dy > 4 || !c->w || !c->h || c->prec < 1 || c->prec > 16)
            return 0;
    }
    return 1;
}

static asj_status decode(opj_codec_t *codec, opj_stream_t *stream, const asj_image_probe *probe, uint64_t max_pixels,
                         jpeg2000_reader *reader, asj_image_buffer *buffer, opj_image_t **image, const asj_message *message)
{
    opj_dparameters_t parameters;
    uint32_t i, deep = 0;
    asj_status status;

    opj_set_default_decoder_parameters(&parameters);
    opj_set_error_handler(codec, on_complaint, reader);
    if (!opj_setup_decoder(codec, &parameters) || !opj_read_header(stream, codec, image))
        return asj_decoder_fail(message, "damaged JPEG 2000", reader->cause);
    if (!is_usual(*image) || (*image)->x1 - (*image)->x0 != probe->width || (*image)->y1 - (*image)->y0 != probe->height)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "an unusual JPEG 2000");
    for (i = 0; i < ((*image)->numcomps < 3 ? 1u : 3u); i++)
        deep |= (*image)->comps[i].prec > 8;
    status = asj_image_allocate(buffer, probe->width, probe->height,
                                deep ? ASJ_FORMAT_GRAY16 : (*image)->numcomps < 3 ? ASJ_FORMAT_GRAY8 : ASJ_FORMAT_RGB8, max_pixels,
                                message);
    if (status != ASJ_OK)
        return status;
    if (!opj_decode(codec, stream, *image) || !opj_end_decompress(codec, stream))
        return asj_decoder_fail(message, "damaged or truncated JPEG 2000", reader->cause);
    for (i = 0; i < ((*image)->numcomps < 3 ? 1u : 3u); i++)
        if (!(*image)->comps[i].data)
            return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged JPEG 2000: a component is missing");
    convert(*image, probe->is_ycc, buffer);
    return ASJ_OK;
}

asj_status asj_jpeg2000_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                               const asj_message *message)
{
    jpeg2000_reader reader = {input->bytes + probe->codestream, input->size - probe->codestream, 0, ""};
    opj_codec_t *codec = opj_create_decompress(OPJ_CODEC_J2K);
    opj_stream_t *stream = opj_stream_default_create(OPJ_TRUE);
    opj_image_t *image = NULL;
    asj_status status;

    if (codec && stream) {
        opj_stream_set_read_function(stream, on_read);
        opj_stream_set_skip_function(stream, on_skip);
        opj_stream_set_seek_function(stream, on_seek);
        opj_stream_set_user_data(stream, &reader, NULL);
        opj_stream_set_user_data_length(stream, reader.size);
        status = decode(codec, stream, probe, max_pixels, &reader, buffer, &image, message);
    } else {
        status = asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory");
    }
    opj_image_destroy(image);
    opj_stream_destroy(stream);
    opj_destroy_codec(codec);
    return status;
}
