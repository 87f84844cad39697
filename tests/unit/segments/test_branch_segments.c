/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_find_segments(): what is one edge and what is not, where its ends are, which branch is a part of which; the same with all in
 * one cell; the room; bad input, no memory, cancelling. */
#include "unit_test.h"

#include <asj/asj.h>

enum { MOST = 3000 };

static asj_junction junctions[MOST + 1];

static void add_branch(asj_junction *j, double angle, float length, int32_t end)
{
    j->branches[j->branch_count++] = (asj_branch){.angle = (float)angle, .length = length, .strength = 5, .log10_nfa = -length,
                                                  .length_sd = 1.5f, .end = end};
}

static asj_junction *place(uint32_t index, float x, float y)
{
    junctions[index] = (asj_junction){.x = x, .y = y, .scale = 5, .location_sd = 0.25f};
    return &junctions[index];
}

static asj_segment_list *find(asj_context *context, size_t count)
{
    asj_segment_list *list = NULL;
    assert_int_equal(asj_find_segments(context, junctions, count, NULL, 0, &list), ASJ_OK);
    assert_non_null(list);
    assert_int_equal(list->junction_count, count);
    return list;
}

static uint32_t of_branch(const asj_segment_list *list, uint32_t junction, uint32_t branch)
{
    return list->of_branches[junction * ASJ_MAX_BRANCHES + branch];
}

/* A square: eight branches, four edges. */
static void an_edge_seen_from_both_ends_comes_once(void **state)
{
    unit_fixture *f = *state;
    for (uint32_t k = 0; k < 4; k++) {
        asj_junction *j = place(k, k == 1 || k == 2 ? 109 : 10, k >= 2 ? 60 : 10);
        add_branch(j, k < 2 ? UNIT_PI / 2 : 3 * UNIT_PI / 2, 50, ASJ_BRANCH_END_JUNCTION);
        add_branch(j, k == 1 || k == 2 ? UNIT_PI : 0, k < 2 ? 98 : 99.5f, ASJ_BRANCH_END_JUNCTION);
    }
    asj_segment_list *list = find(f->context, 4);
    assert_int_equal(list->count, 4);
    for (uint32_t k = 0; k < 4; k++) {
        const asj_segment *s = &list->segments[k];
        assert_int_equal(s->end1, ASJ_BRANCH_END_JUNCTION);
        assert_int_equal(s->end2, ASJ_BRANCH_END_JUNCTION);
        assert_int_equal(s->branch_count, 2);
        assert_true(s->junction1 < 4 && s->junction2 < 4 && s->junction1 != s->junction2);
        assert_true(s->x1 == junctions[s->junction1].x && s->y1 == junctions[s->junction1].y);
        assert_true(s->x2 == junctions[s->junction2].x && s->y2 == junctions[s->junction2].y);
        assert_true(s->sd1 == 0.25f && s->sd2 == 0.25f);
        assert_true(k == 0 || hypotf(s->x2 - s->x1, s->y2 - s->y1) <= 99); /* the longest first */
    }
    assert_int_equal(of_branch(list, 0, 1), of_branch(list, 1, 1));
    assert_int_equal(of_branch(list, 1, 0), of_branch(list, 2, 0));
    assert_int_not_equal(of_branch(list, 0, 0), of_branch(list, 1, 0));
    assert_int_equal(of_branch(list, 0, 2), ASJ_NO_SEGMENT);
    asj_segment_list_free(&list);
    assert_null(list);
    asj_segment_list_free(&list);
    asj_segment_list_free(NULL);
}

/* Corners on an edge, each with a branch to its end: one edge, as long as the longest of its parts reaches. */
static void corners_on_an_edge_are_parts_of_it(void **state)
{
    unit_fixture *f = *state;
    for (uint32_t k = 0; k < 5; k++) {
        asj_junction *j = place(k, 20 + 30 * (float)k, 40.5f);
        add_branch(j, 0, 200 - 30 * (float)k, ASJ_BRANCH_END_FADED);
        add_branch(j, UNIT_PI / 2, 25, ASJ_BRANCH_END_BORDER);
    }
    asj_segment_list *list = find(f->context, 5);
    assert_int_equal(list->count, 6);
    const asj_segment *s = &list->segments[0];
    assert_true(s->x1 == 20 && s->y1 == 40.5f && s->x2 == 220 && s->y2 == 40.5f && s->log10_nfa == -200);
    assert_int_equal(s->branch_count, 5);
    assert_int_equal(s->junction1, 0);
    assert_int_equal(s->junction2, ASJ_NO_JUNCTION);
    assert_int_equal(s->end2, ASJ_BRANCH_END_FADED);
    assert_true(s->sd2 == 1.5f);
    assert_int_equal(s->junction, 0);
    assert_int_equal(s->branch, 0);
    for (uint32_t k = 0; k < 5; k++)
        assert_int_equal(of_branch(list, k, 0), 0);
    asj_segment_list_free(&list);
}

