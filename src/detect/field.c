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
 * every other row is enough (candidate_step = 1 takes them all), for half the time up to the fits. Corners so weak that few
 * of their pixels reach candidate_strength are not found then; a little less of that (2.4 instead of 3) brings most of them back.
 * And which of the junctions of a crowded place are found hangs on which pixels were asked: with one more column at the left, in 32
 * photographs, 240 of 2188 junctions with a log10 NFA below -10 have none within 4 px (with candidate_step 1 89 of 2459, and 5 of
 * 2673 with one octave). Under a change of scale both repeat alike (tests/accuracy/tried/detection.md). */
#include "field.h"
#include "nfa.h"
#include "core/angle.h"

#include <math.h>
#include <string.h>

/* rad (20 degrees), in whole sectors: of the 43 of the default radius 3 at least from each other, 25 degrees, and 3.5 from being
 * opposite, 29. Larger loses corners that open little, smaller takes the two sectors along a thick or bent edge for two
 * branches. */
#define APART 0.35

/* The least sum with ln F <= log_p, in units of gamma; 65535 when that is none of a sector's. */
static uint16_t least_sum(const asj_sectors *s, int32_t pixels, double log_p)
{
    int32_t low = 0, high = 65535;
    while (low < high) {
        const int32_t middle = (low + high) / 2;
        if (asj_nfa_log_sector_tail(asj_nfa_tables(), (double)middle / (1 << s->gamma_bits), pixels) <= log_p)
            high = middle;
        else
            low = middle + 1;
    }
    return (uint16_t)low;
}

/* Sectors of as many pixels have the same one. */
static uint16_t strength_of_tail(const asj_sectors *s, int32_t k, double log_p, const uint16_t *before)
{
    for (int32_t i = 0; i < k; i++)
        if (s->size[i] == s->size[k])
            return before[i];
    const uint16_t strength = asj_sector_strength(s, k, least_sum(s, s->size[k], log_p));
    return strength > 0 ? strength : 1;
}

static void set_limits(asj_field *field)
{
    const asj_sectors *s = &field->sectors;
    for (int32_t k = 0; k < s->count; k++) {
        field->angle[k] = 65536 * k / s->count;
        const int32_t limits[4] = {s->mean[k], s->scale[k], field->keep[k] - 1, field->candidate[k] - 1};
        for (int32_t i = 0; i < 4; i++)
            field->limits[k][i] = asj_sector_twice(limits[i]);
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
    asj_sector_plan_set_steps(s, field->place, &field->plan);
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

/* For one pixel: gamma in runs, prefix sums, strengths. For pixels in vectors, which need more than that: gamma in runs, slots,
 * strengths of as many as there are lanes. For a tile in vectors, which needs more than the reference: a ring of gamma planes, a
 * row of the gradient, slots, strengths. */
size_t asj_field_scratch(const asj_field *field)
{
    const size_t count = (size_t)field->sectors.count, depth = 2 * (size_t)field->sectors.radius + 1;
    const size_t stride = asj_field_plane_stride(field), step = (size_t)field->step;
    const size_t ring = depth * 4 * (size_t)field->plan.family_count * stride * step;
    const size_t lists = (size_t)field->plan.slot_count + count + 2 * (size_t)field->suppress;
    const size_t tile = ring + 2 * stride * step + lists * ASJ_FIELD_TILE;
    const size_t pixels = ((size_t)field->runs.count * ASJ_SECTOR_RUN + lists) * ASJ_FIELD_BATCH;
    return ((tile > pixels ? tile : pixels) + 31) / 32 * 32;
}

/* Strengths of all sectors at a pixel, in the scratch. */
static const uint16_t *find_strengths(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, uint16_t *scratch)
{
    const asj_sectors *s = &field->sectors;
    const ptrdiff_t at = y * frame->stride + x;
    uint16_t *gamma = scratch, *prefix = gamma + field->runs.count * ASJ_SECTOR_RUN, *z = prefix + s->offset_count + 1;
    asj_sector_gammas(&field->runs, frame->gradient_x + at, frame->gradient_y + at, frame->stride, gamma);
    asj_sector_sums(s, field->place, gamma, prefix, z);
    for (int32_t k = 0; k < s->count; k++)
        z[k] = asj_sector_strength(s, k, z[k]);
    return z;
}

/* Whether sector k is the largest of its neighbourhood. Of equal neighbours the first one counts. */
static int is_largest(const asj_field *field, const uint16_t *z, int32_t k)
{
    const int32_t count = field->sectors.count;
    for (int32_t d = 1; d <= field->suppress; d++) {
        const int32_t left = k >= d ? k - d : k - d + count, right = k + d < count ? k + d : k + d - count;
        if (z[left] >= z[k] || z[right] > z[k])
            return 0;
    }
    return 1;
}

/* The sectors that reach `least` and are the largest of their neighbourhoods, in order. Returns how many there are. */
static int32_t find_peaks(const asj_field *field, const uint16_t *z, const uint16_t *least, int32_t peaks[ASJ_FIELD_MAX_SECTORS])
{
    int32_t found = 0;
    for (int32_t k = 0; k < field->sectors.count; k++)
        if (z[k] >= least[k] && is_largest(field, z, k))
            peaks[found++] = k;
    return found;
}

void asj_field_pixel(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, uint16_t *scratch,
                     asj_field_branch branches[ASJ_FIELD_BRANCHES])
{
    const int32_t count = field->sectors.count;
    const uint16_t *z = find_strengths(field, frame, x, y, scratch);
    int32_t peaks[ASJ_FIELD_MAX_SECTORS];
    const int32_t found = find_peaks(field, z, field->keep, peaks);
    memset(branches, 0, ASJ_FIELD_BRANCHES * sizeof *branches);
    for (int32_t i = 0; i < found; i++) {
        const int32_t k = peaks[i], before = z[k > 0 ? k - 1 : count - 1], after = z[k + 1 < count ? k + 1 : 0];
        const int32_t angle = field->angle[k] + asj_field_shift(65536 / count, before, z[k], after);
        asj_field_insert(branches, (asj_field_branch){(uint16_t)angle, z[k]});
    }
}

void asj_field_pixels(const asj_field *field, const asj_frame *frame, const asj_pixel *pixels, int32_t count, uint16_t *scratch,
                      asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    for (int32_t i = 0; i < count; i++)
        asj_field_pixel(field, frame, pixels[i].x, pixels[i].y, scratch, branches[i]);
}

int asj_field_is_candidate(const asj_field *field, const uint16_t *z)
{
    const int32_t count = field->sectors.count;
    int32_t peaks[ASJ_FIELD_MAX_SECTORS];
    const int32_t found = find_peaks(field, z, field->candidate, peaks);
    for (int32_t i = 0; i < found; i++)
        for (int32_t j = i + 1; j < found; j++) {
            const int32_t ahead = peaks[j] - peaks[i], opening = ahead < count - ahead ? ahead : count - ahead;
            if (opening >= field->apart && opening <= count / 2 - field->apart)
                return 1;
        }
    return 0;
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
