/* SPDX-License-Identifier: BSD-2-Clause */
/* From views to gray planes: formats, white levels, strides, what is refused. */
#include "unit_test.h"

typedef unit_fixture fixture;

static asj_status load(fixture *f, const asj_image *image)
{
    asj_status status = asj_image_check(f->context, image);
    if (status == ASJ_OK)
        status = asj_frame_prepare(f->context, &f->frame, image->width, image->height);
    return status == ASJ_OK ? asj_frame_load(f->context, &f->frame, image, ASJ_PLANE_LUMA) : status;
}

static int32_t gray(const fixture *f, int32_t x, int32_t y)
{
    return f->frame.gray[y * f->frame.stride + x];
}

/* The nearest of the 32641 levels; ties may go either way with the rounding of float. */
static void check_level(const fixture *f, int32_t x, int32_t y, double share)
{
    unit_near("level", x, y, gray(f, x, y), fmin(fmax(share, 0), 1) * ASJ_GRAY_MAX, 0.505);
}

static int32_t bytes_of(int32_t format)
{
    static const int32_t bytes[] = {0, 1, 2, 3, 3, 4, 4, 4};
    return bytes[format];
}

static void test_gray8(void **state)
{
    uint8_t pixels[256];
    for (int i = 0; i < 256; i++)
        pixels[i] = (uint8_t)i;
    asj_image image = unit_gray8(pixels, 32, 8);
    assert_int_equal(load(*state, &image), ASJ_OK);
    for (int i = 0; i < 256; i++)
        assert_int_equal(gray(*state, i % 32, i / 32), i * ASJ_GRAY_ONE); /* exact at the default white */
    image.white = 100;
    assert_int_equal(load(*state, &image), ASJ_OK);
    for (int i = 0; i < 256; i++)
        check_level(*state, i % 32, i / 32, i / 100.0);
}

static void test_gray16(void **state)
{
    static uint16_t pixels[65536];
    static const float whites[] = {0, 65535, 1023, 1, 70000};
    for (int i = 0; i < 65536; i++)
        pixels[i] = (uint16_t)i;
    for (size_t k = 0; k < UNIT_COUNT(whites); k++) {
        const asj_image image = {pixels, ASJ_FORMAT_GRAY16, 256, 256, whites[k], 0};
        assert_int_equal(load(*state, &image), ASJ_OK);
        for (int i = 0; i < 65536; i++)
            check_level(*state, i % 256, i / 256, i / (whites[k] > 0 ? (double)whites[k] : 65535));
    }
    for (int i = 0; i < 256; i++)
        pixels[i] = (uint16_t)(i * 257); /* 8-bit levels in 16 bits: the same planes */
    const asj_image image = {pixels, ASJ_FORMAT_GRAY16, 256, 1, 0, 0};
    assert_int_equal(load(*state, &image), ASJ_OK);
    for (int i = 0; i < 256; i++)
        assert_int_equal(gray(*state, i, 0), i * ASJ_GRAY_ONE);
}

static void test_float(void **state)
{
    static const float values[] = {0, 1, 0.5f, -0.0f, -3, 7, 1e30f, -1e30f, 1e-30f, 0.25f, 1 / 3.0f, 254 / 255.0f};
    const int32_t count = (int32_t)UNIT_COUNT(values);
    static const float whites[] = {0, 1, 2, 255, 1e-3f};
    for (size_t k = 0; k < UNIT_COUNT(whites); k++) {
        const asj_image image = {values, ASJ_FORMAT_GRAY_FLOAT, count, 1, whites[k], 0};
        assert_int_equal(load(*state, &image), ASJ_OK);
        for (int32_t i = 0; i < count; i++)
            check_level(*state, i, 0, (double)values[i] / (whites[k] > 0 ? (double)whites[k] : 1));
    }
}

