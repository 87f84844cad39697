/* SPDX-License-Identifier: BSD-2-Clause */
/* Line segments and their parts, against plain formulas, pictures whose edges are known, and noise. */
#include "core/watch.h"
#include "segments/line_segments.h"
#include "segments/line_segments_nfa.h"
#include "segments/line_segments_region.h"
#include "unit_test.h"

typedef unit_fixture fixture;

/* ---- number of false alarms ---- */

/* The binomial tail, term by term from factors that stay near 1, in long double. */
static double naive_log_tail(int32_t n, int32_t k, double p)
{
    long double sum = 0;
    for (int32_t j = k; j <= n; j++) {
        long double term = 1;
        int32_t up = 0, down = 0;
        for (int32_t i = 0; i < n; i++) { /* C(n, j) p^j (1 - p)^(n - j), large and small factors in turn */
            if (up < j) {
                term *= (long double)(n - up) / (j - up) * (long double)p;
                up++;
            }
            if (down < n - j) {
                term *= 1 - (long double)p;
                down++;
            }
        }
        sum += term;
    }
    return (double)logl(sum);
}

static void test_tail(void **state)
{
    static const int32_t sizes[] = {1, 2, 7, 8, 9, 20, 65, 240, 1000};
    static const double precisions[] = {0.125, 0.0625, 1 / 256.0, 0.5};
    (void)state;
    for (size_t s = 0; s < UNIT_COUNT(sizes); s++)
        for (size_t q = 0; q < UNIT_COUNT(precisions); q++)
            for (int32_t k = 0; k <= sizes[s]; k += 1 + sizes[s] / 40) {
                const double expected = naive_log_tail(sizes[s], k, precisions[q]);
                unit_near("tail", sizes[s], k, asj_segment_log_tail(sizes[s], k, precisions[q]), expected,
                          1e-9 + 1e-9 * fabs(expected));
            }
    unit_near("all aligned", 100000, 0, asj_segment_log_tail(100000, 100000, 0.125), 100000 * log(0.125), 1e-3);
    assert_true(asj_segment_log_tail(1000000, 125000, 0.125) < 0);
    unit_near("tests", 512, 384, asj_segment_log_tests(512, 384), log(6 * pow(512.0 * 384.0, 2.5)), 1e-9);
}

/* ---- level lines ---- */

static void load(const fixture *f, const uint8_t *pixels, int32_t width, int32_t height, asj_frame *frame)
{
    const asj_image image = unit_gray8(pixels, width, height);
    unit_frame(f->context, &image, NULL, frame);
}

/* A ramp of `slope` grey levels per pixel in direction `angle`: the level line is everywhere at right angles to it, the dark side
 * on its right, and a working pixel is 1.25 px. */
static void test_ramps(void **state)
{
    const fixture *f = *state;
    enum { SIDE = 40 };
    for (int n = 0; n < 24; n++) {
        const double angle = n * UNIT_PI / 12 + 0.1, slope = 5;
        uint8_t pixels[SIDE * SIDE];
        asj_frame frame;
        asj_levels levels;
        for (int i = 0; i < SIDE * SIDE; i++) {
            const double along = (i % SIDE - SIDE / 2) * cos(angle) + (i / SIDE - SIDE / 2) * sin(angle);
            pixels[i] = (uint8_t)lrint(128 + fmax(-100, fmin(100, slope * along)));
        }
        load(f, pixels, SIDE, SIDE, &frame);
        assert_int_equal(asj_levels_create(f->context, &frame, ASJ_STAGE_CANDIDATES, &levels), ASJ_OK);
        assert_int_equal(levels.width, SIDE * 4 / 5 - 1);
        const int32_t middle = levels.height / 2 * levels.width + levels.width / 2;
        unit_near("slope", n, 0, (double)levels.norm[middle], slope * 1.25, 0.6);
        const double x = (double)levels.direction[middle].x, y = (double)levels.direction[middle].y;
        unit_near("across", n, 0, x * cos(angle) + y * sin(angle), 0, 0.09);
        unit_near("along", n, 0, y * cos(angle) - x * sin(angle), 1, 0.01);
        assert_true(levels.order_count > 0);
        for (int32_t i = 1; i < levels.order_count; i++) /* in classes: 1 / 1023 of the steepest */
            assert_true(levels.norm[levels.order[i]] <= levels.norm[levels.order[i - 1]] + levels.norm[levels.order[0]] / 1000);
        asj_levels_free(&f->context->memory, &levels);
        asj_frame_free(&f->context->memory, &frame);
    }
}

