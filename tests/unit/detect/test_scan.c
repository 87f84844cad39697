/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 4 against the same definition in floating point, and against edges whose ends are known. */
#include "detect/nfa.h"
#include "detect/ray_walk.h"
#include "detect/scan.h"
#include "detect/scan_cache.h"
#include "unit_test.h"

enum { SIZE = 140, THREADS = 5 };

typedef struct fixture {
    unit_counter counter;
    asj_context *context;
    asj_detect_options options;
    asj_frame frame;
    asj_field field;
    asj_scan scan;
    asj_scan_cache cache;
    uint16_t *scratch; /* of THREADS */
    asj_field_branch (*all)[ASJ_FIELD_BRANCHES]; /* local junctions of every pixel */
} fixture;

static int set_up(void **state)
{
    fixture *f = calloc(1, sizeof *f);
    *state = f;
    if (!f)
        return -1;
    f->context = unit_context(&f->counter, 1);
    asj_detect_options_init(&f->options);
    return 0;
}

static int reset(void **state)
{
    asj_detect_options_init(&((fixture *)*state)->options);
    return 0;
}

static void drop_picture(fixture *f)
{
    asj_frame_free(&f->context->memory, &f->frame);
    asj_field_free(&f->context->memory, &f->field);
    asj_scan_cache_free(&f->context->memory, &f->cache);
    free(f->all);
    asj_release(&f->context->memory, f->scratch);
    f->all = NULL;
    f->scratch = NULL;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    drop_picture(f);
    asj_context_free(&f->context);
    unit_nothing_left(&f->counter);
    free(f);
    return 0;
}

static void take_picture(fixture *f, synth_scene *scene, double noise)
{
    drop_picture(f);
    unit_frame_of(f->context, scene, 1, noise, &f->options, &f->frame);
    assert_int_equal(asj_field_create(f->context, &f->options, &f->field), ASJ_OK);
    asj_scan_prepare(&f->options, &f->field, &f->cache, &f->scan);
    asj_scan_set_size(&f->options, f->frame.width, f->frame.height, &f->scan);
    f->scratch = asj_allocate(&f->context->memory, THREADS * asj_field_scratch(&f->field), sizeof *f->scratch);
    const int32_t stride = f->frame.blocks * ASJ_LANES;
    f->all = malloc((size_t)(stride * f->frame.height) * sizeof *f->all);
    assert_non_null(f->scratch);
    assert_non_null(f->all);
    for (int32_t y = 0; y < f->frame.height; y++)
        for (int32_t x = 0; x < stride; x++)
            asj_field_pixel(&f->field, &f->frame, x, y, f->scratch, f->all[y * stride + x]);
}

/* With an empty cache. */
static asj_status follow(fixture *f, asj_ray *rays, size_t count)
{
    const asj_status status = asj_scan_cache_prepare(f->context, &f->frame, f->context->threads, &f->cache);
    const asj_scratch scratch = {f->scratch, asj_field_scratch(&f->field)};
    return status == ASJ_OK ? asj_scan_rays(f->context, &f->scan, &f->frame, &scratch, rays, count) : status;
}

/* ---- the definition in double precision ---- */

typedef struct arc {
    double forward, ahead, axial;
} arc;

/* The branch of the local junction whose angle is closest, modulo `turn`; of equals the first, which is the strongest. */
static const asj_field_branch *closest(const asj_field_branch *list, double angle, double turn)
{
    const asj_field_branch *best = &list[0];
    for (int i = 1; i < ASJ_FIELD_BRANCHES && list[i].strength; i++)
        if (fabs(remainder(list[i].angle * UNIT_PI / 32768 - angle, turn)) <
            fabs(remainder(best->angle * UNIT_PI / 32768 - angle, turn)) - 1e-6)
            best = &list[i];
    return best;
}

static double pairwise(const asj_field_branch *branch, double alpha)
{
    const double turn = branch->angle * UNIT_PI / 32768 - alpha;
    return branch->strength / (double)ASJ_STRENGTH_ONE * fmax(fabs(cos(turn)) - fabs(sin(turn)), 0);
}

