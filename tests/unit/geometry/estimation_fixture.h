/* SPDX-License-Identifier: BSD-2-Clause */
/* An estimation that has its candidates and no geometry yet, for tests of what is done with finalists. */
#ifndef ASJ_TESTS_ESTIMATION_FIXTURE_H
#define ASJ_TESTS_ESTIMATION_FIXTURE_H

#include "geometry/estimation.h"
#include "geometry/pairs.h"

static asj_pyramid pyramids[2][ASJ_MOST_CHANNELS]; /* of the pictures that it is shown */

/* context and options must stay. Never NULL: fails the test. */
static asj_estimation *create_estimation(asj_context *context, const asj_geometry_candidate *list, size_t count,
                                         const asj_geometry_options *options)
{
    asj_estimation *e = asj_allocate_zero(&context->memory, 1, sizeof *e);
    assert_non_null(e);
    e->context = context;
    e->options = options;
    e->focal_at = -1;
    assert_int_equal(asj_pairs_create(context, list, count, NULL, options, &e->set), ASJ_OK);
    assert_true(asj_adjust_scratch_create(&context->memory, &e->set, &e->scratch));
    e->first.probability = asj_allocate(&context->memory, count, sizeof *e->first.probability);
    e->other.probability = asj_allocate(&context->memory, count, sizeof *e->other.probability);
    e->elsewhere = asj_allocate(&context->memory, count, sizeof *e->elsewhere);
    e->vote = asj_allocate(&context->memory, count, 4 * sizeof *e->vote);
    assert_true(e->first.probability && e->other.probability && e->elsewhere && e->vote);
    return e;
}

/* Grey levels of image `which`, 0 or 1. */
typedef void paint_channel(int32_t which, int32_t channel, int32_t contrast, uint8_t *pixels);

/* Both pictures in so many channels, of those contrasts; 0: nobody shows them. */
static void show_pictures(asj_context *context, asj_estimation *e, int32_t channels, const int32_t *contrasts, paint_channel *paint)
{
    const int32_t *widths = e->options->widths, *heights = e->options->heights;
    asj_picture of[2];
    for (int32_t k = 0; k < 2; k++) {
        uint8_t *pixels = asj_allocate(&context->memory, (size_t)widths[k], (size_t)heights[k]);
        assert_non_null(pixels);
        of[k] = (asj_picture){.channel_count = channels, .scale = 1, .width = widths[k], .height = heights[k]};
        for (int32_t c = 0; c < channels; c++) {
            const asj_image image = {pixels, ASJ_FORMAT_GRAY8, widths[k], heights[k], 0, 0};
            paint(k, c, contrasts[c], pixels);
            assert_int_equal(asj_pyramid_create(context, &image, 0.8, &pyramids[k][c]), ASJ_OK);
            of[k].channels[c] = &pyramids[k][c];
        }
        asj_release(&context->memory, pixels);
    }
    e->pictures = channels > 0 ? asj_pictures_create(&context->memory, of, e->set.count) : NULL;
    assert_true(e->pictures || channels == 0);
}

static void release_estimation(asj_context *context, asj_estimation *e)
{
    for (int32_t k = 0; k < 2 * ASJ_MOST_CHANNELS; k++)
        asj_pyramid_free(&context->memory, &pyramids[k / ASJ_MOST_CHANNELS][k % ASJ_MOST_CHANNELS]);
    asj_pictures_free(&context->memory, e->pictures);
    asj_adjust_scratch_free(&context->memory, &e->scratch);
    asj_release(&context->memory, e->first.probability);
    asj_release(&context->memory, e->other.probability);
    asj_release(&context->memory, e->elsewhere);
    asj_release(&context->memory, e->vote);
    asj_pairs_free(&context->memory, &e->set);
    asj_release(&context->memory, e);
}

#endif