/* Where no gradient exceeds what rounding does, there is no level line. */
static void test_flat(void **state)
{
    const fixture *f = *state;
    uint8_t pixels[30 * 20];
    asj_frame frame;
    asj_levels levels;
    for (int i = 0; i < 30 * 20; i++)
        pixels[i] = (uint8_t)(100 + 2 * (i % 2));
    load(f, pixels, 30, 20, &frame);
    assert_int_equal(asj_levels_create(f->context, &frame, ASJ_STAGE_CANDIDATES, &levels), ASJ_OK);
    assert_int_equal(levels.order_count, 0);
    asj_levels_free(&f->context->memory, &levels);
    asj_frame_free(&f->context->memory, &frame);
}

/* Each row is looked at four times: once to fill it, three times to sort its samples. */
static void test_asked_in_every_row(void **state)
{
    const fixture *f = *state;
    enum { SIDE = 120 };
    uint8_t pixels[SIDE * SIDE];
    asj_frame frame;
    asj_levels levels;
    long asked = 0;
    uint32_t random = 1;
    for (size_t i = 0; i < SIDE * SIDE; i++) {
        random = random * 1664525u + 1013904223u;
        pixels[i] = (uint8_t)(random >> 24);
    }
    load(f, pixels, SIDE, SIDE, &frame);
    f->context->options.progress = unit_count_question;
    f->context->options.progress_user = &asked;
    f->context->pause_ms = 0;
    f->context->asked_ms = 0;
    assert_int_equal(asj_levels_create(f->context, &frame, ASJ_STAGE_CANDIDATES, &levels), ASJ_OK);
    f->context->pause_ms = ASJ_PAUSE;
    f->context->options.progress = NULL;
    assert_true(levels.order_count > SIDE * SIDE / 2);
    assert_true(asked >= 3 * levels.height);
    asj_levels_free(&f->context->memory, &levels);
    asj_frame_free(&f->context->memory, &frame);
}

/* ---- regions and rectangles ---- */

/* A field without memory of its own: random directions, all defined. */
enum { FIELD_WIDTH = 37, FIELD_HEIGHT = 29, FIELD = FIELD_WIDTH * FIELD_HEIGHT };
typedef struct field {
    asj_levels levels;
    asj_unit_vector direction[FIELD];
    float norm[FIELD];
    int32_t samples[FIELD];
    uint8_t used[FIELD];
    asj_support_region region;
} field;

static field *random_field(uint64_t seed)
{
    field *f = calloc(1, sizeof *f);
    synth_random random;
    assert_non_null(f);
    synth_random_seed(&random, seed);
    for (int i = 0; i < FIELD; i++) {
        const double angle = synth_random_between(&random, 0, 2 * UNIT_PI);
        f->direction[i] = (asj_unit_vector){(float)cos(angle), (float)sin(angle)};
        f->norm[i] = (float)synth_random_between(&random, 6, 60);
    }
    f->levels = (asj_levels){FIELD_WIDTH, FIELD_HEIGHT, f->direction, f->norm, NULL, 0};
    f->region = (asj_support_region){f->samples, f->used, 0, 0, 0};
    return f;
}

/* Counting row by row gives what asking every sample of the field gives. */
static void test_rectangle_count(void **state)
{
    const float cosines[2] = {0.92387953f, 0.98078528f};
    synth_random random;
    (void)state;
    synth_random_seed(&random, 5);
    field *f = random_field(3);
    for (int n = 0; n < 500; n++) {
        const double angle = n < 8 ? n * UNIT_PI / 4 : synth_random_between(&random, 0, 2 * UNIT_PI);
        asj_rectangle r = {synth_random_between(&random, -3, 40), synth_random_between(&random, -3, 32), cos(angle), sin(angle),
                           synth_random_between(&random, -25, 0), synth_random_between(&random, 0, 25),
                           synth_random_between(&random, -4, 0), synth_random_between(&random, 0, 4)};
        int32_t inside = 0, aligned[2] = {0, 0}, counted[2];
        const double middle = 0.5 * (r.low + r.high), half = 0.5 * asj_rectangle_width(&r);
        for (int i = 0; i < FIELD; i++) {
            const double dx = i % FIELD_WIDTH - r.x, dy = i / FIELD_WIDTH - r.y;
            const double along = dx * r.ux + dy * r.uy, across = dy * r.ux - dx * r.uy;
            if (along < r.first || along > r.last || fabs(across - middle) > half)
                continue;
            const double turn = unit_turn(atan2((double)f->direction[i].y, (double)f->direction[i].x), angle);
            inside++;
            aligned[0] += turn <= UNIT_PI / 8;
            aligned[1] += turn <= UNIT_PI / 16;
        }
        assert_int_equal(asj_rectangle_count(&f->levels, &r, cosines, 2, counted), inside);
        assert_int_equal(counted[0], aligned[0]);
        assert_int_equal(counted[1], aligned[1]);
    }
    free(f);
}