/* Parts that overlap, and one that only two of them together reach. */
static void parts_that_overlap_reach_from_first_to_last(void **state)
{
    unit_fixture *f = *state;
    add_branch(place(0, 0, 10), 0, 100, ASJ_BRANCH_END_FADED);
    add_branch(place(1, 160, 10), UNIT_PI, 80, ASJ_BRANCH_END_FADED);
    add_branch(place(2, 200, 10), UNIT_PI, 50, ASJ_BRANCH_END_FADED);
    asj_segment_list *list = find(f->context, 3);
    assert_int_equal(list->count, 1);
    assert_true(list->segments[0].x1 == 0 && list->segments[0].x2 == 200);
    assert_int_equal(list->segments[0].junction2, 2);
    assert_int_equal(list->segments[0].end2, ASJ_BRANCH_END_JUNCTION);
    assert_int_equal(of_branch(list, 1, 0), 0);
    assert_int_equal(of_branch(list, 2, 0), 0);
    asj_segment_list_free(&list);
}

/* A corner beside a faded end is the end, though the faded one lies farther out. */
static void a_corner_beside_an_end_is_the_end(void **state)
{
    unit_fixture *f = *state;
    add_branch(place(0, 0, 10), 0, 100, ASJ_BRANCH_END_FADED);
    add_branch(place(1, 97, 10.5f), UNIT_PI, 40, ASJ_BRANCH_END_FADED);
    asj_segment_list *list = find(f->context, 2);
    assert_int_equal(list->count, 1);
    assert_true(list->segments[0].x2 == 97 && list->segments[0].y2 == 10.5f && list->segments[0].sd2 == 0.25f);
    assert_int_equal(list->segments[0].junction2, 1);
    asj_segment_list_free(&list);
}

/* Branches from two corners go on to 100; a corner at 85, or 70, has one back to them. Where it turns and they overshoot by little,
 * it is the end. */
static void a_corner_that_turns_is_the_end(void **state)
{
    static const struct { float corner; double other; float end; } cases[] = {
        {85, UNIT_PI / 2, 85}, {85, 0, 100}, {85, 0.15, 100}, {85, 0.3, 85}, {70, UNIT_PI / 2, 100}};
    unit_fixture *f = *state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++)
        for (uint32_t corner = 0; corner < 3; corner++) { /* in any order */
            asj_junction *turned = place(corner, cases[k].corner, 10);
            add_branch(place((corner + 1) % 3, 0, 10), 0, 100, ASJ_BRANCH_END_FADED);
            add_branch(place((corner + 2) % 3, 40, 10), 0, 60, ASJ_BRANCH_END_FADED);
            add_branch(turned, cases[k].other, 9, ASJ_BRANCH_END_FADED);
            add_branch(turned, UNIT_PI, cases[k].corner, ASJ_BRANCH_END_JUNCTION);
            asj_segment_list *list = find(f->context, 3);
            const asj_segment *s = &list->segments[0];
            assert_true(fmaxf(s->x1, s->x2) == cases[k].end && fminf(s->x1, s->x2) == 0 && s->y1 == 10 && s->y2 == 10);
            assert_in_range(s->branch_count, 3, 4);
            asj_segment_list_free(&list);
        }
}

/* The 5 % of the length by which ends may be out are 12 px at most; beyond 4 a corner on a long edge that goes on is no end. */
static void a_long_edge_keeps_its_ends(void **state)
{
    static const struct { float corner; double other; float end; } cases[] = {
        {955, 0, 1000},             /* goes on */
        {992, 0, 1000},
        {997, 0, 997},
        {955, UNIT_PI / 2, 1000},   /* turns, too far away */
        {992, UNIT_PI / 2, 992},
        {980, UNIT_PI / 2, 980},
        {1010, UNIT_PI / 2, 1010},
        {1010, 0, 1010},
    };
    unit_fixture *f = *state;
    for (size_t k = 0; k < UNIT_COUNT(cases); k++) {
        asj_junction *corner = place(1, cases[k].corner, 10);
        add_branch(place(0, 0, 10), 0, 1000, ASJ_BRANCH_END_FADED);
        add_branch(corner, cases[k].other, 3, ASJ_BRANCH_END_FADED);
        add_branch(corner, UNIT_PI, 900, ASJ_BRANCH_END_FADED);
        asj_segment_list *list = find(f->context, 2);
        assert_true(list->segments[0].x1 == 0 && list->segments[0].x2 == cases[k].end);
        asj_segment_list_free(&list);
    }
    add_branch(place(0, 0, 10), 0, 1000, ASJ_BRANCH_END_FADED);
    add_branch(place(1, 500, 10), 0, 545, ASJ_BRANCH_END_FADED);
    asj_segment_list *list = find(f->context, 2);
    assert_true(list->count == 1 && list->segments[0].x2 == 1045);
    asj_segment_list_free(&list);
}

