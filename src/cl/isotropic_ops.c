/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3 on the device (kernels/isotropic.cl): it finds the strongest branches of each candidate, the host judges them. */
#include "kernels/contract.h"
#include "detect.h"
#include "overrides.h"
#include "planes.h"
#include "state.h"
#include "core/threads.h"

#include <asj/device.h>
#include <string.h>

/* Candidates that are sent at once: enough for any device to be busy, few enough for their peaks to stay in a cache. */
#define MOST_CANDIDATES 65536
#define LEAST_CANDIDATES 512 /* to judge, for a thread: about 50 us */

static size_t table_size(const asj_isotropic *test)
{
    size_t count = 0;
    for (int32_t r = 0; r < test->radius_count; r++) {
        const asj_isotropic_radius *entry = &test->radii[r];
        count += RADIUS_INTS + (size_t)entry->sectors.offset_count + (size_t)entry->plan.slot_count +
                 RUN_INTS * (size_t)test->radii[entry->source].runs.count + ISOTROPIC_SECTOR_INTS * (size_t)entry->sectors.count;
    }
    return count;
}

static int32_t *add_runs(const asj_sector_runs *runs, int32_t *next)
{
    for (int32_t r = 0; r < runs->count; r++) {
        next[RUN_DX] = runs->dx[r];
        next[RUN_DY] = runs->dy[r];
        for (int32_t i = 0; i < RUN; i++) {
            next[RUN_X + i] = runs->factors[4 * r][i];
            next[RUN_Y + i] = runs->factors[4 * r + 1][i];
            next[RUN_CROSS_X + i] = runs->factors[4 * r + 2][i];
            next[RUN_DOT_Y + i] = runs->factors[4 * r + 3][i];
        }
        next += RUN_INTS;
    }
    return next;
}

static int32_t *add_slots(const asj_sector_plan *plan, int32_t *next)
{
    for (int32_t j = 0; j < plan->plain_count; j++)
        *next++ = plan->boundary[j];
    for (int32_t j = 0; j < plan->slot_count - plan->plain_count; j++)
        *next++ = plan->extra[j];
    return next;
}

static int32_t *add_sectors(const asj_isotropic_radius *entry, int32_t *next)
{
    const asj_sectors *s = &entry->sectors;
    for (int32_t k = 0; k < s->count; k++) {
        next[SECTOR_LOW] = entry->plan.low[k];
        next[SECTOR_HIGH] = entry->plan.high[k];
        next[SECTOR_MEAN] = s->mean[k];
        next[SECTOR_SCALE] = s->scale[k];
        next[SECTOR_LEAST] = entry->least[k];
        next[SECTOR_FIRST] = s->first[k];
        next[SECTOR_SIZE] = s->size[k];
        next += ISOTROPIC_SECTOR_INTS;
    }
    return next;
}

static asj_status load_table(asj_context *context, asj_cl_table *table, const asj_isotropic *test)
{
    int32_t *numbers;
    asj_status status = asj_cl_table_begin(context, table, table_size(test), &numbers);
    if (status != ASJ_OK)
        return status;
    int32_t *next = numbers + RADIUS_INTS * test->radius_count;
    for (int32_t r = 0; r < test->radius_count; r++) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const asj_sectors *s = &entry->sectors;
        const asj_sector_runs *runs = &test->radii[entry->source].runs;
        const int shared = r > 0 && entry->source == test->radii[r - 1].source;
        int32_t *radius = numbers + RADIUS_INTS * r;
        radius[RADIUS_SECTORS] = s->count;
        radius[RADIUS_SUPPRESS] = entry->suppress;
        radius[RADIUS_PLAIN_SLOTS] = entry->plan.plain_count;
        radius[RADIUS_SLOTS] = entry->plan.slot_count;
        radius[RADIUS_RUNS] = shared ? 0 : runs->count;
        radius[RADIUS_RUN_AT] = (int32_t)(next - numbers);
        next = shared ? next : add_runs(runs, next);
        radius[RADIUS_PLACE_AT] = (int32_t)(next - numbers);
        for (int32_t i = 0; i < s->offset_count; i++)
            *next++ = entry->place[i];
        radius[RADIUS_SLOT_AT] = (int32_t)(next - numbers);
        next = add_slots(&entry->plan, next);
        radius[RADIUS_SECTOR_AT] = (int32_t)(next - numbers);
        next = add_sectors(entry, next);
    }
    return asj_cl_table_end(context, table, (size_t)(next - numbers));
}

