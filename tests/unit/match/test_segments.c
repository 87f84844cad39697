/* SPDX-License-Identifier: BSD-2-Clause */
/* Line segments of thousands of matches: none is lost, none is there twice, and the time is proportional to their number. Where the
 * matches around put the ends of branches, and which of them correspond. */
#include "unit_test.h"

#include "match/segment_matches.h"
#include "match/segments.h"

#include <time.h>

enum { SIDE = 70, MOST_SIDE = 140, STEP = 40, COUNT = SIDE * SIDE, MOST = MOST_SIDE * MOST_SIDE };

#ifdef ASJ_IS_SANITIZED
#define MOST_SECONDS 1.5
#else
#define MOST_SECONDS 0.3 /* 0.03 alone; 7 when every segment is compared with every match (both loaded) */
#endif

static asj_junction_match matches[MOST];
static asj_place places[2][MOST];
static asj_segment_match segments[2 * MOST], others[2 * MOST];

/* A grid: branch a ends at the right neighbour, branch b at the lower one, so that a segment between two corners is seen from its
 * left or upper end only; match 0 is seen from both. */
static void fill(int32_t side)
{
    memset(matches, 0, sizeof matches);
    for (int32_t k = 0; k < side * side; k++) {
        asj_junction_match *m = &matches[k];
        m->x1 = m->x2 = (float)(k % side * STEP);
        m->y1 = m->y2 = (float)(k / side * STEP);
        m->ax1 = m->ax2 = m->x1 + STEP;
        m->ay1 = m->ay2 = m->y1;
        m->bx1 = m->bx2 = m->x1;
        m->by1 = m->by2 = m->y1 + STEP;
        m->end_a = m->end_b = ASJ_END_BOTH;
    }
    matches[1].ax1 = matches[1].ax2 = matches[0].x1 + 1; /* back to match 0, and a little off */
    matches[1].end_a = ASJ_END_INNER;
}

static void thousands_of_matches(void **state)
{
    const asj_match_result result = {.matches = matches, .match_count = COUNT};
    (void)state;
    fill(SIDE);
    const size_t count = asj_match_segments(&result, ASJ_END_CUT, segments, 2 * COUNT);
    assert_int_equal(count, 2 * COUNT - 1); /* the one seen from both its ends, once: the better known end */
    assert_int_equal(segments[0].match, 0);
    assert_int_equal(segments[0].end, ASJ_END_BOTH);
    assert_int_equal(segments[2].match, 1);
    assert_true(segments[2].ey1 > segments[2].y1); /* its branch b */
}

static void time_is_proportional(void **state)
{
    const asj_match_result result = {.matches = matches, .match_count = MOST};
    (void)state;
    fill(MOST_SIDE);
    const clock_t start = clock();
    for (int32_t side = 0; side < 2; side++)
        asj_places_sort(places[side], matches, MOST, side);
    const asj_around around = {matches, MOST, {places[0], places[1]}, MOST, NULL};
    const size_t count = asj_segment_matches(&result, &around, ASJ_END_CUT, segments, 2 * MOST);
    const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    assert_int_equal(count, 2 * MOST - 1);
    if (seconds > MOST_SECONDS)
        fail_msg("%.2f s", seconds);
}

/* Segments of all lengths in all directions, many of which are seen from both ends, some from outside the image, some again and
 * again: with places and without, the same ones. Where the result has fewer matches than there are places, the others are none. */
