/* SPDX-License-Identifier: BSD-2-Clause */
/* Sectors: geometry against the definition and the check values of the design, sums and strengths against trigonometry. */
#include "detect/sector_runs.h"
#include "detect/nfa.h"
#include "unit_test.h"

static double sector_angle(const asj_sectors *s, int32_t k)
{
    return 2 * UNIT_PI * k / s->count;
}

/* The definition: 0 < |o| <= r and d_2pi(alpha(o), theta_k) <= tau / r, ties in. */
static int inside(int32_t dx, int32_t dy, int32_t radius, double theta, double tau)
{
    const int32_t squared = dx * dx + dy * dy;
    return squared > 0 && squared <= radius * radius && unit_turn(atan2(dy, dx), theta) <= tau / radius + 1e-5;
}

static int32_t naive_size(const asj_sectors *s, int32_t k, double tau)
{
    int32_t count = 0;
    for (int32_t dy = -s->radius; dy <= s->radius; dy++)
        for (int32_t dx = -s->radius; dx <= s->radius; dx++)
            count += inside(dx, dy, s->radius, sector_angle(s, k), tau);
    return count;
}

static void make(unit_counter *counter, asj_memory *memory, int32_t radius, double tau, asj_sectors *s)
{
    memset(counter, 0, sizeof *counter);
    *memory = unit_memory(counter);
    assert_int_equal(asj_sectors_create(memory, radius, tau, s), ASJ_OK);
}

static void drop(const unit_counter *counter, asj_memory *memory, asj_sectors *s)
{
    asj_sectors_free(memory, s);
    assert_int_equal(counter->live, 0);
    assert_true(memory->now == 0);
}

/* Check values for tau = 2 (algorithm, section 4). */
static void test_check_values(void **state)
{
    static const struct {
        int32_t radius, count, offsets, least, most, first[5];
        double mean;
    } rows[] = {
        {3, 18, 28, 4, 7, {5, 6, 4, 7, 7}, 5.889},          {5, 31, 80, 9, 12, {9, 10, 9, 11, 11}, 10.161},
        {7, 43, 148, 10, 17, {13, 13, 10, 13, 14}, 13.558}, {9, 56, 252, 12, 19, {17, 18, 12, 18, 18}, 16.786},
        {12, 75, 440, 18, 29, {24, 24, 18, 23, 23}, 23.28},
    };
    (void)state;
    for (size_t i = 0; i < UNIT_COUNT(rows); i++) {
        unit_counter counter;
        asj_memory memory;
        asj_sectors s;
        int32_t least = INT32_MAX, most = 0, sum = 0;
        make(&counter, &memory, rows[i].radius, 2, &s);
        assert_int_equal(s.count, rows[i].count);
        assert_int_equal(s.offset_count, rows[i].offsets);
        for (int32_t k = 0; k < s.count; k++) {
            least = s.size[k] < least ? s.size[k] : least;
            most = s.size[k] > most ? s.size[k] : most;
            sum += s.size[k];
        }
        assert_int_equal(least, rows[i].least);
        assert_int_equal(most, rows[i].most);
        assert_int_equal(s.largest, rows[i].most);
        unit_near("mean J", rows[i].radius, 2, (double)sum / s.count, rows[i].mean, 6e-4);
        for (int32_t k = 0; k < 5; k++)
            assert_int_equal(s.size[k], rows[i].first[k]);
        drop(&counter, &memory, &s);
    }
}

/* Each run of offsets is the set of the definition, for all radii and widths that options allow. */
static void test_members(void **state)
{
    static const double widths[] = {1, 1.5, 2, 2.71, 3};
    (void)state;
    for (int32_t radius = 3; radius <= 30; radius++)
        for (size_t w = 0; w < UNIT_COUNT(widths); w++) {
            unit_counter counter;
            asj_memory memory;
            asj_sectors s;
            make(&counter, &memory, radius, widths[w], &s);
            assert_int_equal(s.count, (int32_t)floor(2 * UNIT_PI * radius));
            for (int32_t k = 0; k < s.count; k++) {
                if (s.size[k] != naive_size(&s, k, widths[w]))
                    fail_msg("radius %d, tau %g, sector %d holds %d pixels", (int)radius, widths[w], (int)k, (int)s.size[k]);
                for (int32_t i = 0; i < s.size[k]; i++) {
                    const int32_t o = (s.first[k] + i) % s.offset_count;
                    if (!inside(s.dx[o], s.dy[o], radius, sector_angle(&s, k), widths[w]))
                        fail_msg("radius %d: (%d, %d) is not in sector %d", (int)radius, s.dx[o], s.dy[o], (int)k);
                }
            }
            drop(&counter, &memory, &s);
        }
}