/* A corner near the end of an edge that passes it does not cut the edge, whichever of its branches is looked at first. */
static void a_corner_near_an_end_is_passed(void **state)
{
    unit_fixture *f = *state;
    for (float gap = 5; gap < 20; gap += 1)
        for (uint32_t near = 0; near < 2; near++) {
            asj_junction *passed = place(near, gap, 10), *other = place(1 - near, 200, 10);
            for (uint32_t k = 0; k < 2; k++) {
                add_branch(k ? other : passed, 0, k ? 100 : 300 - gap, ASJ_BRANCH_END_FADED);
                add_branch(k ? other : passed, UNIT_PI, k ? 200 : gap, ASJ_BRANCH_END_FADED);
            }
            asj_segment_list *list = find(f->context, 2);
            const asj_segment *s = &list->segments[0];
            assert_int_equal(list->count, 1);
            assert_true(fabsf(fminf(s->x1, s->x2)) < 1e-4f && fmaxf(s->x1, s->x2) == 300);
            assert_int_equal(s->branch_count, 4);
            asj_segment_list_free(&list);
        }
}

/* Each overlaps the next by a fifth of its length. */
static void a_chain_is_one_edge(void **state)
{
    unit_fixture *f = *state;
    for (uint32_t k = 0; k < 60; k++)
        add_branch(place(k, 80 * (float)k, 10), 0, 100, ASJ_BRANCH_END_FADED);
    asj_segment_list *list = find(f->context, 60);
    assert_int_equal(list->count, 1);
    assert_int_equal(list->segments[0].branch_count, 60);
    assert_true(list->segments[0].x1 == 0 && list->segments[0].x2 == 4820);
    asj_segment_list_free(&list);
}

/* Two branches of an edge from (10, 100) to (190, 100 + bend), that cross in (100, 100). `on` > 0: the right one's corner has
 * another branch, which goes on to the right, or up. */
static asj_segment_list *halves(asj_context *context, double bend, float left, float right, float on, double on_angle)
{
    add_branch(place(0, 10, 100), 0, left, ASJ_BRANCH_END_FADED);
    asj_junction *j = place(1, 190, 100 + (float)bend);
    add_branch(j, UNIT_PI + atan2(bend, 90), right, ASJ_BRANCH_END_FADED);
    if (on > 0)
        add_branch(j, on_angle, on, ASJ_BRANCH_END_FADED);
    return find(context, 2);
}

static void assert_bent(const asj_segment_list *list, float bend)
{
    assert_int_not_equal(of_branch(list, 0, 0), of_branch(list, 1, 0));
    for (uint32_t k = 0; k < 2; k++) {
        const asj_segment *s = &list->segments[of_branch(list, k, 0)];
        unit_near("crossing x", k, (double)bend, (double)s->x2, 100, 1e-3); /* angles are floats */
        unit_near("crossing y", k, (double)bend, (double)s->y2, 100, 1e-3);
        assert_true(s->x1 == junctions[k].x && s->y1 == junctions[k].y);
        assert_true(s->end2 == ASJ_BRANCH_END_CROSSING && s->junction2 == ASJ_NO_JUNCTION && s->sd2 == 0);
        assert_true(s->branch_count == 1 && s->junction1 == k);
    }
}

/* An edge that bends comes as its halves, which end where they cross; one that does not as one, from corner to corner. */
static void halves_end_where_they_cross(void **state)
{
    unit_fixture *f = *state;
    for (int32_t longer = 0; longer < 2; longer++) { /* the left one, or the right one */
        const float left = longer ? 130 : 140, right = longer ? 140 : 130;
        asj_segment_list *list = halves(f->context, 7, left, right, 0, 0);
        assert_int_equal(list->count, 2);
        assert_bent(list, 7);
        asj_segment_list_free(&list);
        list = halves(f->context, -7, left, right, 0, 0);
        assert_bent(list, -7);
        asj_segment_list_free(&list);
        list = halves(f->context, 3.5, 165, 166, 0, 0); /* 1.75 px from the line of its ends, 2.9 from each other */
        assert_int_equal(list->count, 1);
        const asj_segment *s = list->segments;
        assert_int_equal(s->branch_count, 2);
        assert_true(s->junction1 + s->junction2 == 1 && s->end2 == ASJ_BRANCH_END_JUNCTION && s->sd2 == 0.25f);
        assert_true(s->x2 == junctions[s->junction2].x && s->y2 == junctions[s->junction2].y);
        assert_int_equal(of_branch(list, 0, 0), of_branch(list, 1, 0));
        asj_segment_list_free(&list);
    }
}

