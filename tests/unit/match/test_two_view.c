/* SPDX-License-Identifier: BSD-2-Clause */
/* The geometry in the matcher: on a rendered room seen from far apart the pose is that of the cameras and the matches obey it;
 * without one, or where it is not accepted, the matches are those of before. */
#include "unit_test.h"

#include "geometry/small_matrix.h"
#include "wide_pair.h"

#include <asj/asj.h>

#define SEED 6 /* a furnished room, 33 degrees */
#define REJECTING 3
#define WITH_GUESTS 22
#define SHIFTED 7
#define AMBIGUOUS 21 /* without cameras */

typedef struct views {
    synth_wide_pair pair;
    uint8_t *pixels[2];
    asj_image images[2];
    asj_detection *found[2];
} views;

static void make(asj_context *context, uint64_t seed, views *v)
{
    asj_detect_options options;
    assert_int_equal(synth_wide_pair_make(&v->pair, seed), 0);
    assert_int_equal(asj_detect_options_preset(&options, ASJ_PRESET_MATCH), ASJ_OK);
    for (int k = 0; k < 2; k++) {
        v->pixels[k] = synth_wide_picture(&v->pair, k);
        assert_non_null(v->pixels[k]);
        v->images[k] = (asj_image){v->pixels[k], ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
        assert_int_equal(asj_detect(context, &v->images[k], &options, &v->found[k]), ASJ_OK);
    }
}

static void release(views *v)
{
    for (int k = 0; k < 2; k++) {
        asj_detection_free(&v->found[k]);
        free(v->pixels[k]);
    }
    synth_wide_pair_free(&v->pair);
}

static asj_status match(asj_context *context, const views *first, const views *second, const asj_match_options *options,
                        asj_match_result **result)
{
    return asj_match(context, &first->images[0], first->found[0]->junctions, first->found[0]->junction_count, &second->images[1],
                     second->found[1]->junctions, second->found[1]->junction_count, options, result);
}

static asj_match_options with_cameras(const views *v)
{
    asj_match_options options;
    asj_match_options_init(&options);
    assert_int_equal(options.geometry.model, ASJ_GEOMETRY_NONE);
    options.geometry.model = ASJ_GEOMETRY_AUTO;
    for (int k = 0; k < 2; k++) {
        const double f = v->pair.cameras[k].focal;
        options.geometry.cameras[k] = (asj_camera){f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    }
    return options;
}

/* Degrees: the larger of the errors of rotation and of the direction of translation. */
static double pose_error(const asj_geometry *g, const synth_wide_pair *pair)
{
    const synth_pose_error off = synth_pose_off(&pair->cameras[0], &pair->cameras[1], g->rotation, g->translation);
    return fmax(off.rotation, off.translation);
}

static double from_line(const double f[9], const asj_junction_match *m)
{
    return synth_off_epipolar_line(f, (double)m->x1, (double)m->y1, (double)m->x2, (double)m->y2);
}

/* Whatever numbers are drawn. */
static void the_pose_is_that_of_the_cameras(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_result *result = NULL;
    views v;
    double f[9];
    make(context, SEED, &v);
    synth_fundamental(&v.pair.cameras[0], &v.pair.cameras[1], f);
    for (uint64_t seed = 1; seed <= 3; seed++) {
        asj_match_options options = with_cameras(&v);
        options.geometry.seed = seed;
        assert_int_equal(match(context, &v, &v, &options, &result), ASJ_OK);
        const asj_geometry *g = &result->geometry;
        assert_int_equal(g->status, ASJ_GEOMETRY_ACCEPTED);
        assert_true(g->has_pose);
        unit_near("pose, deg", (double)seed, 0, pose_error(g, &v.pair), 0, 2);
        unit_near("length of the translation", (double)seed, 0, asj_dot3(g->translation, g->translation), 1, 1e-9);
        assert_true(g->log10_nfa < -10);
        uint32_t right = 0;
        for (uint32_t k = 0; k < result->match_count; k++) {
            assert_true(result->matches[k].probability > 0 && result->matches[k].probability <= 1); /* each is judged */
            right += from_line(f, &result->matches[k]) < 4;
        }
        assert_true(result->match_count >= 15 && 10 * right >= 9 * result->match_count);
        asj_match_result_free(&result);
    }
    release(&v);
    unit_context_free(&counter, &context);
}

static uint64_t count_of(const asj_junction_match *list, uint64_t count, const asj_junction_match *m)
{
    uint64_t found = 0;
    for (uint64_t k = 0; k < count; k++)
        found += list[k].l1 == m->l1 && list[k].l2 == m->l2;
    return found;
}

static int is_of(const views *v, const asj_junction_match *m, int32_t octave)
{
    return v->found[0]->junctions[m->junction1].octave == octave && v->found[1]->junctions[m->junction2].octave == octave;
}

/* Of matches in one of whose images a coarser octave than the finest has found the corner. */
static uint32_t count_guests(const views *v, const asj_match_result *r)
{
    uint32_t guests = 0;
    for (uint32_t k = 0; k < r->match_count; k++)
        guests += !is_of(v, &r->matches[k], 0);
    return guests;
}

/* Guests are judged, too: what lies on its line to a pixel is likely right. All is the same with any number of threads. */
static void guests_are_judged(void **state)
{
    (void)state;
    views v;
    double f[9];
    unit_counter counters[2] = {{0}, {0}};
    asj_context *contexts[2] = {unit_context(&counters[0], 1), unit_context(&counters[1], 3)};
    asj_match_result *results[2] = {NULL, NULL};
    make(contexts[0], WITH_GUESTS, &v);
    for (int k = 0; k < 2; k++) {
        const asj_match_options options = with_cameras(&v);
        assert_int_equal(match(contexts[k], &v, &v, &options, &results[k]), ASJ_OK);
        assert_int_equal(results[k]->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    }
    const asj_match_result *r = results[0];
    memcpy(f, r->geometry.matrix, sizeof f);
    assert_true(count_guests(&v, r) >= 2);
    for (uint32_t k = 0; k < r->match_count; k++) {
        const asj_junction_match *m = &r->matches[k];
        assert_true(m->probability >= 0 && m->probability <= 1);
        assert_int_equal(count_of(r->rejected, r->rejected_count, m), 0);
        if (!is_of(&v, m, 0) && from_line(f, m) < 1)
            assert_true(m->probability > 0.5f);
        for (uint32_t q = 0; q < k; q++)
            assert_true(r->matches[q].l1 != m->l1 && r->matches[q].l2 != m->l2); /* each once */
    }
    assert_int_equal(results[1]->match_count, r->match_count);
    assert_memory_equal(results[1]->matches, r->matches, r->match_count * sizeof *r->matches);
    asj_match_result_free(&results[0]);
    asj_match_result_free(&results[1]);
    release(&v);
    unit_context_free(&counters[0], &contexts[0]);
    unit_context_free(&counters[1], &contexts[1]);
}

/* Every match that there is without the geometry is either there with it or among the rejected ones; in this room all those lie off
 * their lines. */
static void what_goes_is_told(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_result *without = NULL, *with = NULL;
    views v;
    uint64_t told = 0;
    make(context, REJECTING, &v);
    asj_match_options options = with_cameras(&v);
    assert_int_equal(match(context, &v, &v, &options, &with), ASJ_OK);
    options.geometry.model = ASJ_GEOMETRY_NONE;
    assert_int_equal(match(context, &v, &v, &options, &without), ASJ_OK);
    assert_int_equal(with->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_int_equal(without->rejected_count, 0);
    assert_null(without->rejected);
    assert_in_range(with->rejected_count, 1, without->match_count);
    for (uint32_t k = 0; k < without->match_count; k++) {
        const asj_junction_match *m = &without->matches[k];
        const uint64_t kept = count_of(with->matches, with->match_count, m);
        const uint64_t gone = count_of(with->rejected, with->rejected_count, m);
        assert_int_equal(kept + gone, 1);
        told += gone;
        if (gone)
            assert_true(from_line(with->geometry.matrix, m) > 3);
    }
    assert_int_equal(told, with->rejected_count);
    asj_match_result_free(&with);
    asj_match_result_free(&without);
    release(&v);
    unit_context_free(&counter, &context);
}

/* Matches of all octaves. */
static void what_is_ambiguous_changes_nothing(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_result *without = NULL, *with = NULL;
    views v;
    make(context, AMBIGUOUS, &v);
    asj_match_options options = with_cameras(&v);
    memset(options.geometry.cameras, 0, sizeof options.geometry.cameras);
    assert_int_equal(match(context, &v, &v, &options, &with), ASJ_OK);
    assert_int_equal(with->geometry.status, ASJ_GEOMETRY_AMBIGUOUS);
    options.geometry.model = ASJ_GEOMETRY_NONE;
    assert_int_equal(match(context, &v, &v, &options, &without), ASJ_OK);
    assert_int_equal(with->match_count, without->match_count);
    assert_true(count_guests(&v, without) >= 2);
    assert_memory_equal(with->matches, without->matches, with->match_count * sizeof *with->matches);
    assert_int_equal(with->rejected_count, 0);
    asj_match_result_free(&with);
    asj_match_result_free(&without);
    release(&v);
    unit_context_free(&counter, &context);
}

/* Tiles: without the geometry all matches are shifted by a period. With it those go, though they are more than those that stay. */
static void what_has_another_partner_goes(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_result *results[2] = {NULL, NULL};
    views v;
    double f[9];
    uint32_t right[2] = {0, 0};
    make(context, SHIFTED, &v);
    synth_fundamental(&v.pair.cameras[0], &v.pair.cameras[1], f);
    asj_match_options options = with_cameras(&v);
    for (int k = 0; k < 2; k++) {
        options.geometry.model = k ? ASJ_GEOMETRY_AUTO : ASJ_GEOMETRY_NONE;
        assert_int_equal(match(context, &v, &v, &options, &results[k]), ASJ_OK);
        for (uint32_t n = 0; n < results[k]->match_count; n++)
            right[k] += from_line(f, &results[k]->matches[n]) < 4;
    }
    assert_true(results[0]->match_count >= 10 && 2 * right[0] < results[0]->match_count);
    assert_int_equal(results[1]->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_true(2 * results[1]->rejected_count > results[0]->match_count);
    assert_true(right[1] >= 10 && 10 * right[1] >= 9 * results[1]->match_count);
    asj_match_result_free(&results[0]);
    asj_match_result_free(&results[1]);
    release(&v);
    unit_context_free(&counter, &context);
}

static void what_is_not_accepted_changes_nothing(void **state)
{
    (void)state;
    unit_counter counter = {0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_result *without = NULL, *with = NULL;
    views a, b;
    make(context, SEED, &a);
    make(context, 14, &b); /* another room */
    asj_match_options options = with_cameras(&a);
    assert_int_equal(match(context, &a, &b, &options, &with), ASJ_OK);
    assert_int_not_equal(with->geometry.status, ASJ_GEOMETRY_ACCEPTED);
    assert_int_not_equal(with->geometry.status, ASJ_GEOMETRY_NOT_ASKED);
    options.geometry.model = ASJ_GEOMETRY_NONE;
    assert_int_equal(match(context, &a, &b, &options, &without), ASJ_OK);
    assert_int_equal(without->geometry.status, ASJ_GEOMETRY_NOT_ASKED);
    assert_int_equal(with->match_count, without->match_count);
    if (with->match_count)
        assert_memory_equal(with->matches, without->matches, with->match_count * sizeof *with->matches);
    asj_match_result_free(&with);
    options.geometry.model = ASJ_GEOMETRY_AUTO;
    options.geometry.cameras[0].fx = -1;
    assert_int_equal(match(context, &a, &b, &options, &with), ASJ_ERROR_OPTION);
    assert_null(with);
    options.geometry.model = ASJ_GEOMETRY_NONE; /* then nobody asks */
    assert_int_equal(match(context, &a, &b, &options, &with), ASJ_OK);
    asj_match_result_free(&with);
    asj_match_result_free(&without);
    release(&a);
    release(&b);
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_pose_is_that_of_the_cameras), cmocka_unit_test(what_goes_is_told),
        cmocka_unit_test(what_is_not_accepted_changes_nothing), cmocka_unit_test(what_is_ambiguous_changes_nothing),
        cmocka_unit_test(guests_are_judged), cmocka_unit_test(what_has_another_partner_goes),
    };
    return cmocka_run_group_tests_name("two views", tests, NULL, NULL);
}
