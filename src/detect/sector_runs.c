/* SPDX-License-Identifier: BSD-2-Clause */
/* Runs of a disc: its offsets in pieces of rows, which compilers and vector forms load at once. */
#include "sector_runs.h"

#include <string.h>

/* Half the number of pixels in a row of the disc, without the middle one. */
static int32_t half_row(int32_t radius, int32_t dy)
{
    int32_t dx = 0;
    while ((dx + 1) * (dx + 1) + dy * dy <= radius * radius)
        dx++;
    return dx;
}

/* By bisection: runs stand in the order of their rows, and of their columns in a row. */
static int16_t find_place(const asj_sector_runs *runs, int32_t dx, int32_t dy)
{
    int32_t r = 0, end = runs->count;
    while (end - r > 1) {
        const int32_t middle = (r + end) / 2;
        if (runs->dy[middle] < dy || (runs->dy[middle] == dy && runs->dx[middle] <= dx))
            r = middle;
        else
            end = middle;
    }
    return (int16_t)(r * ASJ_SECTOR_RUN + dx - runs->dx[r]);
}

static void set_factors(const asj_sectors *s, asj_sector_runs *runs)
{
    for (int32_t i = 0; i < s->offset_count; i++) {
        const asj_direction u = asj_sector_direction(s, i);
        const int32_t place = find_place(runs, s->dx[i], s->dy[i]), at = place % ASJ_SECTOR_RUN;
        int16_t(*factors)[ASJ_SECTOR_RUN] = runs->factors + place / ASJ_SECTOR_RUN * 4;
        factors[0][at] = u.x;
        factors[1][at] = u.y;
        factors[2][at] = u.cross_x;
        factors[3][at] = u.dot_y;
    }
}

asj_status asj_sector_runs_create(asj_memory *memory, const asj_sectors *s, asj_sector_runs *runs)
{
    const int32_t radius = s->radius;
    memset(runs, 0, sizeof *runs);
    for (int32_t dy = -radius; dy <= radius; dy++)
        runs->count += (2 * half_row(radius, dy) + ASJ_SECTOR_RUN) / ASJ_SECTOR_RUN;
    const size_t count = (size_t)runs->count;
    runs->memory = asj_allocate_zero(memory, count, 4 * sizeof *runs->factors + 2 * sizeof(int16_t));
    if (!runs->memory)
        return ASJ_ERROR_MEMORY;
    runs->factors = runs->memory;
    runs->dx = (int16_t *)(runs->factors + 4 * count);
    runs->dy = runs->dx + count;
    int32_t r = 0;
    for (int32_t dy = -radius; dy <= radius; dy++)
        for (int32_t dx = -half_row(radius, dy); dx <= half_row(radius, dy); dx += ASJ_SECTOR_RUN, r++) {
            runs->dx[r] = (int16_t)dx;
            runs->dy[r] = (int16_t)dy;
        }
    set_factors(s, runs);
    return ASJ_OK;
}

void asj_sector_runs_free(asj_memory *memory, asj_sector_runs *runs)
{
    asj_release(memory, runs->memory);
    memset(runs, 0, sizeof *runs);
}

void asj_sector_runs_places(const asj_sector_runs *runs, const asj_sectors *sectors, int16_t *places)
{
    for (int32_t i = 0; i < sectors->offset_count; i++)
        places[i] = find_place(runs, sectors->dx[i], sectors->dy[i]);
}

/* Results go to an array that nothing else may overlap: compilers then make a few vector instructions of the inner loop. */
void asj_sector_gammas(const asj_sector_runs *runs, const int16_t *gx, const int16_t *gy, ptrdiff_t stride, uint16_t *gamma)
{
    for (int32_t r = 0; r < runs->count; r++, gamma += ASJ_SECTOR_RUN) {
        const ptrdiff_t at = runs->dy[r] * stride + runs->dx[r];
        int16_t(*const factors)[ASJ_SECTOR_RUN] = runs->factors + 4 * r;
        uint16_t run[ASJ_SECTOR_RUN];
        for (int i = 0; i < ASJ_SECTOR_RUN; i++) {
            const asj_direction u = {factors[0][i], factors[1][i], factors[2][i], factors[3][i]};
            run[i] = asj_sector_gamma(u, gx[at + i], gy[at + i]);
        }
        memcpy(gamma, run, sizeof run);
    }
}
