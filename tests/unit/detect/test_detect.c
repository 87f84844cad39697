/* SPDX-License-Identifier: BSD-2-Clause */
/* The whole detector: known corners, images without any, borders, threads, reuse, turned images, formats, progress, dumps,
 * options. */
#include "unit_test.h"

#include <asj/asj.h>

typedef unit_fixture fixture;

static int set_up(void **state)
{
    return unit_set_up_threads(state, 2);
}

static asj_detection *detect(asj_context *context, const uint8_t *pixels, int32_t width, int32_t height)
{
    const asj_image image = unit_gray8(pixels, width, height);
    asj_detection *found = NULL;
    const asj_status status = asj_detect(context, &image, NULL, &found);
    if (status != ASJ_OK)
        fail_msg("status %d: %s", (int)status, asj_context_message(context));
    assert_non_null(found);
    return found;
}

static asj_detection *detect_scene(asj_context *context, synth_scene *scene, double blur, double noise)
{
    const int32_t width = scene->width, height = scene->height;
    uint8_t *pixels = unit_picture(scene, blur, noise, 3);
    asj_detection *found = detect(context, pixels, width, height);
    free(pixels);
    return found;
}

/* What every result must be, whatever the image. */
static void check_sound(const asj_detection *d)
{
    assert_int_equal(d->junctions == NULL, d->junction_count == 0);
    assert_int_equal(d->l_junctions == NULL, d->l_junction_count == 0);
    assert_int_equal(d->backend, ASJ_BACKEND_CPU);
    assert_true(d->candidates >= d->isotropic && d->isotropic >= d->junction_count);
    for (uint32_t i = 0; i < d->junction_count; i++) {
        const asj_junction *j = &d->junctions[i];
        assert_true(i == 0 || j->log10_nfa >= j[-1].log10_nfa);
        assert_in_range(j->branch_count, 2, ASJ_MAX_BRANCHES);
        assert_true(isfinite(j->x) && isfinite(j->y) && j->log10_nfa <= 0 && j->location_sd >= 0);
        for (int32_t b = 0; b < j->branch_count; b++) {
            assert_true(j->branches[b].angle >= 0 && (double)j->branches[b].angle < 2 * UNIT_PI);
            assert_true(b == 0 || j->branches[b].angle >= j->branches[b - 1].angle);
            assert_true(j->branches[b].length > 0 && j->branches[b].log10_nfa <= 0 && j->branches[b].angle_sd >= 0);
        }
        for (int32_t b = j->branch_count; b < ASJ_MAX_BRANCHES; b++)
            assert_true(j->branches[b].length == 0 && j->branches[b].angle == 0 && j->branches[b].strength == 0);
    }
    for (uint32_t i = 0; i < d->l_junction_count; i++)
        assert_true(d->l_junctions[i].junction < d->junction_count);
}

static void check_same(const asj_detection *a, const asj_detection *b)
{
    assert_int_equal(a->junction_count, b->junction_count);
    assert_int_equal(a->l_junction_count, b->l_junction_count);
    assert_true(a->candidates == b->candidates && a->isotropic == b->isotropic);
    if (a->junction_count)
        assert_memory_equal(a->junctions, b->junctions, a->junction_count * sizeof *a->junctions);
    if (a->l_junction_count)
        assert_memory_equal(a->l_junctions, b->l_junctions, a->l_junction_count * sizeof *a->l_junctions);
}

/* The junction nearest to a place; NULL when none is within `reach`. */
static const asj_junction *nearest(const asj_detection *d, double x, double y, double reach)
{
    const asj_junction *best = NULL;
    for (uint32_t i = 0; i < d->junction_count; i++) {
        const double distance = hypot(d->junctions[i].x - x, d->junctions[i].y - y);
        if (distance <= reach) {
            reach = distance;
            best = &d->junctions[i];
        }
    }
    return best;
}

static int has_branch(const asj_junction *j, double angle, double tolerance)
{
    for (int32_t b = 0; b < j->branch_count; b++)
        if (unit_turn(j->branches[b].angle, angle) <= tolerance)
            return 1;
    return 0;
}

/* ---- shapes ---- */

typedef struct shape {
    const char *name;
    int32_t count;
    double angles[5], grays[5]; /* sector i from angle i to the next; gray below 0: background */
} shape;

