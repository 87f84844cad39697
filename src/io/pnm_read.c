/* SPDX-License-Identifier: BSD-2-Clause */
/* PBM, PGM, PPM, PAM: up to 255 levels GRAY8 or RGB8, more than that GRAY16 (colour as luma), spread over the range of the format.
 * PFM: GRAY_FLOAT, colour as luma, values as stored. */
#include "image_buffer.h"
#include "pnm_header.h"

#include <string.h>

typedef struct pnm_reader {
    const asj_input *input;
    asj_pnm_header header;
    size_t at;
    int is_bad; /* a number is missing, or too large */
} pnm_reader;

/* PBM: 1 is black. In text the bits may stand without blanks between them. */
static uint32_t next_bit(pnm_reader *reader)
{
    const unsigned char *b = reader->input->bytes;
    while (reader->at < reader->input->size && b[reader->at] != '0' && b[reader->at] != '1')
        reader->at++;
    if (reader->at == reader->input->size) {
        reader->is_bad = 1;
        return 0;
    }
    return b[reader->at++] == '0';
}

static uint32_t next_sample(pnm_reader *reader)
{
    const unsigned char *b = reader->input->bytes;
    uint64_t value = 0;

    if (reader->header.type == '1')
        return next_bit(reader);
    if (reader->header.is_text) {
        reader->is_bad |= !asj_pnm_number(reader->input, &reader->at, &value);
    } else if (reader->header.most > 255) {
        value = (uint64_t)b[reader->at] << 8 | b[reader->at + 1];
        reader->at += 2;
    } else {
        value = b[reader->at++];
    }
    return value < reader->header.most ? (uint32_t)value : reader->header.most;
}

static void read_row(pnm_reader *reader, asj_image_buffer *buffer, unsigned char *row)
{
    uint32_t most = reader->header.most, to = buffer->format == ASJ_FORMAT_GRAY16 ? 65535 : 255, i;
    int32_t x;

    for (x = 0; x < buffer->width; x++) {
        uint32_t s[4] = {0};
        for (i = 0; i < reader->header.samples; i++) {
            s[i] = next_sample(reader);
            if (most != to)
                s[i] = (s[i] * to + most / 2) / most;
        }
        if (buffer->format == ASJ_FORMAT_GRAY16) {
            uint16_t gray = (uint16_t)s[0];
            if (reader->header.samples >= 3)
                gray = asj_luma16(s[0], s[1], s[2]);
            memcpy(row + 2 * (size_t)x, &gray, 2);
        } else if (buffer->format == ASJ_FORMAT_RGB8) {
            for (i = 0; i < 3; i++)
                row[3 * (size_t)x + i] = (unsigned char)s[i];
        } else {
            row[x] = (unsigned char)s[0];
        }
    }
}

/* Rows of packed bits begin at whole bytes. */
static void read_bit_row(pnm_reader *reader, asj_image_buffer *buffer, unsigned char *row)
{
    const unsigned char *b = reader->input->bytes + reader->at;
    int32_t x;
    for (x = 0; x < buffer->width; x++)
        row[x] = b[x / 8] >> (7 - x % 8) & 1 ? 0 : 255;
    reader->at += (size_t)((buffer->width + 7) / 8);
}

static float next_float(pnm_reader *reader)
{
    const unsigned char *b = reader->input->bytes + reader->at;
    uint32_t bits = (uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3];
    float value;

    if (reader->header.is_little_endian)
        bits = (uint32_t)b[3] << 24 | (uint32_t)b[2] << 16 | (uint32_t)b[1] << 8 | b[0];
    reader->at += 4;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static void read_float_row(pnm_reader *reader, asj_image_buffer *buffer, unsigned char *row)
{
    int32_t x;
    for (x = 0; x < buffer->width; x++) {
        float value = next_float(reader);
        if (reader->header.samples == 3) {
            float green = next_float(reader), blue = next_float(reader);
            value = asj_luma_float(value, green, blue);
        }
        memcpy(row + 4 * (size_t)x, &value, 4);
    }
}

asj_status asj_pnm_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                          const asj_message *message)
{
    pnm_reader reader;
    int32_t format, y;
    size_t row;
    asj_status status;

    (void)probe; /* has found the header good, and enough bytes behind it */
    reader.input = input;
    reader.is_bad = !asj_pnm_read_header(input, &reader.header);
    reader.at = reader.header.pixels;
    format = !reader.header.most ? ASJ_FORMAT_GRAY_FLOAT : reader.header.most > 255 ? ASJ_FORMAT_GRAY16
             : reader.header.samples >= 3 ? ASJ_FORMAT_RGB8 : ASJ_FORMAT_GRAY8;
    status = asj_image_allocate(buffer, reader.header.width, reader.header.height, format, max_pixels, message);
    if (status != ASJ_OK)
        return status;
    row = (size_t)buffer->width * (size_t)asj_pixel_size(format);
    for (y = 0; y < buffer->height && !reader.is_bad; y++) {
        if (format == ASJ_FORMAT_GRAY_FLOAT) /* the bottom row comes first */
            read_float_row(&reader, buffer, buffer->pixels + (size_t)(buffer->height - 1 - y) * row);
        else if (reader.header.type == '4')
            read_bit_row(&reader, buffer, buffer->pixels + (size_t)y * row);
        else
            read_row(&reader, buffer, buffer->pixels + (size_t)y * row);
    }
    return reader.is_bad ? asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged or truncated PNM") : ASJ_OK;
}