/* A bar of samples at an angle, all with its direction: growing from any of them finds all, and the rectangle is the bar. */
static void test_region(void **state)
{
    (void)state;
    for (int n = 0; n < 36; n++) {
        const double angle = n * UNIT_PI / 18, ux = cos(angle), uy = sin(angle);
        field *f = random_field((uint64_t)n);
        int32_t bar = 0, seed = 0;
        for (int i = 0; i < FIELD; i++) {
            const double dx = i % FIELD_WIDTH - 18, dy = i / FIELD_WIDTH - 14;
            const double along = dx * ux + dy * uy, across = dy * ux - dx * uy;
            f->norm[i] = fabs(along) <= 12 && fabs(across) <= 1.6 ? 20.0f : 0;
            f->direction[i] = f->norm[i] > 0 ? (asj_unit_vector){(float)ux, (float)uy} : (asj_unit_vector){0, 0};
            if (f->norm[i] > 0) {
                seed = i;
                bar++;
            }
        }
        asj_rectangle r;
        asj_region_grow(&f->levels, seed, ASJ_REGION_COSINE, &f->region);
        assert_int_equal(f->region.count, bar);
        assert_true(asj_region_approximate(&f->levels, &f->region, &r));
        unit_near("x", n, 0, r.x, 18, 0.3);
        unit_near("y", n, 0, r.y, 14, 0.3);
        unit_near("turn", n, 0, unit_turn(atan2(r.uy, r.ux), angle), 0, 0.04);
        unit_near("length", n, 0, asj_rectangle_length(&r), 24, 1.5);
        unit_near("width", n, 0, asj_rectangle_width(&r), 3.2, 1.3);
        free(f);
    }
}

/* A right angle whose sides differ by little in direction is one region, but no rectangle: it is cut to one side. */
static void test_cut(void **state)
{
    (void)state;
    field *f = random_field(1);
    for (int i = 0; i < FIELD; i++) {
        const int x = i % FIELD_WIDTH, y = i / FIELD_WIDTH, lies = x >= 4 && x <= 30 && y >= 4 && y <= 6;
        const int rises = x >= 4 && x <= 6 && y >= 4 && y <= 26;
        const double angle = lies && !rises ? 0.15 : -0.15;
        f->norm[i] = lies || rises ? 20.0f : 0;
        f->direction[i] = lies || rises ? (asj_unit_vector){(float)cos(angle), (float)sin(angle)} : (asj_unit_vector){0, 0};
    }
    asj_rectangle r;
    asj_region_grow(&f->levels, 5 * FIELD_WIDTH + 25, ASJ_REGION_COSINE, &f->region);
    assert_int_equal(f->region.count, 27 * 3 + 20 * 3);
    assert_true(asj_region_approximate(&f->levels, &f->region, &r));
    assert_true(f->region.count >= 0.7 * asj_rectangle_length(&r) * asj_rectangle_width(&r));
    assert_true(asj_rectangle_width(&r) < 5);
    int32_t used = 0;
    for (int i = 0; i < FIELD; i++)
        used += f->used[i];
    assert_int_equal(used, f->region.count); /* the rest is free again */
    free(f);
}

/* ---- the whole ---- */

static asj_line_segment *find(const fixture *f, const uint8_t *pixels, int32_t width, int32_t height, size_t *count)
{
    asj_frame frame;
    asj_line_segment *segments = NULL;
    load(f, pixels, width, height, &frame);
    assert_int_equal(asj_line_segments_find(f->context, &frame, ASJ_STAGE_CANDIDATES, 1, &segments, count), ASJ_OK);
    asj_frame_free(&f->context->memory, &frame);
    return segments;
}

