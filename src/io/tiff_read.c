/* SPDX-License-Identifier: BSD-2-Clause */
/* TIFF and BigTIFF through libtiff, the first image of a file.
 *   gray and RGB of 8 bits       GRAY8, RGB8, samples as stored; white as 0 is turned round
 *   gray and RGB of 16 bits      GRAY16; colour as luma
 *   floats of 32 and 64 bits     GRAY_FLOAT; colour as luma
 *   palette, YCbCr, CMYK, 1 to 7 bits, ...   what libtiff makes of them in 8 bits, GRAY8 or RGB8
 * Libtiff reads the bytes in memory where they are. Its complaints are heard per file, which needs version 4.5. */
#include "image_buffer.h"

#include "exif.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <tiffio.h>

/* What libtiff may ask for at once beyond the pixels and the file: tables of strips, a tile. */
enum { SPARE_BYTES = 32 * 1024 * 1024, MOST_SAMPLES = 8 };

typedef struct tiff_reader {
    const asj_input *input;
    uint64_t at;
    TIFF *tiff;
    char cause[160]; /* the first error */
    uint32_t width, height;
    uint16_t samples, bits, format, photometric, planes;
    size_t channels, depth; /* samples that count, bytes of one */
    unsigned char *raw;     /* width * height * channels of `depth` bytes */
} tiff_reader;

/* ---- the file in memory ---- */

static tmsize_t on_read(thandle_t handle, void *target, tmsize_t size)
{
    tiff_reader *reader = handle;
    uint64_t left = reader->at < reader->input->size ? reader->input->size - reader->at : 0;
    uint64_t count = (uint64_t)size < left ? (uint64_t)size : left;
    memcpy(target, reader->input->bytes + (count ? reader->at : 0), (size_t)count);
    reader->at += count;
    return (tmsize_t)count;
}

static tmsize_t on_write(thandle_t handle, void *source, tmsize_t size)
{
    (void)handle;
    (void)source;
    (void)size;
    return 0;
}

static uint64_t on_seek(thandle_t handle, uint64_t offset, int from)
{
    tiff_reader *reader = handle;
    reader->at = (from == SEEK_CUR ? reader->at : from == SEEK_END ? reader->input->size : 0) + offset;
    return reader->at;
}

static int on_close(thandle_t handle)
{
    (void)handle;
    return 0;
}

static uint64_t on_size(thandle_t handle)
{
    const tiff_reader *reader = handle;
    return reader->input->size;
}

static int on_map(thandle_t handle, void **base, toff_t *size)
{
    const tiff_reader *reader = handle;
    *base = reader->input->bytes;
    *size = reader->input->size;
    return 1;
}

static void on_unmap(thandle_t handle, void *base, toff_t size)
{
    (void)handle;
    (void)base;
    (void)size;
}

static int on_error(TIFF *tiff, void *data, const char *module, const char *format, va_list arguments)
{
    tiff_reader *reader = data;
    (void)tiff;
    (void)module;
    if (!reader->cause[0])
        vsnprintf(reader->cause, sizeof reader->cause, format, arguments);
    return 1;
}

/* Unknown tags and the like. */
static int on_warning(TIFF *tiff, void *data, const char *module, const char *format, va_list arguments)
{
    (void)tiff;
    (void)data;
    (void)module;
    (void)format;
    (void)arguments;
    return 1;
}

static TIFF *open_tiff(tiff_reader *reader, const asj_image_probe *probe)
{
    TIFFOpenOptions *options = TIFFOpenOptionsAlloc();
    TIFF *tiff;

    if (!options)
        return NULL;
    TIFFOpenOptionsSetErrorHandlerExtR(options, on_error, reader);
    TIFFOpenOptionsSetWarningHandlerExtR(options, on_warning, reader);
    TIFFOpenOptionsSetMaxSingleMemAlloc(options,
                                        (tmsize_t)(SPARE_BYTES + reader->input->size + 4 * probe->width * probe->height));
    tiff = TIFFClientOpenExt("TIFF", "r", reader, on_read, on_write, on_seek, on_close, on_size, on_map, on_unmap, options);
    TIFFOpenOptionsFree(options);
    return tiff;
}

/* ---- samples as they are stored ---- */

