/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3: the NFA of isotropic junctions and the thinning, against their definitions. */
#include "detect/nfa.h"
#include "detect/isotropic_thin.h"
#include "unit_test.h"

typedef unit_fixture fixture;

static asj_isotropic tested;

static int set_up(void **state)
{
    synth_scene scene;
    synth_scene_init(&scene, 90, 80, 110);
    synth_add_rectangle(&scene, (synth_point){22.4, 14.2}, 41, 36, 0.35, 170);
    synth_add_rectangle(&scene, (synth_point){44.4, 34.2}, 60, 60, 0.1, 60);
    return unit_set_up_scene(state, &scene, 1, 3);
}

static int tear_down(void **state)
{
    const fixture *f = *state;
    asj_isotropic_free(&f->context->memory, &tested);
    return unit_tear_down(state);
}

static void make(fixture *f, uint32_t radii, int32_t max_branches)
{
    asj_isotropic_free(&f->context->memory, &tested);
    f->options.isotropic_radii = radii;
    f->options.max_branches = max_branches;
    assert_int_equal(asj_isotropic_create(f->context, &f->options, &tested), ASJ_OK);
    asj_isotropic_set_size(&f->options, f->frame.width, f->frame.height, f->frame.octaves, &tested);
}

/* ---- the definition ---- */

enum { MOST = 188 };

typedef struct peak {
    int32_t sector;
    double omega;
} peak;

static int by_omega(const void *a, const void *b)
{
    const double p = ((const peak *)a)->omega, q = ((const peak *)b)->omega;
    return p < q ? 1 : p > q ? -1 : ((const peak *)a)->sector - ((const peak *)b)->sector;
}

/* Maxima of z over Delta with z > 1, by junction-ness. */
static int32_t naive_peaks(const asj_frame *frame, const asj_isotropic_radius *entry, double tau, int32_t x, int32_t y,
                           peak peaks[MOST])
{
    const asj_sectors *s = &entry->sectors;
    const asj_sector_runs *runs = &tested.radii[entry->source].runs;
    uint16_t *gamma = malloc((size_t)runs->count * ASJ_SECTOR_RUN * sizeof *gamma);
    uint16_t *prefix = malloc(((size_t)s->offset_count + 1) * sizeof *prefix), sums[MOST];
    int32_t z[MOST], found = 0;
    assert_true(gamma && prefix);
    const ptrdiff_t at = y * frame->stride + x;
    asj_sector_gammas(runs, frame->gradient_x + at, frame->gradient_y + at, frame->stride, gamma);
    asj_sector_sums(s, entry->place, gamma, prefix, sums);
    const int32_t window = (int32_t)lrint(tau / s->radius * s->count / (2 * UNIT_PI));
    for (int32_t k = 0; k < s->count; k++)
        z[k] = asj_sector_strength(s, k, sums[k]);
    for (int32_t k = 0; k < s->count; k++) {
        int largest = z[k] > ASJ_STRENGTH_ONE;
        for (int32_t d = 1; d <= window; d++)
            largest &= z[k] > z[(k - d + s->count) % s->count] && z[k] >= z[(k + d) % s->count];
        if (largest)
            peaks[found++] = (peak){k, (double)sums[k] / (1 << s->gamma_bits)};
    }
    qsort(peaks, (size_t)found, sizeof *peaks, by_omega);
    free(prefix);
    free(gamma);
    return found;
}

/* ln NFA = ln #J(M) + sum of ln F(t; J_i), t the least omega. */
static double naive_nfa(const fixture *f, const asj_sectors *s, const peak *peaks, int32_t m)
{
    double log_nfa = asj_nfa_log_junction_tests(f->frame.width, f->frame.height, f->options.isotropic_radii,
                                                f->options.sector_width, m);
    for (int32_t i = 0; i < m; i++)
        log_nfa += asj_nfa_log_sector_tail(asj_nfa_tables(), peaks[m - 1].omega, s->size[peaks[i].sector]);
    return log_nfa;
}

