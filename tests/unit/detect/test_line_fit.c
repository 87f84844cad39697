/* SPDX-License-Identifier: BSD-2-Clause */
/* Line fits on edges whose lines are known. */
#include "detect/line_fit.h"
#include "unit_test.h"

enum { SIZE = 101, MIDDLE = 50 };

static const asj_line_range near_range = {2, 12, {4, 2.5, 2}, 3};     /* as for the location */
static const asj_line_range long_range = {5, 38, {1.6, 1.6, 0}, 2};   /* as for the orientation */

typedef unit_fixture fixture;

/* A bar of parallel edges: `width` px across, its first edge `offset` px from the middle of the picture along the normal.
 * HUGE_VAL: a half plane. */
static void picture(const fixture *f, double angle, double offset, double width, double noise, asj_frame *frame)
{
    synth_scene scene;
    const double far = 4 * SIZE, c = cos(angle), s = sin(angle), depth = fmin(width, far);
    const synth_point p = {MIDDLE - offset * s, MIDDLE + offset * c};
    const synth_point corners[4] = {{p.x - far * c, p.y - far * s},
                                    {p.x + far * c, p.y + far * s},
                                    {p.x + far * c - depth * s, p.y + far * s + depth * c},
                                    {p.x - far * c - depth * s, p.y - far * s + depth * c}};
    synth_scene_init(&scene, SIZE, SIZE, 150);
    synth_scene_add(&scene, corners, 4, synth_flat(90), 0);
    unit_frame_of(f->context, &scene, 1, noise, NULL, frame);
}

static asj_hypothesis_branch branch_at(double angle, double offset)
{
    asj_hypothesis_branch branch;
    memset(&branch, 0, sizeof branch);
    branch.angle = angle < 0 ? angle + 2 * UNIT_PI : angle;
    branch.offset = offset;
    return branch;
}

/* Directions all around, edges up to a pixel beside the start, first angles up to 5 degrees off. No noise: what is left are
 * pixels. */
static void test_clean_edges(void **state)
{
    const fixture *f = *state;
    for (int n = 0; n < 72; n++) {
        const double angle = n * UNIT_PI / 36 + 0.01, offset = 0.3 * (n % 7 - 3), start = 0.09 * (n % 3 - 1);
        asj_frame frame;
        picture(f, angle, offset, HUGE_VAL, 0, &frame);
        asj_hypothesis_branch branch = branch_at(angle + start, 0);
        assert_true(asj_line_fit(f->context->ops->line, &frame, MIDDLE, MIDDLE, &near_range, &branch));
        unit_near("angle", n, 1, unit_turn(branch.angle, angle), 0, UNIT_PI / 180);
        unit_near("offset", n, 1, branch.offset, offset, 0.1);
        assert_true(branch.angle >= 0 && branch.angle < 2 * UNIT_PI);
        assert_true(asj_line_fit(f->context->ops->line, &frame, MIDDLE, MIDDLE, &long_range, &branch));
        unit_near("angle", n, 2, unit_turn(branch.angle, angle), 0, 0.2 * UNIT_PI / 180);
        unit_near("offset", n, 2, branch.offset, offset, 0.05);
        asj_frame_free(&f->context->memory, &frame);
    }
}

/* On whole pixels: rows are in the band or not, which costs up to half of one where the edge crosses none. The middle of a thin
 * line too. */
static void test_guesses(void **state)
{
    const fixture *f = *state;
    static const double widths[] = {HUGE_VAL, 2}, t[2] = {2, 14}, far[2] = {5, 40};
    for (size_t w = 0; w < UNIT_COUNT(widths); w++)
        for (int n = 0; n < 72; n++) {
            const double angle = n * UNIT_PI / 36 + 0.01, offset = 0.3 * (n % 5 - 2), start = 0.09 * (n % 3 - 1);
            asj_frame frame;
            picture(f, angle, isinf(widths[w]) ? offset : offset - 0.5 * widths[w], widths[w], 0, &frame);
            asj_hypothesis_branch branch = branch_at(angle + start, 0);
            asj_rough_line line = asj_rough_line_of(&branch);
            assert_true(asj_line_guess(f->context->ops->line, &frame, MIDDLE, MIDDLE, t, 4, &line));
            assert_true(asj_line_guess(f->context->ops->line, &frame, MIDDLE, MIDDLE, t, 2.5, &line));
            asj_rough_line_keep(&line, &branch);
            assert_true(branch.angle >= 0 && branch.angle < 2 * UNIT_PI);
            unit_near("angle", widths[w], n, unit_turn(branch.angle, angle), 0, 0.5 / (t[1] - t[0]));
            unit_near("offset", widths[w], n, branch.offset, offset, 0.5);
            unit_near("apart", widths[w], n, branch.apart > 0, w == 1, 0);
            for (int i = 0; i < 3; i++)
                assert_true(asj_line_guess(f->context->ops->line, &frame, MIDDLE, MIDDLE, far, 2, &line));
            unit_near("direction", widths[w], n, hypot(line.ux, line.uy), 1, 1e-12);
            asj_rough_line_keep(&line, &branch);
            unit_near("angle", widths[w], n, unit_turn(branch.angle, angle), 0, 0.5 / (far[1] - far[0]));
            unit_near("offset", widths[w], n, branch.offset, offset, 0.5);
            asj_frame_free(&f->context->memory, &frame);
        }
}