/* Of what was joined before, too: a branch along the left one's line beyond the crossing is a part of the right half. */
static void branches_are_parts_of_the_nearer_half(void **state)
{
    unit_fixture *f = *state;
    add_branch(place(2, 130, 100), 0, 18, ASJ_BRANCH_END_FADED);
    add_branch(place(3, 40, 100), 0, 30, ASJ_BRANCH_END_FADED);
    add_branch(place(0, 10, 100), 0, 140, ASJ_BRANCH_END_FADED);
    add_branch(place(1, 190, 107), UNIT_PI + atan2(7, 90), 130, ASJ_BRANCH_END_FADED);
    asj_segment_list *list = find(f->context, 4);
    assert_int_equal(list->count, 2);
    const uint32_t left = of_branch(list, 0, 0), right = of_branch(list, 1, 0);
    assert_int_not_equal(left, right);
    assert_int_equal(of_branch(list, 2, 0), right);
    assert_int_equal(of_branch(list, 3, 0), left);
    for (uint32_t k = 0; k < 2; k++) {
        assert_int_equal(list->segments[k].branch_count, 2);
        assert_int_equal(list->segments[k].end2, ASJ_BRANCH_END_CROSSING);
    }
    asj_segment_list_free(&list);
}

/* Two ways across, ones that start on the same side, and what has left the edge too far, are two edges. */
static void what_crosses_otherwise_stays(void **state)
{
    unit_fixture *f = *state;
    asj_segment_list *list = halves(f->context, 10, 130, 130, 0, 0); /* 6.3 degrees */
    assert_int_equal(list->count, 2);
    assert_true(list->segments[0].end2 == ASJ_BRANCH_END_FADED && list->segments[1].end2 == ASJ_BRANCH_END_FADED);
    asj_segment_list_free(&list);
    list = halves(f->context, 8, 170, 170, 0, 0); /* 6.2 px from each other at the end of what both cover */
    assert_true(list->count == 2 && list->segments[0].end2 == ASJ_BRANCH_END_FADED);
    asj_segment_list_free(&list);
    list = halves(f->context, 7, 94, 130, 0, 0); /* the left one hardly goes beyond the crossing */
    assert_true(list->count == 2 && list->segments[0].end2 == ASJ_BRANCH_END_FADED);
    asj_segment_list_free(&list);
    add_branch(place(0, 10, 100), 0, 140, ASJ_BRANCH_END_FADED);
    add_branch(place(1, 30, 95), atan2(5, 70), 120, ASJ_BRANCH_END_FADED);
    list = find(f->context, 2);
    assert_true(list->count == 2 && list->segments[0].end2 == ASJ_BRANCH_END_FADED);
    asj_segment_list_free(&list);
}

/* What goes on beyond the other's corner is cut only where another branch of that corner shows what lies there. */
static void beyond_a_corner_another_must_go_on(void **state)
{
    unit_fixture *f = *state;
    asj_segment_list *list = halves(f->context, 5, 200, 130, 0, 0);
    assert_true(list->count == 2 && list->segments[0].end2 == ASJ_BRANCH_END_FADED);
    asj_segment_list_free(&list);
    list = halves(f->context, 5, 200, 130, 40, -UNIT_PI / 2);
    assert_true(list->count == 3 && list->segments[0].end2 == ASJ_BRANCH_END_FADED);
    asj_segment_list_free(&list);
    list = halves(f->context, 5, 200, 130, 40, 0.15);
    assert_int_equal(list->count, 3);
    assert_bent(list, 5);
    asj_segment_list_free(&list);
}

