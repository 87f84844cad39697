/* SPDX-License-Identifier: BSD-2-Clause */
/* src/detect/follow.c, by what preset paper finds: corners, and none where an edge leaves the image; and by itself: groups of
 * branches. */
#include "detect/follow.h"
#include "detect/steps.h"
#include "unit_test.h"

#include <math.h>

enum { WIDTH = 240, HEIGHT = 180 };

/* A tile, and bars that the border cuts; a frame of a pixel around everything, as photographs have it. */
static uint8_t *draw(void)
{
    synth_scene scene;
    synth_scene_init(&scene, WIDTH, HEIGHT, 160);
    synth_add_rectangle(&scene, (synth_point){69.5, 59.5}, 100, 60, 0, 60);
    for (int n = 0; n < 5; n++) {
        synth_add_rectangle(&scene, (synth_point){20.0 + 45 * n, -30}, 15, 60, 0.2, 90);
        synth_add_rectangle(&scene, (synth_point){20.0 + 45 * n, HEIGHT - 30.0}, 15, 60, 0.2, 90);
    }
    uint8_t *pixels = synth_photograph(&scene, 0.8, 1, 7);
    synth_scene_free(&scene);
    assert_non_null(pixels);
    for (int x = 0; x < WIDTH; x++)
        pixels[x] = pixels[(HEIGHT - 1) * WIDTH + x] = 250;
    return pixels;
}

static double to_border(const asj_junction *j)
{
    return fmin(fmin((double)j->x, (double)j->y), fmin(WIDTH - 1 - (double)j->x, HEIGHT - 1 - (double)j->y));
}

static int32_t count_near(const asj_detection *found, double x, double y)
{
    int32_t count = 0;
    for (uint32_t i = 0; i < found->junction_count; i++)
        count += hypot((double)found->junctions[i].x - x, (double)found->junctions[i].y - y) <= 3;
    return count;
}

static void discs_lie_in_the_image(void **state)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    uint8_t *pixels = draw();
    const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
    asj_detect_options options;
    asj_detection *found = NULL;
    (void)state;
    assert_int_equal(asj_detect_options_preset(&options, ASJ_PRESET_PAPER), ASJ_OK);
    assert_int_equal(asj_detect(context, &image, &options, &found), ASJ_OK);
    for (int corner = 0; corner < 4; corner++)
        assert_in_range(count_near(found, corner % 2 ? 169.5 : 69.5, corner / 2 ? 119.5 : 59.5), 1, 2);
    for (uint32_t i = 0; i < found->junction_count; i++)
        if (to_border(&found->junctions[i]) < (double)found->junctions[i].scale)
            fail_msg("scale %g, %g px from the border: (%g, %g)", (double)found->junctions[i].scale,
                     to_border(&found->junctions[i]), (double)found->junctions[i].x, (double)found->junctions[i].y);
    asj_detection_free(&found);
    free(pixels);
    unit_context_free(&counter, &context);
}

/* Where four squares of a board meet, at a radius of 3 px and with sectors of 2 px: three branches have room side by side, four
 * have not, however strong they are. */
static void groups_without_room_are_none(void **state)
{
    enum { SIDE = 120, ROOM = 3 };
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_detect_options options;
    asj_detection_run run;
    uint8_t pixels[SIDE * SIDE];
    (void)state;
    for (int i = 0; i < SIDE * SIDE; i++)
        pixels[i] = (i % SIDE < SIDE / 2) == (i / SIDE < SIDE / 2) ? 220 : 40;
    const asj_image image = unit_gray8(pixels, SIDE, SIDE);
    assert_int_equal(asj_detect_options_preset(&options, ASJ_PRESET_PAPER), ASJ_OK);
    options.isotropic_radii = 1u << 3;
    options.sector_width = 2;
    options.isotropic_persistence = 1;
    assert_int_equal(asj_detection_run_begin(&run, context, &image, &options, &run), ASJ_OK);
    assert_int_equal(asj_step_load(&run), ASJ_OK);
    assert_int_equal(asj_step_gradient(&run), ASJ_OK);
    for (int32_t count = 2; count <= 4; count++) {
        asj_hypothesis hypothesis = {.x = SIDE / 2, .y = SIDE / 2, .radius = 3, .branch_count = count};
        assert_int_equal(run.test->log_tests[count] == -HUGE_VAL, count > ROOM);
        for (int32_t b = 0; b < count; b++)
            hypothesis.branches[b].angle = 0.5 * UNIT_PI * b;
        asj_follow(&run, &hypothesis);
        assert_int_equal(hypothesis.branch_count, count > ROOM ? 0 : count);
    }
    asj_detection_run_end(&run);
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(discs_lie_in_the_image),
        cmocka_unit_test(groups_without_room_are_none),
    };
    return cmocka_run_group_tests_name("follow", tests, NULL, NULL);
}
