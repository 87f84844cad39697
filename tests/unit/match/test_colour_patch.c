/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/small_picture.c: the image at half its size. src/match/colour_patch.c: patches of it against a naive evaluation, and
 * what white balance leaves of them. src/match/wide_shortlist.c: of partners that look the same in grey levels the one of the same
 * colour is the nearest. */
#include "match/colour_patch.h"
#include "match/compare.h"
#include "match/image_features.h"
#include "match/patch.h"
#include "match/wide_shortlist.h"
#include "shared/pixels.h"
#include "unit_test.h"

#include <asj/asj.h>

#define SIDE 96
#define STEP (ASJ_COLOUR_PATCH_SIDE * ASJ_COLOUR_PATCH_SIDE) /* from channel to channel */

/* --- the image at half its size ----------------------------------------------------------------------------------------------- */

static void small_pictures_are_means(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const int32_t formats[] = {ASJ_FORMAT_RGB8, ASJ_FORMAT_BGR8, ASJ_FORMAT_RGBA8, ASJ_FORMAT_BGRA8};
    uint8_t pixels[5 * 5 * 4 + 3];
    for (size_t f = 0; f < UNIT_COUNT(formats); f++) {
        const int32_t step = asj_pixel_size(formats[f]), red = asj_red_of(formats[f]), stride = 5 * step + 3;
        asj_small_picture made;
        for (int32_t k = 0; k < (int32_t)sizeof pixels; k++)
            pixels[k] = (uint8_t)(37 * k + k * k);
        const asj_image image = {pixels, formats[f], 5, f < 2 ? 4 : 3, 0, stride}; /* the last column, and row, fall away */
        if (stride * image.height > (int32_t)sizeof pixels)
            continue;
        assert_int_equal(asj_small_picture_create(context, &image, &made), ASJ_OK);
        assert_non_null(made.level);
        assert_int_equal(made.width, 2);
        assert_int_equal(made.height, image.height / 2);
        assert_int_equal(asj_small_picture_bytes(&made), 3 * made.width * made.height);
        for (int32_t c = 0; c < 3; c++)
            for (int32_t y = 0; y < made.height; y++)
                for (int32_t x = 0; x < 2; x++) {
                    const int32_t at = c == 0 ? red : c == 1 ? 1 : 2 - red;
                    int32_t sum = 2;
                    for (int32_t k = 0; k < 4; k++)
                        sum += pixels[(2 * y + k / 2) * stride + (2 * x + k % 2) * step + at];
                    assert_int_equal(made.level[(c * made.height + y) * 2 + x], sum / 4);
                }
        asj_release_much(&context->memory, made.level);
    }
}

/* Levels of a pyramid, one by one or means of 2 x 2 or 3 x 3, of each channel; what is left falls away. */
static void pyramids_have_means_of_them(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    uint8_t levels[3 * 11 * 7];
    for (int32_t k = 0; k < (int32_t)sizeof levels; k++)
        levels[k] = (uint8_t)(41 * k + k * k / 3);
    const asj_small_picture picture = {levels, 11, 7};
    for (int32_t by = 1; by <= 3; by++)
        for (int32_t c = 0; c < 3; c++) {
            asj_pyramid pyramid;
            const int32_t width = 11 / by, height = 7 / by;
            assert_int_equal(asj_pyramid_allocate(context, width, height, &pyramid), ASJ_OK);
            asj_small_picture_fill(context, &picture, c, by, &pyramid);
            for (int32_t k = 0; k < width * height; k++) {
                int32_t sum = 0;
                for (int32_t n = 0; n < by * by; n++)
                    sum += levels[(c * 7 + k / width * by + n / by) * 11 + k % width * by + n % by];
                const double mean = (double)sum * ASJ_GRAY_ONE / (by * by);
                assert_true(fabs(pyramid.plane[0][k / width * (width + 1) + k % width] - mean) <= 0.5);
            }
            assert_int_equal(pyramid.plane[0][width], pyramid.plane[0][width - 1]); /* completed */
            asj_pyramid_free(&context->memory, &pyramid);
        }
}