static arc naive_arc(const fixture *f, const asj_ray *ray, int32_t r)
{
    arc sums = {0, 0, 0};
    for (int32_t d = -f->options.arc_half_width; d <= f->options.arc_half_width; d++) {
        const double a = ray->angle + (double)d / r;
        const int64_t x = (int64_t)floor(ray->x + r * cos(a) + 0.5), y = (int64_t)floor(ray->y + r * sin(a) + 0.5);
        if (x < 0 || y < 0 || x >= f->frame.width || y >= f->frame.height)
            continue;
        const asj_field_branch *list = f->all[y * f->frame.blocks * ASJ_LANES + x];
        if (!list[0].strength)
            continue;
        const asj_field_branch *forward = closest(list, ray->angle, 2 * UNIT_PI);
        const double gamma = pairwise(forward, a);
        sums.forward += gamma;
        sums.ahead += cos(forward->angle * UNIT_PI / 32768 - a) > 0 ? gamma : 0;
        sums.axial += pairwise(closest(list, ray->angle, UNIT_PI), a);
    }
    return sums;
}

/* Whether three pixels across the ray have a sum of gamma of 1.2 or more. */
static int naive_edge(const fixture *f, const asj_ray *ray, int32_t r)
{
    const double c = cos(ray->angle), s = sin(ray->angle);
    double sum = 0;
    for (int32_t d = -1; d <= 1; d++) {
        const int64_t x = (int64_t)floor(ray->x + r * c - d * s + 0.5), y = (int64_t)floor(ray->y + r * s + d * c + 0.5);
        if (x < 0 || y < 0 || x >= f->frame.width || y >= f->frame.height)
            continue;
        const double gx = f->frame.gradient_x[y * f->frame.stride + x], gy = f->frame.gradient_y[y * f->frame.stride + x];
        sum += fmax(fabs(gy * c - gx * s) - fabs(gx * c + gy * s), 0) / ASJ_GRADIENT_ONE;
    }
    return sum >= 1.2;
}

/* Steps from r on, while nothing fails, that pass unseen: those with edges under them and under the four rows that follow; then
 * three more when the one behind them passes, else all steps up to that one, *looked, are looked at. */
static int32_t naive_unseen(const fixture *f, const asj_ray *ray, double threshold, int32_t r, int32_t *looked)
{
    int32_t end = r;
    if (f->options.scan_tolerance == 0 || r <= *looked)
        return 0;
    while (naive_edge(f, ray, end))
        end++;
    const int32_t plain = end - r > 4 ? end - r - 4 : 0;
    *looked = r + plain + 3;
    const arc far = naive_arc(f, ray, *looked);
    return plain + (far.ahead >= threshold && (!f->options.scan_axial || far.axial >= threshold) ? 3 : 0);
}

/* The paper's one scan: forward only. The last radius that passes before more than `tolerance` fail. */
static int32_t naive_forward(const fixture *f, const asj_ray *ray, double threshold)
{
    int32_t last = 0, looked = 0;
    for (int32_t r = ray->start > 0 ? ray->start : 1, failures = 0; failures <= f->options.scan_tolerance; r++) {
        const int32_t unseen = failures ? 0 : naive_unseen(f, ray, threshold, r, &looked);
        r += unseen;
        last = unseen ? r - 1 : last;
        const int passes = naive_arc(f, ray, r).forward >= threshold;
        failures = passes ? 0 : failures + 1;
        last = passes ? r : last;
    }
    return last;
}

/* Both scans at once. While the axial test passes, the forward one may fail for up to the field's radius, and is back when three
 * steps in a row pass with branches that look ahead; the axial length ends at most the field's radius behind the forward one. */
