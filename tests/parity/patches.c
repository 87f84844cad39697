/* SPDX-License-Identifier: BSD-2-Clause */
#include "more_operations.h"
#include "match/product_bound.h"

#include <math.h>
#include <string.h>

#define SAMPLES 333 /* no multiple of any vector */
#define PRODUCTS 37
#define CANDIDATES 61
#define DISCS 11

size_t blur_size(const subject *s)
{
    return (size_t)s->frame.width * sizeof(uint16_t);
}

/* Rows of any grey levels, every radius, taps of both signs of rounding that sum to 2^14. */
asj_status run_blur(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    static uint16_t grey[ASJ_BLUR_ROWS][8192];
    synth_random random = s->random;
    const uint16_t *rows[ASJ_BLUR_ROWS];
    const int32_t radius = 1 + (int32_t)(s->seed % ASJ_BLUR_RADIUS), width = s->frame.width < 8192 ? s->frame.width : 8192;
    int32_t taps[ASJ_BLUR_RADIUS + 1], rest = 1 << 14;
    (void)scratch;
    for (int32_t i = 1; i <= radius; i++) {
        taps[i] = (int32_t)synth_random_between(&random, 0, (1 << 13) / radius);
        rest -= 2 * taps[i];
    }
    taps[0] = rest;
    for (int32_t r = 0; r < 2 * radius + 1; r++) {
        for (int32_t x = 0; x < width; x++)
            grey[r][x] = (uint16_t)synth_random_between(&random, 0, s->content == CONTENT_SATURATED ? 2 : 32640.999);
        rows[r] = grey[r];
    }
    memset(output, 0, blur_size(s));
    context->ops->pyramid->blur_row(rows, taps, radius, width, output);
    return ASJ_OK;
}

size_t samples_size(const subject *s)
{
    (void)s;
    return SAMPLES * sizeof(uint16_t) + sizeof(int32_t);
}

/* Of pixels of any grey level. */
static asj_status make_pyramid(asj_context *context, const subject *s, synth_random *random, asj_pyramid *pyramid)
{
    const size_t count = (size_t)s->frame.width * (size_t)s->frame.height;
    uint8_t *pixels = asj_allocate(&context->memory, count, 1);
    if (!pixels)
        return ASJ_ERROR_MEMORY;
    for (size_t i = 0; i < count; i++)
        pixels[i] = (uint8_t)(synth_random_bits(random) >> 56);
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, s->frame.width, s->frame.height, 0, 0};
    const asj_status status = asj_pyramid_create(context, &image, 0, pyramid);
    asj_release(&context->memory, pixels);
    return status;
}

/* Random locations of every level, some outside, some far outside. */
asj_status run_samples(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    asj_pyramid pyramid = {0};
    synth_random random = s->random;
    float x[SAMPLES], y[SAMPLES];
    uint16_t grey[SAMPLES];
    (void)scratch;
    const asj_status status = make_pyramid(context, s, &random, &pyramid);
    for (int32_t i = 0; i < SAMPLES; i++) {
        const double beyond = i % 17 ? 3 : 1e6;
        x[i] = (float)synth_random_between(&random, -beyond, s->frame.width + beyond);
        y[i] = (float)synth_random_between(&random, -beyond, s->frame.height + beyond);
    }
    if (status == ASJ_OK) {
        const int32_t level = (int32_t)(s->seed % (uint64_t)pyramid.levels);
        const int32_t inside = context->ops->pyramid->sample(&pyramid, level, x, y, SAMPLES, grey);
        memcpy(output, &inside, sizeof inside);
        memcpy((char *)output + sizeof inside, grey, sizeof grey);
    }
    asj_pyramid_free(&context->memory, &pyramid);
    return status;
}

size_t discs_size(const subject *s)
{
    (void)s;
    return DISCS * sizeof(asj_disc_sums);
}

/* Discs of all radii under maps of all kinds, across the border, far outside, and small ones, many of them inside. */
asj_status run_discs(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    asj_pyramid pyramid = {0};
    asj_disc disc;
    asj_template t;
    synth_random random = s->random;
    const double width = s->frame.width, height = s->frame.height;
    (void)scratch;
    const asj_status status = make_pyramid(context, s, &random, &pyramid);
    asj_disc_create(synth_random_between(&random, 8, 64), &disc);
    if (status == ASJ_OK)
        asj_template_create(&disc, &pyramid, synth_random_between(&random, 0, width), synth_random_between(&random, 0, height), &t);
    for (int32_t n = 0; n < DISCS && status == ASJ_OK; n++) {
        const double beyond = n % 5 ? 5 : 1e4;
        asj_disc_map map = {n % pyramid.levels, (float)synth_random_between(&random, -beyond, width + beyond),
                            (float)synth_random_between(&random, -beyond, height + beyond), {0, 0, 0, 0}};
        for (int32_t k = 0; k < 4; k++)
            map.linear[k] = (float)(synth_random_between(&random, -2, 2) * (n % 3 ? 1 : 0.1));
        context->ops->disc->compare(&disc, &t, &pyramid, &map, (asj_disc_sums *)output + n);
    }
    asj_pyramid_free(&context->memory, &pyramid);
    return status;
}

size_t products_size(const subject *s)
{
    (void)s;
    return PRODUCTS * sizeof(int32_t);
}