/* What was joined beyond that corner is a part of what goes on there: of halves, and of those that are one. */
static void branches_beyond_are_of_what_goes_on(void **state)
{
    unit_fixture *f = *state;
    for (int32_t straight = 0; straight < 2; straight++) {
        const double bend = straight ? 3.5 : 5;
        add_branch(place(2, 195, 100), 0, 14, ASJ_BRANCH_END_FADED); /* along the left one's line */
        add_branch(place(0, 10, 100), 0, 200, ASJ_BRANCH_END_FADED);
        asj_junction *j = place(1, 190, 100 + (float)bend);
        add_branch(j, UNIT_PI + atan2(bend, 90), straight ? 166 : 130, ASJ_BRANCH_END_FADED);
        add_branch(j, 0.15, 40, ASJ_BRANCH_END_FADED);
        asj_segment_list *list = find(f->context, 3);
        assert_int_equal(list->count, straight ? 2 : 3);
        assert_int_equal(of_branch(list, 0, 0) == of_branch(list, 1, 0), straight);
        assert_int_equal(of_branch(list, 2, 0), of_branch(list, 1, 1));
        assert_int_equal(list->segments[of_branch(list, 1, 1)].branch_count, 2);
        assert_int_equal(list->segments[of_branch(list, 0, 0)].branch_count, straight ? 2 : 1);
        asj_segment_list_free(&list);
    }
}

/* Side by side, one after the other, crossing, touching: not one edge. */
static void what_only_is_near_stays(void **state)
{
    static const struct { float x, y; double angle; float length; } second[] = {
        {0, 13, 0, 60},      /* 3 px beside it */
        {104, 10, 0, 60},    /* begins where it ends */
        {98, 10, 0, 60},     /* overlaps by 2 px, an end's uncertainty */
        {50, -20, UNIT_PI / 2, 60}, /* across */
        {40, 12, 0.1, 40},   /* turned away */
        {0, 10, UNIT_PI, 60},/* the other way from the same corner */
        {50, 11.5f, 3 * UNIT_PI / 2, 3.2f}, /* across, both its ends on the line */
        {50, 10, 0.6, 3},    /* turned away, within 2 px */
    };
    unit_fixture *f = *state;
    for (size_t k = 0; k < UNIT_COUNT(second); k++) {
        add_branch(place(0, 0, 10), 0, 100, ASJ_BRANCH_END_FADED);
        add_branch(place(1, second[k].x, second[k].y), second[k].angle, second[k].length, ASJ_BRANCH_END_FADED);
        asj_segment_list *list = find(f->context, 2);
        assert_int_equal(list->count, 2);
        asj_segment_list_free(&list);
    }
}

/* (0, 0) to (420, 0), whole or as two halves that meet at a slight bend, and an edge that crosses it near its beginning. */
static void halves_are_cut_as_the_whole_is(void **state)
{
    unit_fixture *f = *state;
    for (int whole = 0; whole < 2; whole++) {
        uint32_t n = 0;
        if (whole) {
            add_branch(place(n++, 420, 0), UNIT_PI, 420, ASJ_BRANCH_END_FADED);
        } else {
            add_branch(place(n++, 0, 0), atan2(1.74, 238), 238, ASJ_BRANCH_END_FADED);
            add_branch(place(n++, 420, 0), atan2(1.92, -240), 240, ASJ_BRANCH_END_FADED);
        }
        add_branch(place(n++, 5, -2.3f), atan2(3.85, 40), 40.2f, ASJ_BRANCH_END_FADED);
        asj_segment_list *list = find(f->context, n);
        assert_int_equal(list->count, 2);
        for (uint32_t k = 0; k < 2; k++) {
            unit_near("where it is cut, x", whole, k, (double)list->segments[k].x2, 28.9, 0.1);
            unit_near("where it is cut, y", whole, k, (double)list->segments[k].y2, 0, 0.1);
        }
        asj_segment_list_free(&list);
    }
}

