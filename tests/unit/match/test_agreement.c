/* SPDX-License-Identifier: BSD-2-Clause */
/* agreement.c, support_gate.c and narrow_gate.c: exact under perspective; corners of one edge agree across surfaces, Ts and what
 * lies off the edge do not; the gates lose nothing. */
#include "match/narrow_gate.h"
#include "match/l_junctions_create.h"
#include "random.h"
#include "unit_test.h"

#define SIDE 600

/* Two junctions of two branches in either image (a third one, opposite to the first, makes a T), and a candidate for each. */
typedef struct stage {
    asj_junction junctions[2][2];
    asj_image_features image[2];
    asj_candidate c, d;
    asj_match_options options;
} stage;

static void set(asj_junction *j, double x, double y, double angle, double length)
{
    memset(j, 0, sizeof *j);
    j->x = (float)x;
    j->y = (float)y;
    j->branch_count = 2;
    for (int32_t b = 0; b < 2; b++) {
        j->branches[b].angle = (float)(angle + b * UNIT_PI / 2);
        j->branches[b].length = (float)length;
    }
}

static void make_t(asj_junction *j)
{
    j->branches[2] = j->branches[0];
    j->branches[2].angle += (float)UNIT_PI;
    j->branch_count = 3;
}

static void map(asj_candidate *c, uint32_t l, double a, double b, double p, double q)
{
    memset(c, 0, sizeof *c);
    c->i = c->j = l;
    const double to[4] = {a, b, p, q};
    memcpy(c->map.to, to, sizeof to);
    assert_true(asj_affine_invert(to, c->map.from));
}

static asj_match_run run_of(const stage *s)
{
    return (asj_match_run){.options = &s->options, .image = {&s->image[0], &s->image[1]}};
}

static float measure(const stage *s, const asj_candidate *c, const asj_candidate *d, int on_surface)
{
    const asj_match_run run = run_of(s);
    const asj_way way = asj_way_between(&run, c, d);
    return on_surface ? asj_surface_agreement(&s->options, c, d, &way) : asj_edge_agreement(&run, c, d, &way);
}

/* Of the surface, or of the edge. */
static float agree(stage *s, int on_surface)
{
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    for (int v = 0; v < 2; v++) {
        const asj_image_junctions input = {s->junctions[v], 2, SIDE, SIDE, v + 1, 0};
        memset(&s->image[v], 0, sizeof s->image[v]);
        assert_int_equal(asj_l_junctions_create(context, &s->options, &input, &s->image[v].l_junctions), ASJ_OK);
    }
    const asj_l_junctions *k = &s->image[0].l_junctions;
    s->c.i = s->c.j = 0;
    s->d.i = s->d.j = k->count - 1;
    const float there = measure(s, &s->c, &s->d, on_surface), back = measure(s, &s->d, &s->c, on_surface);
    assert_true(there - back < 1e-5f && back - there < 1e-5f);
    for (int v = 0; v < 2; v++)
        asj_l_junctions_free(&context->memory, &s->image[v].l_junctions);
    unit_context_free(&counter, &context);
    return there;
}

/* x -> 0.6 x / (1 + 0.002 x), y -> y / (1 + 0.002 x) and its derivative. */
static void perspective(double x, double y, double at[2], double derivative[4])
{
    const double w = 1 + 0.002 * x;
    at[0] = 0.6 * x / w;
    at[1] = y / w;
    derivative[0] = 0.6 / (w * w);
    derivative[1] = 0;
    derivative[2] = -0.002 * y / (w * w);
    derivative[3] = 1 / w;
}

static void perspective_is_no_error(void **state)
{
    (void)state;
    stage s;
    const double x[2] = {100, 300}, y[2] = {200, 260};
    asj_candidate *candidates[2] = {&s.c, &s.d};
    asj_match_options_init(&s.options);
    s.options.map_tolerance = 5;
    for (int k = 0; k < 2; k++) {
        double at[2], a[4];
        perspective(x[k], y[k], at, a);
        set(&s.junctions[0][k], x[k], y[k], 0, 20);
        set(&s.junctions[1][k], at[0], at[1], 0, 20);
        map(candidates[k], (uint32_t)k, a[0], a[1], a[2], a[3]);
    }
    assert_true(agree(&s, 1) > 0.98f);
    s.junctions[1][1].x += 40;
    assert_true(agree(&s, 1) == 0);
}

