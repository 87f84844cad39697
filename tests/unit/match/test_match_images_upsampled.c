/* SPDX-License-Identifier: BSD-2-Clause */
/* From images to matches, upsampled by themselves where they are small: one answer of both looks. */
#include "pages.h"

#include "core/context.h"
#include "core/stretch.h"
#include "look.h"
#include "wide_pair.h"

/* What a stretch answers is upsampled too, with the same stretch, under one geometry. */
static void a_stretched_page_is_upsampled_too(void **state)
{
    static const asj_stretch automatic = {0, 0};
    static const int32_t models[] = {ASJ_GEOMETRY_NONE, ASJ_GEOMETRY_HOMOGRAPHY};
    uint8_t *pixels[2] = {pages_draw(&pages_small_print, 0), pages_draw(&pages_small_print, 1)};
    const asj_image images[2] = {unit_gray8(pixels[0], PAGE_WIDTH, PAGE_HEIGHT), unit_gray8(pixels[1], PAGE_WIDTH, PAGE_HEIGHT)};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    (void)state;
    for (size_t m = 0; m < UNIT_COUNT(models); m++) {
        asj_match_options options;
        asj_match_result *plain = pages_look(context, images, &automatic, models[m]), *both = NULL;
        asj_match_options_init(&options);
        options.geometry.model = models[m];
        assert_int_equal(asj_match_images(context, &images[0], &images[1], &automatic, NULL, &options, &both), ASJ_OK);
        const uint32_t right = pages_count_right(both);
        print_message("stretched: %u right of %u; upsampled too %u of %u\n", (unsigned)pages_count_right(plain),
                      (unsigned)plain->match_count, (unsigned)right, (unsigned)both->match_count);
        assert_true(plain->upsampled == 0 && both->upsampled == 1 && both->stretch[0] == 1 && both->stretch[1] == 3);
        assert_true(2 * right > 3 * pages_count_right(plain) && 20 * right >= 18 * both->match_count);
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
        asj_match_result *plain = pages_look(contexts[1], images, NULL, models[m]), *found[2] = {NULL, NULL};
        asj_match_options options;
        asj_match_options_init(&options);
        options.geometry.model = models[m];
        for (int n = 0; n < 2; n++)
            assert_int_equal(asj_match_images(contexts[n], &images[0], &images[1], &automatic, NULL, &options, &found[n]), ASJ_OK);
        pages_expect_equal(found[0], found[1]);
        const asj_match_result *r = found[0];
        pages_expect_consistent(r);
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
    pages_expect_equal(plain[0], plain[1]);
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
    pages_expect_equal(found[0], found[1]);
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
    pages_expect_equal(found[0], found[1]);
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
        pages_expect_equal(plain, found);
        assert_true(found->match_count >= 16 && found->upsampled == (k == 1));
        asj_match_result_free(&plain);
        asj_match_result_free(&found);
    }
    unit_context_free(&counter, &context);
}

