/* SPDX-License-Identifier: BSD-2-Clause */
/* Image files that must be refused: each with its status and one line that names it. */
#define _XOPEN_SOURCE 700
#include "io_test.h"

#include <png.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const png_kind gray8 = {PNG_COLOR_TYPE_GRAY, 8, 0, 0};

static void files_that_are_no_images(void **state)
{
    static const char text[] = "This is text, called .png by mistake.\n";
    char message[512];
    asj_image_file *file;
    (void)state;
    assert_image_refused(in_folder("missing.png"), 0, ASJ_ERROR_FILE, "No such file");
    assert_image_refused(in_folder("missing/x.png"), 0, ASJ_ERROR_FILE, "No such file");
    assert_image_refused("", 0, ASJ_ERROR_FILE, "No such file");
    assert_image_refused(in_folder("."), 0, ASJ_ERROR_FILE, "directory");
    assert_image_refused(write_bytes("empty.png", "", 0), 0, ASJ_ERROR_FORMAT, "empty");
    assert_image_refused("/dev/null", 0, ASJ_ERROR_FORMAT, "empty");
    assert_image_refused(write_bytes("text.png", text, sizeof text - 1), 0, ASJ_ERROR_FORMAT, "not an image");
    file = (asj_image_file *)message; /* anything: NULL afterwards */
    assert_int_equal(asj_image_file_read(NULL, 0, &file, message, sizeof message), ASJ_ERROR_ARGUMENT);
    assert_null(file);
    assert_int_equal(asj_image_file_read("x", 0, NULL, message, sizeof message), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_image_file_read(in_folder("missing.png"), 0, &file, NULL, 0), ASJ_ERROR_FILE);
    asj_image_file_free(NULL);
    file = NULL;
    asj_image_file_free(&file);
}

static void unreadable(void **state)
{
    static test_bytes png;
    const char *path;
    (void)state;
    make_png(&png, &gray8, 7, 5);
    path = write_bytes("secret.png", png.bytes, png.size);
    assert_int_equal(chmod(path, 0), 0);
    if (!become_ordinary()) {
        print_message("SKIPPED: cannot become an ordinary user\n");
        skip();
    }
    assert_image_refused(path, 0, ASJ_ERROR_FILE, "Permission denied");
    become_root();
}

static void png_cut_at_every_length(void **state)
{
    static const png_kind kinds[] = {
        {PNG_COLOR_TYPE_GRAY, 8, 0, 0}, {PNG_COLOR_TYPE_PALETTE, 4, 1, 1}, {PNG_COLOR_TYPE_RGB, 16, 1, 0}};
    static test_bytes png;
    size_t length, k;
    (void)state;
    for (k = 0; k < 3; k++) {
        make_png(&png, &kinds[k], 7, 5);
        for (length = 0; length < png.size; length++)
            assert_image_refused(write_bytes("cut.png", png.bytes, length), 0, ASJ_ERROR_FORMAT, "");
        assert_image_refused(write_bytes("cut.png", png.bytes, png.size / 2), 0, ASJ_ERROR_FORMAT, "PNG");
    }
}

/* Checksums cover every byte: none can change unnoticed. */
static void png_with_any_byte_changed(void **state)
{
    static test_bytes png;
    asj_image_file *file;
    size_t at;
    int bit;
    (void)state;
    make_png(&png, &gray8, 7, 5);
    for (at = 0; at < png.size; at++)
        for (bit = 0; bit < 8; bit++) {
            char message[512];
            asj_status status;
            png.bytes[at] ^= (unsigned char)(1 << bit);
            status = asj_image_file_read(write_bytes("bit.png", png.bytes, png.size), 0, &file, message, sizeof message);
            if (status != ASJ_ERROR_FORMAT && status != ASJ_ERROR_LIMIT)
                fail_msg("byte %zu bit %d: status %d", at, bit, (int)status);
            png.bytes[at] ^= (unsigned char)(1 << bit);
        }
    png.bytes[png.size - 12 - 1] ^= 1; /* the checksum of IDAT */
    assert_image_refused(write_bytes("crc.png", png.bytes, png.size), 0, ASJ_ERROR_FORMAT, "CRC");
}

/* A well-formed PNG header with the size given, and a little compressed data. */
static const char *declare_png(const char *name, uint32_t width, uint32_t height)
{
    static const unsigned char signature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    static const unsigned char rest[] = {8, PNG_COLOR_TYPE_GRAY, 0, 0, 0};
    static test_bytes png, header;
    png.size = header.size = 0;
    append(&png, signature, sizeof signature);
    append_big32(&header, width);
    append_big32(&header, height);
    append(&header, rest, sizeof rest);
    append_chunk(&png, "IHDR", header.bytes, header.size);
    append_chunk(&png, "IDAT", "\x78\x9c\x63\x60\x60\x60\0\0\0\4\0\1", 12);
    append_chunk(&png, "IEND", NULL, 0);
    return write_bytes(name, png.bytes, png.size);
}

