/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3: isotropic junctions (the ACJ test, paper section "Detecting Junction Locations and Isotropic Branches").
 *
 * At a candidate pixel and a radius r: strengths of all sectors, circular non-maximum suppression, branches in order of omega. The
 * M strongest form a junction of junction-ness t = min omega (eq. junction-ness-entire), whose number of false alarms is
 *     NFA = #J(M) prod_{i=1..M} F(t; J_i)       M = 2 .. 5
 * (F: eq. acj-distribution-conv, an upper tail; #J(M): nfa.c). The best radius and M with NFA <= epsilon stay.
 * Two branches that open by more than pi - 2 Delta are an edge, not a junction.
 *
 * Departures of the default: candidates come from the local field (field.c); `seeds` = segments takes those of line segments
 * (seeds.c). Radii {7, 14} instead of all: the same junctions at less than half the cost (5 finds nothing that 7 does not, 10
 * hardly anything). Branches may be as near as Delta; `disjoint_sectors` asks for 2 Delta, which is what #J(M) counts: of K
 * orientations each branch leaves 4 Delta K / 2 pi to no other. So by default #J(M) is short of what is tested, 5.3 times for M = 5
 * at radius 7 (each branch leaving 2 Delta), and each M has the whole epsilon: here it is no bound. What the steps that follow
 * validate keeps to epsilon (tests/accuracy, "Noise"). Among overlapping junctions the more meaningful one stays, and with
 * `more_branches_win` the one with more branches (isotropic_thin.c).
 *
 * `all_meaningful_branches`: the least NFA over M compares products of different length, and a branch comes or goes as the others
 * get stronger: beside two of ln F = -30 a third of -18 is left out, for at t of the weakest the product of three says less; three
 * of -9 are a junction where no two are. So the branches are those of the strongest that are meaningful whatever stands beside
 * them: two like it would be a junction, #J(2) F(omega; J)^2 <= epsilon. Whether there is a junction, and how meaningful it is, is
 * still said by the least NFA. Ours; preset paper uses it: its L-junctions repeat more often under zoom by .9 to .5. Preset default
 * gains at .9 and loses at .5: it keeps the least NFA (tests/accuracy/tried/detection.md, "All meaningful branches").
 *
 * `isotropic_persistence` = n: a junction is meaningful at n radii one after the other. Texture and compression make junctions at
 * single radii. In the output of the authors' program the scale exceeds the radius next to it, where it seems to be first
 * meaningful, by two at least, in each of 7618 records. */
#include "isotropic.h"
#include "core/threads.h"

#include <math.h>
#include <string.h>

#define ROUNDING 1e-6 /* of log_nfa */
#define MAX_SECTORS 188 /* floor(2 pi 30) */

/* Puts a peak into a list of at most `most`, ordered by sum; of equals the one put in first comes first. Returns the new count. */
static int32_t insert(asj_isotropic_peak *peaks, int32_t count, int32_t most, asj_isotropic_peak peak)
{
    if (count == most && peak.sum <= peaks[most - 1].sum)
        return count;
    int32_t i = count < most ? count++ : most - 1;
    for (; i > 0 && peaks[i - 1].sum < peak.sum; i--)
        peaks[i] = peaks[i - 1];
    peaks[i] = peak;
    return count;
}

/* The strongest branches by sum, at most `most`, of one pixel. Only strengths above 1 count. */
static int32_t find_peaks(const asj_isotropic_radius *entry, const uint16_t *sums, int32_t most,
                          asj_isotropic_peak *peaks)
{
    const asj_sectors *s = &entry->sectors;
    uint16_t z[MAX_SECTORS];
    int32_t found = 0;
    for (int32_t k = 0; k < s->count; k++)
        z[k] = asj_sector_strength(s, k, sums[k]);
    for (int32_t k = 0; k < s->count; k++) {
        int largest = z[k] > ASJ_STRENGTH_ONE;
        for (int32_t d = 1; largest && d <= entry->suppress; d++) {
            int32_t left = k >= d ? k - d : k - d + s->count;
            int32_t right = k + d < s->count ? k + d : k + d - s->count;
            largest = z[k] > z[left] && z[k] >= z[right];
        }
        if (largest)
            found = insert(peaks, found, most, (asj_isotropic_peak){k, sums[k], z[k]});
    }
    return found;
}

/* From one sector to the other, the shorter way round. */
static int32_t sectors_apart(const asj_sectors *s, int32_t a, int32_t b)
{
    const int32_t d = a > b ? a - b : b - a;
    return 2 * d > s->count ? s->count - d : d;
}

/* ln NFA of the first m branches. */
static double log_alarms(const asj_isotropic *test, const asj_isotropic_radius *entry, const asj_isotropic_peak *peaks, int32_t m,
                         double t)
{
    double log_nfa = test->log_tests[m];
    for (int32_t i = 0; i < m; i++)
        log_nfa += asj_isotropic_log_tail(entry->tails[peaks[i].sector], t);
    return log_nfa;
}

/* Of a junction whose first `branches` peaks are the most meaningful ones: the branches that it gets. Returns their number. */
static int32_t choose(const asj_isotropic *test, const asj_isotropic_radius *entry, const asj_isotropic_peak *peaks, int32_t count,
                      int32_t branches, asj_isotropic_peak *chosen)
{
    const double unit = 1.0 / (1 << entry->sectors.gamma_bits);
    int32_t alone = 0;
    for (int32_t i = 0; i < count && test->all_meaningful; i++)
        if (asj_isotropic_log_tail(entry->tails[peaks[i].sector], peaks[i].sum * unit) <= test->log_alone)
            chosen[alone++] = peaks[i];
    if (alone > 2 || (alone == 2 && sectors_apart(&entry->sectors, chosen[0].sector, chosen[1].sector) <= entry->straight))
        return alone;
    memcpy(chosen, peaks, (size_t)branches * sizeof *peaks);
    return branches;
}

void asj_isotropic_judge(const asj_isotropic *test, const asj_isotropic_radius *entry, const asj_isotropic_peak *peaks,
                         int32_t count, asj_isotropic_junction *best)
{
    const asj_sectors *s = &entry->sectors;
    const double unit = 1.0 / (1 << s->gamma_bits);
    const uint32_t bit = test->persistence > 1 ? 1u << (entry - test->radii) : 0;
    double least = best->branch_count ? best->log_nfa : HUGE_VAL;
    int32_t branches = 0;
    for (int32_t m = 2; m <= count; m++) {
        if (m == 2 && sectors_apart(s, peaks[0].sector, peaks[1].sector) > entry->straight)
            continue;
        if (peaks[m - 1].sum < entry->least_sum[m]) /* also when so many branches do not fit at any radius */
            continue;
        const double t = peaks[m - 1].sum * unit;
        if ((best->meaningful & bit) == bit && t <= entry->lowest_end &&
            test->log_tests[m] + m * asj_isotropic_log_tail(entry->lowest_tail, t) - ROUNDING > least)
            continue;
        const double log_nfa = log_alarms(test, entry, peaks, m, t);
        if (log_nfa > test->log_epsilon)
            continue;
        best->meaningful |= bit;
        if (log_nfa >= least)
            continue;
        least = log_nfa;
        branches = m;
    }
    if (branches == 0)
        return;
    asj_isotropic_peak chosen[ASJ_MAX_BRANCHES];
    branches = choose(test, entry, peaks, count, branches, chosen);
    best->log_nfa = least;
    best->radius = (uint16_t)s->radius;
    best->branch_count = (uint16_t)branches;
    for (int32_t i = 0; i < branches; i++) {
        best->angle[i] = (uint16_t)(ASJ_ISOTROPIC_TURN * chosen[i].sector / s->count);
        best->strength[i] = chosen[i].strength;
    }
}

int asj_isotropic_persists(const asj_isotropic *test, const asj_isotropic_junction *junction)
{
    uint32_t runs = junction->meaningful; /* bit i: at radius i and at the n - 1 radii before it */
    for (int32_t n = 1; n < test->persistence; n++)
        runs &= junction->meaningful << n;
    return junction->branch_count > 0 && (test->persistence <= 1 || runs != 0);
}

void asj_isotropic_pixel(const asj_isotropic *test, const asj_frame *frame, int32_t x, int32_t y, uint16_t *scratch,
                         asj_isotropic_junction *junction)
{
    const ptrdiff_t at = y * frame->stride + x;
    memset(junction, 0, sizeof *junction);
    junction->x = (uint16_t)x;
    junction->y = (uint16_t)y;
    for (int32_t r = test->radius_count - 1; r >= 0; r--) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const asj_sector_runs *runs = &test->radii[entry->source].runs;
        uint16_t *prefix = scratch + runs->count * ASJ_SECTOR_RUN, *sums = prefix + entry->sectors.offset_count + 1;
        asj_isotropic_peak peaks[ASJ_MAX_BRANCHES];
        if (entry->source == r)
            asj_sector_gammas(runs, frame->gradient_x + at, frame->gradient_y + at, frame->stride, scratch);
        asj_sector_sums(&entry->sectors, entry->place, scratch, prefix, sums);
        asj_isotropic_judge(test, entry, peaks, find_peaks(entry, sums, test->max_branches, peaks), junction);
    }
}