/* Absurd white levels are levels all the same: black stays black, the rest becomes white or black. */
static void test_extreme_white(void **state)
{
    static const float floats[3] = {0, 1, 0.5f};
    static const uint16_t words[3] = {0, 65535, 1};
    static const uint8_t bytes[3] = {0, 255, 1};
    const void *const data[3] = {floats, words, bytes};
    static const int32_t formats[3] = {ASJ_FORMAT_GRAY_FLOAT, ASJ_FORMAT_GRAY16, ASJ_FORMAT_GRAY8};
    for (int i = 0; i < 3; i++) {
        asj_image image = {data[i], formats[i], 3, 1, 1e-38f, 0};
        assert_int_equal(load(*state, &image), ASJ_OK);
        assert_int_equal(gray(*state, 0, 0), 0);
        assert_int_equal(gray(*state, 1, 0), ASJ_GRAY_MAX);
        assert_int_equal(gray(*state, 2, 0), ASJ_GRAY_MAX);
        image.white = 3e38f;
        assert_int_equal(load(*state, &image), ASJ_OK);
        for (int x = 0; x < 3; x++)
            assert_int_equal(gray(*state, x, 0), 0);
    }
}

/* Luma as image.h states it, from each order of channels; alpha is ignored. */
static void test_colour(void **state)
{
    static const struct {
        int32_t format, red, green, blue;
    } orders[] = {{ASJ_FORMAT_RGB8, 0, 1, 2}, {ASJ_FORMAT_BGR8, 2, 1, 0}, {ASJ_FORMAT_RGBA8, 0, 1, 2}, {ASJ_FORMAT_BGRA8, 2, 1, 0}};
    enum { WIDTH = 61, HEIGHT = 13 };
    uint8_t pixels[WIDTH * HEIGHT * 4];
    synth_random random;
    synth_random_seed(&random, 5);
    for (size_t k = 0; k < UNIT_COUNT(orders); k++) {
        const int32_t step = bytes_of(orders[k].format);
        for (size_t i = 0; i < sizeof pixels; i++)
            pixels[i] = (uint8_t)(synth_random_bits(&random) >> 40);
        memset(pixels, 255, (size_t)step);          /* white */
        memset(pixels + step, 0, (size_t)step);     /* black */
        const asj_image image = {pixels, orders[k].format, WIDTH, HEIGHT, 0, 0};
        assert_int_equal(load(*state, &image), ASJ_OK);
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++) {
            const uint8_t *p = pixels + i * step;
            const int32_t luma = (77 * p[orders[k].red] + 150 * p[orders[k].green] + 29 * p[orders[k].blue] + 128) / 256;
            assert_int_equal(gray(*state, i % WIDTH, i / WIDTH), luma * ASJ_GRAY_ONE);
        }
        assert_int_equal(gray(*state, 0, 0), ASJ_GRAY_MAX);
        assert_int_equal(gray(*state, 1, 0), 0);
        memset(pixels, 100, sizeof pixels); /* half as bright as what is white */
        const asj_image dim = {pixels, orders[k].format, WIDTH, HEIGHT, 200, 0};
        const asj_image flat = {pixels, ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 200, 0};
        assert_int_equal(load(*state, &flat), ASJ_OK);
        const int32_t level = gray(*state, 7, 5);
        assert_in_range(level, ASJ_GRAY_MAX * 49 / 100, ASJ_GRAY_MAX * 51 / 100);
        assert_int_equal(load(*state, &dim), ASJ_OK);
        assert_int_equal(gray(*state, 7, 5), level);
    }
}

/* Rows with gaps, of any number of bytes: strides need not suit the samples' alignment. */
static void test_strides(void **state)
{
    enum { WIDTH = 7, HEIGHT = 5 };
    for (int32_t format = ASJ_FORMAT_GRAY8; format <= ASJ_FORMAT_GRAY_FLOAT; format++)
        for (int32_t gap = 0; gap < 9; gap++) {
            const size_t row = (size_t)(WIDTH * bytes_of(format)), stride = row + (size_t)gap, size = stride * (HEIGHT - 1) + row;
            unsigned char *packed = malloc(row * HEIGHT), *spaced = malloc(size); /* no byte behind the last pixel */
            assert_non_null(packed);
            assert_non_null(spaced);
            memset(spaced, 0xff, size);
            for (size_t i = 0; i < row * HEIGHT; i++)
                packed[i] = (unsigned char)(i * 37);
            if (format == ASJ_FORMAT_GRAY_FLOAT)
                for (size_t i = 0; i < WIDTH * HEIGHT; i++)
                    ((float *)(void *)packed)[i] = (float)i / 50;
            for (size_t y = 0; y < HEIGHT; y++)
                memcpy(spaced + y * stride, packed + y * row, row);
            asj_image image = {packed, format, WIDTH, HEIGHT, 0, 0};
            int32_t levels[WIDTH * HEIGHT];
            assert_int_equal(load(*state, &image), ASJ_OK);
            for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
                levels[i] = gray(*state, i % WIDTH, i / WIDTH);
            image.data = spaced;
            image.stride = (ptrdiff_t)stride;
            assert_int_equal(load(*state, &image), ASJ_OK);
            for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
                assert_int_equal(gray(*state, i % WIDTH, i / WIDTH), levels[i]);
            free(spaced);
            free(packed);
        }
}

