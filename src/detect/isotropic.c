/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3: isotropic junctions (the ACJ test, paper section "Detecting Junction Locations and Isotropic Branches").
 *
 * At a candidate pixel and a radius r: strengths of all sectors, circular non-maximum suppression, branches in order of omega. The
 * M strongest form a junction of junction-ness t = min omega (eq. junction-ness-entire), whose number of false alarms is
 *     NFA = #J(M) prod_{i=1..M} F(t; J_i)       M = 2 .. 5
 * (F: eq. acj-distribution-conv, an upper tail; #J(M): nfa.c). The best radius and M with NFA <= epsilon stay.
 * Two branches that open by more than pi - 2 Delta are an edge, not a junction.
 *
 * Departures: candidates come from the local field, not from line segments (field.c). Radii {7, 14} instead of all: the same
 * junctions at less than half the cost (5 finds nothing that 7 does not, 10 hardly anything). Among overlapping junctions the more
 * meaningful one stays; `more_branches_win` restores the rule of ACJ that M + 1 branches within half a radius replace M. */
#include "isotropic.h"
#include "nfa.h"
#include "core/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#ifdef _OPENMP
#include <omp.h>
#endif

#define TWO_PI 6.283185307179586
#define ROUNDING 1e-6 /* of log_nfa */
#define TWIN 2 /* px: of junctions nearer than this the most meaningful one stays */
#define MAX_SECTORS 188 /* floor(2 pi 30) */
#define ASJ_TAIL_STEPS 4 /* table entries for a junction-ness of 1; linear interpolation is then good to 0.01 in ln F */

static asj_status make_tails(asj_context *context, asj_isotropic *test, int32_t pixels)
{
    if (test->tail_tables[pixels])
        return ASJ_OK;
    size_t entries = (size_t)(pixels * (ASJ_GRADIENT_LIMIT + 0.1) * ASJ_TAIL_STEPS) + 3;
    double *table = asj_allocate(&context->memory, entries, sizeof *table);
    if (!table)
        return ASJ_ERROR_MEMORY;
    for (size_t i = 0; i < entries; i++)
        table[i] = asj_nfa_log_sector_tail(asj_nfa_of(context), (double)i / ASJ_TAIL_STEPS, pixels);
    test->tail_tables[pixels] = table;
    return ASJ_OK;
}

static asj_status make_radius(asj_context *context, asj_isotropic *test, int32_t radius, double tau)
{
    asj_isotropic_radius *entry = &test->radii[test->radius_count];
    asj_status status = asj_sectors_create(&context->memory, radius, tau, &entry->sectors);
    if (status != ASJ_OK)
        return status;
    test->radius_count++;
    status = asj_sector_plan_create(&context->memory, &entry->sectors, &entry->plan);
    if (status != ASJ_OK)
        return status;
    entry->suppress = (int32_t)lrint(tau / radius * entry->sectors.count / TWO_PI);
    entry->straight = (int32_t)((0.5 - tau / radius / (TWO_PI / 2)) * entry->sectors.count);
    entry->tails = asj_allocate(&context->memory, (size_t)entry->sectors.count, sizeof *entry->tails);
    if (!entry->tails)
        return ASJ_ERROR_MEMORY;
    entry->least = asj_allocate_zero(&context->memory, (size_t)entry->sectors.count, sizeof *entry->least);
    if (!entry->least)
        return ASJ_ERROR_MEMORY;
    int32_t fewest = entry->sectors.size[0];
    for (int32_t k = 0; status == ASJ_OK && k < entry->sectors.count; k++) {
        status = make_tails(context, test, entry->sectors.size[k]);
        entry->tails[k] = test->tail_tables[entry->sectors.size[k]];
        if (entry->sectors.size[k] < fewest)
            fewest = entry->sectors.size[k];
    }
    entry->lowest_tail = test->tail_tables[fewest];
    entry->lowest_end = fewest * ASJ_GRADIENT_LIMIT;
    return status;
}

/* In blocks: prefix sums, sums. In bands: gamma in runs, which may be those of a larger radius, then slots and strengths. */
static void measure_scratch(asj_isotropic *test)
{
    size_t offsets = 0, rest = 0;
    test->scratch = 0;
    for (int32_t r = 0; r < test->radius_count; r++) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const size_t count = (size_t)entry->sectors.count;
        const size_t block = asj_sector_scratch(&entry->sectors) + count * ASJ_LANES;
        const size_t slots = (size_t)entry->plan.slot_count + count + 2 * (size_t)entry->suppress;
        test->scratch = block > test->scratch ? block : test->scratch;
        const size_t in_runs = (size_t)entry->runs.count * ASJ_SECTOR_RUN;
        offsets = in_runs > offsets ? in_runs : offsets;
        rest = slots > rest ? slots : rest;
    }
    const size_t row = (offsets + rest) * ASJ_ISOTROPIC_LANES;
    test->scratch = row > test->scratch ? row : test->scratch;
}

