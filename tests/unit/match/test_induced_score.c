/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/induced_score.c and what rank.c makes of it: pairs of the paper's patches that are left early change nothing. */
#include "match/image_features.h"
#include "match/shortlist.h"
#include "random.h"
#include "render.h"
#include "unit_test.h"

#include <math.h>

#define WIDTH 160
#define HEIGHT 120
#define CORNERS 60
#define LIMIT 6

/* Corners anywhere, of two or three branches; every tenth where the one before it is. */
static void make_corners(synth_random *random, asj_junction *list)
{
    memset(list, 0, CORNERS * sizeof *list);
    for (int32_t n = 0; n < CORNERS; n++) {
        asj_junction *j = &list[n];
        j->x = n % 10 == 9 ? list[n - 1].x : (float)(int32_t)synth_random_between(random, 0, WIDTH);
        j->y = n % 10 == 9 ? list[n - 1].y : (float)(int32_t)synth_random_between(random, 0, HEIGHT);
        j->branch_count = 2 + n % 2;
        for (int32_t b = 0; b < j->branch_count; b++) {
            j->branches[b].angle = (float)synth_random_between(random, 2 * b, 2 * b + 1.5);
            j->branches[b].length = (float)synth_random_between(random, 5, 40);
        }
    }
}

typedef struct both {
    unit_counter counter;
    asj_context *context;
    asj_image_features features[2];
    asj_match_run run;
    asj_partner *lists[2]; /* LIMIT for each L-junction */
} both;

static void rank_all(asj_match_options *options, both *b)
{
    synth_random random;
    asj_junction corners[CORNERS];
    options->shortlist = LIMIT;
    b->context = unit_context(&b->counter, 1);
    synth_random_seed(&random, 3);
    for (int32_t n = 0; n < 2; n++) {
        uint8_t *pixels = synth_noise_image(WIDTH, HEIGHT, 128, 60, 9); /* the same picture: some patches are equal */
        const asj_image image = unit_gray8(pixels, WIDTH, HEIGHT);
        if (n == 0)
            make_corners(&random, corners);
        for (int32_t k = 0; k < CORNERS && n == 1; k += 3)
            corners[k].branches[0].length *= 1.2F;
        assert_int_equal(asj_image_features_create(b->context, options, &image, corners, CORNERS, n + 1, 0, &b->features[n]),
                         ASJ_OK);
        const uint32_t count = b->features[n].l_junctions.count;
        assert_true(count > CORNERS);
        b->lists[n] = malloc(count * LIMIT * sizeof **b->lists);
        assert_non_null(b->lists[n]);
        for (uint32_t k = 0; k < count * LIMIT; k++)
            b->lists[n][k] = (asj_partner){ASJ_NO_PARTNER, 0};
        free(pixels);
    }
    b->run = (asj_match_run){.context = b->context, .options = options, .image = {&b->features[0], &b->features[1]}};
    assert_int_equal(asj_rank_partners(&b->run, b->lists[0], b->lists[1]), ASJ_OK);
}

static void free_all(both *b)
{
    for (int32_t n = 0; n < 2; n++) {
        asj_image_features_free(&b->context->memory, &b->features[n]);
        free(b->lists[n]);
    }
    unit_context_free(&b->counter, &b->context);
}

static void paper(asj_match_options *options)
{
    asj_match_options_preset(options, ASJ_PRESET_PAPER);
    options->smoothing = 1.5;
}

/* How many partners of L-junction i of image `side` are better than this one. */
static int32_t rank(const both *b, int32_t side, uint32_t i, const asj_partner *partner)
{
    int32_t better = 0;
    for (uint32_t j = 0; j < b->features[1 - side].l_junctions.count; j++) {
        const int32_t other = asj_score_pair(&b->run, side ? j : i, side ? i : j).score;
        better += other > partner->score || (other == partner->score && j < partner->index);
    }
    return better;
}

static void whole_lists(void **state)
{
    (void)state;
    both b = {.context = NULL};
    asj_match_options options;
    paper(&options);
    options.mutual = 1; /* the lists of both sides are read */
    rank_all(&options, &b);
    for (int32_t side = 0; side < 2; side++)
        for (uint32_t i = 0; i < b.features[side].l_junctions.count; i++)
            for (int32_t k = 0; k < LIMIT; k++) {
                const asj_partner *partner = &b.lists[side][i * LIMIT + (uint32_t)k];
                if (partner->score > ASJ_NO_PARTNER)
                    assert_int_equal(rank(&b, side, i, partner), k);
                else
                    assert_true(!b.features[side].usable[i]);
            }
    free_all(&b);
}

/* The preset as it is: of each L-junction of image 1 the best, and the best elsewhere. */
static void best_and_second(void **state)
{
    (void)state;
    both b = {.context = NULL};
    asj_match_options options;
    int32_t seconds = 0;
    paper(&options);
    rank_all(&options, &b);
    const uint32_t *location = b.features[1].l_junctions.location;
    for (uint32_t i = 0; i < b.features[0].l_junctions.count; i++) {
        const asj_partner *list = &b.lists[0][i * LIMIT];
        int32_t best = ASJ_NO_PARTNER, second = ASJ_NO_PARTNER, listed = ASJ_NO_PARTNER;
        uint32_t at = 0;
        for (uint32_t j = 0; j < b.features[1].l_junctions.count; j++)
            if (asj_score_pair(&b.run, i, j).score > best) {
                best = asj_score_pair(&b.run, i, j).score;
                at = j;
            }
        for (uint32_t j = 0; j < b.features[1].l_junctions.count; j++)
            if (location[j] != location[at] && asj_score_pair(&b.run, i, j).score > second)
                second = asj_score_pair(&b.run, i, j).score;
        for (int32_t k = LIMIT - 1; k > 0; k--)
            if (list[k].score > ASJ_NO_PARTNER && location[list[k].index] != location[at])
                listed = list[k].score;
        assert_int_equal(list[0].score, best);
        assert_true(best == ASJ_NO_PARTNER || list[0].index == at);
        assert_int_equal(listed, second);
        seconds += second > ASJ_NO_PARTNER;
    }
    assert_true(seconds > CORNERS / 2);
    free_all(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_lists),
        cmocka_unit_test(best_and_second),
    };
    return cmocka_run_group_tests_name("induced_score", tests, NULL, NULL);
}
