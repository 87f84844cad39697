/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, which patches are worth a comparison. Of all pairs few get on a short list, and a bound of the product tells most of the
 * others at an eighth of the work.
 *
 * With B the lowest frequencies of the cosine transform as rows, <f, g> = <B f, B g> + <f, (1 - B'B) g>. Rows are a little shorter
 * than unit vectors, so that 1 - B'B has no negative eigenvalue although the rows are rounded; then the last term is at most
 * sqrt(<f, (1 - B'B) f> <g, (1 - B'B) g>) (Cauchy and Schwarz), and <f, (1 - B'B) f> = |f|^2 - |B f|^2:
 *
 *     <f, g> <= <B f, B g> + r_f r_g,     r_f = sqrt(|f|^2 - |B f|^2),
 *
 * which is one product of vectors with one more number. Another pair of numbers makes up for what rounding B f loses. */
#include "product_bound.h"
#include "describe.h"
#include "core/threads.h"

#include <math.h>
#include <string.h>

#define TERMS (ASJ_BOUND_LENGTH - 2)
#define FREQUENCIES 8 /* of those terms: 0 .. 7 */
#define ROW 0.995 /* length of a row: rounding adds at most sqrt(TERMS ASJ_PATCH_SAMPLES) / 2 / ASJ_UNIT_ONE = 0.004 */
/* Rounding B f and B g to whole numbers costs sqrt(TERMS) / 2 (|f| + |g|) + TERMS / 4 at most: 5.5 ASJ_UNIT_ONE. */
#define SLACK_LEFT ASJ_UNIT_ONE
#define SLACK_RIGHT 7

/* The rows of B, those of the least sum of both frequencies, without the constant. */
static void fill_rows(int32_t size, int16_t *rows)
{
    const double pi = 3.14159265358979323846;
    double wave[FREQUENCIES][ASJ_PATCH_SIDE];
    int32_t term = 0;
    for (int32_t u = 0; u < FREQUENCIES; u++)
        for (int32_t x = 0; x < size; x++)
            wave[u][x] = cos(pi * (x + 0.5) * u / size);
    for (int32_t sum = 1; term < TERMS; sum++)
        for (int32_t u = 0; u <= sum && term < TERMS; u++, term++) {
            const int32_t v = sum - u;
            const double scale = ROW * ASJ_UNIT_ONE / size * (u > 0 && v > 0 ? 2 : sqrt(2.0));
            for (int32_t y = 0; y < size; y++)
                for (int32_t x = 0; x < size; x++)
                    *rows++ = (int16_t)lrint(scale * wave[u][x] * wave[v][y]);
        }
}

/* All numbers but the slack. */
static void fill_vector(const asj_patch_ops *ops, const int16_t *patch, const int16_t *rows, int32_t length, int16_t *numbers)
{
    const double one = (double)ASJ_UNIT_ONE * ASJ_UNIT_ONE;
    int32_t every[TERMS], product[TERMS];
    double rest = asj_patch_product(patch, patch, length);
    for (int32_t k = 0; k < TERMS; k++)
        every[k] = k;
    ops->products(patch, rows, length, every, TERMS, product);
    for (int32_t k = 0; k < TERMS; k++) {
        numbers[k] = (int16_t)((product[k] + ASJ_UNIT_ONE / 2) >> 14);
        rest -= (double)product[k] * product[k] / one;
    }
    numbers[TERMS] = (int16_t)ceil(sqrt(rest > 0 ? rest : 0));
}

typedef struct job {
    const asj_patch_ops *ops;
    const asj_image_features *features;
    const int16_t *rows;
    int32_t length;
    int16_t slack, *all;
} job;

static void fill_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t f = part->first; f < part->end; f++) {
        int16_t *vector = j->all + f * ASJ_BOUND_LENGTH;
        fill_vector(j->ops, asj_patch_at(j->features, (uint32_t)f, j->length), j->rows, j->length, vector);
        vector[ASJ_BOUND_LENGTH - 1] = j->slack;
    }
}

