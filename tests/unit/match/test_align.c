/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/align.c: known affine maps are found again; gain, offset and flat discs; swapping; limits. */
#include "match/align.h"
#include "unit_test.h"

#define SIDE 240

/* Texture at several scales, smooth, known between pixels; no repetition within the disc. */
static double shade(double x, double y)
{
    return 128 + 40 * sin(0.21 * x + 0.13 * y) + 30 * cos(0.17 * y - 0.11 * x + 1) + 20 * sin(0.05 * x * y / 40);
}

/* Image 2 shows at x' what image 1 shows at centre + m (x' - centre - shift). */
static void make(asj_context *context, const double m[4], double shift_x, double shift_y, double gain, double offset,
                 asj_pyramid *pyramid)
{
    uint8_t *pixels = malloc((size_t)SIDE * SIDE);
    assert_non_null(pixels);
    for (int32_t y = 0; y < SIDE; y++)
        for (int32_t x = 0; x < SIDE; x++) {
            double u = x - 120 - shift_x, v = y - 120 - shift_y;
            double value = offset + gain * shade(120 + m[0] * u + m[1] * v, 120 + m[2] * u + m[3] * v);
            pixels[y * SIDE + x] = (uint8_t)floor(fmin(fmax(value, 0), 255) + 0.5);
        }
    const asj_image image = unit_gray8(pixels, SIDE, SIDE);
    asj_status status = asj_pyramid_create(context, &image, 0.8, pyramid);
    free(pixels);
    assert_int_equal(status, ASJ_OK);
}

static const double identity[4] = {1, 0, 0, 1};

/* Starts with a linear map and a location in the source. */
static asj_alignment align(const asj_disc *disc, const asj_template *t, const asj_pyramid *source, const double linear[4], double x,
                           double y, int32_t iterations, double max_move)
{
    const asj_aligner aligner = {disc, iterations, max_move};
    const asj_disc_pose start = {x, y, {linear[0], linear[1], linear[2], linear[3]}};
    return asj_align(&aligner, t, source, &start);
}

static void finds_a_known_map(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    const double maps[][4] = {{1, 0, 0, 1}, {0.9, 0.08, -0.05, 0.95}, {0.7, -0.1, 0.1, 0.8}};
    asj_disc disc;
    asj_disc_create(20, &disc);
    assert_int_equal(disc.count, 317);
    for (size_t n = 0; n < UNIT_COUNT(maps); n++)
        for (int32_t gain = 0; gain < 2; gain++) {
            asj_pyramid first, second;
            asj_template t;
            asj_alignment found;
            double inverse[4];
            make(context, identity, 0, 0, 1, 0, &first);
            make(context, maps[n], 1.4, -0.9, gain ? 0.5 : 1, gain ? 60 : 0, &second);
            asj_template_create(&disc, &first, 120, 120, &t);
            assert_true(t.usable && t.solvable);
            assert_int_equal(asj_affine_invert(maps[n], inverse), 1);
            /* start: 8 % wrong in one length, 3 degrees in the direction of the other, location 1.7 px off */
            const double start[4] = {inverse[0] * 1.08, inverse[1] + 0.05 * inverse[0],
                                     inverse[2] * 1.08, inverse[3] + 0.05 * inverse[2]};
            found = align(&disc, &t, &second, start, 120, 120, 10, 5);
            assert_true(found.moved);
            assert_true((double)found.similarity > (double)found.first);
            /* the floors of one grey level cost 3 % each at a contrast of 35, 6 % at half of it */
            assert_true((double)found.similarity > 0.9);
            unit_near("x", (double)n, gain, found.pose.x, 121.4, 0.1);
            unit_near("y", (double)n, gain, found.pose.y, 119.1, 0.1);
            for (int k = 0; k < 4; k++)
                unit_near("map", (double)n, k, found.pose.linear[k], inverse[k], 0.02);
            asj_pyramid_free(&context->memory, &first);
            asj_pyramid_free(&context->memory, &second);
        }
    unit_context_free(&counter, &context);
}

