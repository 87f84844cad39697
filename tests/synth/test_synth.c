/* SPDX-License-Identifier: BSD-2-Clause */
/* The renderer and the truth it states are what every accuracy figure rests on: here they are checked against arithmetic done
 * by hand or by another road. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <cmocka.h>

#include "random.h"
#include "render.h"
#include "resample.h"
#include "scenes.h"
#include "truth.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846

static void assert_near(double value, double expected, double tolerance)
{
    if (!(fabs(value - expected) <= tolerance))
        fail_msg("%.12g is not within %g of %.12g", value, tolerance, expected);
}

static double *rendered(const synth_scene *scene)
{
    double *samples = malloc((size_t)scene->width * (size_t)scene->height * sizeof *samples);
    assert_non_null(samples);
    assert_int_equal(synth_render(scene, samples), 0);
    return samples;
}

/* Sum over the image of (grey - background) / contrast = the polygon's area, when it lies inside. */
static double covered(const double *samples, size_t count, double background, double contrast)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++)
        sum += (samples[i] - background) / contrast;
    return sum;
}

static void rectangle_coverage(void **state)
{
    (void)state;
    synth_scene scene;
    synth_scene_init(&scene, 8, 6, 10.0);
    /* From x = 1.25 to 4.75 and y = 0.5 to 3.0: columns 1 (a quarter), 2 to 4 (whole), 5 (a quarter); rows 1 and 2 whole, row 3
     * half. */
    synth_add_rectangle(&scene, (synth_point){1.25, 0.5}, 3.5, 2.5, 0.0, 110.0);
    double *samples = rendered(&scene);
    const double columns[8] = {0.0, 0.25, 1.0, 1.0, 1.0, 0.25, 0.0, 0.0}, rows[6] = {0.0, 1.0, 1.0, 0.5, 0.0, 0.0};
    for (int y = 0; y < 6; y++)
        for (int x = 0; x < 8; x++)
            assert_near(samples[y * 8 + x], 10.0 + 100.0 * columns[x] * rows[y], 1e-10);
    free(samples);
    synth_scene_free(&scene);
}

static void triangle_coverage(void **state)
{
    (void)state;
    synth_scene scene;
    synth_scene_init(&scene, 4, 4, 0.0);
    /* The half of the pixel square around (1, 1) below its diagonal, and nothing else. */
    const synth_point corners[3] = {{0.5, 0.5}, {1.5, 1.5}, {0.5, 1.5}};
    synth_scene_add(&scene, corners, 3, synth_flat(100.0), 0);
    double *samples = rendered(&scene);
    for (int i = 0; i < 16; i++)
        assert_near(samples[i], i == 5 ? 50.0 : 0.0, 1e-10);
    free(samples);
    synth_scene_free(&scene);
}

static void area_of_any_polygon(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 7);
    for (int trial = 0; trial < 200; trial++) {
        synth_scene scene;
        synth_scene_init(&scene, 60, 50, 20.0);
        /* A star-shaped simple polygon around the centre, convex or not, in either sense of rotation. */
        synth_point corners[14];
        const int count = 3 + trial % 12;
        const double sense = trial % 2 ? 1.0 : -1.0;
        double twice = 0.0;
        for (int i = 0; i < count; i++) {
            const double angle = sense * 2.0 * PI * (i + 0.8 * synth_random_unit(&random)) / count;
            const double radius = synth_random_between(&random, 3.0, 24.0);
            corners[i].x = 29.3 + radius * cos(angle);
            corners[i].y = 24.6 + radius * sin(angle);
        }
        for (int i = 0; i < count; i++)
            twice += corners[i].x * corners[(i + 1) % count].y - corners[(i + 1) % count].x * corners[i].y;
        if (count < 5) { /* with few corners the centre may lie outside, and then the polygon need not be simple */
            synth_scene_free(&scene);
            continue;
        }
        synth_scene_add(&scene, corners, count, synth_flat(120.0), 0);
        double *samples = rendered(&scene);
        assert_near(covered(samples, 60 * 50, 20.0, 100.0), 0.5 * fabs(twice), 1e-7);
        free(samples);
        synth_scene_free(&scene);
    }
}

