/* SPDX-License-Identifier: BSD-2-Clause */
#include "operations.h"
#include "gradient.h"

#include <stdlib.h>
#include <string.h>

/* A place for operations on one run; the same for every variant. */
static void choose(const subject *s, int32_t *x, int32_t *y)
{
    synth_random random = s->random;
    *x = (int32_t)(synth_random_unit(&random) * s->frame.blocks) * ASJ_LANES;
    *y = (int32_t)(synth_random_unit(&random) * s->frame.height);
}

enum { BAND = 3 };

/* Every third run of the band has candidates, and not the same ones. */
static void choose_candidates(const subject *s, int32_t top, int32_t bottom, uint16_t *masks)
{
    synth_random random = s->random;
    for (int32_t y = top; y < bottom; y++) {
        uint16_t *row = masks + (ptrdiff_t)y * s->frame.blocks;
        for (int32_t b = 0; b < s->frame.blocks; b++)
            row[b] = synth_random_unit(&random) < 0.4 ? (uint16_t)(synth_random_bits(&random) & synth_random_bits(&random)) : 0;
        asj_field_cut(&s->frame, 0, s->frame.blocks, row);
    }
}

static double one_run(const subject *s)
{
    (void)s;
    return ASJ_LANES;
}

static double band_pixels(const subject *s)
{
    return (double)BAND * s->frame.width;
}

static size_t band_size(const subject *s)
{
    return BAND * (size_t)s->frame.width * sizeof(asj_isotropic_junction);
}

static void run_band(const asj_ops *ops, const subject *s, uint16_t *scratch, void *output)
{
    uint16_t *masks = calloc((size_t)s->frame.blocks * (size_t)s->frame.height, sizeof *masks);
    int32_t x, y;
    choose(s, &x, &y);
    const int32_t bottom = y + BAND < s->frame.height ? y + BAND : s->frame.height;
    if (!masks)
        abort();
    choose_candidates(s, y, bottom, masks);
    ops->isotropic_band(&s->isotropic, &s->frame, y, bottom, masks, scratch, output);
    free(masks);
}

static size_t block_size(const subject *s)
{
    (void)s;
    return ASJ_LANES * ASJ_FIELD_BRANCHES * sizeof(asj_field_branch);
}

static void run_block(const asj_ops *ops, const subject *s, uint16_t *scratch, void *output)
{
    int32_t x, y;
    asj_field_branch branches[ASJ_LANES][ASJ_FIELD_BRANCHES];
    choose(s, &x, &y);
    ops->field_block(&s->field, &s->frame, x, y, scratch, branches);
    memcpy(output, branches, sizeof branches);
}

static double tile_pixels(const subject *s)
{
    int32_t x, top;
    choose(s, &x, &top);
    return (double)s->frame.width * (s->frame.height - top / 2);
}

static size_t tile_size(const subject *s)
{
    return (size_t)s->frame.blocks * (size_t)s->frame.height * sizeof(uint16_t);
}

/* The whole image in tiles, but for the rows above `top`, which must stay as they are. */
static void run_tiles(const asj_ops *ops, const subject *s, uint16_t *scratch, void *output)
{
    const int32_t per_tile = ASJ_FIELD_TILE / ASJ_LANES, blocks = s->frame.blocks;
    int32_t x, top;
    choose(s, &x, &top);
    top /= 2;
    for (int32_t run = 0; run < blocks; run += per_tile)
        ops->field_tile(&s->field, &s->frame, run, blocks - run < per_tile ? blocks - run : per_tile, top, s->frame.height,
                        scratch, output);
}

/* The planes of the gradient with their margins, by asj_gradient() with these operations. */
static size_t plane_elements(const subject *s)
{
    return (size_t)s->picture->stride * ((size_t)s->picture->height + 2 * ASJ_MARGIN);
}

static size_t planes_size(const subject *s)
{
    return 2 * plane_elements(s) * sizeof(int16_t);
}

static double all_pixels(const subject *s)
{
    return (double)s->frame.width * s->frame.height;
}

static void run_gradient(const asj_ops *ops, const subject *s, uint16_t *scratch, void *output)
{
    const size_t count = plane_elements(s);
    asj_ops *own = s->context->ops, these = *ops;
    (void)scratch;
    s->context->ops = &these;
    if (asj_gradient(s->context, s->picture, &s->options) == ASJ_OK) {
        memcpy(output, s->picture->memory[1], count * sizeof(int16_t));
        memcpy((int16_t *)output + count, s->picture->memory[2], count * sizeof(int16_t));
    }
    s->context->ops = own;
}

/* A row in each of the four layouts. */
static size_t luma_size(const subject *s)
{
    return 4 * (size_t)s->frame.width * sizeof(uint16_t);
}

static double luma_pixels(const subject *s)
{
    return 4.0 * s->frame.width;
}

static void run_luma(const asj_ops *ops, const subject *s, uint16_t *scratch, void *output)
{
    (void)scratch;
    for (int32_t i = 0; i < 4; i++)
        ops->image_luma(s->colours, s->frame.width, 3 + i / 2, i % 2 * 2, (uint16_t *)output + i * s->frame.width);
}

const operation operations[] = {
    {"luma", luma_size, luma_pixels, run_luma},
    {"gradient", planes_size, all_pixels, run_gradient},
    {"field block", block_size, one_run, run_block},
    {"isotropic band", band_size, band_pixels, run_band},
    {"field tile", tile_size, tile_pixels, run_tiles},
};
const size_t operation_count = sizeof operations / sizeof operations[0];
