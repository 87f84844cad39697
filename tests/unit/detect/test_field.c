/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 against a naive evaluation: strengths by trigonometry on the definition of the sectors, suppression, threshold,
 * interpolation, candidates. */
#include "detect/nfa.h"
#include "detect/field.h"
#include "unit_test.h"

typedef unit_fixture fixture;

static int set_up(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, 75, 60, 110);
    synth_add_rectangle(&scene, (synth_point){22.4, 14.2}, 31, 26, 0.35, 170);
    synth_add_rectangle(&scene, (synth_point){44.4, 34.2}, 60, 60, 0.1, 60);
    return unit_set_up_scene(state, &scene, 1, 4);
}

enum { MOST = ASJ_FIELD_MAX_SECTORS, MOST_RUNS = 3 * (2 * ASJ_FIELD_MAX_RADIUS + 1) };

/* z_k of all sectors of a pixel from the library's sums, which test_sector.c checks, in whole numbers of 1/256. */
static void strengths_at(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, int32_t z[MOST])
{
    const asj_sectors *s = &field->sectors;
    uint16_t gamma[MOST_RUNS * ASJ_SECTOR_RUN], prefix[ASJ_FIELD_MAX_OFFSETS + 1], sums[MOST];
    const ptrdiff_t at = y * frame->stride + x;
    assert_true(field->runs.count <= MOST_RUNS && s->offset_count <= ASJ_FIELD_MAX_OFFSETS);
    asj_sector_gammas(&field->runs, frame->gradient_x + at, frame->gradient_y + at, frame->stride, gamma);
    asj_sector_sums(s, field->place, gamma, prefix, sums);
    for (int32_t k = 0; k < s->count; k++)
        z[k] = asj_sector_strength(s, k, sums[k]);
}

/* Larger than all sectors within Delta before it, and no smaller than those after it. */
static int is_peak(const asj_field *field, const int32_t z[MOST], int32_t k)
{
    const int32_t count = field->sectors.count;
    const double delta = 2 * UNIT_PI * field->suppress / count + 1e-9;
    for (int32_t i = 0; i < count; i++) {
        const double ahead = remainder(2 * UNIT_PI * (i - k) / count, 2 * UNIT_PI);
        if (i != k && fabs(ahead) <= delta && (ahead < 0 ? z[i] >= z[k] : z[i] > z[k]))
            return 0;
    }
    return 1;
}

/* K F(omega; J) <= epsilon, with the sum that a strength stands for. */
static double log_local_nfa(const asj_field *field, int32_t k, double strength)
{
    const int32_t n = field->sectors.size[k];
    const double sum = n * ASJ_GAMMA_MEAN + strength / ASJ_STRENGTH_ONE * ASJ_GAMMA_SD * sqrt(n);
    return log(field->sectors.count) + asj_nfa_log_sector_tail(asj_nfa_tables(), sum, n);
}

static void make_field(fixture *f, asj_field *field)
{
    assert_int_equal(asj_field_create(f->context, &f->options, field), ASJ_OK);
}

/* The least strengths that are kept: one rounding step lower is above epsilon, two higher below it. */
static void test_threshold(void **state)
{
    static const double epsilons[] = {1e-6, 0.01, 1, 5};
    fixture *f = *state;
    for (int32_t radius = 3; radius <= 9; radius += 2)
        for (size_t e = 0; e < UNIT_COUNT(epsilons); e++) {
            asj_field field;
            f->options.field_radius = radius;
            f->options.field_epsilon = epsilons[e];
            make_field(f, &field);
            for (int32_t k = 0; k < field.sectors.count; k++) {
                assert_true(log_local_nfa(&field, k, field.keep[k] - 2) > log(epsilons[e]));
                assert_true(log_local_nfa(&field, k, field.keep[k] + 2) < log(epsilons[e]));
            }
            asj_field_free(&f->context->memory, &field);
        }
    f->options.field_epsilon = 100; /* more than sectors: everything above the mean is kept, and nothing below */
    f->options.field_radius = 3;
    asj_field field;
    make_field(f, &field);
    for (int32_t k = 0; k < field.sectors.count; k++)
        assert_int_equal(field.keep[k], 1);
    asj_field_free(&f->context->memory, &field);
    asj_detect_options_init(&f->options);
}

