/* SPDX-License-Identifier: BSD-2-Clause */
/* From images to matches: as they are it is what the two calls give; stretched, a page that lies flat matches where it did not, and
 * everything is in pixels of the images. */
#include "unit_test.h"

#include "core/context.h"
#include "look.h"
#include "match/unstretch.h"
#include "wide_pair.h"

#include <asj/asj.h>

enum { WIDTH = 420, HEIGHT = 200 };

/* Patches of a page, and half their sides. */
typedef struct print_size {
    int count;
    double least, most;
} print_size;
static const print_size large_print = {70, 0.08, 0.3}, small_print = {220, 0.03, 0.09};

/* Where a point of the page, -1 .. 1 along both axes, is seen: from low above, turned by `turn` for the second view. */
static synth_point seen(double u, double v, double turn)
{
    const double x = u * cos(turn) - v * sin(turn), y = u * sin(turn) + v * cos(turn);
    const double w = 1 - 0.12 * y;
    return (synth_point){0.5 * WIDTH + 145 * x / w, 0.5 * HEIGHT + 28 * y / w};
}

static double turn_of(int view)
{
    return view == 0 ? 0.1 : 0.75;
}

static uint8_t *page(const print_size *print, int view)
{
    synth_scene scene;
    synth_random random;
    synth_random_seed(&random, 8);
    synth_scene_init(&scene, WIDTH, HEIGHT, 120);
    for (int k = 0; k < print->count; k++) {
        const double u = synth_random_between(&random, -0.9, 0.9), v = synth_random_between(&random, -0.9, 0.9);
        const double a = synth_random_between(&random, print->least, print->most);
        const double b = synth_random_between(&random, print->least, print->most);
        const double gray = synth_random_between(&random, 30, 220);
        const synth_point corners[4] = {seen(u - a, v - b, turn_of(view)), seen(u + a, v - b, turn_of(view)),
                                        seen(u + a, v + b, turn_of(view)), seen(u - a, v + b, turn_of(view))};
        synth_scene_add(&scene, corners, 4, synth_flat(gray), k);
    }
    return unit_picture(&scene, 0.7, 1, 3 + (uint64_t)view);
}

/* px: how far a match is from what the page says. Newton's method in the page's coordinates. */
static double error_of(double x1, double y1, double x2, double y2)
{
    double u = 0, v = 0;
    for (int step = 0; step < 60; step++) {
        const synth_point p = seen(u, v, turn_of(0)), du = seen(u + 1e-6, v, turn_of(0)), dv = seen(u, v + 1e-6, turn_of(0));
        const double a = (du.x - p.x) * 1e6, b = (dv.x - p.x) * 1e6, c = (du.y - p.y) * 1e6, d = (dv.y - p.y) * 1e6;
        u += (d * (x1 - p.x) - b * (y1 - p.y)) / (a * d - b * c);
        v += (a * (y1 - p.y) - c * (x1 - p.x)) / (a * d - b * c);
    }
    const synth_point q = seen(u, v, turn_of(1));
    return hypot(q.x - x2, q.y - y2);
}

typedef struct pages {
    uint8_t *pixels[2];
    asj_image images[2];
} pages;

static int set_up(void **state)
{
    static pages made;
    for (int view = 0; view < 2; view++) {
        made.pixels[view] = page(&large_print, view);
        made.images[view] = unit_gray8(made.pixels[view], WIDTH, HEIGHT);
    }
    *state = &made;
    return 0;
}

static int tear_down(void **state)
{
    pages *made = *state;
    free(made->pixels[0]);
    free(made->pixels[1]);
    return 0;
}

static void expect_equal(const asj_match_result *a, const asj_match_result *b)
{
    assert_int_equal(a->match_count, b->match_count);
    assert_int_equal(a->l_junction_count1, b->l_junction_count1);
    assert_memory_equal(a->matches, b->matches, a->match_count * sizeof *a->matches);
    assert_memory_equal(a->l_junctions2, b->l_junctions2, a->l_junction_count2 * sizeof *a->l_junctions2);
}

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
    expect_equal(by_two, by_one);
    expect_equal(by_two, stretched);
    asj_match_result_free(&by_two);
    asj_match_result_free(&by_one);
    asj_match_result_free(&stretched);
    asj_detection_free(&found[0]);
    asj_detection_free(&found[1]);
    unit_context_free(&counter, &context);
}

