/* SPDX-License-Identifier: BSD-2-Clause */
/* Formats other than PNG: pixels, orientation, damage, and nothing on standard error. */
#define _XOPEN_SOURCE 700
#include "io_test.h"

#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
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

static void append_exif(test_bytes *jpeg, const test_bytes *exif)
{
    const unsigned char length[2] = {(unsigned char)((exif->size + 8) >> 8), (unsigned char)(exif->size + 8)};
    append(jpeg, "\xff\xe1", 2);
    append(jpeg, length, 2);
    append(jpeg, "Exif\0\0", 6);
    append(jpeg, exif->bytes, exif->size);
}

static void make_jpeg(test_bytes *jpeg, const test_bytes *exif, const test_bytes *second)
{
    static unsigned char ones[64];
    memset(ones, 1, sizeof ones); /* quantisation */
    jpeg->size = 0;
    append(jpeg, jpeg_head, 2);
    if (exif)
        append_exif(jpeg, exif);
    if (second)
        append_exif(jpeg, second);
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
    make_jpeg(&jpeg, NULL, NULL);
    file = read_image("plain.jpg", &jpeg);
    assert_int_equal(file->orientation, 1);
    check_jpeg(file);
    asj_image_file_free(&file);
    for (orientation = 1; orientation <= 8; orientation++)
        for (big_endian = 0; big_endian < 2; big_endian++) {
            make_exif(&exif, big_endian, orientation);
            make_jpeg(&jpeg, &exif, NULL);
            file = read_image("turned.jpg", &jpeg);
            assert_int_equal(file->orientation, orientation);
            check_jpeg(file);
            asj_image_file_free(&file);
        }
}

static void the_first_exif_block_counts(void **state)
{
    static test_bytes jpeg, upright, turned;
    asj_image_file *file;
    (void)state;
    make_exif(&upright, 0, 1);
    make_exif(&turned, 1, 6);
    make_jpeg(&jpeg, &upright, &turned);
    file = read_image("upright.jpg", &jpeg);
    assert_int_equal(file->orientation, 1);
    check_jpeg(file);
    asj_image_file_free(&file);
    make_jpeg(&jpeg, &turned, &upright);
    file = read_image("turned.jpg", &jpeg);
    assert_int_equal(file->orientation, 6);
    check_jpeg(file);
    asj_image_file_free(&file);
}

/* A JPEG whose index says what kind of picture a second one is; the index may be too short for it, or BigTIFF (43). */
static void views_behind_the_first_are_told(void **state)
{
    static const struct {
        uint32_t kind;
        size_t kept;
        unsigned magic;
        int has_more;
    } given[] = {{0x020002, 58, 42, 1}, {0x020001, 58, 42, 1}, {0x80020003, 58, 42, 1}, {0x010001, 58, 42, 0}, {0, 58, 42, 0},
                 {0x030000, 58, 42, 0}, {0x020002, 57, 42, 0}, {0x020002, 26, 42, 0}, {0x020002, 10, 42, 0}, {0x020002, 58, 43, 0}};
    static test_bytes plain, index, whole;
    (void)state;
    make_jpeg(&plain, NULL, NULL);
    for (size_t i = 0; i < 2 * sizeof given / sizeof given[0]; i++) {
        const int big_endian = i & 1;
        index.size = 0;
        append(&index, "MPF\0", 4);
        append(&index, big_endian ? "MM" : "II", 2);
        append16(&index, big_endian, given[i / 2].magic);
        append32(&index, big_endian, 8); /* the directory: one entry of 32 bytes behind it */
        append16(&index, big_endian, 1);
        append16(&index, big_endian, 0xb002);
        append16(&index, big_endian, 7);
        append32(&index, big_endian, 32);
        append32(&index, big_endian, 26);
        append32(&index, big_endian, 0);
        const uint32_t entries[8] = {0x20030000, 100, 0, 0, given[i / 2].kind, 100, 100, 0};
        for (size_t n = 0; n < 8; n++)
            append32(&index, big_endian, entries[n]);
        index.size = 4 + given[i / 2].kept;
        whole.size = 0;
        append(&whole, plain.bytes, 2);
        append(&whole, "\xff\xe2", 2);
        append16(&whole, 1, (unsigned)index.size + 2);
        append(&whole, index.bytes, index.size);
        append(&whole, plain.bytes + 2, plain.size - 2);
        asj_image_file *file = read_image("views.jpg", &whole);
        assert_int_equal(file->has_more, given[i / 2].has_more);
        check_jpeg(file);
        asj_image_file_free(&file);
    }
}