/* Documented geometry: suppression over Delta = tau / r, candidates' directions 0.35 rad from equal and from opposite. */
static void test_constants(void **state)
{
    fixture *f = *state;
    for (int32_t radius = 3; radius <= 9; radius += 2)
        for (double tau = 1; tau <= 3; tau += 0.5) {
            asj_field field;
            f->options.field_radius = radius;
            f->options.sector_width = tau;
            make_field(f, &field);
            const double step = 2 * UNIT_PI / field.sectors.count;
            unit_near("suppress", radius, tau, field.suppress * step, tau / radius, 0.5 * step);
            assert_true(field.suppress >= 1);
            assert_true(field.apart * step >= 0.35 && (field.apart - 1) * step < 0.35);
            asj_field_free(&f->context->memory, &field);
        }
    asj_detect_options_init(&f->options);
}

typedef struct branch {
    double angle;
    int32_t strength;
} branch;

static int by_strength(const void *a, const void *b)
{
    return ((const branch *)b)->strength - ((const branch *)a)->strength;
}

/* All kept maxima, strongest first, at the vertex of the parabola through the maximum and its neighbours. */
static int32_t naive_branches(const asj_field *field, const int32_t z[MOST], branch list[MOST])
{
    const int32_t count = field->sectors.count;
    int32_t found = 0;
    for (int32_t k = 0; k < count; k++) {
        const double before = z[(k + count - 1) % count], here = z[k], after = z[(k + 1) % count];
        if (z[k] >= field->keep[k] && is_peak(field, z, k))
            list[found++] = (branch){2 * UNIT_PI / count * (k + (after - before) / (2 * (2 * here - before - after))), z[k]};
    }
    qsort(list, (size_t)found, sizeof *list, by_strength);
    return found;
}

static void check_pixel(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, const asj_field_branch *got)
{
    int32_t z[MOST];
    branch expected[MOST];
    strengths_at(field, frame, x, y, z);
    int32_t count = naive_branches(field, z, expected);
    for (int32_t i = 0; i < ASJ_FIELD_BRANCHES; i++) {
        if (i >= count) {
            assert_int_equal(got[i].strength, 0);
            continue;
        }
        assert_int_equal(got[i].strength, expected[i].strength);
        int32_t match = -1;
        for (int32_t k = 0; k < count; k++) /* equal strengths may stand in either order */
            if (expected[k].strength == got[i].strength && unit_turn(expected[k].angle, got[i].angle * UNIT_PI / 32768) < 0.003)
                match = k;
        if (match < 0)
            fail_msg("(%d, %d): branch %d points to %g, expected %g", (int)x, (int)y, (int)i, got[i].angle * UNIT_PI / 32768,
                     expected[i].angle);
    }
}

static void test_branches(void **state)
{
    fixture *f = *state;
    for (int32_t radius = 3; radius <= 9; radius += 2) {
        asj_field field;
        f->options.field_radius = radius;
        f->options.field_epsilon = radius == 5 ? 50 : 1; /* many branches a pixel */
        make_field(f, &field);
        uint16_t *scratch = malloc(asj_field_scratch(&field) * sizeof *scratch);
        assert_non_null(scratch);
        for (int32_t y = 0; y < f->frame.height; y += 3)
            for (int32_t x = 0; x < f->frame.width; x++) {
                asj_field_branch found[ASJ_FIELD_BRANCHES];
                asj_field_pixel(&field, &f->frame, x, y, scratch, found);
                check_pixel(&field, &f->frame, x, y, found);
            }
        free(scratch);
        asj_field_free(&f->context->memory, &field);
    }
    asj_detect_options_init(&f->options);
}

/* Two maxima of at least `least` whose sectors are `apart` steps from equal and from opposite. */
static int naive_candidate(const asj_field *field, const int32_t z[MOST])
{
    const int32_t count = field->sectors.count;
    for (int32_t a = 0; a < count; a++)
        for (int32_t b = 0; b < count && z[a] >= field->candidate[a] && is_peak(field, z, a); b++) {
            const int32_t apart = abs(a - b), turn = apart > count - apart ? count - apart : apart;
            if (turn >= field->apart && turn <= count / 2 - field->apart && z[b] >= field->candidate[b] && is_peak(field, z, b))
                return 1;
        }
    return 0;
}