/* Branches 3 px apart, of which the graph says that they are one edge, are one with it. */
static void the_graph_says_which_are_one(void **state)
{
    unit_fixture *f = *state;
    const asj_edge edge = {.junction_a = 0, .junction_b = 1};
    for (int with = 0; with < 2; with++) {
        add_branch(place(0, 100, 10), 0, 60, ASJ_BRANCH_END_JUNCTION);
        add_branch(place(1, 160, 13), UNIT_PI, 60, ASJ_BRANCH_END_JUNCTION);
        junctions[1].branches[0].log10_nfa = -70;
        asj_segment_list *list = NULL;
        assert_int_equal(asj_find_segments(f->context, junctions, 2, with ? &edge : NULL, (size_t)with, &list), ASJ_OK);
        assert_int_equal(list->count, with ? 1 : 2);
        if (with)
            assert_true(list->segments[0].log10_nfa == -70); /* of the surer one */
        if (with)
            assert_true(list->segments[0].x2 == 160 && list->segments[0].junction2 == 1 && list->segments[0].branch_count == 2);
        assert_int_equal(of_branch(list, 1, 0) == of_branch(list, 0, 0), with);
        asj_segment_list_free(&list);
    }
    asj_segment_list *list = NULL;
    const asj_edge itself = {.junction_a = 0, .branch_a = 0, .junction_b = 0, .branch_b = 1};
    add_branch(place(0, 100, 10), 0, 3, ASJ_BRANCH_END_JUNCTION);
    add_branch(&junctions[0], 2, 3, ASJ_BRANCH_END_JUNCTION);
    add_branch(place(1, 100, 10), UNIT_PI, 3, ASJ_BRANCH_END_JUNCTION); /* at the same place */
    for (int k = 0; k < 2; k++) {
        assert_int_equal(asj_find_segments(f->context, junctions, 2, k ? &edge : &itself, 1, &list), ASJ_OK);
        assert_int_equal(list->count, 3);
        asj_segment_list_free(&list);
    }
    add_branch(place(0, 100, 10), 0, 3, ASJ_BRANCH_END_JUNCTION);
    add_branch(place(1, 103, 10), UNIT_PI, 1e-30f, ASJ_BRANCH_END_JUNCTION); /* too short to have an end of its own */
    assert_int_equal(asj_find_segments(f->context, junctions, 2, &edge, 1, &list), ASJ_OK);
    assert_true(list->count == 1 && list->segments[0].branch_count == 2);
    assert_int_equal(of_branch(list, 1, 0), 0);
    asj_segment_list_free(&list);
    add_branch(place(0, 0, 50), UNIT_PI / 2, 100, ASJ_BRANCH_END_JUNCTION);
    add_branch(place(1, 100, 50), UNIT_PI / 2, 100, ASJ_BRANCH_END_JUNCTION); /* neither goes to the other */
    assert_int_equal(asj_find_segments(f->context, junctions, 2, &edge, 1, &list), ASJ_OK);
    assert_int_equal(list->count, 2);
    assert_true(list->segments[0].y2 == 150);
    asj_segment_list_free(&list);
    const asj_edge none = {.junction_a = 0, .junction_b = 2};
    assert_int_equal(asj_find_segments(f->context, junctions, 2, &none, 1, &list), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_find_segments(f->context, junctions, 2, NULL, 1, &list), ASJ_ERROR_ARGUMENT);
    for (int k = 0; k < 2; k++) {
        asj_edge later = edge;
        later.reserved[k] = 1;
        assert_int_equal(asj_find_segments(f->context, junctions, 2, &later, 1, &list), ASJ_ERROR_OPTION);
        assert_non_null(strstr(asj_context_message(f->context), "edge 0"));
    }
    assert_null(list);
}

/* Random branches along few lines, so that many are parts of one edge and many nearly are. */
static void draw_junctions(uint64_t seed, uint32_t count, double width)
{
    synth_random random;
    synth_random_seed(&random, seed);
    for (uint32_t k = 0; k < count; k++) {
        const double line = floor(synth_random_unit(&random) * 12), across = 3 * (synth_random_unit(&random) - 0.5);
        const double slope = line * UNIT_PI / 12, along = width * (synth_random_unit(&random) - 0.5);
        asj_junction *j = place(k, (float)(width / 2 + along * cos(slope) - across * sin(slope)),
                                (float)(width / 2 + along * sin(slope) + across * cos(slope)));
        const int branches = 1 + (int)(2 * synth_random_unit(&random));
        for (int b = 0; b < branches; b++) {
            const double angle = slope + 0.02 * (synth_random_unit(&random) - 0.5) + (b ? UNIT_PI : 0);
            add_branch(j, fmod(angle + 2 * UNIT_PI, 2 * UNIT_PI), (float)(8 + width / 4 * synth_random_unit(&random)),
                       ASJ_BRANCH_END_FADED);
        }
    }
}

/* Cells and classes of directions leave nothing out: the same segments as in one cell and without classes, which a junction
 * very far away makes of all of them. */
static void cells_change_nothing(void **state)
{
    unit_fixture *f = *state;
    uint32_t joined = 0;
    for (uint64_t seed = 1; seed <= 40; seed++) {
        const uint32_t count = seed <= 38 ? 20 + 10 * (uint32_t)seed : 1500;
        draw_junctions(seed, count, seed % 4 == 0 ? 20000 : seed % 4 == 1 ? 90 : 640);
        asj_segment_list *list = find(f->context, count);
        add_branch(place(count, 2e12f, 0), UNIT_PI / 2, 4, ASJ_BRANCH_END_FADED); /* shorter than all others */
        asj_segment_list *expected = find(f->context, count + 1);
        uint32_t parts = 0, named = 0;
        assert_int_equal(list->count + 1, expected->count);
        assert_memory_equal(list->segments, expected->segments, list->count * sizeof *list->segments);
        assert_memory_equal(list->of_branches, expected->of_branches, count * ASJ_MAX_BRANCHES * sizeof *list->of_branches);
        for (uint32_t k = 0; k < list->count; k++) {
            const asj_segment *s = &list->segments[k];
            assert_int_equal(of_branch(list, s->junction, s->branch), k);
            parts += s->branch_count;
        }
        for (uint32_t k = 0; k < count * ASJ_MAX_BRANCHES; k++)
            named += list->of_branches[k] != ASJ_NO_SEGMENT;
        assert_int_equal(named, parts);
        joined += parts - list->count;
        asj_segment_list_free(&list);
        asj_segment_list_free(&expected);
    }
    assert_true(joined > 3000);
}

