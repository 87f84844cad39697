/* SPDX-License-Identifier: BSD-2-Clause */
/* Two geometries of a wall of tiles, of which the second is shifted: when that is a rival (a partner within 8 px is no other one),
 * and whether what the tiles look like says which one is wrong, or that one is. */
#include "unit_test.h"
#include "estimation_fixture.h"

#include "geometry/ambiguity.h"
#include "geometry/contradiction.h"
#include "geometry/strike_out.h"

#define TILE 40
#define WIDTH (16 * TILE)
#define HEIGHT (12 * TILE)
#define ACROSS 12 /* corners of tiles that are matched: all but those near the border */
#define DOWN 8
#define PLACES (ACROSS * DOWN)

/* Of each corner two candidates: itself, and what lies `shift` px beside it. */
static void make_candidates(double shift, asj_geometry_candidate list[2 * PLACES])
{
    memset(list, 0, 2 * PLACES * sizeof *list);
    for (uint32_t k = 0; k < 2 * PLACES; k++) {
        asj_geometry_candidate *c = &list[k];
        const uint32_t place = k / 2, beside = k % 2;
        c->x1 = TILE * (2.0 + place % ACROSS);
        c->y1 = TILE * (2.0 + place / ACROSS);
        c->x2 = c->x1 + beside * shift;
        c->y2 = c->y1;
        c->affine[0] = c->affine[3] = 1;
        c->place1 = place;
        c->place2 = beside * PLACES + place;
        c->probability = 0.3;
    }
}

static asj_model shifted_by(double shift)
{
    const double matrix[9] = {1, 0, shift, 0, 1, 0, 0, 0, 1};
    asj_model m;
    memset(&m, 0, sizeof m);
    m.kind = ASJ_GEOMETRY_HOMOGRAPHY;
    m.parameters = 8;
    m.evidence = 100;
    m.view.planar = 1;
    memcpy(m.view.matrix, matrix, sizeof matrix);
    return m;
}

/* An estimation that has found both geometries; nobody has shown it the pictures. */
static asj_estimation *prepare(asj_context *context, double shift, asj_geometry_options *options)
{
    asj_geometry_candidate list[2 * PLACES];
    asj_geometry_options_init(options);
    options->widths[0] = options->widths[1] = WIDTH;
    options->heights[0] = options->heights[1] = HEIGHT;
    make_candidates(shift, list);
    asj_estimation *e = create_estimation(context, list, 2 * PLACES, options);
    e->finalists[e->count++] = shifted_by(0);
    e->finalists[e->count++] = shifted_by(shift);
    return e;
}

static void test_partner_within_eight_pixels_is_no_other_one(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const struct {
        double shift;
        int32_t rival;
    } cases[] = {{6, -1}, {7.9, -1}, {8.1, 1}, {TILE, 1}};
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        asj_geometry_options options;
        asj_estimation *e = prepare(context, cases[k].shift, &options);
        int32_t doubt = 0;
        assert_int_equal(asj_strongest_rival(e, 0, &doubt), cases[k].rival);
        assert_int_equal(doubt, 0);
        if (cases[k].rival >= 0)
            assert_true(asj_is_ambiguous(e, 0, cases[k].rival, doubt, PLACES));
        release_estimation(context, e);
    }
}

