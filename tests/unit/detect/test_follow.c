/* SPDX-License-Identifier: BSD-2-Clause */
/* src/detect/follow.c, by what preset paper finds: corners, and none where an edge leaves the image. */
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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(discs_lie_in_the_image)};
    return cmocka_run_group_tests_name("follow", tests, NULL, NULL);
}