static void too_large_or_too_small(void **state)
{
    static test_bytes png;
    asj_image_file *file = NULL;
    const char *path;
    (void)state;
    assert_image_refused(declare_png("bomb.png", 50000, 50000), 0, ASJ_ERROR_LIMIT, "50000 x 50000");
    assert_image_refused(declare_png("wide.png", 70000, 2), 0, ASJ_ERROR_LIMIT, "70000");
    assert_image_refused(declare_png("high.png", 2, 0x7fffffff), 0, ASJ_ERROR_LIMIT, "2147483647");
    assert_image_refused(declare_png("zero.png", 0, 5), 0, ASJ_ERROR_FORMAT, "zero");
    assert_image_refused(declare_png("flat.png", 5, 0), 0, ASJ_ERROR_FORMAT, "zero");
    assert_image_refused(declare_png("liar.png", 3000, 3000), 0, ASJ_ERROR_FORMAT, "PNG"); /* allowed, but not all there */
    make_png(&png, &gray8, 7, 5);
    path = write_bytes("limit.png", png.bytes, png.size);
    assert_image_refused(path, 34, ASJ_ERROR_LIMIT, "7 x 5");
    assert_int_equal(asj_image_file_read(path, 35, &file, NULL, 0), ASJ_OK);
    asj_image_file_free(&file);
}

/* Headers of other formats that ask for 60000 x 60000 pixels. 0xEA60 = 60000. */
static void too_large_in_other_formats(void **state)
{
    static const unsigned char bmp[] = {'B', 'M', 0, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 0x60, 0xea, 0, 0, 0x60, 0xea,
                                        0, 0, 1, 0, 8, 0};
    static const unsigned char jpeg[] = {0xff, 0xd8, 0xff, 0xc0, 0, 11, 8, 0xea, 0x60, 0xea, 0x60, 1, 1, 0x11, 0, 0xff, 0xd9};
    static const unsigned char tiff[] = {'M', 'M', 0, 42, 0, 0, 0, 8, 0, 2, 1, 0, 0, 4, 0, 0, 0, 1, 0, 0, 0xea, 0x60, 1, 1, 0, 3,
                                         0, 0, 0, 1, 0xea, 0x60, 0, 0, 0, 0, 0, 0};
    static const char webp[] = "RIFF\x20\0\0\0WEBPVP8X\x0a\0\0\0\0\0\0\0\x5f\xea\0\x5f\xea\0";
    static const char pnm[] = "P5\n# comment 1 2\n60000 60000\n255\n";
    static const char pam[] = "P7\nHEIGHT 60000\nWIDTH 60000\nDEPTH 1\nMAXVAL 255\nENDHDR\n";
    static const char jp2[] = "\xff\x4f\xff\x51\0\x29\0\0\0\0\xea\x60\0\0\xea\x60\0\0\0\0\0\0\0\0"
                              "\0\0\xea\x60\0\0\xea\x60\0\0\0\0\0\0\0\0\0\1\7\1\1";
    (void)state;
    assert_image_refused(write_bytes("bomb.bmp", bmp, sizeof bmp), 0, ASJ_ERROR_LIMIT, "60000 x 60000");
    assert_image_refused(write_bytes("bomb.jpg", jpeg, sizeof jpeg), 0, ASJ_ERROR_LIMIT, "60000 x 60000");
    assert_image_refused(write_bytes("bomb.tif", tiff, sizeof tiff), 0, ASJ_ERROR_LIMIT, "60000 x 60000");
    assert_image_refused(write_bytes("bomb.webp", webp, sizeof webp), 0, ASJ_ERROR_LIMIT, "60000 x 60000");
    assert_image_refused(write_bytes("bomb.pgm", pnm, sizeof pnm - 1), 0, ASJ_ERROR_LIMIT, "60000 x 60000");
    assert_image_refused(write_bytes("bomb.pam", pam, sizeof pam - 1), 0, ASJ_ERROR_LIMIT, "60000 x 60000");
    assert_image_refused(write_bytes("bomb.jp2", jp2, sizeof jp2), 0, ASJ_ERROR_LIMIT, "60000 x 60000");
    assert_image_refused(write_bytes("zero.pgm", "P5 0 5 255\n", 11), 0, ASJ_ERROR_FORMAT, "no pixels");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_that_are_no_images),  cmocka_unit_test(unreadable),
        cmocka_unit_test(png_cut_at_every_length),   cmocka_unit_test(png_with_any_byte_changed),
        cmocka_unit_test(too_large_or_too_small),    cmocka_unit_test(too_large_in_other_formats),
    };
    return cmocka_run_group_tests_name("io: bad images", tests, make_folder, remove_folder);
}
