/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2 on the device (kernels/field.cl). */
#include "kernels/contract.h"
#include "detect.h"
#include "overrides.h"
#include "planes.h"
#include "state.h"

#include <asj/device.h>

#define TILE_ROWS 64 /* pixels of a column for a work item: those above and below that it needs, its neighbours make as well */

static int32_t *add_sectors(const asj_field *field, int32_t *next)
{
    const asj_sectors *s = &field->sectors;
    for (int32_t k = 0; k < s->count; k++) {
        next[SECTOR_LOW] = field->plan.low[k];
        next[SECTOR_HIGH] = field->plan.high[k];
        next[SECTOR_MEAN] = s->mean[k];
        next[SECTOR_SCALE] = s->scale[k];
        next[SECTOR_LEAST] = field->candidate[k];
        next += FIELD_SECTOR_INTS;
    }
    return next;
}

static asj_status load_table(asj_context *context, asj_cl_table *table, const asj_field *field)
{
    const asj_sectors *s = &field->sectors;
    const asj_sector_plan *plan = &field->plan;
    int32_t *numbers, *next;
    const size_t most = 2 * (size_t)plan->family_count + FIELD_OFFSET_INTS * (size_t)s->offset_count + (size_t)plan->slot_count +
                        FIELD_SECTOR_INTS * (size_t)s->count;
    asj_status status = asj_cl_table_begin(context, table, most, &numbers);
    if (status != ASJ_OK)
        return status;
    next = numbers;
    for (int32_t f = 0; f < plan->family_count; f++) {
        *next++ = plan->a[f];
        *next++ = plan->b[f];
    }
    for (int32_t i = 0; i < s->offset_count; i++) {
        const asj_direction u = asj_sector_direction(s, i);
        next[OFFSET_DX] = s->dx[i];
        next[OFFSET_DY] = s->dy[i];
        next[OFFSET_X] = u.x;
        next[OFFSET_Y] = u.y;
        next[OFFSET_CROSS_X] = u.cross_x;
        next[OFFSET_DOT_Y] = u.dot_y;
        next[OFFSET_PLANE] = plan->plane[i];
        next += FIELD_OFFSET_INTS;
    }
    for (int32_t j = 0; j < plan->plain_count; j++)
        *next++ = plan->boundary[j];
    for (int32_t j = 0; j < plan->slot_count - plan->plain_count; j++)
        *next++ = plan->extra[j];
    next = add_sectors(field, next);
    return asj_cl_table_end(context, table, (size_t)(next - numbers));
}

/* What both kernels take first. */
typedef struct launch {
    const asj_frame *frame;
    field_sizes sizes;
    int32_t top, bottom;
} launch;

#define COMMON_ARGUMENTS                                                                                                        \
    ASJ_CL_BUFFER(&detect->gradient_x), ASJ_CL_BUFFER(&detect->gradient_y), ASJ_CL_INT(l->frame->width),                        \
        ASJ_CL_INT(l->frame->stride), ASJ_CL_INT(detect->first), ASJ_CL_INT(l->top), ASJ_CL_INT(l->bottom),                      \
        ASJ_CL_INT(l->frame->blocks), ASJ_CL_BUFFER(&detect->field_table.buffer), ASJ_CL_STRUCT(&l->sizes, sizeof l->sizes),     \
        ASJ_CL_BUFFER(&detect->masks)

/* Vectors of a plane: a row of a tile and what is around it, or its even columns and then as many odd ones. */
static int32_t plane_stride(const field_sizes *s)
{
    const int32_t margin = (s->radius + s->step - 1) / s->step;
    return s->step * ((FIELD_TILE / s->step + 2 * margin + ASJ_LANES - 1) / ASJ_LANES);
}

/* Bytes of local memory of a tile: planes of all rows in reach, slots, strengths. */
static void tile_memory(const field_sizes *s, size_t bytes[3])
{
    const size_t vector = ASJ_LANES * sizeof(int16_t);
    bytes[0] = (size_t)(2 * s->radius + 1) * 4 * (size_t)s->families * (size_t)plane_stride(s) * vector;
    bytes[1] = (size_t)s->slots * FIELD_GROUP * vector;
    bytes[2] = (size_t)(s->sectors + 2 * s->suppress) * FIELD_GROUP * vector;
}

static asj_status run_tiles(asj_context *context, struct asj_cl_detect *detect, const launch *l, const size_t bytes[3])
{
    static const size_t local[2] = {1, 1};
    const size_t rows = (size_t)(l->bottom - l->top);
    const size_t global[2] = {((size_t)l->frame->width + FIELD_TILE - 1) / FIELD_TILE, (rows + TILE_ROWS - 1) / TILE_ROWS};
    const asj_cl_argument arguments[] = {COMMON_ARGUMENTS, ASJ_CL_INT(TILE_ROWS), ASJ_CL_INT(plane_stride(&l->sizes)),
                                         ASJ_CL_LOCAL(bytes[0]), ASJ_CL_LOCAL(bytes[1]), ASJ_CL_LOCAL(bytes[2])};
    return asj_cl_run(context, "field_tiles", 2, global, local, ASJ_CL_ARGUMENTS(arguments));
}