/* Bound vectors of all frames, one after the other; the slack of either side. */
static asj_status fill_all(asj_context *context, const asj_match_options *options, const asj_image_features *features,
                           int16_t slack, int16_t **vectors)
{
    const int32_t length = asj_patch_length(options);
    const int64_t count = features->l_junctions.frame_count;
    int16_t *rows = asj_allocate(&context->memory, TERMS * (size_t)length, sizeof *rows);
    int16_t *all = asj_allocate(&context->memory, (size_t)count, ASJ_BOUND_LENGTH * sizeof *all);
    *vectors = all;
    if (!rows || !all) {
        asj_release(&context->memory, rows);
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the bound vectors of %lld patches", (long long)count);
    }
    fill_rows(options->patch_size, rows);
    const job j = {context->ops->patch, features, rows, length, slack, all};
    asj_parallel(context, context->threads, count, 0, fill_some, &j);
    asj_release(&context->memory, rows);
    return ASJ_OK;
}

asj_status asj_bound_left(asj_context *context, const asj_match_options *options, const asj_image_features *features,
                          int16_t **vectors)
{
    return fill_all(context, options, features, SLACK_LEFT, vectors);
}

int32_t asj_bound_blocks(uint32_t frames)
{
    return (int32_t)((frames + ASJ_BOUND_LANES - 1) / ASJ_BOUND_LANES);
}

asj_status asj_bound_right(asj_context *context, const asj_match_options *options, const asj_image_features *features,
                           int16_t **vectors)
{
    const uint32_t count = features->l_junctions.frame_count;
    int16_t *plain, *laned = asj_allocate_zero(&context->memory, (size_t)asj_bound_blocks(count),
                                               ASJ_BOUND_LENGTH * ASJ_BOUND_LANES * sizeof *laned);
    *vectors = laned;
    if (!laned)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the bound vectors of %u patches", (unsigned)count);
    const asj_status status = fill_all(context, options, features, SLACK_RIGHT, &plain);
    for (uint32_t f = 0; f < count && status == ASJ_OK; f++) {
        int16_t *block = laned + (size_t)(f / ASJ_BOUND_LANES) * ASJ_BOUND_LENGTH * ASJ_BOUND_LANES + f % ASJ_BOUND_LANES * 2;
        for (uint32_t k = 0; k < ASJ_BOUND_LENGTH; k++)
            block[k / 2 * 2 * ASJ_BOUND_LANES + k % 2] = plain[(size_t)f * ASJ_BOUND_LENGTH + k];
    }
    asj_release(&context->memory, plain);
    return status;
}

int32_t asj_bound_above(const int16_t *left, const int16_t *right, const int32_t *least, int32_t most, int32_t first, int32_t end,
                        const uint32_t *among, int32_t *which)
{
    int32_t count = 0;
    for (int32_t start = first - first % ASJ_BOUND_LANES; start < end; start += ASJ_BOUND_LANES) {
        const int16_t *r = right + (ptrdiff_t)start * ASJ_BOUND_LENGTH;
        int32_t bound[ASJ_BOUND_LANES] = {0};
        for (int32_t k = 0; k < ASJ_BOUND_LENGTH; k += 2, r += 2 * ASJ_BOUND_LANES)
            for (int32_t n = 0; n < ASJ_BOUND_LANES; n++)
                bound[n] += left[k] * r[2 * n] + left[k + 1] * r[2 * n + 1];
        for (int32_t n = 0; n < ASJ_BOUND_LANES; n++) {
            const int32_t g = start + n;
            if (bound[n] > (least[g] < most ? least[g] : most) && g >= first && g < end &&
                (!among || asj_bound_is_among(among, first, g)))
                which[count++] = g;
        }
    }
    return count;
}

const asj_bound_ops asj_bound_reference = {.above = asj_bound_above};
