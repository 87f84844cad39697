/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 1 against its formula in double precision. */
#include "core/watch.h"
#include "detect/gradient.h"
#include "unit_test.h"

static const double sigma_0 = 0.7825, limit = 3.5;

/* ---- the formula ---- */

static double gray(const asj_frame *frame, int32_t x, int32_t y)
{
    x = x < 0 ? 0 : x >= frame->width ? frame->width - 1 : x;
    y = y < 0 ? 0 : y >= frame->height ? frame->height - 1 : y;
    return (double)frame->gray[y * frame->stride + x] / ASJ_GRAY_ONE;
}

typedef struct vector {
    double x, y;
} vector;

static vector difference(const asj_frame *frame, int32_t x, int32_t y)
{
    return (vector){0.5 * (gray(frame, x + 1, y) - gray(frame, x - 1, y)), 0.5 * (gray(frame, x, y + 1) - gray(frame, x, y - 1))};
}

static double local_mean(const asj_frame *frame, int32_t x, int32_t y)
{
    double sum = 0, count = 0;
    for (int32_t v = y - 2; v <= y + 2; v++)
        for (int32_t u = x - 2; u <= x + 2; u++)
            if (u >= 0 && v >= 0 && u < frame->width && v < frame->height) {
                const vector g = difference(frame, u, v);
                sum += hypot(g.x, g.y);
                count++;
            }
    return sum / count;
}

/* The denominator D of g~ = g / D, and the largest relative error that the whole numbers of gradient.c can make in it: the norms
 * are rounded down to 1/256, epsilon to the nearest, 256 / (sigma_0 L) to the nearest whole number (93.47 to 93), the scale
 * down. */
static double denominator(const asj_frame *frame, int32_t x, int32_t y, double epsilon, double *error)
{
    const vector g = difference(frame, x, y);
    const double mean = local_mean(frame, x, y) + epsilon, least = hypot(g.x, g.y) / (sigma_0 * limit), d = fmax(mean, least);
    const double scale = 1024 * 256 / (sigma_0 * d);
    *error = 2.0 / 256 / d + (least > 0.98 * mean ? 0.0055 : 0) + 2 / scale;
    return d * sigma_0;
}

static void check_frame(const asj_frame *frame, double epsilon)
{
    for (int32_t y = 0; y < frame->height; y++)
        for (int32_t x = 0; x < frame->width; x++) {
            double error;
            const vector g = difference(frame, x, y);
            const double d = denominator(frame, x, y, epsilon, &error), rounding = 0.51 / ASJ_GRADIENT_ONE;
            unit_near("g~x", x, y, unit_gx(frame, x, y), g.x / d, fabs(g.x / d) * error + rounding);
            unit_near("g~y", x, y, unit_gy(frame, x, y), g.y / d, fabs(g.y / d) * error + rounding);
            assert_true(hypot(unit_gx(frame, x, y), unit_gy(frame, x, y)) < 1.01 * limit);
        }
}

/* ---- tests ---- */

typedef unit_fixture fixture;

static void noise_frame(fixture *f, int32_t width, int32_t height, double sd, uint64_t seed, asj_frame *frame)
{
    uint8_t *pixels = synth_noise_image(width, height, 128, sd, seed);
    assert_non_null(pixels);
    const asj_image image = unit_gray8(pixels, width, height);
    unit_frame(f->context, &image, &f->options, frame);
    free(pixels);
}

/* Every window is clipped differently in small images; the border itself is the larger part of them. */
static void test_sizes(void **state)
{
    static const int32_t sizes[][2] = {{1, 1}, {1, 2}, {2, 1}, {1, 9}, {9, 1}, {2, 2}, {3, 3}, {4, 5}, {5, 4}, {17, 3}, {3, 40},
                                       {33, 21}};
    fixture *f = *state;
    for (size_t i = 0; i < UNIT_COUNT(sizes); i++) {
        asj_frame frame;
        noise_frame(f, sizes[i][0], sizes[i][1], 40, 11 + i, &frame);
        check_frame(&frame, f->options.gradient_epsilon);
        asj_frame_free(&f->context->memory, &frame);
    }
}

