/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2: the very local junction at each pixel (paper, "Scale Ambiguity for Branches").
 *
 * Strengths z_k of all sectors of one small radius (sector.c); circular non-maximum suppression over the sectors within Delta = tau
 * / r; a maximum is kept when  K F(omega_k; J_k) <= field_epsilon  (eq. NFA-xia). At most four branches, strongest first. The angle
 * is that of the parabola through the maximum and its two neighbours.
 *
 * Departure: the number of tests is K, the orientations of this one pixel. With all pixels of the image (the paper's #J(1)) no
 * branch survives at radius 3 and hardly one at 5, and rays end long before their edge does.
 *
 * Candidates: pixels with two branches of z >= candidate_strength whose directions are more than APART away from being equal or
 * opposite. They replace the line segment detector that feeds ACJ. Preset `paper` asks for 5.15, which is sqrt(NM) K F <= 1 at
 * radius 7 in a photograph of 0.8 megapixels: what the paper's number of tests would be if it counted one line of the image.
 *
 * The fits that follow move a junction by a pixel or two, and a clear corner has a hundred candidates. So every other pixel of
 * every other row is enough (candidate_step = 1 takes them all), for half the time up to the fits. What is found is the same but
 * for corners so weak that few of their pixels reach candidate_strength; a little less of that (2.4 instead of 3) brings most of
 * them back. */
#include "field.h"
#include "nfa.h"
#include "core/angle.h"
#include "core/threads.h"

#include <math.h>
#include <string.h>

/* rad (20 degrees): chosen below minimum_opening (25), since a local branch is off by a few degrees. Larger loses corners that open
 * little, smaller takes the two sectors along a thick or bent edge for two branches. */
#define APART 0.35

#define LEAST_RUNS 128 /* for a thread: about 25 us */
#define BAND 128       /* rows of a tile; each has 2 radii more to fill planes with */

/* Sectors of as many pixels have the same one. */
static uint16_t strength_of_tail(const asj_sectors *s, int32_t k, double log_p, const uint16_t *before)
{
    for (int32_t i = 0; i < k; i++)
        if (s->size[i] == s->size[k])
            return before[i];
    const double sum = ceil(asj_nfa_sector_threshold(asj_nfa_tables(), log_p, s->size[k]) * (1 << s->gamma_bits));
    const uint16_t strength = asj_sector_strength(s, k, (uint16_t)(sum < 65535 ? sum : 65535));
    return strength > 0 ? strength : 1;
}

static int32_t twice(int32_t number)
{
    const uint32_t half = (uint32_t)number & 0xffff;
    return (int32_t)(half << 16 | half);
}

static void set_limits(asj_field *field)
{
    const asj_sectors *s = &field->sectors;
    for (int32_t k = 0; k < s->count; k++) {
        const int32_t limits[4] = {twice(s->mean[k]), twice(s->scale[k]), twice(field->keep[k] - 1),
                                   twice(field->candidate[k] - 1)};
        memcpy(field->limits[k], limits, sizeof limits);
    }
}

asj_status asj_field_create(asj_context *context, const asj_detect_options *options, asj_field *field)
{
    asj_sectors *s = &field->sectors;
    asj_status status = asj_sectors_create(&context->memory, options->field_radius, options->sector_width, s);
    if (status == ASJ_OK)
        status = asj_sector_plan_create(&context->memory, s, &field->plan);
    if (status == ASJ_OK)
        status = asj_sector_runs_create(&context->memory, s, &field->runs);
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for the sectors of radius %d", (int)options->field_radius);
    asj_sector_runs_places(&field->runs, s, field->place);
    const double log_p = log(options->field_epsilon / s->count);
    const uint16_t wanted = (uint16_t)lrint(options->candidate_strength * ASJ_STRENGTH_ONE);
    for (int32_t k = 0; k < s->count; k++) {
        field->keep[k] = strength_of_tail(s, k, log_p < 0 ? log_p : 0, field->keep);
        field->candidate[k] = field->keep[k] > wanted ? field->keep[k] : wanted;
    }
    const double per_radian = s->count / ASJ_TWO_PI;
    field->suppress = (int32_t)lrint(options->sector_width / options->field_radius * per_radian);
    field->apart = (int32_t)ceil(APART * per_radian);
    field->step = options->candidate_step;
    set_limits(field);
    return ASJ_OK;
}

void asj_field_free(asj_memory *memory, asj_field *field)
{
    asj_sector_runs_free(memory, &field->runs);
    asj_sector_plan_free(memory, &field->plan);
    asj_sectors_free(memory, &field->sectors);
}

size_t asj_field_plane_stride(const asj_field *field)
{
    return (size_t)(ASJ_FIELD_TILE + 2 * field->sectors.radius + 31) / 32 * 32;
}

/* For a block: prefix sums, strengths, peaks, pairs. For a tile: a ring of gamma planes, a row of the gradient, slots, strengths.
 * For pixels in vectors: gamma in runs, slots, strengths. */
size_t asj_field_scratch(const asj_field *field)
{
    const size_t count = (size_t)field->sectors.count, depth = 2 * (size_t)field->sectors.radius + 1;
    const size_t block = asj_sector_scratch(&field->sectors) + 3 * count * ASJ_LANES;
    const size_t stride = asj_field_plane_stride(field), step = (size_t)field->step;
    const size_t ring = depth * 4 * (size_t)field->plan.family_count * stride * step;
    const size_t lists = (size_t)field->plan.slot_count + count + 2 * (size_t)field->suppress;
    const size_t tile = ring + 2 * stride * step + lists * ASJ_FIELD_TILE;
    const size_t pixels = ((size_t)field->runs.count * ASJ_SECTOR_RUN + lists) * ASJ_FIELD_BATCH;
    const size_t most = block > tile ? block : tile;
    return ((most > pixels ? most : pixels) + 31) / 32 * 32;
}

/* Loops over ASJ_LANES are written so that compilers turn them into a few vector instructions: 16-bit values, strengths below 2^15
 * so that they can be compared as signed numbers, no branches. */

/* Turns sums into strengths, in place. */
static void strengths(const asj_sectors *s, int16_t *restrict sums)
{
    for (int32_t k = 0; k < s->count; k++) {
        int16_t *z = sums + (size_t)k * ASJ_LANES;
        const uint16_t mean = s->mean[k], scale = s->scale[k];
        for (int i = 0; i < ASJ_LANES; i++) {
            uint16_t sum = (uint16_t)z[i];
            uint16_t excess = (uint16_t)((sum > mean ? sum : mean) - mean);
            z[i] = (int16_t)(uint16_t)((uint32_t)excess * scale >> 16);
        }
    }
}

/* peaks[k][i] = -1 where sector k of pixel i reaches least[k] and is the largest of its neighbourhood, else 0. Of equal neighbours
 * the first one counts. */
static void find_peaks(const asj_field *field, const int16_t *z, const uint16_t *least, int16_t *peaks)
{
    const int32_t count = field->sectors.count;
    for (int32_t k = 0; k < count; k++) {
        const int16_t *restrict here = z + (size_t)k * ASJ_LANES;
        int16_t *restrict peak = peaks + (size_t)k * ASJ_LANES;
        const int16_t threshold = (int16_t)(least[k] - 1);
        int16_t before[ASJ_LANES], after[ASJ_LANES];
        for (int i = 0; i < ASJ_LANES; i++)
            before[i] = threshold;
        memset(after, 0, sizeof after);
        for (int32_t d = 1; d <= field->suppress; d++) {
            const int16_t *left = z + (size_t)(k >= d ? k - d : k + count - d) * ASJ_LANES;
            const int16_t *right = z + (size_t)(k + d < count ? k + d : k + d - count) * ASJ_LANES;
            for (int i = 0; i < ASJ_LANES; i++) {
                before[i] = before[i] > left[i] ? before[i] : left[i];
                after[i] = after[i] > right[i] ? after[i] : right[i];
            }
        }
        for (int i = 0; i < ASJ_LANES; i++)
            peak[i] = (int16_t)-((here[i] > before[i]) & (here[i] >= after[i]));
    }
}

/* Where they stand in the scratch: sector k of pixel i at [k * ASJ_LANES + i]. */
typedef struct evaluation {
    int16_t *z, *peaks;
} evaluation;

/* Strengths and peaks at ASJ_LANES pixels. */
static evaluation evaluate(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, const uint16_t *least,
                           uint16_t *scratch)
{
    const asj_sectors *s = &field->sectors;
    const ptrdiff_t at = y * frame->stride + x;
    int16_t *z = (int16_t *)(scratch + asj_sector_scratch(s)), *peaks = z + (size_t)s->count * ASJ_LANES;
    asj_sector_sums(s, frame->gradient_x + at, frame->gradient_y + at, frame->stride, scratch, (uint16_t *)z);
    strengths(s, z);
    find_peaks(field, z, least, peaks);
    return (evaluation){z, peaks};
}

static int any_lane(const int16_t *lanes)
{
    int16_t any = 0;
    for (int i = 0; i < ASJ_LANES; i++)
        any |= lanes[i];
    return any != 0;
}

void asj_field_block(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, uint16_t *scratch,
                     asj_field_branch branches[ASJ_LANES][ASJ_FIELD_BRANCHES])
{
    const asj_sectors *s = &field->sectors;
    const evaluation e = evaluate(field, frame, x, y, field->keep, scratch);
    const int16_t *z = e.z, *peaks = e.peaks;
    memset(branches, 0, ASJ_LANES * sizeof *branches);
    for (int32_t k = 0; k < s->count; k++) {
        const int16_t *before = z + (size_t)(k > 0 ? k - 1 : s->count - 1) * ASJ_LANES;
        const int16_t *after = z + (size_t)(k + 1 < s->count ? k + 1 : 0) * ASJ_LANES;
        const int16_t *here = z + (size_t)k * ASJ_LANES, *peak = peaks + (size_t)k * ASJ_LANES;
        if (!any_lane(peak))
            continue;
        for (int i = 0; i < ASJ_LANES; i++)
            if (peak[i]) {
                const int32_t shift = asj_field_shift(65536 / s->count, before[i], here[i], after[i]);
                asj_field_insert(branches[i], (asj_field_branch){(uint16_t)(65536 * k / s->count + shift), (uint16_t)here[i]});
            }
    }
}

void asj_field_pixels(const asj_field *field, const asj_frame *frame, const asj_pixel *pixels, int32_t count, uint16_t *scratch,
                      asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    asj_field_branch run[ASJ_LANES][ASJ_FIELD_BRANCHES];
    for (int32_t i = 0, block = -1, row = -1; i < count; i++) {
        const int32_t x = pixels[i].x, y = pixels[i].y;
        if (x / ASJ_LANES != block || y != row) {
            block = x / ASJ_LANES;
            row = y;
            asj_field_block(field, frame, block * ASJ_LANES, row, scratch, run);
        }
        memcpy(branches[i], run[x % ASJ_LANES], sizeof run[0]);
    }
}

/* out[k] = in[k] | in[k + shift], circularly. */
static void or_shifted(const int16_t *restrict in, int16_t *restrict out, int32_t count, int32_t shift)
{
    const size_t direct = (size_t)(count - shift) * ASJ_LANES, moved = (size_t)shift * ASJ_LANES;
    for (size_t i = 0; i < direct; i++)
        out[i] = in[i] | in[i + moved];
    for (size_t i = 0; i < moved; i++)
        out[direct + i] = in[direct + i] | in[i];
}

uint32_t asj_field_candidates(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, uint16_t *scratch)
{
    const int32_t count = field->sectors.count;
    const evaluation e = evaluate(field, frame, x, y, field->candidate, scratch);
    int16_t *z = e.z, *peaks = e.peaks;
    int16_t some[ASJ_LANES] = {0};
    for (int32_t k = 0; k < count; k++)
        for (int i = 0; i < ASJ_LANES; i++)
            some[i] |= peaks[(size_t)k * ASJ_LANES + (size_t)i];
    if (!any_lane(some))
        return 0;

    /* A pair (k, k + d) counts for apart <= d <= count / 2 - apart. The union of all peaks k + d in that range is built by
     * doubling: `from`[k] holds the union over [k, k + width). The strengths are not needed any more: their place serves too. */
    const int32_t target = count / 2 - 2 * field->apart + 1;
    int32_t width = 1;
    int16_t *from = peaks, *spare = z, *to = peaks + (size_t)count * ASJ_LANES;
    while (width < target) {
        int32_t shift = 2 * width <= target ? width : target - width;
        or_shifted(from, to, count, shift);
        width += shift;
        from = to;
        to = spare;
        spare = from;
    }
    int16_t found[ASJ_LANES] = {0};
    for (int32_t k = 0; k < count; k++) {
        const int16_t *peak = peaks + (size_t)k * ASJ_LANES;
        const int16_t *partners = from + (size_t)((k + field->apart) % count) * ASJ_LANES;
        for (int i = 0; i < ASJ_LANES; i++)
            found[i] |= peak[i] & partners[i];
    }
    uint32_t mask = 0;
    for (int i = 0; i < ASJ_LANES; i++)
        mask |= (found[i] ? 1u : 0u) << i;
    return mask;
}

void asj_field_thin(const asj_field *field, const asj_frame *frame, int32_t run, int32_t runs, uint16_t *masks)
{
    const uint32_t columns = field->step > 1 ? 0x5555 : 0xffff;
    for (int32_t b = 0; b < runs; b++) {
        const int32_t inside = frame->width - (run + b) * ASJ_LANES;
        if (inside < ASJ_LANES)
            masks[b] = (uint16_t)(inside > 0 ? masks[b] & ((1u << inside) - 1) : 0);
        masks[b] = (uint16_t)(masks[b] & columns);
    }
}

void asj_field_tile(const asj_field *field, const asj_frame *frame, const asj_tile *tile, uint16_t *scratch, uint16_t *masks)
{
    for (int32_t y = tile->top; y < tile->bottom; y++) {
        uint16_t *row = masks + (ptrdiff_t)y * frame->blocks + tile->run;
        for (int32_t b = 0; b < tile->runs; b++)
            row[b] = asj_field_has_candidates(field, y)
                         ? (uint16_t)asj_field_candidates(field, frame, (tile->run + b) * ASJ_LANES, y, scratch)
                         : 0;
        asj_field_thin(field, frame, tile->run, tile->runs, row);
    }
}

typedef struct job {
    asj_context *context;
    const asj_field *field;
    const asj_frame *frame;
    int32_t top, bottom, per_tile, across; /* `across` tiles beside each other */
    const asj_scratch *scratch;
    uint16_t *masks;
} job;

static void do_tiles(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t i = part->first; i < part->end; i++) {
        const int32_t run = (int32_t)(i % j->across) * j->per_tile, left = j->frame->blocks - run;
        const int32_t top = j->top + (int32_t)(i / j->across) * BAND, below = j->bottom - top;
        const asj_tile tile = {run, left < j->per_tile ? left : j->per_tile, top, top + (below < BAND ? below : BAND)};
        j->context->ops->field->tile(j->field, j->frame, &tile, asj_thread_scratch(j->scratch, part), j->masks);
    }
}