/* A dark square, turned: four segments, each from corner to corner. */
static void test_square(void **state)
{
    const fixture *f = *state;
    for (int n = 0; n < 9; n++) {
        const double turn = n * UNIT_PI / 18 + 0.05, half = 25;
        const synth_point middle = {59.3, 61.8};
        synth_scene scene;
        size_t count;
        synth_scene_init(&scene, 120, 124, 150);
        const synth_point corner = {middle.x - half * (cos(turn) - sin(turn)), middle.y - half * (sin(turn) + cos(turn))};
        synth_add_rectangle(&scene, corner, 2 * half, 2 * half, turn, 60);
        uint8_t *pixels = unit_picture(&scene, 1, 2, (uint64_t)n);
        asj_line_segment *segments = find(f, pixels, 120, 124, &count);
        assert_int_equal(count, 4);
        for (size_t i = 0; i < count; i++) {
            const asj_line_segment *s = &segments[i];
            const double length = hypot(s->x2 - s->x1, s->y2 - s->y1), ux = (s->x2 - s->x1) / length, uy = (s->y2 - s->y1) / length;
            const double dx = 0.5 * (s->x1 + s->x2) - middle.x, dy = 0.5 * (s->y1 + s->y2) - middle.y;
            unit_near("length", n, (double)i, length, 2 * half, 4);
            unit_near("distance", n, (double)i, dy * ux - dx * uy, -half, 0.3); /* the dark middle on the right */
            unit_near("middle", n, (double)i, dx * ux + dy * uy, 0, 2);
            assert_true(s->log_nfa <= 0 && s->width > 0 && s->width < 8);
        }
        asj_release(&f->context->memory, segments);
        free(pixels);
    }
}

/* Noise has at most one segment an image on average, whatever its size. */
static void test_noise(void **state)
{
    const fixture *f = *state;
    static const struct {
        int32_t side, images;
        double sd;
    } rows[] = {{64, 60, 20}, {128, 30, 60}, {256, 12, 20}};
    for (size_t r = 0; r < UNIT_COUNT(rows); r++) {
        size_t total = 0;
        for (int32_t i = 0; i < rows[r].images; i++) {
            size_t count;
            uint8_t *pixels = synth_noise_image(rows[r].side, rows[r].side, 128, rows[r].sd, (uint64_t)i);
            asj_line_segment *segments = find(f, pixels, rows[r].side, rows[r].side, &count);
            total += count;
            asj_release(&f->context->memory, segments);
            free(pixels);
        }
        assert_true(total <= (size_t)rows[r].images);
    }
}

static void test_sizes(void **state)
{
    const fixture *f = *state;
    for (int32_t width = 1; width <= 9; width++)
        for (int32_t height = 1; height <= 9; height += width < 3 ? 1 : 3) {
            uint8_t pixels[81];
            size_t count = 7;
            for (int i = 0; i < 81; i++)
                pixels[i] = i % width < width / 2 ? 0 : 255;
            asj_line_segment *segments = find(f, pixels, width, height, &count);
            assert_true(count <= 1 && (count == 0) == (segments == NULL));
            if (count == 1)
                unit_near("x", width, height, segments->x1, width / 2 - 0.5, 1);
            asj_release(&f->context->memory, segments);
        }
    uint8_t *long_strip = calloc(3000, 4);
    size_t count;
    assert_non_null(long_strip);
    for (int i = 0; i < 3000; i++)
        long_strip[2 * 3000 + i] = long_strip[3 * 3000 + i] = 200;
    asj_line_segment *segments = find(f, long_strip, 3000, 4, &count);
    assert_int_equal(count, 1);
    asj_release(&f->context->memory, segments);
    free(long_strip);
}

/* Any allocation may fail; what was held is given back. */
static void test_memory(void **state)
{
    fixture *f = *state;
    synth_scene scene;
    synth_scene_init(&scene, 80, 60, 150);
    synth_add_rectangle(&scene, (synth_point){40, 30}, 30, 25, 0.3, 60);
    asj_frame frame;
    unit_frame_of(f->context, &scene, 1, 0, NULL, &frame);
    int reached = 1;
    long n = 1;
    for (; reached && n < 100; n++) {
        asj_line_segment *segments = (asj_line_segment *)f;
        size_t count = 1;
        const long live = f->counter.live;
        f->counter.fail_at = f->counter.calls + n;
        const asj_status status = asj_line_segments_find(f->context, &frame, ASJ_STAGE_CANDIDATES, 1, &segments, &count);
        reached = unit_reached(&f->counter);
        assert_true(status == ASJ_OK ? count == 4 : reached && status == ASJ_ERROR_MEMORY && !segments && count == 0);
        if (status != ASJ_OK)
            assert_int_equal(f->counter.live, live);
        else
            asj_release(&f->context->memory, segments);
    }
    assert_in_range(n, 6, 50);
    asj_frame_free(&f->context->memory, &frame);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tail),
        cmocka_unit_test(test_ramps),
        cmocka_unit_test(test_flat),
        cmocka_unit_test(test_asked_in_every_row),
        cmocka_unit_test(test_rectangle_count),
        cmocka_unit_test(test_region),
        cmocka_unit_test(test_cut),
        cmocka_unit_test(test_square),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_sizes),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