static uint32_t count_right(const asj_match_result *r)
{
    uint32_t right = 0;
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *m = &r->matches[k];
        right += error_of((double)m->x1, (double)m->y1, (double)m->x2, (double)m->y2) < 3;
    }
    return right;
}

/* The parts of a match agree with each other: the map takes one location to the other, and lists name the same places. */
static void expect_consistent(const asj_match_result *r)
{
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *m = &r->matches[k];
        const double *h = m->affine, x = (double)m->x1, y = (double)m->y1;
        unit_near("x2", k, 0, (double)m->x2, h[0] * x + h[1] * y + h[2], 1e-3);
        unit_near("y2", k, 0, (double)m->y2, h[3] * x + h[4] * y + h[5], 1e-3);
        assert_true(m->l1 < r->l_junction_count1 && m->l2 < r->l_junction_count2);
        assert_true(m->x1 == r->l_junctions1[m->l1].x && m->y1 == r->l_junctions1[m->l1].y);
        unit_near("x of the L-junction", k, 0, (double)m->x2, (double)r->l_junctions2[m->l2].x, 9);
    }
    const size_t count = asj_match_segments(r, ASJ_END_CUT, NULL, 0);
    asj_segment_match *segments = calloc(count + 1, sizeof *segments);
    assert_non_null(segments);
    assert_int_equal(asj_match_segments(r, ASJ_END_CUT, segments, count), count);
    assert_true(count >= r->match_count);
    for (size_t k = 0; k < count; k++)
        assert_true(segments[k].x1 == r->matches[segments[k].match].x1 && segments[k].y2 == r->matches[segments[k].match].y2);
    free(segments);
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
        expect_equal(results[0], results[1]);
        expect_consistent(results[0]);
        const uint32_t right = count_right(results[0]);
        print_message("stretched by %g, %g: %u right of %u; as it is %u of %u\n", stretches[s].x, stretches[s].y, (unsigned)right,
                      (unsigned)results[0]->match_count, (unsigned)count_right(plain), (unsigned)plain->match_count);
        assert_true(right >= 20 && right >= least[s] * count_right(plain) && 20 * right >= 17 * results[0]->match_count);
        asj_match_result_free(&results[0]);
        asj_match_result_free(&results[1]);
    }
    asj_match_result_free(&plain);
    unit_context_free(&counters[0], &contexts[0]);
    unit_context_free(&counters[1], &contexts[1]);
}

/* As they are, or stretched; not upsampled. */
static asj_match_result *look(asj_context *context, const asj_image images[2], const asj_stretch *stretch, int32_t model)
{
    asj_match_options options;
    asj_match_result *r = NULL;
    asj_match_options_init(&options);
    options.geometry.model = model;
    options.upsample_from = 0;
    assert_int_equal(asj_match_images(context, &images[0], &images[1], stretch, NULL, &options, &r), ASJ_OK);
    return r;
}

/* As they are where that is enough; stretched, as if asked for it, where it is not; nothing new where nothing helps. */
static void automatically_the_first_look_that_is_enough_counts(void **state)
{
    static const asj_stretch automatic = {0, 0}, across = {1, 3};
    static const int32_t models[] = {ASJ_GEOMETRY_NONE, ASJ_GEOMETRY_AUTO};
    static uint8_t flat[WIDTH * HEIGHT];
    const pages *p = *state;
    const asj_image with_itself[2] = {p->images[0], p->images[0]};
    const asj_image unlike[2] = {p->images[0], unit_gray8(flat, WIDTH, HEIGHT)};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    for (size_t m = 0; m < UNIT_COUNT(models); m++) {
        asj_match_result *plain = look(context, p->images, NULL, models[m]), *one = look(context, p->images, &across, models[m]);
        asj_match_result *found = look(context, p->images, &automatic, models[m]);
        assert_true(plain->match_count < 16 && plain->stretch[0] == 1 && plain->stretch[1] == 1);
        assert_true(found->stretch[0] == 1 && found->stretch[1] == 3 && one->stretch[1] == 3);
        expect_equal(one, found);
        expect_consistent(found);
        assert_true(found->stage_ms[ASJ_STAGE_CANDIDATES] > 0 && count_right(found) > 2 * count_right(plain));
        asj_match_result_free(&plain);
        asj_match_result_free(&one);
        asj_match_result_free(&found);

        plain = look(context, with_itself, NULL, models[m]);
        found = look(context, with_itself, &automatic, models[m]);
        assert_true(found->match_count >= 16 && found->stretch[0] == 1 && found->stretch[1] == 1);
        expect_equal(plain, found);
        asj_match_result_free(&plain);
        asj_match_result_free(&found);

        found = look(context, unlike, &automatic, models[m]);
        assert_true(found->match_count == 0 && found->stretch[0] == 1 && found->stretch[1] == 1);
        asj_match_result_free(&found);
    }
    unit_context_free(&counter, &context);
}

