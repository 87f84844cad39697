/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 4 and the local field on the device (kernels/ray_scan.cl). What is known of the image's local junctions is kept until the
 * gradient changes, so that the second scan of an image finds what the first one computed. An image that the device has no room for
 * is scanned in bands of rows, which overlap: down, up, and again until no ray waits. */
#include "kernels/contract.h"
#include "detect.h"
#include "overrides.h"
#include "planes.h"
#include "core/watch.h"
#include "detect/ray_walk.h"
#include "state.h"

#include <asj/device.h>

#include <string.h>

#define GROUP 16 /* work items: small groups share the work evenly, as rays differ in length */

/* Rows that bands have in common. A step needs the edge from its radius to 4 px farther on, and the arc 3 px on, which reaches
 * 3 px to either side: 9 rows with rounding. */
#define OVERLAP 12
#define SWEEPS 8 /* one down and one up bring every ray to its end: this is for none that waits without end */

struct asj_cl_scan {
    asj_cl_table field, angles;
    asj_cl_buffer rays, known, asked, entries, branches, counts;
    asj_cl_host_buffer host_rays;
    uint64_t generation;    /* of the gradient that all this belongs to, */
    int32_t low, high;      /* and the rows */
    uint32_t done;          /* entries with branches */
    uint32_t capacity;      /* entries that there is room for */
};

static asj_status get(asj_context *context, struct asj_cl_scan **scan)
{
    if (!context->cl->scan)
        context->cl->scan = asj_allocate_zero(&context->memory, 1, sizeof *context->cl->scan);
    *scan = context->cl->scan;
    return *scan ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the rays' state on the device");
}

void asj_cl_free_scan(asj_context *context)
{
    struct asj_cl_scan *scan = context->cl->scan;
    if (!scan)
        return;
    asj_cl_buffer *const buffers[] = {&scan->rays, &scan->known, &scan->asked, &scan->entries, &scan->branches, &scan->counts};
    for (size_t i = 0; i < sizeof buffers / sizeof buffers[0]; i++)
        asj_cl_release(context, buffers[i]);
    asj_cl_table_free(context, &scan->field);
    asj_cl_table_free(context, &scan->angles);
    asj_release(&context->memory, scan->host_rays.memory);
    asj_release(&context->memory, scan);
    context->cl->scan = NULL;
}

/* ---- tables ---- */

static asj_status load_angles(asj_context *context, asj_cl_table *table, const asj_scan *scan)
{
    const size_t numbers = 2 * (ASJ_SCAN_TABLE_RADIUS * ASJ_SCAN_TABLE_WIDTH + SCAN_UNITS);
    int32_t *next;
    asj_status status = asj_cl_table_begin(context, table, numbers, &next);
    if (status != ASJ_OK)
        return status;
    for (int32_t r = 0; r < ASJ_SCAN_TABLE_RADIUS; r++)
        for (int32_t d = 0; d < ASJ_SCAN_TABLE_WIDTH; d++) {
            *next++ = scan->arc_cosine[r][d];
            *next++ = scan->arc_sine[r][d];
        }
    for (int32_t i = 0; i < SCAN_UNITS; i++) {
        *next++ = scan->unit[i][0];
        *next++ = scan->unit[i][1];
    }
    return asj_cl_table_end(context, table, numbers);
}

static void fill_field(const asj_field *field, int32_t *next)
{
    const asj_sectors *s = &field->sectors;
    const asj_sector_plan *plan = &field->plan;
    for (int32_t i = 0; i < s->offset_count; i++) {
        const asj_direction u = asj_sector_direction(s, i);
        next[OFFSET_DX] = s->dx[i];
        next[OFFSET_DY] = s->dy[i];
        next[OFFSET_X] = u.x;
        next[OFFSET_Y] = u.y;
        next[OFFSET_CROSS_X] = u.cross_x;
        next[OFFSET_DOT_Y] = u.dot_y;
        next += SCAN_OFFSET_INTS;
    }
    for (int32_t j = 0; j < plan->plain_count; j++)
        *next++ = plan->boundary[j];
    for (int32_t j = 0; j < plan->slot_count - plan->plain_count; j++)
        *next++ = plan->extra[j];
    for (int32_t k = 0; k < s->count; k++) {
        next[SECTOR_LOW] = plan->low[k];
        next[SECTOR_HIGH] = plan->high[k];
        next[SECTOR_MEAN] = s->mean[k];
        next[SECTOR_SCALE] = s->scale[k];
        next[SECTOR_LEAST] = field->keep[k];
        next += FIELD_SECTOR_INTS;
    }
}

