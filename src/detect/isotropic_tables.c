/* SPDX-License-Identifier: BSD-2-Clause */
/* Tables of step 3: for each radius the sectors, their tails ln F, and the least sums and strengths that can be meaningful. */
#include "isotropic.h"
#include "core/angle.h"
#include "nfa.h"

#include <math.h>
#include <string.h>

/* Of a sector of so many pixels; NULL without memory. */
static const double *find_tails(asj_context *context, asj_isotropic *test, int32_t pixels)
{
    const double *stored = asj_nfa_tail(asj_nfa_tables(), pixels);
    if (stored || test->tail_tables[pixels])
        return stored ? stored : test->tail_tables[pixels];
    const int32_t length = asj_nfa_tail_length(pixels);
    double *table = asj_allocate(&context->memory, (size_t)length, sizeof *table);
    for (int32_t i = 0; table && i < length; i++)
        table[i] = asj_nfa_log_sector_tail(asj_nfa_tables(), (double)i / ASJ_TAIL_STEPS, pixels);
    return test->tail_tables[pixels] = table;
}

static asj_status make_radius(asj_context *context, asj_isotropic *test, int32_t radius, double tau, int32_t disjoint)
{
    asj_isotropic_radius *entry = &test->radii[test->radius_count];
    asj_status status = asj_sectors_create(&context->memory, radius, tau, &entry->sectors);
    if (status != ASJ_OK)
        return status;
    test->radius_count++;
    status = asj_sector_plan_create(&context->memory, &entry->sectors, &entry->plan);
    if (status != ASJ_OK)
        return status;
    entry->suppress = (int32_t)lrint((disjoint ? 2 : 1) * tau / radius * entry->sectors.count / ASJ_TWO_PI);
    entry->straight = (int32_t)((0.5 - tau / radius / ASJ_PI) * entry->sectors.count);
    entry->tails = asj_allocate(&context->memory, (size_t)entry->sectors.count, sizeof *entry->tails);
    if (!entry->tails)
        return ASJ_ERROR_MEMORY;
    entry->least = asj_allocate_zero(&context->memory, (size_t)entry->sectors.count, sizeof *entry->least);
    if (!entry->least)
        return ASJ_ERROR_MEMORY;
    entry->units = asj_allocate(&context->memory, (size_t)entry->sectors.count, sizeof *entry->units);
    if (!entry->units)
        return ASJ_ERROR_MEMORY;
    for (int32_t k = 0; k < entry->sectors.count; k++) {
        const double angle = asj_isotropic_angle((uint16_t)(ASJ_ISOTROPIC_TURN * k / entry->sectors.count));
        entry->units[k][0] = cos(angle);
        entry->units[k][1] = sin(angle);
    }
    int32_t fewest = entry->sectors.size[0];
    for (int32_t k = 0; k < entry->sectors.count; k++) {
        entry->tails[k] = find_tails(context, test, entry->sectors.size[k]);
        if (!entry->tails[k])
            return ASJ_ERROR_MEMORY;
        if (entry->sectors.size[k] < fewest)
            fewest = entry->sectors.size[k];
    }
    entry->lowest_tail = find_tails(context, test, fewest); /* it is there */
    entry->lowest_end = fewest * ASJ_GRADIENT_LIMIT;
    return status;
}

/* Gamma in runs, which may be those of a larger radius; then slots and strengths, of as many pixels as a vector form has lanes. One
 * pixel needs less than that: gamma, prefix sums, sums. */
static void measure_scratch(asj_isotropic *test)
{
    size_t offsets = 0, rest = 0;
    for (int32_t r = 0; r < test->radius_count; r++) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const size_t count = (size_t)entry->sectors.count;
        const size_t slots = (size_t)entry->plan.slot_count + count + 2 * (size_t)entry->suppress;
        const size_t in_runs = (size_t)entry->runs.count * ASJ_SECTOR_RUN;
        offsets = in_runs > offsets ? in_runs : offsets;
        rest = slots > rest ? slots : rest;
    }
    test->scratch = (offsets + rest) * ASJ_ISOTROPIC_LANES;
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
        if (status != ASJ_OK)
            break;
        asj_sector_runs_places(&test->radii[entry->source].runs, &entry->sectors, entry->place);
        asj_sector_plan_set_steps(&entry->sectors, entry->place, &entry->plan);
    }
    return status;
}

asj_status asj_isotropic_create(asj_context *context, const asj_detect_options *options, asj_isotropic *test)
{
    asj_status status = ASJ_OK;
    memset(test, 0, sizeof *test);
    for (int32_t r = 3; r <= ASJ_MAX_RADIUS && status == ASJ_OK; r++)
        if (options->isotropic_radii >> r & 1)
            status = make_radius(context, test, r, options->sector_width, options->disjoint_sectors);
    if (status == ASJ_OK)
        status = share_offsets(&context->memory, test);
    measure_scratch(test);
    test->max_branches = options->max_branches;
    test->persistence = options->isotropic_persistence;
    test->all_meaningful = options->all_meaningful_branches;
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
        asj_release(memory, test->radii[i].units);
        asj_sector_plan_free(memory, &test->radii[i].plan);
        asj_sectors_free(memory, &test->radii[i].sectors);
    }
    for (size_t i = 0; i < sizeof test->tail_tables / sizeof test->tail_tables[0]; i++)
        asj_release(memory, test->tail_tables[i]);
    memset(test, 0, sizeof *test);
}

void asj_isotropic_units(const asj_isotropic *test, const asj_isotropic_junction *junction, double units[ASJ_MAX_BRANCHES][2])
{
    const asj_isotropic_radius *entry = test->radii;
    while (entry->sectors.radius != junction->radius)
        entry++;
    for (int32_t i = 0; i < junction->branch_count; i++) {
        /* the angle is the whole part of TURN k / count */
        const int32_t k = (junction->angle[i] * entry->sectors.count + ASJ_ISOTROPIC_TURN - 1) / ASJ_ISOTROPIC_TURN;
        memcpy(units[i], entry->units[k], sizeof units[i]);
    }
}

/* The least sum of sector k with ln F <= log_p; more than any sum when there is none. */
static int32_t least_sum(const asj_isotropic_radius *entry, int32_t k, double log_p)
{
    const asj_sectors *s = &entry->sectors;
    const int32_t one = 1 << s->gamma_bits, most = (int32_t)(s->size[k] * (ASJ_GRADIENT_LIMIT * one + 2));
    int32_t low = 0, high = most + 1;
    while (low < high) {
        const int32_t middle = (low + high) / 2;
        if (asj_isotropic_log_tail(entry->tails[k], (double)middle / one) <= log_p)
            high = middle;
        else
            low = middle + 1;
    }
    return low > most ? INT32_MAX : low;
}

/* Sectors of as many pixels have the same least sums. */
static int is_first_of_size(const asj_sectors *s, int32_t k)
{
    int32_t first = 0;
    while (s->size[first] != s->size[k])
        first++;
    return first == k;
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
            if (!is_first_of_size(s, k))
                continue;
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

void asj_isotropic_set_size(const asj_detect_options *options, int32_t width, int32_t height, int32_t octaves,
                            asj_isotropic *test)
{
    for (int32_t m = 2; m <= ASJ_MAX_BRANCHES; m++)
        test->log_tests[m] = asj_nfa_log_junction_tests(width, height, options->isotropic_radii, options->sector_width, m) +
                             log(octaves);
    test->log_alone = 0.5 * (test->log_epsilon - test->log_tests[2]);
    for (int32_t r = 0; r < test->radius_count; r++)
        set_least(test, &test->radii[r]);
}