/* What a stretch answers is upsampled too, with the same stretch, under one geometry. */
static void a_stretched_page_is_upsampled_too(void **state)
{
    static const asj_stretch automatic = {0, 0};
    static const int32_t models[] = {ASJ_GEOMETRY_NONE, ASJ_GEOMETRY_HOMOGRAPHY};
    uint8_t *pixels[2] = {page(&small_print, 0), page(&small_print, 1)};
    const asj_image images[2] = {unit_gray8(pixels[0], WIDTH, HEIGHT), unit_gray8(pixels[1], WIDTH, HEIGHT)};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    (void)state;
    for (size_t m = 0; m < UNIT_COUNT(models); m++) {
        asj_match_options options;
        asj_match_result *plain = look(context, images, &automatic, models[m]), *both = NULL;
        asj_match_options_init(&options);
        options.geometry.model = models[m];
        assert_int_equal(asj_match_images(context, &images[0], &images[1], &automatic, NULL, &options, &both), ASJ_OK);
        const uint32_t right = count_right(both);
        print_message("stretched: %u right of %u; upsampled too %u of %u\n", (unsigned)count_right(plain),
                      (unsigned)plain->match_count, (unsigned)right, (unsigned)both->match_count);
        assert_true(plain->upsampled == 0 && both->upsampled == 1 && both->stretch[0] == 1 && both->stretch[1] == 3);
        assert_true(2 * right > 3 * count_right(plain) && 20 * right >= 18 * both->match_count);
        assert_int_equal(both->geometry.status, m ? ASJ_GEOMETRY_ACCEPTED : ASJ_GEOMETRY_NOT_ASKED);
        uint32_t probable = 0;
        for (uint32_t k = 0; k < both->match_count; k++)
            probable += both->matches[k].probability > 0.5F;
        assert_true(m ? 10 * probable > 9 * both->match_count : probable == 0);
        asj_match_result_free(&plain);
        asj_match_result_free(&both);
    }
    free(pixels[0]);
    free(pixels[1]);
    unit_context_free(&counter, &context);
}

/* --- upsampled by themselves -------------------------------------------------------------------------------------------------- */

/* Whether a match of `r` has both places of m (2), one of them (1) or none. */
static int places_of(const asj_match_result *r, const asj_junction_match *m)
{
    int most = 0;
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *f = &r->matches[k];
        const int at1 = fabsf(f->x1 - m->x1) <= 4 && fabsf(f->y1 - m->y1) <= 4;
        const int at2 = fabsf(f->x2 - m->x2) <= 4 && fabsf(f->y2 - m->y2) <= 4;
        most = at1 + at2 > most ? at1 + at2 : most;
    }
    return most;
}

/* One answer of both looks: more matches than the images have, all of theirs that nothing else takes the place of, smallest
 * distance first, with the numbers of their own L-junctions and junctions; also judged by the images' own geometry; with any number
 * of threads. */