/* Below what is nearly as much a rival still counts that is no chance by itself, if it has two fifths of the best one's. */
static void test_sure_rival_makes_ambiguous(void **state)
{
    asj_context *context = ((unit_fixture *)*state)->context;
    static const double best[] = {450, 4000};
    for (size_t k = 0; k < UNIT_COUNT(best); k++) {
        asj_geometry_options options;
        asj_estimation *e = prepare(context, TILE, &options);
        int32_t doubt = 0;
        double before = 0;
        e->finalists[0].evidence = best[k];
        assert_int_equal(asj_strongest_rival(e, 0, &doubt), 1);
        const double of_best = asj_estimation_log10_nfa(e, &e->finalists[0]);
        for (double evidence = 0.01 * best[k]; evidence < 0.58 * best[k]; evidence += 0.01 * best[k]) {
            e->finalists[1].evidence = evidence;
            const double nfa = asj_estimation_log10_nfa(e, &e->finalists[1]);
            assert_int_equal(asj_is_ambiguous(e, 0, 1, doubt, PLACES), nfa <= ASJ_SURE_RIVAL && nfa <= 0.4 * of_best);
            assert_true(nfa > 0.6 * of_best && nfa < before);
            before = nfa;
        }
        assert_true(before < ASJ_SURE_RIVAL && before < 0.4 * of_best);
        release_estimation(context, e);
    }
}

/* A wall of tiles whose levels differ by up to `contrast`, the second picture with another exposure. */
static void paint(int32_t which, int32_t channel, int32_t contrast, uint8_t *pixels)
{
    synth_random random;
    int32_t level[WIDTH / TILE * HEIGHT / TILE];
    synth_random_seed(&random, 7 + (uint64_t)channel);
    for (size_t k = 0; k < sizeof level / sizeof *level; k++)
        level[k] = (int32_t)synth_random_between(&random, 100, 100 + contrast);
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            const int32_t line = x % TILE < 2 || y % TILE < 2, tile = level[y / TILE * (WIDTH / TILE) + x / TILE];
            pixels[y * WIDTH + x] = (uint8_t)((line ? 60 : tile) * (which ? 8 : 10) / 10);
        }
}

/* Is the second geometry a rival when the pictures are looked at? Is the first one, when that one is called the best? */
static void ask(asj_context *context, int32_t channels, const int32_t *contrasts, int32_t rivals[2])
{
    asj_geometry_options options;
    asj_estimation *e = prepare(context, TILE, &options);
    show_pictures(context, e, channels, contrasts, paint);
    for (int32_t best = 0; best < 2; best++) {
        int32_t doubt;
        rivals[best] = asj_strongest_rival(e, best, &doubt);
    }
    release_estimation(context, e);
}

static void test_pictures_tell_tiles_from_others(void **state)
{
    const unit_fixture *f = *state;
    const int32_t grey[1] = {60}, colours[3] = {0, 0, 60};
    int32_t rivals[2];
    ask(f->context, 1, grey, rivals);
    assert_int_equal(rivals[0], -1); /* what is shifted has other tiles */
    assert_int_equal(rivals[1], 0);
    ask(f->context, 3, colours, rivals);
    assert_int_equal(rivals[0], -1);
    assert_int_equal(rivals[1], 0);
}

static void test_pictures_of_like_tiles_say_nothing(void **state)
{
    const unit_fixture *f = *state;
    const int32_t none[3] = {0, 0, 0};
    int32_t rivals[2];
    ask(f->context, 1, none, rivals);
    assert_int_equal(rivals[0], 1);
    assert_int_equal(rivals[1], 0);
    ask(f->context, 3, none, rivals);
    assert_int_equal(rivals[0], 1);
    assert_int_equal(rivals[1], 0);
}

/* The wrong one is in front, by little or by so much that pictures alone are no reason against it, or behind: the right one is the
 * answer, and what candidates say of either stays as it was. */
static void test_wrong_one_is_struck_out(void **state)
{
    static const struct {
        double evidence;
        asj_struck struck;
    } cases[] = {{130, ASJ_STRUCK_BY_PICTURES}, {700, ASJ_STRUCK_FOR_ANOTHER}, {90, ASJ_STRUCK_AS_RIVAL}};
    asj_context *context = ((unit_fixture *)*state)->context;
    const int32_t contrast = 60;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_geometry_options options;
        asj_estimation *e = prepare(context, TILE, &options);
        show_pictures(context, e, 1, &contrast, paint);
        e->finalists[1].evidence = cases[k].evidence;
        assert_int_equal(asj_strike_out(e), ASJ_OK);
        assert_int_equal(asj_estimation_best(e, ASJ_GEOMETRY_AUTO), 0);
        assert_int_equal(e->finalists[0].struck, ASJ_NOT_STRUCK);
        assert_int_equal(e->finalists[1].struck, cases[k].struck);
        assert_true(e->finalists[0].evidence == 100 && e->finalists[1].evidence == cases[k].evidence);
        release_estimation(context, e);
    }
}

