/* SPDX-License-Identifier: BSD-2-Clause */
#include "random_pair.h"
#include "core/sort.h"
#include "match/image_features.h"

#define MOST_JUNCTIONS 256

/* Image 1 -> image 2, about the middle: 0.9 times as large, turned by 10 degrees. */
static const double turn[4] = {0.886327, -0.156283, 0.156283, 0.886327};

/* On a lattice of 4 px, so that distances are equal here and there; one of sixteen where the one before stands. */
static void scatter(synth_random *random, int32_t count, asj_junction *junctions)
{
    memset(junctions, 0, (size_t)count * sizeof *junctions);
    for (int32_t k = 0; k < count; k++) {
        asj_junction *j = &junctions[k];
        const double angle = synth_random_between(random, 0, 2 * UNIT_PI);
        j->x = 4 * (float)floor(synth_random_between(random, 15, 85));
        j->y = 4 * (float)floor(synth_random_between(random, 15, 85));
        if (k % 16 == 15) {
            j->x = j[-1].x;
            j->y = j[-1].y;
        }
        j->branch_count = 2 + k % 3;
        for (int32_t b = 0; b < j->branch_count; b++) {
            j->branches[b].angle = (float)(angle + b * 1.4);
            j->branches[b].length = (float)synth_random_between(random, 10, 60);
        }
    }
}

static void move(synth_random *random, int32_t count, const asj_junction *from, asj_junction *to)
{
    const double middle = RANDOM_PAIR_SIDE / 2.0;
    memcpy(to, from, (size_t)count * sizeof *to);
    for (int32_t k = 0; k < count; k++) {
        const double x = (double)from[k].x - middle, y = (double)from[k].y - middle;
        to[k].x = (float)(middle + turn[0] * x + turn[1] * y + synth_random_between(random, -1, 1));
        to[k].y = (float)(middle + turn[2] * x + turn[3] * y + synth_random_between(random, -1, 1));
        const double wrong = k % 4 == 1 ? 0.6 : 0.03; /* rad */
        for (int32_t b = 0; b < to[k].branch_count; b++) {
            to[k].branches[b].angle += (float)(atan2(turn[2], turn[0]) + synth_random_between(random, -wrong, wrong));
            to[k].branches[b].length *= 0.9f * (float)synth_random_between(random, 0.95, 1.05);
        }
    }
}

static void paint(int32_t image, uint8_t *pixels)
{
    const double middle = RANDOM_PAIR_SIDE / 2.0, area = turn[0] * turn[3] - turn[1] * turn[2];
    for (int32_t y = 0; y < RANDOM_PAIR_SIDE; y++)
        for (int32_t x = 0; x < RANDOM_PAIR_SIDE; x++) {
            double u = x - middle, v = y - middle;
            if (image == 1) {
                const double p = (turn[3] * u - turn[1] * v) / area, q = (turn[0] * v - turn[2] * u) / area;
                u = p;
                v = q;
            }
            const double value = 128 + 50 * sin(0.21 * u + 0.13 * v) + 40 * cos(0.17 * v - 0.11 * u) + 20 * sin(u * v / 500);
            pixels[y * RANDOM_PAIR_SIDE + x] = (uint8_t)floor(fmin(fmax(value, 0), 255));
        }
}

void random_pair_create(asj_context *context, uint64_t seed, int32_t count, const asj_match_options *options, random_pair *pair)
{
    asj_junction junctions[2][MOST_JUNCTIONS];
    uint8_t *pixels = malloc((size_t)RANDOM_PAIR_SIDE * RANDOM_PAIR_SIDE);
    synth_random random;
    assert_true(pixels && count <= MOST_JUNCTIONS);
    synth_random_seed(&random, seed);
    scatter(&random, count, junctions[0]);
    move(&random, count, junctions[0], junctions[1]);
    pair->options = *options;
    for (int32_t n = 0; n < 2; n++) {
        const asj_image image = unit_gray8(pixels, RANDOM_PAIR_SIDE, RANDOM_PAIR_SIDE);
        paint(n, pixels);
        assert_int_equal(asj_image_features_create(context, &pair->options, &image, junctions[n], (size_t)count, n + 1, 0,
                                                   &pair->image[n]), ASJ_OK);
    }
    free(pixels);
    pair->run = (asj_match_run){.context = context, .options = &pair->options, .image = {&pair->image[0], &pair->image[1]}};
}

static void append(random_pair *pair, synth_random *random, uint32_t i, uint32_t j)
{
    const asj_l_junctions *in1 = &pair->image[0].l_junctions, *in2 = &pair->image[1].l_junctions;
    asj_candidates *all = &pair->run.candidates;
    asj_candidate c;
    void *list = all->list;
    memset(&c, 0, sizeof c);
    c.i = i;
    c.j = j;
    if (!asj_affine_between(&in1->frames[in1->first_frame[i]], &in2->frames[in2->first_frame[j]], &c.map))
        return;
    c.distance2 = (float)synth_random_between(random, 0.05, 1);
    c.similarity = (float)synth_random_between(random, -0.1, 1);
    c.score = (float)floor(synth_random_between(random, 0, 40)) / 8;
    c.support = (float)synth_random_between(random, 0, 4);
    double *moved = synth_random_unit(random) < 0.5 ? c.move1 : c.move2;
    moved[0] = synth_random_between(random, -3, 3);
    moved[1] = synth_random_between(random, -3, 3);
    assert_int_equal(asj_grow(&pair->run.context->memory, &list, &all->capacity, all->count + 1, sizeof *all->list, all->count),
                     ASJ_OK);
    all->list = list;
    all->list[all->count++] = c;
}

static int by_pair(const void *left, const void *right)
{
    const asj_candidate *p = left, *q = right;
    if (p->i != q->i)
        return p->i < q->i ? -1 : 1;
    return p->j < q->j ? -1 : p->j > q->j;
}

/* In order, each pair once. */
static void sort(asj_candidates *candidates)
{
    size_t kept = 0;
    asj_sort(candidates->list, candidates->count, sizeof *candidates->list, by_pair);
    for (size_t k = 0; k < candidates->count; k++)
        if (kept == 0 || by_pair(&candidates->list[k], &candidates->list[kept - 1]) != 0)
            candidates->list[kept++] = candidates->list[k];
    candidates->count = kept;
}

void random_pair_candidates(uint64_t seed, int32_t others, random_pair *pair)
{
    const asj_l_junctions *in1 = &pair->image[0].l_junctions, *in2 = &pair->image[1].l_junctions;
    synth_random random;
    synth_random_seed(&random, seed);
    for (uint32_t i = 0; i < in1->count; i++) {
        for (uint32_t j = 0; j < in2->count; j++)
            if (in1->l[i].junction == in2->l[j].junction)
                append(pair, &random, i, j);
        for (int32_t n = 0; n < others; n++)
            append(pair, &random, i, (uint32_t)synth_random_between(&random, 0, in2->count));
    }
    sort(&pair->run.candidates);
    assert_true(pair->run.candidates.count > in1->count);
}

void random_pair_free(random_pair *pair)
{
    asj_memory *memory = &pair->run.context->memory;
    for (int n = 0; n < 2; n++)
        asj_image_features_free(memory, &pair->image[n]);
    asj_release(memory, pair->run.candidates.list);
    asj_release(memory, pair->run.choices.list);
    memset(pair, 0, sizeof *pair);
}