static void automatically_images_are_upsampled_too(void **state)
{
    static const asj_stretch automatic = {0, 0};
    static const int32_t models[] = {ASJ_GEOMETRY_NONE, ASJ_GEOMETRY_HOMOGRAPHY};
    const pages *p = *state;
    const asj_image images[2] = {p->images[0], p->images[0]};
    unit_counter counters[2] = {{0}, {0}};
    asj_context *contexts[2] = {unit_context(&counters[0], 1), unit_context(&counters[1], 2)};
    for (size_t m = 0; m < UNIT_COUNT(models); m++) {
        asj_match_result *plain = look(contexts[1], images, NULL, models[m]), *found[2] = {NULL, NULL};
        asj_match_options options;
        asj_match_options_init(&options);
        options.geometry.model = models[m];
        for (int n = 0; n < 2; n++)
            assert_int_equal(asj_match_images(contexts[n], &images[0], &images[1], &automatic, NULL, &options, &found[n]), ASJ_OK);
        expect_equal(found[0], found[1]);
        const asj_match_result *r = found[0];
        expect_consistent(r);
        print_message("%u matches, upsampled too %u\n", (unsigned)plain->match_count, (unsigned)r->match_count);
        assert_true(r->upsampled == 1 && plain->upsampled == 0 && 2 * r->match_count > 3 * plain->match_count);
        for (uint32_t k = 0; k < plain->match_count; k++)
            assert_true(places_of(r, &plain->matches[k]) > 0);
        for (uint32_t k = 0; k < r->match_count; k++) {
            const asj_junction_match *a = &r->matches[k];
            assert_true(k == 0 || r->matches[k - 1].distance <= a->distance);
            assert_int_equal(a->junction1, r->l_junctions1[a->l1].junction);
            assert_int_equal(a->junction2, r->l_junctions2[a->l2].junction);
        }
        assert_int_equal(r->geometry.status, plain->geometry.status);
        assert_memory_equal(r->geometry.matrix, plain->geometry.matrix, sizeof r->geometry.matrix);
        for (int n = 0; n < 2; n++)
            asj_match_result_free(&found[n]);
        asj_match_result_free(&plain);
    }
    unit_context_free(&counters[0], &contexts[0]);
    unit_context_free(&counters[1], &contexts[1]);
}

/* Half-way between the octaves of the upsampled images there are more matches, which are true, too; the images as they are go
 * without, unless half octaves are asked for. */
static void upsampled_images_have_half_octaves(void **state)
{
    static const asj_stretch automatic = {0, 0};
    const pages *p = *state;
    const asj_image *image = &p->images[0];
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_options options;
    asj_match_result *found[2], *plain[2] = {NULL, NULL};
    asj_match_options_init(&options);
    for (int32_t half = 0; half < 2; half++) {
        options.upsampled_half_octaves = half;
        assert_int_equal(asj_match_images(context, image, image, &automatic, NULL, &options, &found[half]), ASJ_OK);
        assert_int_equal(asj_match_images(context, image, image, NULL, NULL, &options, &plain[half]), ASJ_OK);
        assert_true(found[half]->upsampled == 1);
        for (uint32_t k = 0; k < found[half]->match_count; k++) {
            const asj_junction_match *m = &found[half]->matches[k]; /* of an image with itself */
            assert_true(hypot((double)(m->x1 - m->x2), (double)(m->y1 - m->y2)) < 2);
        }
    }
    print_message("%u matches, with half octaves %u\n", (unsigned)found[0]->match_count, (unsigned)found[1]->match_count);
    assert_true(5 * found[1]->match_count > 6 * found[0]->match_count);
    expect_equal(plain[0], plain[1]);
    for (int32_t half = 0; half < 2; half++) {
        asj_match_result_free(&found[half]);
        asj_match_result_free(&plain[half]);
    }
    unit_context_free(&counter, &context);
}

/* Fewer junctions of the upsampled images have fewer matches; as many as there are, and 0, are all of them. */
static void the_most_meaningful_junctions_are_enough(void **state)
{
    static const asj_stretch automatic = {0, 0};
    static const int32_t most[] = {0, 1000000, 150};
    const pages *p = *state;
    const asj_image *image = &p->images[0];
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_options options;
    asj_match_result *found[UNIT_COUNT(most)];
    asj_match_options_init(&options);
    for (size_t k = 0; k < UNIT_COUNT(most); k++) {
        options.upsampled_max_junctions = most[k];
        assert_int_equal(asj_match_images(context, image, image, &automatic, NULL, &options, &found[k]), ASJ_OK);
        assert_true(found[k]->upsampled == 1);
    }
    expect_equal(found[0], found[1]);
    assert_true(found[2]->match_count < found[0]->match_count && found[2]->l_junction_count1 < found[0]->l_junction_count1);
    for (size_t k = 0; k < UNIT_COUNT(most); k++)
        asj_match_result_free(&found[k]);
    unit_context_free(&counter, &context);
}

/* Partners are looked for where the images' own matches put them: fewer candidates, and as many matches of an image with itself. A
 * reach of the whole image and none are the same. */
