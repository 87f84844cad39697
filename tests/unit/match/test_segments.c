/* SPDX-License-Identifier: BSD-2-Clause */
/* Line segments of thousands of matches: none is lost, none is there twice, and it takes no second. */
#include "unit_test.h"

#include <asj/match.h>

#include <time.h>

enum { SIDE = 70, STEP = 40, COUNT = SIDE * SIDE };

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MOST_SECONDS 15.0
#else
#define MOST_SECONDS 1.5 /* 0.2 alone; 9 when every pair of matches is looked at in full */
#endif

/* A grid: branch a ends at the right neighbour, branch b at the lower one, so that a segment between two corners is seen from its
 * left or upper end only; match 0 is seen from both. */
static void fill(asj_junction_match *matches)
{
    memset(matches, 0, COUNT * sizeof *matches);
    for (int32_t k = 0; k < COUNT; k++) {
        asj_junction_match *m = &matches[k];
        m->x1 = m->x2 = (float)(k % SIDE * STEP);
        m->y1 = m->y2 = (float)(k / SIDE * STEP);
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
    static asj_junction_match matches[COUNT];
    static asj_segment_match segments[2 * COUNT];
    asj_match_result result;
    (void)state;
    memset(&result, 0, sizeof result);
    fill(matches);
    result.matches = matches;
    result.match_count = COUNT;
    const clock_t start = clock();
    const size_t count = asj_match_segments(&result, ASJ_END_CUT, segments, 2 * COUNT);
    const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    assert_int_equal(count, 2 * COUNT - 1); /* the one seen from both its ends, once: the better known end */
    assert_int_equal(segments[0].match, 0);
    assert_int_equal(segments[0].end, ASJ_END_BOTH);
    assert_int_equal(segments[2].match, 1);
    assert_true(segments[2].ey1 > segments[2].y1); /* its branch b */
    if (seconds > MOST_SECONDS)
        fail_msg("%.2f s", seconds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(thousands_of_matches)};
    return cmocka_run_group_tests_name("segments", tests, NULL, NULL);
}
