/* SPDX-License-Identifier: BSD-2-Clause */
/* Option colours: planes of opponent colours, and corners that only they show. */
#include "core/colour_plane.h"
#include "unit_test.h"

#include <asj/asj.h>

#define SIDE 160
#define PIXELS (SIDE * SIDE)
#define FIRST 50 /* px: of the square */
#define END 110

typedef unit_fixture fixture;
typedef uint8_t picture[PIXELS][3];

/* Noise in each channel; `smooth`: of 2 x 2 pixels, and interpolated, as JPEG keeps colours. */
static void add_noise(picture pixels, double deviation, int smooth, uint64_t seed)
{
    static double noise[3][SIDE + 2][SIDE + 2];
    synth_random random;
    synth_random_seed(&random, seed);
    for (int c = 0; c < 3; c++)
        for (int y = 0; y < SIDE + 2; y++)
            for (int x = 0; x < SIDE + 2; x++)
                noise[c][y][x] = deviation * synth_random_normal(&random);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            for (int c = 0; c < 3; c++) {
                const double fx = 0.25 + 0.5 * (x & 1), fy = 0.25 + 0.5 * (y & 1);
                const double(*n)[SIDE + 2] = (const double(*)[SIDE + 2])noise[c];
                const double upper = (1 - fx) * n[y / 2][x / 2] + fx * n[y / 2][x / 2 + 1];
                const double lower = (1 - fx) * n[y / 2 + 1][x / 2] + fx * n[y / 2 + 1][x / 2 + 1];
                const double level = pixels[y * SIDE + x][c] + (smooth ? (1 - fy) * upper + fy * lower : n[y][x]);
                pixels[y * SIDE + x][c] = (uint8_t)fmax(0, fmin(255, floor(level + 0.5)));
            }
}

/* A square of one colour on another one. */
static void draw_square(picture pixels, const uint8_t ground[3], const uint8_t square[3])
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++)
            memcpy(pixels[y * SIDE + x], x >= FIRST && x < END && y >= FIRST && y < END ? square : ground, 3);
}

/* Of equal luma: 77 R + 150 G + 29 B. */
static const uint8_t grey[3] = {120, 120, 120}, reddish[3] = {159, 100, 120}, bluish[3] = {120, 108, 182};

static asj_image view(const void *pixels, int32_t format)
{
    return (asj_image){pixels, format, SIDE, SIDE, 0, 0};
}

/* How many of the square's corners have a junction within a pixel and a half. */
static int corners_found(const asj_detection *found)
{
    int count = 0;
    for (int corner = 0; corner < 4; corner++) {
        const double x = (corner & 1 ? END : FIRST) - 0.5, y = (corner & 2 ? END : FIRST) - 0.5;
        int there = 0;
        for (uint32_t k = 0; k < found->junction_count; k++)
            there |= hypot((double)found->junctions[k].x - x, (double)found->junctions[k].y - y) < 1.5;
        count += there;
    }
    return count;
}

static void corners_of_equal_luma(void **state)
{
    static picture pixels;
    fixture *f = *state;
    const uint8_t *const squares[] = {reddish, bluish};
    for (int s = 0; s < 2; s++)
        for (int32_t preset = ASJ_PRESET_DEFAULT; preset <= ASJ_PRESET_MATCH; preset += 2) {
            asj_detection *without = NULL, *with = NULL;
            const asj_image image = view(pixels, ASJ_FORMAT_RGB8);
            draw_square(pixels, grey, squares[s]);
            add_noise(pixels, 2, 0, 7 + (uint64_t)s);
            assert_int_equal(asj_detect_options_preset(&f->options, preset), ASJ_OK);
            assert_int_equal(f->options.colours, 0);
            assert_int_equal(asj_detect(f->context, &image, &f->options, &without), ASJ_OK);
            f->options.colours = 1;
            assert_int_equal(asj_detect(f->context, &image, &f->options, &with), ASJ_OK);
            assert_int_equal(corners_found(without), 0);
            assert_int_equal(corners_found(with), 4);
            assert_true(preset == ASJ_PRESET_MATCH || (with->junction_count == 4 && with->edge_count == 4));
            asj_detection_free(&without);
            asj_detection_free(&with);
        }
}

static void expect_same(const asj_detection *a, const asj_detection *b)
{
    assert_int_equal(a->junction_count, b->junction_count);
    assert_int_equal(a->edge_count, b->edge_count);
    assert_memory_equal(a->junctions, b->junctions, a->junction_count * sizeof *a->junctions);
}

