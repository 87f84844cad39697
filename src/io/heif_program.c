/* SPDX-License-Identifier: BSD-2-Clause */
/* asj-io-heif PIXELS: decodes the HEIF or AVIF file on standard input with libheif and writes the pixels to standard output, for
 * libasj-io (decoder_process.c) and nobody else. What is wrong with a file is told by an answer that does not come. It limits its
 * own memory to what an image of PIXELS needs, and its own time.
 *
 * Up to 8 bits a sample RGB8, more than that GRAY16 (colour as luma), spread over the range of the format. The image is turned and
 * cropped as the file says; its EXIF has no say in that. Transparency is ignored. */
#include "decoder_answer.h"
#include "shared/pixels.h"

#include <libheif/heif.h>

#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>

#ifdef ASJ_ADDRESS_SANITIZER
enum { LIMITS_MEMORY = 0 }; /* its shadow memory would not fit */
#else
enum { LIMITS_MEMORY = 1 };
#endif

/* For PIXELS: two pictures of the codec in three planes of 16 bits and what it knows of blocks, the picture of libheif twice, for
 * turning and converting, and its answer. For the rest: libraries, threads' stacks, small tables. */
enum { BYTES_A_PIXEL = 48, BYTES_AT_LEAST = 48 << 20, PIXELS_A_SECOND = 1000000 };

static void limit(int resource, rlim_t most)
{
    const struct rlimit both = {most, most};
    setrlimit(resource, &both);
}

static unsigned char *read_input(size_t *size)
{
    size_t room = 1 << 16, got;
    unsigned char *bytes = malloc(room);
    for (*size = 0; bytes && (got = fread(bytes + *size, 1, room - *size, stdin)) > 0;) {
        *size += got;
        if (*size == room) {
            unsigned char *more = realloc(bytes, room *= 2);
            if (!more)
                free(bytes);
            bytes = more;
        }
    }
    return bytes;
}

/* A sample of `bits` as one of 16, rounded. */
static uint32_t spread(const uint8_t *two, int bits)
{
    const uint32_t most = (1u << bits) - 1, value = (uint32_t)two[0] | (uint32_t)two[1] << 8;
    return ((value > most ? most : value) * 65535u + most / 2) / most;
}

/* Luma of deep colour. */
static void convert_row(const uint8_t *row, int width, int bits, uint16_t *gray)
{
    for (int x = 0; x < width; x++, row += 6)
        gray[x] = asj_luma16(spread(row, bits), spread(row + 2, bits), spread(row + 4, bits));
}

static int write_all(const void *bytes, size_t size)
{
    return fwrite(bytes, 1, size, stdout) == size;
}

static int write_image(const struct heif_image *image, int bits)
{
    const enum heif_channel all = heif_channel_interleaved;
    const int width = heif_image_get_width(image, all), height = heif_image_get_height(image, all), deep = bits > 8;
    const asj_decoder_answer answer = {ASJ_DECODER_MAGIC, deep ? ASJ_DECODER_GRAY16 : ASJ_DECODER_RGB8, (uint64_t)width,
                                       (uint64_t)height};
    int stride, good;
    const uint8_t *plane = heif_image_get_plane_readonly(image, all, &stride);
    uint16_t *gray;

    if (!plane || width <= 0 || height <= 0 || stride / (deep ? 6 : 3) < width)
        return 0;
    gray = malloc((size_t)width * sizeof *gray);
    good = gray && write_all(&answer, sizeof answer);
    for (int y = 0; y < height && good; y++) {
        const uint8_t *row = plane + (size_t)y * (size_t)stride;
        if (deep) {
            convert_row(row, width, bits, gray);
            good = write_all(gray, (size_t)width * sizeof *gray);
        } else {
            good = write_all(row, (size_t)width * 3);
        }
    }
    free(gray);
    return good && fflush(stdout) == 0;
}

/* Says that a codec is missing, where that is what is wrong. */
static int failed(struct heif_error error)
{
    const asj_decoder_answer lacks = {ASJ_DECODER_MAGIC, ASJ_DECODER_LACKS, 0, 0};
    if (error.code == heif_error_Ok)
        return 0;
    if (error.code == heif_error_Decoder_plugin_error && error.subcode == heif_suberror_Unsupported_codec)
        write_all(&lacks, sizeof lacks);
    else if (error.code == heif_error_Unsupported_feature && error.subcode == heif_suberror_Unsupported_codec)
        write_all(&lacks, sizeof lacks);
    fflush(stdout);
    return 1;
}

static int decode(struct heif_context *context, const unsigned char *bytes, size_t size, unsigned long long pixels)
{
    struct heif_image_handle *handle = NULL;
    struct heif_image *image = NULL;
    int good = 0;

    heif_context_set_max_decoding_threads(context, 0);
    if (failed(heif_context_read_from_memory_without_copy(context, bytes, size, NULL)) ||
        failed(heif_context_get_primary_image_handle(context, &handle)))
        return 0;
    const int width = heif_image_handle_get_width(handle), height = heif_image_handle_get_height(handle);
    const int bits = heif_image_handle_get_luma_bits_per_pixel(handle);
    if (bits >= 1 && bits <= 16 && width > 0 && height > 0 && (unsigned long long)width * (unsigned long long)height <= pixels)
        good = !failed(heif_decode_image(handle, &image, heif_colorspace_RGB,
                                         bits > 8 ? heif_chroma_interleaved_RRGGBB_LE : heif_chroma_interleaved_RGB, NULL)) &&
               write_image(image, bits);
    heif_image_release(image);
    heif_image_handle_release(handle);
    return good;
}

int main(int count, char **arguments)
{
    const unsigned long long pixels = count > 1 ? strtoull(arguments[1], NULL, 10) : 0;
    struct heif_context *context;
    unsigned char *bytes;
    size_t size;
    int good;

    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, 1 + (rlim_t)(pixels / PIXELS_A_SECOND));
    bytes = read_input(&size);
    if (!bytes)
        return 1;
    if (LIMITS_MEMORY)
        limit(RLIMIT_DATA, BYTES_AT_LEAST + (rlim_t)size + BYTES_A_PIXEL * (rlim_t)pixels);
    context = heif_context_alloc();
    good = context && decode(context, bytes, size, pixels);
    if (context)
        heif_context_free(context);
    free(bytes);
    return good ? 0 : 1;
}