/* Every shape turned all around: its centre within half a pixel, each of its branches within 2 degrees, 3 px in length. */
static void test_shapes(void **state)
{
    const fixture *f = *state;
    static const shape shapes[] = {
        {"L", 2, {0, 1.6}, {180, -1}},
        {"T", 3, {0, 1.5, UNIT_PI}, {180, 60, -1}},
        {"X", 4, {0, 1.5, UNIT_PI, 1.5 + UNIT_PI}, {180, 60, 200, 40}},
        {"Y", 3, {0, 2.1, 4.2}, {200, 60, 130}},
        {"star", 5, {0, 1.2, 2.6, 3.8, 5.1}, {200, 60, 140, 220, 40}},
    };
    for (size_t i = 0; i < UNIT_COUNT(shapes); i++)
        for (int n = 0; n < 8; n++) {
            const shape *s = &shapes[i];
            const double turn = 0.79 * n + 0.1, x = 80.3 + 0.05 * n, y = 79.6 + 0.07 * n;
            double angles[5];
            synth_scene scene;
            for (int32_t k = 0; k < s->count; k++)
                angles[k] = s->angles[k] + turn;
            synth_scene_init(&scene, 160, 160, 110);
            synth_add_star(&scene, (synth_point){x, y}, angles, s->grays, s->count, 60);
            asj_detection *found = detect_scene(f->context, &scene, 0.8, 1);
            check_sound(found);
            const asj_junction *j = nearest(found, x, y, 0.6);
            if (!j)
                fail_msg("%s turned by %g is not found", s->name, turn);
            for (int32_t k = 0; k < s->count; k++)
                if (!has_branch(j, angles[k], 2 * UNIT_PI / 180))
                    fail_msg("%s turned by %g lacks branch %d", s->name, turn, (int)k);
            assert_int_equal(j->branch_count, s->count);
            for (int32_t b = 0; b < j->branch_count; b++)
                unit_near("length", (double)i, n, j->branches[b].length, 60, 4);
            asj_detection_free(&found);
        }
}

/* Sharp corners, whose sides blur joins near the apex. */
static void test_sharp(void **state)
{
    const fixture *f = *state;
    for (int degrees = 28; degrees <= 48; degrees += 4)
        for (int n = 0; n < 6; n++) {
            const double turn = 1.05 * n + 0.1, opening = degrees * UNIT_PI / 180;
            const double x = 100.3 - 35 * cos(turn + opening / 2), y = 99.6 - 35 * sin(turn + opening / 2);
            synth_scene scene;
            synth_scene_init(&scene, 200, 200, 100);
            synth_add_star(&scene, (synth_point){x, y}, (const double[]){turn, turn + opening}, (const double[]){160, -1}, 2, 80);
            asj_detection *found = detect_scene(f->context, &scene, 1, 2);
            const asj_junction *j = nearest(found, x, y, 1.5);
            if (!j || !has_branch(j, turn, 0.03) || !has_branch(j, turn + opening, 0.03))
                fail_msg("%d degrees turned by %g: not found", degrees, turn);
            asj_detection_free(&found);
        }
}

/* Inner crossings of a board of tiles, with four branches each; a crossing is where branches of other junctions must pass. */
static void test_crossings(void **state)
{
    const fixture *f = *state;
    synth_scene scene;
    int crossings = 0;
    synth_scene_init(&scene, 200, 200, 128);
    for (int i = 0; i < 16; i++)
        synth_add_rectangle(&scene, (synth_point){20.3 + 40 * (i % 4), 20.6 + 40 * (i / 4)}, 40, 40, 0, (i + i / 4) % 2 ? 60 : 200);
    asj_detection *found = detect_scene(f->context, &scene, 0.8, 1);
    check_sound(found);
    for (int i = 0; i < 9; i++) {
        const double x = 60.3 + 40 * (i % 3), y = 60.6 + 40 * (i / 3);
        const asj_junction *j = nearest(found, x, y, 0.5);
        if (!j || j->branch_count != 4)
            fail_msg("crossing at (%g, %g): %d branches", x, y, j ? (int)j->branch_count : -1);
        for (int32_t b = 0; b < 4; b++)
            crossings += (double)j->branches[b].length > 50; /* reaches beyond the next crossing or the rim */
    }
    assert_true(crossings > 12);
    asj_detection_free(&found);
}

/* ---- nothing to find ---- */

static void check_nothing(const fixture *f, const uint8_t *pixels, int32_t width, int32_t height)
{
    asj_detection *found = detect(f->context, pixels, width, height);
    check_sound(found);
    if (found->junction_count)
        fail_msg("%d junctions in an image of %d x %d", (int)found->junction_count, (int)width, (int)height);
    assert_true(found->width == width && found->height == height);
    asj_detection_free(&found);
}

static void test_tiny_and_flat(void **state)
{
    static const int32_t sizes[][2] = {{1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 3}, {1, 500}, {500, 1}, {2, 300}, {300, 2}, {7, 7},
                                       {15, 15}, {33, 17}};
    for (size_t i = 0; i < UNIT_COUNT(sizes); i++) {
        const int32_t width = sizes[i][0], height = sizes[i][1];
        static const double grays[] = {0, 127, 255};
        for (size_t g = 0; g < UNIT_COUNT(grays); g++) {
            uint8_t *flat = synth_noise_image(width, height, grays[g], 0, 1);
            assert_non_null(flat);
            check_nothing(*state, flat, width, height);
            free(flat);
        }
        uint8_t *noise = synth_noise_image(width, height, 128, 40, i);
        assert_non_null(noise);
        check_nothing(*state, noise, width, height);
        free(noise);
    }
}