/* Against brute force: 64 x 64 point samples per pixel of the topmost polygon. Its own error is below 0.5 / 64 a pixel and edge. */
static void overlaps_against_sampling(void **state)
{
    (void)state;
    synth_scene scene;
    synth_scene_init(&scene, 24, 24, 128.0);
    synth_random random;
    synth_random_seed(&random, 3);
    for (int i = 0; i < 12; i++) {
        double v[6];
        for (int k = 0; k < 6; k++)
            v[k] = synth_random_unit(&random);
        synth_add_rectangle(&scene, (synth_point){23.0 * v[0] - 3.0, 23.0 * v[1] - 3.0}, 2.0 + 13.0 * v[2], 2.0 + 13.0 * v[3],
                            6.3 * v[4], 255.0 * v[5]);
    }
    scene.polygons[4].paint.slope_x = 1.5;
    double *samples = rendered(&scene);
    double worst = 0.0, mean = 0.0;
    for (int i = 0; i < 24 * 24; i++) {
        double sum = 0.0;
        for (int k = 0; k < 4096; k++)
            sum += synth_scene_gray(&scene, i % 24 - 0.5 + (k % 64 + 0.5) / 64.0, i / 24 - 0.5 + (k / 64 + 0.5) / 64.0);
        const double error = fabs(samples[i] - sum / 4096.0);
        worst = fmax(worst, error);
        mean += error / 576.0;
    }
    assert_near(worst, 0.0, 4.0);
    assert_near(mean, 0.0, 0.2);
    free(samples);
    synth_scene_free(&scene);
}

static void shared_edges_leave_no_seam(void **state)
{
    (void)state;
    synth_scene scene;
    synth_scene_init(&scene, 40, 40, 0.0);
    const double angles[5] = {0.2, 1.1, 2.9, 4.0, 5.2}, grays[5] = {100.0, 100.0, 100.0, 100.0, 100.0};
    synth_add_star(&scene, (synth_point){19.37, 20.21}, angles, grays, 5, 60.0);
    double *samples = rendered(&scene);
    for (int i = 0; i < 1600; i++)
        assert_near(samples[i], 100.0, 1e-9);
    free(samples);
    synth_scene_free(&scene);
}

static void linear_shade_is_exact(void **state)
{
    (void)state;
    synth_scene scene;
    synth_scene_init(&scene, 10, 10, 0.0);
    const synth_point corners[3] = {{-20.0, -20.0}, {40.0, -20.0}, {-20.0, 60.0}};
    const synth_paint paint = {50.0, 2.0, -3.0, 1.0, 2.0};
    synth_scene_add(&scene, corners, 3, paint, 0);
    double *samples = rendered(&scene);
    assert_near(samples[3 * 10 + 4], 50.0 + 2.0 * 3.0 - 3.0 * 1.0, 1e-10);
    free(samples);
    synth_scene_free(&scene);
}

static void blur_of_a_step(void **state)
{
    (void)state;
    double line[41];
    for (int i = 0; i < 41; i++)
        line[i] = i < 20 ? 0.0 : 100.0;
    assert_int_equal(synth_blur(line, 41, 1, 2.0), 0);
    /* A step between pixels 19 and 20, blurred: 100 Phi((i - 19.5) / sigma), but for the sum in place of the integral: the
     * midpoint rule is off by at most 100 max|phi'| / (24 sigma^2) = 0.26. */
    for (int i = 10; i < 30; i++)
        assert_near(line[i], 50.0 * erfc(-(i - 19.5) / (2.0 * sqrt(2.0))), 0.26);
    assert_near(line[19] + line[20], 100.0, 1e-9);
}