static void another_place_stays_unlike(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid pyramid;
    asj_template t;
    asj_alignment found;
    asj_disc disc;
    asj_disc_create(20, &disc);
    make(context, identity, 0, 0, 1, 0, &pyramid);
    asj_template_create(&disc, &pyramid, 120, 120, &t);
    found = align(&disc, &t, &pyramid, identity, 70, 170, 6, 5);
    assert_true((double)found.similarity < 0.8);
    found = align(&disc, &t, &pyramid, identity, 120, 120, 6, 5);
    assert_true((double)found.similarity > 0.9);
    unit_near("x", 0, 0, found.pose.x, 120, 0.05);
    asj_pyramid_free(&context->memory, &pyramid);
    unit_context_free(&counter, &context);
}

static void limits_put_the_start_back(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid first, second;
    asj_template t;
    asj_alignment found;
    asj_disc disc;
    asj_disc_create(20, &disc);
    make(context, identity, 0, 0, 1, 0, &first);
    make(context, identity, 3, 0, 1, 0, &second);
    asj_template_create(&disc, &first, 120, 120, &t);
    found = align(&disc, &t, &second, identity, 120, 120, 10, 5);
    unit_near("moved", 0, 0, found.pose.x, 123, 0.1);
    found = align(&disc, &t, &second, identity, 120, 120, 10, 1); /* 3 px are more than 1 */
    assert_false(found.moved);
    unit_near("stayed", 0, 0, found.pose.x, 120, 0);
    assert_memory_equal(found.pose.linear, identity, sizeof identity);
    unit_near("first", 0, 0, (double)found.similarity, (double)found.first, 0);
    found = align(&disc, &t, &second, identity, 120, 120, 0, 5); /* no steps at all */
    assert_false(found.moved);
    asj_pyramid_free(&context->memory, &first);
    asj_pyramid_free(&context->memory, &second);
    unit_context_free(&counter, &context);
}

static void flat_discs_are_like_nothing(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_pyramid flat, textured;
    asj_template t;
    asj_alignment found;
    asj_disc disc;
    asj_disc_create(20, &disc);
    make(context, identity, 0, 0, 0, 90, &flat);
    make(context, identity, 0, 0, 1, 0, &textured);
    asj_template_create(&disc, &flat, 120, 120, &t);
    found = align(&disc, &t, &textured, identity, 120, 120, 6, 5);
    unit_near("flat template", 0, 0, (double)found.similarity, 0, 1e-3);
    asj_template_create(&disc, &textured, 120, 120, &t);
    found = align(&disc, &t, &flat, identity, 120, 120, 6, 5);
    unit_near("flat source", 0, 0, (double)found.similarity, 0, 1e-3);
    asj_template_create(&disc, &textured, -15, -15, &t);
    assert_false(t.usable);
    asj_pyramid_free(&context->memory, &flat);
    asj_pyramid_free(&context->memory, &textured);
    unit_context_free(&counter, &context);
}

/* Twice as many where either image is upsampled, but not for the candidates of a geometry. */
static void upsampled_images_take_more_steps(void **state)
{
    (void)state;
    asj_match_options options;
    asj_match_options_init(&options);
    options.align_iterations = 5;
    for (int32_t n = 0; n < 8; n++) {
        asj_image_features images[2];
        memset(images, 0, sizeof images);
        images[0].l_junctions.upsampled = n & 1;
        images[1].l_junctions.upsampled = n >> 1 & 1;
        const asj_match_run run = {.options = &options, .image = {&images[0], &images[1]}, .for_geometry = n >> 2};
        assert_int_equal(asj_align_steps(&run), n >= 1 && n <= 3 ? 10 : 5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(finds_a_known_map),
        cmocka_unit_test(another_place_stays_unlike),
        cmocka_unit_test(limits_put_the_start_back),
        cmocka_unit_test(flat_discs_are_like_nothing),
        cmocka_unit_test(upsampled_images_take_more_steps),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