static void partners_lie_where_they_are_expected(void **state)
{
    static const asj_stretch automatic = {0, 0};
    static const double reach[] = {0, 1, 0.01};
    const pages *p = *state;
    const asj_image *image = &p->images[0];
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_options options;
    asj_match_result *found[UNIT_COUNT(reach)];
    asj_match_options_init(&options);
    options.upsampled_shortlist = 0;
    for (size_t k = 0; k < UNIT_COUNT(reach); k++) {
        options.upsampled_search_radius = reach[k];
        assert_int_equal(asj_match_images(context, image, image, &automatic, NULL, &options, &found[k]), ASJ_OK);
        assert_true(found[k]->upsampled == 1);
    }
    print_message("%u matches anywhere, %u near\n", (unsigned)found[0]->match_count, (unsigned)found[2]->match_count);
    expect_equal(found[0], found[1]);
    assert_true(found[2]->candidates < found[0]->candidates && found[2]->match_count >= found[0]->match_count);
    for (size_t k = 0; k < UNIT_COUNT(reach); k++)
        asj_match_result_free(&found[k]);
    unit_context_free(&counter, &context);
}

/* Who asks for octave -1, for one octave, for more matches than there are or for none of it gets what the images have. */
static void images_are_not_upsampled_unasked(void **state)
{
    static const asj_stretch automatic = {0, 0};
    const pages *p = *state;
    const asj_image *image = &p->images[0];
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_detect_options detect_options;
    asj_match_options options;
    for (int k = 0; k < 4; k++) {
        asj_match_result *plain = NULL, *found = NULL;
        asj_detect_options_preset(&detect_options, ASJ_PRESET_MATCH);
        asj_match_options_init(&options);
        detect_options.octaves = k == 0 ? 1 : detect_options.octaves;
        detect_options.first_octave = k == 1 ? -1 : 0;
        options.upsample_from = k == 2 ? 100000 : k == 3 ? 0 : options.upsample_from;
        assert_int_equal(asj_match_images(context, image, image, NULL, &detect_options, &options, &plain), ASJ_OK);
        assert_int_equal(asj_match_images(context, image, image, &automatic, &detect_options, &options, &found), ASJ_OK);
        expect_equal(plain, found);
        assert_true(found->match_count >= 16 && found->upsampled == (k == 1));
        asj_match_result_free(&plain);
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
            const synth_point from = seen(u, v, turn_of(0)), to = seen(u, v, turn_of(1));
            const double w = h[6] * from.x + h[7] * from.y + h[8];
            unit_near("x", u, v, (h[0] * from.x + h[1] * from.y + h[2]) / w, to.x, 2);
            unit_near("y", u, v, (h[3] * from.x + h[4] * from.y + h[5]) / w, to.y, 2);
        }
    asj_match_result_free(&r);
    unit_context_free(&counter, &context);
}