static int is_plain(const tiff_reader *reader)
{
    int is_integer = reader->format == SAMPLEFORMAT_UINT && (reader->bits == 8 || reader->bits == 16);
    int is_float = reader->format == SAMPLEFORMAT_IEEEFP && (reader->bits == 32 || reader->bits == 64);
    int is_gray = reader->photometric == PHOTOMETRIC_MINISBLACK || (reader->photometric == PHOTOMETRIC_MINISWHITE && is_integer);
    return (is_integer || is_float) && (is_gray || (reader->photometric == PHOTOMETRIC_RGB && reader->samples >= 3));
}

/* `count` pixels from a scan line or a row of a tile to (x, y). `plane`: which sample they are when each has a plane of its own. */
static void store(const tiff_reader *reader, const unsigned char *from, uint32_t x, uint32_t y, uint32_t count, uint16_t plane)
{
    int is_separate = reader->planes == PLANARCONFIG_SEPARATE;
    size_t pixel = reader->channels * reader->depth, step = is_separate ? reader->depth : reader->samples * reader->depth;
    size_t size = is_separate ? reader->depth : pixel;
    unsigned char *to = reader->raw + ((size_t)y * reader->width + x) * pixel + (is_separate ? plane * reader->depth : 0);
    uint32_t i;

    for (i = 0; i < count; i++, to += pixel, from += step)
        memcpy(to, from, size);
}

static int read_rows(tiff_reader *reader, unsigned char *row, uint16_t plane)
{
    uint32_t y;
    for (y = 0; y < reader->height; y++) {
        if (TIFFReadScanline(reader->tiff, row, y, plane) < 0)
            return 0;
        store(reader, row, 0, y, reader->width, plane);
    }
    return 1;
}

static int read_tiles(tiff_reader *reader, unsigned char *tile, uint32_t width, uint32_t height, uint16_t plane)
{
    size_t row = (reader->planes == PLANARCONFIG_SEPARATE ? 1u : reader->samples) * reader->depth * width;
    uint32_t x, y, i;

    for (y = 0; y < reader->height; y += height)
        for (x = 0; x < reader->width; x += width) {
            uint32_t rows = reader->height - y < height ? reader->height - y : height;
            if (TIFFReadTile(reader->tiff, tile, x, y, 0, plane) < 0)
                return 0;
            for (i = 0; i < rows; i++)
                store(reader, tile + i * row, x, y + i, reader->width - x < width ? reader->width - x : width, plane);
        }
    return 1;
}

static asj_status read_plain(tiff_reader *reader, const asj_message *message)
{
    size_t in_buffer = reader->planes == PLANARCONFIG_SEPARATE ? 1u : reader->samples, wanted;
    uint32_t tile_width = reader->width, tile_height = 1;
    int is_tiled = TIFFIsTiled(reader->tiff), good = 1;
    uint16_t plane, planes = (uint16_t)(reader->planes == PLANARCONFIG_SEPARATE ? reader->channels : 1);
    unsigned char *buffer;

    if (is_tiled) {
        TIFFGetField(reader->tiff, TIFFTAG_TILEWIDTH, &tile_width);
        TIFFGetField(reader->tiff, TIFFTAG_TILELENGTH, &tile_height);
    }
    wanted = in_buffer * reader->depth * tile_width * tile_height;
    if ((uint64_t)(is_tiled ? TIFFTileSize64(reader->tiff) : TIFFScanlineSize64(reader->tiff)) != wanted)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "an unusual TIFF: rows of an unexpected length");
    buffer = malloc(wanted);
    reader->raw = malloc((size_t)reader->width * reader->height * reader->channels * reader->depth);
    if (!buffer || !reader->raw) {
        free(buffer);
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for the pixels");
    }
    for (plane = 0; plane < planes && good; plane++)
        good = is_tiled ? read_tiles(reader, buffer, tile_width, tile_height, plane) : read_rows(reader, buffer, plane);
    free(buffer);
    return good ? ASJ_OK : asj_decoder_fail(message, "damaged or truncated TIFF", reader->cause);
}

static float float_at(const unsigned char *from, size_t depth)
{
    float single;
    double wide;
    if (depth == 4) {
        memcpy(&single, from, sizeof single);
        return single;
    }
    memcpy(&wide, from, sizeof wide);
    return (float)wide;
}