/* Bytes of local memory of columns x rows pixels, `step` apart: gradient, slots, results. */
static void pixel_memory(const field_sizes *s, size_t columns, size_t rows, size_t bytes[3])
{
    const size_t around = 2 * (size_t)s->radius + 1, step = (size_t)s->step;
    bytes[0] = ((columns - 1) * step + around) * ((rows - 1) * step + around) * 2 * sizeof(int16_t);
    bytes[1] = columns * rows * (size_t)s->slots * sizeof(uint16_t);
    bytes[2] = columns * rows;
}

static asj_status run_pixels(asj_context *context, struct asj_cl_detect *detect, const launch *l)
{
    static const size_t sizes[][2] = {{32, 4}, {16, 4}, {16, 2}, {16, 1}};
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    size_t most, choice = 0, bytes[3];
    asj_status status = asj_cl_kernel_limits(context, "field_pixels", &most, NULL);
    if (status != ASJ_OK)
        return status;
    for (;; choice++) {
        pixel_memory(&l->sizes, sizes[choice][0], sizes[choice][1], bytes);
        if (choice == 3 || (bytes[0] + bytes[1] + bytes[2] <= limits->local_memory && sizes[choice][0] * sizes[choice][1] <= most &&
                            sizes[choice][0] <= limits->max_work_item[0] && sizes[choice][1] <= limits->max_work_item[1]))
            break;
    }
    const int32_t step = l->sizes.step, first = (l->top + step - 1) / step; /* at least one work-group, which clears the rest */
    const size_t *local = sizes[choice], columns = ((size_t)l->frame->width + (size_t)step - 1) / (size_t)step;
    const size_t rows = (size_t)((l->bottom + step - 1) / step - first) + (l->bottom <= first * step);
    const size_t global[2] = {(columns + local[0] - 1) / local[0] * local[0], (rows + local[1] - 1) / local[1] * local[1]};
    const asj_cl_argument arguments[] = {COMMON_ARGUMENTS, ASJ_CL_LOCAL(bytes[0]), ASJ_CL_LOCAL(bytes[1]), ASJ_CL_LOCAL(bytes[2])};
    return asj_cl_run(context, "field_pixels", 2, global, local, ASJ_CL_ARGUMENTS(arguments));
}

/* Rows that fit at once. */
static asj_status make_rows(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                            uint16_t *masks)
{
    const size_t count = (size_t)frame->blocks * (size_t)(bottom - top) * sizeof *masks;
    struct asj_cl_detect *detect;
    size_t bytes[3];
    asj_status status = asj_cl_planes_need(context, frame, top, bottom);
    if (status == ASJ_OK)
        status = asj_cl_detect_get(context, &detect);
    if (status == ASJ_OK)
        status = load_table(context, &detect->field_table, field);
    if (status == ASJ_OK)
        status = asj_cl_reserve(context, &detect->masks, count);
    if (status != ASJ_OK)
        return status;
    const launch l = {frame,
                      {.radius = field->sectors.radius, .sectors = field->sectors.count, .suppress = field->suppress,
                       .apart = field->apart, .families = field->plan.family_count, .offsets = field->sectors.offset_count,
                       .plain_slots = field->plan.plain_count, .slots = field->plan.slot_count, .step = field->step},
                      top, bottom};
    const asj_cl_limits *limits = asj_cl_get_limits(context);
    tile_memory(&l.sizes, bytes);
    if (limits->type == ASJ_DEVICE_CPU && bytes[0] + bytes[1] + bytes[2] <= limits->local_memory)
        status = run_tiles(context, detect, &l, bytes);
    else
        status = run_pixels(context, detect, &l);
    if (status == ASJ_OK)
        status = asj_cl_read(context, &detect->masks, 0, masks + (ptrdiff_t)top * frame->blocks, count);
    return status;
}

asj_status asj_cl_field_rows(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                             const asj_scratch *scratch, uint16_t *masks)
{
    const int32_t band = asj_cl_plane_rows(context, frame) - 2 * ASJ_MARGIN;
    asj_status status = ASJ_OK;
    if (band < 1)
        return asj_field_rows(context, field, frame, top, bottom, scratch, masks);
    for (int32_t y = top; y < bottom && status == ASJ_OK; y += band)
        status = make_rows(context, field, frame, y, bottom - y < band ? bottom : y + band, masks);
    return status;
}
