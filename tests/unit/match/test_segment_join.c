/* SPDX-License-Identifier: BSD-2-Clause */
/* Segment matches of one edge as one: what joins, what does not, where its ends are; any order, any numbers. */
#include "unit_test.h"

#include <asj/match.h>

enum { MOST = 2000 };

static asj_segment_match segments[MOST], others[MOST];

/* On the line y = 10 of image 1 and x = 20 of image 2, where it is twice as long. */
static asj_segment_match on_the_line(uint32_t match, float from, float to, int32_t end)
{
    return (asj_segment_match){.match = match, .end = end, .x1 = from, .y1 = 10, .ex1 = to, .ey1 = 10, .x2 = 20, .y2 = 2 * from,
                               .ex2 = 20, .ey2 = 2 * to, .start = ASJ_END_CORNER};
}

static size_t join(size_t count)
{
    return asj_join_segment_matches(segments, count);
}

static void expect(const asj_segment_match *s, uint32_t match, float from, float to, int32_t start, int32_t end)
{
    assert_int_equal(s->match, match);
    assert_true(s->x1 == from && s->ex1 == to && s->y2 == 2 * from && s->ey2 == 2 * to);
    assert_true(s->y1 == 10 && s->ey1 == 10 && s->x2 == 20 && s->ex2 == 20);
    assert_int_equal(s->start, start);
    assert_int_equal(s->end, end);
}

/* From every corner of the edge to its end, either way. */
static void parts_of_an_edge_are_one(void **state)
{
    (void)state;
    segments[0] = on_the_line(3, 50, 100, ASJ_END_BOTH);
    segments[1] = on_the_line(1, 0, 100, ASJ_END_INNER);
    segments[2] = on_the_line(2, 70, 1, ASJ_END_BOTH); /* back to the first */
    assert_int_equal(join(3), 1);
    expect(&segments[0], 1, 0, 100, ASJ_END_CORNER, ASJ_END_INNER);
}

/* The corner that is matched at the far end of another one is that end. */
static void a_matched_corner_is_the_end(void **state)
{
    (void)state;
    segments[0] = on_the_line(0, 0, 100, ASJ_END_BOTH);
    segments[1] = on_the_line(1, 102, 60, ASJ_END_CUT);
    assert_int_equal(join(2), 1);
    expect(&segments[0], 0, 0, 102, ASJ_END_CORNER, ASJ_END_CORNER);
}

/* The second goes on beyond both ends of what overlaps, and reaches a third that the first did not. */
static void parts_that_overlap_reach_from_first_to_last(void **state)
{
    (void)state;
    segments[0] = on_the_line(0, 0, 100, ASJ_END_CUT);
    segments[1] = on_the_line(1, 80, 160, ASJ_END_INNER);
    segments[2] = on_the_line(2, 150, 200, ASJ_END_BOTH);
    assert_int_equal(join(3), 1);
    expect(&segments[0], 0, 0, 200, ASJ_END_CORNER, ASJ_END_BOTH);
    segments[0] = on_the_line(0, 60, 200, ASJ_END_CUT);
    segments[1] = on_the_line(1, 100, 10, ASJ_END_INNER); /* so that no corner is at its first end */
    assert_int_equal(join(2), 1);
    expect(&segments[0], 0, 10, 200, ASJ_END_INNER, ASJ_END_CUT);
}

/* Whoever comes with it; what is less than a corner moves no end. Where one has moved it may reach others. */
static void corners_that_others_have_found(void **state)
{
    (void)state;
    segments[0] = on_the_line(0, 0, 100, ASJ_END_INNER);
    segments[1] = on_the_line(1, 50, 103, ASJ_END_CORNER);
    assert_int_equal(join(2), 1);
    expect(&segments[0], 0, 0, 103, ASJ_END_CORNER, ASJ_END_CORNER);
    segments[0] = on_the_line(0, 0, 100, ASJ_END_INNER);
    segments[1] = on_the_line(1, 98, 50, ASJ_END_BOTH);
    segments[1].start = ASJ_END_BOTH;
    assert_int_equal(join(2), 1);
    expect(&segments[0], 0, 0, 100, ASJ_END_CORNER, ASJ_END_INNER);
    segments[0] = on_the_line(0, 0, 100, ASJ_END_INNER);
    segments[1] = on_the_line(1, 105, 60, ASJ_END_CUT);
    segments[2] = on_the_line(2, 99, 160, ASJ_END_BOTH);
    assert_int_equal(join(3), 1);
    expect(&segments[0], 0, 0, 160, ASJ_END_CORNER, ASJ_END_BOTH);
}