static asj_status find_of(asj_context *context, const asj_detection *found, asj_segment_list **list)
{
    return asj_find_segments(context, found->junctions, found->junction_count, found->edges, found->edge_count, list);
}

static double length_of(const asj_junction *j, uint16_t branch)
{
    return (double)j->branches[branch].length;
}

/* Both branches of an edge of the graph are parts of one segment: of those that end at each other's junctions always. */
static void edges_of_the_room_come_once(void **state)
{
    unit_fixture *f = *state;
    uint8_t *pixels = unit_room_picture(0, 640, 480);
    const asj_image image = unit_gray8(pixels, 640, 480);
    asj_detection *found = NULL;
    asj_segment_list *list = NULL, *again = NULL;
    assert_int_equal(asj_detect(f->context, &image, NULL, &found), ASJ_OK);
    assert_int_equal(find_of(f->context, found, &list), ASJ_OK);
    assert_int_equal(find_of(f->context, found, &again), ASJ_OK);
    uint32_t branches = 0, of_one = 0, mutual = 0;
    for (uint32_t k = 0; k < found->junction_count; k++)
        branches += (uint32_t)found->junctions[k].branch_count;
    assert_in_range(list->count, found->edge_count, branches * 7 / 10);
    assert_int_equal(list->count, again->count);
    assert_memory_equal(list->segments, again->segments, list->count * sizeof *list->segments);
    for (uint32_t k = 0; k < found->edge_count; k++) {
        const asj_edge *e = &found->edges[k];
        const asj_junction *a = &found->junctions[e->junction_a], *b = &found->junctions[e->junction_b];
        const double distance = hypot((double)(a->x - b->x), (double)(a->y - b->y));
        const int same = of_branch(list, e->junction_a, e->branch_a) == of_branch(list, e->junction_b, e->branch_b);
        of_one += same ? 1 : 0;
        if (fabs(length_of(a, e->branch_a) - distance) < 4 && fabs(length_of(b, e->branch_b) - distance) < 4) {
            assert_true(same);
            mutual++;
        }
    }
    assert_true(mutual >= 20 && of_one * 10 >= found->edge_count * 9);
    asj_segment_list_free(&list);
    asj_segment_list_free(&again);
    asj_detection_free(&found);
    free(pixels);
}

static void nothing_gives_nothing(void **state)
{
    unit_fixture *f = *state;
    asj_segment_list *list = NULL;
    assert_int_equal(asj_find_segments(f->context, NULL, 0, NULL, 0, &list), ASJ_OK);
    assert_int_equal(list->count, 0);
    asj_segment_list_free(&list);
    add_branch(place(0, 5, 5), 0, 0, ASJ_BRANCH_END_FADED); /* no length */
    place(1, 7, 7);                                         /* no branch */
    list = find(f->context, 2);
    assert_int_equal(list->count, 0);
    assert_int_equal(of_branch(list, 0, 0), ASJ_NO_SEGMENT);
    asj_segment_list_free(&list);
}

static void what_cannot_be_is_refused(void **state)
{
    unit_fixture *f = *state;
    asj_segment_list *list = NULL;
    assert_int_equal(asj_find_segments(NULL, junctions, 1, NULL, 0, &list), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_find_segments(f->context, junctions, 1, NULL, 0, NULL), ASJ_ERROR_ARGUMENT);
    assert_int_equal(asj_find_segments(f->context, NULL, 1, NULL, 0, &list), ASJ_ERROR_ARGUMENT);
    const asj_edge edge = {.junction_a = 7, .junction_b = 8};
    if (SIZE_MAX > UINT32_MAX) /* told before any is read */
        assert_int_equal(asj_find_segments(f->context, NULL, 0, &edge, UINT32_MAX, &list), ASJ_ERROR_LIMIT);
    for (int k = 0; k < 13; k++) {
        asj_junction *j = place(0, k == 0 ? NAN : k == 1 ? 3e38f : 5, k == 2 ? INFINITY : 5);
        add_branch(j, k == 3 ? (double)NAN : 0, k == 1 ? 3e38f : k == 4 ? INFINITY : 9, ASJ_BRANCH_END_FADED);
        if (k == 5)
            j->branch_count = ASJ_MAX_BRANCHES + 1;
        if (k == 6)
            j->branches[0].length = -9;
        if (k == 7)
            j->branches[0].log10_nfa = NAN;
        if (k == 8)
            j->location_sd = INFINITY;
        if (k == 9)
            j->branches[0].end = 42;
        if (k == 10)
            j->branches[0].length = 3e5f;
        if (k == 11)
            j->branches[0].angle = 2e6f;
        if (k == 12)
            j->octave = 16;
        assert_int_equal(asj_find_segments(f->context, junctions, 1, NULL, 0, &list), ASJ_ERROR_ARGUMENT);
        assert_non_null(strstr(asj_context_message(f->context), "junction 0"));
        assert_null(list);
    }
}

