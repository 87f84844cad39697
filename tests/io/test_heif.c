/* SPDX-License-Identifier: BSD-2-Clause */
/* HEIF and AVIF: files that this test writes with libheif, where that has the encoders. */
#define _DEFAULT_SOURCE
#include "io_test.h"

#include <libheif/heif.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { WIDTH = 48, HEIGHT = 32, BLOCK = 16, MOST_KB = 64 * 1024 };

#ifdef ASJ_ADDRESS_SANITIZER
enum { IS_MEASURED = 0 };
#else
enum { IS_MEASURED = 1 };
#endif

typedef struct picture {
    enum heif_compression_format format;
    int32_t width, height, deep, gray;
    int32_t turn; /* EXIF's number for what the file says of turning; 0 = nothing */
} picture;

static void good(struct heif_error error)
{
    if (error.code != heif_error_Ok)
        fail_msg("%s", error.message);
}

/* Blocks of one colour; behind them all is black. */
static unsigned level(int32_t x, int32_t y, int32_t channel)
{
    if (x >= WIDTH || y >= HEIGHT)
        return 0;
    return (unsigned)(37 * (x / BLOCK) + 91 * (y / BLOCK) + 60 * channel) % 200 + 20;
}

static struct heif_image *draw(const picture *p)
{
    const enum heif_channel channel = p->gray ? heif_channel_Y : heif_channel_interleaved;
    const int32_t channels = p->gray ? 1 : 3;
    struct heif_image *image;
    int stride;
    good(heif_image_create(p->width, p->height, p->gray ? heif_colorspace_monochrome : heif_colorspace_RGB,
                           p->gray ? heif_chroma_monochrome : p->deep ? heif_chroma_interleaved_RRGGBB_LE
                                                                     : heif_chroma_interleaved_RGB, &image));
    good(heif_image_add_plane(image, channel, p->width, p->height, p->deep ? 10 : 8));
    uint8_t *plane = heif_image_get_plane(image, channel, &stride);
    for (int32_t y = 0; y < p->height; y++)
        for (int32_t i = 0; i < p->width * channels; i++) {
            const unsigned value = level(i / channels, y, i % channels);
            if (p->deep) { /* little-endian where interleaved, the machine's where not: as these tests have it */
                const uint16_t ten = (uint16_t)(value << 2);
                memcpy(plane + y * stride + 2 * i, &ten, 2);
            } else {
                plane[y * stride + i] = (uint8_t)value;
            }
        }
    return image;
}

static struct heif_error take(struct heif_context *context, const void *bytes, size_t size, void *to)
{
    const struct heif_error fine = {heif_error_Ok, heif_suberror_Unspecified, ""};
    (void)context;
    append(to, bytes, size);
    return fine;
}

static void make(const picture *p, test_bytes *file)
{
    struct heif_writer writer = {1, take};
    struct heif_context *context = heif_context_alloc();
    struct heif_encoding_options *options = heif_encoding_options_alloc();
    struct heif_image_handle *handle;
    struct heif_encoder *encoder;
    struct heif_image *image = draw(p);
    good(heif_context_get_encoder_for_format(context, p->format, &encoder));
    good(heif_encoder_set_lossy_quality(encoder, 90));
    if (p->format == heif_compression_AV1)
        good(heif_encoder_set_parameter_integer(encoder, "speed", 9));
    else
        good(heif_encoder_set_parameter_string(encoder, "preset", "ultrafast"));
    if (p->turn)
        options->image_orientation = (enum heif_orientation)p->turn;
    good(heif_context_encode_image(context, image, encoder, options, &handle));
    file->size = 0;
    good(heif_context_write(context, &writer, file));
    heif_image_handle_release(handle);
    heif_image_release(image);
    heif_encoder_release(encoder);
    heif_encoding_options_free(options);
    heif_context_free(context);
}

