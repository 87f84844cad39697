/* SPDX-License-Identifier: BSD-2-Clause */
/* From images to matches: as they are it is what the two calls give; stretched, a page that lies flat matches where it did not, and
 * everything is in pixels of the images. */
#include "pages.h"

#include "match/unstretch.h"

/* Without a stretch, with one of 1, and by the two calls. */
static void as_they_are_it_is_what_two_calls_give(void **state)
{
    const pages *p = *state;
    const asj_stretch one = {1, 1};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_detect_options options;
    asj_detection *found[2] = {NULL, NULL};
    asj_match_result *by_two = NULL, *by_one = NULL, *stretched = NULL;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    for (int v = 0; v < 2; v++)
        assert_int_equal(asj_detect(context, &p->images[v], &options, &found[v]), ASJ_OK);
    assert_int_equal(asj_match(context, &p->images[0], found[0]->junctions, found[0]->junction_count, &p->images[1],
                               found[1]->junctions, found[1]->junction_count, NULL, &by_two), ASJ_OK);
    assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], NULL, NULL, NULL, &by_one), ASJ_OK);
    assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &one, &options, NULL, &stretched), ASJ_OK);
    pages_expect_equal(by_two, by_one);
    pages_expect_equal(by_two, stretched);
    asj_match_result_free(&by_two);
    asj_match_result_free(&by_one);
    asj_match_result_free(&stretched);
    asj_detection_free(&found[0]);
    asj_detection_free(&found[1]);
    unit_context_free(&counter, &context);
}

/* Stretched by any factor, along one axis or both; the same with any number of threads. */
static void a_page_that_lies_flat_matches_when_it_is_stretched(void **state)
{
    static const asj_stretch stretches[] = {{1, 3}, {1, 2.5}, {1.5, 3}};
    static const uint32_t least[] = {3, 3, 1}; /* times as many as without: across the page it helps most */
    const pages *p = *state;
    unit_counter counters[2] = {{0}, {0}};
    asj_context *contexts[2] = {unit_context(&counters[0], 1), unit_context(&counters[1], 2)};
    asj_match_result *plain = NULL;
    assert_int_equal(asj_match_images(contexts[1], &p->images[0], &p->images[1], NULL, NULL, NULL, &plain), ASJ_OK);
    for (size_t s = 0; s < UNIT_COUNT(stretches); s++) {
        asj_match_result *results[2] = {NULL, NULL};
        for (int n = 0; n < 2; n++)
            assert_int_equal(asj_match_images(contexts[n], &p->images[0], &p->images[1], &stretches[s], NULL, NULL, &results[n]),
                             ASJ_OK);
        pages_expect_equal(results[0], results[1]);
        pages_expect_consistent(results[0]);
        const uint32_t right = pages_count_right(results[0]);
        print_message("stretched by %g, %g: %u right of %u; as it is %u of %u\n", stretches[s].x, stretches[s].y, (unsigned)right,
                      (unsigned)results[0]->match_count, (unsigned)pages_count_right(plain), (unsigned)plain->match_count);
        assert_true(right >= 20 && right >= least[s] * pages_count_right(plain) && 20 * right >= 17 * results[0]->match_count);
        asj_match_result_free(&results[0]);
        asj_match_result_free(&results[1]);
    }
    asj_match_result_free(&plain);
    unit_context_free(&counters[0], &contexts[0]);
    unit_context_free(&counters[1], &contexts[1]);
}