/* *changed: another field than before. */
static asj_status load_field(asj_context *context, asj_cl_table *table, const asj_field *field, int32_t *changed)
{
    const size_t count = SCAN_OFFSET_INTS * (size_t)field->sectors.offset_count + (size_t)field->plan.slot_count +
                         FIELD_SECTOR_INTS * (size_t)field->sectors.count;
    int32_t *numbers;
    asj_status status = asj_cl_table_begin(context, table, count, &numbers);
    if (status != ASJ_OK)
        return status;
    fill_field(field, numbers);
    *changed = table->held_count != count || memcmp(table->held, numbers, count * sizeof *numbers) != 0;
    return asj_cl_table_end(context, table, count);
}

/* ---- rays ---- */

static asj_status send_rays(asj_context *context, struct asj_cl_scan *state, const asj_ray *rays, size_t count)
{
    asj_status status = asj_cl_host_reserve(context, &state->host_rays, count * sizeof(scan_ray));
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &state->rays, count * sizeof(scan_ray));
    if (status != ASJ_OK)
        return status;
    scan_ray *to = state->host_rays.memory;
    for (size_t i = 0; i < count; i++) {
        memset(&to[i], 0, sizeof to[i]);
        const asj_ray_direction way = asj_ray_walk_direction(&rays[i]);
        to[i].x = way.x;
        to[i].y = way.y;
        to[i].ux = (int32_t)way.ux;
        to[i].uy = (int32_t)way.uy;
        to[i].angle = way.angle;
        to[i].radius = rays[i].start > 0 ? rays[i].start : 1;
    }
    return asj_cl_write(context, &state->rays, 0, to, count * sizeof(scan_ray));
}

static asj_status fetch_rays(asj_context *context, const asj_scan *scan, struct asj_cl_scan *state, asj_ray *rays, size_t count)
{
    const scan_ray *from = state->host_rays.memory;
    asj_status status = asj_cl_read(context, &state->rays, 0, state->host_rays.memory, count * sizeof(scan_ray));
    for (size_t i = 0; i < count && status == ASJ_OK; i++) {
        rays[i].forward = from[i].forward;
        rays[i].axial = from[i].axial;
        asj_ray_walk_finish(scan, &rays[i]);
    }
    return status;
}

/* ---- local junctions ---- */

static asj_status forget(asj_context *context, struct asj_cl_scan *state, size_t runs)
{
    const uint32_t none[3] = {0, 0, 0};
    state->done = 0;
    asj_status status = asj_cl_reserve(context, &state->known, runs * sizeof(uint32_t));
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &state->asked, runs * sizeof(uint32_t));
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &state->entries, runs * sizeof(uint32_t));
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &state->counts, sizeof none);
    if (status == ASJ_OK)
        status = asj_cl_write(context, &state->counts, 0, none, sizeof none);
    if (status == ASJ_OK)
        status = asj_cl_zero(context, &state->known, 0, runs * sizeof(uint32_t));
    return status == ASJ_OK ? asj_cl_zero(context, &state->asked, 0, runs * sizeof(uint32_t)) : status;
}

/* Room for `count` entries; when it grows, all of them are to be computed again. */
static asj_status make_room(asj_context *context, struct asj_cl_scan *state, size_t count, size_t runs)
{
    const size_t entry = ASJ_LANES * ASJ_FIELD_BRANCHES * sizeof(uint32_t), least = runs / 8 > 1024 ? runs / 8 : 1024;
    if (count <= state->capacity)
        return ASJ_OK;
    size_t capacity = 2 * count > least ? 2 * count : least;
    capacity = capacity < runs ? capacity : runs;
    state->capacity = 0;
    state->done = 0;
    asj_status status = asj_cl_reserve(context, &state->branches, capacity * entry);
    if (status == ASJ_OK)
        state->capacity = (uint32_t)capacity;
    return status;
}