/* Finds for each radius whose gammas it can share, and where they are there. */
static asj_status share_offsets(asj_memory *memory, asj_isotropic *test)
{
    asj_status status = ASJ_OK;
    for (int32_t r = test->radius_count - 1; r >= 0 && status == ASJ_OK; r--) {
        asj_isotropic_radius *entry = &test->radii[r];
        entry->source = r;
        if (r + 1 < test->radius_count && test->radii[r + 1].sectors.gamma_bits == entry->sectors.gamma_bits)
            entry->source = test->radii[r + 1].source;
        else
            status = asj_sector_runs_create(memory, &entry->sectors, &entry->runs);
        entry->place = asj_allocate(memory, (size_t)entry->sectors.offset_count, sizeof *entry->place);
        if (!entry->place)
            return ASJ_ERROR_MEMORY;
        if (status == ASJ_OK)
            asj_sector_runs_places(&test->radii[entry->source].runs, &entry->sectors, entry->place);
    }
    return status;
}

asj_status asj_isotropic_create(asj_context *context, const asj_detect_options *options, asj_isotropic *test)
{
    asj_status status = ASJ_OK;
    memset(test, 0, sizeof *test);
    for (int32_t r = 3; r <= ASJ_MAX_RADIUS && status == ASJ_OK; r++)
        if (options->isotropic_radii >> r & 1)
            status = make_radius(context, test, r, options->sector_width);
    if (status == ASJ_OK)
        status = share_offsets(&context->memory, test);
    measure_scratch(test);
    test->max_branches = options->max_branches;
    test->log_epsilon = log(options->epsilon);
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for the tables of the isotropic test");
    return ASJ_OK;
}

void asj_isotropic_free(asj_memory *memory, asj_isotropic *test)
{
    for (int32_t i = 0; i <= ASJ_MAX_RADIUS; i++) {
        asj_release(memory, test->radii[i].tails);
        asj_release(memory, test->radii[i].place);
        asj_sector_runs_free(memory, &test->radii[i].runs);
        asj_release(memory, test->radii[i].least);
        asj_sector_plan_free(memory, &test->radii[i].plan);
        asj_sectors_free(memory, &test->radii[i].sectors);
    }
    for (size_t i = 0; i < sizeof test->tail_tables / sizeof test->tail_tables[0]; i++)
        asj_release(memory, test->tail_tables[i]);
    memset(test, 0, sizeof *test);
}

static double log_tail(const double *table, double t)
{
    double position = t * ASJ_TAIL_STEPS;
    int32_t i = (int32_t)position;
    double rest = position - i;
    return table[i] * (1 - rest) + table[i + 1] * rest;
}

/* The least sum of sector k with ln F <= log_p; more than any sum when there is none. */
static int32_t least_sum(const asj_isotropic_radius *entry, int32_t k, double log_p)
{
    const asj_sectors *s = &entry->sectors;
    const int32_t one = 1 << s->gamma_bits, most = (int32_t)(s->size[k] * (ASJ_GRADIENT_LIMIT * one + 2));
    int32_t low = 0, high = most + 1;
    while (low < high) {
        const int32_t middle = (low + high) / 2;
        if (log_tail(entry->tails[k], (double)middle / one) <= log_p)
            high = middle;
        else
            low = middle + 1;
    }
    return low > most ? INT32_MAX : low;
}

