/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/patch.c and src/match/sift.c: pyramids, sampling and distances against naive evaluations in floating point. */
#include "match/patch.h"
#include "match/sift.h"
#include "tables.h"
#include "unit_test.h"

#define SIDE 64

/* A smooth picture that is known between pixels. */
static double shade(double x, double y)
{
    return 128 + 60 * sin(0.11 * x + 0.05 * y) + 40 * cos(0.07 * y - 0.03 * x);
}

static void fill(uint8_t *pixels, int32_t width, int32_t height)
{
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            pixels[y * width + x] = (uint8_t)floor(shade(x, y) + 0.5);
}

static void make(asj_context *context, int32_t width, int32_t height, double smoothing, asj_pyramid *pyramid)
{
    uint8_t *pixels = malloc((size_t)width * (size_t)height);
    assert_non_null(pixels);
    fill(pixels, width, height);
    const asj_image image = unit_gray8(pixels, width, height);
    asj_status status = asj_pyramid_create(context, &image, smoothing, pyramid);
    free(pixels);
    assert_int_equal(status, ASJ_OK);
}

static void sampling_is_bilinear(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid pyramid;
    make(context, SIDE, SIDE, 0, &pyramid);
    for (int32_t n = 0; n < 500; n++) {
        float x = (float)fmod(7.13 * n, SIDE - 1), y = (float)fmod(3.77 * n, SIDE - 1);
        uint16_t grey;
        assert_int_equal(asj_pyramid_sample(&pyramid, 0, &x, &y, 1, &grey), 1);
        double fx = (double)x - floor((double)x), fy = (double)y - floor((double)y);
        const uint16_t *p = pyramid.plane[0] + (int32_t)y * (SIDE + 1) + (int32_t)x;
        double expected = (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * p[SIDE + 1] + fx * p[SIDE + 2]);
        /* 1/256 px of a slope of at most 15 grey levels per px, and rounding */
        unit_near("bilinear", (double)x, (double)y, grey, expected, 15.0 * ASJ_GRAY_ONE / 256 + 1);
    }
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

static void the_border_continues_and_outside_is_counted(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid pyramid;
    make(context, SIDE, SIDE, 0, &pyramid);
    const float x[] = {-1e6f, 1e6f, 5, 5, 0, SIDE - 1, -0.01f}, y[] = {5, 5, -1e6f, 1e6f, 0, SIDE - 1, 0};
    const int32_t column[] = {0, SIDE - 1, 5, 5, 0, SIDE - 1, 0}, row[] = {5, 5, 0, SIDE - 1, 0, SIDE - 1, 0};
    uint16_t grey[UNIT_COUNT(x)];
    assert_int_equal(asj_pyramid_sample(&pyramid, 0, x, y, (int32_t)UNIT_COUNT(x), grey), 2);
    for (size_t n = 0; n < UNIT_COUNT(x); n++)
        assert_int_equal(grey[n], pyramid.plane[0][row[n] * (SIDE + 1) + column[n]]);
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

static void levels_show_the_same_place(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid pyramid;
    make(context, 150, 131, 0, &pyramid);
    assert_int_equal(pyramid.levels, 5); /* 131 / 16 = 8 */
    for (int32_t l = 0; l < 3; l++)
        for (int32_t n = 0; n < 100; n++) {
            float x = 20 + (float)fmod(7.13 * n, 100), y = 20 + (float)fmod(3.77 * n, 90);
            uint16_t grey;
            asj_pyramid_sample(&pyramid, l, &x, &y, 1, &grey);
            /* means over 4 px of a wave of period 50 px lose less than 3 of its 100 grey levels */
            unit_near("level", l, n, (double)grey / ASJ_GRAY_ONE, shade((double)x, (double)y), 3);
        }
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

static void the_level_follows_the_area(void **state)
{
    (void)state;
    asj_pyramid pyramid;
    memset(&pyramid, 0, sizeof pyramid);
    pyramid.levels = 5;
    for (int32_t n = -30; n < 130; n++) {
        double log_step = 0.05 * n + 0.0123, step = exp2(log_step); /* sqrt(area) */
        int32_t expected = (int32_t)floor(log_step + 0.3);
        expected = expected < 0 ? 0 : expected > 4 ? 4 : expected;
        assert_int_equal(asj_pyramid_level(&pyramid, step * step), expected);
    }
}

static void tiny_and_flat_images(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    const uint8_t pixel = 77;
    const asj_image image = unit_gray8(&pixel, 1, 1);
    asj_pyramid pyramid;
    assert_int_equal(asj_pyramid_create(context, &image, 0.8, &pyramid), ASJ_OK);
    const asj_affine_frame frame = {0, 0, 10, 0, 0, 10};
    uint16_t grey[ASJ_PATCH_SAMPLES];
    int16_t unit[ASJ_PATCH_SAMPLES];
    assert_int_equal(asj_patch_sample(&pyramid, &frame, 16, -0.25, 1, grey), 0); /* nearly all outside */
    assert_int_equal(grey[255], 77 * ASJ_GRAY_ONE);
    asj_patch_normalise(grey, 16, unit);
    assert_int_equal(asj_patch_product(unit, unit, 256), 0); /* flat: no direction at all */
    asj_sift_describe(grey, 16, unit);
    assert_int_equal(asj_patch_product(unit, unit, ASJ_SIFT_LENGTH), 0);
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

/* The product of two normalised patches is their correlation, as floating point has it. */
static void the_product_is_the_correlation(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid pyramid;
    make(context, 200, 200, 0, &pyramid);
    for (int32_t n = 0; n < 20; n++) {
        const asj_affine_frame f = {60 + n, 70, 30, n, -n, 25}, g = {100, 90 - n, 20, 10, 5.0 - n, 30};
        uint16_t grey[2][256];
        int16_t unit[2][256];
        assert_int_equal(asj_patch_sample(&pyramid, &f, 16, -0.25, 1, grey[0]), 1);
        assert_int_equal(asj_patch_sample(&pyramid, &g, 16, -0.25, 1, grey[1]), 1);
        double mean[2] = {0, 0}, product = 0, norm[2] = {0, 0};
        for (int32_t i = 0; i < 512; i++)
            mean[i / 256] += grey[i / 256][i % 256] / 256.0;
        for (int32_t i = 0; i < 256; i++) {
            double p = grey[0][i] - mean[0], q = grey[1][i] - mean[1];
            product += p * q;
            norm[0] += p * p;
            norm[1] += q * q;
        }
        for (int k = 0; k < 2; k++) {
            norm[k] = sqrt(norm[k]) + 16.0 * ASJ_GRAY_ONE; /* the floor of one grey level */
            asj_patch_normalise(grey[k], 16, unit[k]);
        }
        double one = (double)ASJ_UNIT_ONE * ASJ_UNIT_ONE;
        /* 256 entries of size 1/16 rounded to 1/16384: sqrt(256) / 16 / 16384 / sqrt(6) at one sigma */
        unit_near("correlation", n, 0, asj_patch_product(unit[0], unit[1], 256) / one, product / (norm[0] * norm[1]), 3e-4);
    }
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

/* An affinely warped picture looks the same in the warped frame; another location does not. */
static void patches_do_not_depend_on_the_viewpoint(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    static uint8_t pixels[200 * 200];
    const double m[4] = {0.8, -0.3, 0.25, 0.9}; /* x = m (x' - 100) + 100 */
    for (int32_t y = 0; y < 200; y++)
        for (int32_t x = 0; x < 200; x++) /* gain 0.6, offset 40 as well */
            pixels[y * 200 + x] = (uint8_t)floor(40.5 + 0.6 * shade(100 + m[0] * (x - 100) + m[1] * (y - 100),
                                                                    100 + m[2] * (x - 100) + m[3] * (y - 100)));
    const asj_image image = unit_gray8(pixels, 200, 200);
    asj_pyramid here, there;
    make(context, 200, 200, 0.8, &here);
    assert_int_equal(asj_pyramid_create(context, &image, 0.8, &there), ASJ_OK);
    const double d = m[0] * m[3] - m[1] * m[2];
    const asj_affine_frame f = {100, 100, 40, 0, 0, 40}, other = {80, 115, 40, 0, 0, 40};
    const asj_affine_frame g = {100, 100, 40 * m[3] / d, -40 * m[2] / d, -40 * m[1] / d, 40 * m[0] / d};
    uint16_t grey[3][256];
    int16_t unit[3][256], sift[3][ASJ_SIFT_LENGTH];
    assert_int_equal(asj_patch_sample(&here, &f, 16, -0.25, 1, grey[0]), 1);
    assert_int_equal(asj_patch_sample(&there, &g, 16, -0.25, 1, grey[1]), 1);
    assert_int_equal(asj_patch_sample(&there, &other, 16, -0.25, 1, grey[2]), 1);
    for (int k = 0; k < 3; k++) {
        asj_patch_normalise(grey[k], 16, unit[k]);
        asj_sift_describe(grey[k], 16, sift[k]);
    }
    const double one = (double)ASJ_UNIT_ONE * ASJ_UNIT_ONE;
    const double raw = asj_patch_product(unit[0], unit[1], 256) / one, raw_other = asj_patch_product(unit[0], unit[2], 256) / one;
    const double rooted = asj_patch_product(sift[0], sift[1], ASJ_SIFT_LENGTH) / one;
    const double rooted_other = asj_patch_product(sift[0], sift[2], ASJ_SIFT_LENGTH) / one;
    assert_true(raw > 0.9 && raw > raw_other + 0.2); /* 0.93 at most: the floor of one grey level on a contrast of 30 */
    assert_true(rooted > 0.97 && rooted > rooted_other);
    asj_pyramid_free(&context->memory, &here);
    asj_pyramid_free(&context->memory, &there);
    unit_context_free(&counter, &context);
}

/* A ramp in direction phi votes for the two directions around phi, in proportion. */
static void sift_votes_for_the_direction(void **state)
{
    (void)state;
    for (int32_t degrees = 0; degrees < 360; degrees += 15) {
        const double phi = degrees * UNIT_PI / 180;
        uint16_t grey[256];
        int16_t unit[ASJ_SIFT_LENGTH];
        for (int32_t i = 0; i < 256; i++)
            grey[i] = (uint16_t)(16000 + floor(400 * ((i % 16) * cos(phi) + (i / 16) * sin(phi)) + 0.5));
        asj_sift_describe(grey, 16, unit);
        const int32_t low = degrees / 45, high = (low + 1) % 8;
        const double t = phi - low * UNIT_PI / 4;                      /* oblique coordinates of a unit vector at angle t */
        const double alpha = sin(UNIT_PI / 4 - t), beta = sin(t);
        const int16_t *inner = unit + (1 * 4 + 1) * 8;                 /* a cell away from the border */
        double sum = 0;
        for (int32_t k = 0; k < 8; k++)
            sum += (double)inner[k] * inner[k];
        for (int32_t k = 0; k < 8; k++) {
            double expected = k == low ? alpha / (alpha + beta) : k == high ? beta / (alpha + beta) : 0;
            unit_near("share", degrees, k, inner[k] * (double)inner[k] / sum, expected, 0.01);
        }
        const double one = (double)ASJ_UNIT_ONE * ASJ_UNIT_ONE;
        unit_near("norm", degrees, 0, asj_patch_product(unit, unit, ASJ_SIFT_LENGTH) / one, 1, 1e-3);
    }
}

static void out_of_memory(void **state)
{
    (void)state;
    uint8_t pixels[SIDE * SIDE];
    fill(pixels, SIDE, SIDE);
    const asj_image image = unit_gray8(pixels, SIDE, SIDE);
    int reached = 1;
    for (long n = 1; n < 200 && reached; n++) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, 1);
        asj_pyramid pyramid;
        counter.fail_at = counter.calls + n;
        asj_status status = asj_pyramid_create(context, &image, 0.8, &pyramid);
        asj_pyramid_free(&context->memory, &pyramid);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK || (reached && status == ASJ_ERROR_MEMORY));
        unit_context_free(&counter, &context);
    }
    assert_false(reached);
}

static uint32_t shuffled(uint32_t *state)
{
    return *state = *state * 1664525u + 1013904223u;
}

/* Every form that this processor has gives the bits of the reference, inside the image, across its border and far outside. */
static void variants_give_the_same_bits(void **state)
{
    (void)state;
    enum { COUNT = 100, LENGTH = 144 };
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid pyramid;
    static int16_t patches[COUNT][LENGTH];
    uint32_t seed = 1;
    uint8_t pixels[61 * 47];
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(i % 5 ? shuffled(&seed) >> 24 : 255);
    const asj_image image = unit_gray8(pixels, 61, 47);
    assert_int_equal(asj_pyramid_create(context, &image, 0, &pyramid), ASJ_OK);
    for (int32_t n = 0; n < COUNT * LENGTH; n++) /* as large as unit vectors of this length can be */
        patches[n / LENGTH][n % LENGTH] = (int16_t)((int32_t)(shuffled(&seed) >> 16) % 2731 - 1365);
    for (int32_t simd = ASJ_SIMD_REFERENCE; simd < ASJ_SIMD_COUNT; simd++) {
        asj_tables tables;
        if (!asj_tables_fill(simd, &tables))
            continue;
        for (int32_t radius = 0; radius <= ASJ_BLUR_RADIUS; radius++) {
            const int32_t taps[] = {16384 - 2 * (3000 + 40 * radius) * (radius > 0), 3000, 40, 40, 40, 40, 40};
            const uint16_t *rows[ASJ_BLUR_ROWS];
            uint16_t expected[61], blurred[61];
            for (int32_t r = 0; r < ASJ_BLUR_ROWS; r++)
                rows[r] = pyramid.plane[0] + r * 62;
            asj_blur_row(rows, taps, radius, 61, expected);
            tables.pyramid.blur_row(rows, taps, radius, 61, blurred);
            assert_memory_equal(blurred, expected, sizeof expected);
        }
        for (int32_t count = 0; count < COUNT; count++) {
            int32_t which[COUNT], expected[COUNT], products[COUNT];
            float x[COUNT], y[COUNT];
            uint16_t expected_grey[COUNT], grey[COUNT];
            const int32_t level = count % pyramid.levels;
            for (int32_t k = 0; k < count; k++)
                which[k] = k * 7 % count;
            asj_patch_products(patches[count], patches[0], LENGTH, which, count, expected);
            tables.patch.products(patches[count], patches[0], LENGTH, which, count, products);
            assert_memory_equal(products, expected, (size_t)count * sizeof *products);
            for (int32_t i = 0; i < count; i++) {
                x[i] = (float)shuffled(&seed) * (80.0f / 4294967296.0f) - 10;
                y[i] = i % 31 == 0 ? 1e9f : (float)shuffled(&seed) * (66.0f / 4294967296.0f) - 10;
            }
            assert_int_equal(tables.pyramid.sample(&pyramid, level, x, y, count, grey),
                             asj_pyramid_sample_reference(&pyramid, level, x, y, count, expected_grey));
            assert_memory_equal(grey, expected_grey, (size_t)count * sizeof *grey);
        }
    }
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

/* Grids of all sizes, inside, across the border, folded and far away; levels from black to white. */
static void patch_variants_give_the_same_bits(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid pyramid;
    uint32_t seed = 7;
    static uint8_t pixels[161 * 147];
    for (size_t i = 0; i < sizeof pixels; i++)
        pixels[i] = (uint8_t)(i % 7 ? shuffled(&seed) >> 24 : i % 3 ? 255 : 0);
    const asj_image image = unit_gray8(pixels, 161, 147);
    assert_int_equal(asj_pyramid_create(context, &image, 0, &pyramid), ASJ_OK);
    for (int32_t simd = ASJ_SIMD_REFERENCE; simd < ASJ_SIMD_COUNT; simd++) {
        asj_tables tables;
        if (!asj_tables_fill(simd, &tables))
            continue;
        for (int32_t n = 0; n < 400; n++) {
            const int32_t size = 8 + 4 * (n % 5), scale = n % 20 == 19 ? 1 << 30 : 1 << (15 + n % 7);
            int32_t number[6];
            for (int32_t k = 0; k < 6; k++)
                number[k] = (int32_t)((shuffled(&seed) >> 8) * (1.0 / 16777216) * scale) - (k < 2 ? 0 : scale / 2);
            for (int32_t k = 2; k < 6; k++)
                number[k] /= size;
            const asj_patch_grid grid = {n % pyramid.levels, number[0], number[1], number[2], number[3], number[4], number[5]};
            uint16_t expected[ASJ_PATCH_SAMPLES], grey[ASJ_PATCH_SAMPLES];
            int16_t expected_unit[ASJ_PATCH_SAMPLES], unit[ASJ_PATCH_SAMPLES];
            const size_t bytes = (size_t)(size * size) * sizeof *grey;
            assert_int_equal(tables.patch.levels(&pyramid, &grid, size, grey), asj_patch_levels(&pyramid, &grid, size, expected));
            assert_memory_equal(grey, expected, bytes);
            for (int32_t i = 0; i < size * size && n % 3 > 0; i++) /* more contrast than interpolation leaves */
                grey[i] = n % 3 == 1 ? (uint16_t)(shuffled(&seed) % (ASJ_GRAY_MAX + 1)) : i % 2 ? ASJ_GRAY_MAX : 0;
            asj_patch_normalise(grey, size, expected_unit);
            tables.patch.normalise(grey, size, unit);
            assert_memory_equal(unit, expected_unit, bytes);
        }
    }
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

/* Whole-number positions show what the frame says; beyond the limits there is nothing. */
static void grids_follow_their_frames(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid pyramid;
    make(context, 400, 300, 0, &pyramid);
    for (int32_t n = 0; n < 50; n++) {
        const int32_t size = 8 + 4 * (n % 5);
        const asj_affine_frame f = {150 + n, 140 - n, 20.0 + 2 * n, n - 20.3, 13.7 - n, 100.0 - n};
        const double step = 1.25 / (size - 1);
        uint16_t grey[ASJ_PATCH_SAMPLES];
        asj_patch_grid grid;
        asj_patch_grid_set(&pyramid, &f, size, -0.25, 1, &grid);
        assert_int_equal(grid.level, asj_pyramid_level(&pyramid, asj_affine_area(&f) * step * step));
        assert_int_equal(asj_patch_levels(&pyramid, &grid, size, grey), size * size);
        for (int32_t k = 0; k < size * size; k++) {
            const double u = -0.25 + step * (k % size), v = -0.25 + step * (k / size);
            const float x = (float)(f.x + u * f.ax + v * f.bx), y = (float)(f.y + u * f.ay + v * f.by);
            uint16_t expected;
            asj_pyramid_sample_reference(&pyramid, grid.level, &x, &y, 1, &expected);
            /* along either axis 1/256 px of the level and 48 roundings of 2^-14 px, of a slope of at most 10.3 grey levels per px
             * and the rounding of pixels */
            const double off = sqrt(2) * (ldexp(1, grid.level - 8) + 48 * ldexp(1, -14));
            unit_near("level", n, k, grey[k], expected, 11.3 * ASJ_GRAY_ONE * off + 1);
        }
    }
    const double far[] = {1e5, 1e6, 1e300, NAN, INFINITY};
    for (size_t n = 0; n < UNIT_COUNT(far); n++)
        for (int32_t k = 0; k < 6; k++) {
            double number[6] = {100, 100, 100, 0, 0, 100};
            number[k] = far[n];
            const asj_affine_frame f = {number[0], number[1], number[2], number[3], number[4], number[5]};
            uint16_t grey[ASJ_PATCH_SAMPLES];
            assert_int_equal(asj_patch_sample(&pyramid, &f, 8, -0.25, 1.5, grey), 0);
            assert_true(n == 0 || grey[63] == 0);
        }
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sampling_is_bilinear),
        cmocka_unit_test(the_border_continues_and_outside_is_counted),
        cmocka_unit_test(levels_show_the_same_place),
        cmocka_unit_test(the_level_follows_the_area),
        cmocka_unit_test(tiny_and_flat_images),
        cmocka_unit_test(the_product_is_the_correlation),
        cmocka_unit_test(patches_do_not_depend_on_the_viewpoint),
        cmocka_unit_test(sift_votes_for_the_direction),
        cmocka_unit_test(variants_give_the_same_bits),
        cmocka_unit_test(patch_variants_give_the_same_bits),
        cmocka_unit_test(grids_follow_their_frames),
        cmocka_unit_test(out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