/* The promise of the method: at epsilon 1 less than one junction in an image of noise. The paper and we find none. */
static void test_noise(void **state)
{
    for (uint64_t seed = 0; seed < 12; seed++) {
        uint8_t *noise = synth_noise_image(200, 160, 128, 5 + 5.0 * (double)(seed % 6), seed);
        assert_non_null(noise);
        check_nothing(*state, noise, 200, 160);
        free(noise);
    }
}

/* ---- borders ---- */

/* A corner of a bright block at 1 to 8 px from each border, its sides leading inwards. The gradient is zero outside and sectors
 * keep their number of pixels, so evidence is lost there and none is invented: from 3 px on every corner is found, and what is
 * found nearer than that is at the right place. */
static void test_borders(void **state)
{
    const fixture *f = *state;
    int near = 0;
    for (int side = 0; side < 4; side++)
        for (int away = 1; away <= 8; away++) {
            const double turn = side * UNIT_PI / 2, c = cos(turn), s = sin(turn);
            /* the corner at (50, away), branches at 45 and 135 degrees, then all turned around the centre of the image */
            const double u = 0.3, v = away - 49.5, x = 49.5 + u * c - v * s, y = 49.5 + u * s + v * c;
            const double angles[2] = {UNIT_PI / 4 + turn, 3 * UNIT_PI / 4 + turn}, grays[2] = {190, -1};
            synth_scene scene;
            synth_scene_init(&scene, 100, 100, 100);
            synth_add_star(&scene, (synth_point){x, y}, angles, grays, 2, 50);
            asj_detection *found = detect_scene(f->context, &scene, 0.8, 0.5);
            check_sound(found);
            const asj_junction *j = nearest(found, x, y, 5);
            if (away >= 3 && !j)
                fail_msg("side %d: the corner %d px from the border is not found", side, away);
            near += j != NULL;
            if (j) {
                unit_near("distance", side, away, hypot(j->x - x, j->y - y), 0, 1);
                assert_true(has_branch(j, angles[0], 0.05));
                assert_true(has_branch(j, angles[1], 0.05));
            }
            asj_detection_free(&found);
        }
    assert_in_range(near, 24, 32);
}

/* ---- the same picture in other ways ---- */

static uint8_t *some_picture(int32_t kind, int32_t *width, int32_t *height)
{
    synth_scene scene;
    switch (kind) {
    case 0: synth_parallelograms(&scene, 60, 11); break;
    case 1: synth_tiles(&scene, SYNTH_RANDOM_TILES, 4); break;
    default: synth_random_star(&scene, 40, 6);
    }
    *width = scene.width;
    *height = scene.height;
    return unit_picture(&scene, 1, 3, 8);
}

static asj_detection *keep_copy(const asj_detection *d)
{
    asj_detection *copy = malloc(sizeof *copy);
    asj_junction *junctions = calloc(d->junction_count + 1, sizeof *junctions);
    asj_l_junction *l_junctions = calloc(d->l_junction_count + 1, sizeof *l_junctions);
    assert_non_null(copy);
    assert_non_null(junctions);
    assert_non_null(l_junctions);
    *copy = *d;
    memcpy(junctions, d->junctions, d->junction_count * sizeof *junctions);
    memcpy(l_junctions, d->l_junctions, d->l_junction_count * sizeof *l_junctions);
    copy->junctions = junctions;
    copy->l_junctions = l_junctions;
    return copy;
}

static void drop_copy(asj_detection *copy)
{
    free((void *)(uintptr_t)copy->junctions);
    free((void *)(uintptr_t)copy->l_junctions);
    free(copy);
}

static void test_threads(void **state)
{
    static const int32_t threads[] = {1, 2, 3, 7};
    (void)state;
    for (int32_t preset = 0; preset < 2; preset++)
        for (int32_t kind = 0; kind < (preset ? 1 : 3); kind++) {
            int32_t width, height;
            uint8_t *pixels = some_picture(kind, &width, &height);
            const asj_image image = unit_gray8(pixels, width, height);
            asj_detection *first = NULL;
            asj_detect_options options;
            asj_detect_options_preset(&options, preset);
            for (size_t i = 0; i < UNIT_COUNT(threads); i++) {
                unit_counter counter;
                asj_context *context = unit_context(&counter, threads[i]);
                asj_detection *found = NULL;
                assert_int_equal(asj_detect(context, &image, &options, &found), ASJ_OK);
                assert_true(found->junction_count > 0);
                if (first)
                    check_same(first, found);
                else
                    first = keep_copy(found);
                asj_detection_free(&found);
                unit_context_free(&counter, &context);
            }
            drop_copy(first);
            free(pixels);
        }
}