/* Raw samples of 16 bits or floats, to one sample a pixel. */
static void reduce(const tiff_reader *reader, asj_image_buffer *buffer)
{
    size_t count = (size_t)reader->width * reader->height, pixel = reader->channels * reader->depth, i;
    const unsigned char *from = reader->raw;

    for (i = 0; i < count; i++, from += pixel)
        if (reader->depth == 2) {
            uint16_t s[3];
            memcpy(s, from, pixel);
            if (reader->channels == 3)
                s[0] = asj_luma16(s[0], s[1], s[2]);
            if (reader->photometric == PHOTOMETRIC_MINISWHITE)
                s[0] = (uint16_t)(65535 - s[0]);
            memcpy(buffer->pixels + 2 * i, s, 2);
        } else {
            float value = float_at(from, reader->depth);
            if (reader->channels == 3)
                value = asj_luma_float(value, float_at(from + reader->depth, reader->depth),
                                       float_at(from + 2 * reader->depth, reader->depth));
            memcpy(buffer->pixels + 4 * i, &value, 4);
        }
}

static asj_status decode_plain(tiff_reader *reader, uint64_t max_pixels, asj_image_buffer *buffer, const asj_message *message)
{
    size_t i;
    asj_status status;

    reader->channels = reader->photometric == PHOTOMETRIC_RGB ? 3 : 1;
    reader->depth = reader->bits / 8u;
    status = read_plain(reader, message);
    if (status == ASJ_OK)
        status = asj_image_allocate(buffer, reader->width, reader->height,
                                    reader->depth > 2 ? ASJ_FORMAT_GRAY_FLOAT : reader->depth == 2 ? ASJ_FORMAT_GRAY16
                                    : reader->channels == 3 ? ASJ_FORMAT_RGB8 : ASJ_FORMAT_GRAY8, max_pixels, message);
    if (status != ASJ_OK)
        return status;
    if (reader->depth > 1) {
        reduce(reader, buffer);
        return ASJ_OK;
    }
    for (i = 0; i < (size_t)reader->width * reader->height * reader->channels; i++)
        buffer->pixels[i] = (unsigned char)(reader->photometric == PHOTOMETRIC_MINISWHITE ? 255 - reader->raw[i] : reader->raw[i]);
    return ASJ_OK;
}

/* ---- everything else ---- */

static asj_status decode_by_libtiff(tiff_reader *reader, uint64_t max_pixels, asj_image_buffer *buffer, const asj_message *message)
{
    int is_gray = reader->photometric <= PHOTOMETRIC_MINISBLACK && reader->samples == 1;
    size_t count = (size_t)reader->width * reader->height, i;
    TIFFRGBAImage rgba;
    char cause[1024] = "";
    uint32_t *pixels;
    int good;
    asj_status status = asj_image_allocate(buffer, reader->width, reader->height, is_gray ? ASJ_FORMAT_GRAY8 : ASJ_FORMAT_RGB8,
                                           max_pixels, message);

    if (status != ASJ_OK)
        return status;
    if (reader->bits > 8 || !TIFFRGBAImageOK(reader->tiff, cause) || !TIFFRGBAImageBegin(&rgba, reader->tiff, 1, cause))
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "a TIFF of %u%s samples of %u bits is not read%s%.160s",
                                (unsigned)reader->samples, reader->format == SAMPLEFORMAT_INT ? " signed" : "",
                                (unsigned)reader->bits, cause[0] ? ": " : "", cause);
    rgba.req_orientation = rgba.orientation; /* as stored: the caller turns it upright */
    pixels = malloc(count * sizeof *pixels);
    good = pixels && TIFFRGBAImageGet(&rgba, pixels, reader->width, reader->height);
    TIFFRGBAImageEnd(&rgba);
    if (!pixels)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for the pixels");
    for (i = 0; good && i < count; i++) {
        unsigned char *to = buffer->pixels + (is_gray ? i : 3 * i);
        to[0] = (unsigned char)TIFFGetR(pixels[i]);
        if (!is_gray) {
            to[1] = (unsigned char)TIFFGetG(pixels[i]);
            to[2] = (unsigned char)TIFFGetB(pixels[i]);
        }
    }
    free(pixels);
    return good ? ASJ_OK : asj_decoder_fail(message, "damaged or truncated TIFF", reader->cause);
}