#define COMPUTE_ARGUMENTS                                                                                                     \
    ASJ_CL_BUFFER(&detect->gradient_x), ASJ_CL_BUFFER(&detect->gradient_y), ASJ_CL_INT(frame->stride), ASJ_CL_INT(base),      \
        ASJ_CL_INT(frame->blocks), ASJ_CL_BUFFER(&state->field.buffer), ASJ_CL_STRUCT(&sizes, sizeof sizes),                  \
        ASJ_CL_BUFFER(&state->entries), ASJ_CL_INT(first), ASJ_CL_INT(end), ASJ_CL_BUFFER(&state->branches),                  \
        ASJ_CL_BUFFER(&state->known)

/* Entries first .. end - 1. `base`: the row of the image that the planes begin with, from the one that run 0 is in. */
static asj_status run_entries(asj_context *context, struct asj_cl_scan *state, const asj_field *field, const asj_frame *frame,
                              int32_t base, uint32_t first, uint32_t end)
{
    const struct asj_cl_detect *detect = context->cl->detect;
    const scan_sizes sizes = {.radius = field->sectors.radius, .sectors = field->sectors.count, .suppress = field->suppress,
                              .offsets = field->sectors.offset_count, .plain_slots = field->plan.plain_count,
                              .slots = field->plan.slot_count};
    const size_t entries = end - first, pixels = 64, memory = pixels * (size_t)sizes.slots * sizeof(uint16_t);
    const asj_cl_argument runs[] = {COMPUTE_ARGUMENTS}, by_pixels[] = {COMPUTE_ARGUMENTS, ASJ_CL_LOCAL(memory)};
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    const int by_pixel = limits->type != ASJ_DEVICE_CPU && memory <= limits->local_memory;
    const size_t local = by_pixel ? pixels : GROUP, items = by_pixel ? entries * ASJ_LANES : entries;
    const size_t global = (items + local - 1) / local * local;
    return by_pixel ? asj_cl_run(context, "scan_pixels", 1, &global, &local, ASJ_CL_ARGUMENTS(by_pixels))
                    : asj_cl_run(context, "scan_runs", 1, &global, &local, ASJ_CL_ARGUMENTS(runs));
}

/* Runs of the rows that rays are walked in. */
static size_t runs_of(const struct asj_cl_scan *state, const asj_frame *frame)
{
    return (size_t)frame->blocks * (size_t)(state->high - state->low);
}

/* All entries up to `count` that have no branches yet. */
static asj_status compute(asj_context *context, struct asj_cl_scan *state, const asj_field *field, const asj_frame *frame,
                          uint32_t count)
{
    asj_status status = make_room(context, state, count, runs_of(state, frame));
    if (status == ASJ_OK)
        status = run_entries(context, state, field, frame, context->cl->detect->first - state->low, state->done, count);
    if (status == ASJ_OK)
        state->done = count;
    return status;
}

/* ---- local junctions everywhere: rows of runs, all asked for in order ---- */

static asj_status list_runs(asj_context *context, struct asj_cl_scan *state, size_t runs)
{
    asj_status status = asj_cl_host_reserve(context, &state->host_rays, runs * sizeof(uint32_t));
    uint32_t *entries = state->host_rays.memory;
    for (size_t i = 0; i < runs && status == ASJ_OK; i++)
        entries[i] = (uint32_t)i;
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &state->entries, runs * sizeof(uint32_t));
    return status == ASJ_OK ? asj_cl_write(context, &state->entries, 0, entries, runs * sizeof(uint32_t)) : status;
}

/* The device writes words, whatever the order of the bytes in them. */
static void unpack(asj_field_branch *branches, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        uint32_t word;
        memcpy(&word, &branches[i], sizeof word);
        branches[i].angle = (uint16_t)word;
        branches[i].strength = (uint16_t)(word >> 16);
    }
}