static void expect(fixture *f, const asj_image *image, asj_status status, const char *word)
{
    assert_int_equal(asj_image_check(f->context, image), status);
    if (status != ASJ_OK && !strstr(asj_context_message(f->context), word))
        fail_msg("'%s' does not say '%s'", asj_context_message(f->context), word);
}

static void test_refused(void **state)
{
    static const uint8_t pixels[64] = {0};
    const asj_image good = unit_gray8(pixels, 8, 8);
    asj_image image = good;
    expect(*state, &image, ASJ_OK, "");
    image.data = NULL;
    expect(*state, &image, ASJ_ERROR_IMAGE, "no data");
    static const int32_t formats[] = {0, -1, 8, INT32_MAX, INT32_MIN};
    for (size_t i = 0; i < UNIT_COUNT(formats); i++) {
        image = good;
        image.format = formats[i];
        expect(*state, &image, ASJ_ERROR_IMAGE, "format");
    }
    static const int32_t sides[] = {0, -1, INT32_MIN};
    for (size_t i = 0; i < UNIT_COUNT(sides); i++) {
        image = good;
        image.width = sides[i];
        expect(*state, &image, ASJ_ERROR_IMAGE, "empty");
        image = good;
        image.height = sides[i];
        expect(*state, &image, ASJ_ERROR_IMAGE, "empty");
    }
    static const int32_t limits[][2] = {{ASJ_MAX_SIDE + 1, 1}, {1, ASJ_MAX_SIDE + 1}, {INT32_MAX, INT32_MAX},
                                        {ASJ_MAX_SIDE, ASJ_MAX_SIDE},
                                        {32768, 16385}};
    for (size_t i = 0; i < UNIT_COUNT(limits); i++) {
        image = good;
        image.width = limits[i][0];
        image.height = limits[i][1];
        expect(*state, &image, ASJ_ERROR_LIMIT, "65535");
    }
    image.width = 32768; /* the limits themselves are inside */
    image.height = 16384;
    expect(*state, &image, ASJ_OK, "");
    image.width = 1;
    image.height = ASJ_MAX_SIDE;
    expect(*state, &image, ASJ_OK, "");
    static const float whites[] = {-1, -1e-30f, NAN, INFINITY, -INFINITY};
    for (size_t i = 0; i < UNIT_COUNT(whites); i++) {
        image = good;
        image.white = whites[i];
        expect(*state, &image, ASJ_ERROR_IMAGE, "white");
    }
}

/* Rows from the last to the first: the same picture. */
static void test_bottom_up(void **state)
{
    enum { WIDTH = 19, HEIGHT = 7 };
    static uint8_t pixels[WIDTH * HEIGHT * 4], turned[WIDTH * HEIGHT * 4];
    static uint16_t gray_before[WIDTH * HEIGHT];
    fixture *f = *state;
    for (int32_t format = ASJ_FORMAT_GRAY8; format <= ASJ_FORMAT_BGRA8; format++) {
        const ptrdiff_t row = WIDTH * bytes_of(format);
        for (int32_t i = 0; i < row * HEIGHT; i++)
            pixels[i] = (uint8_t)(i * 37 + i / 11);
        for (int32_t y = 0; y < HEIGHT; y++)
            memcpy(turned + (HEIGHT - 1 - y) * row, pixels + y * row, (size_t)row);
        const asj_image image = {pixels, format, WIDTH, HEIGHT, 0, 0};
        const asj_image bottom_up = {turned + (HEIGHT - 1) * row, format, WIDTH, HEIGHT, 0, -row};
        assert_int_equal(load(f, &image), ASJ_OK);
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
            gray_before[i] = (uint16_t)gray(f, i % WIDTH, i / WIDTH);
        assert_int_equal(load(f, &bottom_up), ASJ_OK);
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
            assert_int_equal(gray(f, i % WIDTH, i / WIDTH), gray_before[i]);
    }
}