/* Colours that are grey are none, whatever holds them. */
static void grey_images_stay_as_they_are(void **state)
{
    static picture pixels;
    static uint8_t levels[PIXELS];
    fixture *f = *state;
    asj_detection *without = NULL, *with = NULL, *of_levels = NULL;
    const asj_image image = view(pixels, ASJ_FORMAT_RGB8), gray = view(levels, ASJ_FORMAT_GRAY8);
    draw_square(pixels, (const uint8_t[]){60, 60, 60}, grey);
    add_noise(pixels, 2, 0, 3);
    for (int k = 0; k < PIXELS; k++)
        levels[k] = pixels[k][1] = pixels[k][2] = pixels[k][0];
    asj_detect_options_init(&f->options);
    assert_int_equal(asj_detect(f->context, &image, &f->options, &without), ASJ_OK);
    f->options.colours = 1;
    assert_int_equal(asj_detect(f->context, &image, &f->options, &with), ASJ_OK);
    assert_int_equal(asj_detect(f->context, &gray, &f->options, &of_levels), ASJ_OK);
    assert_int_equal(without->junction_count, 4);
    expect_same(without, with);
    expect_same(without, of_levels);
    asj_detection_free(&without);
    asj_detection_free(&with);
    asj_detection_free(&of_levels);
}

/* A grey corner beside a coloured one: with independent_octaves what the luma shows stays where it is, before or behind what
 * colours add, and nothing is listed twice. */
static void colours_add_to_the_luma(void **state)
{
    static picture pixels;
    fixture *f = *state;
    asj_detection *without = NULL, *with = NULL;
    const asj_image image = view(pixels, ASJ_FORMAT_RGB8);
    draw_square(pixels, grey, reddish);
    for (int y = 0; y < 25; y++)
        for (int x = 0; x < 30; x++)
            memcpy(pixels[y * SIDE + x], (const uint8_t[]){200, 120, 60}, 3);
    add_noise(pixels, 2, 0, 5);
    asj_detect_options_preset(&f->options, ASJ_PRESET_MATCH);
    assert_int_equal(asj_detect(f->context, &image, &f->options, &without), ASJ_OK);
    f->options.colours = 1;
    assert_int_equal(asj_detect(f->context, &image, &f->options, &with), ASJ_OK);
    assert_true(without->junction_count > 0 && with->junction_count >= without->junction_count + 4);
    uint32_t again = 0;
    for (uint32_t k = 0; k < with->junction_count; k++) {
        const asj_junction *a = &with->junctions[k];
        int of_luma = 0, close = 0;
        for (uint32_t i = 0; i < without->junction_count; i++) {
            of_luma |= a->x == without->junctions[i].x && a->y == without->junctions[i].y;
            close |= hypot((double)a->x - (double)without->junctions[i].x, (double)a->y - (double)without->junctions[i].y) < 4;
        }
        again += (uint32_t)of_luma;
        assert_true(of_luma || !close);
        assert_true(k == 0 || with->junctions[k - 1].log10_nfa <= a->log10_nfa);
    }
    assert_int_equal(again, without->junction_count);
    asj_detection_free(&without);
    asj_detection_free(&with);
}

/* The order of channels, alpha, the number of threads and rows from bottom to top change no bit. */
static void formats_and_threads_agree(void **state)
{
    static picture pixels;
    static uint8_t others[3][PIXELS][4];
    static const int32_t formats[] = {ASJ_FORMAT_BGR8, ASJ_FORMAT_RGBA8, ASJ_FORMAT_BGRA8};
    fixture *f = *state;
    asj_detection *first = NULL;
    const asj_image image = view(pixels, ASJ_FORMAT_RGB8);
    draw_square(pixels, reddish, bluish);
    add_noise(pixels, 3, 0, 11);
    asj_detect_options_init(&f->options);
    f->options.colours = f->options.half_octaves = 1;
    assert_int_equal(asj_detect(f->context, &image, &f->options, &first), ASJ_OK);
    assert_int_equal(corners_found(first), 4);
    for (int k = 0; k < 3; k++) {
        uint8_t *to = &others[k][0][0];
        const int step = formats[k] == ASJ_FORMAT_BGR8 ? 3 : 4, red = formats[k] == ASJ_FORMAT_RGBA8 ? 0 : 2;
        for (int i = 0; i < PIXELS; i++, to += step) {
            to[red] = pixels[i][0];
            to[1] = pixels[i][1];
            to[2 - red] = pixels[i][2];
            if (step == 4)
                to[3] = (uint8_t)i;
        }
        unit_counter counter = {0};
        asj_context *context = unit_context(&counter, 1 + k);
        asj_detection *found = NULL;
        const asj_image other = view(others[k], formats[k]);
        assert_int_equal(asj_detect(context, &other, &f->options, &found), ASJ_OK);
        expect_same(first, found);
        asj_detection_free(&found);
        unit_context_free(&counter, &context);
    }
    asj_detection_free(&first);
}

