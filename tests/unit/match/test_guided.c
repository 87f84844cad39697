/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/guided.c: what it proposes is what the rule in front of it says of every pair of L-junctions. */
#include "match/agreement.h"
#include "match/compare.h"
#include "match/guided.h"
#include "random_pair.h"

#define GUIDES_ASKED 8
#define MOST_PROPOSALS 32
#define MOST_L 1024

static random_pair pair;

static double distance_to(const asj_candidate *guide, int32_t side, const asj_l_junction *l)
{
    const asj_l_junction *g = asj_match_run_l(&pair.run, guide, side);
    const double dx = (double)g->x - (double)l->x, dy = (double)g->y - (double)l->y;
    return dx * dx + dy * dy;
}

/* Is choice n one of the nearest of L-junction l? */
static int asked(size_t n, int32_t side, const asj_l_junction *l)
{
    const asj_candidate *list = pair.run.candidates.list;
    const asj_choice *choices = pair.run.choices.list;
    const double mine = distance_to(&list[choices[n].candidate], side, l);
    int nearer = 0;
    for (size_t m = 0; m < pair.run.choices.count; m++) {
        const double other = distance_to(&list[choices[m].candidate], side, l);
        nearer += other < mine || (other == mine && m < n);
    }
    return nearer < GUIDES_ASKED;
}

static double angle_between(const double map[4], const double u[2], const double v[2])
{
    const double x = map[0] * u[0] + map[1] * u[1], y = map[2] * u[0] + map[3] * u[1];
    return unit_turn(atan2(y, x), atan2(v[1], v[0]));
}

/* Does the guide take L-junction l of image `side` to k of the other, location and both branches? */
static int leads(const asj_candidate *guide, int32_t side, uint32_t l, uint32_t k)
{
    const asj_l_junctions *mine = &pair.image[side].l_junctions, *others = &pair.image[1 - side].l_junctions;
    const asj_l_junction *g = asj_match_run_l(&pair.run, guide, side), *h = asj_match_run_l(&pair.run, guide, 1 - side);
    const double *map = asj_candidate_map(guide, side);
    const double *u = mine->direction + 4 * (size_t)l, *v = others->direction + 4 * (size_t)k;
    const double dx = (double)mine->l[l].x - (double)g->x, dy = (double)mine->l[l].y - (double)g->y;
    const double px = map[0] * dx + map[1] * dy, py = map[2] * dx + map[3] * dy;
    const double miss = hypot((double)others->l[k].x - (double)h->x - px, (double)others->l[k].y - (double)h->y - py);
    const double limit = 25 * UNIT_PI / 180;
    return miss <= 3 + pair.options.neighbour_tolerance * hypot(px, py) && angle_between(map, u, v) <= limit &&
           angle_between(map, u + 2, v + 2) <= limit;
}

/* Marks all pairs (i, j) that image `side` proposes: wanted[i * MOST_L + j]. */
static void propose(int32_t side, uint8_t *wanted)
{
    const asj_l_junctions *mine = &pair.image[side].l_junctions, *others = &pair.image[1 - side].l_junctions;
    for (uint32_t l = 0; l < mine->count; l++)
        for (size_t n = 0; n < pair.run.choices.count; n++) {
            const asj_candidate *guide = &pair.run.candidates.list[pair.run.choices.list[n].candidate];
            if (!asked(n, side, &mine->l[l]))
                continue;
            for (uint32_t k = 0; k < others->count; k++)
                if (leads(guide, side, l, k))
                    wanted[side == 0 ? l * MOST_L + k : k * MOST_L + l] = 1;
        }
}

/* Its place in the list, or -1. */
static int32_t find(const asj_candidate *list, size_t count, uint32_t i, uint32_t j)
{
    for (size_t k = 0; k < count; k++)
        if (list[k].i == i && list[k].j == j)
            return (int32_t)k;
    return -1;
}

/* The pair alone, compared; 0 when it has no map. */
static int compared(uint32_t i, uint32_t j, asj_candidate *c)
{
    asj_candidates one = {c, 1, 1};
    memset(c, 0, sizeof *c);
    c->i = i;
    c->j = j;
    asj_compare_and_drop(&pair.run, &one);
    return one.count == 1;
}

/* Every third candidate of a junction with itself is a match; all candidates of some L-junctions are unknown. */
static void choose(void)
{
    asj_candidates *all = &pair.run.candidates;
    size_t kept = 0;
    for (size_t k = 0; k < all->count; k++)
        if (all->list[k].i % 4 != 3)
            all->list[kept++] = all->list[k];
    all->count = kept;
    pair.run.choices.list = asj_allocate(&pair.run.context->memory, kept, sizeof *pair.run.choices.list);
    assert_non_null(pair.run.choices.list);
    for (size_t k = 0; k < kept; k++) {
        const asj_candidate *c = &all->list[k];
        if (c->i % 3 == 0 && asj_match_run_l(&pair.run, c, 0)->branch_a == asj_match_run_l(&pair.run, c, 1)->branch_a &&
            asj_match_run_l(&pair.run, c, 0)->junction == asj_match_run_l(&pair.run, c, 1)->junction)
            pair.run.choices.list[pair.run.choices.count++] = (asj_choice){(uint32_t)k, 2, 0};
    }
}

static void proposals_are_those_of_the_rule(void **state)
{
    (void)state;
    static asj_candidate before[4 * MOST_L];
    static uint8_t wanted[MOST_L * MOST_L];
    asj_match_options options;
    asj_match_options_init(&options);
    options.align_iterations = 0; /* what the alignment does with them is align.c's */
    for (uint64_t seed = 1; seed <= 3; seed++) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, 1 + (int32_t)(seed % 2));
        uint32_t fresh = 0, refused = 0;
        random_pair_create(context, seed, 60, &options, &pair);
        random_pair_candidates(seed + 20, 1, &pair);
        choose();
        const uint32_t count1 = pair.image[0].l_junctions.count, count2 = pair.image[1].l_junctions.count;
        const size_t known = pair.run.candidates.count;
        assert_true(count1 <= MOST_L && count2 <= MOST_L && known <= UNIT_COUNT(before) && pair.run.choices.count > 10);
        memcpy(before, pair.run.candidates.list, known * sizeof *before);
        memset(wanted, 0, sizeof wanted);
        propose(0, wanted);
        propose(1, wanted);
        assert_int_equal(asj_guided(&pair.run), ASJ_OK);
        for (uint32_t i = 0; i < count1; i++)
            for (uint32_t j = 0; j < count2; j++) {
                asj_candidate alone;
                const int32_t old = find(before, known, i, j);
                const int32_t now = find(pair.run.candidates.list, pair.run.candidates.count, i, j);
                if (old >= 0) {
                    assert_true(now >= 0 && memcmp(&before[old], &pair.run.candidates.list[now], sizeof *before) == 0);
                    continue;
                }
                const int has_map = compared(i, j, &alone);
                assert_int_equal(now >= 0, wanted[i * MOST_L + j] && has_map);
                assert_true(now < 0 || memcmp(&alone, &pair.run.candidates.list[now], sizeof alone) == 0);
                fresh += now >= 0;
                refused += now < 0;
            }
        assert_int_equal(pair.run.candidates.count, known + fresh); /* none twice */
        assert_true(fresh > 20 && refused > fresh && fresh < count1 * MOST_PROPOSALS / 4);
        random_pair_free(&pair);
        unit_context_free(&counter, &context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(proposals_are_those_of_the_rule),
    };
    return cmocka_run_group_tests_name("guided", tests, NULL, NULL);
}