/* A stride is at least a row long, whatever the format and the direction. */
static void test_short_strides(void **state)
{
    static const uint8_t pixels[64] = {0};
    for (int32_t format = ASJ_FORMAT_GRAY8; format <= ASJ_FORMAT_GRAY_FLOAT; format++) {
        asj_image image = {pixels, format, 5, 3, 0, 0};
        image.stride = (ptrdiff_t)5 * bytes_of(format) - 1;
        expect(*state, &image, ASJ_ERROR_IMAGE, "stride");
        image.stride++;
        expect(*state, &image, ASJ_OK, "");
        image.stride = 1 - image.stride;
        expect(*state, &image, ASJ_ERROR_IMAGE, "stride");
        image.stride = PTRDIFF_MIN; /* nobody has so much memory */
        expect(*state, &image, ASJ_ERROR_IMAGE, "stride");
        image.stride = PTRDIFF_MAX / 2;
        expect(*state, &image, ASJ_ERROR_IMAGE, "stride");
        image.stride = PTRDIFF_MAX / 3;
        assert_int_equal(asj_image_check(((fixture *)*state)->context, &image), ASJ_OK);
        image.stride = 1;
        expect(*state, &image, ASJ_ERROR_IMAGE, "stride");
    }
}

static void test_not_finite(void **state)
{
    static const float bad[] = {NAN, INFINITY, -INFINITY};
    float values[5 * 4] = {0};
    const asj_image image = {values, ASJ_FORMAT_GRAY_FLOAT, 5, 4, 0, 0};
    for (size_t b = 0; b < UNIT_COUNT(bad); b++)
        for (size_t i = 0; i < 20; i++) {
            char row[32];
            values[i] = bad[b];
            assert_int_equal(load(*state, &image), ASJ_ERROR_IMAGE);
            snprintf(row, sizeof row, "row %zu ", i / 5);
            assert_non_null(strstr(asj_context_message(((fixture *)*state)->context), row));
            values[i] = 0;
        }
    assert_int_equal(load(*state, &image), ASJ_OK);
}

/* Memory is kept for smaller images and grows for larger ones; after a failure the frame can still be used. */
static void test_prepare(void **state)
{
    fixture *f = *state;
    assert_int_equal(asj_frame_prepare(f->context, &f->frame, 300, 200), ASJ_OK);
    const long calls = f->counter.calls;
    assert_int_equal(asj_frame_prepare(f->context, &f->frame, 200, 250), ASJ_OK);
    assert_int_equal(f->counter.calls, calls);
    assert_int_equal(f->frame.blocks, 13);
    assert_true(f->frame.stride >= 13 * ASJ_LANES + 2 * ASJ_MARGIN);
    for (long n = 1; n <= 3; n++) {
        f->counter.fail_at = f->counter.calls + 1; /* all planes stand in one block */
        assert_int_equal(asj_frame_prepare(f->context, &f->frame, 400 + (int32_t)n * 100, 400), ASJ_ERROR_MEMORY);
        f->counter.fail_at = 0;
        assert_int_equal(asj_frame_prepare(f->context, &f->frame, 20, 20), ASJ_OK);
    }
}