static double sector_opening(const asj_sectors *s, const peak *peaks)
{
    return unit_turn(2 * UNIT_PI * peaks[0].sector / s->count, 2 * UNIT_PI * peaks[1].sector / s->count);
}

typedef struct best {
    double log_nfa;
    int32_t radius, branches;
} best;

static best naive_best(const fixture *f, int32_t x, int32_t y)
{
    best found = {HUGE_VAL, 0, 0};
    for (int32_t r = 0; r < tested.radius_count; r++) {
        const asj_sectors *s = &tested.radii[r].sectors;
        peak peaks[MOST];
        const int32_t count = naive_peaks(&f->frame, &tested.radii[r], f->options.sector_width, x, y, peaks);
        for (int32_t m = 2; m <= count && m <= f->options.max_branches; m++) {
            const double log_nfa = naive_nfa(f, s, peaks, m);
            const int edge = m == 2 && sector_opening(s, peaks) > UNIT_PI - 2 * f->options.sector_width / s->radius + 1e-9;
            if (!edge && log_nfa < found.log_nfa)
                found = (best){log_nfa, s->radius, m};
        }
    }
    return found;
}

/* 0.01 for each branch is what the tables of tails may be off. */
static void check_junction(const fixture *f, const asj_isotropic_junction *got, int32_t x, int32_t y)
{
    const best expected = naive_best(f, x, y);
    assert_int_equal(got->x, x);
    assert_int_equal(got->y, y);
    if (!got->branch_count) {
        if (expected.log_nfa < log(f->options.epsilon) - 0.01 * expected.branches)
            fail_msg("(%d, %d): missed, ln NFA %g", (int)x, (int)y, expected.log_nfa);
        return;
    }
    unit_near("ln NFA", x, y, got->log_nfa, expected.log_nfa, 0.01 * fmax(got->branch_count, expected.branches));
    assert_true(got->log_nfa <= log(f->options.epsilon));
    for (int32_t r = 0; r < tested.radius_count; r++) {
        const asj_sectors *s = &tested.radii[r].sectors;
        peak peaks[MOST];
        if (s->radius != got->radius)
            continue;
        const int32_t count = naive_peaks(&f->frame, &tested.radii[r], f->options.sector_width, x, y, peaks);
        assert_true(got->branch_count <= count);
        unit_near("ln NFA as stated", x, y, got->log_nfa, naive_nfa(f, s, peaks, got->branch_count), 0.01 * got->branch_count);
        for (int32_t i = 0; i < got->branch_count; i++) {
            int32_t match = 0;
            for (int32_t k = 0; k < got->branch_count; k++)
                match += unit_turn(got->angle[i] * UNIT_PI / 32768, 2 * UNIT_PI * peaks[k].sector / s->count) < 1e-3;
            if (match != 1 && peaks[got->branch_count - 1].omega > peaks[got->branch_count % count].omega)
                fail_msg("(%d, %d): branch %d is not one of the strongest", (int)x, (int)y, (int)i);
        }
        return;
    }
    fail_msg("radius %d is not tested", got->radius);
}

static int every_other(int32_t x, int32_t y)
{
    return (x + y) % 2;
}

static void check_image(fixture *f, int *meaningful, int *rejected)
{
    uint16_t *scratch = malloc(tested.scratch * sizeof *scratch);
    assert_non_null(scratch);
    for (int32_t y = 1; y < f->frame.height; y += 3)
        for (int32_t x = 0; x < f->frame.width; x++)
            if (every_other(x, y)) {
                asj_isotropic_junction found;
                memset(&found, 0x77, sizeof found);
                asj_isotropic_pixel(&tested, &f->frame, x, y, scratch, &found);
                check_junction(f, &found, x, y);
                *(found.branch_count ? meaningful : rejected) += 1;
            }
    free(scratch);
}