/* Rows that fit at once. */
static asj_status make_branches(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                                asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    const size_t rows = (size_t)(bottom - top), runs = (size_t)frame->blocks * rows, pixel = sizeof *branches;
    struct asj_cl_scan *state;
    int32_t changed;
    asj_status status = get(context, &state);
    if (status != ASJ_OK)
        return status;
    state->generation = 0; /* the rays' entries go, .. */
    state->capacity = 0;   /* .. and buffers may be gone when one of them cannot be made */
    status = asj_cl_planes_need(context, frame, top, bottom);
    if (status == ASJ_OK)
        status = load_field(context, &state->field, field, &changed);
    if (status == ASJ_OK)
        status = list_runs(context, state, runs);
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &state->known, runs * sizeof(uint32_t));
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &state->branches, runs * ASJ_LANES * pixel);
    if (status == ASJ_OK)
        status = run_entries(context, state, field, frame, context->cl->detect->first - top, 0, (uint32_t)runs);
    if (status == ASJ_OK)
        status = asj_cl_read_rows(context, &state->branches, 0, (size_t)frame->blocks * ASJ_LANES * pixel, branches,
                                  (size_t)frame->width * pixel, (size_t)frame->width * pixel, rows);
    if (status == ASJ_OK)
        unpack(branches[0], rows * (size_t)frame->width * ASJ_FIELD_BRANCHES);
    return status;
}

/* Rows of local junctions that the device has room for. */
static int32_t branches_rows(const asj_context *context, const asj_frame *frame)
{
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    const uint64_t share = limits->global_memory / 4, most = share < limits->largest_buffer ? share : limits->largest_buffer;
    const uint64_t rows = most / ((uint64_t)frame->blocks * ASJ_LANES * ASJ_FIELD_BRANCHES * sizeof(uint32_t));
    const int32_t planes = asj_cl_plane_rows(context, frame) - 2 * ASJ_MARGIN;
    return rows < (uint64_t)(planes > 0 ? planes : 0) ? (int32_t)rows : planes;
}

asj_status asj_cl_field_branches(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                                 const asj_scratch *scratch, asj_field_branch (*branches)[ASJ_FIELD_BRANCHES])
{
    const int32_t band = branches_rows(context, frame);
    asj_status status = ASJ_OK;
    if (band < 1)
        return asj_field_branches(context, field, frame, top, bottom, scratch, branches);
    for (int32_t y = top; y < bottom && status == ASJ_OK; y += band)
        status = make_branches(context, field, frame, y, bottom - y < band ? bottom : y + band,
                               branches + (size_t)(y - top) * (size_t)frame->width);
    return status;
}

/* ---- walking ---- */

/* Walks as far as all rays can; counts: entries, rays that go on, rays that wait for another band. */
static asj_status walk(asj_context *context, struct asj_cl_scan *state, const scan_image *image, size_t count, uint32_t counts[3])
{
    const size_t local = GROUP, global = (count + local - 1) / local * local;
    const struct asj_cl_detect *detect = context->cl->detect;
    const asj_cl_argument arguments[] = {
        ASJ_CL_BUFFER(&detect->gradient_x), ASJ_CL_BUFFER(&detect->gradient_y), ASJ_CL_STRUCT(image, sizeof *image),
        ASJ_CL_BUFFER(&state->angles.buffer), ASJ_CL_BUFFER(&state->rays), ASJ_CL_INT(count), ASJ_CL_BUFFER(&state->known),
        ASJ_CL_BUFFER(&state->branches), ASJ_CL_BUFFER(&state->asked), ASJ_CL_BUFFER(&state->entries),
        ASJ_CL_BUFFER(&state->counts)};
    asj_status status = asj_cl_zero(context, &state->counts, sizeof(uint32_t), 2 * sizeof(uint32_t));
    if (status == ASJ_OK)
        status = asj_cl_run(context, "scan_walk", 1, &global, &local, ASJ_CL_ARGUMENTS(arguments));
    return status == ASJ_OK ? asj_cl_read(context, &state->counts, 0, counts, 3 * sizeof *counts) : status;
}