static void some_have_none(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    uint8_t pixels[3 * 8 * 8];
    asj_small_picture made;
    memset(pixels, 90, sizeof pixels);
    const asj_image grey = {pixels, ASJ_FORMAT_RGB8, 8, 8, 0, 0}, plain = {pixels, ASJ_FORMAT_GRAY8, 8, 8, 0, 0};
    assert_int_equal(asj_small_picture_create(context, &grey, &made), ASJ_OK);
    assert_null(made.level);
    assert_int_equal(asj_small_picture_create(context, &plain, &made), ASJ_OK);
    assert_null(made.level);
    pixels[0] = 200;
    const asj_image narrow = {pixels, ASJ_FORMAT_RGB8, 1, 8, 0, 0}, low = {pixels, ASJ_FORMAT_RGB8, 8, 1, 0, 0};
    assert_int_equal(asj_small_picture_create(context, &narrow, &made), ASJ_OK);
    assert_null(made.level);
    assert_int_equal(asj_small_picture_create(context, &low, &made), ASJ_OK);
    assert_null(made.level);
    assert_int_equal(asj_small_picture_create(context, &grey, &made), ASJ_OK);
    assert_non_null(made.level); /* one pixel is enough */
    asj_release_much(&context->memory, made.level);
}

/* --- patches ------------------------------------------------------------------------------------------------------------------ */

/* Smooth, and different in each channel. */
static double level_at(int32_t channel, double x, double y)
{
    static const double waves[3][2] = {{0.11, 0.05}, {-0.06, 0.12}, {0.08, -0.10}};
    return 120 + 70 * sin(waves[channel][0] * x + waves[channel][1] * y + channel);
}

static void paint(uint8_t *pixels, const double gain[3], const double offset[3])
{
    for (int32_t k = 0; k < 3 * SIDE * SIDE; k++) {
        const double level = level_at(k % 3, k / 3 % SIDE, k / 3 / SIDE);
        pixels[k] = (uint8_t)lrint(gain[k % 3] * level + offset[k % 3]);
    }
}

static void make(asj_context *context, const uint8_t *pixels, double scale, const asj_affine_frame *frames, uint32_t count,
                 asj_colour_patches *patches)
{
    const asj_image image = {pixels, ASJ_FORMAT_RGB8, SIDE, SIDE, 0, 0};
    asj_match_options options;
    asj_small_picture picture;
    asj_match_options_init(&options);
    assert_int_equal(asj_small_picture_create(context, &image, &picture), ASJ_OK);
    assert_int_equal(asj_colour_patches_create(context, &options, &picture, scale, frames, count, patches), ASJ_OK);
    asj_release_much(&context->memory, picture.level);
}

static const double same[3] = {1, 1, 1}, nothing[3] = {0, 0, 0};
static const asj_affine_frame frames[] = {
    {40.3, 35.2, 24, 3, -4, 20}, {50, 50, -18, 6, 2, -22}, {30, 60, 30, -5, 12, 16}, {60, 30, 12, 0, 0, 12}};

/* (g - mean) / ((sd + 1) sqrt(N)) of the channel's levels g where the samples lie. */
static void naive_patch(const asj_affine_frame *frame, int32_t channel, double out[STEP])
{
    const int32_t side = ASJ_COLOUR_PATCH_SIDE;
    double mean = 0, square = 0;
    for (int32_t k = 0; k < STEP; k++) {
        const double u = -0.25 + 1.25 * (k % side) / (side - 1), v = -0.25 + 1.25 * (k / side) / (side - 1);
        out[k] = level_at(channel, frame->x + u * frame->ax + v * frame->bx, frame->y + u * frame->ay + v * frame->by);
        mean += out[k] / STEP;
    }
    for (int32_t k = 0; k < STEP; k++)
        square += (out[k] - mean) * (out[k] - mean);
    for (int32_t k = 0; k < STEP; k++)
        out[k] = (out[k] - mean) / (sqrt(square) + sqrt(STEP));
}