/* Both pictures, to be freed. */
static void draw_pair(const synth_wide_pair *pair, uint8_t *pixels[2], asj_image images[2])
{
    for (int k = 0; k < 2; k++) {
        pixels[k] = synth_wide_picture(pair, k);
        assert_non_null(pixels[k]);
        images[k] = (asj_image){pixels[k], ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
    }
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
    draw_pair(&pair, pixels, images);
    for (int k = 0; k < 2; k++) {
        const double f = pair.cameras[k].focal;
        options.geometry.cameras[k] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    }
    assert_int_equal(asj_match_images(context, &images[0], &images[1], &stretch, NULL, &options, &r), ASJ_OK);
    assert_int_equal(r->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_true(r->geometry.has_pose);
    const synth_pose_error off = synth_pose_off(&pair.cameras[0], &pair.cameras[1], r->geometry.rotation, r->geometry.translation);
    unit_near("rotation, deg", 0, 0, off.rotation, 0, 2);
    unit_near("translation, deg", 0, 0, off.translation, 0, 3);
    unit_near("focal length", 0, 0, r->geometry.cameras[0].fx, pair.cameras[0].focal, 1e-6);
    unit_near("principal point", 0, 0, r->geometry.cameras[0].cx, 0.5 * (SYNTH_WIDE_WIDTH - 1), 1e-6);
    unit_near("principal point", 1, 0, r->geometry.cameras[1].cy, 0.5 * (SYNTH_WIDE_HEIGHT - 1), 1e-6);
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

/* A pair whose geometry the luma leaves to chance, with cameras. */
static void find_with_colours(asj_context *context, const asj_image images[2], const synth_wide_pair *pair, int32_t look_at_colours,
                              asj_match_result **r)
{
    static const asj_stretch automatic = {0, 0};
    asj_match_options options;
    asj_match_options_init(&options);
    assert_int_equal(options.look_at_colours, 1);
    options.look_at_colours = look_at_colours;
    options.geometry.model = ASJ_GEOMETRY_AUTO;
    for (int k = 0; k < 2; k++) {
        const double f = pair->cameras[k].focal;
        options.geometry.cameras[k] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    }
    assert_int_equal(asj_match_images(context, &images[0], &images[1], &automatic, NULL, &options, r), ASJ_OK);
}

/* Where the luma leaves the geometry to chance the colours are looked at, unless that is not wanted, or there are none. */
static void colours_are_looked_at_where_nothing_is_found(void **state)
{
    synth_wide_pair pair;
    uint8_t *pixels[2];
    asj_image images[2];
    asj_match_result *r[3] = {NULL, NULL, NULL};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    (void)state;
    assert_int_equal(synth_wide_pair_make(&pair, 1127), 0);
    draw_pair(&pair, pixels, images);
    find_with_colours(context, images, &pair, 0, &r[0]);
    find_with_colours(context, images, &pair, 1, &r[1]);
    assert_int_equal(r[0]->geometry.status, ASJ_GEOMETRY_CHANCE);
    assert_int_equal(r[1]->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_true(r[1]->geometry.has_pose && r[1]->match_count > r[0]->match_count && r[1]->coloured && !r[0]->coloured);
    const asj_geometry *g = &r[1]->geometry;
    const synth_pose_error off = synth_pose_off(&pair.cameras[0], &pair.cameras[1], g->rotation, g->translation);
    unit_near("rotation, deg", 0, 0, off.rotation, 0, 2);
    unit_near("translation, deg", 0, 0, off.translation, 0, 3);
    for (int v = 0; v < 2; v++) /* without colours */
        for (size_t k = 0; k < (size_t)SYNTH_WIDE_WIDTH * SYNTH_WIDE_HEIGHT; k++) {
            uint8_t *p = pixels[v] + 3 * k;
            p[0] = p[1] = p[2] = (uint8_t)((77 * p[0] + 150 * p[1] + 29 * p[2] + 128) >> 8);
        }
    find_with_colours(context, images, &pair, 1, &r[2]);
    assert_int_equal(r[2]->geometry.status, ASJ_GEOMETRY_CHANCE);
    for (int k = 0; k < 3; k++)
        asj_match_result_free(&r[k]);
    synth_wide_pair_free(&pair);
    free(pixels[0]);
    free(pixels[1]);
    unit_context_free(&counter, &context);
}

#define TIMES 3

/* So many times as long, and as soft as that makes it. */
static asj_image enlarged(asj_context *context, const asj_image *image, void **made)
{
    const int32_t width = TIMES * image->width, height = TIMES * image->height;
    asj_image large;
    assert_int_equal(asj_stretch_image(context, &context->memory, image, width, height, &large, made), ASJ_OK);
    return large;
}

/* How many matches of the enlarged pair are within 2 px of the pair's epipolar lines. */
static uint32_t count_on_lines(const asj_match_result *r, const double f[9])
{
    uint32_t count = 0;
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *m = &r->matches[k];
        const double x1 = ((double)m->x1 + 0.5) / TIMES - 0.5, y1 = ((double)m->y1 + 0.5) / TIMES - 0.5;
        const double x2 = ((double)m->x2 + 0.5) / TIMES - 0.5, y2 = ((double)m->y2 + 0.5) / TIMES - 0.5;
        const double a = f[0] * x1 + f[1] * y1 + f[2], b = f[3] * x1 + f[4] * y1 + f[5], c = f[6] * x1 + f[7] * y1 + f[8];
        count += fabs(a * x2 + b * y2 + c) < 2 * hypot(a, b);
    }
    return count;
}

static void expect_not_halved(asj_context *context, const asj_image *first, const asj_image *second,
                              const asj_detect_options *options)
{
    static const asj_stretch automatic = {0, 0};
    asj_match_result *r = NULL;
    assert_int_equal(asj_match_images(context, first, second, &automatic, options, NULL, &r), ASJ_OK);
    assert_true(r->stretch[0] >= 1 && r->stretch[1] >= 1);
    asj_match_result_free(&r);
}

/* Large images are looked at halved, and upsampled from there; not where the caller says how, nor where one of them is small. */
static void large_images_are_halved(void **state)
{
    static const asj_stretch automatic = {0, 0};
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    synth_wide_pair pair;
    uint8_t *pixels[2];
    void *made[2] = {NULL, NULL};
    asj_image small[2], large[2];
    asj_detect_options one_octave;
    asj_match_result *plain = NULL, *found = NULL;
    double f[9];
    (void)state;
    assert_int_equal(synth_near_pair_make(&pair, 6), 0);
    synth_fundamental(&pair.cameras[0], &pair.cameras[1], f);
    draw_pair(&pair, pixels, small);
    for (int k = 0; k < 2; k++)
        large[k] = enlarged(context, &small[k], &made[k]);
    assert_int_equal(asj_match_images(context, &large[0], &large[1], NULL, NULL, NULL, &plain), ASJ_OK);
    assert_int_equal(asj_match_images(context, &large[0], &large[1], &automatic, NULL, NULL, &found), ASJ_OK);
    const uint32_t right[2] = {count_on_lines(plain, f), count_on_lines(found, f)};
    print_message("as they are %u of %u right, automatically %u of %u\n", (unsigned)right[0], (unsigned)plain->match_count,
                  (unsigned)right[1], (unsigned)found->match_count);
    assert_true(found->stretch[0] == 0.5 && found->stretch[1] == 0.5 && found->upsampled == 1);
    assert_true(2 * right[1] > 3 * right[0] && 20 * right[1] >= 19 * found->match_count);
    expect_not_halved(context, &large[0], &small[1], NULL);
    asj_detect_options_preset(&one_octave, ASJ_PRESET_MATCH);
    one_octave.octaves = 1;
    expect_not_halved(context, &large[0], &large[1], &one_octave);
    asj_match_result_free(&found);
    asj_match_result_free(&plain);
    for (int k = 0; k < 2; k++) {
        asj_release(&context->memory, made[k]);
        free(pixels[k]);
    }
    synth_wide_pair_free(&pair);
    unit_context_free(&counter, &context);
}

/* A ramp stays one when less than half of it is left: halved first, and the rest of the way then. */
static void a_quarter_is_half_of_a_half(void **state)
{
    enum { WIDTH = 403, HEIGHT = 250 };
    static uint8_t ramp[WIDTH * HEIGHT];
    const asj_image image = unit_gray8(ramp, WIDTH, HEIGHT), *const images[2] = {&image, &image};
    const asj_stretch stretch = {0.2, 0.3};
    asj_detect_options options;
    asj_look eyes;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    (void)state;
    for (int k = 0; k < WIDTH * HEIGHT; k++)
        ramp[k] = (uint8_t)(k % WIDTH / 2 + k / WIDTH / 10);
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    assert_int_equal(asj_look_open(context, images, &stretch, &options, NULL, 0, 1, &eyes), ASJ_OK);
    const asj_image *small = &eyes.views[0].stretched;
    assert_true(small->width == 81 && small->height == 75);
    for (int y = 1; y < 74; y++)
        for (int x = 1; x < 80; x++) {
            const double at_x = (x + 0.5) * WIDTH / 81 - 0.5, at_y = (y + 0.5) * HEIGHT / 75 - 0.5;
            unit_near("grey level", x, y, ((const uint8_t *)small->data)[81 * y + x], at_x / 2 + at_y / 10, 1.5);
        }
    asj_look_close(&eyes);
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_stretched_page_is_upsampled_too),
        cmocka_unit_test(automatically_images_are_upsampled_too),
        cmocka_unit_test(upsampled_images_have_half_octaves),
        cmocka_unit_test(the_most_meaningful_junctions_are_enough),
        cmocka_unit_test(partners_lie_where_they_are_expected),
        cmocka_unit_test(images_are_not_upsampled_unasked),
        cmocka_unit_test(a_pose_is_found_in_upsampled_images),
        cmocka_unit_test(octave_minus_one_needs_a_witness_in_upsampled_images),
        cmocka_unit_test(colours_are_looked_at_where_nothing_is_found),
        cmocka_unit_test(large_images_are_halved),
        cmocka_unit_test(a_quarter_is_half_of_a_half),
    };
    return cmocka_run_group_tests(tests, pages_set_up, pages_tear_down);
}
