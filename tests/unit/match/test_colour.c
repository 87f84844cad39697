/* SPDX-License-Identifier: BSD-2-Clause */
/* Colours around L-junctions: what is measured, how it is kept, and that it decides between tiles that differ in nothing else, also
 * under other exposures and white balances; and that grey images know nothing of it. */
#include "core/bytes.h"
#include "geometry/colour_vote.h"
#include "geometry/pairs.h"
#include "match/kept_features.h"
#include "match/l_junctions_create.h"
#include "unit_test.h"
#include "wide_pair.h"

#include <asj/asj.h>

#define SIDE 80
#define TILED 81 /* a room with a floor of tiles */

/* --- what is measured -------------------------------------------------------------------------------------------------------- */

/* Four quarters that meet at (40, 40), in bytes of a format: top left, top right, bottom left, bottom right. */
static const uint8_t quarters[4][3] = {{200, 100, 50}, {20, 120, 220}, {90, 90, 10}, {60, 180, 70}};

static void paint(uint8_t *pixels, int32_t step, int32_t red)
{
    for (int32_t y = 0; y < SIDE; y++)
        for (int32_t x = 0; x < SIDE; x++) {
            const uint8_t *colour = quarters[(x >= SIDE / 2) + 2 * (y >= SIDE / 2)];
            uint8_t *to = pixels + (ptrdiff_t)(y * SIDE + x) * step;
            memset(to, 7, (size_t)step);
            to[red] = colour[0];
            to[1] = colour[1];
            to[2 - red] = colour[2];
        }
}

static asj_junction corner_at(float x, float y, float a, float b, float length)
{
    asj_junction j;
    memset(&j, 0, sizeof j);
    j.x = x;
    j.y = y;
    j.branch_count = 2;
    j.branches[0].angle = a;
    j.branches[1].angle = b;
    j.branches[0].length = j.branches[1].length = length;
    return j;
}

/* The colours of the L-junction of one corner; 0 when there are none. */
static int32_t colour_of(asj_context *context, const asj_image *image, const asj_junction *corner, asj_colour *colour)
{
    asj_match_options options;
    asj_l_junctions made;
    asj_colour *found = NULL;
    memset(&made, 0, sizeof made);
    memset(colour, 0, sizeof *colour);
    asj_match_options_init(&options);
    const asj_image_junctions list = {corner, 1, image->width, image->height, 1, 0};
    assert_int_equal(asj_l_junctions_create(context, &options, &list, &made), ASJ_OK);
    assert_int_equal(made.count, 1);
    assert_int_equal(asj_colours_create(context, image, &made, &found), ASJ_OK);
    const int32_t there = found != NULL;
    if (there)
        *colour = *found;
    asj_release(&context->memory, found);
    asj_l_junctions_free(&context->memory, &made);
    return there;
}

static void assert_level(const asj_colour *colour, int32_t region, const uint8_t expected[3])
{
    for (int32_t c = 0; c < 3; c++)
        assert_int_equal(colour->level[region][c], 128 * expected[c]);
}

/* Branches to the right and down: between them bottom right, beside a on the other side top right, beside b bottom left, opposite
 * top left. In every format, upright and bottom-up, and from the other branch. */
static void regions_are_where_they_should_be(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const struct {
        int32_t format, step, red;
    } formats[] = {{ASJ_FORMAT_RGB8, 3, 0}, {ASJ_FORMAT_BGR8, 3, 2}, {ASJ_FORMAT_RGBA8, 4, 0}, {ASJ_FORMAT_BGRA8, 4, 2}};
    uint8_t pixels[SIDE * SIDE * 4], flipped[SIDE * SIDE * 4];
    asj_colour colour;
    for (size_t f = 0; f < UNIT_COUNT(formats); f++) {
        const int32_t step = formats[f].step;
        const asj_junction corner = corner_at(39.5F, 39.5F, 0, (float)(UNIT_PI / 2), 30);
        paint(pixels, step, formats[f].red);
        asj_image image = {pixels, formats[f].format, SIDE, SIDE, 0, 0};
        for (int32_t way = 0; way < 2; way++) {
            assert_true(colour_of(context, &image, &corner, &colour));
            assert_level(&colour, 0, quarters[3]);
            assert_level(&colour, 1, quarters[1]);
            assert_level(&colour, 2, quarters[3]);
            assert_level(&colour, 3, quarters[2]);
            assert_level(&colour, 4, quarters[3]);
            assert_level(&colour, 5, quarters[0]);
            for (int32_t y = 0; y < SIDE; y++)
                memcpy(flipped + (ptrdiff_t)y * SIDE * step, pixels + (ptrdiff_t)(SIDE - 1 - y) * SIDE * step,
                       (size_t)(SIDE * step));
            image.data = flipped + (ptrdiff_t)(SIDE - 1) * SIDE * step;
            image.stride = -(ptrdiff_t)SIDE * step;
        }
    }
}