/* What octave -1 adds to a union is all of its own, and the rest is what there was. */
static void check_upsampled(asj_context *context, const asj_image *image, const asj_detection *all)
{
    asj_detect_options options;
    asj_detection *more = NULL;
    uint32_t next = 0;
    assert_int_equal(asj_detect_options_preset(&options, ASJ_PRESET_MATCH), ASJ_OK);
    options.first_octave = -1;
    options.octaves++;
    assert_int_equal(asj_detect(context, image, &options, &more), ASJ_OK);
    assert_true(more->junction_count > all->junction_count);
    for (uint32_t i = 0; i < more->junction_count; i++) {
        assert_true(more->junctions[i].octave >= -1);
        if (more->junctions[i].octave < 0)
            continue;
        assert_true(next < all->junction_count);
        assert_memory_equal(&more->junctions[i], &all->junctions[next++], sizeof *all->junctions);
    }
    assert_int_equal(next, all->junction_count);
    asj_detection_free(&more);
}

/* Squares of `side` px have corners too near to each other for the image itself; those of octave -1 are where they are, within
 * what they say. */
static void test_small_squares(void **state)
{
    enum { SIDE = 7, FIRST = 20, STEP = 31, COUNT = 6, SIZE = 2 * FIRST + COUNT * STEP };
    static uint8_t pixels[SIZE * SIZE];
    fixture *f = *state;
    const asj_image image = unit_gray8(pixels, SIZE, SIZE);
    uint32_t found_by[2];
    for (int32_t y = 0; y < SIZE; y++)
        for (int32_t x = 0; x < SIZE; x++) {
            const int32_t i = (x - FIRST) / STEP, j = (y - FIRST) / STEP;
            const int inside = x >= FIRST && y >= FIRST && i < COUNT && j < COUNT && (x - FIRST) % STEP < SIDE &&
                               (y - FIRST) % STEP < SIDE;
            pixels[y * SIZE + x] = inside ? 200 : 60;
        }
    for (int32_t first = 0; first >= -1; first--) {
        asj_detect_options options;
        asj_detection *found = NULL;
        asj_detect_options_init(&options);
        options.first_octave = first;
        assert_int_equal(asj_detect(f->context, &image, &options, &found), ASJ_OK);
        assert_true(found->width == SIZE && found->height == SIZE);
        found_by[-first] = 0;
        for (uint32_t k = 0; k < found->junction_count; k++) {
            const asj_junction *c = &found->junctions[k];
            const double x = fmod((double)c->x - FIRST + 0.5 + 1, STEP) - 1, y = fmod((double)c->y - FIRST + 0.5 + 1, STEP) - 1;
            const double dx = fmin(fabs(x), fabs(x - SIDE)), dy = fmin(fabs(y), fabs(y - SIDE));
            found_by[-first] += c->octave == first && c->branch_count == 2 && dx < 0.2 && dy < 0.2;
            assert_true(c->octave > first || hypot(dx, dy) < 5 * (double)c->location_sd + 0.05);
        }
        asj_detection_free(&found);
    }
    printf("squares of %d px: %u corners of the image, %u of octave -1, of %d\n", (int)SIDE, (unsigned)found_by[0],
           (unsigned)found_by[1], 4 * COUNT * COUNT);
    assert_int_equal(found_by[1], 4 * COUNT * COUNT);
    assert_int_equal(found_by[0], 0); /* their sides are shorter than a sector */
}

/* An upsampled image has a largest size, too. */
static void test_upsampled_limit(void **state)
{
    fixture *f = *state;
    asj_detect_options options;
    asj_detection *found = NULL;
    const uint8_t pixel = 0;
    const asj_image wide = {&pixel, ASJ_FORMAT_GRAY8, ASJ_MAX_SIDE / 2 + 1, 1, 0, 0};
    asj_detect_options_init(&options);
    options.first_octave = -1;
    assert_int_equal(asj_detect(f->context, &wide, &options, &found), ASJ_ERROR_LIMIT);
    assert_null(found);
    options.first_octave = -2;
    assert_int_equal(asj_detect(f->context, &wide, &options, &found), ASJ_ERROR_OPTION);
}