/* The largest of all radii: gammas, slots, sectors with those that are repeated. */
static void largest(const asj_isotropic *test, size_t *gammas, size_t *slots, size_t *sectors)
{
    *gammas = *slots = *sectors = 0;
    for (int32_t r = 0; r < test->radius_count; r++) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const size_t count = (size_t)(entry->sectors.count + 2 * entry->suppress);
        *gammas = (size_t)entry->runs.count * RUN > *gammas ? (size_t)entry->runs.count * RUN : *gammas;
        *slots = (size_t)entry->plan.slot_count > *slots ? (size_t)entry->plan.slot_count : *slots;
        *sectors = count > *sectors ? count : *sectors;
    }
}

/* A call's work: rows first .. last - 1 at once. */
typedef struct batch {
    const asj_isotropic *test;
    const asj_frame *frame;
    const uint16_t *masks; /* of row 0 */
    int32_t first, last;
    size_t count;          /* candidates */
} batch;

static void list_candidates(const batch *b, uint32_t *places)
{
    for (int32_t y = b->first; y < b->last; y++)
        for (int32_t run = 0; run < b->frame->blocks; run++) {
            uint32_t bits = b->masks[(ptrdiff_t)y * b->frame->blocks + run];
            for (int32_t x = run * ASJ_LANES; bits; bits >>= 1, x++)
                if (bits & 1)
                    *places++ = (uint32_t)y << 16 | (uint32_t)x;
        }
}

#define COMMON_ARGUMENTS                                                                                                        \
    ASJ_CL_BUFFER(&detect->gradient_x), ASJ_CL_BUFFER(&detect->gradient_y), ASJ_CL_INT(b->frame->stride),                       \
        ASJ_CL_INT(detect->first), ASJ_CL_BUFFER(&detect->isotropic_table.buffer), ASJ_CL_INT(b->test->radius_count),           \
        ASJ_CL_INT(b->test->max_branches), ASJ_CL_BUFFER(&detect->candidates), ASJ_CL_BUFFER(&detect->peaks)

static asj_status send_candidates(asj_context *context, struct asj_cl_detect *detect, const batch *b)
{
    const size_t bytes = b->count * sizeof(uint32_t);
    asj_status status = asj_cl_host_reserve(context, &detect->host_candidates, bytes);
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &detect->candidates, bytes);
    if (status != ASJ_OK)
        return status;
    list_candidates(b, detect->host_candidates.memory);
    return asj_cl_write(context, &detect->candidates, 0, detect->host_candidates.memory, bytes);
}

static asj_status run_batches(asj_context *context, struct asj_cl_detect *detect, const batch *b, const size_t bytes[4])
{
    static const size_t local = 1;
    const size_t global = (b->count + LANES - 1) / LANES;
    const asj_cl_argument arguments[] = {COMMON_ARGUMENTS, ASJ_CL_INT(b->count), ASJ_CL_LOCAL(bytes[0]), ASJ_CL_LOCAL(bytes[1]),
                                         ASJ_CL_LOCAL(bytes[2]), ASJ_CL_LOCAL(bytes[3])};
    return asj_cl_run(context, "isotropic_batches", 1, &global, &local, ASJ_CL_ARGUMENTS(arguments));
}

static asj_status run_candidates(asj_context *context, struct asj_cl_detect *detect, const batch *b, size_t gammas, size_t sectors)
{
    const size_t longest = asj_cl_get_limits(context)->max_work_item[0];
    size_t local = 64, most = 1;
    asj_status status = asj_cl_kernel_limits(context, "isotropic_candidates", &most, NULL);
    local = local <= most ? local : most;
    local = local <= longest ? local : longest;
    const size_t global = b->count * local;
    const asj_cl_argument arguments[] = {COMMON_ARGUMENTS, ASJ_CL_LOCAL(gammas * sizeof(uint16_t)),
                                         ASJ_CL_LOCAL(sectors * sizeof(uint32_t)), ASJ_CL_LOCAL(sectors * sizeof(uint32_t))};
    if (status == ASJ_OK)
        status = asj_cl_run(context, "isotropic_candidates", 1, &global, &local, ASJ_CL_ARGUMENTS(arguments));
    return status;
}

/* Runs the form that suits the device; the peaks come to host_peaks. */
static asj_status find_peaks(asj_context *context, struct asj_cl_detect *detect, const batch *b)
{
    const size_t bytes = b->count * (size_t)(b->test->radius_count * b->test->max_branches) * sizeof(uint32_t);
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    size_t gammas, slots, sectors;
    asj_status status = asj_cl_planes_need(context, b->frame, b->first, b->last);
    if (status == ASJ_OK)
        status = load_table(context, &detect->isotropic_table, b->test);
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &detect->peaks, bytes);
    if (status == ASJ_OK)
        status = asj_cl_host_reserve(context, &detect->host_peaks, bytes);
    if (status == ASJ_OK)
        status = send_candidates(context, detect, b);
    if (status != ASJ_OK)
        return status;
    largest(b->test, &gammas, &slots, &sectors);
    const size_t lanes = LANES * sizeof(uint16_t);
    const size_t local[4] = {gammas * lanes, slots * lanes, sectors * lanes, ASJ_MAX_BRANCHES * LANES * sizeof(uint32_t)};
    if (limits->type == ASJ_DEVICE_CPU && local[0] + local[1] + local[2] + local[3] <= limits->local_memory)
        status = run_batches(context, detect, b, local);
    else
        status = run_candidates(context, detect, b, gammas, sectors);
    return status == ASJ_OK ? asj_cl_read(context, &detect->peaks, 0, detect->host_peaks.memory, bytes) : status;
}