/* Offsets are distinct, and the unit vectors are those of their offsets to half a unit. */
static void test_offsets(void **state)
{
    (void)state;
    for (int32_t radius = 3; radius <= 30; radius++) {
        unit_counter counter;
        asj_memory memory;
        asj_sectors s;
        uint8_t seen[61][61] = {{0}};
        make(&counter, &memory, radius, 2, &s);
        const double one = (double)(1 << (s.gamma_bits + 6));
        for (int32_t i = 0; i < s.offset_count; i++) {
            const double length = hypot(s.dx[i], s.dy[i]);
            assert_false(seen[s.dy[i] + 30][s.dx[i] + 30]++);
            unit_near("ux", s.dx[i], s.dy[i], s.ux[i], one * s.dx[i] / length, 1);
            unit_near("uy", s.dx[i], s.dy[i], s.uy[i], one * s.dy[i] / length, 1);
        }
        drop(&counter, &memory, &s);
    }
}

/* The widths of the numbers: no sector's sum leaves 16 bits at the largest gradient, strengths stay below 2^15 (they are compared
 * as signed numbers), and the tail tables of the isotropic test have an entry for each number of pixels. */
static void test_ranges(void **state)
{
    static const double widths[] = {1, 2, 3};
    (void)state;
    for (int32_t radius = 3; radius <= 30; radius++)
        for (size_t w = 0; w < UNIT_COUNT(widths); w++) {
            unit_counter counter;
            asj_memory memory;
            asj_sectors s;
            make(&counter, &memory, radius, widths[w], &s);
            const double largest = 1.01 * ASJ_GRADIENT_LIMIT * (1 << s.gamma_bits) + 2;
            assert_true(s.largest * largest < 65536);
            assert_in_range(s.largest, 1, 127);
            for (int32_t k = 0; k < s.count; k++) {
                assert_true(s.size[k] >= 1);
                assert_true(asj_sector_strength(&s, k, (uint16_t)(s.size[k] * largest)) < 32768);
            }
            drop(&counter, &memory, &s);
        }
}

/* ---- sums ---- */

static double naive_sum(const asj_frame *frame, int32_t x, int32_t y, const asj_sectors *s, int32_t k, double tau)
{
    double sum = 0;
    for (int32_t dy = -s->radius; dy <= s->radius; dy++)
        for (int32_t dx = -s->radius; dx <= s->radius; dx++)
            if (inside(dx, dy, s->radius, sector_angle(s, k), tau))
                sum += unit_gamma(unit_gx(frame, x + dx, y + dy), unit_gy(frame, x + dx, y + dy), atan2(dy, dx));
    return sum;
}

static double naive_strength(double sum, int32_t pixels)
{
    return fmax(0, (sum - pixels * ASJ_GAMMA_MEAN) / (ASJ_GAMMA_SD * sqrt(pixels)));
}

enum { MOST = 188 }; /* floor(2 pi 30) */

/* Sectors with their offsets in runs. */
typedef struct disc {
    asj_memory *memory;
    const asj_sectors *sectors;
    asj_sector_runs runs;
    int16_t *place;
} disc;

static disc open_disc(asj_memory *memory, const asj_sectors *s)
{
    disc d = {memory, s, {0}, malloc((size_t)s->offset_count * sizeof(int16_t))};
    assert_non_null(d.place);
    assert_int_equal(asj_sector_runs_create(memory, s, &d.runs), ASJ_OK);
    asj_sector_runs_places(&d.runs, s, d.place);
    return d;
}

static void close_disc(disc *d)
{
    asj_sector_runs_free(d->memory, &d->runs);
    free(d->place);
}

/* The library's sums of all sectors at a pixel. */
static void sums_at(const disc *d, const int16_t *gx, const int16_t *gy, ptrdiff_t stride, uint16_t *sums)
{
    uint16_t *gamma = malloc((size_t)d->runs.count * ASJ_SECTOR_RUN * sizeof *gamma);
    uint16_t *prefix = malloc(((size_t)d->sectors->offset_count + 1) * sizeof *prefix);
    assert_true(gamma && prefix);
    asj_sector_gammas(&d->runs, gx, gy, stride, gamma);
    asj_sector_sums(d->sectors, d->place, gamma, prefix, sums);
    free(prefix);
    free(gamma);
}