/* Corners at both ends of an edge of 400 px that is 300 px long in the second image; across the edge their maps have nothing in
 * common, along it they differ by perspective. */
static void set_edge(stage *s)
{
    asj_match_options_init(&s->options);
    for (int v = 0; v < 2; v++) {
        set(&s->junctions[v][0], 100, 100, 0, v ? 280 : 380);
        set(&s->junctions[v][1], v ? 400 : 500, 100, UNIT_PI / 2, 60); /* branches down and towards the first */
        s->junctions[v][1].branches[1].length = v ? 280 : 380;
    }
    map(&s->c, 0, 0.75 * 1.4, 0, 0, 2);
    map(&s->d, 1, 0.75 / 1.4, 0, 0, 0.5);
}

static void corners_of_one_edge_agree(void **state)
{
    (void)state;
    stage s;
    set_edge(&s);
    assert_true(agree(&s, 1) == 0);
    assert_true(agree(&s, 0) > 0.98f);
    s.junctions[1][1].y += 8; /* off the line */
    assert_true(agree(&s, 0) == 0);
    set_edge(&s);
    s.junctions[1][1].x -= 150; /* nearer than both maps say */
    assert_true(agree(&s, 0) < 0.8f);
    set_edge(&s);
    for (int k = 0; k < 2; k++)
        s.junctions[0][k].branches[k].length = 100; /* half of the way is bare */
    assert_true(agree(&s, 0) == 0);
    set_edge(&s);
    s.junctions[1][0].branches[0].angle += (float)UNIT_PI; /* leads away */
    s.junctions[1][0].branches[1].angle -= (float)UNIT_PI;
    assert_true(agree(&s, 0) == 0);
}

static void ts_say_nothing_of_edges(void **state)
{
    (void)state;
    stage s;
    set_edge(&s);
    for (int v = 0; v < 2; v++)
        make_t(&s.junctions[v][0]);
    assert_true(agree(&s, 0) == 0);
}

/* --- the gate ------------------------------------------------------------------------------------------------------------- */

enum { LOCATIONS = 60 };

/* Two images of locations; in one of five they hardly move and branches lie along the ways between these. */
static void scatter(synth_random *random, asj_junction junctions[2][LOCATIONS], asj_candidate *candidates)
{
    for (uint32_t k = 0; k < LOCATIONS; k++) {
        const double a = synth_random_between(random, 0.5, 2), b = synth_random_between(random, -0.5, 0.5);
        const double off = k % 5 == 0 ? 4 : 60;
        const double x = 60 + 8 * k, y = 100 + (k % 5 == 0 ? 0 : synth_random_between(random, 0, 100));
        const double angle = k % 5 == 0 ? 0 : synth_random_between(random, 0, 6);
        set(&junctions[0][k], x, y, angle, 300);
        set(&junctions[1][k], x + synth_random_between(random, -off, off), y + synth_random_between(random, -off, off), angle, 300);
        map(&candidates[k], k, a, b, -b, a);
    }
}

