/* SPDX-License-Identifier: BSD-2-Clause */
/* verify.c: what the matches around contradict goes; a T needs more agreement than another corner; what stands alone stays. */
#include "match/verify.h"
#include "match/l_junctions_create.h"
#include "unit_test.h"

#define SIDE 600
#define MOST 32

/* Corners with two branches (or three: a T) on a grid, the same in both images but for a shift of some in the second. */
typedef struct stage {
    asj_junction junctions[2][MOST];
    size_t count;
    asj_image_features image[2];
    asj_candidate list[MOST];
    asj_choice choices[MOST];
    asj_match_options options;
    size_t fixed;
} stage;

static void add(stage *s, double x, double y, double move_x, double move_y, int32_t branches)
{
    for (int v = 0; v < 2; v++) {
        asj_junction *j = &s->junctions[v][s->count];
        memset(j, 0, sizeof *j);
        j->x = (float)(x + v * move_x);
        j->y = (float)(y + v * move_y);
        j->branch_count = branches;
        for (int32_t b = 0; b < branches; b++) { /* 0, 90, 180 degrees */
            j->branches[b].angle = (float)(b * UNIT_PI / 2);
            j->branches[b].length = 20;
        }
    }
    s->count++;
}

static size_t verify(asj_context *context, stage *s)
{
    size_t count = 0;
    for (int v = 0; v < 2; v++) {
        const asj_image_junctions input = {s->junctions[v], s->count, SIDE, SIDE, v + 1, 0};
        memset(&s->image[v], 0, sizeof s->image[v]);
        assert_int_equal(asj_l_junctions_create(context, &s->options, &input, &s->image[v].l_junctions), ASJ_OK);
    }
    for (uint32_t l = 0; l < s->image[0].l_junctions.count; l++) { /* the first L-junction of each junction with its like */
        if (l > 0 && s->image[0].l_junctions.l[l].junction == s->image[0].l_junctions.l[l - 1].junction)
            continue;
        memset(&s->list[count], 0, sizeof s->list[count]);
        s->list[count].i = s->list[count].j = l;
        s->list[count].map = (asj_linear){{1, 0, 0, 1}, {1, 0, 0, 1}};
        s->choices[count] = (asj_choice){(uint32_t)count, 2, 0};
        count++;
    }
    assert_int_equal(count, s->count);
    asj_match_run run = {.context = context, .options = &s->options, .image = {&s->image[0], &s->image[1]},
                         .candidates = {s->list, s->count, MOST}, .choices = {s->choices, count}};
    assert_int_equal(asj_verify(&run, s->fixed), ASJ_OK);
    for (int v = 0; v < 2; v++)
        asj_l_junctions_free(&context->memory, &s->image[v].l_junctions);
    return run.choices.count;
}

static void grid(stage *s, int32_t l_junctions)
{
    memset(s, 0, sizeof *s);
    asj_match_options_init(&s->options);
    for (int32_t k = 0; k < l_junctions; k++)
        add(s, 100 + 40 * (k % 4), 100 + 40 * (k / 4), 0, 0, 2);
}

static void what_is_contradicted_goes(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 2);
    static stage s;
    grid(&s, 12);
    add(&s, 140, 160, 70, -50, 2);
    assert_int_equal(verify(context, &s), 12);
    for (size_t n = 0; n < 12; n++)
        assert_int_equal(s.choices[n].candidate, n); /* in order */
    s.options.verify_neighbours = 0;
    assert_int_equal(verify(context, &s), 13);
    s.options.verify_neighbours = 16;
    s.options.verify_agreement = 0;
    assert_int_equal(verify(context, &s), 13);
    unit_context_free(&counter, &context);
}

/* Three matches that agree with each other against twelve: enough for corners, not for Ts. */
static void a_t_needs_more(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    static stage s;
    for (int32_t branches = 2; branches <= 3; branches++) {
        grid(&s, 12);
        for (int32_t k = 0; k < 3; k++)
            add(&s, 120 + 40 * k, 200, 60, 60, branches);
        s.options.verify_agreement = 0.25;
        assert_int_equal(verify(context, &s), branches == 2 ? 15 : 12);
    }
    unit_context_free(&counter, &context);
}

static void far_neighbours_say_little(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    static stage s;
    grid(&s, 12);
    add(&s, 400, 400, -90, 30, 2);
    s.options.verify_distance = 50;
    assert_int_equal(verify(context, &s), 13);
    s.options.verify_distance = 10000;
    assert_int_equal(verify(context, &s), 12);
    grid(&s, 1);
    assert_int_equal(verify(context, &s), 1);
    grid(&s, 0);
    assert_int_equal(verify(context, &s), 0);
    unit_context_free(&counter, &context);
}

/* Three that agree among themselves, as above, but what they say of each other does not count. */
static void fixed_ones_judge_alone(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    static stage s;
    grid(&s, 12);
    add(&s, 180, 140, 70, -50, 2); /* wrong, and stays: it is fixed */
    for (int32_t k = 0; k < 3; k++)
        add(&s, 120 + 40 * k, 200, 60, 60, 2);
    add(&s, 260, 140, 0, 0, 2);
    s.options.verify_agreement = 0.25;
    s.fixed = 13;
    assert_int_equal(verify(context, &s), 14);
    for (size_t n = 0; n < 14; n++)
        assert_int_equal(s.choices[n].candidate, n < 13 ? n : 16);
    s.fixed = 17;
    assert_int_equal(verify(context, &s), 17);
    unit_context_free(&counter, &context);
}

static void without_memory_it_says_so(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_choice choice = {0, 1, 0};
    asj_match_options options;
    asj_match_options_init(&options);
    asj_match_run run = {.context = context, .options = &options, .choices = {&choice, 1}};
    counter.fail_at = counter.calls + 1;
    assert_int_equal(asj_verify(&run, 0), ASJ_ERROR_MEMORY);
    counter.fail_at = 0;
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_contradicted_goes),
        cmocka_unit_test(a_t_needs_more),
        cmocka_unit_test(far_neighbours_say_little),
        cmocka_unit_test(fixed_ones_judge_alone),
        cmocka_unit_test(without_memory_it_says_so),
    };
    return cmocka_run_group_tests_name("verify", tests, NULL, NULL);
}
