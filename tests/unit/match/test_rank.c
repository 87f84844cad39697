/* SPDX-License-Identifier: BSD-2-Clause */
/* src/match/rank.c and src/match/product_bound.c: a bound is never too low, and the lists are those of all pairs. */
#include "random.h"
#include "match/describe.h"
#include "match/product_bound.h"
#include "match/shortlist.h"
#include "unit_test.h"

#include <math.h>

#define CORNERS 90
#define MOST_FRAMES (CORNERS * 16)

/* An image's patches, without an image. */
typedef struct patches {
    asj_image_features features;
    uint32_t first_frame[CORNERS + 1];
    uint8_t usable[MOST_FRAMES];
    int16_t units[MOST_FRAMES * ASJ_PATCH_SAMPLES];
} patches;

/* Kinds of patches: edges and slopes with a little noise, noise alone, stripes at the limit of resolution, flat ones. */
static void draw(synth_random *random, int32_t size, uint16_t *grey)
{
    const double kind = synth_random_unit(random), edge = synth_random_between(random, -1, size), fine = 3000 * (kind > 0.8);
    const double noise = kind < 0.6 ? 200 : kind < 0.7 ? 9000 : 0, slope = kind < 0.3 ? synth_random_between(random, -400, 400) : 0;
    const int32_t down = synth_random_unit(random) < 0.5;
    for (int32_t y = 0; y < size; y++)
        for (int32_t x = 0; x < size; x++)
            grey[y * size + x] = (uint16_t)(15000 + slope * x + (kind < 0.95 ? ((down ? y : x) > edge) * 5000 : 0) +
                                            fine * ((x + y) % 2) + synth_random_between(random, -noise, noise));
}

/* Some patches are the same, for ties. */
static void make(synth_random *random, int32_t size, patches *p)
{
    asj_l_junctions *c = &p->features.l_junctions;
    const size_t length = (size_t)(size * size);
    uint16_t grey[ASJ_PATCH_SAMPLES];
    c->count = CORNERS;
    c->first_frame = p->first_frame;
    c->frame_count = 0;
    p->features.patches = p->units;
    p->features.usable = p->usable;
    for (uint32_t i = 0; i < CORNERS; i++) {
        c->first_frame[i] = c->frame_count;
        c->frame_count += (uint32_t)synth_random_between(random, 0, i % 10 ? 5 : 16.99);
    }
    c->first_frame[CORNERS] = c->frame_count;
    for (uint32_t f = 0; f < c->frame_count; f++) {
        draw(random, size, grey);
        asj_patch_normalise(grey, size, p->units + f * length);
        if (f % 11 == 10)
            memcpy(p->units + f * length, p->units + (f - 7) * length, length * sizeof *p->units);
        p->usable[f] = f % 13 != 12;
    }
}

/* --- bounds ----------------------------------------------------------------------------------------------------------------- */

static void bounds_are_never_too_low(void **state)
{
    (void)state;
    static patches p[2];
    asj_match_options options;
    synth_random random;
    asj_match_options_init(&options);
    synth_random_seed(&random, 5);
    for (options.patch_size = 8; options.patch_size <= ASJ_PATCH_SIDE; options.patch_size += 4) {
        const int32_t length = asj_patch_length(&options);
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, 1);
        int32_t least[MOST_FRAMES], which[MOST_FRAMES];
        int16_t *left, *right;
        uint32_t above = 0, below = 0;
        make(&random, options.patch_size, &p[0]);
        make(&random, options.patch_size, &p[1]);
        assert_int_equal(asj_bound_left(context, &options, &p[0].features, &left), ASJ_OK);
        assert_int_equal(asj_bound_right(context, &options, &p[1].features, &right), ASJ_OK);
        const uint32_t count = p[1].features.l_junctions.frame_count;
        for (uint32_t f = 0; f < p[0].features.l_junctions.frame_count; f++) {
            const int16_t *mine = p[0].units + f * (size_t)length;
            for (uint32_t g = 0; g < MOST_FRAMES; g++) { /* just below the product; 1/4 above it for every other one */
                const int32_t more = g % 2 ? ASJ_UNIT_ONE * (ASJ_UNIT_ONE / 4) : -1;
                least[g] = g < count ? asj_patch_product(mine, p[1].units + g * (size_t)length, length) + more : 0;
            }
            const int16_t *one = left + f * ASJ_BOUND_LENGTH;
            const int32_t found = context->ops->bound->above(one, right, least, -ASJ_BOUND_LEAST, 0, (int32_t)count, NULL, which);
            for (int32_t k = 0, g = 0; g < (int32_t)count; g++) {
                const int32_t is = k < found && which[k] == g;
                assert_true(is || g % 2);
                above += (uint32_t)is;
                below += !is;
                k += is;
            }
        }
        assert_true(above > 0 && below > above / 4); /* tight enough to be of use */
        asj_release(&context->memory, left);
        asj_release(&context->memory, right);
        unit_context_free(&counter, &context);
    }
}

/* --- lists ------------------------------------------------------------------------------------------------------------------ */

/* How many partners of L-junction i (of image `side`) are better than the one of this score and number. */
static int32_t rank(const asj_match_run *run, int side, uint32_t i, int32_t score, uint32_t index)
{
    int32_t better = 0;
    for (uint32_t j = 0; j < CORNERS; j++) {
        const int32_t other = asj_score_pair(run, side ? j : i, side ? i : j).score;
        better += other > score || (other == score && j < index);
    }
    return better;
}

static void lists_are_those_of_all_pairs(void **state)
{
    (void)state;
    static patches p[2];
    static asj_partner lists[2][CORNERS * 32];
    asj_match_options options;
    synth_random random;
    asj_match_options_init(&options);
    synth_random_seed(&random, 6);
    for (options.shortlist = 1; options.shortlist <= 32; options.shortlist += 7) {
        unit_counter counter = {0, 0, 0, 0};
        asj_context *context = unit_context(&counter, 1);
        const asj_match_run run = {.context = context, .options = &options, .image = {&p[0].features, &p[1].features}};
        for (int v = 0; v < 2; v++)
            make(&random, options.patch_size, &p[v]);
        for (int32_t k = 0; k < 2 * CORNERS * 32; k++)
            lists[k / (CORNERS * 32)][k % (CORNERS * 32)] = (asj_partner){ASJ_NO_PARTNER, 0};
        assert_int_equal(asj_rank_partners(&run, lists[0], lists[1]), ASJ_OK);
        for (int32_t k = 0; k < 2 * CORNERS * options.shortlist; k++) {
            const int side = k >= CORNERS * options.shortlist;
            const int32_t at = k - side * CORNERS * options.shortlist;
            const asj_partner *partner = &lists[side][at];
            const uint32_t i = (uint32_t)(at / options.shortlist);
            if (partner->score > ASJ_NO_PARTNER)
                assert_int_equal(rank(&run, side, i, partner->score, partner->index), at % options.shortlist);
            else
                assert_true(rank(&run, side, i, ASJ_NO_PARTNER, 0) <= at % options.shortlist);
        }
        unit_context_free(&counter, &context);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_are_never_too_low),
        cmocka_unit_test(lists_are_those_of_all_pairs),
    };
    return cmocka_run_group_tests_name("rank", tests, NULL, NULL);
}