/* Bilinear between pixel centres, in whole 1/128 of a grey level; the border goes on, and the gradient's margins are empty. */
static void test_upsample(void **state)
{
    enum { WIDTH = 19, HEIGHT = 11 };
    static const int32_t sizes[][2] = {{WIDTH, HEIGHT}, {1, 1}, {3, HEIGHT}, {WIDTH, 2}};
    fixture *f = *state;
    uint8_t pixels[WIDTH * HEIGHT];
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        pixels[i] = (uint8_t)(i * 89 % 251);
    for (size_t k = 0; k < UNIT_COUNT(sizes); k++) {
        const int32_t w = sizes[k][0], h = sizes[k][1];
        const asj_image image = unit_gray8(pixels, w, h);
        f->frame.octaves = 3;
        assert_int_equal(asj_frame_upsample(f->context, &f->frame, &image, ASJ_PLANE_LUMA), ASJ_OK);
        assert_true(f->frame.width == 2 * w && f->frame.height == 2 * h && f->frame.octave == -1 && f->frame.octaves == 3);
        for (int32_t y = -ASJ_GRAY_BORDER; y < 2 * h + ASJ_GRAY_BORDER; y++)
            for (int32_t x = -ASJ_GRAY_BORDER; x < 2 * w + ASJ_GRAY_BORDER; x++) {
                const double u = fmin(fmax(0.5 * fmin(fmax(x, 0), 2 * w - 1) - 0.25, 0), w - 1);
                const double v = fmin(fmax(0.5 * fmin(fmax(y, 0), 2 * h - 1) - 0.25, 0), h - 1);
                const int32_t i = (int32_t)u, j = (int32_t)v, right = i + 1 < w ? i + 1 : i, below = j + 1 < h ? j + 1 : j;
                const double upper = pixels[j * w + i] + (u - i) * (pixels[j * w + right] - pixels[j * w + i]);
                const double lower = pixels[below * w + i] + (u - i) * (pixels[below * w + right] - pixels[below * w + i]);
                const double level = upper + (v - j) * (lower - upper);
                assert_int_equal(gray(f, x, y), floor(level * ASJ_GRAY_ONE + 0.5));
            }
        for (int32_t i = 1; i <= ASJ_MARGIN; i++)
            assert_true(f->frame.gradient_x[-i] == 0 && f->frame.gradient_y[2 * w - 1 + i] == 0 &&
                        f->frame.gradient_x[-i * f->frame.stride] == 0 &&
                        f->frame.gradient_x[(2 * h - 1 + i) * f->frame.stride + w] == 0);
    }
    f->counter.fail_at = f->counter.calls + 1;
    const asj_image large = unit_gray8(calloc(300 * 300, 1), 300, 300);
    assert_non_null(large.data);
    assert_int_equal(asj_frame_upsample(f->context, &f->frame, &large, ASJ_PLANE_LUMA), ASJ_ERROR_MEMORY);
    f->counter.fail_at = 0;
    free((void *)(uintptr_t)large.data);
}

/* Means of 2 x 2 levels, those between two of them rounded up; white too. */
static void test_halve_row(void **state)
{
    enum { WIDTH = 37 };
    uint16_t rows[2][2 * WIDTH], means[WIDTH + 1];
    synth_random random;
    (void)state;
    synth_random_seed(&random, 4);
    for (int i = 0; i < 2 * WIDTH; i++)
        for (int k = 0; k < 2; k++)
            rows[k][i] = (uint16_t)(i < 4 ? ASJ_GRAY_MAX : synth_random_between(&random, 0, ASJ_GRAY_MAX));
    means[WIDTH] = 7;
    asj_halve_row(rows[0], rows[1], WIDTH, means);
    for (int i = 0; i < WIDTH; i++)
        assert_int_equal(means[i], floor((rows[0][2 * i] + rows[0][2 * i + 1] + rows[1][2 * i] + rows[1][2 * i + 1]) / 4.0 + 0.5));
    assert_int_equal(means[WIDTH], 7);
}

/* A loaded plane is there yet behind those of coarser octaves, border included; not behind a larger one, in another size, of
 * another plane, or where octaves are so small that their margins reach it. */