static void test_epsilons_and_contrasts(void **state)
{
    static const double epsilons[] = {0.05, 0.4, 3.3, 16}, deviations[] = {0.3, 2, 30, 120};
    fixture *f = *state;
    for (size_t i = 0; i < UNIT_COUNT(epsilons); i++)
        for (size_t k = 0; k < UNIT_COUNT(deviations); k++) {
            asj_frame frame;
            f->options.gradient_epsilon = epsilons[i];
            noise_frame(f, 40, 30, deviations[k], 100 * i + k, &frame);
            check_frame(&frame, epsilons[i]);
            asj_frame_free(&f->context->memory, &frame);
        }
    asj_detect_options_init(&f->options);
}

/* Lone bright pixels on black: the only pictures in which the cut at L = 3.5 works. */
static void test_cut(void **state)
{
    fixture *f = *state;
    uint8_t pixels[24 * 24] = {0};
    asj_frame frame;
    pixels[24 * 12 + 12] = 255;
    pixels[24 * 3 + 20] = 3;
    pixels[0] = 90;
    const asj_image image = unit_gray8(pixels, 24, 24);
    unit_frame(f->context, &image, &f->options, &frame);
    check_frame(&frame, f->options.gradient_epsilon);
    unit_near("cut at L", 11, 12, hypot(unit_gx(&frame, 11, 12), unit_gy(&frame, 11, 12)), limit, 0.0055 * limit);
    assert_true(unit_gx(&frame, 11, 12) > 0); /* dark to bright */
    assert_true(unit_gx(&frame, 13, 12) < 0);
    assert_true(unit_gy(&frame, 12, 11) > 0);
    assert_true(unit_gy(&frame, 12, 13) < 0);
    assert_true(unit_gx(&frame, 12, 12) == 0 && unit_gy(&frame, 12, 12) == 0);
    asj_frame_free(&f->context->memory, &frame);
}

/* Constant pictures have no gradient, and the margin around the planes is zero, up to its last sample. */
static void test_flat_and_margin(void **state)
{
    fixture *f = *state;
    asj_frame frame;
    noise_frame(f, 37, 19, 50, 5, &frame);
    for (int32_t y = -ASJ_MARGIN; y < frame.height + ASJ_MARGIN; y++)
        for (int32_t x = -ASJ_MARGIN; x < frame.stride - ASJ_MARGIN; x++)
            if (x < 0 || y < 0 || x >= frame.width || y >= frame.height) {
                assert_int_equal(frame.gradient_x[y * frame.stride + x], 0);
                assert_int_equal(frame.gradient_y[y * frame.stride + x], 0);
            }
    asj_frame_free(&f->context->memory, &frame);
    noise_frame(f, 20, 20, 0, 5, &frame);
    for (int32_t i = 0; i < 400; i++)
        assert_true(unit_gx(&frame, i % 20, i / 20) == 0 && unit_gy(&frame, i % 20, i / 20) == 0);
    asj_frame_free(&f->context->memory, &frame);
}

/* What the whole numbers lose against doubles, on a picture with edges and noise at the default epsilon: the figure to quote. */
static void test_loss(void **state)
{
    fixture *f = *state;
    synth_scene scene;
    asj_frame frame;
    double squares = 0, largest = 0;
    synth_parallelograms(&scene, 60, 3);
    unit_frame_of(f->context, &scene, 1, 2, &f->options, &frame);
    for (int32_t y = 0; y < frame.height; y++)
        for (int32_t x = 0; x < frame.width; x++) {
            double error;
            const vector g = difference(&frame, x, y);
            const double d = denominator(&frame, x, y, f->options.gradient_epsilon, &error);
            const double loss = hypot(unit_gx(&frame, x, y) - g.x / d, unit_gy(&frame, x, y) - g.y / d);
            squares += loss * loss;
            largest = fmax(largest, loss);
        }
    const double root_mean = sqrt(squares / (frame.width * frame.height));
    print_message("fixed point against double: root mean square %.2g, largest %.2g normalised units\n", root_mean, largest);
    assert_true(root_mean < 0.003);
    assert_true(largest < 0.02);
    asj_frame_free(&f->context->memory, &frame);
}