/* As they are where that is enough; stretched, as if asked for it, where it is not; nothing new where nothing helps. */
static void automatically_the_first_look_that_is_enough_counts(void **state)
{
    static const asj_stretch automatic = {0, 0}, across = {1, 3};
    static const int32_t models[] = {ASJ_GEOMETRY_NONE, ASJ_GEOMETRY_AUTO};
    static uint8_t flat[PAGE_WIDTH * PAGE_HEIGHT];
    const pages *p = *state;
    const asj_image with_itself[2] = {p->images[0], p->images[0]};
    const asj_image unlike[2] = {p->images[0], unit_gray8(flat, PAGE_WIDTH, PAGE_HEIGHT)};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    for (size_t m = 0; m < UNIT_COUNT(models); m++) {
        asj_match_result *plain = pages_look(context, p->images, NULL, models[m]);
        asj_match_result *one = pages_look(context, p->images, &across, models[m]);
        asj_match_result *found = pages_look(context, p->images, &automatic, models[m]);
        assert_true(plain->match_count < 16 && plain->stretch[0] == 1 && plain->stretch[1] == 1);
        assert_true(found->stretch[0] == 1 && found->stretch[1] == 3 && one->stretch[1] == 3);
        pages_expect_equal(one, found);
        pages_expect_consistent(found);
        assert_true(found->stage_ms[ASJ_STAGE_CANDIDATES] > 0 && pages_count_right(found) > 2 * pages_count_right(plain));
        asj_match_result_free(&plain);
        asj_match_result_free(&one);
        asj_match_result_free(&found);

        plain = pages_look(context, with_itself, NULL, models[m]);
        found = pages_look(context, with_itself, &automatic, models[m]);
        assert_true(found->match_count >= 16 && found->stretch[0] == 1 && found->stretch[1] == 1);
        pages_expect_equal(plain, found);
        asj_match_result_free(&plain);
        asj_match_result_free(&found);

        found = pages_look(context, unlike, &automatic, models[m]);
        assert_true(found->match_count == 0 && found->stretch[0] == 1 && found->stretch[1] == 1);
        asj_match_result_free(&found);
    }
    unit_context_free(&counter, &context);
}

/* The homography is that of the page, in pixels of the images. */
static void a_homography_is_of_the_images_as_they_are(void **state)
{
    const pages *p = *state;
    const asj_stretch stretch = {1, 3};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_options options;
    asj_match_result *r = NULL;
    asj_match_options_init(&options);
    options.geometry.model = ASJ_GEOMETRY_HOMOGRAPHY;
    assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &stretch, NULL, &options, &r), ASJ_OK);
    assert_int_equal(r->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    const double *h = r->geometry.matrix;
    double norm = 0;
    for (int k = 0; k < 9; k++)
        norm += h[k] * h[k];
    unit_near("norm", 0, 0, norm, 1, 1e-9);
    for (double u = -0.8; u < 0.9; u += 0.4)
        for (double v = -0.8; v < 0.9; v += 0.4) {
            const synth_point from = pages_seen(u, v, 0), to = pages_seen(u, v, 1);
            const double w = h[6] * from.x + h[7] * from.y + h[8];
            unit_near("x", u, v, (h[0] * from.x + h[1] * from.y + h[2]) / w, to.x, 2);
            unit_near("y", u, v, (h[3] * from.x + h[4] * from.y + h[5]) / w, to.y, 2);
        }
    asj_match_result_free(&r);
    unit_context_free(&counter, &context);
}