/* M branches of which the weakest has sum t are meaningful when ln #J(M) + sum of ln F(t; J_i) <= ln epsilon. One of the M terms
 * is at most their mean, so t is at least the least sum, over the sectors, with ln F <= (ln epsilon - ln #J(M)) / M. A branch below
 * all these for M = 2, 3, .. cannot be among meaningful ones. A millionth is for rounding. */
static void set_least(const asj_isotropic *test, asj_isotropic_radius *entry)
{
    const asj_sectors *s = &entry->sectors;
    int32_t least = INT32_MAX;
    for (int32_t m = 2; m <= ASJ_MAX_BRANCHES; m++) {
        entry->least_sum[m] = INT32_MAX;
        if (m > test->max_branches || test->log_tests[m] == -HUGE_VAL)
            continue;
        for (int32_t k = 0; k < s->count; k++) {
            const int32_t sum = least_sum(entry, k, (test->log_epsilon - test->log_tests[m]) / m + 1e-6);
            entry->least_sum[m] = sum < entry->least_sum[m] ? sum : entry->least_sum[m];
        }
        least = entry->least_sum[m] < least ? entry->least_sum[m] : least;
    }
    for (int32_t k = 0; k < s->count; k++) {
        const uint16_t strength = least > 65535 ? INT16_MAX : asj_sector_strength(s, k, (uint16_t)least);
        entry->least[k] = strength > ASJ_STRENGTH_ONE ? strength : ASJ_STRENGTH_ONE + 1;
    }
}

void asj_isotropic_set_size(const asj_detect_options *options, int32_t width, int32_t height, asj_isotropic *test)
{
    for (int32_t m = 2; m <= ASJ_MAX_BRANCHES; m++)
        test->log_tests[m] = asj_nfa_log_junction_tests(width, height, options->isotropic_radii, options->sector_width, m);
    for (int32_t r = 0; r < test->radius_count; r++)
        set_least(test, &test->radii[r]);
}

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
        z[k] = asj_sector_strength(s, k, sums[(size_t)k * ASJ_LANES]);
    for (int32_t k = 0; k < s->count; k++) {
        int largest = z[k] > ASJ_STRENGTH_ONE;
        for (int32_t d = 1; largest && d <= entry->suppress; d++) {
            int32_t left = k >= d ? k - d : k - d + s->count;
            int32_t right = k + d < s->count ? k + d : k + d - s->count;
            largest = z[k] > z[left] && z[k] >= z[right];
        }
        if (largest)
            found = insert(peaks, found, most, (asj_isotropic_peak){k, sums[(size_t)k * ASJ_LANES], z[k]});
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
        log_nfa += log_tail(entry->tails[peaks[i].sector], t);
    return log_nfa;
}

void asj_isotropic_judge(const asj_isotropic *test, const asj_isotropic_radius *entry, const asj_isotropic_peak *peaks,
                         int32_t count, asj_isotropic_junction *best)
{
    const asj_sectors *s = &entry->sectors;
    const double unit = 1.0 / (1 << s->gamma_bits);
    double least = best->branch_count ? best->log_nfa : HUGE_VAL;
    int32_t branches = 0;
    for (int32_t m = 2; m <= count; m++) {
        if (m == 2 && sectors_apart(s, peaks[0].sector, peaks[1].sector) > entry->straight)
            continue;
        if (peaks[m - 1].sum < entry->least_sum[m]) /* also when so many branches do not fit at any radius */
            continue;
        const double t = peaks[m - 1].sum * unit;
        if (t <= entry->lowest_end && test->log_tests[m] + m * log_tail(entry->lowest_tail, t) - ROUNDING > least)
            continue;
        const double log_nfa = log_alarms(test, entry, peaks, m, t);
        if (log_nfa > test->log_epsilon || log_nfa >= least)
            continue;
        least = log_nfa;
        branches = m;
    }
    if (branches == 0)
        return;
    best->log_nfa = least;
    best->radius = (uint16_t)s->radius;
    best->branch_count = (uint16_t)branches;
    for (int32_t i = 0; i < branches; i++) {
        best->angle[i] = (uint16_t)(65536 * peaks[i].sector / s->count);
        best->strength[i] = peaks[i].strength;
    }
}

