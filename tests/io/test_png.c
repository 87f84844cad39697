/* SPDX-License-Identifier: BSD-2-Clause */
/* PNG files of every kind, made here with libpng, against exact pixels. */
#include "io_test.h"

#include <png.h>
#include <stdio.h>
#include <string.h>

static asj_image_file *read_image(const char *path)
{
    asj_image_file *file = NULL;
    char message[512];
    asj_status status = asj_image_file_read(path, 0, &file, message, sizeof message);
    if (status != ASJ_OK)
        fail_msg("%s", message);
    return file;
}

/* The samples that image.h promises for a pixel of the test picture; returns how many. */
static int expected_samples(const png_kind *kind, int32_t x, int32_t y, unsigned expected[3])
{
    unsigned s[3];
    int c, colour = kind->colour_type & PNG_COLOR_MASK_COLOR;
    for (c = 0; c < 3; c++)
        s[c] = picture_sample(x, y, c, kind->depth);
    if (kind->colour_type == PNG_COLOR_TYPE_PALETTE) {
        expected[0] = s[0];
        expected[1] = 255 - s[0];
        expected[2] = s[0] / 2;
        return 3;
    }
    if (colour && kind->depth == 16) {
        expected[0] = (77 * s[0] + 150 * s[1] + 29 * s[2] + 128) / 256;
        return 1;
    }
    memcpy(expected, s, sizeof s);
    if (kind->depth < 8)
        expected[0] = s[0] * 255 / ((1u << kind->depth) - 1);
    return colour ? 3 : 1;
}

static void check_pixels(const asj_image_file *file, const png_kind *kind, int32_t width, int32_t height)
{
    const asj_image *image = &file->image;
    int32_t x, y, stored_x, stored_y, turned = file->orientation >= 5;
    int samples, c, wide = kind->depth == 16;
    unsigned expected[3];

    samples = expected_samples(kind, 0, 0, expected);
    assert_int_equal(image->width, turned ? height : width);
    assert_int_equal(image->height, turned ? width : height);
    assert_int_equal(image->format, wide ? ASJ_FORMAT_GRAY16 : samples == 3 ? ASJ_FORMAT_RGB8 : ASJ_FORMAT_GRAY8);
    assert_int_equal(image->stride, 0);
    for (y = 0; y < image->height; y++)
        for (x = 0; x < image->width; x++)
            for (c = 0; c < samples; c++) {
                size_t at = ((size_t)y * (size_t)image->width + (size_t)x) * (size_t)samples + (size_t)c;
                unsigned got = wide ? ((const uint16_t *)image->data)[at] : ((const uint8_t *)image->data)[at];
                stored_place(file->orientation, width, height, x, y, &stored_x, &stored_y);
                expected_samples(kind, stored_x, stored_y, expected);
                if (got != expected[c])
                    fail_msg("type %d depth %d interlaced %d tRNS %d orientation %d, sample %d at (%d, %d): %u, not %u",
                             kind->colour_type, kind->depth, kind->interlaced, kind->with_trns, (int)file->orientation, c, (int)x,
                             (int)y, got, expected[c]);
            }
}

static const png_kind kinds[] = {
    {PNG_COLOR_TYPE_GRAY, 1, 0, 0},       {PNG_COLOR_TYPE_GRAY, 2, 0, 0},     {PNG_COLOR_TYPE_GRAY, 4, 0, 0},
    {PNG_COLOR_TYPE_GRAY, 8, 0, 0},       {PNG_COLOR_TYPE_GRAY, 16, 0, 0},    {PNG_COLOR_TYPE_GRAY_ALPHA, 8, 0, 0},
    {PNG_COLOR_TYPE_GRAY_ALPHA, 16, 0, 0}, {PNG_COLOR_TYPE_PALETTE, 1, 0, 0}, {PNG_COLOR_TYPE_PALETTE, 2, 0, 0},
    {PNG_COLOR_TYPE_PALETTE, 4, 0, 0},    {PNG_COLOR_TYPE_PALETTE, 8, 0, 0},  {PNG_COLOR_TYPE_RGB, 8, 0, 0},
    {PNG_COLOR_TYPE_RGB, 16, 0, 0},       {PNG_COLOR_TYPE_RGB_ALPHA, 8, 0, 0}, {PNG_COLOR_TYPE_RGB_ALPHA, 16, 0, 0},
};
#define KIND_COUNT (sizeof kinds / sizeof kinds[0])

