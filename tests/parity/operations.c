/* SPDX-License-Identifier: BSD-2-Clause */
#include "operations.h"
#include "detect/gradient.h"
#include "more_operations.h"

#include <math.h>
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
    asj_field all = s->field;
    all.step = 1;
    for (int32_t y = top; y < bottom; y++) {
        uint16_t *row = masks + (ptrdiff_t)y * s->frame.blocks;
        for (int32_t b = 0; b < s->frame.blocks; b++)
            row[b] = synth_random_unit(&random) < 0.4 ? (uint16_t)(synth_random_bits(&random) & synth_random_bits(&random)) : 0;
        asj_field_thin(&all, &s->frame, 0, s->frame.blocks, row);
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

static asj_status run_band(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    uint16_t *masks = calloc((size_t)s->frame.blocks * (size_t)s->frame.height, sizeof *masks);
    int32_t x, y;
    choose(s, &x, &y);
    const int32_t bottom = y + BAND < s->frame.height ? y + BAND : s->frame.height;
    if (!masks)
        abort();
    choose_candidates(s, y, bottom, masks);
    context->ops->isotropic->band(&s->isotropic, &s->frame, y, bottom, masks, scratch, output);
    free(masks);
    return ASJ_OK;
}

enum { MOST_PIXELS = 100 };

/* Not a whole number of vectors, mostly. */
static int32_t pixel_count(const subject *s)
{
    synth_random random = s->random;
    return 1 + (int32_t)(synth_random_unit(&random) * MOST_PIXELS);
}

static double some_pixels(const subject *s)
{
    return pixel_count(s);
}

static size_t pixels_size(const subject *s)
{
    return (size_t)pixel_count(s) * ASJ_FIELD_BRANCHES * sizeof(asj_field_branch);
}

/* From anywhere, corners and neighbours among them. */
static asj_status run_pixels(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    synth_random random = s->random;
    asj_pixel pixels[MOST_PIXELS];
    const int32_t count = pixel_count(s), right = s->frame.width - 1, bottom = s->frame.height - 1;
    for (int32_t i = 0; i < count; i++) {
        const int32_t x = (int32_t)(synth_random_unit(&random) * s->frame.width);
        pixels[i] = (asj_pixel){x, (int32_t)(synth_random_unit(&random) * s->frame.height)};
        if (i % 8 == 7)
            pixels[i] = (asj_pixel){i & 8 ? right : 0, i & 16 ? bottom : 0};
        else if (i % 3 == 2)
            pixels[i] = (asj_pixel){pixels[i - 1].x < right ? pixels[i - 1].x + 1 : 0, pixels[i - 1].y};
    }
    context->ops->field->pixels(&s->field, &s->frame, pixels, count, scratch, output);
    return ASJ_OK;
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
static asj_status run_tiles(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    const int32_t per_tile = ASJ_FIELD_TILE / ASJ_LANES, blocks = s->frame.blocks;
    int32_t x, top;
    choose(s, &x, &top);
    top /= 2;
    for (int32_t run = 0; run < blocks; run += per_tile) {
        const asj_tile tile = {run, blocks - run < per_tile ? blocks - run : per_tile, top, s->frame.height};
        context->ops->field->tile(&s->field, &s->frame, &tile, scratch, output);
    }
    return ASJ_OK;
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

/* Two planes of gradients. */
static double gradient_bytes(const subject *s)
{
    return 4 * all_pixels(s);
}

/* And the gray plane. */
static double step_1_bytes(const subject *s)
{
    return 6 * all_pixels(s);
}

static asj_status run_gradient(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    (void)scratch;
    for (int32_t y = 0; y < s->picture->height; y++)
        for (int32_t x = 0; x < s->picture->width; x++) { /* nothing that an earlier run has left */
            s->picture->gradient_x[y * s->picture->stride + x] = 12345;
            s->picture->gradient_y[y * s->picture->stride + x] = -12345;
        }
    asj_status status = context->ops->gradient->planes(context, s->picture, &s->options);
    memcpy(output, s->picture->memory, planes_size(s));
    asj_release(&context->memory, s->picture->rows); /* this context's, which the frame would keep */
    s->picture->rows = NULL;
    s->picture->row_capacity = 0;
    return status;
}

/* Rows from `top` on; those above must stay as they are. */
static asj_status run_field_rows(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    int32_t x, top;
    choose(s, &x, &top);
    const asj_scratch whole = {scratch, s->scratch_size};
    return context->ops->field->rows(context, &s->field, &s->frame, top / 2, s->frame.height, &whole, output);
}

static size_t branches_size(const subject *s)
{
    return (size_t)s->frame.width * (size_t)s->frame.height * ASJ_FIELD_BRANCHES * sizeof(asj_field_branch);
}

/* Rows from `top` on. */
static asj_status run_branches(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    int32_t x, top;
    choose(s, &x, &top);
    const asj_scratch whole = {scratch, s->scratch_size};
    return context->ops->field->branches(context, &s->field, &s->frame, top / 2, s->frame.height, &whole, output);
}

static size_t records_size(const subject *s)
{
    return (size_t)s->frame.width * (size_t)s->frame.height * sizeof(asj_isotropic_junction);
}

static asj_status run_isotropic_rows(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    const size_t runs = (size_t)s->frame.blocks * (size_t)s->frame.height, rows = (size_t)s->frame.height;
    uint16_t *masks = calloc(runs, sizeof *masks);
    size_t *starts = calloc(rows + 1, sizeof *starts);
    asj_status status = ASJ_ERROR_MEMORY;
    if (masks && starts) {
        choose_candidates(s, s->frame.height / 3, s->frame.height, masks);
        for (size_t i = 0; i < runs; i++) {
            const size_t y = i / (size_t)s->frame.blocks;
            starts[y + 1] = i % (size_t)s->frame.blocks ? starts[y + 1] : starts[y];
            for (uint32_t bits = masks[i]; bits; bits &= bits - 1)
                starts[y + 1]++;
        }
        const asj_candidate_rows candidates = {0, s->frame.height, masks, starts};
        const asj_scratch whole = {scratch, s->scratch_size};
        status = context->ops->isotropic->rows(context, &s->isotropic, &s->frame, &candidates, &whole, output);
    }
    free(starts);
    free(masks);
    return status;
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

static asj_status run_luma(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    (void)scratch;
    for (int32_t i = 0; i < 4; i++)
        context->ops->image->luma(s->colours, s->frame.width, 3 + i / 2, i % 2 * 2, (uint16_t *)output + i * s->frame.width);
    return ASJ_OK;
}

/* A line that starts anywhere, up to 10 px outside too. */
static double choose_line(const subject *s, synth_random *random, double *x, double *y, double *length)
{
    *x = synth_random_unit(random) * (s->picture->width + 20) - 10;
    *y = synth_random_unit(random) * (s->picture->height + 20) - 10;
    *length = 3 + 90 * synth_random_unit(random) * synth_random_unit(random);
    return 6.2831853 * synth_random_unit(random);
}

enum {
    EDGE_ROOM = 96 + ASJ_EDGE_BATCH, /* rows */
    EDGE_REACH = ASJ_GRAY_BORDER - 2 /* px that samples are from the middle of their row at most */
};

static size_t line_sums_size(const subject *s)
{
    (void)s;
    return 2 * sizeof(asj_line_sums);
}

static asj_status run_line_sums(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    synth_random random = s->random;
    asj_line_band band;
    double x, y, length;
    const double angle = choose_line(s, &random, &x, &y, &length), half_width = synth_random_between(&random, 0.5, 5);
    (void)scratch;
    const asj_line_box box = {x, y, cos(angle), sin(angle), 0.5 * length, half_width};
    asj_line_band_set(s->picture, &box, &band);
    context->ops->line->sums(s->picture, &band, output);
    return ASJ_OK;
}

static size_t line_profile_size(const subject *s)
{
    (void)s;
    return sizeof(asj_profile_sums);
}

static asj_status run_line_profile(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    synth_random random = s->random;
    asj_line_profile profile = {0};
    asj_profile_sums *sums = output;
    double x, y, length;
    const double angle = choose_line(s, &random, &x, &y, &length);
    (void)scratch;
    profile.ux = (float)cos(angle);
    profile.uy = (float)sin(angle);
    profile.x = (int32_t)floor(x);
    profile.y = (int32_t)floor(y);
    profile.origin_x = (float)(x - profile.x);
    profile.origin_y = (float)(y - profile.y);
    profile.first = 2;
    profile.step = (float)(1 + synth_random_unit(&random));
    profile.a = (float)synth_random_unit(&random);
    profile.b = 0.1f;
    profile.count = (int32_t)length;
    profile.offsets = 5;
    for (int32_t i = 0; i < profile.offsets; i++)
        profile.offset[i] = 0.8f * (float)(i - 2);
    context->ops->line->profile(s->picture, &profile, sums);
    for (int32_t side = 0; side < 2; side++)
        for (int32_t k = profile.count; k < ASJ_PROFILE_SAMPLES; k++)
            sums->w[side][k] = sums->moment[side][k] = 0;
    return ASJ_OK;
}

static size_t strip_size(const subject *s)
{
    (void)s;
    return sizeof(asj_strip);
}

/* In any direction, in and around the image, of any width and length. */
static asj_status run_strip(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    synth_random random = s->random;
    asj_detect_options options = s->options;
    double x, y, length;
    const double angle = choose_line(s, &random, &x, &y, &length);
    (void)scratch;
    options.strip_half_width = synth_random_between(&random, 0.5, 4);
    const asj_strip_line line = {x, y, angle, length};
    const asj_strip strip = asj_strip_test(context, &s->frame, &options, &line);
    memcpy(output, &strip, sizeof strip);
    return ASJ_OK;
}

static size_t edge_rows_size(const subject *s)
{
    (void)s;
    return sizeof(int32_t) + ASJ_EDGE_SAMPLES * EDGE_ROOM * sizeof(int32_t);
}

/* In any direction, in and around the image: how many there are, and their levels. What a form leaves behind them means nothing. */
static asj_status run_edge_rows(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    synth_random random = s->random;
    double x, y, length;
    const double angle = choose_line(s, &random, &x, &y, &length);
    const int32_t step = 1 + (int32_t)(3 * synth_random_unit(&random)), count = (int32_t)length;
    const double offset = synth_random_between(&random, ASJ_EDGE_HALF - EDGE_REACH, EDGE_REACH - ASJ_EDGE_HALF);
    const asj_edge_line line = {s->picture, x, y, cos(angle), sin(angle), offset};
    int32_t *rows = output, *levels = rows + 1;
    (void)scratch;
    *rows = context->ops->edge->rows(&line, 0, step, count, levels, EDGE_ROOM);
    for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++)
        memset(levels + i * EDGE_ROOM + *rows, 0, (size_t)(EDGE_ROOM - *rows) * sizeof *levels);
    return ASJ_OK;
}

static size_t edge_fan_size(const subject *s)
{
    (void)s;
    return ASJ_FAN_RAYS * sizeof(double);
}

/* Any number of rays in any direction, from in and around the image. */
static asj_status run_edge_fan(asj_context *context, const subject *s, uint16_t *scratch, void *output)
{
    synth_random random = s->random;
    double x, y, length, *means = output;
    const double angle = choose_line(s, &random, &x, &y, &length);
    asj_edge_fan fan = {.count = 1 + (int32_t)(ASJ_FAN_RAYS * synth_random_unit(&random))};
    (void)scratch;
    for (int32_t i = 0; i < fan.count; i++) {
        fan.ux[i] = cos(angle + 0.3 * i);
        fan.uy[i] = sin(angle + 0.3 * i);
    }
    context->ops->edge->fan(&s->frame, &fan, x, y, means);
    memset(means + fan.count, 0, (size_t)(ASJ_FAN_RAYS - fan.count) * sizeof *means);
    return ASJ_OK;
}

static double one_line(const subject *s)
{
    return s->frame.width;
}

const operation operations[] = {
    {"luma", 0, luma_size, luma_pixels, NULL, run_luma},
    {"gradient", 1, planes_size, all_pixels, step_1_bytes, run_gradient},
    {"field pixels", 0, pixels_size, some_pixels, NULL, run_pixels},
    {"isotropic band", 0, band_size, band_pixels, NULL, run_band},
    {"line sums", 0, line_sums_size, one_run, NULL, run_line_sums},
    {"line profile", 0, line_profile_size, one_run, NULL, run_line_profile},
    {"strip", 0, strip_size, one_run, NULL, run_strip},
    {"wedge", 0, wedge_size, one_run, NULL, run_wedge},
    {"edge rows", 0, edge_rows_size, one_run, NULL, run_edge_rows},
    {"edge fan", 0, edge_fan_size, one_run, NULL, run_edge_fan},
    {"blur row", 0, blur_size, one_line, NULL, run_blur},
    {"pyramid samples", 0, samples_size, one_run, NULL, run_samples},
    {"discs", 0, discs_size, one_run, NULL, run_discs},
    {"patch products", 0, products_size, one_run, NULL, run_products},
    {"bounds", 0, bounds_size, one_run, NULL, run_bounds},
    {"gate", 0, gate_size, one_run, NULL, run_gate},
    {"near", 0, near_size, one_run, NULL, run_near},
    {"ratio", 0, ratio_size, one_run, NULL, run_ratio},
    {"field tile", 0, tile_size, tile_pixels, NULL, run_tiles},
    {"field rows", 1, tile_size, tile_pixels, gradient_bytes, run_field_rows},
    {"branches", 1, branches_size, tile_pixels, NULL, run_branches},
    {"isotropic rows", 1, records_size, all_pixels, gradient_bytes, run_isotropic_rows},
    {"rays", 1, rays_size, all_pixels, NULL, run_rays},
    {"patches", 1, patches_size, all_pixels, patches_bytes, run_patches},
    {"partners", 1, partners_size, all_pixels, NULL, run_partners},
};
const size_t operation_count = sizeof operations / sizeof operations[0];