static void test_nfa(void **state)
{
    static const struct {
        uint32_t radii;
        int32_t branches;
        double epsilon;
    } settings[] = {{1u << 5 | 1u << 7 | 1u << 10 | 1u << 14, 5, 1}, {1u << 3 | 1u << 4, 3, 1e-3}, {1u << 9, 2, 100},
                    {1u << 30, 4, 1}};
    fixture *f = *state;
    for (size_t i = 0; i < UNIT_COUNT(settings); i++) {
        int meaningful = 0, rejected = 0;
        f->options.epsilon = settings[i].epsilon;
        make(f, settings[i].radii, settings[i].branches);
        check_image(f, &meaningful, &rejected);
        assert_true(i == 1 || meaningful > 20);
        assert_true(rejected > 20);
    }
    asj_detect_options_init(&f->options);
}

static int has_branch(const asj_isotropic_junction *junction, const asj_sectors *s, int32_t sector)
{
    int found = 0;
    for (int32_t i = 0; i < junction->branch_count; i++)
        found += unit_turn(junction->angle[i] * UNIT_PI / 32768, 2 * UNIT_PI * sector / s->count) < 1e-3;
    return found;
}

/* all_meaningful_branches: of the five strongest branches those with #J(2) F(omega; J)^2 <= epsilon, unless they make no junction.
 * Returns 1 when they are others than the most meaningful ones. Tables of tails are good to 0.01. */
static int check_all_meaningful(const fixture *f, const asj_isotropic_junction *most, const asj_isotropic_junction *all)
{
    const asj_sectors *s = &tested.radii[0].sectors;
    const double tests = asj_nfa_log_junction_tests(f->frame.width, f->frame.height, f->options.isotropic_radii,
                                                    f->options.sector_width, 2);
    peak peaks[MOST], alone[5];
    const int32_t found = naive_peaks(&f->frame, &tested.radii[0], f->options.sector_width, all->x, all->y, peaks);
    int32_t count = 0;
    assert_true(all->radius == most->radius && all->log_nfa == most->log_nfa);
    for (int32_t i = 0; i < found && i < 5; i++) {
        const double log_tail = asj_nfa_log_sector_tail(asj_nfa_tables(), peaks[i].omega, s->size[peaks[i].sector]);
        const double log_nfa = tests + 2 * log_tail - log(f->options.epsilon);
        if (fabs(log_nfa) < 0.02)
            return 0;
        if (log_nfa < 0)
            alone[count++] = peaks[i];
    }
    if (count < 2 || (count == 2 && sector_opening(s, alone) > UNIT_PI - 2 * f->options.sector_width / s->radius + 1e-9)) {
        assert_memory_equal(all, most, sizeof *all);
        return 0;
    }
    assert_int_equal(all->branch_count, count);
    for (int32_t i = 0; i < count; i++)
        assert_int_equal(has_branch(all, s, alone[i].sector), 1);
    return memcmp(all, most, sizeof *all) != 0;
}

static void test_all_meaningful(void **state)
{
    enum { COLUMNS = 80, ROWS = 80 };
    static asj_isotropic_junction found[2][ROWS][COLUMNS];
    fixture *f = *state;
    int others = 0, more = 0;
    assert_true(f->frame.width >= COLUMNS && f->frame.height == ROWS);
    f->options.epsilon = 1e4; /* weak branches too */
    for (int32_t all = 0; all < 2; all++) {
        f->options.all_meaningful_branches = all;
        make(f, 1u << 6, 5);
        uint16_t *scratch = malloc(tested.scratch * sizeof *scratch);
        assert_non_null(scratch);
        for (int32_t y = 0; y < ROWS; y++)
            for (int32_t x = 0; x < COLUMNS; x++)
                asj_isotropic_pixel(&tested, &f->frame, x, y, scratch, &found[all][y][x]);
        free(scratch);
    }
    for (int32_t y = 0; y < ROWS; y++)
        for (int32_t x = 0; x < COLUMNS; x++)
            if (found[0][y][x].branch_count && check_all_meaningful(f, &found[0][y][x], &found[1][y][x])) {
                others++;
                more += found[1][y][x].branch_count > found[0][y][x].branch_count;
            }
    assert_true(more > 10 && others > more);
    asj_detect_options_init(&f->options);
}