static void patches_are_normalised_levels(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static uint8_t pixels[3 * SIDE * SIDE];
    asj_colour_patches patches = {NULL, NULL};
    paint(pixels, same, nothing);
    make(context, pixels, 2, frames, UNIT_COUNT(frames), &patches);
    for (size_t f = 0; f < UNIT_COUNT(frames); f++)
        for (int32_t c = 0; c < 3; c++) {
            double expected[STEP];
            naive_patch(&frames[f], c, expected);
            const int16_t *made = patches.patch + f * ASJ_COLOUR_PATCH_LENGTH + c * STEP;
            for (int32_t k = 0; k < STEP; k++) /* halved levels are rounded, and are lines between their middles */
                unit_near("sample", (double)f, c * STEP + k, made[k] * sqrt(3) / ASJ_UNIT_ONE, expected[k], 0.012);
        }
    asj_colour_patches_free(&context->memory, &patches);
}

/* Frames of the image upsampled by two show the same. */
static void scale_is_that_of_the_frames(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static uint8_t pixels[3 * SIDE * SIDE];
    asj_affine_frame larger[UNIT_COUNT(frames)];
    asj_colour_patches patches = {NULL, NULL}, of_larger = {NULL, NULL};
    paint(pixels, same, nothing);
    for (size_t f = 0; f < UNIT_COUNT(frames); f++)
        larger[f] = (asj_affine_frame){2 * frames[f].x + 0.5, 2 * frames[f].y + 0.5, 2 * frames[f].ax, 2 * frames[f].ay,
                                       2 * frames[f].bx,      2 * frames[f].by};
    make(context, pixels, 2, frames, UNIT_COUNT(frames), &patches);
    make(context, pixels, 4, larger, UNIT_COUNT(frames), &of_larger);
    assert_memory_equal(patches.patch, of_larger.patch, UNIT_COUNT(frames) * ASJ_COLOUR_PATCH_LENGTH * sizeof *patches.patch);
    asj_colour_patches_free(&context->memory, &patches);
    asj_colour_patches_free(&context->memory, &of_larger);
}

static double length(const int16_t *patch)
{
    return sqrt(asj_patch_product(patch, patch, ASJ_COLOUR_PATCH_LENGTH));
}

static void white_balance_does_not_count(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static uint8_t pixels[2][3 * SIDE * SIDE];
    const double gain[3] = {0.5, 0.9, 1.2}, offset[3] = {60, 10, -20};
    asj_colour_patches patches[2] = {{NULL, NULL}, {NULL, NULL}};
    paint(pixels[0], same, nothing);
    paint(pixels[1], gain, offset);
    for (int32_t n = 0; n < 2; n++)
        make(context, pixels[n], 2, frames, UNIT_COUNT(frames), &patches[n]);
    for (size_t f = 0; f < UNIT_COUNT(frames); f++)
        for (size_t g = 0; g < UNIT_COUNT(frames); g++) {
            const int16_t *left = patches[0].patch + f * ASJ_COLOUR_PATCH_LENGTH;
            const int16_t *right = patches[1].patch + g * ASJ_COLOUR_PATCH_LENGTH;
            /* a floor of one level is added to each standard deviation, and leaves them shorter than 1 */
            const double product = asj_patch_product(left, right, ASJ_COLOUR_PATCH_LENGTH) / (length(left) * length(right));
            assert_true(f == g ? product > 0.995 : product < 0.9);
        }
    asj_colour_patches_free(&context->memory, &patches[0]);
    asj_colour_patches_free(&context->memory, &patches[1]);
}