/* `peaks`: those of all radii, one candidate. */
static void judge(const asj_isotropic *test, const uint32_t *peaks, int32_t x, int32_t y, asj_isotropic_junction *junction)
{
    memset(junction, 0, sizeof *junction);
    junction->x = (uint16_t)x;
    junction->y = (uint16_t)y;
    for (int32_t r = test->radius_count - 1; r >= 0; r--) {
        const asj_isotropic_radius *entry = &test->radii[r];
        const uint32_t *own = peaks + r * test->max_branches;
        asj_isotropic_peak list[ASJ_MAX_BRANCHES];
        int32_t count = 0;
        for (; count < test->max_branches && own[count]; count++) {
            const int32_t k = (int32_t)(own[count] & 65535);
            const uint16_t sum = (uint16_t)(own[count] >> 16);
            list[count] = (asj_isotropic_peak){k, sum, asj_sector_strength(&entry->sectors, k, sum)};
        }
        asj_isotropic_judge(test, entry, list, count, junction);
    }
}

static void judge_row(const batch *b, int32_t y, const uint32_t *peaks, asj_isotropic_junction *junctions)
{
    const size_t numbers = (size_t)(b->test->radius_count * b->test->max_branches);
    for (int32_t run = 0; run < b->frame->blocks; run++) {
        uint32_t bits = b->masks[(ptrdiff_t)y * b->frame->blocks + run];
        for (int32_t x = run * ASJ_LANES; bits; bits >>= 1, x++)
            if (bits & 1) {
                judge(b->test, peaks, x, y, junctions++);
                peaks += numbers;
            }
    }
}

typedef struct job {
    const batch *b;
    const uint32_t *peaks;
    const size_t *starts; /* of candidates, for each row from `top` on */
    int32_t top;
    asj_isotropic_junction *junctions;
} job;

static void judge_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    const size_t numbers = (size_t)(j->b->test->radius_count * j->b->test->max_branches), *starts = j->starts;
    const int32_t first = j->b->first;
    for (int64_t y = first + part->first; y < first + part->end; y++)
        judge_row(j->b, (int32_t)y, j->peaks + (starts[y - j->top] - starts[first - j->top]) * numbers,
                  j->junctions + starts[y - j->top]);
}

/* Candidates whose peaks a buffer has room for. */
static size_t most_candidates(const asj_context *context, size_t numbers)
{
    const uint64_t most = asj_cl_get_limits(context)->largest_buffer / (numbers * sizeof(uint32_t));
    return most > MOST_CANDIDATES ? MOST_CANDIDATES : (size_t)most;
}

asj_status asj_cl_isotropic_rows(asj_context *context, const asj_isotropic *test, const asj_frame *frame,
                                 const asj_candidate_rows *rows, const asj_scratch *scratch, asj_isotropic_junction *junctions)
{
    const int32_t top = rows->top, bottom = rows->bottom;
    const size_t *starts = rows->starts;
    const int32_t band = asj_cl_plane_rows(context, frame) - 2 * ASJ_MARGIN;
    const size_t numbers = (size_t)(test->radius_count * test->max_branches), most = most_candidates(context, numbers);
    struct asj_cl_detect *detect;
    asj_status status = asj_cl_detect_get(context, &detect);
    if (status == ASJ_OK && (band < 1 || most < (size_t)frame->width))
        return asj_isotropic_rows(context, test, frame, rows, scratch, junctions);
    for (int32_t first = top, last; status == ASJ_OK && first < bottom; first = last) {
        for (last = first + 1; last < bottom && last - first < band; last++)
            if (starts[last + 1 - top] - starts[first - top] > most)
                break;
        const batch b = {test, frame, rows->masks, first, last, starts[last - top] - starts[first - top]};
        if (b.count > 0)
            status = find_peaks(context, detect, &b);
        if (status != ASJ_OK || b.count == 0)
            continue;
        const job j = {&b, detect->host_peaks.memory, starts, top, junctions};
        asj_parallel(context, asj_threads_for(context, (int64_t)b.count, LEAST_CANDIDATES), last - first, 4, judge_rows, &j);
    }
    return status;
}