/* Bands of rows at once: the records of their runs one after the other. */
static void test_band(void **state)
{
    enum { ROWS = 3 };
    fixture *f = *state;
    make(f, 1u << 5 | 1u << 7 | 1u << 10 | 1u << 14, 5);
    const int32_t blocks = f->frame.blocks, last = f->frame.width - (blocks - 1) * ASJ_LANES;
    asj_isotropic_junction *band = malloc((ROWS * (size_t)f->frame.width + 1) * sizeof *band);
    uint16_t *masks = malloc((size_t)blocks * (size_t)f->frame.height * sizeof *masks);
    uint16_t *scratch = malloc(tested.scratch * sizeof *scratch);
    assert_true(band && masks && scratch);
    for (int32_t y = 0; y < f->frame.height; y++)
        for (int32_t b = 0; b < blocks; b++) { /* full, empty and sparse runs; none beyond the image */
            const int kind = (b + y) % 4;
            const uint32_t mask = kind == 0 ? 0xffff : kind == 1 ? 0 : 0x5155;
            masks[y * blocks + b] = (uint16_t)(b == blocks - 1 ? mask & ((1u << last) - 1) : mask);
        }
    for (int32_t top = 0; top + ROWS <= f->frame.height; top += 7) {
        int32_t at = 0;
        memset(band, 0x77, (ROWS * (size_t)f->frame.width + 1) * sizeof *band);
        asj_isotropic_band(&tested, &f->frame, top, top + ROWS, masks, scratch, band);
        for (int32_t y = top; y < top + ROWS; y++)
            for (int32_t x = 0; x < f->frame.width; x++)
                if (masks[y * blocks + x / ASJ_LANES] >> x % ASJ_LANES & 1) {
                    asj_isotropic_junction alone;
                    asj_isotropic_pixel(&tested, &f->frame, x, y, scratch, &alone);
                    assert_memory_equal(&band[at++], &alone, sizeof alone);
                }
        assert_int_equal(band[at].x, 0x7777);
    }
    free(band);
    free(masks);
    free(scratch);
}

/* All radii at once, as the options allow. */
static void test_tables(void **state)
{
    static const double widths[] = {1, 2, 3};
    fixture *f = *state;
    for (size_t w = 0; w < UNIT_COUNT(widths); w++) {
        f->options.sector_width = widths[w];
        make(f, 0x7ffffff8u, 5);
        assert_int_equal(tested.radius_count, 28);
        for (int32_t r = 0; r < 28; r++)
            assert_int_equal(tested.radii[r].sectors.radius, r + 3);
        for (int32_t m = 2; m <= 5; m++)
            assert_true(tested.log_tests[m] == asj_nfa_log_junction_tests(90, 80, 0x7ffffff8u, widths[w], m));
    }
    asj_detect_options_init(&f->options);
}

static void test_out_of_memory(void **state)
{
    fixture *f = *state;
    long fail_at = 1;
    asj_isotropic_free(&f->context->memory, &tested);
    const long live = f->counter.live, calls = f->counter.calls;
    int reached = 1;
    for (; reached && fail_at < 500; fail_at++) {
        f->counter.calls = calls;
        f->counter.fail_at = calls + fail_at;
        const asj_status status = asj_isotropic_create(f->context, &f->options, &tested);
        reached = unit_reached(&f->counter);
        assert_true(status == ASJ_OK || (reached && status == ASJ_ERROR_MEMORY));
        asj_isotropic_free(&f->context->memory, &tested);
        assert_int_equal(f->counter.live, live);
    }
    assert_in_range(fail_at, 10, 499);
}

/* ---- thinning ---- */