static void naive_both(const fixture *f, const asj_ray *ray, double threshold, int32_t *forward, int32_t *axial)
{
    const int32_t bridge = f->options.field_radius, tolerance = f->options.scan_tolerance;
    int32_t failures = 0, passes_ahead = 0, failures_ahead = 0, axial_failures = 0, looked = 0;
    *forward = *axial = 0;
    for (int32_t r = ray->start > 0 ? ray->start : 1;
         failures <= tolerance || (failures_ahead <= bridge && axial_failures <= tolerance); r++) {
        const int32_t unseen = failures || axial_failures ? 0 : naive_unseen(f, ray, threshold, r, &looked);
        r += unseen;
        *forward = unseen ? r - 1 : *forward;
        *axial = unseen ? r - 1 : *axial;
        const arc sums = naive_arc(f, ray, r);
        const int closed = failures > tolerance;
        passes_ahead = sums.ahead >= threshold ? passes_ahead + 1 : 0;
        failures_ahead = passes_ahead ? 0 : failures_ahead + 1;
        axial_failures = sums.axial >= threshold ? 0 : axial_failures + 1;
        failures = passes_ahead >= 3 || (!closed && sums.forward >= threshold) ? 0 : failures + 1;
        *forward = failures ? *forward : r;
        *axial = axial_failures ? *axial : r;
    }
    if (*axial > *forward + bridge)
        *axial = *forward + bridge;
}

static double threshold_of(const fixture *f)
{
    const double log_p = log(f->options.scan_epsilon) - 0.5 * log((double)f->frame.width * f->frame.height);
    return asj_nfa_arc_threshold(asj_nfa_tables(), fmin(log_p, 0), 2 * f->options.arc_half_width + 1);
}

static void test_threshold(void **state)
{
    static const double epsilons[] = {1e-6, 1, 100, 1e3};
    fixture *f = *state;
    for (int32_t width = 1; width <= 3; width++)
        for (size_t e = 0; e < UNIT_COUNT(epsilons); e++) {
            synth_scene scene;
            f->options.arc_half_width = width;
            f->options.scan_epsilon = epsilons[e];
            synth_scene_init(&scene, 50, 40, 100);
            take_picture(f, &scene, 0);
            unit_near("threshold", width, epsilons[e], f->scan.threshold, threshold_of(f) * ASJ_STRENGTH_ONE, 1.001);
            assert_true(f->scan.threshold >= 1); /* an arc without junctions never passes */
        }
    asj_detect_options_init(&f->options);
}

/* ---- the library's rays ---- */

static void scene_of(int kind, synth_scene *scene)
{
    static const double angles[4] = {0.2, 1.9, 3.3, 5.1}, grays[4] = {60, 180, 110, 220};
    synth_point ends[2 * SYNTH_GRID_LINES];
    switch (kind) {
    case 0: synth_tiles(scene, SYNTH_CHECKERBOARD, 2); break;
    case 1: synth_line_grid(scene, ends, 2); break;
    case 2: synth_parallelograms(scene, 60, 5); break;
    default:
        synth_scene_init(scene, SIZE, SIZE, 120);
        synth_add_star(scene, (synth_point){70.3, 65.8}, angles, grays, 4, 50);
    }
}

static void random_rays(const fixture *f, asj_ray *rays, size_t count, uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    for (size_t i = 0; i < count;) {
        const double x = synth_random_between(&random, -3, f->frame.width + 3);
        const double y = synth_random_between(&random, -3, f->frame.height + 3);
        double angle = synth_random_between(&random, 0, 2 * UNIT_PI);
        const int32_t u = (int32_t)lrint(x), v = (int32_t)lrint(y);
        if (i % 8 != 0) { /* most of them along an edge: from a pixel with a strong branch into its direction, or nearly */
            if (u < 0 || v < 0 || u >= f->frame.width || v >= f->frame.height)
                continue;
            const asj_field_branch branch = f->all[v * f->frame.blocks * ASJ_LANES + u][0];
            if (branch.strength < 4 * ASJ_STRENGTH_ONE)
                continue;
            angle = branch.angle * UNIT_PI / 32768 + 0.02 * synth_random_normal(&random);
            angle -= 2 * UNIT_PI * floor(angle / (2 * UNIT_PI));
        }
        rays[i++] = (asj_ray){x, y, angle, f->options.scan_start, -7, -7};
    }
}

enum { RAYS = 400 };

/* With the second scan off it is the paper's scan. Rounding may move a step that is at the threshold, one ray in a hundred at
 * most. */