/* Cameras are those of the images as they are, and so is the fundamental matrix; the pose is that of the cameras. */
static void a_pose_is_found_in_upsampled_images(void **state)
{
    const asj_stretch stretch = {1.5, 1.25};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    synth_wide_pair pair;
    uint8_t *pixels[2];
    asj_image images[2];
    asj_match_options options;
    asj_match_result *r = NULL;
    double wanted[9];
    (void)state;
    assert_int_equal(synth_wide_pair_make(&pair, 6), 0);
    asj_match_options_init(&options);
    options.geometry.model = ASJ_GEOMETRY_AUTO;
    for (int k = 0; k < 2; k++) {
        const double f = pair.cameras[k].focal;
        pixels[k] = synth_wide_picture(&pair, k);
        assert_non_null(pixels[k]);
        images[k] = (asj_image){pixels[k], ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
        options.geometry.cameras[k] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    }
    assert_int_equal(asj_match_images(context, &images[0], &images[1], &stretch, NULL, &options, &r), ASJ_OK);
    assert_int_equal(r->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_true(r->geometry.has_pose);
    const synth_pose_error off = synth_pose_off(&pair.cameras[0], &pair.cameras[1], r->geometry.rotation, r->geometry.translation);
    unit_near("rotation, deg", 0, 0, off.rotation, 0, 2);
    unit_near("translation, deg", 0, 0, off.translation, 0, 3);
    unit_near("focal length", 0, 0, r->geometry.focal[0], pair.cameras[0].focal, 1e-6);
    synth_fundamental(&pair.cameras[0], &pair.cameras[1], wanted);
    double between = 0, norm = 0;
    for (int k = 0; k < 9; k++) {
        between += wanted[k] * r->geometry.matrix[k];
        norm += wanted[k] * wanted[k];
    }
    unit_near("fundamental matrix", 0, 0, fabs(between) / sqrt(norm), 1, 1e-3);
    asj_match_result_free(&r);
    synth_wide_pair_free(&pair);
    free(pixels[0]);
    free(pixels[1]);
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
        asj_geometry g = {.model = model, .focal = {600, 500}};
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
        unit_near("focal length", 0, 0, g.focal[0], 300, 1e-9);
        unit_near("focal length", 1, 0, g.focal[1], 400, 1e-9);
    }
}

static void what_cannot_be_is_refused(void **state)
{
    static const asj_stretch outside[] = {{0.4, 1}, {1, 8.5}, {NAN, 1}, {1, -1}, {INFINITY, 2}, {0, 1}, {3, 0}};
    const pages *p = *state;
    const asj_stretch along = {1, 2}, most = {8, 8};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_result *r = (asj_match_result *)&counter;
    for (size_t k = 0; k < UNIT_COUNT(outside); k++) {
        assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &outside[k], NULL, NULL, &r), ASJ_ERROR_OPTION);
        assert_null(r);
    }
    const asj_stretch least = {0.5, 0.5};
    assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &least, NULL, NULL, &r), ASJ_OK);
    assert_true(r->stretch[0] == 0.5 && r->stretch[1] == 0.5);
    asj_match_result_free(&r);
    assert_int_equal(asj_match_images(context, NULL, &p->images[1], NULL, NULL, NULL, &r), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], NULL, NULL, NULL, NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_match_images(NULL, &p->images[0], &p->images[1], NULL, NULL, NULL, &r), ASJ_ERROR_ARGUMENT);
    const asj_image wide = {p->pixels[0], ASJ_FORMAT_GRAY8, 10000, 8, 0, 0}, empty = {p->pixels[0], ASJ_FORMAT_GRAY8, 0, 8, 0, 0};
    assert_int_equal(asj_match_images(context, &wide, &p->images[1], &most, NULL, NULL, &r), ASJ_ERROR_LIMIT);
    const asj_image large = {p->pixels[0], ASJ_FORMAT_GRAY8, 16384, 8192, 0, 0};
    assert_true(asj_look_fits(&large, &(asj_stretch){2, 2}) && !asj_look_fits(&large, &(asj_stretch){2, 2.01}));
    assert_true(asj_look_fits(&wide, &(asj_stretch){6.5, 1}) && !asj_look_fits(&wide, &(asj_stretch){6.56, 1}));
    assert_int_equal(asj_match_images(context, &p->images[0], &empty, &along, NULL, NULL, &r), ASJ_ERROR_IMAGE);
    assert_null(r);
    unit_context_free(&counter, &context);
}

/* What only stretched images show is found whether or not a focal length is looked for. The page alone is a plane, which tells
 * none; its edges are at right angles at one. In seen() a camera of focal length f at a distance d from the middle of the page,
 * against which it is tilted by t, has f / d = 145, f sin(t) / d = 28 and cos(t) / d = 0.12: f = 145 cos(t) / 0.12 = 1185.6. */
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
        assert_true(r->stretch[0] == 1 && r->stretch[1] == 3 && count_right(r) >= 80);
        assert_int_equal(r->geometry.status, ASJ_GEOMETRY_ACCEPTED);
        if (k == 0) {
            assert_true(r->geometry.model == ASJ_GEOMETRY_HOMOGRAPHY && r->geometry.focal[0] == 0);
        } else {
            assert_int_equal(r->geometry.model, ASJ_GEOMETRY_ESSENTIAL);
            assert_true(r->geometry.focal_sd > 0 && r->geometry.focal_sd < 0.1);
            const double off = log(r->geometry.focal[0] / 1185.6);
            unit_near("focal length, in standard deviations", k, 0, off / r->geometry.focal_sd, 0, 2);
        }
        asj_match_result_free(&r);
    }
    unit_context_free(&counter, &context);
}

