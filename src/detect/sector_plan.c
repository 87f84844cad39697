/* SPDX-License-Identifier: BSD-2-Clause */
/* Planes and slots of a plan: which gammas are shared, which partial sums are needed. */
#include "sector_plan.h"

#include <stdlib.h>
#include <string.h>

static asj_status make_room(asj_memory *memory, const asj_sectors *s, asj_sector_plan *plan)
{
    const size_t offsets = (size_t)s->offset_count, sectors = (size_t)s->count;
    plan->memory = asj_allocate_zero(memory, 8 * offsets + 3 * sectors + 1, sizeof(int16_t));
    if (!plan->memory)
        return ASJ_ERROR_MEMORY;
    plan->a = plan->memory;
    plan->b = plan->a + offsets;
    plan->used[0] = plan->b + offsets;
    plan->used[1] = plan->used[0] + offsets;
    plan->plane = plan->used[1] + offsets;
    plan->boundary = plan->plane + offsets;
    plan->extra = plan->boundary + offsets + 1;
    plan->low = plan->extra + sectors;
    plan->high = plan->low + sectors;
    plan->steps = (int16_t(*)[2])(plan->high + sectors);
    return ASJ_OK;
}

static int16_t find_family(asj_sector_plan *plan, int16_t a, int16_t b)
{
    int16_t f = 0;
    while (f < plan->family_count && (plan->a[f] != a || plan->b[f] != b))
        f++;
    if (f == plan->family_count) {
        plan->a[f] = a;
        plan->b[f] = b;
        plan->family_count++;
    }
    return f;
}

static void assign_planes(const asj_sectors *s, asj_sector_plan *plan)
{
    for (int32_t i = 0; i < s->offset_count; i++) {
        const int16_t ux = (int16_t)abs(s->ux[i]), uy = (int16_t)abs(s->uy[i]);
        const int mirrored = (s->ux[i] < 0) != (s->uy[i] < 0) && ux && uy, steep = uy > ux;
        const int16_t family = steep ? find_family(plan, uy, ux) : find_family(plan, ux, uy);
        const int plane = mirrored ? steep ? 1 : 3 : steep ? 2 : 0;
        int16_t *used = &plan->used[s->dy[i] & 1][family];
        plan->plane[i] = (int16_t)(4 * family + plane);
        *used = (int16_t)(*used | 1 << (plane + 4 * (s->dx[i] & 1)));
    }
}

static int16_t find_slot(const asj_sector_plan *plan, int32_t boundary)
{
    int16_t low = 0, high = (int16_t)(plan->plain_count - 1);
    while (low < high) {
        const int16_t middle = (int16_t)((low + high) / 2);
        if (plan->boundary[middle] < boundary)
            low = (int16_t)(middle + 1);
        else
            high = middle;
    }
    return low;
}

/* The boundaries in order: those that there are are marked in their list first. */
static void list_boundaries(const asj_sectors *s, asj_sector_plan *plan)
{
    const int32_t n = s->offset_count;
    plan->boundary[n] = 1;
    for (int32_t k = 0; k < s->count; k++) {
        const int32_t end = s->first[k] + s->size[k];
        plan->boundary[s->first[k]] = plan->boundary[end > n ? end - n : end] = 1;
    }
    for (int32_t b = 0; b <= n; b++)
        if (plan->boundary[b])
            plan->boundary[plan->plain_count++] = (int16_t)b;
}

static void assign_slots(const asj_sectors *s, asj_sector_plan *plan)
{
    const int32_t n = s->offset_count;
    list_boundaries(s, plan);
    plan->slot_count = plan->plain_count;
    for (int32_t k = 0; k < s->count; k++) {
        int32_t end = s->first[k] + s->size[k];
        plan->low[k] = find_slot(plan, s->first[k]);
        plan->high[k] = end > n ? (int16_t)plan->slot_count : find_slot(plan, end);
        if (end > n)
            plan->extra[plan->slot_count++ - plan->plain_count] = find_slot(plan, end - n);
    }
}

asj_status asj_sector_plan_create(asj_memory *memory, const asj_sectors *s, asj_sector_plan *plan)
{
    memset(plan, 0, sizeof *plan);
    asj_status status = make_room(memory, s, plan);
    if (status != ASJ_OK)
        return status;
    assign_planes(s, plan);
    assign_slots(s, plan);
    return ASJ_OK;
}

void asj_sector_plan_set_steps(const asj_sectors *sectors, const int16_t *places, asj_sector_plan *plan)
{
    for (int32_t i = 0, slot = 0; i < sectors->offset_count; i++) {
        while (plan->boundary[slot] <= i)
            slot++;
        plan->steps[i][0] = (int16_t)(places[i] * ASJ_SECTOR_RUN);
        plan->steps[i][1] = (int16_t)(slot * ASJ_SECTOR_RUN);
    }
}

void asj_sector_plan_free(asj_memory *memory, asj_sector_plan *plan)
{
    asj_release(memory, plan->memory);
    memset(plan, 0, sizeof *plan);
}