/* Wherever octaves begin and however many there are, with sources of the paper, and in a part of the image. */
static void other_options_go_with_colours(void **state)
{
    static picture pixels;
    fixture *f = *state;
    const asj_image image = view(pixels, ASJ_FORMAT_RGB8);
    draw_square(pixels, grey, reddish);
    add_noise(pixels, 2, 0, 23);
    for (int k = 0; k < 4; k++) {
        asj_detection *found = NULL;
        asj_region region = {.x = END - 20, .y = END - 20, .width = 40, .height = 40};
        asj_detect_options_init(&f->options);
        f->options.colours = 1;
        f->options.first_octave = k == 0 ? -1 : k == 1 ? 1 : 0;
        f->options.octaves = k == 2 ? 1 : 16;
        assert_int_equal(asj_detect(f->context, &image, &f->options, &found), ASJ_OK);
        assert_int_equal(corners_found(found), 4);
        assert_int_equal(asj_detect_region(f->context, &image, &region, &f->options, &found), ASJ_OK);
        assert_int_equal(corners_found(found), 1);
        assert_int_equal(found->junction_count, 1);
        asj_detection_free(&found);
    }
}

/* A board of colours of equal luma is seen in as many octaves as a grey one, where each is a detector of its own. */
static void each_octave_has_its_own(void **state)
{
    static picture pixels;
    fixture *f = *state;
    const asj_image image = view(pixels, ASJ_FORMAT_RGB8);
    uint32_t counts[2][3] = {{0}};
    for (int coloured = 0; coloured < 2; coloured++) {
        asj_detection *found = NULL;
        for (int k = 0; k < PIXELS; k++) {
            const int odd = (k % SIDE / 32 + k / SIDE / 32) % 2;
            memcpy(pixels[k], odd ? grey : coloured ? reddish : (const uint8_t[]){90, 90, 91}, 3);
        }
        add_noise(pixels, 2, 0, 29);
        asj_detect_options_preset(&f->options, ASJ_PRESET_MATCH);
        f->options.colours = 1;
        assert_int_equal(asj_detect(f->context, &image, &f->options, &found), ASJ_OK);
        for (uint32_t k = 0; k < found->junction_count; k++) {
            const asj_junction *j = &found->junctions[k];
            const double x = (double)j->x + 0.5, y = (double)j->y + 0.5;
            const double across = x - 32 * floor(x / 32 + 0.5), down = y - 32 * floor(y / 32 + 0.5);
            if (j->octave <= 2 && hypot(across, down) < 2 && x > 16 && y > 16 && x < SIDE - 16 && y < SIDE - 16)
                counts[coloured][j->octave]++;
        }
        asj_detection_free(&found);
    }
    for (int octave = 0; octave < 2; octave++)
        assert_true(counts[0][octave] >= 14 && counts[1][octave] >= 14 && counts[1][octave] <= 18);
}

/* White is white in each channel. */
static void white_levels_scale_colours(void **state)
{
    static picture pixels;
    fixture *f = *state;
    asj_detection *found = NULL;
    asj_image image = view(pixels, ASJ_FORMAT_RGB8);
    const uint8_t dark[] = {12, 12, 12}, red[] = {17, 9, 12};
    draw_square(pixels, dark, red);
    image.white = 24;
    asj_detect_options_init(&f->options);
    f->options.colours = 1;
    assert_int_equal(asj_detect(f->context, &image, &f->options, &found), ASJ_OK);
    assert_int_equal(corners_found(found), 4);
    asj_detection_free(&found);
}

/* As many false alarms as epsilon allows: in 30 images none, whether neighbouring pixels are alike or not. */
static void noise_has_no_corners(void **state)
{
    static picture pixels;
    fixture *f = *state;
    const asj_image image = view(pixels, ASJ_FORMAT_RGB8);
    asj_detect_options_init(&f->options);
    f->options.colours = 1;
    for (uint64_t seed = 0; seed < 30; seed++) {
        asj_detection *found = NULL;
        draw_square(pixels, reddish, reddish);
        add_noise(pixels, seed % 2 ? 4 : 12, seed % 2 != 0, seed);
        assert_int_equal(asj_detect(f->context, &image, &f->options, &found), ASJ_OK);
        assert_int_equal(found->junction_count, 0);
        asj_detection_free(&found);
    }
}