asj_status asj_field_rows(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                          const asj_scratch *scratch, uint16_t *masks)
{
    const int32_t threads = asj_threads_for(context, (int64_t)frame->blocks * (bottom - top), LEAST_RUNS);
    const int32_t bands = (bottom - top + BAND - 1) / BAND, largest = field->step * ASJ_FIELD_TILE / ASJ_LANES;
    /* tiles are half as wide where there are so few that threads would wait for the last one */
    const int32_t many = 8 * threads * largest;
    const int32_t per_tile = threads == 1 || frame->blocks * bands >= many ? largest : largest / 2;
    const int32_t across = (frame->blocks + per_tile - 1) / per_tile;
    const job j = {context, field, frame, top, bottom, per_tile, across, scratch, masks};
    asj_parallel(context, threads, (int64_t)across * bands, 1, do_tiles, &j);
    return ASJ_OK;
}

typedef struct branches_job {
    asj_context *context;
    const asj_field *field;
    const asj_frame *frame;
    int32_t top;
    const asj_scratch *scratch;
    asj_field_branch (*branches)[ASJ_FIELD_BRANCHES];
} branches_job;

static void find_branches(const void *data, const asj_part *part)
{
    enum { AT_ONCE = 2 * ASJ_FIELD_BATCH };
    const branches_job *j = data;
    const int32_t width = j->frame->width;
    asj_pixel pixels[AT_ONCE];
    for (int64_t row = part->first; row < part->end; row++)
        for (int32_t first = 0; first < width; first += AT_ONCE) {
            const int32_t count = width - first < AT_ONCE ? width - first : AT_ONCE;
            for (int32_t i = 0; i < count; i++)
                pixels[i] = (asj_pixel){first + i, j->top + (int32_t)row};
            j->context->ops->field->pixels(j->field, j->frame, pixels, count, asj_thread_scratch(j->scratch, part),
                                           j->branches + (size_t)row * (size_t)width + first);
        }
}

asj_status asj_field_branches(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                              const asj_scratch *scratch, asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    const branches_job j = {context, field, frame, top, scratch, branches};
    asj_parallel(context, context->threads, bottom - top, 4, find_branches, &j);
    return ASJ_OK;
}

const asj_field_ops asj_field_reference = {
    .rows = asj_field_rows, .branches = asj_field_branches, .tile = asj_field_tile, .pixels = asj_field_pixels};