static void places_change_nothing(void **state)
{
    asj_match_result result = {.matches = matches, .match_count = 2000};
    uint32_t random = 1;
    (void)state;
    memset(matches, 0, sizeof matches);
    for (int32_t k = 0; k < 2000; k++) {
        asj_junction_match *m = &matches[k];
        float to[4];
        for (int32_t i = 0; i < 4; i++) {
            random = random * 1664525u + 1013904223u;
            to[i] = (float)((int32_t)(random >> 16) % (k % 3 ? 60 : 1400) - 20) / (float)(1 + k % 2);
        }
        const int32_t back = k > 0 && k % 4 == 0;
        const asj_junction_match *last = &matches[back ? k - 1 : k];
        m->x1 = m->x2 = back ? last->ax1 + 1 : to[0];
        m->y1 = m->y2 = back ? last->ay1 : to[1];
        m->ax1 = m->ax2 = back ? last->x1 : to[2];
        m->ay1 = m->ay2 = back ? last->y1 + 2 : to[3];
        m->bx1 = m->bx2 = to[3];
        m->by1 = m->by2 = to[2];
        m->end_a = m->end_b = k % 7 ? ASJ_END_INNER : ASJ_END_BOTH;
    }
    for (int32_t side = 0; side < 2; side++)
        asj_places_sort(places[side], matches, 2000, side);
    for (result.match_count = 2000; result.match_count > 0; result.match_count /= 5) {
        const asj_around none = {matches, result.match_count, {NULL, NULL}, 0, NULL};
        const asj_around all = {matches, result.match_count, {places[0], places[1]}, 2000, NULL};
        const size_t count = asj_segment_matches(&result, &none, ASJ_END_CUT, others, 2 * MOST);
        assert_true(result.match_count < 2000 || count < 2 * 2000 - 300);
        assert_int_equal(asj_segment_matches(&result, &all, ASJ_END_CUT, segments, 2 * MOST), count);
        assert_memory_equal(segments, others, count * sizeof *segments);
    }
}

/* ---- ends ---- */

/* A wall seen obliquely: x2 = 2 x / (1 + x / 400), y2 = y / (1 + x / 400). */
static void on_the_wall(double x, double y, double *x2, double *y2)
{
    const double w = 1 + x / 400;
    *x2 = 2 * x / w;
    *y2 = y / w;
}

/* The match at (x, y), with the derivatives of the wall for its map. */
static asj_junction_match on_wall(double x, double y)
{
    const double w = 1 + x / 400, by_x = 2 / (w * w), y_by_x = -y / (400 * w * w);
    double x2, y2;
    on_the_wall(x, y, &x2, &y2);
    return (asj_junction_match){.x1 = (float)x, .y1 = (float)y, .x2 = (float)x2, .y2 = (float)y2,
                                .affine = {by_x, 0, x2 - by_x * x, y_by_x, 1 / w, y2 - y_by_x * x - y / w}};
}

/* A branch of the match at the origin along x, `one` px long in image 1 and `other` px in image 2. */
static asj_common_end end_of(const asj_around *around, float one, int32_t one_kind, float other, int32_t other_kind)
{
    const asj_matched_branch branch = {&matches[0], {0, 0}, {0, 0}, {1, 1}, {0, 0}};
    const asj_lengths lengths[2] = {{1, {one}, one_kind}, {1, {other}, other_kind}};
    const asj_lengths *both[2] = {&lengths[0], &lengths[1]};
    return asj_find_common_end(around, &branch, both, 0.12);
}