/* Outside of the image, where a channel is cut, and beside branches too short for it nothing is seen; black is seen. */
static void what_cannot_be_seen(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    uint8_t pixels[SIDE * SIDE * 3];
    const uint8_t none[3] = {0, 0, 0};
    const asj_image image = {pixels, ASJ_FORMAT_RGB8, SIDE, SIDE, 0, 0};
    asj_junction corner = corner_at(39.5F, 0.5F, 0, (float)(UNIT_PI / 2), 30);
    asj_colour colour;
    paint(pixels, 3, 0);
    assert_true(colour_of(context, &image, &corner, &colour));
    assert_level(&colour, 1, none);
    assert_level(&colour, 5, none);
    assert_level(&colour, 0, quarters[1]);
    for (int32_t k = 0; k < SIDE * SIDE; k++) { /* bottom right cut, top right black */
        pixels[3 * k] = k % SIDE >= 40 && k / SIDE >= 40 ? 255 : pixels[3 * k];
        if (k % SIDE >= 40 && k / SIDE < 40)
            memset(pixels + 3 * k, 0, 3);
    }
    corner = corner_at(39.5F, 39.5F, 0, (float)(UNIT_PI / 2), 30);
    assert_true(colour_of(context, &image, &corner, &colour));
    assert_level(&colour, 0, none);
    assert_level(&colour, 4, none);
    assert_true(colour.level[1][0] == 1 && colour.level[1][1] == 1 && colour.level[1][2] == 1);
    assert_level(&colour, 3, quarters[2]);
    corner = corner_at(39.5F, 39.5F, 0, (float)(UNIT_PI / 2), 3.5F);
    assert_true(colour_of(context, &image, &corner, &colour));
    assert_level(&colour, 2, none);
    for (int32_t k = 0; k < 3 * SIDE * SIDE; k++)
        pixels[k] = pixels[k / 3 * 3];
    assert_false(colour_of(context, &image, &corner, &colour)); /* grey in a format that has colours */
}

/* The left half is grey. What another octave has found in the right one is no candidate of a geometry, and is not asked. */
static void guests_do_not_say_that_there_are_colours(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    static uint8_t pixels[3 * SIDE * SIDE];
    asj_match_options options;
    asj_junction corners[3];
    asj_match_options_init(&options);
    for (int32_t k = 0; k < 3 * SIDE * SIDE; k++)
        pixels[k] = (uint8_t)(100 + (k / 3 % SIDE >= SIDE / 2 ? 40 * (k % 3) : 0));
    for (int32_t k = 0; k < 3; k++)
        corners[k] = corner_at(k == 2 ? 60 : 15, 20.0F + 20 * (float)k, 0, (float)(UNIT_PI / 2), 8);
    const asj_image image = {pixels, ASJ_FORMAT_RGB8, SIDE, SIDE, 0, 0};
    for (int32_t octave = 0; octave < 2; octave++) {
        asj_l_junctions made;
        asj_colour *found = NULL;
        memset(&made, 0, sizeof made);
        corners[2].octave = octave;
        const asj_image_junctions list = {corners, 3, SIDE, SIDE, 1, 0};
        assert_int_equal(asj_l_junctions_create(context, &options, &list, &made), ASJ_OK);
        assert_int_equal(asj_colours_create(context, &image, &made, &found), ASJ_OK);
        assert_int_equal(found != NULL, octave == 0);
        asj_release(&context->memory, found);
        asj_l_junctions_free(&context->memory, &made);
    }
    unit_context_free(&counter, &context);
}

/* --- what a vote needs ------------------------------------------------------------------------------------------------------- */

#define PLACES 24

/* At each place the first geometry has candidate 2 k, the second 2 k + 1, one place further in image 2. */
static double speak(const double *first_colour, const double *second_colour, int32_t places)
{
    asj_pair list[2 * PLACES];
    double first[2 * PLACES], second[2 * PLACES], room[4 * PLACES];
    memset(list, 0, sizeof list);
    for (int32_t k = 0; k < places; k++)
        for (int32_t n = 0; n < 2; n++) {
            list[2 * k + n].place1 = (uint32_t)k;
            list[2 * k + n].place2 = (uint32_t)((k + n) % places);
            list[2 * k + n].colour = (float)(n == 0 ? first_colour[k] : second_colour[k]);
            first[2 * k + n] = n == 0 ? 0.9 : 0;
            second[2 * k + n] = n == 1 ? 0.8 : 0;
        }
    const asj_pairs set = {.list = list, .count = 2 * places, .place_count = {places, places}};
    return asj_colours_against(&set, first, second, room);
}

