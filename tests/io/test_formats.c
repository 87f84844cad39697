/* SPDX-License-Identifier: BSD-2-Clause */
/* Formats that OpenCV decodes: pixels, orientation, damage, and nothing on standard error. */
#define _XOPEN_SOURCE 700
#include "io_test.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* A gray JPEG of 24 x 16 pixels: six blocks of 8 x 8 that decode exactly to the levels below. */
static const unsigned char jpeg_head[] = {0xff, 0xd8, 0xff, 0xe0, 0, 16, 'J', 'F', 'I', 'F', 0, 1, 1, 0, 0, 1, 0, 1, 0, 0,
                                          0xff, 0xdb, 0, 67, 0};
static const unsigned char jpeg_tail[] = {
    0xff, 0xc0, 0x00, 0x0b, 0x08, 0x00, 0x10, 0x00, 0x18, 0x01, 0x01, 0x11, 0x00, 0xff, 0xc4, 0x00, 0x18, 0x00, 0x00, 0x02,
    0x03, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x07, 0x08, 0x0a, 0x0b, 0xff,
    0xc4, 0x00, 0x14, 0x10, 0x01, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0xff, 0xda, 0x00, 0x08, 0x01, 0x01, 0x00, 0x00, 0x3f, 0x00, 0x5f, 0xad, 0x00, 0x19, 0x57, 0xa0, 0x78, 0x7f, 0xff,
    0xd9};
static const int jpeg_levels[2][3] = {{120, 200, 200}, {30, 0, 0}};

static void make_jpeg(test_bytes *jpeg, const test_bytes *exif)
{
    static unsigned char ones[64], length[2];
    memset(ones, 1, sizeof ones); /* quantisation */
    jpeg->size = 0;
    append(jpeg, jpeg_head, 2);
    if (exif) {
        length[0] = (unsigned char)((exif->size + 8) >> 8);
        length[1] = (unsigned char)(exif->size + 8);
        append(jpeg, "\xff\xe1", 2);
        append(jpeg, length, 2);
        append(jpeg, "Exif\0\0", 6);
        append(jpeg, exif->bytes, exif->size);
    }
    append(jpeg, jpeg_head + 2, sizeof jpeg_head - 2);
    append(jpeg, ones, sizeof ones);
    append(jpeg, jpeg_tail, sizeof jpeg_tail);
}