/* What d may be for c by both gates, as the matcher asks them; *wide: does it pass the first one? Side 0 or 1. */
static uint32_t passes(const stage *s, const asj_candidate *c, const asj_candidate *d, int side, int *wide)
{
    const asj_match_run run = run_of(s);
    const asj_way way = asj_way_between(&run, c, d);
    const asj_l_junctions *asked = &s->image[side].l_junctions, *others = &s->image[1 - side].l_junctions;
    const uint32_t mine = side == 0 ? c->i : c->j, here = side == 0 ? c->j : c->i, there = side == 0 ? d->j : d->i;
    const double *u = others->direction + 4 * (size_t)here, *map = side == 0 ? c->map.to : c->map.from;
    const double *their = side == 0 ? d->map.to : d->map.from, tolerance = s->options.neighbour_tolerance;
    const double x = side == 0 ? way.x1 : way.x2, y = side == 0 ? way.y1 : way.y2;
    const double cover = ASJ_GATE_COVER * (1 - s->options.end_tolerance);
    float numbers[8][1 + ASJ_GATE_PADDING] = {{others->l[there].x}, {others->l[there].y}};
    for (int k = 0; k < 4; k++)
        numbers[2 + k][0] = (float)their[k];
    asj_gate_lengths(&run, d, side, &numbers[6][0], &numbers[7][0]);
    const asj_gate_candidates list = {numbers[0], numbers[1], {numbers[2], numbers[3], numbers[4], numbers[5]},
                                      {numbers[6], numbers[7]}};
    asj_gate_query query = {others->l[here].x, others->l[here].y, (float)x, (float)y, (float)(map[0] * x + map[1] * y),
                            (float)(map[2] * x + map[3] * y), (float)(ASJ_GATE_SLOPE * tolerance * tolerance),
                            asj_edges_through(asked, mine, 3, x, y), {{(float)u[0], (float)u[1]}, {(float)u[2], (float)u[3]}},
                            {0, 0}, {0, 0}, (float)(cover * cover)};
    for (uint32_t t = 0; t < 2; t++) {
        query.length[t] = others->lengths[2 * here + t].length[0];
        query.least[t] = (float)(cover * sqrt(x * x + y * y) - (double)asked->lengths[2 * mine + t].length[0]);
    }
    const asj_narrow_query narrow = asj_narrow_query_of(&s->options, c, side);
    const asj_narrow_maps maps = asj_narrow_maps_of(d, 0, side);
    *wide = (int)asj_support_gate(&query, &list, 0, 1);
    return asj_narrow_gate(&query, &narrow, &maps, numbers[0][0] - query.x, numbers[1][0] - query.y);
}

static asj_status create(asj_context *context, stage *s, const asj_junction *junctions, int v)
{
    const asj_image_junctions input = {junctions, LOCATIONS, SIDE, SIDE, v + 1, 0};
    return asj_l_junctions_create(context, &s->options, &input, &s->image[v].l_junctions);
}

/* Whatever agrees passes, and much of what does not is not. */
static void the_gate_loses_nothing(void **state)
{
    (void)state;
    static asj_junction junctions[2][LOCATIONS];
    asj_candidate candidates[LOCATIONS];
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    synth_random random;
    stage s;
    int agreed[2] = {0, 0}, stopped[2] = {0, 0};
    synth_random_seed(&random, 7);
    memset(&s, 0, sizeof s);
    asj_match_options_init(&s.options);
    scatter(&random, junctions, candidates);
    for (int v = 0; v < 2; v++)
        assert_int_equal(create(context, &s, junctions[v], v), ASJ_OK);
    for (uint32_t k = 0; k < LOCATIONS * LOCATIONS; k++) {
        const asj_candidate *c = &candidates[k / LOCATIONS], *d = &candidates[k % LOCATIONS];
        const int surface = measure(&s, c, d, 1) > 0, edge = measure(&s, c, d, 0) > 0;
        agreed[0] += surface;
        agreed[1] += edge && !surface;
        for (int side = 0; side < 2; side++) {
            int wide;
            const uint32_t narrow = passes(&s, c, d, side, &wide);
            assert_true(wide || !(surface || edge));
            assert_true(narrow & ASJ_NARROW_SURFACE || !surface);
            assert_true(narrow & ASJ_NARROW_EDGE || !edge);
            stopped[0] += !wide;
            stopped[1] += wide && !narrow;
        }
    }
    assert_true(agreed[0] > 100 && agreed[1] > 20 && stopped[0] > LOCATIONS * LOCATIONS / 2 && stopped[1] > 100);
    for (int v = 0; v < 2; v++)
        asj_l_junctions_free(&context->memory, &s.image[v].l_junctions);
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(perspective_is_no_error),
        cmocka_unit_test(corners_of_one_edge_agree),
        cmocka_unit_test(ts_say_nothing_of_edges),
        cmocka_unit_test(the_gate_loses_nothing),
    };
    return cmocka_run_group_tests_name("agreement", tests, NULL, NULL);
}