/* Vectors of every length that patches have, with entries as large as unit vectors allow. */
asj_status run_products(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    static int16_t vectors[PRODUCTS + 1][ASJ_PATCH_SAMPLES];
    synth_random random = s->random;
    const int32_t side = 8 + 4 * (int32_t)(s->seed % 5), length = side * side;
    const double most = ASJ_UNIT_ONE / sqrt(length);
    int16_t right[PRODUCTS * ASJ_PATCH_SAMPLES];
    int32_t which[PRODUCTS];
    (void)scratch;
    for (int32_t k = 0; k <= PRODUCTS; k++)
        for (int32_t i = 0; i < length; i++)
            vectors[k][i] = (int16_t)(k == 0 ? most : synth_random_between(&random, -most, most));
    for (int32_t k = 0; k < PRODUCTS; k++)
        memcpy(right + k * length, vectors[k + 1], (size_t)length * sizeof *right);
    for (int32_t k = 0; k < PRODUCTS; k++)
        which[k] = (int32_t)(synth_random_bits(&random) % PRODUCTS);
    context->ops->patch->products(vectors[0], right, length, which, PRODUCTS, output);
    return ASJ_OK;
}

size_t bounds_size(const subject *s)
{
    (void)s;
    return (CANDIDATES + 1) * sizeof(int32_t);
}

/* Bound vectors as large as they get, ranges that start and end anywhere, some or all of them, thresholds of all kinds. */
asj_status run_bounds(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    enum { ROOM = (CANDIDATES + ASJ_BOUND_LANES) / ASJ_BOUND_LANES * ASJ_BOUND_LANES };
    static int16_t right[ROOM * ASJ_BOUND_LENGTH];
    synth_random random = s->random;
    const double largest = ASJ_UNIT_ONE / sqrt(ASJ_BOUND_LENGTH);
    int16_t left[ASJ_BOUND_LENGTH];
    int32_t least[ROOM], *which = output;
    const int32_t first = (int32_t)(s->seed % 20), end = CANDIDATES - (int32_t)(s->seed % 17);
    (void)scratch;
    for (int32_t k = 0; k < ASJ_BOUND_LENGTH; k++)
        left[k] = (int16_t)synth_random_between(&random, -largest, largest);
    for (int32_t k = 0; k < ROOM * ASJ_BOUND_LENGTH; k++)
        right[k] = (int16_t)synth_random_between(&random, -largest, largest);
    for (int32_t g = 0; g < ROOM; g++)
        least[g] = g % 7 ? (int32_t)synth_random_between(&random, -1e8, 1e8) : ASJ_BOUND_LEAST;
    const int32_t most = s->seed % 3 ? (int32_t)synth_random_between(&random, -1e8, 1e8) : -ASJ_BOUND_LEAST;
    uint32_t among[ROOM / ASJ_BOUND_LANES] = {0};
    for (int32_t g = first; g < end; g++)
        if (synth_random_bits(&random) % 4 < s->seed % 4)
            asj_bound_add(among, first, g, g + 1 < end && g % 3 == 0 ? g + 2 : g + 1);
    memset(output, 0, bounds_size(s));
    which[CANDIDATES] = context->ops->bound->above(left, right, least, most, first, end, s->seed % 5 ? among : NULL, which);
    return ASJ_OK;
}

size_t gate_size(const subject *s)
{
    (void)s;
    return ASJ_GATE_COUNT * sizeof(uint64_t);
}

/* Queries of all counts and with all kinds of edges, on candidates of which about half are near. */
asj_status run_gate(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    static float numbers[8][CANDIDATES + ASJ_GATE_COUNT + ASJ_GATE_PADDING];
    const asj_gate_candidates list = {numbers[0], numbers[1], {numbers[2], numbers[3], numbers[4], numbers[5]},
                                      {numbers[6], numbers[7]}};
    synth_random random = s->random;
    uint64_t *passed = output;
    (void)scratch;
    for (int32_t k = 0; k < 6; k++)
        for (int32_t m = 0; m < CANDIDATES + ASJ_GATE_COUNT; m++)
            numbers[k][m] = (float)(k < 2 ? synth_random_between(&random, 0, 200)
                                          : synth_random_between(&random, -0.3, 0.3) + (k == 2 || k == 5));
    for (int32_t m = 0; m < CANDIDATES + ASJ_GATE_COUNT; m++) {
        numbers[6][m] = m % 9 ? (float)synth_random_between(&random, 0, 100) : ASJ_GATE_NO_EDGE;
        numbers[7][m] = (float)synth_random_between(&random, 0, 100);
    }
    for (uint32_t count = 1; count <= ASJ_GATE_COUNT; count++) {
        asj_gate_query query = {.x = 100, .y = 90, .slope = (float)synth_random_between(&random, 0, 0.5), .edges = count % 4};
        query.way_x = (float)synth_random_between(&random, -90, 90);
        query.way_y = (float)synth_random_between(&random, -90, 90);
        query.px = query.way_x + (float)synth_random_between(&random, -20, 20);
        query.py = query.way_y + (float)synth_random_between(&random, -20, 20);
        for (int32_t t = 0; t < 4; t++)
            query.branch[t / 2][t % 2] = (float)synth_random_between(&random, -1, 1);
        for (int32_t t = 0; t < 2; t++) {
            query.length[t] = (float)synth_random_between(&random, 0, 60);
            query.least[t] = (float)synth_random_between(&random, -50, 100);
        }
        query.cover = (float)synth_random_between(&random, 0, 1);
        passed[count - 1] = context->ops->gate->pass(&query, &list, (uint32_t)(synth_random_bits(&random) % CANDIDATES), count);
    }
    return ASJ_OK;
}