/* Octaves that are listed each for itself change nothing of each other. */
static void test_independent_octaves(void **state)
{
    enum { PICTURES = 3 };
    fixture *f = *state;
    uint32_t coarse = 0;
    for (int32_t kind = 0; kind < PICTURES; kind++) {
        int32_t width, height;
        uint8_t *pixels = some_picture(kind, &width, &height);
        const asj_image image = unit_gray8(pixels, width, height);
        asj_detection *one = NULL, *all = NULL;
        asj_detect_options options;
        assert_int_equal(asj_detect_options_preset(&options, ASJ_PRESET_MATCH), ASJ_OK);
        assert_true(options.octaves > 1 && options.independent_octaves);
        assert_int_equal(asj_detect(f->context, &image, &options, &all), ASJ_OK);
        options.octaves = 1;
        assert_int_equal(asj_detect(f->context, &image, &options, &one), ASJ_OK);
        uint32_t next = 0;
        for (uint32_t i = 0; i < all->junction_count; i++) {
            coarse += all->junctions[i].octave > 0;
            if (all->junctions[i].octave > 0)
                continue;
            assert_true(next < one->junction_count);
            assert_memory_equal(&all->junctions[i], &one->junctions[next++], sizeof *one->junctions);
        }
        assert_int_equal(next, one->junction_count);
        check_upsampled(f->context, &image, all);
        asj_detection_free(&one);
        asj_detection_free(&all);
        free(pixels);
    }
    assert_true(coarse > 20);
}

/* No branch is shorter, wherever it ends in the end: ends come after branches have been validated. In px of the image, in all
 * octaves: of the upsampled image they are twice as many. */
static void test_minimum_length(void **state)
{
    enum { LENGTH = 40, PICTURES = 3 };
    fixture *f = *state;
    uint32_t shorter = 0, branches = 0;
    for (int32_t kind = 0; kind < PICTURES; kind++)
        for (int32_t least = 0; least <= LENGTH; least += LENGTH) {
            int32_t width, height;
            uint8_t *pixels = some_picture(kind, &width, &height);
            const asj_image image = unit_gray8(pixels, width, height);
            asj_detection *found = NULL;
            asj_detect_options options;
            asj_detect_options_init(&options);
            options.minimum_length = least;
            options.octaves = kind == 1 ? 16 : 1;
            options.first_octave = kind == 2 ? -1 : 0;
            options.snap_distance = 0;
            assert_int_equal(asj_detect(f->context, &image, &options, &found), ASJ_OK);
            for (uint32_t i = 0; i < found->junction_count; i++) {
                assert_true(found->junctions[i].branch_count >= 2);
                for (int32_t b = 0; b < found->junctions[i].branch_count; b++) {
                    const float length = found->junctions[i].branches[b].length;
                    assert_true(length >= (float)least);
                    shorter += least == 0 && length < LENGTH;
                    branches += least > 0;
                }
            }
            asj_detection_free(&found);
            free(pixels);
        }
    assert_true(shorter > 10 && branches > 10);
}

/* A second time, and after images of other sizes and calls that failed: the same bits. */
static void test_reuse(void **state)
{
    fixture *f = *state;
    int32_t width, height;
    uint8_t *pixels = some_picture(0, &width, &height);
    asj_detection *found = detect(f->context, pixels, width, height), *first = keep_copy(found);
    assert_true(first->junction_count >= 8);
    asj_detection_free(&found);
    for (int i = 0; i < 6; i++) {
        static const int32_t sizes[][2] = {{1, 1}, {400, 30}, {30, 400}, {16, 16}, {333, 1}, {250, 260}};
        uint8_t *other = synth_noise_image(sizes[i][0], sizes[i][1], 128, 60, 1);
        assert_non_null(other);
        asj_image image = unit_gray8(other, sizes[i][0], sizes[i][1]);
        asj_detect_options options;
        asj_detect_options_init(&options);
        options.field_radius = i % 2 ? 5 : 9; /* other tables in between */
        assert_int_equal(asj_detect(f->context, &image, &options, &found), ASJ_OK);
        asj_detection_free(&found);
        image.width = -1;
        assert_int_equal(asj_detect(f->context, &image, NULL, &found), ASJ_ERROR_IMAGE);
        assert_null(found);
        found = detect(f->context, pixels, width, height);
        check_same(first, found);
        asj_detection_free(&found);
        free(other);
    }
    drop_copy(first);
    free(pixels);
}

/* Upside down, with an odd number of rows: candidates stand at the same pixels, and directions of sectors mirror each other. All
 * that comes after has no side that it prefers, so that what is found is the same, but for numbers that round to either side. */