/* H and F of stretched images, taken back, say of points what they said of stretched ones. */
static void matrices_are_taken_back(void **state)
{
    const asj_stretch by[2] = {{2, 3}, {1.25, 1}};
    const double points[4] = {31.5, 12.25, 80, 7};
    synth_random random;
    (void)state;
    synth_random_seed(&random, 3);
    for (int32_t model = ASJ_GEOMETRY_FUNDAMENTAL; model <= ASJ_GEOMETRY_HOMOGRAPHY; model++) {
        asj_geometry g = {.model = model, .cameras = {{600, 660, 63.5, 95.5}, {500, 400, 80, 7}}};
        double m[9];
        for (int k = 0; k < 9; k++)
            m[k] = g.matrix[k] = synth_random_between(&random, -1, 1);
        double fundamental[9];
        memcpy(fundamental, m, sizeof fundamental);
        asj_unstretch_fundamental(fundamental, by);
        asj_unstretch_geometry(&g, by);
        assert_int_equal(memcmp(fundamental, g.matrix, sizeof fundamental) == 0, model == ASJ_GEOMETRY_FUNDAMENTAL);
        const double *t = g.matrix, x1 = points[0], y1 = points[1], x2 = points[2], y2 = points[3];
        const double sx1 = (x1 + 0.5) * 2 - 0.5, sy1 = (y1 + 0.5) * 3 - 0.5, sx2 = (x2 + 0.5) * 1.25 - 0.5, sy2 = y2;
        double before[3], after[3];
        for (int row = 0; row < 3; row++) {
            before[row] = m[3 * row] * sx1 + m[3 * row + 1] * sy1 + m[3 * row + 2];
            after[row] = t[3 * row] * x1 + t[3 * row + 1] * y1 + t[3 * row + 2];
        }
        if (model == ASJ_GEOMETRY_HOMOGRAPHY) {
            unit_near("x", 0, 0, (after[0] / after[2] + 0.5) * 1.25 - 0.5, before[0] / before[2], 1e-9);
            unit_near("y", 0, 0, after[1] / after[2], before[1] / before[2], 1e-9);
        } else {
            const double here = x2 * after[0] + y2 * after[1] + after[2], there = sx2 * before[0] + sy2 * before[1] + before[2];
            unit_near("x2' F x1, with the same factor as the line", 0, 0, here * before[1], there * after[1], 1e-9);
            unit_near("line", 0, 0, after[0] * before[1], after[1] * before[0] * 1.25, 1e-9);
        }
        const asj_camera wanted[2] = {{300, 220, 31.5, 31.5}, {400, 400, 63.9, 7}};
        for (int v = 0; v < 2; v++) {
            unit_near("fx", v, 0, g.cameras[v].fx, wanted[v].fx, 1e-9);
            unit_near("fy", v, 0, g.cameras[v].fy, wanted[v].fy, 1e-9);
            unit_near("cx", v, 0, g.cameras[v].cx, wanted[v].cx, 1e-9);
            unit_near("cy", v, 0, g.cameras[v].cy, wanted[v].cy, 1e-9);
        }
    }
}

/* What only stretched images show is found whether or not a focal length is looked for. The page alone is a plane, which tells
 * none; its edges are at right angles at one. In pages_seen() a camera of focal length f at a distance d from the middle of the
 * page, against which it is tilted by t, has f / d = 145, f sin(t) / d = 28 and cos(t) / d = 0.12: f = 145 cos(t) / 0.12, that is
 * 1185.6. */
static void a_focal_length_may_be_looked_for(void **state)
{
    static const asj_stretch automatic = {0, 0};
    const pages *p = *state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_result *r = NULL;
    asj_match_options options;
    asj_match_options_init(&options);
    options.geometry.model = ASJ_GEOMETRY_AUTO;
    for (int32_t k = 0; k < 3; k++) {
        options.geometry.find_focal = k > 0;
        options.upsample_from = k < 2 ? 0 : 16;
        assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &automatic, NULL, &options, &r), ASJ_OK);
        assert_true(r->stretch[0] == 1 && r->stretch[1] == 3 && pages_count_right(r) >= 80);
        assert_int_equal(r->geometry.status, ASJ_GEOMETRY_ACCEPTED);
        if (k == 0) {
            assert_true(r->geometry.model == ASJ_GEOMETRY_HOMOGRAPHY && r->geometry.cameras[0].fx == 0);
        } else {
            assert_int_equal(r->geometry.model, ASJ_GEOMETRY_ESSENTIAL);
            assert_true(r->geometry.focal_sd > 0 && r->geometry.focal_sd < 0.1);
            const double off = log(r->geometry.cameras[0].fx / 1185.6);
            unit_near("focal length, in standard deviations", k, 0, off / r->geometry.focal_sd, 0, 2);
        }
        asj_match_result_free(&r);
    }
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_they_are_it_is_what_two_calls_give),
        cmocka_unit_test(a_page_that_lies_flat_matches_when_it_is_stretched),
        cmocka_unit_test(automatically_the_first_look_that_is_enough_counts),
        cmocka_unit_test(a_homography_is_of_the_images_as_they_are),
        cmocka_unit_test(matrices_are_taken_back),
        cmocka_unit_test(a_focal_length_may_be_looked_for),
    };
    return cmocka_run_group_tests(tests, pages_set_up, pages_tear_down);
}