static void noise_has_its_standard_deviation(void **state)
{
    (void)state;
    uint8_t *pixels = synth_noise_image(512, 512, 128.0, 20.0, 11);
    assert_non_null(pixels);
    double sum = 0.0, squares = 0.0, neighbours = 0.0;
    const double n = 512.0 * 512.0;
    for (int i = 0; i < 512 * 512; i++) {
        const double v = pixels[i] - 128.0;
        sum += v;
        squares += v * v;
        if (i % 512)
            neighbours += v * (pixels[i - 1] - 128.0);
    }
    /* Rounding adds 1/12 to the variance. Five standard errors: 20 / 512 for the mean, 400 sqrt 2 / 512 for the variance. */
    assert_near(sum / n, 0.0, 5.0 * 20.0 / 512.0);
    assert_near(squares / n, 400.0 + 1.0 / 12.0, 5.0 * 400.0 * sqrt(2.0) / 512.0);
    assert_near(neighbours / n, 0.0, 5.0 * 400.0 / 512.0);
    free(pixels);
}

/* First outputs of the reference implementations' published recurrences for seed 0: splitmix64 gives e220a8397b1dcdaf, .... */
static void random_numbers_are_known(void **state)
{
    (void)state;
    synth_random random;
    synth_random_seed(&random, 0);
    assert_true(random.state[0] == UINT64_C(0xe220a8397b1dcdaf));
    assert_true(random.state[1] == UINT64_C(0x6e789e6aa1b965f4));
    /* xoshiro256** from state 1, 2, 3, 4 begins 11520, 0, 1509978240. */
    for (uint64_t i = 0; i < 4; i++)
        random.state[i] = i + 1;
    assert_true(synth_random_bits(&random) == 11520);
    assert_true(synth_random_bits(&random) == 0);
    assert_true(synth_random_bits(&random) == 1509978240);
}

static void pictures_are_the_same_everywhere(void **state)
{
    (void)state;
    synth_scene scene;
    synth_parallelograms(&scene, 60.0, 1);
    uint8_t *pixels = synth_photograph(&scene, 1.0, 2.0, 1), *again = synth_photograph(&scene, 1.0, 2.0, 1);
    uint8_t *other = synth_photograph(&scene, 1.0, 2.0, 2);
    assert_non_null(pixels);
    assert_non_null(again);
    assert_non_null(other);
    assert_memory_equal(pixels, again, 320 * 240);
    assert_memory_not_equal(pixels, other, 320 * 240);
    assert_true(synth_checksum(pixels, 320 * 240) == UINT64_C(0x8c07b4f74820c6d5));
    free(pixels);
    free(again);
    free(other);
    synth_scene_free(&scene);
}

static void resampling_averages_areas(void **state)
{
    (void)state;
    uint8_t pixels[12 * 6];
    for (int i = 0; i < 72; i++)
        pixels[i] = (uint8_t)(10 * (i % 12) + 20 * (i / 12));
    uint8_t *half = synth_resample(pixels, 12, 6, 6, 3), *uneven = synth_resample(pixels, 12, 6, 8, 6);
    assert_non_null(half);
    assert_non_null(uneven);
    for (int i = 0; i < 18; i++)
        assert_int_equal(half[i], 10 * (2 * (i % 6)) + 5 + 20 * (2 * (i / 6)) + 10);
    /* 3 to 2: the first new pixel takes a whole old one and half of the next: (0 + 5) / 1.5 = 3.3, the second (5 + 20) / 1.5. */
    assert_int_equal(uneven[0], 3);
    assert_int_equal(uneven[1], 17);
    assert_int_equal(uneven[2], 33);
    assert_null(synth_resample(pixels, 12, 6, 13, 6));
    free(half);
    free(uneven);
}

static const synth_true_junction *junction_at(const synth_truth *truth, double x, double y)
{
    for (int32_t i = 0; i < truth->count; i++)
        if (hypot(truth->junctions[i].x - x, truth->junctions[i].y - y) < 1e-6)
            return &truth->junctions[i];
    fail_msg("no junction at (%g, %g)", x, y);
    return NULL;
}

static void assert_branch(const synth_true_branch *branch, double angle, double length, double contrast)
{
    assert_near(synth_angle_distance(branch->angle, angle), 0.0, 1e-9);
    assert_near(branch->length, length, 1e-6);
    assert_near(branch->contrast, contrast, 1e-9);
}