static asj_status decode(tiff_reader *reader, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                         const asj_message *message)
{
    TIFF *tiff = reader->tiff;
    uint64_t tile;

    if (!TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &reader->width) || !TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &reader->height) ||
        reader->width != probe->width || reader->height != probe->height)
        return asj_message_fail(message, ASJ_ERROR_FORMAT, "damaged TIFF: its size is given twice");
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &reader->samples);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &reader->bits);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &reader->format);
    TIFFGetFieldDefaulted(tiff, TIFFTAG_PLANARCONFIG, &reader->planes);
    if (!TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &reader->photometric))
        reader->photometric = reader->samples >= 3 ? PHOTOMETRIC_RGB : PHOTOMETRIC_MINISBLACK;
    if (reader->samples < 1 || reader->samples > MOST_SAMPLES)
        return asj_message_fail(message, ASJ_ERROR_UNSUPPORTED, "a TIFF of %u samples a pixel is not read",
                                (unsigned)reader->samples);
    tile = TIFFIsTiled(tiff) ? TIFFTileSize64(tiff) : 0;
    if (tile > SPARE_BYTES + 8 * (uint64_t)reader->width * reader->height)
        return asj_message_fail(message, ASJ_ERROR_LIMIT, "a TIFF with a tile far larger than the image");
    if (is_plain(reader))
        return decode_plain(reader, max_pixels, buffer, message);
    return decode_by_libtiff(reader, max_pixels, buffer, message);
}

/* A fraction; libtiff's versions differ in what they keep it in. */
static double fraction(TIFF *tiff, uint32_t tag)
{
    const TIFFField *field = TIFFFieldWithTag(tiff, tag);
    double wide = 0;
    float single = 0;
    if (field && TIFFFieldSetGetSize(field) == (int)sizeof wide)
        return TIFFGetField(tiff, tag, &wide) ? wide : 0;
    return field && TIFFGetField(tiff, tag, &single) ? (double)single : 0;
}

/* The lens, from the EXIF directory that the first one refers to. */
static void read_lens(TIFF *tiff, asj_lens *lens)
{
    uint64_t directory = 0;
    uint16_t film = 0, unit = 2;
    uint32_t width = 0, height = 0;
    if (!TIFFGetField(tiff, TIFFTAG_EXIFIFD, &directory) || directory == 0)
        return;
    if (!TIFFReadEXIFDirectory(tiff, (toff_t)directory)) {
        lens->is_damaged = 1;
        return;
    }
    TIFFGetField(tiff, EXIFTAG_FOCALLENGTHIN35MMFILM, &film);
    TIFFGetField(tiff, EXIFTAG_FOCALPLANERESOLUTIONUNIT, &unit);
    TIFFGetField(tiff, EXIFTAG_PIXELXDIMENSION, &width);
    TIFFGetField(tiff, EXIFTAG_PIXELYDIMENSION, &height);
    *lens = (asj_lens){film, fraction(tiff, EXIFTAG_FOCALLENGTH), fraction(tiff, EXIFTAG_FOCALPLANEXRESOLUTION), unit, 0, width,
                       height};
}

/* Is there a page behind the first? Smaller copies and masks of one are none (TIFF 6.0, NewSubfileType). */
static int has_more(TIFF *tiff)
{
    enum { MOST = 32 }; /* of these that are passed over */
    if (!TIFFSetDirectory(tiff, 0))
        return 0;
    for (int i = 0; i < MOST && TIFFReadDirectory(tiff); i++) {
        uint32_t kind = 0;
        TIFFGetField(tiff, TIFFTAG_SUBFILETYPE, &kind);
        if (!(kind & (FILETYPE_REDUCEDIMAGE | FILETYPE_MASK)))
            return 1;
    }
    return 0;
}

asj_status asj_tiff_decode(const asj_input *input, const asj_image_probe *probe, uint64_t max_pixels, asj_image_buffer *buffer,
                           const asj_message *message)
{
    static const tiff_reader none = {0};
    tiff_reader reader = none;
    asj_status status;

    reader.input = input;
    reader.tiff = open_tiff(&reader, probe);
    if (!reader.tiff)
        return asj_decoder_fail(message, "damaged TIFF", reader.cause);
    status = decode(&reader, probe, max_pixels, buffer, message);
    if (status == ASJ_OK) {
        read_lens(reader.tiff, &buffer->lens);
        buffer->has_more = has_more(reader.tiff);
    }
    TIFFClose(reader.tiff);
    free(reader.raw);
    return status;
}
