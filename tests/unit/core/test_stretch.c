/* SPDX-License-Identifier: BSD-2-Clause */
/* Stretched images against the formula of stretch.c, evaluated pixel by pixel in double precision: every format, strides, factors
 * that are no whole numbers. */
#include "unit_test.h"

#include "core/stretch.h"

typedef unit_fixture fixture;

enum { WIDTH = 13, HEIGHT = 9, LARGEST = 4 };

static const struct {
    int32_t format, channels, bytes;
} formats[] = {{ASJ_FORMAT_GRAY8, 1, 1}, {ASJ_FORMAT_GRAY16, 1, 2}, {ASJ_FORMAT_RGB8, 3, 1},     {ASJ_FORMAT_BGR8, 3, 1},
               {ASJ_FORMAT_RGBA8, 4, 1}, {ASJ_FORMAT_BGRA8, 4, 1},  {ASJ_FORMAT_GRAY_FLOAT, 1, 4}};

static double sample(const asj_image *image, int32_t k, int32_t bytes, int32_t channels, int32_t x, int32_t y)
{
    const ptrdiff_t stride = image->stride ? image->stride : (ptrdiff_t)image->width * channels * bytes;
    const int32_t column = x < 0 ? 0 : x >= image->width ? image->width - 1 : x;
    const int32_t row = y < 0 ? 0 : y >= image->height ? image->height - 1 : y;
    const char *at = (const char *)image->data + row * stride + (column * channels + k) * bytes;
    uint16_t wide;
    float real;
    memcpy(&wide, at, bytes == 2 ? sizeof wide : 0);
    memcpy(&real, at, bytes == 4 ? sizeof real : 0);
    return bytes == 1 ? *(const uint8_t *)at : bytes == 2 ? wide : (double)real;
}

/* Between the four pixels around, with weights in 1/256. */
static double wanted(const asj_image *image, const asj_image *copy, int32_t k, int32_t bytes, int32_t channels, int32_t x,
                     int32_t y)
{
    const double u = (x + 0.5) * image->width / copy->width - 0.5, v = (y + 0.5) * image->height / copy->height - 0.5;
    const double f = floor((u - floor(u)) * 256 + 0.5) / 256, g = floor((v - floor(v)) * 256 + 0.5) / 256;
    const int32_t i = (int32_t)floor(u), j = (int32_t)floor(v);
    return (1 - g) * ((1 - f) * sample(image, k, bytes, channels, i, j) + f * sample(image, k, bytes, channels, i + 1, j)) +
           g * ((1 - f) * sample(image, k, bytes, channels, i, j + 1) + f * sample(image, k, bytes, channels, i + 1, j + 1));
}

static void check(fixture *f, const asj_image *image, size_t n, int32_t width, int32_t height)
{
    asj_memory memory = unit_memory(&f->counter);
    asj_image copy;
    void *pixels = NULL;
    assert_int_equal(asj_stretch_image(f->context, &memory, image, width, height, &copy, &pixels), ASJ_OK);
    assert_ptr_equal(copy.data, pixels);
    assert_int_equal(copy.width, width);
    assert_int_equal(copy.height, height);
    assert_int_equal(copy.format, image->format);
    assert_true(copy.white == image->white && copy.stride == 0);
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            for (int32_t k = 0; k < formats[n].channels; k++)
                unit_near("sample", x, y, sample(&copy, k, formats[n].bytes, formats[n].channels, x, y),
                          wanted(image, &copy, k, formats[n].bytes, formats[n].channels, x, y),
                          formats[n].bytes == 4 ? 1e-7 : 0.5001);
    asj_release(&memory, pixels);
}

static void every_format_is_interpolated(void **state)
{
    static const int32_t sizes[][2] = {{WIDTH, HEIGHT}, {2 * WIDTH, 2 * HEIGHT}, {WIDTH, 3 * HEIGHT}, {31, 14},
                                       {LARGEST * WIDTH, 11}};
    synth_random random;
    synth_random_seed(&random, 5);
    for (size_t n = 0; n < UNIT_COUNT(formats); n++) {
        char pixels[WIDTH * HEIGHT * 4 + 64];
        const ptrdiff_t row = (ptrdiff_t)WIDTH * formats[n].channels * formats[n].bytes;
        for (size_t i = 0; i < sizeof pixels; i++)
            pixels[i] = (char)(int)(256 * synth_random_unit(&random) - 128);
        for (int32_t i = 0; i < WIDTH * HEIGHT && formats[n].bytes == 4; i++) {
            const float value = (float)synth_random_unit(&random);
            memcpy(pixels + (size_t)i * sizeof value, &value, sizeof value);
        }
        for (size_t s = 0; s < UNIT_COUNT(sizes); s++) {
            const asj_image plain = {pixels, formats[n].format, WIDTH, HEIGHT, 3, 0};
            const asj_image upside_down = {pixels + (HEIGHT - 1) * row, formats[n].format, WIDTH, HEIGHT, 0, -row};
            check(*state, &plain, n, sizes[s][0], sizes[s][1]);
            check(*state, &upside_down, n, sizes[s][0], sizes[s][1]);
        }
    }
}

/* Twice as large: a quarter and three quarters, rounded half up. */
static void pixels_of_an_upsampled_row(void **state)
{
    static const uint8_t pixels[3] = {0, 100, 255}, expected[6] = {0, 25, 75, 139, 216, 255};
    fixture *f = *state;
    asj_memory memory = unit_memory(&f->counter);
    const asj_image image = unit_gray8(pixels, 3, 1);
    asj_image copy;
    void *to;
    assert_int_equal(asj_stretch_image(f->context, &memory, &image, 6, 1, &copy, &to), ASJ_OK);
    assert_memory_equal(to, expected, sizeof expected);
    asj_release(&memory, to);
}

static void memory_may_run_out(void **state)
{
    static const uint8_t pixels[3] = {0, 100, 255};
    fixture *f = *state;
    const asj_image image = unit_gray8(pixels, 3, 1);
    for (long n = 1; n <= 3; n++) {
        unit_counter counter = {0, 0, n, 0};
        asj_memory memory = unit_memory(&counter);
        asj_image copy;
        void *to = f;
        assert_int_equal(asj_stretch_image(f->context, &memory, &image, 6, 1, &copy, &to), ASJ_ERROR_MEMORY);
        assert_null(to);
        assert_int_equal(counter.live, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_format_is_interpolated),
        cmocka_unit_test(pixels_of_an_upsampled_row),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
