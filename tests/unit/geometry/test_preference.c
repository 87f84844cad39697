/* SPDX-License-Identifier: BSD-2-Clause */
/* Two motions that cannot both be right and whose matches contradict each other in nothing: pictures say which one it is.
 *
 * A wall in front of both cameras, which are one tile apart. Its upper half is matched as it is. Its lower half, half of which
 * repeats every four tiles, is matched four tiles beside that, as if the camera had moved three tiles the other way. */
#include "unit_test.h"
#include "estimation_fixture.h"

#include "core/angle.h"
#include "geometry/ambiguity.h"
#include "geometry/contradiction.h"
#include "geometry/strike_out.h"

#define TILE 40
#define PERIOD 4
#define COLUMNS 16
#define ROWS 12
#define WIDTH (COLUMNS * TILE)
#define HEIGHT (ROWS * TILE)
#define FOCAL 500.0
#define LEFT 4   /* columns of corners that are matched: from here .. */
#define RIGHT 14 /* .. to before this one */
#define PLACES ((RIGHT - LEFT) * (ROWS - 2))

enum { RIGHT_ONE, WRONG_ONE, TWIN };

static const asj_camera camera = {FOCAL, FOCAL, 0.5 * (WIDTH - 1), 0.5 * (HEIGHT - 1)};

static void make_candidates(asj_geometry_candidate list[PLACES])
{
    memset(list, 0, PLACES * sizeof *list);
    for (uint32_t k = 0; k < PLACES; k++) {
        asj_geometry_candidate *c = &list[k];
        const int32_t row = 1 + (int32_t)k / (RIGHT - LEFT);
        c->x1 = TILE * (LEFT + k % (RIGHT - LEFT));
        c->y1 = TILE * row;
        c->x2 = c->x1 + TILE * (row < ROWS / 2 ? 1 : 1 - PERIOD);
        c->y2 = c->y1;
        c->affine[0] = c->affine[3] = 1;
        c->place1 = c->place2 = k;
        c->probability = 0.5;
    }
}

/* Of the wall, which it takes so many tiles to the right in the image. */
static asj_model moved_by(int32_t tiles, double evidence)
{
    asj_model m;
    memset(&m, 0, sizeof m);
    m.kind = ASJ_GEOMETRY_ESSENTIAL;
    m.parameters = 8;
    m.evidence = m.peak = evidence;
    m.cameras[0] = m.cameras[1] = camera;
    m.rotation[0] = m.rotation[4] = m.rotation[8] = 1;
    m.translation[0] = tiles > 0 ? 1 : -1;
    m.planes[0][2] = abs(tiles) * TILE / FOCAL;
    m.view.plane_count = 1;
    assert_true(asj_model_complete(&m));
    return m;
}

/* Which of the levels a tile has in a channel: every other row of the lower half repeats. */
static int32_t level_of(int32_t column, int32_t row, uint32_t channel, int32_t contrast)
{
    synth_random random;
    const int32_t repeats = row >= ROWS / 2 && row % 2 == 0;
    const int32_t number = repeats ? column % PERIOD : column;
    synth_random_seed(&random, 1 + channel + 8 * (uint64_t)(row + ROWS * (number + PERIOD)));
    return (int32_t)synth_random_between(&random, 100, 100 + contrast);
}

static void paint(int32_t which, uint32_t channel, int32_t contrast, uint8_t *pixels)
{
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            const int32_t line = x % TILE < 2 || y % TILE < 2;
            pixels[y * WIDTH + x] = (uint8_t)(line ? 60 : level_of(x / TILE - which, y / TILE, channel, contrast));
        }
}

/* The wall in so many channels; 0: nobody shows it. */
static void show(asj_context *context, asj_estimation *e, int32_t channels, int32_t contrast)
{
    static uint8_t pixels[WIDTH * HEIGHT];
    asj_picture of[2];
    for (int32_t k = 0; k < 2; k++) {
        of[k] = (asj_picture){.channel_count = channels, .scale = 1, .width = WIDTH, .height = HEIGHT};
        for (int32_t c = 0; c < channels; c++) {
            const asj_image image = {pixels, ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0};
            paint(k, (uint32_t)c, contrast, pixels);
            assert_int_equal(asj_pyramid_create(context, &image, 0.8, &pyramids[k][c]), ASJ_OK);
            of[k].channels[c] = &pyramids[k][c];
        }
    }
    e->pictures = channels > 0 ? asj_pictures_create(&context->memory, of, e->set.count) : NULL;
    assert_true(e->pictures || channels == 0);
}

