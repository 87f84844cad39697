/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/consensus.c and src/match/support.c against the formula in front of consensus.c, evaluated in double precision: every
 * candidate is compared with every other one, neighbours are found by sorting, nothing is indexed, gated or kept. */
#include "match/agreement.h"
#include "match/consensus.h"
#include "match/support.h"
#include "random_pair.h"

#define BASE 0.2
#define STEPS 5
#define MOST_CANDIDATES 4096

static random_pair pair;
static double appearance[MOST_CANDIDATES], score[MOST_CANDIDATES], support[MOST_CANDIDATES], confidence[MOST_CANDIDATES];

static uint32_t location_of(const asj_candidate *c, int32_t side)
{
    return pair.image[side].l_junctions.location[side == 0 ? c->i : c->j];
}

/* How many other locations, farther than `separation`, are nearer than q to p: q's rank among the neighbours; ties by number. */
static uint32_t rank_of(const asj_l_junctions *in, uint32_t p, uint32_t q, double separation)
{
    const double dx = in->location_x[q] - in->location_x[p], dy = in->location_y[q] - in->location_y[p];
    const double square = dx * dx + dy * dy;
    uint32_t nearer = 0;
    if (square <= separation * separation)
        return UINT32_MAX;
    for (uint32_t r = 0; r < in->location_count; r++) {
        const double ex = in->location_x[r] - in->location_x[p], ey = in->location_y[r] - in->location_y[p];
        const double other = ex * ex + ey * ey;
        nearer += other > separation * separation && (other < square || (other == square && r < q));
    }
    return nearer;
}

static double agreement(const asj_candidate *c, const asj_candidate *d)
{
    const asj_way way = asj_way_between(&pair.run, c, d);
    const double surface = (double)asj_surface_agreement(&pair.options, c, d, &way);
    const double edge = (double)asj_edge_agreement(&pair.run, c, d, &way);
    return floor((surface > edge ? surface : edge) * (double)ASJ_SUPPORT_ONE) / (double)ASJ_SUPPORT_ONE; /* as it is kept */
}

/* Sum over the neighbour locations of the largest agreement x confidence of their candidates. */
static double naive_support(const asj_candidate *c, int32_t side)
{
    const asj_l_junctions *in = &pair.image[side].l_junctions;
    double sum = 0;
    for (uint32_t q = 0; q < in->location_count; q++) {
        if (rank_of(in, location_of(c, side), q, pair.options.separation) >= (uint32_t)pair.options.neighbours)
            continue;
        double largest = 0;
        for (size_t m = 0; m < pair.run.candidates.count; m++) {
            const asj_candidate *d = &pair.run.candidates.list[m];
            if (location_of(d, side) == q)
                largest = fmax(largest, agreement(c, d) * confidence[m]);
        }
        sum += largest;
    }
    return sum;
}

/* Does candidate d compete with c: for a location of either image? */
static int competes(const asj_candidate *c, const asj_candidate *d)
{
    return location_of(c, 0) == location_of(d, 0) || location_of(c, 1) == location_of(d, 1);
}

static void evaluate(double needed)
{
    const asj_candidate *list = pair.run.candidates.list;
    const size_t count = pair.run.candidates.count;
    for (size_t k = 0; k < count; k++) {
        double least = HUGE_VAL;
        for (size_t m = 0; m < count; m++)
            least = competes(&list[k], &list[m]) ? fmin(least, (double)list[m].distance2) : least;
        appearance[k] = least / (double)list[k].distance2 * fmax((double)list[k].similarity, 1e-3);
        confidence[k] = appearance[k];
    }
    for (int step = 0; step < STEPS; step++) {
        for (size_t k = 0; k < count; k++) {
            support[k] = 0.5 * (naive_support(&list[k], 0) + naive_support(&list[k], 1));
            score[k] = appearance[k] * (BASE + support[k]);
        }
        for (size_t k = 0; k < count; k++) {
            double best = needed;
            for (size_t m = 0; m < count; m++)
                best = competes(&list[k], &list[m]) ? fmax(best, score[m]) : best;
            confidence[k] = score[k] / best;
        }
    }
}

/* Support comes in two goes, as when the guided pass adds candidates. */
static void find_support(int in_two_goes)
{
    asj_candidates *all = &pair.run.candidates;
    static asj_candidate rest[MOST_CANDIDATES];
    size_t kept = 0, taken = 0;
    for (size_t k = 0; k < all->count && in_two_goes; k++) {
        if (k % 3 == 1)
            rest[taken++] = all->list[k];
        else
            all->list[kept++] = all->list[k];
    }
    if (in_two_goes) {
        asj_candidates others = {rest, taken, taken};
        all->count = kept;
        assert_int_equal(asj_support_find(&pair.run), ASJ_OK);
        assert_int_equal(asj_candidates_merge(pair.run.context, all, &others, ASJ_STAGE_ALIGN), ASJ_OK);
        assert_int_equal(all->count, kept + taken);
    }
    assert_int_equal(asj_support_find(&pair.run), ASJ_OK);
}