static int before(const asj_isotropic_junction *p, const asj_isotropic_junction *q, int by_branches)
{
    if (by_branches && p->branch_count != q->branch_count)
        return p->branch_count > q->branch_count;
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa;
    return p->y != q->y ? p->y < q->y : p->x < q->x;
}

static int close_to(const asj_isotropic_junction *kept, const asj_isotropic_junction *other, int32_t apart)
{
    const double radius = apart ? apart : 0.5 * kept->radius;
    return hypot(kept->x - other->x, kept->y - other->y) <= radius + 1e-12;
}

static int in_rows(const void *a, const void *b)
{
    const asj_isotropic_junction *p = a, *q = b;
    return p->y != q->y ? p->y - q->y : p->x - q->x;
}

static void sort_rows(asj_isotropic_junction *list, size_t count)
{
    if (count > 0)
        qsort(list, count, sizeof *list, in_rows);
}

/* Greedy by definition: the best one that is left stays, what is near it goes. */
static size_t naive_thin(asj_isotropic_junction *list, size_t count, const asj_detect_options *options,
                         asj_isotropic_junction *kept)
{
    size_t n = 0;
    while (count > 0) {
        size_t first = 0, left = 0;
        for (size_t i = 1; i < count; i++)
            if (before(&list[i], &list[first], options->more_branches_win))
                first = i;
        kept[n] = list[first];
        for (size_t i = 0; i < count; i++)
            if (!close_to(&kept[n], &list[i], options->isotropic_separation))
                list[left++] = list[i];
        count = left;
        n++;
    }
    sort_rows(kept, n);
    return n;
}

static void test_thin(void **state)
{
    enum { COUNT = 300 };
    static const int32_t sizes[][2] = {{50, 40}, {1, 300}, {300, 1}, {9, 9}, {64, 64}};
    static asj_isotropic_junction list[COUNT], copy[COUNT], expected[COUNT];
    fixture *f = *state;
    synth_random random;
    synth_random_seed(&random, 2);
    for (int round = 0; round < 40; round++) {
        const int32_t width = sizes[round % 5][0], height = sizes[round % 5][1];
        const size_t count = (size_t)(round * 7.5);
        void *scratch = malloc(asj_isotropic_thin_scratch(count, width, height));
        assert_non_null(scratch);
        f->options.more_branches_win = round % 2;
        f->options.isotropic_separation = round / 2 % 4;
        memset(list, 0, sizeof list);
        for (size_t i = 0; i < count; i++) {
            list[i].x = (uint16_t)synth_random_between(&random, 0, width);
            list[i].y = (uint16_t)synth_random_between(&random, 0, height);
            list[i].radius = (uint16_t)synth_random_between(&random, 3, 31);
            list[i].branch_count = (uint16_t)synth_random_between(&random, 2, 6);
            list[i].log_nfa = -floor(synth_random_between(&random, 0, 20)); /* with ties */
            for (size_t k = 0; k < i; k++)
                if (list[k].x == list[i].x && list[k].y == list[i].y)
                    list[i].radius = list[k].radius, list[i].branch_count = list[k].branch_count, list[i].log_nfa = list[k].log_nfa;
        }
        sort_rows(list, count);
        memcpy(copy, list, sizeof copy);
        const size_t kept = asj_isotropic_thin(list, count, &f->options, width, height, scratch);
        assert_int_equal(kept, naive_thin(copy, count, &f->options, expected));
        for (size_t i = 0; i < kept; i++)
            assert_true(list[i].x == expected[i].x && list[i].y == expected[i].y && list[i].log_nfa == expected[i].log_nfa);
        free(scratch);
    }
    asj_detect_options_init(&f->options);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_nfa),
        cmocka_unit_test(test_all_meaningful),
        cmocka_unit_test(test_band),
        cmocka_unit_test(test_tables),
        cmocka_unit_test(test_out_of_memory),
        cmocka_unit_test(test_thin),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