/* HUE (1 - r), HUE 4: 0 where the channels differ by white balance alone, in full where they have nothing in common. */
static void grey_has_no_hue(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static uint8_t pixels[3 * SIDE * SIDE];
    const double shares[] = {0, 0.3, 1}; /* of the other channels' waves */
    double before = -1;
    for (size_t n = 0; n < UNIT_COUNT(shares); n++) {
        asj_colour_patches patches = {NULL, NULL};
        double sum = 0;
        for (int32_t k = 0; k < 3 * SIDE * SIDE; k++) {
            const double x = k / 3 % SIDE, y = k / 3 / SIDE, other = level_at(k % 3, x, y);
            pixels[k] = (uint8_t)lrint(((1 - shares[n]) * level_at(0, x, y) + shares[n] * other) * (1 - 0.2 * (k % 3)));
        }
        make(context, pixels, 2, frames, UNIT_COUNT(frames), &patches);
        for (size_t f = 0; f < UNIT_COUNT(frames); f++) {
            const int16_t *p = patches.patch + f * ASJ_COLOUR_PATCH_LENGTH;
            double own = 0, between = 0;
            for (int32_t k = 0; k < ASJ_COLOUR_PATCH_LENGTH; k++) {
                own += (double)p[k] * p[k];
                between += (double)p[k] * p[(k + STEP) % ASJ_COLOUR_PATCH_LENGTH];
            }
            const double hue = 4 * (1 - between / own);
            unit_near("hue", (double)n, (double)f, patches.hue[f] / (double)ASJ_HUE_ONE, hue < 1 ? hue : 1, 1.0 / ASJ_HUE_ONE);
            sum += patches.hue[f];
            if (n == 0)
                assert_true(patches.hue[f] < 0.02 * ASJ_HUE_ONE);
        }
        assert_true(sum > before);
        before = sum;
        asj_colour_patches_free(&context->memory, &patches);
    }
    assert_true(before > 0.99 * ASJ_HUE_ONE * UNIT_COUNT(frames));
}

/* --- short lists -------------------------------------------------------------------------------------------------------------- */

#define WIDTH 240
#define HEIGHT 100
#define SQUARE 40
#define SQUARES 4

/* Squares in a row, darker than the wall and of one luma, each brighter in other channels. */
static void paint_squares(uint8_t *pixels, const int32_t order[SQUARES])
{
    static const uint8_t hues[SQUARES][3] = {{220, 40, 90}, {60, 95, 230}, {10, 150, 80}, {180, 30, 250}};
    static const uint8_t wall[3] = {128, 128, 127};
    for (int32_t k = 0; k < WIDTH * HEIGHT; k++) {
        const int32_t x = k % WIDTH, y = k / WIDTH, n = x / (WIDTH / SQUARES), in = x % (WIDTH / SQUARES);
        const int32_t inside = in >= 10 && in < 10 + SQUARE && y >= 30 && y < 30 + SQUARE;
        memcpy(pixels + 3 * k, inside ? hues[order[n]] : wall, 3);
    }
}

/* The upper left corner of every square. */
static void find_corners(asj_junction corners[SQUARES])
{
    memset(corners, 0, SQUARES * sizeof *corners);
    for (int32_t n = 0; n < SQUARES; n++) {
        asj_junction *j = &corners[n];
        j->x = (float)(n * (WIDTH / SQUARES) + 10) - 0.5f;
        j->y = 29.5f;
        j->scale = 6;
        j->branch_count = 2;
        j->branches[1].angle = (float)(UNIT_PI / 2);
        j->branches[0].length = j->branches[1].length = SQUARE;
    }
}

typedef struct scene {
    uint8_t pixels[2][3 * WIDTH * HEIGHT];
    asj_junction corners[SQUARES];
    asj_match_options options;
    asj_image_features features[2];
    asj_match_run run;
} scene;

static const int32_t orders[2][SQUARES] = {{0, 1, 2, 3}, {2, 0, 3, 1}};