void asj_isotropic_band(const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom, const uint16_t *masks,
                        uint16_t *scratch, asj_isotropic_junction *junctions)
{
    for (int32_t y = top; y < bottom; y++)
        for (int32_t b = 0; b < frame->blocks; b++) {
            uint32_t candidates = masks[(ptrdiff_t)y * frame->blocks + b];
            for (int32_t x = b * ASJ_LANES; candidates; candidates >>= 1, x++)
                if (candidates & 1)
                    asj_isotropic_pixel(test, frame, x, y, scratch, junctions++);
        }
}

/* Bands with enough candidates to be worth a thread, and enough of them for all threads to end together. */
#define LEAST_CANDIDATES 64
#define BANDS_PER_THREAD 8

typedef struct job {
    asj_context *context;
    const asj_isotropic *test;
    const asj_frame *frame;
    const asj_candidate_rows *rows;
    const asj_scratch *scratch;
    asj_isotropic_junction *junctions;
    int32_t bands;
} job;

static void test_bands(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_candidate_rows *rows = j->rows;
    const int64_t count = rows->bottom - rows->top;
    for (int64_t band = part->first; band < part->end; band++) {
        const int32_t first = (int32_t)(count * band / j->bands), last = (int32_t)(count * (band + 1) / j->bands);
        if (rows->starts[last] > rows->starts[first])
            j->context->ops->isotropic->band(j->test, j->frame, rows->top + first, rows->top + last, rows->masks,
                                             asj_thread_scratch(j->scratch, part), j->junctions + rows->starts[first]);
    }
}

asj_status asj_isotropic_rows(asj_context *context, const asj_isotropic *test, const asj_frame *frame,
                              const asj_candidate_rows *rows, const asj_scratch *scratch, asj_isotropic_junction *junctions)
{
    const int32_t count = rows->bottom - rows->top;
    const int32_t threads = asj_threads_for(context, (int64_t)rows->starts[count], LEAST_CANDIDATES);
    const int32_t bands = threads == 1 || count < BANDS_PER_THREAD * threads ? threads : BANDS_PER_THREAD * threads;
    const job j = {context, test, frame, rows, scratch, junctions, bands};
    asj_parallel(context, threads, bands, 1, test_bands, &j);
    return ASJ_OK;
}

const asj_isotropic_ops asj_isotropic_reference = {.rows = asj_isotropic_rows, .band = asj_isotropic_band};