/* White noise is what sigma_0 was measured on: components of unit variance (2.4). */
static void test_noise_has_unit_variance(void **state)
{
    fixture *f = *state;
    asj_frame frame;
    double squares = 0;
    noise_frame(f, 256, 256, 30, 1, &frame);
    for (int32_t i = 0; i < 256 * 256; i++)
        squares += pow(unit_gx(&frame, i % 256, i / 256), 2) + pow(unit_gy(&frame, i % 256, i / 256), 2);
    unit_near("variance", 256, 256, squares / (2 * 256 * 256), 1, 0.04);
    asj_frame_free(&f->context->memory, &frame);
}

static void test_standardise(void **state)
{
    fixture *f = *state;
    synth_scene scene;
    asj_frame plain, made;
    synth_parallelograms(&scene, 60, 3);
    unit_frame_of(f->context, &scene, 1, 5, &f->options, &plain);
    f->options.standardise = 1;
    synth_parallelograms(&scene, 60, 3);
    unit_frame_of(f->context, &scene, 1, 5, &f->options, &made);
    asj_detect_options_init(&f->options);
    for (int axis = 0; axis < 2; axis++) {
        double (*component)(const asj_frame *, int32_t, int32_t) = axis ? unit_gy : unit_gx;
        const double count = plain.width * plain.height;
        double sum = 0, squares = 0;
        for (int32_t y = 0; y < plain.height; y++)
            for (int32_t x = 0; x < plain.width; x++) {
                sum += component(&plain, x, y);
                squares += pow(component(&plain, x, y), 2);
            }
        const double mean = sum / count, sd = sqrt(squares / count - mean * mean), cut = 0.7 * limit;
        for (int32_t y = 0; y < plain.height; y++)
            for (int32_t x = 0; x < plain.width; x++) {
                const double expected = fmax(-cut, fmin(cut, (component(&plain, x, y) - mean) / sd));
                unit_near("standardised", x, y, component(&made, x, y), expected, (0.55 / sd + 1) / ASJ_GRADIENT_ONE);
            }
    }
    asj_frame_free(&f->context->memory, &plain);
    asj_frame_free(&f->context->memory, &made);
}

static void test_standardise_flat(void **state)
{
    fixture *f = *state;
    asj_frame frame;
    f->options.standardise = 1;
    noise_frame(f, 9, 9, 0, 1, &frame);
    for (int32_t i = 0; i < 81; i++)
        assert_true(unit_gx(&frame, i % 9, i / 9) == 0 && unit_gy(&frame, i % 9, i / 9) == 0);
    asj_frame_free(&f->context->memory, &frame);
    asj_detect_options_init(&f->options);
}

static int32_t stop_at_second(void *user, int32_t stage, double done)
{
    (void)done;
    assert_int_equal(stage, ASJ_STAGE_GRADIENT);
    return ++*(int *)user == 2;
}

/* A caller who stops it once the gradient is there, in one band, waits for no pass over the image: it is left as it is. */
static void test_standardise_stops(void **state)
{
    fixture *f = *state;
    asj_frame frame;
    int asked = 0;
    noise_frame(f, 64, 64, 60, 8, &frame);
    const int16_t x = frame.gradient_x[20], y = frame.gradient_y[20];
    f->options.standardise = 1;
    f->context->options.progress = stop_at_second;
    f->context->options.progress_user = &asked;
    f->context->pause_ms = 0;
    assert_int_equal(asj_gradient(f->context, &frame, &f->options), ASJ_ERROR_CANCELLED);
    assert_true(frame.gradient_x[20] == x && frame.gradient_y[20] == y);
    f->context->pause_ms = ASJ_PAUSE;
    f->context->options.progress = NULL;
    f->options.standardise = 0;
    asj_frame_free(&f->context->memory, &frame);
}