static void test_forward(void **state)
{
    fixture *f = *state;
    static asj_ray rays[RAYS];
    for (int kind = 0; kind < 4; kind++)
        for (int variant = 0; variant < 4; variant++) {
            synth_scene scene;
            int off = 0;
            f->options.scan_axial = 0;
            f->options.scan_tolerance = variant;
            f->options.arc_half_width = 1 + variant % 3;
            f->options.scan_start = 1 + variant;
            scene_of(kind, &scene);
            take_picture(f, &scene, 2);
            random_rays(f, rays, RAYS, 9);
            assert_int_equal(follow(f, rays, RAYS), ASJ_OK);
            long total = 0;
            for (size_t i = 0; i < RAYS; i++) {
                assert_int_equal(rays[i].axial, 0); /* not asked for */
                off += abs(rays[i].forward - naive_forward(f, &rays[i], threshold_of(f))) > 1;
                total += rays[i].forward;
            }
            assert_true(total > 5 * RAYS);
            if (off > RAYS / 100)
                fail_msg("scene %d, variant %d: %d of %d lengths are off", kind, variant, off, RAYS);
        }
    asj_detect_options_init(&f->options);
}

static void test_both(void **state)
{
    fixture *f = *state;
    static asj_ray rays[RAYS];
    for (int kind = 0; kind < 4; kind++) {
        synth_scene scene;
        int off = 0, longer = 0, shorter = 0;
        scene_of(kind, &scene);
        take_picture(f, &scene, 2);
        random_rays(f, rays, RAYS, 10);
        assert_int_equal(follow(f, rays, RAYS), ASJ_OK);
        for (size_t i = 0; i < RAYS; i++) {
            int32_t forward, axial;
            naive_both(f, &rays[i], threshold_of(f), &forward, &axial);
            off += abs(rays[i].forward - forward) > 1 || abs(rays[i].axial - axial) > 1;
            longer += rays[i].axial > rays[i].forward;
            shorter += rays[i].forward < naive_forward(f, &rays[i], threshold_of(f)) - 1; /* than the paper's */
        }
        if (off > RAYS / 100)
            fail_msg("scene %d: %d of %d lengths are off", kind, off, RAYS);
        assert_true(longer > RAYS / 4);
        assert_true(shorter <= RAYS / 100); /* other steps are passed over */
    }
}

/* From a corner of a rectangle along its sides: the mean of both lengths is the side, within 2 px (8.1: +0.7 on average). */
static void test_sides(void **state)
{
    fixture *f = *state;
    double bias = 0;
    int count = 0;
    for (int n = 0; n < 24; n++) {
        const double angle = n * UNIT_PI / 12 + 0.05, c = cos(angle), s = sin(angle), width = 30 + n, height = 52 - n;
        const synth_point corner = {70.2 - 0.5 * (width * c - height * s), 69.6 - 0.5 * (width * s + height * c)};
        synth_scene scene;
        synth_scene_init(&scene, SIZE, SIZE, 90);
        synth_add_rectangle(&scene, corner, width, height, angle, 150);
        take_picture(f, &scene, 2);
        asj_ray rays[2] = {{corner.x, corner.y, angle, 3, 0, 0}, {corner.x, corner.y, fmod(angle + UNIT_PI / 2, 2 * UNIT_PI), 3,
                                                                  0, 0}};
        assert_int_equal(follow(f, rays, 2), ASJ_OK);
        for (int i = 0; i < 2; i++) {
            const double length = 0.5 * (rays[i].forward + rays[i].axial), truth = i ? height : width;
            unit_near("side", n, i, length, truth, 3);
            bias += length - truth;
            count++;
        }
    }
    unit_near("bias", count, 0, bias / count, 0, 1);
}

/* Nothing passes on a flat picture, nor outside it; rays start anywhere and point anywhere. */
static void test_nothing(void **state)
{
    fixture *f = *state;
    synth_scene scene;
    synth_scene_init(&scene, 30, 20, 100);
    take_picture(f, &scene, 0);
    static const double places[][2] = {{10, 10}, {-5, 3}, {1e5, -1e5}, {29, 19}, {0, 0}, {29.5, 19.5}, {-0.5, -0.5}};
    asj_ray rays[7 * 16];
    for (size_t i = 0; i < UNIT_COUNT(rays); i++)
        rays[i] = (asj_ray){places[i / 16][0], places[i / 16][1], (double)(i % 16) * 2 * UNIT_PI / 16, (int32_t)(i % 5), -7, -7};
    rays[3].angle = nextafter(2 * UNIT_PI, 0);
    assert_int_equal(follow(f, rays, UNIT_COUNT(rays)), ASJ_OK);
    for (size_t i = 0; i < UNIT_COUNT(rays); i++)
        assert_true(rays[i].forward == 0 && rays[i].axial == 0);
    assert_int_equal(follow(f, rays, 0), ASJ_OK);
}