static void test_recall(void **state)
{
    enum { WIDTH = 93, HEIGHT = 85, ROW = WIDTH + 2 * ASJ_GRAY_BORDER, ROWS = HEIGHT + 2 * ASJ_GRAY_BORDER };
    static uint8_t pixels[HEIGHT][WIDTH];
    static uint16_t before[ROWS][ROW];
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0}, little = {pixels, ASJ_FORMAT_GRAY8, 4, 4, WIDTH, 0};
    unit_fixture *f = *state;
    synth_random random;
    synth_random_seed(&random, 6);
    for (int y = 0; y < HEIGHT; y++)
        for (int x = 0; x < WIDTH; x++)
            pixels[y][x] = (uint8_t)synth_random_between(&random, 0, 256);
    assert_int_equal(load(f, &image), ASJ_OK);
    for (int y = 0; y < ROWS; y++)
        memcpy(before[y], f->frame.gray + (y - ASJ_GRAY_BORDER) * f->frame.stride - ASJ_GRAY_BORDER, sizeof before[y]);
    for (int octave = 1; octave < 4; octave++) {
        assert_int_equal(asj_frame_halve(f->context, &f->frame), ASJ_OK);
        for (int32_t y = 0; y < f->frame.height; y++) {
            memset(f->frame.gradient_x + y * f->frame.stride, 1, (size_t)f->frame.width * sizeof *f->frame.gradient_x);
            memset(f->frame.gradient_y + y * f->frame.stride, 2, (size_t)f->frame.width * sizeof *f->frame.gradient_y);
        }
    }
    assert_false(asj_frame_recall(&f->frame, WIDTH, HEIGHT - 1, ASJ_PLANE_LUMA));
    assert_false(asj_frame_recall(&f->frame, WIDTH, HEIGHT, ASJ_PLANE_LUMA + 1));
    assert_true(asj_frame_recall(&f->frame, WIDTH, HEIGHT, ASJ_PLANE_LUMA));
    assert_true(f->frame.width == WIDTH && f->frame.height == HEIGHT && f->frame.octave == 0);
    for (int y = 0; y < ROWS; y++)
        assert_memory_equal(before[y], f->frame.gray + (y - ASJ_GRAY_BORDER) * f->frame.stride - ASJ_GRAY_BORDER, sizeof before[y]);
    assert_int_equal(asj_frame_prepare(f->context, &f->frame, WIDTH + 40, HEIGHT), ASJ_OK);
    assert_false(asj_frame_recall(&f->frame, WIDTH, HEIGHT, ASJ_PLANE_LUMA));
    assert_int_equal(load(f, &little), ASJ_OK);
    assert_int_equal(asj_frame_halve(f->context, &f->frame), ASJ_OK);
    assert_false(asj_frame_recall(&f->frame, 4, 4, ASJ_PLANE_LUMA));
}

/* The mean of the plane between first and end along both axes, pixel k from k to k + 1. */
static double mean_between(const uint8_t *pixels, int32_t width, double left, double right, double top, double bottom)
{
    double sum = 0;
    for (int32_t y = (int32_t)top; y < bottom; y++)
        for (int32_t x = (int32_t)left; x < right; x++)
            sum += (fmin(x + 1, right) - fmax(x, left)) * (fmin(y + 1, bottom) - fmax(y, top)) * pixels[y * width + x];
    return sum / ((right - left) * (bottom - top));
}

/* Means over sqrt 2 x sqrt 2 px, to what rounding their shares to 1/256 leaves; what is the same everywhere stays. The plane that
 * is kept becomes the next octave, as the frame itself does. */
static void test_shrink(void **state)
{
    enum { WIDTH = 83, HEIGHT = 47 };
    static const int32_t sizes[][2] = {{WIDTH, HEIGHT}, {2, 2}, {3, HEIGHT}, {WIDTH, 2}};
    const double step = sqrt(2);
    fixture *f = *state;
    uint8_t pixels[WIDTH * HEIGHT];
    for (size_t k = 0; k < 2 * UNIT_COUNT(sizes); k++) {
        const int32_t w = sizes[k / 2][0], h = sizes[k / 2][1], same = k % 2;
        const asj_image image = unit_gray8(pixels, w, h);
        asj_gray_plane kept;
        for (int i = 0; i < w * h; i++)
            pixels[i] = (uint8_t)(same ? 255 : i * 89 % 251);
        assert_int_equal(asj_frame_prepare(f->context, &f->frame, w, h), ASJ_OK);
        assert_int_equal(asj_frame_load(f->context, &f->frame, &image, ASJ_PLANE_LUMA), ASJ_OK);
        f->frame.octave = 2;
        f->frame.octaves = 7;
        assert_int_equal(asj_gray_plane_keep(f->context, &f->frame, &kept), ASJ_OK);
        assert_int_equal(asj_frame_shrink(f->context, &f->frame, &kept), ASJ_OK);
        assert_true(f->frame.width == (int32_t)(w / step) && f->frame.height == (int32_t)(h / step));
        assert_true(f->frame.octave == 2.5 && f->frame.octaves == 7);
        for (int32_t y = 0; y < f->frame.height; y++)
            for (int32_t x = 0; x < f->frame.width; x++) {
                const double mean = mean_between(pixels, w, x * step, (x + 1) * step, y * step, (y + 1) * step);
                assert_true(fabs((double)gray(f, x, y) / ASJ_GRAY_ONE - mean) < (same ? 1e-9 : 1.0));
            }
        assert_int_equal(gray(f, -ASJ_GRAY_BORDER, -1), gray(f, 0, 0));
        assert_int_equal(gray(f, f->frame.width, f->frame.height + ASJ_GRAY_BORDER - 1),
                         gray(f, f->frame.width - 1, f->frame.height - 1));
        assert_int_equal(asj_frame_halve_plane(f->context, &f->frame, &kept), ASJ_OK);
        assert_true(f->frame.width == w / 2 && f->frame.height == h / 2 && f->frame.octave == 3 && f->frame.octaves == 7);
        for (int32_t y = 0; y < h / 2; y++)
            for (int32_t x = 0; x < w / 2; x++)
                assert_true(gray(f, x, y) == mean_between(pixels, w, 2 * x, 2 * x + 2, 2 * y, 2 * y + 2) * ASJ_GRAY_ONE);
        asj_release(&f->context->memory, kept.levels);
    }
}