static int32_t vote(const double *first_colour, const double *second_colour, int32_t places)
{
    return speak(first_colour, second_colour, places) > 1;
}

static void many_places_decide(void **state)
{
    (void)state;
    double good[PLACES], bad[PLACES], none[PLACES] = {0};
    synth_random random;
    synth_random_seed(&random, 7);
    for (int32_t k = 0; k < PLACES; k++) {
        good[k] = 0.9 + 0.5 * synth_random_between(&random, -1, 1);
        bad[k] = 0.1 + 0.5 * synth_random_between(&random, -1, 1);
    }
    assert_true(vote(good, bad, PLACES));
    assert_true(speak(bad, good, PLACES) < -1); /* they speak for the second one */
    assert_false(vote(good, bad, 4));      /* of too few */
    assert_false(vote(none, none, PLACES));
    int32_t decided = 0;
    for (int32_t trial = 0; trial < 200; trial++) { /* colours that know nothing */
        for (int32_t k = 0; k < PLACES; k++) {
            good[k] = synth_random_between(&random, -1, 1);
            bad[k] = synth_random_between(&random, -1, 1);
        }
        decided += vote(good, bad, PLACES);
    }
    assert_true(decided <= 4);
}

/* --- rooms ------------------------------------------------------------------------------------------------------------------- */

typedef struct pictures {
    synth_wide_pair pair;
    uint8_t *pixels[2], *grey[2], *grey3[2];
    asj_detection *found[2];
} pictures;

static pictures tiled;