/* Each axis is looked at twice more, in as many bands; by default a small image is one. */
static void test_standardise_asks(void **state)
{
    fixture *f = *state;
    long asked[2] = {0, 0};
    asj_frame frame;
    noise_frame(f, 64, 64, 60, 8, &frame);
    f->context->options.progress = unit_count_question;
    f->context->pause_ms = 0;
    for (int32_t standardise = 0; standardise < 2; standardise++) {
        f->options.standardise = standardise;
        f->context->options.progress_user = &asked[standardise];
        assert_int_equal(asj_gradient(f->context, &frame, &f->options), ASJ_OK);
    }
    assert_int_equal(asked[1], 5 * asked[0]);
    assert_true(asked[0] > 0);
    f->context->pause_ms = ASJ_PAUSE;
    f->context->options.progress = NULL;
    f->options.standardise = 0;
    asj_frame_free(&f->context->memory, &frame);
}

/* Bands of rows by thread, also more bands than rows; with and without standardisation. */
static void check_threads(fixture *f, int32_t width, int32_t height)
{
    static const int32_t threads[] = {2, 3, 7, 50};
    asj_frame one, many;
    noise_frame(f, width, height, 60, 8, &one);
    for (size_t i = 0; i < UNIT_COUNT(threads); i++) {
        f->context->threads = threads[i];
        noise_frame(f, width, height, 60, 8, &many);
        for (int32_t y = 0; y < height; y++) {
            const size_t bytes = (size_t)width * sizeof(int16_t);
            assert_memory_equal(one.gray + y * one.stride - 1, many.gray + y * many.stride - 1, bytes + 2 * sizeof(int16_t));
            assert_memory_equal(one.gradient_x + y * one.stride, many.gradient_x + y * many.stride, bytes);
            assert_memory_equal(one.gradient_y + y * one.stride, many.gradient_y + y * many.stride, bytes);
        }
        asj_frame_free(&f->context->memory, &many);
    }
    f->context->threads = 1;
    asj_frame_free(&f->context->memory, &one);
}

static void test_threads(void **state)
{
    fixture *f = *state;
    for (f->options.standardise = 0; f->options.standardise <= 1; f->options.standardise++) {
        check_threads(f, 61, 23);
        check_threads(f, 700, 301);
        check_threads(f, 60001, 3);
    }
    asj_detect_options_init(&f->options);
}

static void test_out_of_memory(void **state)
{
    fixture *f = *state;
    uint8_t pixels[64] = {0};
    const asj_image image = unit_gray8(pixels, 8, 8);
    asj_frame frame = {0};
    const long live = f->counter.live;
    assert_int_equal(asj_frame_prepare(f->context, &frame, 8, 8), ASJ_OK);
    assert_int_equal(asj_frame_load(f->context, &frame, &image, ASJ_PLANE_LUMA), ASJ_OK);
    f->counter.fail_at = f->counter.calls + 1;
    assert_int_equal(asj_gradient(f->context, &frame, &f->options), ASJ_ERROR_MEMORY);
    f->counter.fail_at = 0;
    assert_int_equal(asj_gradient(f->context, &frame, &f->options), ASJ_OK);
    const long calls = f->counter.calls;
    assert_int_equal(asj_gradient(f->context, &frame, &f->options), ASJ_OK);
    assert_int_equal(f->counter.calls, calls); /* the second time in the same memory */
    asj_frame_free(&f->context->memory, &frame);
    assert_int_equal(f->counter.live, live);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sizes),       cmocka_unit_test(test_epsilons_and_contrasts),
        cmocka_unit_test(test_cut),         cmocka_unit_test(test_flat_and_margin),
        cmocka_unit_test(test_loss),        cmocka_unit_test(test_noise_has_unit_variance),
        cmocka_unit_test(test_standardise), cmocka_unit_test(test_standardise_flat),
        cmocka_unit_test(test_standardise_stops),
        cmocka_unit_test(test_standardise_asks),
        cmocka_unit_test(test_threads),     cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