/* An image that is too long to be stretched is looked at as it is. */
static void automatically_nothing_is_too_large(void **state)
{
    static uint8_t thin[ASJ_MAX_SIDE / 2 * 8];
    static const asj_stretch automatic = {0, 0}, along = {3, 1};
    const asj_image images[2] = {unit_gray8(thin, ASJ_MAX_SIDE / 2, 8), unit_gray8(thin, 8, ASJ_MAX_SIDE / 2)};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_result *r = NULL;
    (void)state;
    assert_int_equal(asj_match_images(context, &images[0], &images[1], &along, NULL, NULL, &r), ASJ_ERROR_LIMIT);
    assert_int_equal(asj_match_images(context, &images[0], &images[1], &automatic, NULL, NULL, &r), ASJ_OK);
    assert_true(r->match_count == 0 && r->stretch[0] == 1 && r->stretch[1] == 1);
    asj_match_result_free(&r);
    /* and with octave -1, which upsamples it once more */
    asj_detect_options upsampled;
    asj_detect_options_preset(&upsampled, ASJ_PRESET_MATCH);
    upsampled.first_octave = -1;
    const asj_image flat[2] = {unit_gray8(thin, ASJ_MAX_SIDE / 5, 8), unit_gray8(thin, ASJ_MAX_SIDE / 5, 8)};
    assert_int_equal(asj_match_images(context, &flat[0], &flat[1], &along, &upsampled, NULL, &r), ASJ_ERROR_LIMIT);
    assert_int_equal(asj_match_images(context, &flat[0], &flat[1], &automatic, &upsampled, NULL, &r), ASJ_OK);
    asj_match_result_free(&r);
    unit_context_free(&counter, &context);
}

/* Octave -1 of an upsampled image is held to what is found without it, as of one that is not. */
static void octave_minus_one_needs_a_witness_in_upsampled_images(void **state)
{
    const asj_stretch twice = {2, 2};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_detect_options options[2];
    asj_match_result *results[2] = {NULL, NULL};
    const pages *p = *state;
    asj_detect_options_preset(&options[0], ASJ_PRESET_MATCH);
    options[1] = options[0];
    options[1].first_octave = -1;
    for (int k = 0; k < 2; k++)
        assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &twice, &options[k], NULL, &results[k]), ASJ_OK);
    uint32_t again = 0;
    for (uint32_t i = 0; i < results[0]->match_count; i++)
        for (uint32_t j = 0; j < results[1]->match_count; j++) {
            const asj_junction_match *a = &results[0]->matches[i], *b = &results[1]->matches[j];
            if (hypot((double)a->x1 - (double)b->x1, (double)a->y1 - (double)b->y1) < 4 &&
                hypot((double)a->x2 - (double)b->x2, (double)a->y2 - (double)b->y2) < 4) {
                again++;
                break;
            }
        }
    print_message("upsampled: %u; with octave -1: %u, of the others %u\n", (unsigned)results[0]->match_count,
                  (unsigned)results[1]->match_count, (unsigned)again);
    assert_true(results[0]->match_count > 0 && 10 * again >= 3 * results[0]->match_count);
    asj_match_result_free(&results[0]);
    asj_match_result_free(&results[1]);
    unit_context_free(&counter, &context);
}

/* What the caller is told, and when it says stop. */
typedef struct listener {
    double last;
    int falls, calls, stop_at;
} listener;

static int32_t listen(void *user, int32_t stage, double done)
{
    listener *l = user;
    (void)stage;
    l->falls += done < l->last || done > 1;
    l->last = done;
    return ++l->calls == l->stop_at;
}

/* Over the whole call, and never back; stopped anywhere, there is no result and nothing is lost. */
static void progress_never_falls_and_the_caller_may_stop(void **state)
{
    static const asj_stretch stretches[] = {{1, 2}, {0, 0}};
    const pages *p = *state;
    listener l = {0};
    int all = 0;
    for (int n = 0; n < 2 || n * 9 < all; n++) { /* twice to the end */
        const int whole = n < 2;
        unit_counter counter = {0};
        asj_context_options options;
        asj_context *context = NULL;
        asj_match_result *r = NULL;
        asj_context_options_init(&options);
        options.allocator = (asj_allocator){unit_allocate, unit_release, &counter};
        options.threads = 1;
        options.progress = listen;
        options.progress_user = &l;
        l = (listener){.stop_at = whole ? 0 : n * 9};
        assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
        const asj_status status = asj_match_images(context, &p->images[0], &p->images[1], &stretches[n % 2], NULL, NULL, &r);
        assert_int_equal(l.falls, 0);
        if (whole) {
            assert_int_equal(status, ASJ_OK);
            unit_near("at the end", 0, 0, l.last, 1, 1e-9);
            assert_true(r->stage_ms[ASJ_STAGE_CANDIDATES] > 0 && r->total_ms > r->stage_ms[ASJ_STAGE_CANDIDATES]);
            all = l.calls;
        } else {
            assert_true(status == ASJ_ERROR_CANCELLED || (status == ASJ_OK && l.calls < l.stop_at)); /* the clock asks, too */
        }
        asj_match_result_free(&r);
        unit_context_free(&counter, &context);
    }
    assert_true(all > 20);
}