/* Each gamma may be off by two units, each strength by its rounding to 1/256 too. */
static void check_pixel(const asj_frame *frame, int32_t x, int32_t y, const disc *d, double tau)
{
    uint16_t sums[MOST];
    const asj_sectors *s = d->sectors;
    const ptrdiff_t at = y * frame->stride + x;
    const double unit = 1.0 / (1 << s->gamma_bits);
    sums_at(d, frame->gradient_x + at, frame->gradient_y + at, frame->stride, sums);
    for (int32_t k = 0; k < s->count; k++) {
        const double expected = naive_sum(frame, x, y, s, k, tau), error = 2.1 * unit * s->size[k];
        unit_near("sum", x, k, sums[k] * unit, expected, error);
        unit_near("strength", x, k, asj_sector_strength(s, k, sums[k]) / (double)ASJ_STRENGTH_ONE,
                  naive_strength(expected, s->size[k]), error / (ASJ_GAMMA_SD * sqrt(s->size[k])) + 2.0 / ASJ_STRENGTH_ONE);
    }
}

/* Also where the sector reaches outside the image: the gradient is zero there and J is not changed. */
static void test_sums(void **state)
{
    static const int32_t radii[] = {3, 5, 7, 9, 14, 30};
    static const double widths[] = {1, 2, 3};
    static const int32_t places[][2] = {{0, 0}, {32, 0}, {48, 30}, {0, 69}, {16, 35}};
    unit_counter counter, sector_counter;
    asj_context *context = unit_context(&counter, 1);
    synth_scene scene;
    asj_frame frame;
    (void)state;
    synth_scene_init(&scene, 60, 70, 120);
    synth_add_rectangle(&scene, (synth_point){20.3, 24.8}, 25, 40, 0.3, 60);
    synth_add_rectangle(&scene, (synth_point){-5, -5}, 12, 60, 0, 200);
    unit_frame_of(context, &scene, 0.8, 3, NULL, &frame);
    for (size_t r = 0; r < UNIT_COUNT(radii); r++)
        for (size_t w = 0; w < UNIT_COUNT(widths); w++) {
            asj_memory memory;
            asj_sectors s;
            make(&sector_counter, &memory, radii[r], widths[w], &s);
            disc d = open_disc(&memory, &s);
            for (size_t p = 0; p < UNIT_COUNT(places); p++)
                for (int32_t x = places[p][0]; (radii[r] < 30 || p == 4) && x < places[p][0] + 16 && x < frame.width; x++)
                    check_pixel(&frame, x, places[p][1], &d, widths[w]);
            close_disc(&d);
            drop(&sector_counter, &memory, &s);
        }
    asj_frame_free(&context->memory, &frame);
    unit_context_free(&counter, &context);
}

/* The largest gradient everywhere, in every direction: sums as large as they get, and no wrap-around. */
static void test_saturation(void **state)
{
    enum { SIDE = 96, SIZE = SIDE * SIDE };
    static int16_t gx[SIZE], gy[SIZE];
    const int32_t largest = (int32_t)(1.005 * ASJ_GRADIENT_LIMIT * ASJ_GRADIENT_ONE);
    (void)state;
    for (int32_t radius = 3; radius <= 30; radius += 3) {
        unit_counter counter;
        asj_memory memory;
        asj_sectors s;
        make(&counter, &memory, radius, 3, &s);
        uint16_t sums[MOST];
        for (int32_t i = 0; i < SIZE; i++) { /* across the line to the centre: gamma is |g| */
            const int32_t dx = i % SIDE - 40, dy = i / SIDE - 40;
            const double length = dx || dy ? hypot(dx, dy) : 1;
            gx[i] = (int16_t)lrint(-largest * dy / length);
            gy[i] = (int16_t)lrint(largest * dx / length);
        }
        disc d = open_disc(&memory, &s);
        sums_at(&d, gx + 40 * SIDE + 40, gy + 40 * SIDE + 40, SIDE, sums);
        close_disc(&d);
        for (int32_t k = 0; k < s.count; k++)
            unit_near("largest sum", radius, k, (double)sums[k] / (1 << s.gamma_bits),
                      s.size[k] * (double)largest / ASJ_GRADIENT_ONE, s.size[k] * 2.1 / (1 << s.gamma_bits));
        drop(&counter, &memory, &s);
    }
}