static int make_tiled(void **state)
{
    const size_t count = (size_t)SYNTH_WIDE_WIDTH * SYNTH_WIDE_HEIGHT;
    asj_detect_options options;
    assert_int_equal(unit_set_up(state), 0);
    assert_int_equal(synth_wide_pair_make(&tiled.pair, TILED), 0);
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    for (int32_t v = 0; v < 2; v++) {
        uint8_t *pixels = synth_wide_picture(&tiled.pair, v), *grey = malloc(count), *grey3 = malloc(3 * count);
        assert_true(pixels && grey && grey3);
        for (size_t k = 0; k < count; k++) {
            grey[k] = (uint8_t)((77 * pixels[3 * k] + 150 * pixels[3 * k + 1] + 29 * pixels[3 * k + 2] + 128) >> 8);
            memset(grey3 + 3 * k, grey[k], 3);
        }
        tiled.pixels[v] = pixels;
        tiled.grey[v] = grey;
        tiled.grey3[v] = grey3;
        const asj_image image = {grey, ASJ_FORMAT_GRAY8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
        assert_int_equal(asj_detect(((unit_fixture *)*state)->context, &image, &options, &tiled.found[v]), ASJ_OK);
    }
    return 0;
}

static int free_tiled(void **state)
{
    for (int32_t v = 0; v < 2; v++) {
        asj_detection_free(&tiled.found[v]);
        free(tiled.pixels[v]);
        free(tiled.grey[v]);
        free(tiled.grey3[v]);
    }
    synth_wide_pair_free(&tiled.pair);
    return unit_tear_down(state);
}

static asj_match_options with_cameras(void)
{
    asj_match_options options;
    asj_match_options_init(&options);
    options.geometry.model = ASJ_GEOMETRY_AUTO;
    for (int32_t v = 0; v < 2; v++) {
        const double f = tiled.pair.cameras[v].focal;
        options.geometry.cameras[v] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    }
    return options;
}

static asj_image view_of(const uint8_t *pixels, int32_t format)
{
    return (asj_image){pixels, format, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
}

static asj_match_result *match(asj_context *context, asj_image image1, asj_image image2)
{
    const asj_match_options options = with_cameras();
    asj_match_result *result = NULL;
    assert_int_equal(asj_match(context, &image1, tiled.found[0]->junctions, tiled.found[0]->junction_count, &image2,
                               tiled.found[1]->junctions, tiled.found[1]->junction_count, &options, &result), ASJ_OK);
    return result;
}

static void assert_right(const asj_match_result *result, int32_t which)
{
    assert_int_equal(result->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_true(result->geometry.has_pose);
    const synth_pose_error off = synth_pose_off(&tiled.pair.cameras[0], &tiled.pair.cameras[1], result->geometry.rotation,
                                                result->geometry.translation);
    unit_near("rotation, deg", which, 0, off.rotation, 0, 1);
}

/* A floor shifted by a tile is as exact. Neither grey levels between the corners (picture_vote.c) nor colours fit it then, and no
 * more so when the second camera has another exposure and white balance still. */
static void tiles_of_many_hues(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    const size_t bytes = 3 * (size_t)SYNTH_WIDE_WIDTH * SYNTH_WIDE_HEIGHT;
    asj_match_result *result = match(context, view_of(tiled.grey[0], ASJ_FORMAT_GRAY8), view_of(tiled.grey[1], ASJ_FORMAT_GRAY8));
    assert_right(result, 2);
    asj_match_result_free(&result);
    uint8_t *other = malloc(bytes);
    assert_non_null(other);
    for (int32_t light = 0; light < 2; light++) {
        static const double gains[3] = {0.55, 0.8, 0.65};
        for (size_t k = 0; k < bytes; k++)
            other[k] = light == 0 ? tiled.pixels[1][k] : (uint8_t)(gains[k % 3] * tiled.pixels[1][k] + 0.5);
        result = match(context, view_of(tiled.pixels[0], ASJ_FORMAT_RGB8), view_of(other, ASJ_FORMAT_RGB8));
        assert_right(result, light);
        asj_match_result_free(&result);
    }
    free(other);
}

static void assert_same(const asj_match_result *a, const asj_match_result *b)
{
    assert_int_equal(a->match_count, b->match_count);
    assert_memory_equal(a->matches, b->matches, a->match_count * sizeof *a->matches);
    assert_memory_equal(&a->geometry, &b->geometry, sizeof a->geometry);
}

static asj_features *features_of(asj_context *context, const uint8_t *pixels, int32_t format, int32_t which, size_t count)
{
    asj_features *features = NULL;
    const asj_image image = view_of(pixels, format);
    const asj_match_options options = with_cameras();
    assert_int_equal(asj_features_create(context, &image, tiled.found[which]->junctions, count, &options, &features), ASJ_OK);
    return features;
}

static uint8_t *bytes_of(const asj_features *features, size_t *size)
{
    *size = asj_features_save(features, NULL, 0);
    uint8_t *bytes = malloc(*size);
    assert_non_null(bytes);
    assert_int_equal(asj_features_save(features, bytes, *size), *size);
    return bytes;
}

/* Grey pixels in a format with colours, or colours in one image alone, are grey images; their files are of version 1. */
static void grey_images_as_before(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_match_result *grey = match(context, view_of(tiled.grey[0], ASJ_FORMAT_GRAY8), view_of(tiled.grey[1], ASJ_FORMAT_GRAY8));
    asj_match_result *grey3 = match(context, view_of(tiled.grey3[0], ASJ_FORMAT_RGB8), view_of(tiled.grey3[1], ASJ_FORMAT_RGB8));
    asj_match_result *mixed = match(context, view_of(tiled.pixels[0], ASJ_FORMAT_RGB8), view_of(tiled.grey[1], ASJ_FORMAT_GRAY8));
    assert_same(grey, grey3);
    assert_same(grey, mixed);
    asj_features *a = features_of(context, tiled.grey[0], ASJ_FORMAT_GRAY8, 0, 40);
    asj_features *b = features_of(context, tiled.grey3[0], ASJ_FORMAT_RGB8, 0, 40);
    size_t size, size3;
    uint8_t *bytes = bytes_of(a, &size), *bytes3 = bytes_of(b, &size3);
    assert_int_equal(size, size3);
    assert_memory_equal(bytes, bytes3, size);
    assert_int_equal(asj_get_u32(bytes + 8), 1);
    free(bytes);
    free(bytes3);
    asj_features_free(&a);
    asj_features_free(&b);
    asj_match_result_free(&grey);
    asj_match_result_free(&grey3);
    asj_match_result_free(&mixed);
}

/* --- features that are kept -------------------------------------------------------------------------------------------------- */

static void refuse(asj_context *context, uint8_t *bytes, size_t size, const char *word)
{
    asj_features *features = NULL;
    asj_put_u64(bytes + 16, size);
    asj_put_u32(bytes + 12, asj_crc32(bytes + 16, size - 16));
    assert_int_equal(asj_features_load(context, bytes, size, &features), ASJ_ERROR_FORMAT);
    assert_null(features);
    assert_non_null(strstr(asj_context_message(context), word));
}

/* What former libraries wrote: colours, and no image at half its size. */
static void bytes_of_version_2(asj_context *context, uint8_t *bytes, size_t size)
{
    asj_features *features;
    size_t again;
    asj_put_u64(bytes + 16, size);
    asj_put_u32(bytes + 12, asj_crc32(bytes + 16, size - 16));
    assert_int_equal(asj_features_load(context, bytes, size, &features), ASJ_OK);
    uint8_t *same = bytes_of(features, &again);
    assert_int_equal(again, size);
    assert_memory_equal(same, bytes, size);
    asj_features_free(&features);
    free(same);
}

static void colours_are_kept(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    const asj_match_options options = with_cameras();
    asj_match_result *images = match(context, view_of(tiled.pixels[0], ASJ_FORMAT_RGB8), view_of(tiled.pixels[1], ASJ_FORMAT_RGB8));
    asj_match_result *files = NULL;
    asj_features *loaded[2] = {NULL, NULL};
    for (int32_t v = 0; v < 2; v++) {
        size_t size, size2;
        asj_features *f = features_of(context, tiled.pixels[v], ASJ_FORMAT_RGB8, v, tiled.found[v]->junction_count);
        uint8_t *bytes = bytes_of(f, &size);
        assert_int_equal(asj_get_u32(bytes + 8), 10); /* colours, and the image at half its size */
        const size_t small = (size_t)3 * (SYNTH_WIDE_WIDTH / 2) * (SYNTH_WIDE_HEIGHT / 2);
        assert_int_equal(asj_features_load(context, bytes, size, &loaded[v]), ASJ_OK);
        uint8_t *again = bytes_of(loaded[v], &size2);
        assert_int_equal(size, size2);
        assert_memory_equal(bytes, again, size);
        refuse(context, again, size - 1, "half");
        refuse(context, again, size - small - 36, "colours"); /* one less */
        asj_put_u16(again + size - small - 2, 255 * 128 + 1);
        refuse(context, again, size, "colour");
        memcpy(again, bytes, size);
        asj_put_u32(again + 8, 2);
        refuse(context, again, size, "colours"); /* version 2 ends with them */
        asj_put_u32(again + 8, 1);
        refuse(context, again, size, "pixels"); /* version 1 has none */
        asj_put_u32(again + 8, 2);
        bytes_of_version_2(context, again, size - small);
        asj_features_free(&f);
        free(bytes);
        free(again);
    }
    assert_int_equal(asj_match_features(context, loaded[0], loaded[1], &options, &files), ASJ_OK);
    assert_same(images, files);
    asj_match_result_free(&images);
    asj_match_result_free(&files);
    asj_features_free(&loaded[0]);
    asj_features_free(&loaded[1]);
}

static void every_allocation_may_fail(void **state)
{
    (void)state;
    const asj_image images[2] = {view_of(tiled.pixels[0], ASJ_FORMAT_RGB8), view_of(tiled.pixels[1], ASJ_FORMAT_RGB8)};
    size_t size;
    asj_match_options options = with_cameras();
    options.geometry.samples = 20;
    unit_counter plenty = {0};
    asj_context *rich = unit_context(&plenty, 1);
    asj_features *features = features_of(rich, tiled.pixels[0], ASJ_FORMAT_RGB8, 0, 30);
    uint8_t *bytes = bytes_of(features, &size);
    asj_features_free(&features);
    unit_context_free(&plenty, &rich);
    for (int32_t what = 0; what < 3; what++) {
        int reached = 1;
        for (long n = 1; n < 2000 && reached; n += UNIT_ALLOCATION_STEP) {
            unit_counter counter = {0};
            asj_context *poor = unit_context(&counter, 1);
            asj_match_result *result = NULL;
            counter.fail_at = counter.calls + n;
            const asj_status status =
                what == 0 ? asj_features_create(poor, &images[0], tiled.found[0]->junctions, 30, NULL, &features)
                : what == 1 ? asj_features_load(poor, bytes, size, &features)
                            : asj_match(poor, &images[0], tiled.found[0]->junctions, 12, &images[1], tiled.found[1]->junctions, 12,
                                        &options, &result);
            reached = unit_reached(&counter);
            assert_true(status == ASJ_OK || (reached && status == ASJ_ERROR_MEMORY));
            asj_features_free(&features);
            asj_match_result_free(&result);
            unit_context_free(&counter, &poor);
        }
        assert_false(reached);
    }
    free(bytes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(regions_are_where_they_should_be), cmocka_unit_test(what_cannot_be_seen),
        cmocka_unit_test(many_places_decide),               cmocka_unit_test(tiles_of_many_hues),
        cmocka_unit_test(guests_do_not_say_that_there_are_colours),
        cmocka_unit_test(grey_images_as_before),            cmocka_unit_test(colours_are_kept),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, make_tiled, free_tiled);
}
