/* SPDX-License-Identifier: BSD-2-Clause */
/* Edges between junctions: the rule on junctions that are made up, and the graph of drawn scenes, whose edges are known exactly. */
#include "detect/edges.h"
#include "core/context.h"
#include "unit_test.h"

#include <asj/asj.h>

enum { MOST = 16 };

/* ---- the rule ---- */

typedef struct drawing {
    asj_hypothesis list[MOST];
    asj_edge edges[MOST * ASJ_MAX_BRANCHES];
    size_t count, edge_count;
} drawing;

/* Of all branches of all drawings, one behind the other. */
static asj_evidence evidence[8192];
static int32_t evidence_count;

/* A branch with an edge beyond doubt under it, or with `gamma` for each of its 3 pixels across. */
static void add_branch(asj_hypothesis *h, double angle, double length, double gamma)
{
    asj_hypothesis_branch *branch = &h->branches[h->branch_count++];
    branch->angle = angle < 0 ? angle + 2 * UNIT_PI : angle;
    assert_in_range(evidence_count, 0, 8191);
    branch->evidence = evidence_count++;
    asj_evidence *e = &evidence[branch->evidence];
    branch->length = e->length = length;
    e->alike = 1;
    branch->end = ASJ_BRANCH_END_FADED;
    for (int32_t i = 0; i < ASJ_EVIDENCE_PARTS; i++) {
        e->pixels[i] = (int32_t)(3 * length * (i + 1) / ASJ_EVIDENCE_PARTS);
        e->gamma[i] = gamma * e->pixels[i];
    }
}

/* A junction at (x, y) with a branch down, which is part of no edge; others are added. */
static asj_hypothesis *add_junction(drawing *d, double x, double y)
{
    asj_hypothesis *h = &d->list[d->count++];
    h->x = x;
    h->y = y;
    add_branch(h, UNIT_PI / 2, 9, 1.5);
    return h;
}

static void join(drawing *d)
{
    asj_context *context = NULL;
    asj_detect_options options;
    int32_t *scratch = calloc(asj_edges_scratch(d->count), sizeof *scratch);
    asj_junction_grid grid;
    assert_non_null(scratch);
    assert_int_equal(asj_context_create(NULL, &context), ASJ_OK);
    asj_detect_options_init(&options);
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_REFINE);
    assert_int_equal(asj_junction_grid_make(context, d->list, d->count, 640, 480, &grid), ASJ_OK);
    const asj_edge_search search = {&watch, &options, 640, 480, 1, evidence, &grid, d->list, d->count, scratch};
    d->edge_count = asj_edges_join(&search, d->edges);
    asj_junction_grid_free(context, &grid);
    asj_context_free(&context);
    free(scratch);
}

static int joined(const drawing *d, uint32_t a, uint32_t b)
{
    for (size_t i = 0; i < d->edge_count; i++)
        if (d->edges[i].junction_a == a && d->edges[i].junction_b == b)
            return 1;
    return 0;
}

/* Two junctions 100 px apart whose branches are so long and turned so far off each other. */
static int joins(double length1, double length2, double turn1, double turn2, double gamma)
{
    drawing d = {.count = 0};
    add_branch(add_junction(&d, 40, 70), turn1, length1, gamma);
    add_branch(add_junction(&d, 140, 70), UNIT_PI + turn2, length2, gamma);
    join(&d);
    if (d.edge_count) {
        assert_int_equal(d.edge_count, 1);
        assert_true(joined(&d, 0, 1) && d.edges[0].branch_a == 1 && d.edges[0].branch_b == 1);
        assert_true(d.edges[0].log10_nfa < 0);
        assert_int_equal(d.list[0].branches[1].end == ASJ_BRANCH_END_JUNCTION, fabs(length1 - 100) <= 4);
        assert_int_equal(d.list[0].branches[0].end, ASJ_BRANCH_END_FADED);
    }
    return (int)d.edge_count;
}