/* ---- strength of a clean edge (algorithm, 5.1) ---- */

typedef struct edge {
    double blur, noise, contrast, strength[5]; /* strength for r = 3, 5, 7, 9, 12 */
} edge;

/* The stronger of the two sectors that hold the edge, looking either way, at the middle of an edge through the centre of a pixel.
 * The profile is the error function at the pixels' centres. */
static double edge_strength(asj_context *context, const asj_sectors *s, double angle, const edge *row)
{
    enum { SIZE = 81, MIDDLE = 40 };
    asj_detect_options options;
    asj_frame frame;
    uint16_t best = 0;
    static double levels[SIZE * SIZE];
    static uint8_t pixels[SIZE * SIZE];
    asj_detect_options_init(&options);
    options.gradient_epsilon = 0.3;
    for (int32_t y = 0; y < SIZE; y++)
        for (int32_t x = 0; x < SIZE; x++) {
            const double across = (x - MIDDLE) * sin(angle) - (y - MIDDLE) * cos(angle);
            levels[y * SIZE + x] = 120 + 0.5 * row->contrast * erf(across / (sqrt(2) * row->blur));
        }
    synth_add_noise(levels, SIZE * SIZE, row->noise, (uint64_t)(1000 * angle));
    synth_to_gray8(levels, SIZE * SIZE, pixels);
    const asj_image image = unit_gray8(pixels, SIZE, SIZE);
    unit_frame(context, &image, &options, &frame);
    const ptrdiff_t at = MIDDLE * frame.stride + MIDDLE;
    uint16_t sums[MOST];
    disc d = open_disc(&context->memory, s);
    sums_at(&d, frame.gradient_x + at, frame.gradient_y + at, frame.stride, sums);
    close_disc(&d);
    for (int32_t k = 0; k < s->count; k++) {
        const uint16_t strength = asj_sector_strength(s, k, sums[k]);
        if (unit_turn(2 * sector_angle(s, k), 2 * angle) <= 2 * 2.0 / s->radius && strength > best)
            best = strength;
    }
    asj_frame_free(&context->memory, &frame);
    return best / (double)ASJ_STRENGTH_ONE;
}

/* Mean over orientations, within the 0.3 that the table states. Its weakest row, which is mostly noise, hangs on which of the two
 * sectors is looked at, and the table does not say. */
static void test_clean_edge(void **state)
{
    static const edge rows[] = {
        {0.6, 0, 100, {5.5, 8.6, 10.7, 12.7, 15.1}}, {1.0, 0, 100, {4.3, 7.2, 9.1, 11.0, 13.1}},
        {1.5, 0, 100, {3.4, 6.0, 7.8, 9.3, 11.3}},   {1.0, 10, 100, {4.0, 5.9, 7.2, 8.4, 9.7}},
    };
    static const int32_t radii[] = {3, 5, 7, 9, 12};
    enum { ORIENTATIONS = 90 };
    unit_counter counter, sector_counter;
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (size_t r = 0; r < UNIT_COUNT(radii); r++) {
        asj_memory memory;
        asj_sectors s;
        make(&sector_counter, &memory, radii[r], 2, &s);
        for (size_t i = 0; i < UNIT_COUNT(rows); i++) {
            double sum = 0;
            for (int n = 0; n < ORIENTATIONS; n++)
                sum += edge_strength(context, &s, 2 * UNIT_PI * n / ORIENTATIONS, &rows[i]);
            unit_near("strength of an edge", radii[r], (double)i, sum / ORIENTATIONS, rows[i].strength[r], 0.3);
        }
        drop(&sector_counter, &memory, &s);
    }
    unit_context_free(&counter, &context);
}

static void test_out_of_memory(void **state)
{
    (void)state;
    for (long fail_at = 1; fail_at <= 2; fail_at++) {
        unit_counter counter = {0, 0, fail_at, 0};
        asj_memory memory = unit_memory(&counter);
        asj_sectors s;
        assert_int_equal(asj_sectors_create(&memory, 7, 2, &s), ASJ_ERROR_MEMORY);
        asj_sectors_free(&memory, &s);
        assert_int_equal(counter.live, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_check_values), cmocka_unit_test(test_members),    cmocka_unit_test(test_offsets),
        cmocka_unit_test(test_ranges),       cmocka_unit_test(test_sums),       cmocka_unit_test(test_saturation),
        cmocka_unit_test(test_clean_edge),   cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