/* --- the planes --------------------------------------------------------------------------------------------------------------- */

static void levels_of_planes(void **state)
{
    static const uint8_t pixels[][3] = {{0, 0, 0}, {255, 255, 255}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {10, 30, 60},
                                        {255, 255, 0}};
    static const double red_green[] = {127.5, 127.5, 255, 0, 127.5, 117.5, 127.5};
    static const double blue_yellow[] = {127.5, 127.5, 63.75, 63.75, 255, 147.5, 0};
    uint16_t row[UNIT_COUNT(pixels)], table[256];
    (void)state;
    for (int k = 0; k < 256; k++)
        table[k] = (uint16_t)(k * ASJ_GRAY_ONE);
    for (int lut = 0; lut < 2; lut++)
        for (int32_t plane = ASJ_PLANE_RED_GREEN; plane < ASJ_PLANES; plane++) {
            asj_colour_row(&pixels[0][0], UNIT_COUNT(pixels), 3, 0, lut ? table : NULL, plane, row);
            for (size_t k = 0; k < UNIT_COUNT(pixels); k++)
                unit_near("level", plane, (double)k, (double)row[k] / ASJ_GRAY_ONE,
                          plane == ASJ_PLANE_RED_GREEN ? red_green[k] : blue_yellow[k], 0);
        }
}

static void noise_of_planes(void **state)
{
    static picture pixels;
    static uint8_t levels[PIXELS];
    fixture *f = *state;
    asj_colour_planes planes;
    asj_image image = view(levels, ASJ_FORMAT_GRAY8);
    assert_int_equal(asj_colour_planes_look(f->context, &image, &planes), ASJ_OK);
    assert_int_equal(planes.count, 1);
    image = view(pixels, ASJ_FORMAT_RGB8);
    draw_square(pixels, grey, grey);
    assert_int_equal(asj_colour_planes_look(f->context, &image, &planes), ASJ_OK);
    assert_int_equal(planes.count, 1);
    pixels[PIXELS - 1][2]++; /* one pixel with a colour */
    assert_int_equal(asj_colour_planes_look(f->context, &image, &planes), ASJ_OK);
    assert_int_equal(planes.count, ASJ_PLANES);
    for (int along = 0; along < 2; along++) { /* smooth along one direction is smooth */
        draw_square(pixels, grey, reddish);
        add_noise(pixels, 3, 0, 19);
        for (int k = 0; k < PIXELS; k += 2)
            for (int c = 0; c < 3; c++) {
                const int at = along ? k / 2 % SIDE + k / 2 / SIDE * 2 * SIDE : k, next = at + (along ? SIDE : 1);
                pixels[at][c] = pixels[next][c] = (uint8_t)((pixels[at][c] + pixels[next][c]) / 2);
            }
        assert_int_equal(asj_colour_planes_look(f->context, &image, &planes), ASJ_OK);
        assert_true(planes.smooth[1] == 1 && planes.smooth[2] == 1);
    }
    for (int smooth = 0; smooth < 2; smooth++) {
        draw_square(pixels, grey, reddish);
        add_noise(pixels, 3, smooth, 17);
        assert_int_equal(asj_colour_planes_look(f->context, &image, &planes), ASJ_OK);
        assert_int_equal(planes.count, ASJ_PLANES);
        assert_true(planes.smooth[0] == 0 && planes.smooth[1] == smooth && planes.smooth[2] == smooth);
    }
    f->counter.calls = 0;
    f->counter.fail_at = 1;
    assert_int_equal(asj_colour_planes_look(f->context, &image, &planes), ASJ_ERROR_MEMORY);
    f->counter.fail_at = 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_of_planes),
        cmocka_unit_test(noise_of_planes),
        cmocka_unit_test(corners_of_equal_luma),
        cmocka_unit_test(grey_images_stay_as_they_are),
        cmocka_unit_test(colours_add_to_the_luma),
        cmocka_unit_test(formats_and_threads_agree),
        cmocka_unit_test(other_options_go_with_colours),
        cmocka_unit_test(each_octave_has_its_own),
        cmocka_unit_test(white_levels_scale_colours),
        cmocka_unit_test(noise_has_no_corners),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