static void test_pairs(void **state)
{
    (void)state;
    assert_int_equal(joins(100, 100, 0, 0, 1.5), 1);
    assert_int_equal(joins(97, 98, 0.01, -0.01, 1.5), 1);
    assert_int_equal(joins(100, 60, 0, 0, 1.5), 1); /* one reaches, the other comes back over half of the way */
    assert_int_equal(joins(60, 100, 0, 0, 1.5), 1);
    assert_int_equal(joins(300, 130, 0, 0, 1.5), 1); /* both go on */
    assert_int_equal(joins(100, 40, 0, 0, 1.5), 0);
    assert_int_equal(joins(80, 80, 0, 0, 1.5), 0);
    assert_int_equal(joins(100, 100, 0.03, 0, 1.5), 0); /* 3 px beside the other junction */
    assert_int_equal(joins(100, 100, 0, -0.03, 1.5), 0);
    assert_int_equal(joins(100, 100, 0, 0.4, 1.5), 0);
    assert_int_equal(joins(100, 100, 0, 0, 0.33), 0); /* noise between */
}

/* A branch that only just reaches, and passes beside the other junction, which is a little farther off than along the branch. */
static void test_only_just(void **state)
{
    (void)state;
    for (int32_t i = 0; i < 40; i++) {
        drawing d = {.count = 0};
        add_branch(add_junction(&d, 40, 70), 0, 96 + 1e-3 * i, 1.5);
        add_branch(add_junction(&d, 140, 71.9), UNIT_PI, 60, 1.5);
        join(&d);
        assert_int_equal(d.edge_count, 1);
        assert_true(d.edges[0].log10_nfa < 0); /* infinity before: no branch reached as far as that */
    }
}

/* a ---- t ---- b, all branches running to the far end: what is joined depends on the branches that t has. */
static void test_between(void **state)
{
    (void)state;
    for (int both = 0; both < 2; both++) {
        drawing d = {.count = 0};
        add_branch(add_junction(&d, 40, 70), 0, 200, 1.5);
        add_branch(add_junction(&d, 240, 70), UNIT_PI, 200, 1.5);
        asj_hypothesis *t = add_junction(&d, 100, 70);
        add_branch(t, UNIT_PI, 60, 1.5);
        if (both)
            add_branch(t, 0, 140, 1.5);
        join(&d);
        assert_int_equal(d.edge_count, both ? 2 : 1);
        assert_int_equal(joined(&d, 0, 1), !both);
        assert_int_equal(joined(&d, 0, 2), both);
        assert_int_equal(joined(&d, 1, 2), both);
    }
}

/* The branch of a overshoots b, which has no branch beyond: only b knows where the edge ends. */
static void test_overshoot(void **state)
{
    drawing d = {.count = 0};
    (void)state;
    add_branch(add_junction(&d, 40, 70), 0, 115, 1.5);
    add_branch(add_junction(&d, 140, 70), UNIT_PI, 100, 1.5);
    join(&d);
    assert_true(d.edge_count == 1 && joined(&d, 0, 1));
    assert_int_equal(d.list[0].branches[1].end, ASJ_BRANCH_END_FADED);
    assert_int_equal(d.list[1].branches[1].end, ASJ_BRANCH_END_JUNCTION);
}

/* An end of which nothing is known is no end at the junction on its way. */
static void test_unsure_end(void **state)
{
    drawing d = {.count = 0};
    (void)state;
    add_branch(add_junction(&d, 40, 70), 0, 130, 1.5);
    add_branch(add_junction(&d, 140, 70), UNIT_PI, 100, 1.5);
    d.list[0].branches[1].end_variance = 900;
    join(&d);
    assert_true(d.edge_count == 1 && joined(&d, 0, 1));
    assert_int_equal(d.list[0].branches[1].end, ASJ_BRANCH_END_FADED);
}

/* In coarse octaves lines are known to tens of pixels: wherever the cells of the grid lie, what is that far off is found. */
static void test_far_off(void **state)
{
    (void)state;
    for (int octave = 4; octave <= 5; octave++)
        for (double phase = 0; phase < 32; phase += 3)
            for (double side = -1; side <= 1; side += 2) {
                drawing d = {.count = 0};
                const double x = 100 + phase, y = 200 + phase, off = side * 1.8 * (1 << octave);
                add_branch(add_junction(&d, x, y), 0, 210, 1.5);
                add_branch(add_junction(&d, x + 200, y + off), UNIT_PI, 210, 1.5);
                for (int i = 0; i < 2; i++) {
                    d.list[i].octave = octave;
                    d.list[i].branches[0].octave = d.list[i].branches[1].octave = octave;
                }
                join(&d);
                assert_int_equal(d.edge_count, 1);
            }
}