/* Planes and tables for a band, and what is known already. */
static asj_status prepare(asj_context *context, struct asj_cl_scan *state, const asj_scan *scan, const asj_frame *frame,
                          int32_t low, int32_t high)
{
    int32_t changed = 0;
    asj_status status = asj_cl_planes_need(context, frame, low, high);
    if (status == ASJ_OK)
        status = load_angles(context, &state->angles, scan);
    if (status == ASJ_OK)
        status = load_field(context, &state->field, scan->field, &changed);
    if (status != ASJ_OK || (!changed && state->generation == context->cl->detect->generation && state->low == low &&
                             state->high == high))
        return status;
    state->generation = 0;
    state->low = low;
    state->high = high;
    status = forget(context, state, runs_of(state, frame));
    if (status == ASJ_OK)
        status = make_room(context, state, 1, runs_of(state, frame));
    if (status == ASJ_OK)
        state->generation = context->cl->detect->generation;
    return status;
}

/* Walks all rays to their ends, or to that of the band; *waiting: how many wait for another one. */
static asj_status scan_band(asj_context *context, struct asj_cl_scan *state, const asj_scan *scan, const asj_frame *frame,
                            int32_t low, int32_t high, size_t count, uint32_t *waiting)
{
    uint32_t counts[3] = {0, 1, 0};
    asj_watch watch;
    asj_status status = prepare(context, state, scan, frame, low, high);
    const scan_image image = {
        .width = frame->width, .height = frame->height, .blocks = frame->blocks, .half_width = scan->half_width,
        .tolerance = scan->tolerance, .axial = scan->axial, .rough = scan->rough,
        .bridge = scan->axial ? scan->field->sectors.radius : -1, .threshold = scan->threshold,
        .ahead = asj_cl_get_limits(context)->type == ASJ_DEVICE_CPU ? 4 : 32, .edge = ASJ_SCAN_EDGE,
        .stride = (int32_t)frame->stride, .base = status == ASJ_OK ? context->cl->detect->first : 0, .low = low, .high = high};
    asj_watch_start(&watch, context, ASJ_STAGE_SCAN);
    while (status == ASJ_OK && counts[1] > 0) {
        status = asj_watch_stops(&watch, NULL) ? asj_watch_end(&watch) : walk(context, state, &image, count, counts);
        if (status == ASJ_OK && counts[0] > state->done)
            status = compute(context, state, scan->field, frame, counts[0]);
    }
    *waiting = counts[2];
    return status;
}

/* Bands of `rows` rows, from top to bottom, back, and so on. */
static asj_status scan_bands(asj_context *context, struct asj_cl_scan *state, const asj_scan *scan, const asj_frame *frame,
                             int32_t rows, size_t count, uint32_t *waiting)
{
    const int32_t step = rows - OVERLAP, bands = frame->height > rows ? (frame->height - rows + step - 1) / step + 1 : 1;
    asj_status status = ASJ_OK;
    *waiting = 1;
    for (int32_t sweep = 0; sweep < SWEEPS && *waiting > 0; sweep++)
        for (int32_t i = 0; i < bands && *waiting > 0 && status == ASJ_OK; i++) {
            const int32_t low = (sweep % 2 ? bands - 1 - i : i) * step;
            const int32_t high = frame->height - low < rows ? frame->height : low + rows;
            status = scan_band(context, state, scan, frame, low, high, count, waiting);
        }
    return status;
}

asj_status asj_cl_scan_rays(asj_context *context, const asj_scan *scan, const asj_frame *frame, const asj_scratch *scratch,
                            asj_ray *rays, size_t count)
{
    const int32_t rows = branches_rows(context, frame);
    struct asj_cl_scan *state;
    uint32_t waiting;
    if (count == 0)
        return ASJ_OK;
    if (scan->longest > 0 || count > INT32_MAX / 2 || (rows < frame->height && rows <= OVERLAP))
        return asj_scan_rays(context, scan, frame, scratch, rays, count);
    asj_status status = get(context, &state);
    if (status != ASJ_OK)
        return status;
    status = send_rays(context, state, rays, count);
    if (status == ASJ_OK)
        status = scan_bands(context, state, scan, frame, rows, count, &waiting);
    if (status != ASJ_OK)
        state->generation = 0; /* whatever there is may be half done */
    else if (waiting > 0)
        return asj_scan_rays(context, scan, frame, scratch, rays, count);
    return status == ASJ_OK ? fetch_rays(context, scan, state, rays, count) : status;
}