static void test_candidates(void **state)
{
    static const double strengths[] = {0, 2.5, 3.5};
    fixture *f = *state;
    uint16_t *masks = malloc((size_t)f->frame.blocks * (size_t)f->frame.height * sizeof *masks);
    int total = 0;
    assert_non_null(masks);
    for (int32_t radius = 3; radius <= 9; radius += 2)
        for (size_t s = 0; s < UNIT_COUNT(strengths); s++) {
            asj_field field;
            f->options.field_radius = radius;
            f->options.candidate_strength = strengths[s];
            f->options.candidate_step = s == 2 ? 1 : 2;
            make_field(f, &field);
            for (int32_t k = 0; k < field.sectors.count; k++)
                assert_int_equal(field.candidate[k], fmax(field.keep[k], strengths[s] * ASJ_STRENGTH_ONE));
            uint16_t *scratch = malloc(asj_field_scratch(&field) * sizeof *scratch);
            assert_non_null(scratch);
            const asj_tile whole = {0, f->frame.blocks, 0, f->frame.height};
            asj_field_tile(&field, &f->frame, &whole, scratch, masks);
            for (int32_t y = 0; y < f->frame.height; y += field.step)
                for (int32_t x = 0; x < f->frame.width; x += field.step) {
                    const int found = masks[y * f->frame.blocks + x / ASJ_LANES] >> x % ASJ_LANES & 1;
                    int32_t z[MOST];
                    strengths_at(&field, &f->frame, x, y, z);
                    if (naive_candidate(&field, z) != found)
                        fail_msg("(%d, %d), radius %d: candidate %d", (int)x, (int)y, (int)radius, found);
                    total += found;
                }
            free(scratch);
            asj_field_free(&f->context->memory, &field);
        }
    free(masks);
    assert_in_range(total, 100, 4000); /* there was something to compare */
    asj_detect_options_init(&f->options);
}

/* candidate_step 2: the candidates in even rows and columns. */
static void test_candidate_step(void **state)
{
    fixture *f = *state;
    asj_field field;
    const size_t count = (size_t)f->frame.blocks * (size_t)f->frame.height;
    uint16_t *all = malloc(count * sizeof *all), *thin = malloc(count * sizeof *thin), *scratch;
    int kept = 0, gone = 0;
    assert_true(all && thin);
    f->options.candidate_strength = 2;
    for (int32_t step = 1; step <= 2; step++) {
        f->options.candidate_step = step;
        make_field(f, &field);
        scratch = malloc(asj_field_scratch(&field) * sizeof *scratch);
        assert_non_null(scratch);
        const asj_tile whole = {0, f->frame.blocks, 0, f->frame.height};
        asj_field_tile(&field, &f->frame, &whole, scratch, step == 1 ? all : thin);
        free(scratch);
        asj_field_free(&f->context->memory, &field);
    }
    for (size_t i = 0; i < count; i++)
        for (int bit = 0; bit < ASJ_LANES; bit++) {
            const int here = all[i] >> bit & 1, expected = here && bit % 2 == 0 && i / (size_t)f->frame.blocks % 2 == 0;
            assert_int_equal(thin[i] >> bit & 1, expected);
            kept += expected;
            gone += here && !expected;
        }
    assert_true(kept > 20 && gone > 20);
    free(all);
    free(thin);
    asj_detect_options_init(&f->options);
}