static void every_kind_gives_its_pixels(void **state)
{
    static const int32_t sizes[][2] = {{1, 1}, {7, 5}, {33, 17}, {64, 1}, {1, 64}};
    static test_bytes png;
    size_t k, s;
    int variant;
    (void)state;
    for (k = 0; k < KIND_COUNT; k++)
        for (s = 0; s < sizeof sizes / sizeof sizes[0]; s++)
            for (variant = 0; variant < 4; variant++) {
                png_kind kind = kinds[k];
                asj_image_file *file;
                kind.interlaced = variant & 1;
                kind.with_trns = variant >> 1 && !(kind.colour_type & PNG_COLOR_MASK_ALPHA);
                make_png(&png, &kind, sizes[s][0], sizes[s][1]);
                file = read_image(write_bytes("kind.png", png.bytes, png.size));
                assert_int_equal(file->orientation, 1);
                check_pixels(file, &kind, sizes[s][0], sizes[s][1]);
                asj_image_file_free(&file);
                assert_null(file);
            }
}

/* Puts an eXIf chunk behind IHDR, or before IEND. */
static void insert_exif(test_bytes *png, const test_bytes *exif, int at_end)
{
    static test_bytes copy;
    size_t at = at_end ? png->size - 12 : 8 + 25;
    copy.size = 0;
    append(&copy, png->bytes, at);
    append_chunk(&copy, "eXIf", exif->bytes, exif->size);
    append(&copy, png->bytes + at, png->size - at);
    *png = copy;
}

/* acTL before the pixels, with the number of frames; its content may be too short. */
static void frames_behind_the_first_are_told(void **state)
{
    static const struct {
        unsigned char content[8];
        size_t size;
        int has_more;
    } given[] = {{{0, 0, 0, 2}, 8, 1}, {{0, 0, 0, 1}, 8, 0}, {{1, 0, 0, 0}, 8, 1}, {{0, 0, 2}, 3, 0}, {{0}, 0, 0}};
    static test_bytes png, whole;
    (void)state;
    for (size_t i = 0; i < sizeof given / sizeof given[0]; i++) {
        const size_t at = 8 + 25; /* behind IHDR */
        make_png(&png, &kinds[0], 7, 5);
        whole.size = 0;
        append(&whole, png.bytes, at);
        append_chunk(&whole, "acTL", given[i].content, given[i].size);
        append(&whole, png.bytes + at, png.size - at);
        asj_image_file *file = read_image(write_bytes("frames.png", whole.bytes, whole.size));
        assert_int_equal(file->has_more, given[i].has_more);
        check_pixels(file, &kinds[0], 7, 5);
        asj_image_file_free(&file);
    }
}

static void every_orientation_is_turned_upright(void **state)
{
    static test_bytes png, exif;
    size_t k;
    int orientation, variant;
    (void)state;
    for (k = 0; k < KIND_COUNT; k++)
        for (orientation = 1; orientation <= 8; orientation++)
            for (variant = 0; variant < 8; variant++) {
                png_kind kind = kinds[k];
                asj_image_file *file;
                kind.interlaced = variant & 1;
                make_png(&png, &kind, 7, 5);
                make_exif(&exif, variant >> 1 & 1, orientation);
                insert_exif(&png, &exif, variant >> 2);
                file = read_image(write_bytes("turned.png", png.bytes, png.size));
                assert_int_equal(file->orientation, orientation);
                check_pixels(file, &kind, 7, 5);
                asj_image_file_free(&file);
            }
}