static void scores_are_those_of_the_formula(void **state)
{
    (void)state;
    asj_match_options options;
    asj_match_options_init(&options);
    for (int round = 0; round < 3; round++) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, 1 + round % 2);
        double supported = 0;
        options.neighbours = round == 2 ? 40 : 8; /* more than there are, and fewer */
        random_pair_create(context, (uint64_t)round + 1, 24, &options, &pair);
        random_pair_candidates((uint64_t)round + 7, 1, &pair);
        assert_true(pair.run.candidates.count < MOST_CANDIDATES);
        find_support(round > 0);
        assert_int_equal(asj_consensus(&pair.run), ASJ_OK);
        evaluate((double)asj_needed_support(&pair.run));
        for (size_t k = 0; k < pair.run.candidates.count; k++) {
            const asj_candidate *c = &pair.run.candidates.list[k];
            unit_near("support", round, (double)k, (double)c->support, support[k], 1e-4 * (1 + support[k]));
            unit_near("score", round, (double)k, (double)c->score, score[k], 1e-4 * (1 + score[k]));
            supported += support[k] > 0.5;
        }
        assert_true(supported > 20 && supported < (double)pair.run.candidates.count); /* true ones are, false ones are not */
        asj_support_free(&context->memory, &pair.run.support);
        random_pair_free(&pair);
        unit_context_free(&counter, &context);
    }
}

/* Without room for all supporters every candidate keeps the first of its list, which are at the nearest locations. */
static void a_share_is_what_is_nearest(void **state)
{
    (void)state;
    enum { SHARE = 3 };
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 2);
    asj_match_options options;
    asj_match_options_init(&options);
    random_pair_create(context, 5, 24, &options, &pair);
    random_pair_candidates(9, 1, &pair);
    const uint32_t count = (uint32_t)pair.run.candidates.count;
    assert_int_equal(asj_support_find(&pair.run), ASJ_OK);
    asj_support all = pair.run.support;
    memset(&pair.run.support, 0, sizeof pair.run.support);
    for (uint32_t k = 0; k < count; k++)
        pair.run.candidates.list[k].number = 0;
    assert_int_equal(asj_support_find_within(&pair.run, (size_t)count * (SHARE + 1) - 1), ASJ_OK);
    uint32_t cut = 0;
    for (int side = 0; side < 2; side++)
        for (uint32_t k = 0; k < count; k++) {
            const asj_supporters *whole = &all.side[side], *part = &pair.run.support.side[side];
            assert_int_equal(part->count[k], whole->count[k] < SHARE ? whole->count[k] : SHARE);
            for (uint32_t n = 0; n < part->count[k]; n++) {
                const asj_supporter *a = whole->list + whole->offset[k] + n, *b = part->list + part->offset[k] + n;
                assert_true(a->number == b->number && a->weight == b->weight && a->neighbour == b->neighbour);
            }
            cut += whole->count[k] > SHARE;
        }
    assert_true(cut > 20);
    asj_support_free(&context->memory, &all);
    asj_support_free(&context->memory, &pair.run.support);
    random_pair_free(&pair);
    unit_context_free(&counter, &context);
}

/* minimum_support x (neighbours that can be asked / all that the option names), mean of both images. */
static void needed_support_falls_with_the_locations(void **state)
{
    (void)state;
    asj_match_options options;
    asj_image_features image[2];
    memset(image, 0, sizeof image);
    asj_match_options_init(&options);
    const asj_match_run run = {.options = &options, .image = {&image[0], &image[1]}};
    options.neighbours = 40;
    options.minimum_support = 2;
    const uint32_t counts[][2] = {{100, 100}, {41, 100}, {21, 100}, {11, 21}, {1, 1}, {0, 0}};
    const double asked[] = {1, 1, 0.75, 0.375, 0.025, 0.025};
    for (size_t n = 0; n < UNIT_COUNT(counts); n++) {
        image[0].l_junctions.home_locations = counts[n][0];
        image[1].l_junctions.home_locations = counts[n][1];
        unit_near("needed", (double)n, 0, (double)asj_needed_support(&run), 2 * asked[n], 1e-6);
    }
    options.neighbours = 0; /* nobody could give it */
    unit_near("needed", 0, 0, (double)asj_needed_support(&run), 0, 1e-6);
}

static void without_neighbours_distance_decides(void **state)
{
    (void)state;
    unit_counter counter = {0, 0, 0, 0};
    asj_context *context = unit_context(&counter, 1);
    asj_match_options options;
    asj_match_options_init(&options);
    options.neighbours = 0;
    random_pair_create(context, 1, 10, &options, &pair);
    random_pair_candidates(2, 2, &pair);
    pair.run.candidates.list[0].distance2 = 0;
    assert_int_equal(asj_support_find(&pair.run), ASJ_OK);
    assert_int_equal(asj_consensus(&pair.run), ASJ_OK);
    for (size_t k = 0; k < pair.run.candidates.count; k++) {
        const asj_candidate *c = &pair.run.candidates.list[k];
        const double score_of = 1 / sqrt(k == 0 ? 1e-12 : (double)c->distance2);
        unit_near("score", (double)k, 0, (double)c->score, score_of, 1e-6 * score_of);
        assert_true(c->support == 0);
    }
    random_pair_free(&pair);
    unit_context_free(&counter, &context);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scores_are_those_of_the_formula),
        cmocka_unit_test(a_share_is_what_is_nearest),
        cmocka_unit_test(needed_support_falls_with_the_locations),
        cmocka_unit_test(without_neighbours_distance_decides),
    };
    return cmocka_run_group_tests_name("consensus", tests, NULL, NULL);
}