static asj_image_file *read_image(const char *name, const test_bytes *bytes)
{
    asj_image_file *file = NULL;
    char message[512];
    if (asj_image_file_read(write_bytes(name, bytes->bytes, bytes->size), 0, &file, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    return file;
}

static void check_jpeg(const asj_image_file *file)
{
    const unsigned char *pixels = file->image.data;
    int32_t x, y, from_x, from_y;
    assert_int_equal(file->image.format, ASJ_FORMAT_GRAY8);
    assert_int_equal(file->image.width, file->orientation < 5 ? 24 : 16);
    assert_int_equal(file->image.height, file->orientation < 5 ? 16 : 24);
    for (y = 0; y < file->image.height; y++)
        for (x = 0; x < file->image.width; x++) {
            stored_place(file->orientation, 24, 16, x, y, &from_x, &from_y);
            assert_int_equal(*pixels++, jpeg_levels[from_y / 8][from_x / 8]);
        }
}

static void jpeg_pixels_and_orientation(void **state)
{
    static test_bytes jpeg, exif;
    asj_image_file *file;
    int orientation, big_endian;
    (void)state;
    make_jpeg(&jpeg, NULL);
    file = read_image("plain.jpg", &jpeg);
    assert_int_equal(file->orientation, 1);
    check_jpeg(file);
    asj_image_file_free(&file);
    for (orientation = 1; orientation <= 8; orientation++)
        for (big_endian = 0; big_endian < 2; big_endian++) {
            make_exif(&exif, big_endian, orientation);
            make_jpeg(&jpeg, &exif);
            file = read_image("turned.jpg", &jpeg);
            assert_int_equal(file->orientation, orientation);
            check_jpeg(file);
            asj_image_file_free(&file);
        }
}

/* Standard error into a file of the folder while a test runs; how much arrived. */
static int saved_stderr;
static void divert_stderr(void)
{
    int file = open(in_folder("stderr"), O_WRONLY | O_CREAT | O_TRUNC, 0666);
    fflush(stderr);
    saved_stderr = dup(STDERR_FILENO);
    dup2(file, STDERR_FILENO);
    close(file);
}

static size_t restore_stderr(void)
{
    static test_bytes written;
    fflush(stderr);
    dup2(saved_stderr, STDERR_FILENO);
    close(saved_stderr);
    read_bytes(in_folder("stderr"), &written);
    if (written.size)
        print_message("standard error: %.*s\n", written.size > 200 ? 200 : (int)written.size, (const char *)written.bytes);
    return written.size;
}

static void jpeg_cut_at_every_length(void **state)
{
    static test_bytes jpeg, exif;
    size_t length;
    (void)state;
    make_exif(&exif, 0, 6);
    make_jpeg(&jpeg, &exif);
    for (length = 1; length < jpeg.size; length++)
        assert_image_refused(write_bytes("cut.jpg", jpeg.bytes, length), 0, ASJ_ERROR_FORMAT, "");
    assert_image_refused(write_bytes("cut.jpg", jpeg.bytes, jpeg.size - 4), 0, ASJ_ERROR_FORMAT, "truncated JPEG");
}

/* All markers are there, but the compressed data end early: only the decoder can know. Surplus bytes behind them do no harm. */
static void jpeg_with_too_few_or_too_many_data(void **state)
{
    static test_bytes jpeg, changed;
    asj_image_file *file;
    (void)state;
    make_jpeg(&jpeg, NULL);
    changed.size = 0;
    append(&changed, jpeg.bytes, jpeg.size - 6);
    append(&changed, "\xff\xd9", 2);
    divert_stderr();
    assert_image_refused(write_bytes("early.jpg", changed.bytes, changed.size), 0, ASJ_ERROR_FORMAT, "premature end");
    changed.size = 0;
    append(&changed, jpeg.bytes, jpeg.size - 2);
    append(&changed, "\x12\x34\x56\x78\x12\x34\x56\x78\xff\xd9", 10);
    file = read_image("late.jpg", &changed);
    check_jpeg(file);
    asj_image_file_free(&file);
    assert_int_equal(restore_stderr(), 0);
}

/* Damage of any kind may or may not be noticed, but never crashes and never speaks. */
static void any_byte_changed(void **state)
{
    static test_bytes files[4];
    static const char pnm[] = "P6\n3 2\n255\nabcdefghijklmnopqr", pfm[] = "Pf\n2 1\n-1.0\nabcdefgh";
    static const unsigned char bmp[62] = {'B', 'M', 62, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 1, 0,
                                          24, 0, 0, 0, 0, 0, 8};
    asj_image_file *file;
    static const unsigned char masks[] = {1, 0x80, 0xff};
    size_t f, at, m;
    (void)state;
    make_jpeg(&files[0], NULL);
    append(&files[1], pnm, sizeof pnm - 1);
    append(&files[2], bmp, sizeof bmp);
    append(&files[3], pfm, sizeof pfm - 1);
    divert_stderr();
    for (f = 0; f < 4; f++) {
        file = read_image("sound", &files[f]);
        asj_image_file_free(&file);
        for (at = 0; at < files[f].size; at++)
            for (m = 0; m < sizeof masks; m++) {
                files[f].bytes[at] ^= masks[m];
                asj_image_file_read(write_bytes("changed", files[f].bytes, files[f].size), 1000000, &file, NULL, 0);
                asj_image_file_free(&file);
                files[f].bytes[at] ^= masks[m];
            }
        for (at = 0; at < files[f].size; at++) {
            asj_image_file_read(write_bytes("cut", files[f].bytes, at), 1000000, &file, NULL, 0);
            asj_image_file_free(&file);
        }
    }
    assert_int_equal(restore_stderr(), 0);
}

static void pnm_gray_colour_and_depth(void **state)
{
    static const char colour[] = "P6\n2 1\n255\n\1\2\3\xff\0\x80", deep[] = "P5\n2 1\n65535\n\x12\x34\xff\xff";
    static const unsigned char deep_colour[] = {'P', '6', '\n', '1', ' ', '1', '\n', '6', '5', '5', '3', '5', '\n',
                                                0xff, 0xff, 0x80, 0, 0, 1};
    static test_bytes bytes;
    asj_image_file *file;
    (void)state;
    bytes.size = 0;
    append(&bytes, colour, sizeof colour - 1);
    file = read_image("colour.ppm", &bytes);
    assert_int_equal(file->image.format, ASJ_FORMAT_BGR8);
    assert_memory_equal(file->image.data, "\3\2\1\x80\0\xff", 6);
    asj_image_file_free(&file);
    bytes.size = 0;
    append(&bytes, deep, sizeof deep - 1);
    file = read_image("deep.pgm", &bytes);
    assert_int_equal(file->image.format, ASJ_FORMAT_GRAY16);
    assert_int_equal(((const uint16_t *)file->image.data)[0], 0x1234);
    assert_int_equal(((const uint16_t *)file->image.data)[1], 0xffff);
    asj_image_file_free(&file);
    bytes.size = 0;
    append(&bytes, deep_colour, sizeof deep_colour);
    file = read_image("deep.ppm", &bytes);
    assert_int_equal(file->image.format, ASJ_FORMAT_GRAY16);
    assert_int_equal(((const uint16_t *)file->image.data)[0], (77 * 65535 + 150 * 32768 + 29 * 1 + 128) / 256);
    asj_image_file_free(&file);
}

static void pfm_floats(void **state)
{
    static test_bytes bytes;
    const float gray[2] = {0.25f, 1.5f}, colour[3] = {1.0f, 0.5f, 0.25f};
    const uint16_t one = 1;
    const char *scale = *(const unsigned char *)&one ? "-1.0\n" : "1.0\n";
    asj_image_file *file;
    (void)state;
    bytes.size = 0;
    append(&bytes, "Pf\n2 1\n", 7);
    append(&bytes, scale, strlen(scale));
    append(&bytes, gray, sizeof gray);
    file = read_image("gray.pfm", &bytes);
    assert_int_equal(file->image.format, ASJ_FORMAT_GRAY_FLOAT);
    assert_memory_equal(file->image.data, gray, sizeof gray);
    asj_image_file_free(&file);
    bytes.size = 0;
    append(&bytes, "PF\n1 1\n", 7);
    append(&bytes, scale, strlen(scale));
    append(&bytes, colour, sizeof colour);
    file = read_image("colour.pfm", &bytes);
    assert_int_equal(file->image.format, ASJ_FORMAT_GRAY_FLOAT);
    assert_true(((const float *)file->image.data)[0] == (77.0f * 1.0f + 150.0f * 0.5f + 29.0f * 0.25f) / 256.0f);
    asj_image_file_free(&file);
}

static void append16(test_bytes *to, int big_endian, unsigned value)
{
    unsigned char bytes[2] = {(unsigned char)(big_endian ? value >> 8 : value), (unsigned char)(big_endian ? value : value >> 8)};
    append(to, bytes, 2);
}

static void append32(test_bytes *to, int big_endian, uint32_t value)
{
    append16(to, big_endian, big_endian ? value >> 16 : value & 0xffff);
    append16(to, big_endian, big_endian ? value & 0xffff : value >> 16);
}

/* An uncompressed gray TIFF of the test picture, 5 x 3. */
static void make_tiff(test_bytes *tiff, int big_endian, int bits, int orientation)
{
    const unsigned tags[10][2] = {{256, 5}, {257, 3}, {258, (unsigned)bits}, {259, 1}, {262, 1}, {273, 8 + 2 + 120 + 4},
                                  {274, (unsigned)orientation}, {277, 1}, {278, 3}, {279, 15 * (unsigned)bits / 8}};
    int32_t i;
    tiff->size = 0;
    append(tiff, big_endian ? "MM" : "II", 2);
    append16(tiff, big_endian, 42);
    append32(tiff, big_endian, 8);
    append16(tiff, big_endian, 10);
    for (i = 0; i < 10; i++) {
        append16(tiff, big_endian, tags[i][0]);
        append16(tiff, big_endian, 3);
        append32(tiff, big_endian, 1);
        append16(tiff, big_endian, tags[i][1]);
        append16(tiff, big_endian, 0);
    }
    append32(tiff, big_endian, 0);
    for (i = 0; i < 15; i++) {
        unsigned char sample = (unsigned char)picture_sample(i % 5, i / 5, 0, 8);
        if (bits == 16)
            append16(tiff, big_endian, picture_sample(i % 5, i / 5, 0, 16));
        else
            append(tiff, &sample, 1);
    }
}

static void tiff_orientation_is_applied_once(void **state)
{
    static test_bytes tiff;
    int orientation, variant;
    int32_t x, y, from_x, from_y;
    (void)state;
    for (variant = 0; variant < 4; variant++)
        for (orientation = 1; orientation <= 8; orientation++) {
            int bits = variant >> 1 ? 16 : 8;
            asj_image_file *file;
            make_tiff(&tiff, variant & 1, bits, orientation);
            file = read_image("turned.tif", &tiff);
            assert_int_equal(file->orientation, orientation);
            assert_int_equal(file->image.format, bits == 16 ? ASJ_FORMAT_GRAY16 : ASJ_FORMAT_GRAY8);
            assert_int_equal(file->image.width, orientation < 5 ? 5 : 3);
            for (y = 0; y < file->image.height; y++)
                for (x = 0; x < file->image.width; x++) {
                    size_t at = (size_t)(y * file->image.width + x);
                    unsigned got = bits == 16 ? ((const uint16_t *)file->image.data)[at] : ((const uint8_t *)file->image.data)[at];
                    stored_place(orientation, 5, 3, x, y, &from_x, &from_y);
                    assert_int_equal(got, picture_sample(from_x, from_y, 0, bits));
                }
            asj_image_file_free(&file);
        }
}

static void formats_that_are_known_but_not_read(void **state)
{
    static const char gif[] = "GIF89a\1\0\1\0\0\0\0;", pdf[] = "%PDF-1.4\n", heif[] = "\0\0\0\x18" "ftypheic\0\0\0\0";
    (void)state;
    assert_image_refused(write_bytes("x.gif", gif, sizeof gif - 1), 0, ASJ_ERROR_UNSUPPORTED, "GIF");
    assert_image_refused(write_bytes("x.pdf", pdf, sizeof pdf - 1), 0, ASJ_ERROR_UNSUPPORTED, "PDF");
    assert_image_refused(write_bytes("x.heic", heif, sizeof heif - 1), 0, ASJ_ERROR_UNSUPPORTED, "HEIF");
}

static void without_opencv_every_other_format_is_unsupported(void **state)
{
    static test_bytes jpeg;
    (void)state;
    make_jpeg(&jpeg, NULL);
    assert_image_refused(write_bytes("x.jpg", jpeg.bytes, jpeg.size), 0, ASJ_ERROR_UNSUPPORTED, "JPEG");
    assert_image_refused(write_bytes("x.jpg", jpeg.bytes, jpeg.size - 5), 0, ASJ_ERROR_FORMAT, "truncated JPEG");
}

int main(void)
{
    const struct CMUnitTest with[] = {
        cmocka_unit_test(jpeg_pixels_and_orientation),      cmocka_unit_test(jpeg_cut_at_every_length),
        cmocka_unit_test(jpeg_with_too_few_or_too_many_data), cmocka_unit_test(any_byte_changed),
        cmocka_unit_test(pnm_gray_colour_and_depth),        cmocka_unit_test(pfm_floats),
        cmocka_unit_test(tiff_orientation_is_applied_once), cmocka_unit_test(formats_that_are_known_but_not_read),
    };
    const struct CMUnitTest without[] = {
        cmocka_unit_test(without_opencv_every_other_format_is_unsupported),
        cmocka_unit_test(formats_that_are_known_but_not_read),
    };
    if (asj_io_has_opencv())
        return cmocka_run_group_tests_name("io: formats, with OpenCV", with, make_folder, remove_folder);
    return cmocka_run_group_tests_name("io: formats, without OpenCV", without, make_folder, remove_folder);
}