/* Noise: errors shrink with the stated uncertainties, which are right within a factor of two over many edges. */
static void test_noise(void **state)
{
    const fixture *f = *state;
    enum { EDGES = 150 };
    double angle_ratio = 0, offset_ratio = 0;
    synth_random random;
    synth_random_seed(&random, 6);
    for (int n = 0; n < EDGES; n++) {
        const double angle = synth_random_between(&random, 0, 2 * UNIT_PI), offset = synth_random_between(&random, -0.5, 0.5);
        synth_scene scene;
        asj_frame frame;
        unit_half_plane(&scene, SIZE, (synth_point){MIDDLE - offset * sin(angle), MIDDLE + offset * cos(angle)}, angle, 100, 140);
        uint8_t *pixels = unit_picture(&scene, 1, 5, 1000 + (uint64_t)n);
        const asj_image image = unit_gray8(pixels, SIZE, SIZE);
        unit_frame(f->context, &image, NULL, &frame);
        asj_hypothesis_branch branch = branch_at(angle, offset);
        assert_true(asj_line_fit(f->context->ops->line, &frame, MIDDLE, MIDDLE, &long_range, &branch));
        angle_ratio += pow(unit_turn(branch.angle, angle), 2) / branch.angle_variance;
        offset_ratio += pow(branch.offset - offset, 2) / branch.offset_variance;
        assert_true(unit_turn(branch.angle, angle) < 0.05);
        asj_frame_free(&f->context->memory, &frame);
        free(pixels);
    }
    unit_near("angle error / stated (log2)", EDGES, 0, 0.5 * log2(angle_ratio / EDGES), 0, 1);
    unit_near("offset error / stated (log2)", EDGES, 0, 0.5 * log2(offset_ratio / EDGES), 0, 1);
}

/* A line narrower than THIN: its middle, though its edges have opposite signs. */
static void test_thin_lines(void **state)
{
    const fixture *f = *state;
    static const double widths[] = {1.5, 2, 3};
    for (size_t w = 0; w < UNIT_COUNT(widths); w++)
        for (int n = 0; n < 24; n++) {
            const double angle = n * UNIT_PI / 12 + 0.03;
            asj_frame frame;
            picture(f, angle, -0.5 * widths[w], widths[w], 0, &frame);
            asj_hypothesis_branch branch = branch_at(angle + 0.04, 0.4);
            assert_true(asj_line_fit(f->context->ops->line, &frame, MIDDLE, MIDDLE, &near_range, &branch));
            assert_true(asj_line_fit(f->context->ops->line, &frame, MIDDLE, MIDDLE, &long_range, &branch));
            unit_near("angle", widths[w], n, unit_turn(branch.angle, angle), 0, 0.006);
            unit_near("middle", widths[w], n, branch.offset, 0, 0.1);
            asj_frame_free(&f->context->memory, &frame);
        }
}

/* Two edges of opposite sign, 5 to 8 px apart: the fit follows one of them, the one it starts at, and never the middle. */
static void test_bands(void **state)
{
    const fixture *f = *state;
    for (double width = 5; width <= 8; width += 0.5)
        for (int n = 0; n < 24; n++) {
            const double angle = n * UNIT_PI / 12 + 0.03;
            asj_frame frame;
            picture(f, angle, 0, width, 0, &frame);
            asj_hypothesis_branch branch = branch_at(angle + 0.03 * (n % 3 - 1), 0.5);
            assert_true(asj_line_fit(f->context->ops->line, &frame, MIDDLE, MIDDLE, &near_range, &branch));
            unit_near("angle", width, n, unit_turn(branch.angle, angle), 0, 0.02);
            unit_near("offset", width, n, branch.offset, 0, 0.15);
            asj_frame_free(&f->context->memory, &frame);
        }
}

