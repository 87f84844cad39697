/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 over part of an image: candidates of a tile, a row of them at a time. What field.c does at one pixel is done here at all
 * candidates of a row before the next offset or sector is looked at, so that compilers make vectors of it. Where candidates are two
 * pixels apart, even and odd columns of the gradient are kept apart for that. */
#include "field.h"

#include <string.h>

/* Rows of the gradient around a row of candidates, and what comes of them; candidate i of sector k, or of slot k, at
 * [k * ASJ_FIELD_TILE + i]. */
typedef struct work {
    const asj_field *field;
    int32_t margin;   /* columns to the left of the tile */
    int32_t count;    /* candidates in a row */
    size_t stride;    /* elements of a row's columns of one kind */
    int16_t *ring;    /* of each row: gx of the even columns, of the odd ones, and gy */
    uint16_t *total;
    uint16_t *slots;  /* sector_plan.h */
    uint16_t *z;
} work;

static size_t row_size(const work *w)
{
    return 2 * (size_t)w->field->step * w->stride;
}

static int16_t *row_of(const work *w, int32_t y)
{
    const int32_t depth = 2 * w->field->sectors.radius + 1;
    return w->ring + (size_t)((y + depth) % depth) * row_size(w);
}

/* Columns from `row` on, by kind. */
static void split(const work *w, const int16_t *row, int16_t *restrict out)
{
    const int32_t step = w->field->step, width = w->count + 2 * w->margin / step;
    for (int32_t kind = 0; kind < step; kind++, row++, out += w->stride)
        for (int32_t i = 0; i < width; i++)
            out[i] = row[i * step];
}

/* gamma of an offset, at all candidates, to their totals. */
static void add_gammas(const int16_t *restrict gx, const int16_t *restrict gy, asj_direction u, int32_t count,
                       uint16_t *restrict total)
{
    for (int32_t i = 0; i < count; i++)
        total[i] = (uint16_t)(total[i] + asj_sector_gamma(u, gx[i], gy[i]));
}

/* The slots of the candidates in row y. */
static void fill_slots(const work *w, int32_t y)
{
    const asj_sectors *s = &w->field->sectors;
    const asj_sector_plan *plan = &w->field->plan;
    const size_t gy = (size_t)w->field->step * w->stride;
    uint16_t *slot = w->slots;
    memset(w->total, 0, ASJ_FIELD_TILE * sizeof *w->total);
    for (int32_t j = 0, i = 0; j < plan->plain_count; j++, slot += ASJ_FIELD_TILE) {
        for (; i < plan->boundary[j]; i++) {
            const int32_t column = s->dx[i] + w->margin, step = w->field->step;
            const int16_t *from = row_of(w, y + s->dy[i]) + (size_t)(column % step) * w->stride + column / step;
            add_gammas(from, from + gy, asj_sector_direction(s, i), w->count, w->total);
        }
        memcpy(slot, w->total, ASJ_FIELD_TILE * sizeof *slot);
    }
    for (int32_t e = 0; e < plan->slot_count - plan->plain_count; e++, slot += ASJ_FIELD_TILE) {
        const uint16_t *from = w->slots + plan->extra[e] * ASJ_FIELD_TILE;
        for (int32_t i = 0; i < w->count; i++)
            slot[i] = (uint16_t)(w->total[i] + from[i]);
    }
}

/* Strengths from the slots; strong[i]: whether any of candidate i reaches what a candidate's branch must have. */
static void fill_strengths(const work *w, int16_t *restrict strong)
{
    const asj_sectors *s = &w->field->sectors;
    const asj_sector_plan *plan = &w->field->plan;
    memset(strong, 0, ASJ_FIELD_TILE * sizeof *strong);
    for (int32_t k = 0; k < s->count; k++) {
        const uint16_t *low = w->slots + plan->low[k] * ASJ_FIELD_TILE, *high = w->slots + plan->high[k] * ASJ_FIELD_TILE;
        const uint16_t mean = s->mean[k], scale = s->scale[k];
        const int16_t least = (int16_t)(w->field->candidate[k] - 1);
        uint16_t *z = w->z + k * ASJ_FIELD_TILE;
        for (int32_t i = 0; i < w->count; i++) {
            const uint16_t sum = (uint16_t)(high[i] - low[i]), excess = (uint16_t)((sum > mean ? sum : mean) - mean);
            const int16_t strength = (int16_t)((uint32_t)excess * scale >> 16); /* below 2^15 */
            z[i] = (uint16_t)strength;
            strong[i] = (int16_t)(strong[i] | -(strength > least));
        }
    }
}

/* Bits of the candidates of row y. */
static void find_row(const work *w, int32_t y, uint16_t *bits)
{
    int16_t strong[ASJ_FIELD_TILE];
    uint16_t z[ASJ_FIELD_MAX_SECTORS];
    fill_slots(w, y);
    fill_strengths(w, strong);
    for (int32_t i = 0; i < w->count; i++) {
        const int32_t x = i * w->field->step;
        for (int32_t k = 0; strong[i] && k < w->field->sectors.count; k++)
            z[k] = w->z[k * ASJ_FIELD_TILE + i];
        if (strong[i] && asj_field_is_candidate(w->field, z))
            bits[x / ASJ_LANES] = (uint16_t)(bits[x / ASJ_LANES] | 1u << x % ASJ_LANES);
    }
}

static work start(const asj_field *field, const asj_tile *tile, uint16_t *scratch)
{
    work w = {.field = field, .margin = (field->sectors.radius + field->step - 1) / field->step * field->step,
              .count = tile->runs * ASJ_LANES / field->step, .stride = asj_field_plane_stride(field), .ring = (int16_t *)scratch};
    w.total = scratch + (size_t)(2 * field->sectors.radius + 1) * row_size(&w);
    w.slots = w.total + ASJ_FIELD_TILE;
    w.z = w.slots + (size_t)field->plan.slot_count * ASJ_FIELD_TILE;
    return w;
}

void asj_field_tile(const asj_field *field, const asj_frame *frame, const asj_tile *tile, uint16_t *scratch, uint16_t *masks)
{
    const work w = start(field, tile, scratch);
    const int32_t radius = field->sectors.radius;
    for (int32_t y = tile->top - radius; y < tile->bottom + radius; y++) {
        const ptrdiff_t at = y * frame->stride + tile->run * ASJ_LANES - w.margin;
        const int32_t centre = y - radius;
        split(&w, frame->gradient_x + at, row_of(&w, y));
        split(&w, frame->gradient_y + at, row_of(&w, y) + (size_t)field->step * w.stride);
        if (centre < tile->top)
            continue;
        uint16_t *bits = masks + (ptrdiff_t)centre * frame->blocks + tile->run;
        memset(bits, 0, (size_t)tile->runs * sizeof *bits);
        if (asj_field_has_candidates(field, centre))
            find_row(&w, centre, bits);
        asj_field_thin(field, frame, tile->run, tile->runs, bits);
    }
}