/* The middle of each block, to which compression does little. */
static void check(const picture *p, const test_bytes *bytes)
{
    const int32_t turned = p->turn >= 5;
    asj_image_file *file = NULL;
    char message[512];
    if (asj_image_file_read(write_bytes("x.heif", bytes->bytes, bytes->size), 0, &file, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    assert_int_equal(file->image.format, p->deep ? ASJ_FORMAT_GRAY16 : ASJ_FORMAT_RGB8);
    assert_int_equal(file->image.width, turned ? p->height : p->width);
    assert_int_equal(file->image.height, turned ? p->width : p->height);
    for (int32_t y = BLOCK / 2; y < file->image.height; y += BLOCK)
        for (int32_t x = BLOCK / 2; x < file->image.width; x += BLOCK) {
            const size_t at = (size_t)(y * file->image.width + x);
            int32_t from_x, from_y;
            stored_place(p->turn ? p->turn : 1, p->width, p->height, x, y, &from_x, &from_y);
            for (int32_t c = 0; c < (p->deep ? 1 : 3); c++) {
                const unsigned wanted = level(from_x, from_y, p->gray ? 0 : c);
                if (p->deep)
                    assert_in_range(((const uint16_t *)file->image.data)[at], wanted * 65535 / 255.75 - 1000,
                                    wanted * 65535 / 255.75 + 1000);
                else
                    assert_in_range(((const uint8_t *)file->image.data)[3 * at + (size_t)c], wanted - 6, wanted + 6);
            }
        }
    asj_image_file_free(&file);
}

static void pixels(void **state)
{
    static test_bytes file;
    const picture pictures[] = {
        {heif_compression_HEVC, WIDTH, HEIGHT, 0, 0, 0}, {heif_compression_HEVC, WIDTH, HEIGHT, 0, 1, 0},
        {heif_compression_HEVC, WIDTH, HEIGHT, 1, 1, 0}, {heif_compression_HEVC, WIDTH, HEIGHT, 0, 0, 6},
        {heif_compression_AV1, WIDTH, HEIGHT, 0, 0, 0},  {heif_compression_AV1, WIDTH, HEIGHT, 0, 1, 0},
        {heif_compression_AV1, WIDTH, HEIGHT, 0, 0, 3},  {heif_compression_AV1, WIDTH, HEIGHT, 0, 0, 8}};
    (void)state;
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; i++)
        if (heif_have_encoder_for_format(pictures[i].format)) {
            make(&pictures[i], &file);
            check(&pictures[i], &file);
        }
}

static void cut_anywhere(void **state)
{
    static test_bytes file;
    const picture p = {heif_compression_AV1, WIDTH, HEIGHT, 0, 1, 0};
    (void)state;
    if (!heif_have_encoder_for_format(p.format))
        skip();
    make(&p, &file);
    for (size_t length = 12; length < file.size; length++)
        assert_image_refused(write_bytes("cut.avif", file.bytes, length), 0, ASJ_ERROR_FORMAT, "");
    assert_image_refused(write_bytes("cut.avif", file.bytes, file.size - 1), 0, ASJ_ERROR_FORMAT, "truncated AVIF");
    assert_image_refused(write_bytes("x.avif", file.bytes, file.size), WIDTH * HEIGHT - 1, ASJ_ERROR_LIMIT, "48 x 32");
}

/* Another size than that of the picture, in all places where the file tells it. */
static void declare(test_bytes *file, uint32_t side)
{
    const unsigned char big[4] = {(unsigned char)(side >> 24), (unsigned char)(side >> 16), (unsigned char)(side >> 8),
                                  (unsigned char)side};
    for (size_t at = 0; at + 16 < file->size; at++)
        if (!memcmp(file->bytes + at, "ispe", 4)) {
            memcpy(file->bytes + at + 8, big, 4);
            memcpy(file->bytes + at + 12, big, 4);
        }
}

/* Runs in a process of its own, so that what the encoder takes is not counted for the reader. */
static void elsewhere(void (*what)(void))
{
    int state = 0;
    const pid_t child = fork();
    assert_true(child >= 0);
    if (!child) {
        what();
        _exit(0);
    }
    assert_int_equal(waitpid(child, &state, 0), child);
    assert_true(WIFEXITED(state) && WEXITSTATUS(state) == 0);
}

static void write_large(void)
{
    static test_bytes file;
    const picture p = {heif_compression_AV1, 4096, 4096, 0, 1, 0};
    make(&p, &file);
    declare(&file, 16);
    write_bytes("small.avif", file.bytes, file.size);
    declare(&file, 60000);
    write_bytes("large.avif", file.bytes, file.size);
}

static void read_large(void)
{
    asj_image_file *file = NULL;
    struct rusage use;
    if (asj_image_file_read(in_folder("small.avif"), 0, &file, NULL, 0) != ASJ_ERROR_FORMAT)
        _exit(1);
    if (getrusage(RUSAGE_CHILDREN, &use) != 0 || (IS_MEASURED && use.ru_maxrss > MOST_KB)) {
        fprintf(stderr, "%ld KB\n", use.ru_maxrss);
        _exit(2);
    }
}

/* 16 megapixels in some hundred bytes, which say that they are a few pixels: only the codec can know. Its process takes no more
 * than the few pixels need. */
static void larger_than_declared(void **state)
{
    (void)state;
    if (!heif_have_encoder_for_format(heif_compression_AV1))
        skip();
    elsewhere(write_large);
    elsewhere(read_large);
    assert_image_refused(in_folder("large.avif"), 0, ASJ_ERROR_LIMIT, "60000 x 60000");
}

static void any_byte_changed(void **state)
{
    static test_bytes file;
    const picture p = {heif_compression_AV1, WIDTH, HEIGHT, 0, 1, 0};
    (void)state;
    if (!heif_have_encoder_for_format(p.format))
        skip();
    make(&p, &file);
    for (size_t at = 0; at < file.size; at += 3) {
        asj_image_file *read = NULL;
        file.bytes[at] ^= 0x5a;
        const asj_status status = asj_image_file_read(write_bytes("changed", file.bytes, file.size), 1000000, &read, NULL, 0);
        assert_int_equal(status == ASJ_OK, read != NULL);
        asj_image_file_free(&read);
        file.bytes[at] ^= 0x5a;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(larger_than_declared), cmocka_unit_test(pixels),
                                       cmocka_unit_test(cut_anywhere), cmocka_unit_test(any_byte_changed)};
    if (!heif_have_encoder_for_format(heif_compression_AV1) && !heif_have_encoder_for_format(heif_compression_HEVC)) {
        puts("SKIPPED: libheif has no encoders here");
        return 77;
    }
    return cmocka_run_group_tests_name("io: HEIF", tests, make_folder, remove_folder);
}