/* Its own map is 40 px off at 100 px; two matches near there know better, and one on another surface hardly counts. */
static void matches_around_put_ends(void **state)
{
    const asj_matched_branch branch = {&matches[0], {0, 0}, {0, 0}, {1, 1}, {0, 0}};
    const asj_around around = {matches, 4, {NULL, NULL}, 0, NULL};
    const int32_t junction = ASJ_BRANCH_END_JUNCTION, faded = ASJ_BRANCH_END_FADED, border = ASJ_BRANCH_END_BORDER;
    (void)state;
    matches[0] = on_wall(0, 0);
    matches[1] = on_wall(100, 10);
    matches[2] = on_wall(95, -12);
    matches[3] = on_wall(100, -5);
    matches[3].affine[5] += 60; /* on another surface */
    unit_near("alone", 0, 0, asj_around_place(NULL, &branch, 0, 100).along, 200, 1e-6);
    unit_near("around", 0, 0, asj_around_place(&around, &branch, 0, 100).along, 160, 1);
    unit_near("off", 0, 0, asj_around_place(&around, &branch, 0, 100).off, 0, 0.5);
    unit_near("back", 0, 0, asj_around_place(&around, &branch, 1, 160).along, 100, 1);
    assert_int_equal(end_of(&around, 100, junction, 160, junction).kind, ASJ_END_BOTH);
    assert_int_equal(end_of(NULL, 100, junction, 160, junction).kind, ASJ_END_CUT);
    assert_int_equal(end_of(&around, 100, junction, 163, junction).kind, ASJ_END_BOTH);
    assert_int_equal(end_of(&around, 100, junction, 170, junction).kind, ASJ_END_CUT);
    assert_int_equal(end_of(&around, 100, junction, 160, faded).kind, ASJ_END_BOTH);
    assert_int_equal(end_of(&around, 100, junction, 163.8f, faded).kind, ASJ_END_CUT); /* of another kind, less is allowed */
    assert_int_equal(end_of(&around, 100, border, 160, border).kind, ASJ_END_CUT);
    const asj_common_end longer = end_of(&around, 100, junction, 240, junction);
    const asj_common_end shorter = end_of(&around, 180, faded, 160, junction);
    unit_near("cut in image 2", 0, 0, longer.length[1], 160, 1);
    unit_near("whole in image 1", 0, 0, longer.length[0], 100, 0);
    unit_near("cut in image 1", 0, 0, shorter.length[0], 100, 1);
    unit_near("whole in image 2", 0, 0, shorter.length[1], 160, 0);
}

/* The wall as an epipolar line puts it: exactly, unless the line runs along the branch or the matches around contradict. */
static void epipolar_lines_put_cuts(void **state)
{
    static const double across[9] = {1.0 / 400, 0, 1, 0, 0, 0, -2, 0, 0}; /* (x, y) -> x2 = 2 x / (1 + x / 400) */
    static const double along[9] = {0, 0, 0, 0, 0, -1, 0, 1, 0};          /* y2 = y */
    static const double elsewhere[9] = {1.0 / 400, 0, 1, 0, 0, 0, -2.25, 0, -100}; /* x2 + 100 */
    const int32_t junction = ASJ_BRANCH_END_JUNCTION, faded = ASJ_BRANCH_END_FADED;
    const double *lines[] = {NULL, across, along, elsewhere};
    double by[4][2];
    (void)state;
    matches[0] = on_wall(0, 0);
    matches[1] = on_wall(100, 20);
    matches[2] = on_wall(90, -12);
    matches[3] = on_wall(115, -5);
    for (int k = 0; k < 4; k++) {
        const asj_around around = {matches, 4, {NULL, NULL}, 0, lines[k]};
        by[k][1] = end_of(&around, 100, junction, 240, junction).length[1];
        by[k][0] = end_of(&around, 180, faded, 160, junction).length[0];
        printf("%.3f px in image 2, %.3f in image 1\n", by[k][1], by[k][0]);
    }
    unit_near("crossing in image 2", 0, 0, by[1][1], 160, 1e-9);
    unit_near("crossing in image 1", 0, 0, by[1][0], 100, 1e-9);
    for (int n = 0; n < 2; n++) {
        assert_true(fabs(by[0][n] - (n ? 160 : 100)) > 1e-3);
        assert_true(by[2][n] == by[0][n] && by[3][n] == by[0][n]);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(thousands_of_matches), cmocka_unit_test(time_is_proportional),
                                       cmocka_unit_test(places_change_nothing),
                                       cmocka_unit_test(matches_around_put_ends), cmocka_unit_test(epipolar_lines_put_cuts)};
    return cmocka_run_group_tests_name("segments", tests, NULL, NULL);
}