static void neighbours_stay(void **state)
{
    (void)state;
    segments[0] = on_the_line(0, 0, 100, ASJ_END_BOTH);
    segments[1] = on_the_line(1, 100, 200, ASJ_END_BOTH); /* they touch */
    segments[2] = on_the_line(2, 210, 300, ASJ_END_BOTH); /* a gap */
    assert_int_equal(join(3), 3);
    segments[1] = on_the_line(1, 20, 80, ASJ_END_BOTH);
    segments[1].y1 = segments[1].ey1 = 12.5f; /* beside it, in one image */
    assert_int_equal(join(2), 2);
    segments[1] = on_the_line(1, 20, 80, ASJ_END_BOTH);
    segments[1].y2 = 160, segments[1].ey2 = 40; /* the other way round in one image */
    assert_int_equal(join(2), 2);
    segments[1] = on_the_line(1, 20, 100, ASJ_END_BOTH);
    segments[1].ey2 = 220; /* beyond its end in one image */
    assert_int_equal(join(2), 2);
    segments[1] = on_the_line(1, 20, 80, ASJ_END_BOTH);
    segments[1].ey1 = 16; /* another direction */
    assert_int_equal(join(2), 2);
}

/* The same ones in any order, also of matches that have no L-junctions, and no more to join in what comes of it. */
static void order_changes_nothing(void **state)
{
    uint32_t random = 7;
    (void)state;
    for (int32_t k = 0; k < MOST; k++) {
        random = random * 1664525u + 1013904223u;
        const float from = (float)(random >> 16 & 1023), to = from + (float)(random >> 8 & 255) - 128;
        others[k] = on_the_line((uint32_t)k, from, to, (int32_t)(random >> 5 & 1));
        if (k % 50 < 2) {
            others[k].match = (uint32_t)(k / 50);
            others[k].branch1 = others[k].branch2 = -1;
            others[k].ex1 = others[k].x1 + 40, others[k].ey2 = others[k].y2 + 80; /* as long as others */
        }
        others[k].y1 = others[k].ey1 = others[k].x2 = others[k].ex2 = (float)(k % 100 * 10);
    }
    memcpy(segments, others, sizeof segments);
    const size_t count = join(MOST);
    assert_true(count > 100 && count < MOST / 2);
    static asj_segment_match first[MOST];
    memcpy(first, segments, sizeof segments);
    for (int32_t k = 0; k < MOST; k++)
        segments[k] = others[MOST - 1 - k];
    assert_int_equal(join(MOST), count);
    assert_memory_equal(segments, first, count * sizeof *segments);
    assert_int_equal(join(count), count);
    assert_memory_equal(segments, first, count * sizeof *segments);
    for (size_t k = 1; k < count; k++)
        assert_true(segments[k - 1].match <= segments[k].match);
}

static void any_numbers(void **state)
{
    (void)state;
    assert_int_equal(asj_join_segment_matches(NULL, 5), 0);
    assert_int_equal(join(0), 0);
    segments[0] = on_the_line(0, 0, 100, ASJ_END_BOTH);
    segments[1] = on_the_line(1, 50, 50, ASJ_END_BOTH); /* a point on it */
    segments[2] = on_the_line(2, NAN, 80, ASJ_END_BOTH);
    segments[3] = on_the_line(3, 20, INFINITY, ASJ_END_BOTH);
    segments[4] = on_the_line(4, 200, 200, ASJ_END_BOTH); /* a point, twice */
    segments[5] = segments[4];
    assert_int_equal(join(6), 6);
    expect(&segments[0], 0, 0, 100, ASJ_END_CORNER, ASJ_END_BOTH);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_of_an_edge_are_one), cmocka_unit_test(a_matched_corner_is_the_end),
        cmocka_unit_test(corners_that_others_have_found),
        cmocka_unit_test(parts_that_overlap_reach_from_first_to_last), cmocka_unit_test(neighbours_stay),
        cmocka_unit_test(order_changes_nothing), cmocka_unit_test(any_numbers)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
