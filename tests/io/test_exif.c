/* SPDX-License-Identifier: BSD-2-Clause */
/* Focal lengths from EXIF data: values, cut and turned pictures, damage. */
#include "io_test.h"

#include <math.h>
#include <string.h>

static asj_image_file *read_image(const char *path)
{
    asj_image_file *file = NULL;
    char message[512];
    if (asj_image_file_read(path, 0, &file, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
    return file;
}

/* Pictures of 36 x 24 pixels that Pillow wrote: 28 mm on film, or 5 mm with 152.4 pixels an inch (6 a mm). */
static void every_format_tells_it(void **state)
{
    static const struct {
        const char *name;
        int32_t source;
        double focal;
    } files[] = {{"lens.jpg", ASJ_EXIF_FOCAL_FILM, 28}, {"lens.webp", ASJ_EXIF_FOCAL_FILM, 28},
                 {"lens.png", ASJ_EXIF_FOCAL_PLANE, 30}, {"lens.tif", ASJ_EXIF_FOCAL_PLANE, 30},
                 {"gray.jpg", ASJ_EXIF_FOCAL_NONE, 0}, {"gray.png", ASJ_EXIF_FOCAL_NONE, 0},
                 {"lzw.tif", ASJ_EXIF_FOCAL_NONE, 0}, {"lossy.webp", ASJ_EXIF_FOCAL_NONE, 0},
                 {"text.ppm", ASJ_EXIF_FOCAL_NONE, 0}};
    size_t k;
    (void)state;
    for (k = 0; k < sizeof files / sizeof files[0]; k++) {
        char path[1024];
        snprintf(path, sizeof path, "%s/%s", ASJ_IMAGES, files[k].name);
        asj_image_file *file = read_image(path);
        assert_int_equal(file->focal_source, files[k].source);
        assert_true(fabs((double)file->focal_length - files[k].focal) < 1e-4);
        asj_image_file_free(&file);
    }
}

/* What a block says; 0 = nothing. */
typedef struct says {
    unsigned orientation, film, mm, per_unit, below, unit, width, height; /* per_unit / below */
} says;

static void put16(test_bytes *to, unsigned value)
{
    const unsigned char b[2] = {(unsigned char)(value >> 8), (unsigned char)value};
    append(to, b, 2);
}

static void put_entry(test_bytes *to, unsigned tag, unsigned type, uint32_t value)
{
    put16(to, tag);
    put16(to, type);
    append_big32(to, 1);
    if (type == 3) {
        put16(to, value);
        value = 0;
        put16(to, 0);
    } else {
        append_big32(to, value);
    }
}

/* First directory at 8, that of EXIF at 38 with seven entries, two fractions at 128. */
static void make_block(test_bytes *to, const says *s)
{
    to->size = 0;
    append(to, "MM\0*\0\0\0\10", 8);
    put16(to, 2);
    put_entry(to, 0x0112, 3, s->orientation);
    put_entry(to, 0x8769, 4, 38);
    append_big32(to, 0);
    put16(to, 7);
    put_entry(to, 0x920a, 5, 128);
    put_entry(to, 0xa002, 4, s->width);
    put_entry(to, 0xa003, 4, s->height);
    put_entry(to, 0xa20e, 5, 136);
    put_entry(to, 0xa210, s->unit > 65535 ? 4 : 3, s->unit);
    put_entry(to, 0xa405, 3, s->film);
    put_entry(to, 0xa217, 3, 1);
    append_big32(to, 0);
    append_big32(to, s->mm);
    append_big32(to, 1);
    append_big32(to, s->per_unit);
    append_big32(to, s->below);
}

static asj_image_file *read_with(const test_bytes *block, int32_t width, int32_t height)
{
    static test_bytes png, with;
    const png_kind gray = {0, 8, 0, 0};
    make_png(&png, &gray, width, height);
    with.size = 0;
    append(&with, png.bytes, 33);
    append_chunk(&with, "eXIf", block->bytes, block->size);
    append(&with, png.bytes + 33, png.size - 33);
    return read_image(write_bytes("lens.png", with.bytes, with.size));
}

static void values(void **state)
{
    const double diagonal = 43.26661530556787;
    const struct {
        says said;
        int32_t source;
        double focal;
    } cases[] = {
        {{1, 35, 0, 0, 0, 0, 0, 0}, ASJ_EXIF_FOCAL_FILM, 35 * 50 / diagonal}, /* the pictures are 40 x 30 */
        {{6, 35, 0, 0, 0, 0, 40, 30}, ASJ_EXIF_FOCAL_FILM, 35 * 50 / diagonal}, /* held upright */
        {{1, 35, 0, 0, 0, 0, 30, 40}, ASJ_EXIF_FOCAL_FILM, 35 * 50 / diagonal}, /* turned by a program */
        {{1, 35, 5, 100, 1, 4, 4000, 3000}, ASJ_EXIF_FOCAL_FILM, 35 * 50 / diagonal},
        {{1, 0, 5, 800, 1, 4, 4000, 3000}, ASJ_EXIF_FOCAL_PLANE, 40}, /* a hundredth as large since */
        {{1, 0, 5, 80, 10, 4, 0, 0}, ASJ_EXIF_FOCAL_PLANE, 40},
        {{1, 0, 5, 80, 1, 3, 0, 0}, ASJ_EXIF_FOCAL_PLANE, 40},
        {{1, 0, 5, 2032, 10, 2, 0, 0}, ASJ_EXIF_FOCAL_PLANE, 40},
        {{1, 0, 5, 2032, 10, 0, 0, 0}, ASJ_EXIF_FOCAL_PLANE, 40},
        {{1, 0, 5, 80, 10000, 5, 0, 0}, ASJ_EXIF_FOCAL_PLANE, 40},
        {{1, 0, 5, 80, 10, 7, 0, 0}, ASJ_EXIF_FOCAL_NONE, 0}, /* no such unit */
        {{1, 0, 5, 80, 10, 4294967295u, 0, 0}, ASJ_EXIF_FOCAL_NONE, 0},
        {{1, 0, 5, 80, 0, 4, 0, 0}, ASJ_EXIF_FOCAL_NONE, 0},  /* divided by zero */
        {{1, 0, 0, 80, 10, 4, 0, 0}, ASJ_EXIF_FOCAL_NONE, 0},
        {{1, 0, 5, 0, 10, 4, 0, 0}, ASJ_EXIF_FOCAL_NONE, 0},
        {{1, 35, 0, 0, 0, 0, 4000, 2250}, ASJ_EXIF_FOCAL_UNUSABLE, 0}, /* cut from 16:9 to 4:3 */
        {{1, 0, 5, 110, 10, 4, 40, 30}, ASJ_EXIF_FOCAL_UNUSABLE, 0},   /* made smaller: a sensor 3.6 mm wide .. */
        {{1, 0, 18, 80, 10, 4, 40, 30}, ASJ_EXIF_FOCAL_UNUSABLE, 0},   /* .. and one of 5 mm behind a lens of 18 */
        {{1, 0, 18, 2000, 10, 4, 4000, 3000}, ASJ_EXIF_FOCAL_PLANE, 36}, /* .. but not one of 20 mm */
        {{1, 35, 18, 80, 10, 4, 40, 30}, ASJ_EXIF_FOCAL_FILM, 35 * 50 / diagonal}, /* of any size */
        {{1, 1, 0, 0, 0, 0, 0, 0}, ASJ_EXIF_FOCAL_UNUSABLE, 0},        /* 175 degrees */
        {{1, 65535, 0, 0, 0, 0, 0, 0}, ASJ_EXIF_FOCAL_UNUSABLE, 0},
        {{1, 0, 4000000000u, 4000000000u, 1, 5, 0, 0}, ASJ_EXIF_FOCAL_UNUSABLE, 0},
    };
    static test_bytes block;
    size_t k;
    (void)state;
    for (k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        make_block(&block, &cases[k].said);
        asj_image_file *file = read_with(&block, 40, 30);
        if (file->focal_source != cases[k].source || !(fabs((double)file->focal_length - cases[k].focal) < 1e-4))
            fail_msg("case %zu: source %d, %g px", k, (int)file->focal_source, (double)file->focal_length);
        asj_image_file_free(&file);
    }
}

/* A block cut at every length, and with every byte changed: the picture is read, and its focal length is one that can be. */
static void damage(void **state)
{
    const says said = {1, 35, 5, 800, 1, 4, 4000, 3000};
    static test_bytes block;
    size_t whole, k;
    int32_t unusable = 0;
    (void)state;
    make_block(&block, &said);
    whole = block.size;
    for (k = 1; k < 2 * whole; k++) {
        make_block(&block, &said);
        block.size = k < whole ? k : whole;
        if (k >= whole)
            block.bytes[k - whole] ^= 0xff;
        asj_image_file *file = read_with(&block, 40, 30);
        assert_true(isfinite(file->focal_length) && file->focal_length >= 0);
        assert_true((file->focal_length > 0) ==
                    (file->focal_source == ASJ_EXIF_FOCAL_FILM || file->focal_source == ASJ_EXIF_FOCAL_PLANE));
        unusable += file->focal_source == ASJ_EXIF_FOCAL_UNUSABLE;
        asj_image_file_free(&file);
    }
    assert_true(unusable > 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(every_format_tells_it), cmocka_unit_test(values), cmocka_unit_test(damage)};
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
