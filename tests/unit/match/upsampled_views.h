/* SPDX-License-Identifier: BSD-2-Clause */
/* Two views of the sample room, and their junctions without octave -1 and with it. */
#ifndef ASJ_TEST_UPSAMPLED_VIEWS_H
#define ASJ_TEST_UPSAMPLED_VIEWS_H

#include "match/upsampled.h"
#include "unit_test.h"

#include <asj/asj.h>

enum { WIDTH = 320, HEIGHT = 237 };

typedef struct view {
    uint8_t *pixels;
    asj_image image;
    asj_detection *plain, *upsampled; /* without octave -1, and with it */
} view;

static view views[2];

static int make_views(void **state)
{
    assert_int_equal(unit_set_up(state), 0);
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_detect_options options;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    for (int32_t n = 0; n < 2; n++) {
        views[n].pixels = unit_room_picture(n, WIDTH, HEIGHT);
        views[n].image = unit_gray8(views[n].pixels, WIDTH, HEIGHT);
        options.first_octave = 0;
        assert_int_equal(asj_detect(context, &views[n].image, &options, &views[n].plain), ASJ_OK);
        options.first_octave = -1;
        assert_int_equal(asj_detect(context, &views[n].image, &options, &views[n].upsampled), ASJ_OK);
        assert_false(asj_has_upsampled(views[n].plain->junctions, views[n].plain->junction_count));
        assert_true(asj_has_upsampled(views[n].upsampled->junctions, views[n].upsampled->junction_count));
    }
    return 0;
}

static int free_views(void **state)
{
    for (int32_t n = 0; n < 2; n++) {
        asj_detection_free(&views[n].plain);
        asj_detection_free(&views[n].upsampled);
        free(views[n].pixels);
    }
    return unit_tear_down(state);
}

#endif