/* Numbers that can be, whatever they are; where a float has no room for the length there is no segment. */
static void far_away_is_no_harm(void **state)
{
    unit_fixture *f = *state;
    add_branch(place(0, -1e9f, 1e9f), 0.3, ASJ_MAX_BRANCH_LENGTH, ASJ_BRANCH_END_FADED);
    add_branch(place(1, 1, 1), 0.3, 1e-30f, ASJ_BRANCH_END_FADED);
    add_branch(place(2, 2e9f, -2e9f), 4, ASJ_MAX_BRANCH_LENGTH, ASJ_BRANCH_END_FADED);
    add_branch(place(3, 10, 10), 1, 50, ASJ_BRANCH_END_FADED);
    add_branch(place(4, 3e38f, -3e38f), 4, ASJ_MAX_BRANCH_LENGTH, ASJ_BRANCH_END_FADED);
    asj_segment_list *list = find(f->context, 5);
    assert_int_equal(list->count, 3);
    asj_segment_list_free(&list);
}

static void without_memory_nothing_is_left(void **state)
{
    unit_fixture *f = *state;
    asj_segment_list *list = NULL;
    draw_junctions(7, 200, 640);
    asj_status status = ASJ_OK;
    for (f->counter.fail_at = 1; f->counter.fail_at < 100; f->counter.fail_at++) {
        const long live = f->counter.live, fail_at = f->counter.fail_at;
        f->counter.calls = 0;
        status = asj_find_segments(f->context, junctions, 200, NULL, 0, &list);
        if (status == ASJ_OK)
            break;
        assert_int_equal(status, ASJ_ERROR_MEMORY);
        assert_null(list);
        assert_int_equal(f->counter.live, live);
        assert_true(fail_at < 99);
    }
    assert_true(f->counter.fail_at > 8);
    assert_int_equal(status, ASJ_OK);
    f->counter.fail_at = 0;
    asj_segment_list_free(&list);
}

static int32_t stop(void *user, int32_t stage, double done)
{
    (void)user;
    (void)stage;
    (void)done;
    return 1;
}

static void it_can_be_cancelled(void **state)
{
    (void)state;
    asj_context_options options;
    asj_context *context;
    asj_segment_list *list = (asj_segment_list *)&options; /* anything: NULL afterwards */
    asj_context_options_init(&options);
    options.progress = stop;
    assert_int_equal(asj_context_create(&options, &context), ASJ_OK);
    draw_junctions(3, MOST, 640);
    assert_int_equal(asj_find_segments(context, junctions, MOST, NULL, 0, &list), ASJ_ERROR_CANCELLED);
    assert_null(list);
    asj_context_free(&context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(an_edge_seen_from_both_ends_comes_once, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(corners_on_an_edge_are_parts_of_it, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(parts_that_overlap_reach_from_first_to_last, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(a_corner_beside_an_end_is_the_end, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(a_corner_that_turns_is_the_end, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(a_corner_near_an_end_is_passed, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(a_long_edge_keeps_its_ends, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(a_chain_is_one_edge, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(branches_beyond_are_of_what_goes_on, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(branches_are_parts_of_the_nearer_half, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(halves_end_where_they_cross, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(what_crosses_otherwise_stays, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(beyond_a_corner_another_must_go_on, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(what_only_is_near_stays, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(halves_are_cut_as_the_whole_is, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(the_graph_says_which_are_one, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(cells_change_nothing, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(edges_of_the_room_come_once, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(nothing_gives_nothing, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(what_cannot_be_is_refused, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(far_away_is_no_harm, unit_set_up, unit_tear_down),
        cmocka_unit_test_setup_teardown(without_memory_nothing_is_left, unit_set_up, unit_tear_down),
        cmocka_unit_test(it_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