/* Longer than the table of rotations: an edge over 700 px is followed to its end. */
static void test_long_ray(void **state)
{
    fixture *f = *state;
    for (int n = 0; n < 4; n++) {
        const double slope = 0.003 * n, angle = atan(slope);
        synth_scene scene;
        const synth_point corners[4] = {{20, 30}, {760, 30 + 740 * slope}, {760, 70}, {20, 70}};
        synth_scene_init(&scene, 800, 60, 90);
        synth_scene_add(&scene, corners, 4, synth_flat(160), 0);
        take_picture(f, &scene, 1);
        asj_ray rays[2] = {{20, 30, angle, 3, 0, 0}, {760, 30 + 740 * slope, angle + UNIT_PI, 3, 0, 0}};
        assert_int_equal(follow(f, rays, 2), ASJ_OK);
        for (int i = 0; i < 2; i++)
            unit_near("long ray", n, i, 0.5 * (rays[i].forward + rays[i].axial), 740 / cos(angle), 5);
    }
}

static void test_threads_and_memory(void **state)
{
    fixture *f = *state;
    static asj_ray one[RAYS], many[RAYS];
    synth_scene scene;
    scene_of(0, &scene);
    take_picture(f, &scene, 4);
    random_rays(f, one, RAYS, 3);
    memcpy(many, one, sizeof many);
    assert_int_equal(follow(f, one, RAYS), ASJ_OK);
    f->context->threads = THREADS;
    assert_int_equal(follow(f, many, RAYS), ASJ_OK);
    for (size_t i = 0; i < RAYS; i++)
        assert_true(one[i].forward == many[i].forward && one[i].axial == many[i].axial);
    f->context->threads = 1;
    const long live = f->counter.live;
    for (long n = 1; n <= 2; n++) {
        f->counter.fail_at = f->counter.calls + n;
        assert_int_equal(follow(f, many, RAYS), ASJ_ERROR_MEMORY);
        assert_int_equal(f->counter.live, live);
    }
    f->counter.fail_at = 0;
}

/* Rays that are followed for some px alone: those that end well before are what they were. */
static void test_longest(void **state)
{
    enum { LONGEST = 30, BEFORE = 20, BEYOND = 2 * ASJ_RAY_STRIDE };
    fixture *f = *state;
    static asj_ray whole[RAYS], cut[RAYS];
    synth_scene scene;
    int ended = 0;
    scene_of(0, &scene);
    take_picture(f, &scene, 2);
    random_rays(f, whole, RAYS, 11);
    memcpy(cut, whole, sizeof cut);
    assert_int_equal(follow(f, whole, RAYS), ASJ_OK);
    f->scan.longest = LONGEST;
    assert_int_equal(follow(f, cut, RAYS), ASJ_OK);
    f->scan.longest = 0;
    for (size_t i = 0; i < RAYS; i++) {
        assert_true(cut[i].forward <= whole[i].forward && cut[i].forward <= LONGEST + BEYOND);
        if (whole[i].forward <= BEFORE && whole[i].axial <= BEFORE)
            assert_true(cut[i].forward == whole[i].forward && cut[i].axial == whole[i].axial);
        ended += whole[i].forward > LONGEST + BEYOND;
    }
    assert_true(ended > RAYS / 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(test_threshold, reset), cmocka_unit_test_setup(test_forward, reset),
            cmocka_unit_test_setup(test_both, reset),
        cmocka_unit_test_setup(test_sides, reset),     cmocka_unit_test_setup(test_nothing, reset),
            cmocka_unit_test_setup(test_long_ray, reset),
        cmocka_unit_test_setup(test_threads_and_memory, reset), cmocka_unit_test_setup(test_longest, reset),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