/* A clean edge has its two branches along it, to a quarter of a sector step. */
static void test_edge_direction(void **state)
{
    fixture *f = *state;
    asj_field field;
    make_field(f, &field);
    uint16_t *scratch = malloc(asj_field_scratch(&field) * sizeof *scratch);
    assert_non_null(scratch);
    const double step = 2 * UNIT_PI / field.sectors.count;
    for (int n = 0; n < 36; n++) {
        const double angle = 0.02 + n * UNIT_PI / 36;
        synth_scene scene;
        asj_frame frame;
        asj_field_branch found[ASJ_FIELD_BRANCHES];
        unit_half_plane(&scene, 65, (synth_point){32, 32}, angle, 90, 150);
        unit_frame_of(f->context, &scene, 1, 0, NULL, &frame);
        asj_field_pixel(&field, &frame, 32, 32, scratch, found);
        for (int i = 0; i < 2; i++) {
            assert_true(found[i].strength > 5 * ASJ_STRENGTH_ONE);
            unit_near("direction", n, i, unit_turn(2 * angle, found[i].angle * UNIT_PI / 16384) / 2, 0, 0.5 * step);
        }
        assert_true(unit_turn(found[0].angle * UNIT_PI / 32768, found[1].angle * UNIT_PI / 32768) > 3);
        asj_frame_free(&f->context->memory, &frame);
    }
    free(scratch);
    asj_field_free(&f->context->memory, &field);
}

/* The public function gives the same branches in radians, standard deviations and log10 NFA, for any width. */
static void test_public(void **state)
{
    static const int32_t sizes[][2] = {{75, 60}, {1, 1}, {16, 2}, {17, 3}, {1, 40}};
    fixture *f = *state;
    asj_field field;
    make_field(f, &field);
    uint16_t *scratch = malloc(asj_field_scratch(&field) * sizeof *scratch);
    assert_non_null(scratch);
    for (size_t n = 0; n < UNIT_COUNT(sizes); n++) {
        const int32_t width = sizes[n][0], height = sizes[n][1];
        synth_scene scene;
        asj_frame frame;
        synth_scene_init(&scene, width, height, 110);
        synth_add_rectangle(&scene, (synth_point){8.4, 0.2}, 31, 26, 0.35, 170);
        uint8_t *pixels = unit_picture(&scene, 1, 6, 4);
        const asj_image image = unit_gray8(pixels, width, height);
        asj_local_branch *all = calloc((size_t)(width * height) * ASJ_FIELD_BRANCHES, sizeof *all);
        assert_non_null(all);
        asj_detect_options options; /* larger octaves are none of its */
        asj_detect_options_init(&options);
        options.first_octave = n % 2 ? 0 : -1;
        assert_int_equal(asj_local_field(f->context, &image, &options, all), ASJ_OK);
        unit_frame(f->context, &image, NULL, &frame);
        for (int32_t i = 0; i < width * height; i++) {
            asj_field_branch found[ASJ_FIELD_BRANCHES];
            asj_field_pixel(&field, &frame, i % width, i / width, scratch, found);
            for (int32_t b = 0; b < ASJ_FIELD_BRANCHES; b++) {
                const asj_field_branch expected = found[b];
                const asj_local_branch got = all[i * ASJ_FIELD_BRANCHES + b];
                unit_near("strength", i, b, got.strength, expected.strength / (double)ASJ_STRENGTH_ONE, 1e-5);
                unit_near("angle", i, b, got.angle, expected.strength ? expected.angle * UNIT_PI / 32768 : 0, 1e-5);
                assert_true(got.angle >= 0 && (double)got.angle < 2 * UNIT_PI);
                if (expected.strength) { /* the sector nearest to the angle; J of its neighbour may differ */
                    const int32_t k = (int32_t)lrint(expected.angle * field.sectors.count / 65536.0) % field.sectors.count;
                    unit_near("log10 NFA", i, b, got.log10_nfa, log_local_nfa(&field, k, expected.strength) / log(10), 1e-4);
                    assert_true(got.log10_nfa <= 0.05f);
                }
            }
        }
        asj_frame_free(&f->context->memory, &frame);
        free(all);
        free(pixels);
    }
    free(scratch);
    asj_field_free(&f->context->memory, &field);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_threshold),  cmocka_unit_test(test_constants),      cmocka_unit_test(test_branches),
        cmocka_unit_test(test_candidates), cmocka_unit_test(test_candidate_step), cmocka_unit_test(test_edge_direction),
        cmocka_unit_test(test_public),
    };
    return cmocka_run_group_tests(tests, set_up, unit_tear_down);
}