static void truth_of_a_rectangle(void **state)
{
    (void)state;
    synth_scene scene;
    synth_truth truth;
    synth_scene_init(&scene, 100, 80, 50.0);
    synth_add_rectangle(&scene, (synth_point){20.0, 10.0}, 40.0, 30.0, 0.0, 90.0);
    assert_int_equal(synth_truth_of_scene(&scene, 1.0, &truth), 0);
    assert_int_equal(truth.count, 4);
    const synth_true_junction *j = junction_at(&truth, 60.0, 10.0);
    assert_int_equal(j->branch_count, 2);
    assert_branch(&j->branches[0], 0.5 * PI, 30.0, 40.0);
    assert_branch(&j->branches[1], PI, 40.0, 40.0);
    assert_near(synth_truth_opening(j, 0.4, 30.0 - 1e-6, 40.0), 0.5 * PI, 1e-9);
    assert_near(synth_truth_opening(j, 1.6, 0.0, 0.0), 0.0, 0.0);
    assert_near(synth_truth_opening(j, 0.4, 30.1, 0.0), 0.0, 0.0);
    assert_near(synth_truth_opening(j, 0.4, 0.0, 40.1), 0.0, 0.0);
    synth_truth_free(&truth);
    /* The same step with a floor above it: nothing to be seen. */
    assert_int_equal(synth_truth_of_scene(&scene, 41.0, &truth), 0);
    assert_int_equal(truth.count, 0);
    synth_truth_free(&truth);
    synth_scene_free(&scene);
}

static void truth_of_an_occlusion(void **state)
{
    (void)state;
    synth_scene scene;
    synth_truth truth;
    synth_scene_init(&scene, 120, 100, 50.0);
    synth_add_rectangle(&scene, (synth_point){10.0, 10.0}, 60.0, 40.0, 0.0, 90.0);
    synth_add_rectangle(&scene, (synth_point){50.0, 30.0}, 50.0, 50.0, 0.0, 150.0);
    assert_int_equal(synth_truth_of_scene(&scene, 1.0, &truth), 0);
    /* Three corners of the lower one (the fourth is hidden), four of the upper one, two T-junctions. */
    assert_int_equal(truth.count, 9);
    const synth_true_junction *t = junction_at(&truth, 70.0, 30.0);
    assert_int_equal(t->branch_count, 3);
    assert_branch(&t->branches[0], 0.0, 30.0, 100.0);
    assert_branch(&t->branches[1], PI, 20.0, 60.0);
    assert_branch(&t->branches[2], 1.5 * PI, 20.0, 40.0);
    const synth_true_junction *corner = junction_at(&truth, 50.0, 30.0);
    assert_int_equal(corner->branch_count, 2);
    assert_int_equal(corner->branches[0].passes, 1);
    assert_near(corner->branches[0].length, 50.0, 1e-6);
    assert_near(corner->branches[0].contrast, 0.4 * 60.0 + 0.6 * 100.0, 1e-9);
    synth_truth_free(&truth);
    synth_scene_free(&scene);
}

static void truth_of_a_star(void **state)
{
    (void)state;
    synth_scene scene;
    synth_truth truth;
    synth_scene_init(&scene, 200, 200, 60.0);
    const double angles[3] = {0.3, 2.2, 4.5}, grays[3] = {100.0, 140.0, 200.0};
    synth_add_star(&scene, (synth_point){100.2, 99.7}, angles, grays, 3, 70.0);
    assert_int_equal(synth_truth_of_scene(&scene, 1.0, &truth), 0);
    const synth_true_junction *y = junction_at(&truth, 100.2, 99.7);
    assert_int_equal(y->branch_count, 3);
    assert_branch(&y->branches[0], 0.3, 70.0, 100.0);
    assert_branch(&y->branches[1], 2.2, 70.0, 40.0);
    assert_branch(&y->branches[2], 4.5, 70.0, 60.0);
    synth_truth_free(&truth);
    synth_scene_free(&scene);
}