/* An estimation that has found both motions. */
static asj_estimation *prepare(asj_context *context, int32_t channels, int32_t contrast, asj_geometry_options *options)
{
    asj_geometry_candidate list[PLACES];
    asj_geometry_options_init(options);
    for (int32_t v = 0; v < 2; v++) {
        options->widths[v] = WIDTH;
        options->heights[v] = HEIGHT;
        options->cameras[v] = camera;
    }
    make_candidates(list);
    asj_estimation *e = create_estimation(context, list, PLACES, options);
    e->finalists[RIGHT_ONE] = moved_by(1, 120);
    e->finalists[WRONG_ONE] = moved_by(1 - PERIOD, 130);
    e->count = 2;
    show(context, e, channels, contrast);
    return e;
}

static asj_comparison compare(asj_estimation *e, int32_t first, int32_t other)
{
    asj_compare_from(e, first);
    return asj_compare_with(e, &e->finalists[other]);
}

/* In colours that know something, of two motions that are far apart. */
static void test_pictures_prefer_the_right_motion(void **state)
{
    static const struct {
        int32_t channels, contrast, prefers;
    } cases[] = {{3, 100, 1}, {3, 0, 0}, {1, 100, 0}, {0, 100, 0}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_geometry_options options;
        int32_t doubt = 0;
        asj_estimation *e = prepare(context, cases[k].channels, cases[k].contrast, &options);
        const asj_comparison from_wrong = compare(e, WRONG_ONE, RIGHT_ONE);
        const asj_agreement right = *asj_agreement_of_other(e);
        print_message("%d channels, contrast %d: agreement %.2f of %.0f nats and %.2f of %.0f, contrary %.2f, preference %.1f\n",
                      (int)cases[k].channels, (int)cases[k].contrast, e->first.agreement.share, e->first.agreement.known,
                      right.share, right.known, from_wrong.contrary, from_wrong.preference);
        assert_true(from_wrong.contrary < 0.01);
        assert_int_equal(from_wrong.preference > 0, cases[k].prefers);
        assert_int_equal(asj_strongest_rival(e, WRONG_ONE, &doubt), cases[k].prefers ? RIGHT_ONE : -1);
        assert_int_equal(asj_strongest_rival(e, RIGHT_ONE, &doubt), -1);
        const asj_comparison from_right = compare(e, RIGHT_ONE, WRONG_ONE);
        assert_true(from_right.preference == -from_wrong.preference);
        release_estimation(context, e);
    }
}

/* Motions that are near each other do not exclude each other: which planes they have is all that pictures tell. */
static void test_only_motions_far_apart_exclude_each_other(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_geometry_options options;
    asj_estimation *e = prepare(context, 3, 100, &options);
    const asj_model wrong = e->finalists[WRONG_ONE];
    for (int32_t degrees = 5; degrees <= 175; degrees += 10) {
        const double turn = degrees * ASJ_DEGREE;
        e->finalists[WRONG_ONE] = wrong;
        e->finalists[WRONG_ONE].translation[0] = cos(turn);
        e->finalists[WRONG_ONE].translation[1] = sin(turn);
        assert_int_equal(compare(e, WRONG_ONE, RIGHT_ONE).preference > 0, degrees > 15);
    }
    release_estimation(context, e);
}

/* What has less than half of the evidence is not preferred, whatever pictures say. */
static void test_much_evidence_is_not_outweighed(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_geometry_options options;
    asj_estimation *e = prepare(context, 3, 100, &options);
    e->finalists[WRONG_ONE].evidence = 239;
    assert_true(compare(e, WRONG_ONE, RIGHT_ONE).preference > 0);
    e->finalists[WRONG_ONE].evidence = 241;
    assert_true(compare(e, WRONG_ONE, RIGHT_ONE).preference == 0);
    release_estimation(context, e);
}

/* The wrong one has a little more evidence, the right one is there twice: the one that is followed is the answer. */
static void test_preferred_motion_is_the_answer(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    asj_geometry_options options;
    asj_estimation *e = prepare(context, 3, 100, &options);
    e->finalists[TWIN] = moved_by(1, 1e6);
    e->finalists[TWIN].evidence = 121;
    e->count = 3;
    assert_int_equal(asj_strike_out(e), ASJ_OK);
    const int32_t best = asj_estimation_best(e, ASJ_GEOMETRY_AUTO);
    assert_true(best == RIGHT_ONE || best == TWIN);
    assert_true(e->finalists[best].settled);
    assert_int_equal(e->finalists[WRONG_ONE].struck != ASJ_NOT_STRUCK, 1);
    release_estimation(context, e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pictures_prefer_the_right_motion),
        cmocka_unit_test(test_only_motions_far_apart_exclude_each_other),
        cmocka_unit_test(test_much_evidence_is_not_outweighed),
        cmocka_unit_test(test_preferred_motion_is_the_answer),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