/* Whatever stands there: every branch in one edge at most, sound indices in order. */
static void test_random(void **state)
{
    synth_random random;
    size_t total = 0;
    (void)state;
    synth_random_seed(&random, 3);
    for (int round = 0; round < 60; round++) {
        drawing d = {.count = 0};
        unsigned taken[MOST] = {0};
        for (int i = 0; i < MOST; i++) { /* on a coarse grid, so that many lie on a line; some outside the image */
            asj_hypothesis *h = add_junction(&d, 40 * floor(synth_random_between(&random, 0, 5)) - 9,
                                             40 * floor(synth_random_between(&random, 0, 4)));
            for (int k = 0; k < 3; k++)
                add_branch(h, UNIT_PI / 2 * floor(synth_random_between(&random, 0, 4)), synth_random_between(&random, 5, 200), 1.5);
        }
        join(&d);
        total += d.edge_count;
        for (size_t i = 0; i < d.edge_count; i++) {
            const asj_edge *e = &d.edges[i];
            assert_true(e->junction_a < e->junction_b && e->junction_b < d.count);
            assert_true(e->branch_a < d.list[e->junction_a].branch_count && e->branch_b < d.list[e->junction_b].branch_count);
            assert_false(taken[e->junction_a] >> e->branch_a & 1 || taken[e->junction_b] >> e->branch_b & 1);
            taken[e->junction_a] |= 1u << e->branch_a;
            taken[e->junction_b] |= 1u << e->branch_b;
            assert_true(i == 0 || e->junction_a > e[-1].junction_a ||
                        (e->junction_a == e[-1].junction_a && e->branch_a > e[-1].branch_a));
        }
    }
    assert_true(total > 200);
}

/* ---- drawn scenes ---- */

static asj_detection *detect(asj_context *context, synth_scene *scene)
{
    const int32_t width = scene->width, height = scene->height;
    uint8_t *pixels = unit_picture(scene, 0.8, 2, 5);
    const asj_image image = unit_gray8(pixels, width, height);
    asj_detection *found = NULL;
    assert_int_equal(asj_detect(context, &image, NULL, &found), ASJ_OK);
    free(pixels);
    return found;
}

/* Number of edges between two places. */
static int count_edges(const asj_detection *d, synth_point a, synth_point b)
{
    int count = 0;
    for (uint32_t i = 0; i < d->edge_count; i++) {
        const asj_junction *p = &d->junctions[d->edges[i].junction_a], *q = &d->junctions[d->edges[i].junction_b];
        const double same = fmax(hypot(p->x - a.x, p->y - a.y), hypot(q->x - b.x, q->y - b.y));
        const double reversed = fmax(hypot(p->x - b.x, p->y - b.y), hypot(q->x - a.x, q->y - a.y));
        if (fmin(same, reversed) > 1.5)
            continue;
        count++;
        for (int side = 0; side < 2; side++) { /* branches point along it */
            const asj_junction *from = side ? q : p, *to = side ? p : q;
            const uint16_t branch = side ? d->edges[i].branch_b : d->edges[i].branch_a;
            assert_true(unit_turn(from->branches[branch].angle, atan2(to->y - from->y, to->x - from->x)) < 0.05);
        }
        assert_true(d->edges[i].log10_nfa < -5);
    }
    return count;
}

/* The edges of a scene are these, no more and no less. */
static void check_graph(asj_context *context, synth_scene *scene, const synth_point (*edges)[2], size_t count)
{
    asj_detection *found = detect(context, scene);
    for (size_t i = 0; i < count; i++)
        if (count_edges(found, edges[i][0], edges[i][1]) != 1)
            fail_msg("%d edges from (%g, %g) to (%g, %g)", count_edges(found, edges[i][0], edges[i][1]), edges[i][0].x,
                     edges[i][0].y, edges[i][1].x, edges[i][1].y);
    assert_int_equal(found->edge_count, count);
    asj_detection_free(&found);
}

#define POINT(px, py) ((synth_point){px, py})

static void add(synth_scene *scene, const synth_point *corners, int32_t count, double gray)
{
    synth_scene_add(scene, corners, count, synth_flat(gray), 0);
}

/* A door that stands on the line where wall and floor meet, with two panels: two closed faces, and the door's own, whose lower side
 * is where the floor begins. The floor's line runs from border to border and is cut in three. */