static void test_upside_down(void **state)
{
    enum { WIDTH = 479, HEIGHT = 359 };
    const fixture *f = *state;
    asj_detect_options options;
    asj_detection *found[2];
    uint32_t same = 0;
    uint8_t *pixels = unit_room_picture(0, WIDTH, HEIGHT), *turned = malloc(WIDTH * HEIGHT);
    assert_non_null(turned);
    for (int y = 0; y < HEIGHT; y++)
        memcpy(turned + y * WIDTH, pixels + (HEIGHT - 1 - y) * WIDTH, WIDTH);
    asj_detect_options_init(&options);
    options.octaves = 1; /* an octave has an even number of rows, or half a row less than the image */
    for (int k = 0; k < 2; k++) {
        const asj_image image = unit_gray8(k ? turned : pixels, WIDTH, HEIGHT);
        assert_int_equal(asj_detect(f->context, &image, &options, &found[k]), ASJ_OK);
    }
    for (uint32_t i = 0; i < found[0]->junction_count; i++)
        same += nearest(found[1], (double)found[0]->junctions[i].x, HEIGHT - 1 - (double)found[0]->junctions[i].y, 0.02) != NULL;
    assert_true(found[0]->junction_count > 100);
    assert_true(same * 50 >= found[0]->junction_count * 49);
    asj_detection_free(&found[0]);
    asj_detection_free(&found[1]);
    free(turned);
    free(pixels);
}

/* Turned by 90 degrees the picture has the same junctions, turned. Bins of directions and scan lines are not symmetric under that
 * turn, so nearly all, and to a tenth of a pixel. */
static void test_quarter_turn(void **state)
{
    const fixture *f = *state;
    int32_t width, height;
    int missing = 0, total = 0;
    for (int kind = 0; kind < 2; kind++) {
        uint8_t *pixels = some_picture(kind, &width, &height), *turned = malloc((size_t)(width * height));
        assert_non_null(turned);
        for (int32_t y = 0; y < height; y++) /* clockwise: (x, y) -> (height - 1 - y, x) */
            for (int32_t x = 0; x < width; x++)
                turned[x * height + height - 1 - y] = pixels[y * width + x];
        asj_detection *a = detect(f->context, pixels, width, height), *b = detect(f->context, turned, height, width);
        assert_true(abs((int)a->junction_count - (int)b->junction_count) <= (int)a->junction_count / 20);
        for (uint32_t i = 0; i < a->junction_count; i++) {
            const asj_junction *p = &a->junctions[i], *q = nearest(b, height - 1 - (double)p->y, p->x, 0.5);
            total++;
            missing += !q;
            for (int32_t k = 0; q && k < p->branch_count; k++)
                missing += q->branch_count == p->branch_count && !has_branch(q, p->branches[k].angle + UNIT_PI / 2, 0.035);
        }
        asj_detection_free(&a);
        asj_detection_free(&b);
        free(turned);
        free(pixels);
    }
    assert_true(total > 30);
    if (missing > total / 20)
        fail_msg("%d of %d junctions or branches are not where the turn takes them", missing, total);
}

/* The same gray levels in every format give the same junctions. */
static void test_formats(void **state)
{
    const fixture *f = *state;
    int32_t width, height;
    uint8_t *pixels = some_picture(0, &width, &height);
    const size_t count = (size_t)(width * height);
    asj_detection *gray = detect(f->context, pixels, width, height), *other = NULL;
    uint16_t *words = malloc(count * sizeof *words);
    float *floats = malloc(count * sizeof *floats);
    uint8_t *colours = malloc(count * 4);
    assert_non_null(words);
    assert_non_null(floats);
    assert_non_null(colours);
    for (size_t i = 0; i < count; i++) {
        words[i] = (uint16_t)(pixels[i] * 257);
        floats[i] = (float)pixels[i] / 255;
        memset(colours + 4 * i, pixels[i], 4);
    }
    const asj_image images[] = {{words, ASJ_FORMAT_GRAY16, width, height, 0, 0},
                                {floats, ASJ_FORMAT_GRAY_FLOAT, width, height, 0, 0},
                                {colours, ASJ_FORMAT_RGBA8, width, height, 0, 0}, {colours, ASJ_FORMAT_BGRA8, width, height, 0, 0}};
    for (size_t i = 0; i < UNIT_COUNT(images); i++) {
        assert_int_equal(asj_detect(f->context, &images[i], NULL, &other), ASJ_OK);
        check_same(gray, other);
        asj_detection_free(&other);
    }
    for (size_t i = 0; i < count; i++)
        memset(colours + 3 * i, pixels[i], 3);
    for (int32_t format = ASJ_FORMAT_RGB8; format <= ASJ_FORMAT_BGR8; format++) {
        const asj_image image = {colours, format, width, height, 0, 0};
        assert_int_equal(asj_detect(f->context, &image, NULL, &other), ASJ_OK);
        check_same(gray, other);
        asj_detection_free(&other);
    }
    asj_detection_free(&gray);
    free(colours);
    free(floats);
    free(words);
    free(pixels);
}

/* ---- arguments and options ---- */