void asj_isotropic_block(const asj_isotropic *test, const asj_frame *frame, int32_t x, int32_t y, uint32_t candidates,
                         uint16_t *scratch, asj_isotropic_junction *junctions)
{
    const ptrdiff_t at = y * frame->stride + x;
    int32_t count = 0;
    for (int32_t i = 0; i < ASJ_LANES; i++)
        if (candidates >> i & 1) {
            memset(&junctions[count], 0, sizeof *junctions);
            junctions[count].x = (uint16_t)(x + i);
            junctions[count++].y = (uint16_t)y;
        }
    for (int32_t r = test->radius_count - 1; r >= 0; r--) {
        const asj_isotropic_radius *entry = &test->radii[r];
        uint16_t *sums = scratch + asj_sector_scratch(&entry->sectors);
        asj_sector_sums(&entry->sectors, frame->gradient_x + at, frame->gradient_y + at, frame->stride, scratch, sums);
        for (int32_t i = 0, slot = 0; i < ASJ_LANES; i++)
            if (candidates >> i & 1) {
                asj_isotropic_peak peaks[ASJ_MAX_BRANCHES];
                const int32_t found = find_peaks(entry, sums + i, test->max_branches, peaks);
                asj_isotropic_judge(test, entry, peaks, found, &junctions[slot++]);
            }
    }
}

void asj_isotropic_band(const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom, const uint16_t *masks,
                        uint16_t *scratch, asj_isotropic_junction *junctions)
{
    for (int32_t y = top; y < bottom; y++)
        for (int32_t b = 0; b < frame->blocks; b++) {
            const uint32_t candidates = masks[(ptrdiff_t)y * frame->blocks + b];
            if (candidates)
                asj_isotropic_block(test, frame, b * ASJ_LANES, y, candidates, scratch, junctions);
            for (uint32_t rest = candidates; rest; rest &= rest - 1)
                junctions++;
        }
}

/* Bands with enough candidates to be worth a thread, and enough of them for all threads to end together. */
#define LEAST_CANDIDATES 64
#define BANDS_PER_THREAD 4

asj_status asj_isotropic_rows(asj_context *context, const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom,
                              const uint16_t *masks, const size_t *starts, uint16_t *scratch, size_t scratch_size,
                              asj_isotropic_junction *junctions)
{
    const int32_t rows = bottom - top, threads = asj_threads_for(context, (int64_t)starts[rows], LEAST_CANDIDATES);
    const int32_t bands = threads == 1 || rows < BANDS_PER_THREAD * threads ? threads : BANDS_PER_THREAD * threads;
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(dynamic)
#endif
    for (int32_t band = 0; band < bands; band++) {
        const int32_t first = (int32_t)((int64_t)rows * band / bands), last = (int32_t)((int64_t)rows * (band + 1) / bands);
        size_t thread = 0;
#ifdef _OPENMP
        thread = (size_t)omp_get_thread_num();
#endif
        if (starts[last] > starts[first])
            context->ops->isotropic->band(test, frame, top + first, top + last, masks, scratch + thread * scratch_size,
                                         junctions + starts[first]);
    }
    return ASJ_OK;
}

/* Ties are broken by place, so that the order never depends on anything else. */
static int by_place(const asj_isotropic_junction *p, const asj_isotropic_junction *q)
{
    return p->y != q->y ? p->y - q->y : p->x - q->x;
}

static int in_rows(const void *a, const void *b)
{
    return by_place(a, b);
}

static int by_meaning(const void *a, const void *b)
{
    const asj_isotropic_junction *p = a, *q = b;
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa ? -1 : 1;
    return by_place(p, q);
}

static int by_branches(const void *a, const void *b)
{
    const asj_isotropic_junction *p = a, *q = b;
    if (p->branch_count != q->branch_count)
        return q->branch_count - p->branch_count;
    return by_meaning(a, b);
}

