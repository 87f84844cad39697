/* SPDX-License-Identifier: BSD-2-Clause */
/* Grey planes of images at another size against the formula of resized.c, evaluated pixel by pixel in double precision. */
#include "unit_test.h"

typedef unit_fixture fixture;

enum { WIDTH = 61, HEIGHT = 47 };

static double level(const uint8_t *pixels, int32_t x, int32_t y)
{
    const int32_t column = x < 0 ? 0 : x >= WIDTH ? WIDTH - 1 : x, row = y < 0 ? 0 : y >= HEIGHT ? HEIGHT - 1 : y;
    return pixels[row * WIDTH + column] * (double)ASJ_GRAY_ONE;
}

/* Between the four pixels around, with weights in 1/256. */
static double wanted(const uint8_t *pixels, const asj_frame *frame, int32_t x, int32_t y)
{
    const double u = (x + 0.5) * WIDTH / frame->width - 0.5, v = (y + 0.5) * HEIGHT / frame->height - 0.5;
    const double f = floor((u - floor(u)) * 256 + 0.5) / 256, g = floor((v - floor(v)) * 256 + 0.5) / 256;
    const int32_t i = (int32_t)floor(u), j = (int32_t)floor(v);
    return (1 - g) * ((1 - f) * level(pixels, i, j) + f * level(pixels, i + 1, j)) +
           g * ((1 - f) * level(pixels, i, j + 1) + f * level(pixels, i + 1, j + 1));
}

static void random_pixels(uint8_t *pixels)
{
    synth_random random;
    synth_random_seed(&random, 6);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        pixels[i] = i % 7 ? (uint8_t)(256 * synth_random_unit(&random)) : 255;
}

/* With their borders, and zeros around the gradient. */
static void levels_are_interpolated(void **state)
{
    static const int32_t sizes[][2] = {{WIDTH, HEIGHT}, {51, 40}, {73, 56}, {46, 36}, {2 * WIDTH, 2 * HEIGHT}};
    fixture *f = *state;
    uint8_t pixels[WIDTH * HEIGHT];
    random_pixels(pixels);
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
    for (size_t n = 0; n < UNIT_COUNT(sizes); n++) {
        asj_frame frame = {.octave = -1, .octaves = 3};
        const int32_t width = sizes[n][0], height = sizes[n][1];
        assert_int_equal(asj_frame_load_resized(f->context, &frame, &image, ASJ_PLANE_LUMA, width, height), ASJ_OK);
        assert_true(frame.width == width && frame.height == height && frame.octave == -1 && frame.octaves == 3);
        for (int32_t y = 0; y < height; y++)
            for (int32_t x = 0; x < width; x++)
                unit_near("level", x, y, frame.gray[y * frame.stride + x], wanted(pixels, &frame, x, y), 0.5001);
        assert_int_equal(frame.gray[-1 - frame.stride], frame.gray[0]);
        assert_int_equal(frame.gradient_x[-1], 0);
        assert_int_equal(frame.gradient_y[height * frame.stride], 0);
        asj_frame_free(&f->context->memory, &frame);
    }
}

static void memory_and_threads(void **state)
{
    fixture *f = *state;
    uint8_t pixels[WIDTH * HEIGHT];
    random_pixels(pixels);
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
    const long live = f->counter.live;
    for (long n = 1; n <= 3; n++) {
        asj_frame frame = {.octave = 0};
        f->counter.fail_at = f->counter.calls + n;
        assert_int_equal(asj_frame_load_resized(f->context, &frame, &image, ASJ_PLANE_LUMA, 51, 40), ASJ_ERROR_MEMORY);
        f->counter.fail_at = 0;
        asj_frame_free(&f->context->memory, &frame);
        assert_int_equal(f->counter.live, live);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(levels_are_interpolated, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(memory_and_threads, unit_set_up, unit_tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