static void test_arguments(void **state)
{
    const fixture *f = *state;
    static const uint8_t pixels[64] = {0};
    static asj_local_branch branches[64 * ASJ_FIELD_BRANCHES];
    const asj_image image = unit_gray8(pixels, 8, 8);
    asj_detection *found = (asj_detection *)(uintptr_t)pixels;
    assert_int_equal(asj_detect(NULL, &image, NULL, &found), ASJ_ERROR_ARGUMENT);
    assert_null(found);
    assert_int_equal(asj_detect(f->context, NULL, NULL, &found), ASJ_ERROR_ARGUMENT);
    assert_non_null(strstr(asj_context_message(f->context), "image"));
    assert_int_equal(asj_detect(f->context, &image, NULL, NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_detect(f->context, NULL, NULL, NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_local_field(NULL, &image, NULL, branches), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_local_field(f->context, NULL, NULL, branches), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_local_field(f->context, &image, NULL, NULL), ASJ_ERROR_ARGUMENT);
    asj_detection_free(&found);
    asj_detection_free(NULL);
    float bad[4] = {0, 1, NAN, 0};
    const asj_image floats = {bad, ASJ_FORMAT_GRAY_FLOAT, 2, 2, 0, 0};
    found = (asj_detection *)(uintptr_t)pixels;
    assert_int_equal(asj_detect(f->context, &floats, NULL, &found), ASJ_ERROR_IMAGE);
    assert_null(found);
    assert_int_equal(asj_local_field(f->context, &floats, NULL, branches), ASJ_ERROR_IMAGE);
    const asj_image large = unit_gray8(pixels, ASJ_MAX_SIDE + 1, 8);
    assert_int_equal(asj_detect(f->context, &large, NULL, &found), ASJ_ERROR_LIMIT);
}

/* `radii` where the option is a set of them, else `number`. */
static void put_option(asj_detect_options *options, const asj_option_info *row, double number, uint32_t radii)
{
    char *field = (char *)options + row->offset;
    if (row->type == ASJ_OPTION_NUMBER)
        memcpy(field, &number, sizeof number);
    else if (row->type == ASJ_OPTION_RADII)
        memcpy(field, &radii, sizeof radii);
    else {
        const int32_t integer = (int32_t)number;
        memcpy(field, &integer, sizeof integer);
    }
}

/* Each option out of its range, on either side: refused by name, by both functions. */
static void test_bad_options(void **state)
{
    const fixture *f = *state;
    static const uint8_t pixels[64] = {0};
    static asj_local_branch branches[64 * ASJ_FIELD_BRANCHES];
    const asj_image image = unit_gray8(pixels, 8, 8);
    for (size_t k = 0; k < asj_detect_option_count(); k++)
        for (int above = 0; above < 2; above++) {
            const asj_option_info *row = asj_detect_option(k);
            asj_detect_options options;
            asj_detection *found = NULL;
            const double number = above ? row->maximum * 1.0001 + 1e-9 : row->minimum - 1e-9 - 1e-4 * fabs(row->minimum);
            asj_detect_options_init(&options);
            if (row->type == ASJ_OPTION_NUMBER)
                put_option(&options, row, number, 0);
            else
                put_option(&options, row, above ? row->maximum + 1 : row->minimum - 1, above ? 0x80000000u : 0);
            assert_int_equal(asj_detect(f->context, &image, &options, &found), ASJ_ERROR_OPTION);
            assert_null(found);
            if (strncmp(asj_context_message(f->context), row->key, strlen(row->key)) != 0)
                fail_msg("%s is not named in '%s'", row->key, asj_context_message(f->context));
            assert_int_equal(asj_local_field(f->context, &image, &options, branches), ASJ_ERROR_OPTION);
        }
}

/* Every option at both ends of its range, on a picture with junctions: a result or none, but sound. */
static void test_extreme_options(void **state)
{
    const fixture *f = *state;
    synth_scene scene;
    synth_scene_init(&scene, 60, 50, 110);
    synth_add_rectangle(&scene, (synth_point){12.4, 14.2}, 31, 26, 0.2, 170);
    uint8_t *pixels = unit_picture(&scene, 1, 4, 4);
    const asj_image image = unit_gray8(pixels, 60, 50);
    for (size_t k = 0; k < asj_detect_option_count(); k++)
        for (int preset = ASJ_PRESET_DEFAULT; preset <= ASJ_PRESET_MATCH; preset++)
            for (int above = 0; above < 2; above++) {
                const asj_option_info *row = asj_detect_option(k);
                asj_detect_options options;
                asj_detection *found = NULL;
                const double number = above ? row->maximum : row->minimum;
                asj_detect_options_preset(&options, preset);
                put_option(&options, row, number, above ? 0x7ffffff8u : 1u << 3);
                if (asj_detect(f->context, &image, &options, &found) != ASJ_OK)
                    fail_msg("%s = %g: %s", row->key, number, asj_context_message(f->context));
                for (uint32_t i = 0; i < found->junction_count; i++) {
                    const asj_junction *j = &found->junctions[i];
                    assert_in_range(j->branch_count, 2, ASJ_MAX_BRANCHES);
                    assert_true(isfinite(j->x) && isfinite(j->y) && isfinite(j->location_sd) && isfinite(j->log10_nfa));
                    for (int32_t b = 0; b < j->branch_count; b++)
                        assert_true(isfinite(j->branches[b].length) && isfinite(j->branches[b].log10_nfa) &&
                                    isfinite(j->branches[b].angle_sd) && j->branches[b].length >= 0);
                }
                asj_detection_free(&found);
            }
    free(pixels);
}

/* Branches that hardly have a pixel, since the picture ends: their numbers are finite, too. */
static void test_branches_at_the_border(void **state)
{
    const fixture *f = *state;
    enum { SIDE = 96 };
    static uint8_t pixels[SIDE * SIDE];
    const asj_image image = unit_gray8(pixels, SIDE, SIDE);
    asj_detect_options options;
    uint32_t random = 1, count = 0;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    options.ignore_frame = 0;
    for (int32_t n = 0; n < 40; n++) {
        asj_detection *found = NULL;
        for (int32_t i = 0; i < SIDE * SIDE; i++) { /* cells of 6 x 6 px, noise */
            if (i % 6 == 0 && i / SIDE % 6 == 0)
                pixels[i] = (uint8_t)((random = random * 1664525u + 1013904223u) >> 24);
            else
                pixels[i] = pixels[i / SIDE / 6 * 6 * SIDE + i % SIDE / 6 * 6];
        }
        assert_int_equal(asj_detect(f->context, &image, &options, &found), ASJ_OK);
        for (uint32_t i = 0; i < found->junction_count; i++, count++)
            for (int32_t b = 0; b < found->junctions[i].branch_count; b++)
                assert_true(isfinite(found->junctions[i].branches[b].log10_nfa));
        asj_detection_free(&found);
    }
    assert_true(count > 1000);
}

/* Radii that share the gammas of a larger one, small fields, radii at which five branches do not fit: under sanitizers this
 * checks the scratch, and everywhere that every number is finite and every order kept. Checkerboards have branches at angle 0. */
static void test_radii(void **state)
{
    static const char *const radii[] = {"14,15", "23,25", "28,29", "3-30", "3", "3,4", "5,7,10,14"};
    enum { SIDE = 120 };
    static uint8_t board[SIDE * SIDE];
    unit_counter counter;
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (int32_t i = 0; i < SIDE * SIDE; i++)
        board[i] = (i % SIDE / 20 + i / SIDE / 20) % 2 ? 255 : 0;
    const asj_image image = {board, ASJ_FORMAT_GRAY8, SIDE, SIDE, 0, 0};
    for (size_t r = 0; r < sizeof radii / sizeof radii[0]; r++)
        for (int32_t field = 3; field <= 9; field += 2) {
            asj_detect_options options;
            asj_detection *found = NULL;
            asj_detect_options_init(&options);
            options.field_radius = field;
            assert_int_equal(asj_detect_options_set(&options, "isotropic_radii", radii[r], NULL, 0), ASJ_OK);
            assert_int_equal(asj_detect(context, &image, &options, &found), ASJ_OK);
            for (uint32_t j = 0; j < found->junction_count; j++) {
                const asj_junction *junction = &found->junctions[j];
                assert_true(isfinite(junction->log10_nfa));
                for (int32_t b = 0; b < junction->branch_count; b++) {
                    assert_true(isfinite(junction->branches[b].log10_nfa));
                    assert_true(b == 0 || junction->branches[b].angle > junction->branches[b - 1].angle);
                }
            }
            if (r == 6 && field == 7)
                assert_true(found->junction_count > 10);
            asj_detection_free(&found);
        }
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_shapes), cmocka_unit_test(test_sharp), cmocka_unit_test(test_crossings),
        cmocka_unit_test(test_tiny_and_flat),
        cmocka_unit_test(test_noise),  cmocka_unit_test(test_borders),   cmocka_unit_test(test_threads),
        cmocka_unit_test(test_reuse),  cmocka_unit_test(test_quarter_turn), cmocka_unit_test(test_upside_down),
        cmocka_unit_test(test_formats),
        cmocka_unit_test(test_independent_octaves), cmocka_unit_test(test_small_squares), cmocka_unit_test(test_upsampled_limit),
        cmocka_unit_test(test_minimum_length),
        cmocka_unit_test(test_radii), cmocka_unit_test(test_branches_at_the_border),
        cmocka_unit_test(test_arguments), cmocka_unit_test(test_bad_options), cmocka_unit_test(test_extreme_options),
    };
    return cmocka_run_group_tests(tests, set_up, unit_tear_down);
}