/* Marks the disc around a junction in the bit map. */
static void take(uint8_t *taken, int32_t width, int32_t height, int32_t x, int32_t y, double radius)
{
    const size_t row_bytes = ((size_t)width + 7) / 8;
    const int32_t reach = (int32_t)radius, top = y > reach ? y - reach : 0, bottom = y + reach < height ? y + reach : height - 1;
    for (int32_t row = top; row <= bottom; row++) {
        int32_t half = 0;
        while ((half + 1) * (half + 1) + (row - y) * (row - y) <= radius * radius)
            half++;
        const int32_t right = x + half < width ? x + half : width - 1;
        for (int32_t column = x > half ? x - half : 0; column <= right; column++)
            taken[(size_t)row * row_bytes + (size_t)(column / 8)] |= (uint8_t)(1 << column % 8);
    }
}

/* A junction's place in the list and its log_nfa as a float, turned into a whole number in the same order. */
typedef struct rank {
    uint32_t key, index;
} rank;

static uint32_t key_of(double log_nfa)
{
    const float rounded = (float)log_nfa + 0.0f; /* no negative zero */
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    return bits >> 31 ? ~bits : bits | 0x80000000u;
}

/* Ranks by meaningfulness: three passes over 11 bits of the keys each, then what the floats do not tell. `spare` is as long as
 * `ranks`; returns the one of both that holds the result. */
static rank *sort_ranks(const asj_isotropic_junction *junctions, rank *ranks, rank *spare, size_t count)
{
    for (int shift = 0; shift < 32; shift += 11) {
        size_t starts[2048] = {0}, next = 0;
        for (size_t i = 0; i < count; i++)
            starts[ranks[i].key >> shift & 2047]++;
        for (size_t b = 0; b < 2048; b++) {
            const size_t here = starts[b];
            starts[b] = next;
            next += here;
        }
        for (size_t i = 0; i < count; i++)
            spare[starts[ranks[i].key >> shift & 2047]++] = ranks[i];
        rank *swap = ranks;
        ranks = spare;
        spare = swap;
    }
    for (size_t i = 1; i < count; i++) {
        const rank moved = ranks[i];
        size_t j = i;
        for (; j > 0 && ranks[j - 1].key == moved.key; j--) {
            if (by_meaning(&junctions[ranks[j - 1].index], &junctions[moved.index]) <= 0)
                break;
            ranks[j] = ranks[j - 1];
        }
        ranks[j] = moved;
    }
    return ranks;
}

size_t asj_isotropic_thin_scratch(size_t count, int32_t width, int32_t height)
{
    return count * (2 * sizeof(rank) + 1) + ((size_t)width + 7) / 8 * (size_t)height;
}

size_t asj_isotropic_thin(asj_isotropic_junction *junctions, size_t count, const asj_detect_options *options,
                          int32_t width, int32_t height, void *scratch)
{
    const size_t row_bytes = ((size_t)width + 7) / 8;
    rank *ranks = scratch, *spare = ranks + count;
    uint8_t *stays = (uint8_t *)(void *)(spare + count), *taken = stays + count;
    size_t kept = 0;
    if (count == 0)
        return 0;
    if (options->more_branches_win)
        qsort(junctions, count, sizeof *junctions, by_branches);
    for (size_t i = 0; i < count; i++)
        ranks[i] = (rank){key_of(junctions[i].log_nfa), (uint32_t)i};
    const rank *order = options->more_branches_win ? ranks : sort_ranks(junctions, ranks, spare, count);
    memset(stays, 0, count + row_bytes * (size_t)height);
    for (size_t i = 0; i < count; i++) {
        const asj_isotropic_junction *junction = &junctions[order[i].index];
        if (taken[junction->y * row_bytes + junction->x / 8] >> junction->x % 8 & 1)
            continue;
        take(taken, width, height, junction->x, junction->y, options->more_branches_win ? 0.5 * junction->radius : TWIN);
        stays[order[i].index] = 1;
    }
    for (size_t i = 0; i < count; i++)
        if (stays[i])
            junctions[kept++] = junctions[i];
    if (options->more_branches_win)
        qsort(junctions, kept, sizeof *junctions, in_rows);
    return kept;
}

const asj_isotropic_ops asj_isotropic_reference = {.rows = asj_isotropic_rows, .band = asj_isotropic_band};