/* 36 points; 4 corners, 16 points of three and 16 of four branches; every full line runs to the far side through four junctions. */
static void truth_of_a_checkerboard(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        synth_scene scene;
        synth_truth truth;
        int32_t by_branches[SYNTH_MAX_BRANCHES + 1] = {0}, full = 0;
        synth_tiles(&scene, SYNTH_CHECKERBOARD, seed);
        assert_int_equal(synth_truth_of_scene(&scene, 1.0, &truth), 0);
        assert_int_equal(truth.count, 36);
        for (int32_t i = 0; i < truth.count; i++) {
            const synth_true_junction *j = &truth.junctions[i];
            by_branches[j->branch_count]++;
            for (int32_t k = 0; k < j->branch_count; k++) {
                assert_false(j->branches[k].at_border);
                full += j->branches[k].passes == 4 && j->branches[k].length > 160.0;
            }
        }
        assert_int_equal(by_branches[2], 4);
        assert_int_equal(by_branches[3], 16);
        assert_int_equal(by_branches[4], 16);
        assert_int_equal(full, 24); /* twelve lines, from either end */
        synth_truth_free(&truth);
        synth_scene_free(&scene);
    }
}

static void truth_of_a_line_grid(void **state)
{
    (void)state;
    synth_scene scene;
    synth_truth truth;
    synth_point ends[2 * SYNTH_GRID_LINES];
    synth_line_grid(&scene, ends, 4);
    assert_int_equal(synth_truth_of_lines(ends, SYNTH_GRID_LINES, scene.width, scene.height, &truth), 0);
    assert_int_equal(truth.count, 25);
    const synth_true_junction *corner = junction_at(&truth, ends[0].x, ends[0].y);
    assert_int_equal(corner->branch_count, 2);
    synth_truth_free(&truth);
    synth_scene_free(&scene);
}

/* Truth and picture agree: along every true branch the grey steps by the stated contrast, within the last pixel before its end too,
 * and beyond the end of an L it does not. */
static void truth_and_picture_agree(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        synth_scene scene;
        synth_truth truth;
        synth_parallelograms(&scene, 60.0, seed);
        assert_int_equal(scene.count, 3);
        assert_int_equal(synth_truth_of_scene(&scene, 1.0, &truth), 0);
        assert_int_equal(truth.count, 12);
        double *samples = rendered(&scene);
        for (int32_t i = 0; i < truth.count; i++) {
            const synth_true_junction *j = &truth.junctions[i];
            for (int32_t k = 0; k < 2; k++) {
                const synth_true_branch *b = &j->branches[k];
                const double ux = cos(b->angle), uy = sin(b->angle);
                const double at[3] = {3.0, b->length - 3.0, b->length + 3.0};
                for (int q = 0; q < 3; q++) {
                    double side[2];
                    for (int s = 0; s < 2; s++) {
                        const double off = s ? 1.3 : -1.3;
                        const int x = (int)floor(j->x + at[q] * ux - off * uy + 0.5);
                        const int y = (int)floor(j->y + at[q] * uy + off * ux + 0.5);
                        side[s] = samples[y * scene.width + x];
                    }
                    assert_near(fabs(side[0] - side[1]), q < 2 ? 60.0 : 0.0, q < 2 ? 15.0 : 30.0);
                }
            }
        }
        free(samples);
        synth_truth_free(&truth);
        synth_scene_free(&scene);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rectangle_coverage),
        cmocka_unit_test(triangle_coverage),
        cmocka_unit_test(area_of_any_polygon),
        cmocka_unit_test(overlaps_against_sampling),
        cmocka_unit_test(shared_edges_leave_no_seam),
        cmocka_unit_test(linear_shade_is_exact),
        cmocka_unit_test(blur_of_a_step),
        cmocka_unit_test(noise_has_its_standard_deviation),
        cmocka_unit_test(random_numbers_are_known),
        cmocka_unit_test(pictures_are_the_same_everywhere),
        cmocka_unit_test(resampling_averages_areas),
        cmocka_unit_test(truth_of_a_rectangle),
        cmocka_unit_test(truth_of_an_occlusion),
        cmocka_unit_test(truth_of_a_star),
        cmocka_unit_test(truth_of_a_checkerboard),
        cmocka_unit_test(truth_of_a_line_grid),
        cmocka_unit_test(truth_and_picture_agree),
    };
    return cmocka_run_group_tests_name("synth", tests, NULL, NULL);
}