/* A geometry needs no rival to be wrong: pictures that know something disagree, and so little evidence is not believed then. */
static void test_wrong_one_alone_is_struck_out(void **state)
{
    static const struct {
        double shift, evidence;
        int32_t contrast, stays;
    } cases[] = {{TILE, 130, 100, 0}, {0, 130, 100, 1}, {TILE, 130, 0, 1}, {TILE, 700, 100, 1}};
    asj_context *context = ((unit_fixture *)*state)->context;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_geometry_options options;
        asj_estimation *e = prepare(context, TILE, &options);
        show_pictures(context, e, 1, &cases[k].contrast, paint);
        e->finalists[0] = shifted_by(cases[k].shift);
        e->finalists[0].evidence = cases[k].evidence;
        e->count = 1;
        assert_int_equal(asj_strike_out(e), ASJ_OK);
        print_message("shift %.0f, contrast %d: agreement %.2f\n", cases[k].shift, cases[k].contrast,
                      asj_told_agreement(e, &e->finalists[0]).share);
        assert_int_equal(asj_estimation_best(e, ASJ_GEOMETRY_AUTO), cases[k].stays ? 0 : -1);
        assert_int_equal(e->finalists[0].struck, cases[k].stays ? ASJ_NOT_STRUCK : ASJ_STRUCK_BY_PICTURES);
        release_estimation(context, e);
    }
}

/* What matches leave open counts with as many decades as the pictures' agreement is unusual. */
static void test_agreement_is_unusual(void **state)
{
    static const struct {
        double share, known, decades;
    } cases[] = {{.9, 20, 3}, {.7, 20, 3}, {.6, 20, 1.5}, {.5, 20, 0}, {.2, 20, 0}, {.9, 14, 0}};
    asj_context *context = ((unit_fixture *)*state)->context;
    const int32_t contrast = 60;
    asj_geometry_options options;
    asj_estimation *e = prepare(context, TILE, &options);
    assert_true(asj_estimation_log10_agreement(e->first.agreement) == 0); /* nobody has shown pictures */
    for (double evidence = 5; evidence < 25; evidence += 1) {
        e->finalists[0].evidence = evidence;
        assert_int_equal(asj_estimation_counts(e, 0), asj_estimation_log10_nfa(e, &e->finalists[0]) <= -7);
    }
    show_pictures(context, e, 1, &contrast, paint);
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        const asj_agreement agreement = {cases[k].share, cases[k].known};
        assert_true(fabs(asj_estimation_log10_agreement(agreement) + cases[k].decades) < 1e-9);
    }
    for (double evidence = 5; evidence < 25; evidence += 1) {
        e->finalists[0].evidence = evidence;
        assert_int_equal(asj_estimation_counts(e, 0), asj_estimation_log10_nfa(e, &e->finalists[0]) <= -4);
    }
    assert_false(asj_estimation_counts(e, -1));
    release_estimation(context, e);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_partner_within_eight_pixels_is_no_other_one),
        cmocka_unit_test(test_sure_rival_makes_ambiguous),
        cmocka_unit_test(test_pictures_tell_tiles_from_others),
        cmocka_unit_test(test_pictures_of_like_tiles_say_nothing),
        cmocka_unit_test(test_wrong_one_is_struck_out),
        cmocka_unit_test(test_wrong_one_alone_is_struck_out),
        cmocka_unit_test(test_agreement_is_unusual),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