/* A large frame needs no copy of its plane for that. */
static void test_shrink_in_place(void **state)
{
    static const int32_t sizes[][2] = {{256, 256}, {257, 1031}, {1031, 256}, {273, 289}};
    fixture *f = *state;
    for (size_t k = 0; k < UNIT_COUNT(sizes); k++) {
        const int32_t w = sizes[k][0], h = sizes[k][1], width = (int32_t)(w / ASJ_SQRT2), height = (int32_t)(h / ASJ_SQRT2);
        uint8_t *pixels = malloc((size_t)w * (size_t)h);
        uint16_t *expected = malloc((size_t)width * (size_t)height * sizeof *expected);
        assert_true(pixels && expected);
        for (int32_t i = 0; i < w * h; i++)
            pixels[i] = (uint8_t)(i * 89 % 251);
        const asj_image image = unit_gray8(pixels, w, h);
        for (int in_place = 0; in_place < 2; in_place++) {
            asj_gray_plane plane;
            assert_int_equal(asj_frame_prepare(f->context, &f->frame, w, h), ASJ_OK);
            assert_int_equal(asj_frame_load(f->context, &f->frame, &image, ASJ_PLANE_LUMA), ASJ_OK);
            assert_true(asj_frame_shrinks_in_place(&f->frame));
            plane = asj_frame_gray(&f->frame);
            if (!in_place)
                assert_int_equal(asj_gray_plane_keep(f->context, &f->frame, &plane), ASJ_OK);
            assert_int_equal(asj_frame_shrink(f->context, &f->frame, &plane), ASJ_OK);
            assert_true(f->frame.width == width && f->frame.height == height);
            for (int32_t i = 0; i < width * height && in_place; i++)
                assert_int_equal(gray(f, i % width, i / width), expected[i]);
            for (int32_t i = 0; i < width * height && !in_place; i++)
                expected[i] = f->frame.gray[(i / width) * f->frame.stride + i % width];
            if (!in_place)
                asj_release(&f->context->memory, plane.levels);
        }
        free(expected);
        free(pixels);
    }
    assert_int_equal(asj_frame_prepare(f->context, &f->frame, 255, 400), ASJ_OK);
    assert_false(asj_frame_shrinks_in_place(&f->frame));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_gray8),         cmocka_unit_test(test_gray16),     cmocka_unit_test(test_float),
        cmocka_unit_test(test_extreme_white), cmocka_unit_test(test_colour),     cmocka_unit_test(test_strides),
        cmocka_unit_test(test_refused),       cmocka_unit_test(test_short_strides),
        cmocka_unit_test(test_bottom_up), cmocka_unit_test(test_not_finite),
        cmocka_unit_test(test_prepare), cmocka_unit_test(test_upsample), cmocka_unit_test(test_shrink),
        cmocka_unit_test(test_shrink_in_place), cmocka_unit_test(test_halve_row), cmocka_unit_test(test_recall),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
