/* SPDX-License-Identifier: BSD-2-Clause */
/* Line segments of thousands of matches: none is lost, none is there twice, and the time is proportional to their number. */
#include "unit_test.h"

#include "match/segment_matches.h"

#include <time.h>

enum { SIDE = 70, MOST_SIDE = 140, STEP = 40, COUNT = SIDE * SIDE, MOST = MOST_SIDE * MOST_SIDE };

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MOST_SECONDS 1.5
#else
#define MOST_SECONDS 0.3 /* 0.03 alone; 7 when every segment is compared with every match (both loaded) */
#endif

static asj_junction_match matches[MOST];
static asj_place places[MOST];
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
    asj_places_sort(places, matches, MOST);
    const size_t count = asj_segment_matches(&result, places, MOST, ASJ_END_CUT, segments, 2 * MOST);
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
    asj_places_sort(places, matches, 2000);
    for (result.match_count = 2000; result.match_count > 0; result.match_count /= 5) {
        const size_t count = asj_segment_matches(&result, NULL, 0, ASJ_END_CUT, others, 2 * MOST);
        assert_true(result.match_count < 2000 || count < 2 * 2000 - 300);
        assert_int_equal(asj_segment_matches(&result, places, 2000, ASJ_END_CUT, segments, 2 * MOST), count);
        assert_memory_equal(segments, others, count * sizeof *segments);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(thousands_of_matches), cmocka_unit_test(time_is_proportional),
                                       cmocka_unit_test(places_change_nothing)};
    return cmocka_run_group_tests_name("segments", tests, NULL, NULL);
}