/* The same on a band when two edges have the same sign (a step up, another step up): one of them. */
static void test_stairs(void **state)
{
    const fixture *f = *state;
    for (double width = 5; width <= 8; width++) /* nearer ones blur into each other */
        for (int n = 0; n < 12; n++) {
            const double angle = n * UNIT_PI / 6 + 0.03, c = cos(angle), s = sin(angle), far = 4 * SIZE;
            synth_scene scene;
            asj_frame frame;
            synth_scene_init(&scene, SIZE, SIZE, 60);
            for (int i = 0; i < 2; i++) {
                const synth_point p = {MIDDLE - i * width * s, MIDDLE + i * width * c};
                const synth_point corners[4] = {{p.x - far * c, p.y - far * s}, {p.x + far * c, p.y + far * s},
                                                {p.x + far * c - far * s, p.y + far * s + far * c},
                                                {p.x - far * c - far * s, p.y - far * s + far * c}};
                synth_scene_add(&scene, corners, 4, synth_flat(110 + 50 * i), i);
            }
            unit_frame_of(f->context, &scene, 1, 0, NULL, &frame);
            asj_hypothesis_branch branch = branch_at(angle, 0);
            assert_true(asj_line_fit(f->context->ops->line, &frame, MIDDLE, MIDDLE, &long_range, &branch));
            unit_near("angle", width, n, unit_turn(branch.angle, angle), 0, 0.01);
            unit_near("offset", width, n, branch.offset, 0, 0.1);
            asj_frame_free(&f->context->memory, &frame);
        }
}

static void test_nothing_there(void **state)
{
    const fixture *f = *state;
    asj_frame frame;
    synth_scene scene;
    synth_scene_init(&scene, SIZE, SIZE, 100);
    unit_frame_of(f->context, &scene, 0, 0, NULL, &frame);
    asj_hypothesis_branch branch = branch_at(1, 0.25), before = branch;
    assert_false(asj_line_fit(f->context->ops->line, &frame, MIDDLE, MIDDLE, &near_range, &branch));
    assert_memory_equal(&branch, &before, sizeof branch);
    static const double t[2] = {2, 10};
    asj_rough_line line = asj_rough_line_of(&branch);
    const asj_rough_line same = line;
    assert_false(asj_line_guess(f->context->ops->line, &frame, MIDDLE, MIDDLE, t, 4, &line));
    assert_memory_equal(&line, &same, sizeof line);
    asj_frame_free(&f->context->memory, &frame);
}

/* Far outside the picture, very long, and on pictures of a pixel: any answer but a crash or a NaN. */
static void test_extremes(void **state)
{
    const fixture *f = *state;
    static const asj_line_range ranges[] = {{2, 3, {4, 2, 1}, 3}, {0, 5000, {4.5, 4.5, 4.5}, 3}, {5, 8, {0.5, 0.5, 0.5}, 3},
                                            {5, 4, {2, 2, 2}, 3}};
    for (int size = 1; size < 40; size = size * 3 + 1) {
        uint8_t *pixels = synth_noise_image(size, size, 128, 60, (uint64_t)size);
        asj_frame frame;
        assert_non_null(pixels);
        const asj_image image = unit_gray8(pixels, size, size);
        unit_frame(f->context, &image, NULL, &frame);
        for (size_t r = 0; r < UNIT_COUNT(ranges); r++)
            for (int n = 0; n < 16; n++) {
                asj_hypothesis_branch branch = branch_at(n * UNIT_PI / 8, n - 8);
                asj_line_fit(f->context->ops->line, &frame, n * 7 - 50, n * 3 - 20, &ranges[r], &branch);
                assert_true(isfinite(branch.angle) && isfinite(branch.offset));
                assert_true(isfinite(branch.angle_variance) && isfinite(branch.offset_variance));
                const double t[2] = {ranges[r].first, ranges[r].last};
                asj_rough_line line = asj_rough_line_of(&branch);
                asj_line_guess(f->context->ops->line, &frame, n * 7 - 50, n * 3 - 20, t, ranges[r].half_width[0], &line);
                assert_true(isfinite(line.ux) && isfinite(line.uy) && isfinite(line.offset) && isfinite(line.apart));
            }
        asj_frame_free(&f->context->memory, &frame);
        free(pixels);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_clean_edges),
        cmocka_unit_test(test_guesses),
        cmocka_unit_test(test_noise),
        cmocka_unit_test(test_thin_lines),
        cmocka_unit_test(test_bands),
        cmocka_unit_test(test_stairs),
        cmocka_unit_test(test_nothing_there),
        cmocka_unit_test(test_extremes),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