static void test_door(void **state)
{
    const unit_fixture *f = *state;
    synth_scene scene;
    static const synth_point door[4] = {{120.2, 40.4}, {208.7, 44.1}, {206.3, 230.6}, {116.4, 226.9}};
    static const synth_point upper[4] = {{136.3, 60.2}, {191.4, 62.9}, {190.7, 120.3}, {134.8, 118.6}};
    static const synth_point lower[4] = {{134.1, 138.5}, {190.2, 140.8}, {188.9, 208.6}, {132.2, 206.4}};
    /* through the door's feet */
    static const synth_point floor_line[4] = {{-0.5, 222.0963}, {319.5, 235.2625}, {319.5, 299.5}, {-0.5, 299.5}};
    synth_point edges[11][2];
    synth_scene_init(&scene, 320, 300, 190);
    add(&scene, floor_line, 4, 90);
    add(&scene, door, 4, 140);
    add(&scene, upper, 4, 180);
    add(&scene, lower, 4, 100);
    for (int i = 0; i < 4; i++) {
        memcpy(edges[i], (const synth_point[2]){upper[i], upper[(i + 1) % 4]}, sizeof edges[i]);
        memcpy(edges[4 + i], (const synth_point[2]){lower[i], lower[(i + 1) % 4]}, sizeof edges[i]);
    }
    memcpy(edges[8], (const synth_point[2]){door[0], door[1]}, sizeof edges[8]);
    memcpy(edges[9], (const synth_point[2]){door[1], door[2]}, sizeof edges[9]);
    memcpy(edges[10], (const synth_point[2]){door[3], door[0]}, sizeof edges[10]);
    asj_detection *found = detect(f->context, &scene);
    for (int i = 0; i < 11; i++)
        if (count_edges(found, edges[i][0], edges[i][1]) != 1)
            fail_msg("edge %d is not one", i);
    assert_int_equal(count_edges(found, door[2], door[3]), 1);
    assert_int_equal(found->edge_count, 12);
    asj_detection_free(&found);
}

/* A room seen from its middle: the back wall's face is closed, and the four edges that come from its corners leave the picture. */
static void test_room(void **state)
{
    const unit_fixture *f = *state;
    synth_scene scene;
    static const synth_point wall[4] = {{110.3, 80.6}, {230.4, 70.2}, {226.8, 190.3}, {104.9, 178.4}};
    static const synth_point corners[4] = {{-0.5, -0.5}, {319.5, -0.5}, {319.5, 239.5}, {-0.5, 239.5}};
    static const double grays[4] = {220, 165, 50, 180}; /* ceiling, right, floor, left */
    synth_point edges[4][2];
    synth_scene_init(&scene, 320, 240, 110);
    for (int i = 0; i < 4; i++) {
        const synth_point side[4] = {wall[i], corners[i], corners[(i + 1) % 4], wall[(i + 1) % 4]};
        add(&scene, side, 4, grays[i]);
        edges[i][0] = wall[i];
        edges[i][1] = wall[(i + 1) % 4];
    }
    check_graph(f->context, &scene, (const synth_point (*)[2])edges, 4);
}

/* Each parallelogram is a closed face, and nothing joins one with another. */
static void test_parallelograms(void **state)
{
    const unit_fixture *f = *state;
    for (uint64_t seed = 0; seed < 4; seed++) {
        synth_scene scene;
        synth_point edges[12][2];
        size_t count = 0;
        synth_parallelograms(&scene, 60, seed);
        for (int32_t p = 0; p < scene.count; p++)
            for (int32_t i = 0; i < 4; i++) {
                edges[count][0] = scene.polygons[p].corners[i];
                edges[count++][1] = scene.polygons[p].corners[(i + 1) % 4];
            }
        assert_int_equal(count, 12);
        check_graph(f->context, &scene, (const synth_point (*)[2])edges, count);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_pairs),  cmocka_unit_test(test_between), cmocka_unit_test(test_overshoot),
        cmocka_unit_test(test_far_off), cmocka_unit_test(test_random), cmocka_unit_test(test_door),    cmocka_unit_test(test_room),
        cmocka_unit_test(test_parallelograms), cmocka_unit_test(test_unsure_end), cmocka_unit_test(test_only_just),
    };
    return cmocka_run_group_tests(tests, unit_set_up, unit_tear_down);
}
