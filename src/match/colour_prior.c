/* SPDX-License-Identifier: BSD-2-Clause */
/* Colours of the same corner in two images.
 *
 * A right map takes branch a to branch a, so the regions of colour.c correspond. Of each the chroma is compared, in logarithms,
 *
 *     c = (log (R + DARK)/(G + DARK), log (B + DARK)/(G + DARK)),
 *
 * which exposure does not change, nor does a shadow. Another white balance, or another lamp, adds the same to all: the median of
 * the differences, each weighed by how probable its candidate is, is taken away from them. With D the mean over the regions that
 * both images show of what is left, |c2 - c1 - median|, the agreement is
 *
 *     mean of log(D + NOISE) over all candidates - log(D + NOISE):
 *
 * 0 for what is as far apart as colours of this pair usually are, so that images without much colour say little. */
#include "colour_prior.h"

#include <math.h>
#include <string.h>

#define DARK 4.0       /* grey levels: noise of what is nearly black */
#define NOISE 0.05
#define LEAST_REGIONS 2
#define BINS 4096      /* of the differences, on .. */
#define WIDTH 3.0      /* .. [-WIDTH, WIDTH] */
#define LEVEL_ONE 128

typedef struct chroma {
    double value[ASJ_COLOUR_REGIONS][2];
    int32_t seen[ASJ_COLOUR_REGIONS];
} chroma;

static chroma *chromas_of(asj_memory *memory, const asj_image_features *image)
{
    const uint32_t count = image->l_junctions.count;
    chroma *list = asj_allocate(memory, count, sizeof *list);
    for (uint32_t n = 0; list && n < count; n++)
        for (int32_t r = 0; r < ASJ_COLOUR_REGIONS; r++) {
            const uint16_t *level = image->colours[n].level[r];
            const double green = log((double)level[1] / LEVEL_ONE + DARK);
            list[n].seen[r] = level[0] + level[1] + level[2] > 0;
            list[n].value[r][0] = log((double)level[0] / LEVEL_ONE + DARK) - green;
            list[n].value[r][1] = log((double)level[2] / LEVEL_ONE + DARK) - green;
        }
    return list;
}

/* What both images see around a candidate. */
typedef struct comparison {
    const chroma *in1, *in2;
} comparison;

static int32_t is_common(const comparison *c, int32_t region)
{
    return c->in1->seen[region] && c->in2->seen[region];
}

/* The weighted median of the differences of one channel, to a bin's middle. */
static double median_difference(const asj_match_run *run, const chroma *const lists[2], const double *probability, int32_t channel,
                                double *bins)
{
    double all = 0, sum = 0;
    int32_t bin = 0;
    memset(bins, 0, BINS * sizeof *bins);
    for (size_t k = 0; k < run->candidates.count; k++) {
        const asj_candidate *candidate = &run->candidates.list[k];
        const comparison c = {&lists[0][candidate->i], &lists[1][candidate->j]};
        for (int32_t r = 0; r < ASJ_COLOUR_REGIONS; r++) {
            const double difference = c.in2->value[r][channel] - c.in1->value[r][channel];
            if (!is_common(&c, r) || !(fabs(difference) < WIDTH))
                continue;
            const int32_t at = (int32_t)((difference + WIDTH) / (2 * WIDTH) * BINS);
            bins[at < BINS ? at : BINS - 1] += probability[k]; /* rounding */
            all += probability[k];
        }
    }
    while (bin < BINS - 1 && (sum += bins[bin]) < 0.5 * all)
        bin++;
    return all > 0 ? (bin + 0.5) / BINS * 2 * WIDTH - WIDTH : 0;
}

/* log(D + NOISE); HUGE_VAL when too little is seen. */
static double log_distance(const comparison *c, const double offset[2])
{
    double sum = 0;
    int32_t count = 0;
    for (int32_t r = 0; r < ASJ_COLOUR_REGIONS; r++)
        if (is_common(c, r)) {
            const double p = c->in2->value[r][0] - c->in1->value[r][0] - offset[0];
            const double q = c->in2->value[r][1] - c->in1->value[r][1] - offset[1];
            sum += sqrt(p * p + q * q);
            count++;
        }
    return count < LEAST_REGIONS ? HUGE_VAL : log(sum / count + NOISE);
}

static void compare(const asj_match_run *run, const chroma *const lists[2], const double *probability, double *bins,
                    double *agreement)
{
    const double offset[2] = {median_difference(run, lists, probability, 0, bins),
                              median_difference(run, lists, probability, 1, bins)};
    double sum = 0;
    size_t seen = 0;
    for (size_t k = 0; k < run->candidates.count; k++) {
        const comparison c = {&lists[0][run->candidates.list[k].i], &lists[1][run->candidates.list[k].j]};
        agreement[k] = log_distance(&c, offset);
        sum += agreement[k] < HUGE_VAL ? agreement[k] : 0;
        seen += agreement[k] < HUGE_VAL;
    }
    for (size_t k = 0; k < run->candidates.count; k++)
        agreement[k] = agreement[k] < HUGE_VAL ? sum / (double)seen - agreement[k] : 0;
}

asj_status asj_colour_agreement(const asj_match_run *run, const double *probability, double *agreement)
{
    asj_memory *memory = &run->context->memory;
    chroma *lists[2] = {chromas_of(memory, run->image[0]), chromas_of(memory, run->image[1])};
    double *bins = asj_allocate(memory, BINS, sizeof *bins);
    const int32_t good = lists[0] && lists[1] && bins;
    if (good)
        compare(run, (const chroma *const[]){lists[0], lists[1]}, probability, bins, agreement);
    asj_release(memory, bins);
    asj_release(memory, lists[0]);
    asj_release(memory, lists[1]);
    return good ? ASJ_OK : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for colours");
}