/* A description that makes no sense does not spoil the picture: cut at every length, every byte changed, orientations 0 and 9. */
static void damaged_exif_means_upright(void **state)
{
    static test_bytes png, exif;
    size_t length, changed;
    int orientation;
    (void)state;
    for (length = 0; length <= 40; length++)
        for (changed = 0; changed < 40; changed += length < 38 ? 40 : 1)
            for (orientation = 0; orientation <= 9; orientation += 9) {
                asj_image_file *file;
                make_exif(&exif, 1, orientation);
                if (length < exif.size)
                    exif.size = length;
                if (changed < exif.size && length >= 38)
                    exif.bytes[changed] ^= 0xff;
                make_png(&png, &kinds[3], 7, 5);
                if (exif.size)
                    insert_exif(&png, &exif, 0);
                file = read_image(write_bytes("exif.png", png.bytes, png.size));
                assert_int_equal(file->orientation, 1);
                check_pixels(file, &kinds[3], 7, 5);
                asj_image_file_free(&file);
            }
}

static void what_is_written_reads_back(void **state)
{
    static const int32_t formats[] = {ASJ_FORMAT_GRAY8, ASJ_FORMAT_GRAY16, ASJ_FORMAT_RGB8, ASJ_FORMAT_BGR8, ASJ_FORMAT_RGBA8,
                                      ASJ_FORMAT_BGRA8};
    static const int bytes[] = {1, 2, 3, 3, 4, 4};
    unsigned char pixels[6 * 64];
    char message[512];
    size_t f, i;
    (void)state;
    for (i = 0; i < sizeof pixels; i++)
        pixels[i] = (unsigned char)(i * 37 + 11);
    for (f = 0; f < 6; f++) {
        asj_image view = {pixels, formats[f], 9, 6, 0, 64};
        int swapped = formats[f] == ASJ_FORMAT_BGR8 || formats[f] == ASJ_FORMAT_BGRA8, kept = bytes[f] == 4 ? 3 : bytes[f];
        asj_image_file *file;
        assert_int_equal(asj_png_write(in_folder("written.png"), &view, message, sizeof message), ASJ_OK);
        file = read_image(in_folder("written.png"));
        assert_int_equal(file->image.format, kept == 3 ? ASJ_FORMAT_RGB8 : formats[f]);
        for (i = 0; i < (size_t)(9 * 6 * kept); i++) {
            size_t x = i / (size_t)kept % 9, y = i / (size_t)kept / 9, c = i % (size_t)kept;
            size_t from = y * 64 + x * (size_t)bytes[f] + (swapped ? 2 - c : c);
            assert_int_equal(((const unsigned char *)file->image.data)[i], pixels[from]);
        }
        asj_image_file_free(&file);
    }
}

static void bad_views_are_not_written(void **state)
{
    unsigned char pixel[64] = {0};
    const asj_image views[] = {{pixel, ASJ_FORMAT_GRAY_FLOAT, 2, 2, 0, 0}, {pixel, 99, 2, 2, 0, 0},
                               {NULL, ASJ_FORMAT_GRAY8, 2, 2, 0, 0},       {pixel, ASJ_FORMAT_GRAY8, 0, 2, 0, 0},
                               {pixel, ASJ_FORMAT_GRAY8, 2, -1, 0, 0},     {pixel, ASJ_FORMAT_RGB8, 2, 2, 0, 5},
                               {pixel, ASJ_FORMAT_GRAY8, 1, 4, 0, PTRDIFF_MAX / 2},
                               {pixel, ASJ_FORMAT_GRAY8, 1, 4, 0, PTRDIFF_MIN}};
    char message[512];
    size_t i;
    (void)state;
    for (i = 0; i < sizeof views / sizeof views[0]; i++)
        assert_int_equal(asj_png_write(in_folder("never.png"), &views[i], message, sizeof message), ASJ_ERROR_IMAGE);
    assert_int_equal(asj_png_write(in_folder("never.png"), NULL, NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_png_write(NULL, &views[0], NULL, 0), ASJ_ERROR_ARGUMENT);
    assert_null(fopen(in_folder("never.png"), "rb"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_gives_its_pixels), cmocka_unit_test(every_orientation_is_turned_upright),
        cmocka_unit_test(damaged_exif_means_upright),  cmocka_unit_test(what_is_written_reads_back),
        cmocka_unit_test(bad_views_are_not_written),   cmocka_unit_test(frames_behind_the_first_are_told),
    };
    return cmocka_run_group_tests_name("io: PNG", tests, make_folder, remove_folder);
}