/* A second call with the same context begins at 0, though it stretches the images first and its caller has not been asked for long;
 * and a part that ends at the whole ends at 1, however its limits are rounded. */
static void progress_begins_and_ends_where_it_should(void **state)
{
    static const asj_stretch twice = {2, 2};
    const pages *p = *state;
    listener l = {0};
    asj_context_options options;
    asj_context *context = NULL;
    asj_match_result *r = NULL;
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    options.threads = 1;
    options.progress = listen;
    options.progress_user = &l;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    for (int n = 0; n < 2; n++) {
        l = (listener){0};
        context->asked_ms -= 1000;
        assert_int_equal(asj_match_images(context, &p->images[0], &p->images[1], &twice, NULL, NULL, &r), ASJ_OK);
        assert_int_equal(l.falls, 0);
        assert_true(l.last == 1);
        asj_match_result_free(&r);
    }
    l = (listener){0};
    context->progress = 0;
    context->progress_from = 0.9;
    context->progress_part = 0.1 + 1e-15;
    assert_int_equal(asj_progress(context, ASJ_STAGE_ASSIGN, 1), ASJ_OK);
    assert_true(l.last == 1);
    asj_context_free(&context);
}

static void expect_allocations_may_fail(const asj_image *image, const asj_stretch *stretch)
{
    int reached = 1;
    for (long n = 1; n < 2000 && reached; n++) {
        unit_counter counter = {0};
        asj_context *poor = unit_context(&counter, 1);
        asj_match_result *r = NULL;
        counter.fail_at = counter.calls + n;
        const asj_status status = asj_match_images(poor, image, image, stretch, NULL, NULL, &r);
        reached = unit_reached(&counter);
        assert_true(status == ASJ_OK ? r != NULL : reached && status == ASJ_ERROR_MEMORY && !r);
        asj_match_result_free(&r);
        unit_context_free(&counter, &poor);
    }
    assert_false(reached);
}

static void every_allocation_may_fail(void **state)
{
    static const uint8_t dark[24 * 20];
    static const asj_stretch stretches[] = {{2, 1}, {0, 0}};
    const asj_image image = unit_gray8(dark, 24, 20);
    (void)state;
    for (size_t s = 0; s < UNIT_COUNT(stretches); s++)
        expect_allocations_may_fail(&image, &stretches[s]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(as_they_are_it_is_what_two_calls_give),
        cmocka_unit_test(a_page_that_lies_flat_matches_when_it_is_stretched),
        cmocka_unit_test(automatically_the_first_look_that_is_enough_counts),
        cmocka_unit_test(a_stretched_page_is_upsampled_too),
        cmocka_unit_test(automatically_images_are_upsampled_too),
        cmocka_unit_test(images_are_not_upsampled_unasked), cmocka_unit_test(upsampled_images_have_half_octaves),
        cmocka_unit_test(the_most_meaningful_junctions_are_enough),
        cmocka_unit_test(partners_lie_where_they_are_expected),
        cmocka_unit_test(a_homography_is_of_the_images_as_they_are),
        cmocka_unit_test(a_pose_is_found_in_upsampled_images),
        cmocka_unit_test(matrices_are_taken_back),
        cmocka_unit_test(what_cannot_be_is_refused),
        cmocka_unit_test(a_focal_length_may_be_looked_for),
        cmocka_unit_test(automatically_nothing_is_too_large),
        cmocka_unit_test(octave_minus_one_needs_a_witness_in_upsampled_images),
        cmocka_unit_test(progress_never_falls_and_the_caller_may_stop),
        cmocka_unit_test(progress_begins_and_ends_where_it_should),
        cmocka_unit_test(every_allocation_may_fail),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