static void pictures_of_a_pnm_behind_the_first_are_told(void **state)
{
    static const struct {
        const char *behind;
        int has_more;
    } given[] = {{"", 0}, {"\n", 0}, {"P5", 0}, {"P8 1", 0}, {"junk", 0}, {"P5 1 1 255 a", 1}, {"P7\nWIDTH 1", 1}, {"Pf 1", 1}};
    static const char *const first[] = {"P5 1 1 255\na", "P6\n1 1 65535\nabcdef", "P4 1 1\na", "Pf\n1 1\n-1.0\n\0\0\0\0",
                                        "P2 1 1 255 3 "};
    static const size_t sizes[] = {12, 19, 8, 16, 13};
    static test_bytes pnm;
    (void)state;
    for (size_t f = 0; f < sizeof sizes / sizeof sizes[0]; f++)
        for (size_t i = 0; i < sizeof given / sizeof given[0]; i++) {
            pnm.size = 0;
            append(&pnm, first[f], sizes[f]);
            append(&pnm, given[i].behind, strlen(given[i].behind));
            asj_image_file *file = read_image("pictures.pnm", &pnm);
            assert_int_equal(file->has_more, given[i].has_more && f < 4); /* text has no second picture */
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
    make_jpeg(&jpeg, &exif, NULL);
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
    make_jpeg(&jpeg, NULL, NULL);
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
    assert_int_equal(file->image.format, ASJ_FORMAT_RGB8);
    assert_memory_equal(file->image.data, "\1\2\3\xff\0\x80", 6);
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

/* A second directory of the tags of the first, which says in one more what it is: a page, a copy in another size, a mask. */
static void pages_behind_the_first_are_told(void **state)
{
    static const unsigned kinds[] = {0, 1, 2, 4, 5};
    static test_bytes tiff, whole, next;
    (void)state;
    for (int variant = 0; variant < 10; variant++) {
        const int big_endian = variant & 1;
        const unsigned kind = kinds[variant / 2];
        make_tiff(&tiff, big_endian, 8, 1);
        whole = tiff;
        asj_image_file *file = read_image("pages.tif", &whole);
        assert_int_equal(file->has_more, 0);
        asj_image_file_free(&file);
        append(&whole, "", whole.size & 1); /* directories begin at even places */
        const uint32_t second = (uint32_t)whole.size;
        append16(&whole, big_endian, 11);
        append16(&whole, big_endian, 254);
        append16(&whole, big_endian, 4);
        append32(&whole, big_endian, 1);
        append32(&whole, big_endian, kind);
        append(&whole, tiff.bytes + 10, 120 + 4);
        next.size = 0;
        append32(&next, big_endian, second);
        memcpy(whole.bytes + 10 + 120, next.bytes, 4);
        file = read_image("pages.tif", &whole);
        assert_int_equal(file->has_more, kind == 0 || kind == 2);
        assert_int_equal(((const uint8_t *)file->image.data)[7], picture_sample(2, 1, 0, 8));
        asj_image_file_free(&file);
    }
}

/* Damage of any kind may or may not be noticed, but never crashes and never speaks. */
static void any_byte_changed(void **state)
{
    static test_bytes files[4];
    static const char pnm[] = "P6\n3 2\n255\nabcdefghijklmnopqr", pfm[] = "Pf\n2 1\n-1.0\nabcdefgh";
    asj_image_file *file;
    static const unsigned char masks[] = {1, 0x80, 0xff};
    size_t f, at, m;
    (void)state;
    make_jpeg(&files[0], NULL, NULL);
    files[1].size = files[3].size = 0;
    append(&files[1], pnm, sizeof pnm - 1);
    make_tiff(&files[2], 0, 8, 6);
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

static void formats_that_are_known_but_not_read(void **state)
{
    static const char gif[] = "GIF89a\1\0\1\0\0\0\0;", pdf[] = "%PDF-1.4\n", film[] = "\0\0\0\x14" "ftypisom\0\0\0\0avc1";
    static const char heif[] = "\0\0\0\x14" "ftypmif1\0\0\0\0heic";
    (void)state;
    assert_image_refused(write_bytes("x.gif", gif, sizeof gif - 1), 0, ASJ_ERROR_UNSUPPORTED, "GIF");
    assert_image_refused(write_bytes("x.pdf", pdf, sizeof pdf - 1), 0, ASJ_ERROR_UNSUPPORTED, "PDF");
    assert_image_refused(write_bytes("x.mp4", film, sizeof film - 1), 0, ASJ_ERROR_UNSUPPORTED, "no still image");
    assert_image_refused(write_bytes("x.heic", heif, sizeof heif - 1), 0,
                         strstr(asj_io_image_formats(), "HEIF") ? ASJ_ERROR_FORMAT : ASJ_ERROR_UNSUPPORTED, "HEIF");
}

static int is_read(const char *format)
{
    const char *all = asj_io_image_formats(), *found = strstr(all, format);
    size_t length = strlen(format);
    while (found && ((found > all && found[-1] != ' ') || (found[length] && found[length] != ',')))
        found = strstr(found + 1, format);
    return found != NULL;
}

static void formats_that_this_build_lacks(void **state)
{
    static test_bytes bytes;
    (void)state;
    if (!is_read("JPEG")) {
        make_jpeg(&bytes, NULL, NULL);
        assert_image_refused(write_bytes("x.jpg", bytes.bytes, bytes.size), 0, ASJ_ERROR_UNSUPPORTED, "JPEG");
        assert_image_refused(write_bytes("x.jpg", bytes.bytes, bytes.size - 5), 0, ASJ_ERROR_FORMAT, "truncated JPEG");
    }
    if (!is_read("TIFF")) {
        make_tiff(&bytes, 0, 8, 1);
        assert_image_refused(write_bytes("x.tif", bytes.bytes, bytes.size), 0, ASJ_ERROR_UNSUPPORTED, "TIFF");
    }
}

/* Netpbm's scale: a sample of the largest value is white, whatever that value is. */
#define TEXT(literal) (literal), sizeof(literal) - 1
static void pnm_of_every_kind(void **state)
{
    static const struct {
        const char *bytes;
        size_t size;
        int32_t format;
        const char *pixels;
        size_t pixel_bytes;
    } kinds[] = {
        {TEXT("P1\n3 2\n1 0 1\n010\n"), ASJ_FORMAT_GRAY8, "\0\xff\0\xff\0\xff", 6},
        {TEXT("P4 3 2\n\xa0\x40"), ASJ_FORMAT_GRAY8, "\0\xff\0\xff\0\xff", 6},
        {TEXT("P2 # a comment\r3 1 # another\n5\n0 5\n1"), ASJ_FORMAT_GRAY8, "\0\xff\x33", 3},
        {TEXT("P2 3 1 100 1 33 50"), ASJ_FORMAT_GRAY8, "\3\x54\x80", 3},
        {TEXT("P3 1 1 255 1 20 300"), ASJ_FORMAT_RGB8, "\1\x14\xff", 3},
        {TEXT("P5 2 1 15\n\1\xf"), ASJ_FORMAT_GRAY8, "\x11\xff", 2},
        {TEXT("P7\nWIDTH 1\nHEIGHT 2\nDEPTH 2\nMAXVAL 255\nTUPLTYPE GRAYSCALE_ALPHA\nENDHDR\n\1\2\3\4"), ASJ_FORMAT_GRAY8,
         "\1\3", 2},
        {TEXT("P7\n#x\nMAXVAL 255\nDEPTH 4\nWIDTH 1\nHEIGHT 1\nENDHDR\n\1\2\3\4"), ASJ_FORMAT_RGB8, "\1\2\3", 3},
    };
    static const char *const bad[] = {
        "P5 2 1 0\n12", "P5 2 1 65536\n1234", "P5 2 2 255\n123", "P5 2x1 255\n12", "P2 2 1 255\n1 ", "P2 2 1 255\n1 x",
        "P1 2 1 1 2", "P6 1 1 255\n12", "P4 9 1\n1", "Pf 1 1\n1\n123", "Pf 1 1 x\n1234", "P7\nWIDTH 1\nENDHDR\n1",
        "P7\nWIDTH 1\nHEIGHT 1\nDEPTH 5\nMAXVAL 1\nENDHDR\n11111", "P7\nWIDTH 1\nHEIGHT 1\nDEPTH 1\nMAXVAL 65536\nENDHDR\n12",
        "P7\nWIDTH 1\nWIDTH 1\nHEIGHT 1\nDEPTH 1\nMAXVAL 1\nENDHDR\n1"};
    static test_bytes bytes;
    size_t i;
    (void)state;
    for (i = 0; i < sizeof kinds / sizeof kinds[0]; i++) {
        asj_image_file *file;
        bytes.size = 0;
        append(&bytes, kinds[i].bytes, kinds[i].size);
        file = read_image("kind.pnm", &bytes);
        assert_int_equal(file->image.format, kinds[i].format);
        assert_memory_equal(file->image.data, kinds[i].pixels, kinds[i].pixel_bytes);
        asj_image_file_free(&file);
    }
    for (i = 0; i < sizeof bad / sizeof bad[0]; i++)
        assert_image_refused(write_bytes("bad.pnm", bad[i], strlen(bad[i])), 0, ASJ_ERROR_FORMAT, "PNM");
}

/* A lossless WebP of 5 x 3 pixels, and a JPEG 2000 codestream of 32 x 32, as other programs write them. */
static const unsigned char webp[] = {
    0x52, 0x49, 0x46, 0x46, 0x46, 0x00, 0x00, 0x00, 0x57, 0x45, 0x42, 0x50, 0x56, 0x50, 0x38, 0x4c, 0x39, 0x00, 0x00, 0x00,
    0x2f, 0x04, 0x80, 0x00, 0x00, 0x57, 0x20, 0x14, 0x40, 0xfc, 0xcd, 0x82, 0x89, 0xa0, 0x9f, 0x83, 0x40, 0x20, 0xf1, 0xf7,
    0x09, 0x62, 0x98, 0x21, 0x04, 0x02, 0x89, 0x5a, 0xf8, 0xc3, 0x0c, 0x31, 0xff, 0x19, 0x7d, 0xa7, 0xc0, 0x4c, 0x00, 0xb2,
    0x71, 0x5e, 0xaf, 0x0a, 0x2a, 0xc8, 0xa2, 0xc2, 0x2a, 0x2c, 0xa2, 0xff, 0xf1, 0xe5, 0x05, 0xb3, 0x00, 0x00};
static const unsigned char jpeg2000[] = {
    0xff, 0x4f, 0xff, 0x51, 0x00, 0x2f, 0x00, 0x00, 0x00, 0x00, 0x00, 0x20, 0x00, 0x00, 0x00, 0x20, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x20, 0x00, 0x00, 0x00, 0x20, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00, 0x00,
    0x00, 0x03, 0x07, 0x01, 0x01, 0x07, 0x01, 0x01, 0x07, 0x01, 0x01, 0xff, 0x52, 0x00, 0x0c, 0x00, 0x00, 0x00, 0x01, 0x00,
    0x05, 0x04, 0x04, 0x00, 0x01, 0xff, 0x5c, 0x00, 0x13, 0x40, 0x40, 0x48, 0x48, 0x50, 0x48, 0x48, 0x50, 0x48, 0x48, 0x50,
    0x48, 0x48, 0x50, 0x48, 0x48, 0x50, 0xff, 0x90, 0x00, 0x0a, 0x00, 0x00, 0x00, 0x00, 0x00, 0xc1, 0x00, 0x01, 0xff, 0x93,
    0xc7, 0xd4, 0x04, 0x01, 0x7f, 0xc7, 0xd4, 0x04, 0x08, 0x2f, 0xcf, 0xb4, 0x08, 0x05, 0xdf, 0xcf, 0xc0, 0x08, 0x07, 0x2b,
    0xcf, 0xc0, 0x08, 0x04, 0x7b, 0xc7, 0xda, 0x04, 0x00, 0x04, 0x73, 0xc7, 0xda, 0x0c, 0x00, 0x02, 0x39, 0x12, 0x26, 0xca,
    0x9f, 0xc7, 0xda, 0x0c, 0x00, 0x08, 0xf1, 0x26, 0x26, 0xa4, 0xdf, 0xc3, 0xea, 0x05, 0x00, 0x08, 0xf1, 0x26, 0x26, 0xa3,
    0xc7, 0xda, 0x10, 0x00, 0x17, 0xd8, 0x75, 0x75, 0x31, 0xe5, 0x38, 0xcb, 0xc7, 0xda, 0x10, 0x00, 0x17, 0x2c, 0x73, 0x75,
    0x31, 0xe5, 0x38, 0x1b, 0xc3, 0xea, 0x07, 0x00, 0x17, 0x2c, 0x73, 0x75, 0x31, 0xe5, 0x37, 0xc7, 0xda, 0x18, 0x00, 0x22,
    0x1a, 0x0e, 0xc3, 0xcc, 0x80, 0x92, 0x8e, 0xb3, 0xe1, 0x6e, 0x7f, 0xc7, 0xda, 0x18, 0x00, 0x21, 0x6e, 0x0c, 0xc3, 0xcc,
    0x80, 0x92, 0x8e, 0xb3, 0xe1, 0x6e, 0x7f, 0xc3, 0xea, 0x09, 0x00, 0x21, 0x6e, 0x0c, 0xc3, 0xcc, 0x80, 0x92, 0x8e, 0xb3,
    0xc7, 0xda, 0x12, 0x00, 0x36, 0x9e, 0x41, 0xe2, 0xd4, 0x0c, 0xd8, 0x48, 0x4b, 0xc7, 0xda, 0x12, 0x00, 0x35, 0xf2, 0x3f,
    0xe2, 0xd4, 0x0c, 0xd8, 0x48, 0x4b, 0xc3, 0xea, 0x09, 0x00, 0x35, 0xf2, 0x3f, 0xe2, 0xd4, 0x0c, 0xd8, 0x48, 0x4b, 0xff,
    0xd9};

static void webp_pixels(void **state)
{
    static test_bytes bytes;
    asj_image_file *file;
    int32_t x, y, c;
    size_t length;
    (void)state;
    bytes.size = 0;
    append(&bytes, webp, sizeof webp);
    file = read_image("x.webp", &bytes);
    assert_int_equal(file->image.format, ASJ_FORMAT_RGB8);
    assert_int_equal(file->image.width, 5);
    assert_int_equal(file->image.height, 3);
    for (y = 0; y < 3; y++)
        for (x = 0; x < 5; x++)
            for (c = 0; c < 3; c++)
                assert_int_equal(((const uint8_t *)file->image.data)[3 * (5 * y + x) + c], (40 * x + 20 * y + 70 * c) % 256);
    asj_image_file_free(&file);
    for (length = 1; length < sizeof webp - 4; length++)
        assert_image_refused(write_bytes("cut.webp", webp, length), 0, ASJ_ERROR_FORMAT, "");
    assert_image_refused(write_bytes("x.webp", webp, sizeof webp), 14, ASJ_ERROR_LIMIT, "5 x 3");
}

/* The codestream alone, and in the boxes of a JP2 file. */
static void jpeg2000_pixels(void **state)
{
    static const char boxes[] = "\0\0\0\x0cjP  \r\n\x87\n\0\0\0\x14" "ftypjp2 \0\0\0\0jp2 \0\0\0\x17jp2h\0\0\0\x0f"
                                "colr\1\0\0\0\0\0\x10\0\0\0\0jp2c";
    static test_bytes bytes;
    asj_image_file *file;
    int32_t x, y, c, boxed;
    size_t length;
    (void)state;
    for (boxed = 0; boxed < 2; boxed++) {
        bytes.size = 0;
        append(&bytes, boxes, boxed ? sizeof boxes - 1 : 0);
        append(&bytes, jpeg2000, sizeof jpeg2000);
        file = read_image("x.jp2", &bytes);
        assert_int_equal(file->image.format, ASJ_FORMAT_RGB8);
        assert_int_equal(file->image.width, 32);
        assert_int_equal(file->image.height, 32);
        for (y = 0; y < 32; y++)
            for (x = 0; x < 32; x++) {
                const int level = x < 16 ? 40 : 200, colour[3] = {255 - level, level, level / 2};
                for (c = 0; c < 3; c++)
                    assert_int_equal(((const uint8_t *)file->image.data)[3 * (32 * y + x) + c], colour[c]);
            }
        asj_image_file_free(&file);
    }
    for (length = 1; length < sizeof jpeg2000 - 100; length++)
        assert_image_refused(write_bytes("cut.jp2", jpeg2000, length), 0, ASJ_ERROR_FORMAT, "");
}

/* 5 x 3 pixels, 24 bits, rows from the bottom and padded to 16 bytes. */
static void bmp_through_opencv(void **state)
{
    static const unsigned char head[54] = {'B', 'M', 102, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 5, 0, 0, 0, 3, 0, 0, 0,
                                           1, 0, 24};
    static test_bytes bytes;
    asj_image_file *file;
    int32_t x, y, c;
    (void)state;
    bytes.size = 0;
    append(&bytes, head, sizeof head);
    for (y = 2; y >= 0; y--) {
        unsigned char row[16] = {0};
        for (x = 0; x < 5; x++)
            for (c = 0; c < 3; c++)
                row[3 * x + c] = (unsigned char)picture_sample(x, y, c, 8);
        append(&bytes, row, sizeof row);
    }
    file = read_image("x.bmp", &bytes);
    assert_int_equal(file->image.format, ASJ_FORMAT_BGR8);
    for (y = 0; y < 3; y++)
        for (x = 0; x < 5; x++)
            for (c = 0; c < 3; c++)
                assert_int_equal(((const uint8_t *)file->image.data)[3 * (5 * y + x) + c], picture_sample(x, y, c, 8));
    asj_image_file_free(&file);
    assert_image_refused(write_bytes("cut.bmp", bytes.bytes, 60), 0, ASJ_ERROR_FORMAT, "BMP");
    memcpy(bytes.bytes + 128, "DICM", 4); /* behind the end of this one, but nobody reads that far */
    assert_image_refused(write_bytes("dicm.bmp", bytes.bytes, 132), 0, ASJ_ERROR_UNSUPPORTED, "DICOM");
}

/* 5 x 3 pixels, 8 bits, gray without a colour map, rows padded to 6 bytes. */
static void gray_sun_raster_through_opencv(void **state)
{
    static const unsigned char head[32] = {0x59, 0xa6, 0x6a, 0x95, 0, 0, 0, 5, 0, 0, 0, 3, 0, 0, 0, 8, 0, 0, 0, 18, 0, 0, 0, 1};
    static test_bytes bytes;
    asj_image_file *file;
    int32_t x, y;
    (void)state;
    bytes.size = 0;
    append(&bytes, head, sizeof head);
    for (y = 0; y < 3; y++) {
        unsigned char row[6] = {0};
        for (x = 0; x < 5; x++)
            row[x] = (unsigned char)picture_sample(x, y, 0, 8);
        append(&bytes, row, sizeof row);
    }
    file = read_image("x.ras", &bytes);
    assert_int_equal(file->image.format, ASJ_FORMAT_GRAY8);
    for (y = 0; y < 3; y++)
        for (x = 0; x < 5; x++)
            assert_int_equal(((const uint8_t *)file->image.data)[5 * y + x], picture_sample(x, y, 0, 8));
    asj_image_file_free(&file);
}

/* The verdict hangs on no descriptor and on no message: the test runs in a process of its own whose standard error is closed and
 * whose table of open files is full but for one. */
static void damage_is_seen_without_descriptors(void **state)
{
    static test_bytes jpeg, changed;
    const char *path;
    pid_t child;
    int state_of_child;
    (void)state;
    make_jpeg(&jpeg, NULL, NULL);
    changed.size = 0;
    append(&changed, jpeg.bytes, jpeg.size - 6);
    append(&changed, "\xff\xd9", 2);
    path = write_bytes("few.jpg", changed.bytes, changed.size);
    child = fork();
    assert_true(child >= 0);
    if (!child) {
        const struct rlimit few = {4, 4};
        asj_image_file *file;
        close(STDERR_FILENO);
        while (open("/dev/null", O_RDONLY) >= 0 && open("/dev/null", O_RDONLY) < 3)
            continue;
        close(3);
        setrlimit(RLIMIT_NOFILE, &few);
        _exit(asj_image_file_read(path, 0, &file, NULL, 0) == ASJ_ERROR_FORMAT ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &state_of_child, 0), child);
    assert_true(WIFEXITED(state_of_child));
    assert_int_equal(WEXITSTATUS(state_of_child), 0);
}

int main(void)
{
    const struct CMUnitTest always[] = {
        cmocka_unit_test(pnm_gray_colour_and_depth),
        cmocka_unit_test(pnm_of_every_kind),
        cmocka_unit_test(pfm_floats),
        cmocka_unit_test(formats_that_are_known_but_not_read),
        cmocka_unit_test(formats_that_this_build_lacks),
    };
    const struct CMUnitTest jpeg[] = {
        cmocka_unit_test(jpeg_pixels_and_orientation),
        cmocka_unit_test(the_first_exif_block_counts),
        cmocka_unit_test(views_behind_the_first_are_told),
        cmocka_unit_test(pictures_of_a_pnm_behind_the_first_are_told),
        cmocka_unit_test(jpeg_cut_at_every_length),
        cmocka_unit_test(jpeg_with_too_few_or_too_many_data),
        cmocka_unit_test(damage_is_seen_without_descriptors),
    };
    const struct CMUnitTest tiff[] = {cmocka_unit_test(tiff_orientation_is_applied_once),
                                     cmocka_unit_test(pages_behind_the_first_are_told)};
    const struct CMUnitTest changed[] = {cmocka_unit_test(any_byte_changed)};
    const struct CMUnitTest of_webp[] = {cmocka_unit_test(webp_pixels)};
    const struct CMUnitTest of_jpeg2000[] = {cmocka_unit_test(jpeg2000_pixels)};
    const struct CMUnitTest opencv[] = {cmocka_unit_test(bmp_through_opencv), cmocka_unit_test(gray_sun_raster_through_opencv)};
    int failed = cmocka_run_group_tests_name("io: formats", always, make_folder, remove_folder);
    if (is_read("JPEG"))
        failed += cmocka_run_group_tests_name("io: JPEG", jpeg, make_folder, remove_folder);
    if (is_read("TIFF"))
        failed += cmocka_run_group_tests_name("io: TIFF", tiff, make_folder, remove_folder);
    if (is_read("WebP"))
        failed += cmocka_run_group_tests_name("io: WebP", of_webp, make_folder, remove_folder);
    if (is_read("JPEG 2000"))
        failed += cmocka_run_group_tests_name("io: JPEG 2000", of_jpeg2000, make_folder, remove_folder);
    if (is_read("BMP"))
        failed += cmocka_run_group_tests_name("io: OpenCV", opencv, make_folder, remove_folder);
    if (is_read("JPEG") && is_read("TIFF"))
        failed += cmocka_run_group_tests_name("io: changed bytes", changed, make_folder, remove_folder);
    return failed;
}