static asj_status make_scene(asj_context *context, int32_t shortlist, int32_t colours, scene *s)
{
    asj_status status = ASJ_OK;
    memset(s, 0, sizeof *s);
    find_corners(s->corners);
    asj_match_options_init(&s->options);
    s->options.shortlist = shortlist;
    s->run = (asj_match_run){.context = context, .options = &s->options, .image = {&s->features[0], &s->features[1]}};
    for (int32_t n = 0; n < 2 && status == ASJ_OK; n++) {
        const asj_image image = {s->pixels[n], ASJ_FORMAT_RGB8, WIDTH, HEIGHT, 0, 0};
        paint_squares(s->pixels[n], orders[n]);
        status = asj_image_features_create(context, &s->options, &image, s->corners, SQUARES, n + 1, 0, &s->features[n]);
        if (status == ASJ_OK && colours)
            status = asj_image_features_add_colours(context, &image, &s->features[n]);
    }
    return status == ASJ_OK ? asj_wide_shortlist(&s->run) : status;
}

static void free_scene(asj_context *context, scene *s)
{
    asj_wide_shortlist_free(&s->run);
    asj_release_much(&context->memory, s->run.candidates.list);
    for (int32_t n = 0; n < 2; n++)
        asj_image_features_free(&context->memory, &s->features[n]);
}

static int32_t square_of(const scene *s, int32_t side, uint32_t l)
{
    return (int32_t)s->features[side].l_junctions.l[l].x / (WIDTH / SQUARES);
}

static int32_t is_same_hue(const scene *s, const asj_candidate *c)
{
    return orders[0][square_of(s, 0, c->i)] == orders[1][square_of(s, 1, c->j)];
}

static void hues_tell_partners_apart(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static scene s;
    double largest[2] = {0, 0}, smallest[2] = {9, 9}; /* distances of another hue, and of the same */
    assert_int_equal(make_scene(context, SQUARES, 0, &s), ASJ_OK);
    for (size_t k = 0; k < s.run.candidates.count; k++) {
        const float d = s.run.candidates.list[k].distance2;
        const int32_t is_same = is_same_hue(&s, &s.run.candidates.list[k]);
        largest[is_same] = fmax(largest[is_same], (double)d);
        smallest[is_same] = fmin(smallest[is_same], (double)d);
    }
    for (int32_t n = 0; n < 2; n++) /* grey levels know nothing */
        assert_true(smallest[n] > 0 && largest[n] < smallest[1 - n] + 0.02);
    free_scene(context, &s);
    for (int32_t list = SQUARES / 2; list <= SQUARES; list++) { /* lists by grey levels hold twice as many: all */
        int32_t right = 0, wrong = 0;
        assert_int_equal(make_scene(context, list, 1, &s), ASJ_OK);
        for (size_t k = 0; k < s.run.candidates.count; k++) {
            const asj_candidate *c = &s.run.candidates.list[k];
            const int32_t is_same = is_same_hue(&s, c);
            assert_true(is_same ? c->distance2 < 0.3f : c->distance2 > 0.7f);
            right += is_same;
            wrong += !is_same;
        }
        assert_int_equal(right, SQUARES);
        assert_in_range(wrong, SQUARES * (list - 1), 2 * SQUARES * (list - 1)); /* either side has its list */
        free_scene(context, &s);
    }
}

static void every_allocation_may_fail(void **state)
{
    static scene s;
    int reached = 1;
    (void)state;
    for (long n = 1; reached; n++) {
        unit_counter counter = {0};
        asj_context *poor = unit_context(&counter, 1);
        counter.fail_at = counter.calls + n;
        const asj_status status = make_scene(poor, 2, 1, &s);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK || (reached && status == ASJ_ERROR_MEMORY));
        free_scene(poor, &s);
        unit_context_free(&counter, &poor);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(small_pictures_are_means),      cmocka_unit_test(some_have_none),
        cmocka_unit_test(pyramids_have_means_of_them),
        cmocka_unit_test(patches_are_normalised_levels), cmocka_unit_test(scale_is_that_of_the_frames),
        cmocka_unit_test(white_balance_does_not_count),  cmocka_unit_test(hues_tell_partners_apart),
        cmocka_unit_test(grey_has_no_hue),               cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
