/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, preparation: which L-junctions are part of a T. One of their branches goes on beyond the location, as a branch of another
 * L-junction there; so it may be the edge of something else in front. */
#include "t_junctions.h"
#include "core/angle.h"
#include "core/sort.h"

#include <math.h>

#define OPPOSITE (-0.978147601) /* cosine of 180 - 12 degrees: half the least opening of branches, and less */
#define WITHIN 0.2095 /* rad: 12 degrees and a little more */

static asj_status no_memory(asj_context *context)
{
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the T-junctions of an image");
}

/* A branch of the L-junctions of one location. */
typedef struct spoke {
    double angle; /* rad in [-pi, pi] */
    uint32_t l;
    int32_t branch;
} spoke;

static int by_angle(const void *left, const void *right)
{
    const spoke *p = left, *q = right;
    if (p->angle != q->angle)
        return p->angle < q->angle ? -1 : 1;
    return p->l != q->l ? p->l < q->l ? -1 : 1 : p->branch - q->branch;
}

/* Rising by angle. Thousands of L-junctions may share a location. */
static uint32_t sort_spokes(const asj_l_junctions *all, uint32_t location, spoke *spokes)
{
    uint32_t count = 0;
    for (uint32_t m = all->first_of_location[location]; m < all->first_of_location[location + 1]; m++)
        for (int32_t branch = 0; branch < 2; branch++) {
            const double *v = all->direction + 4 * (size_t)all->l_of_location[m] + 2 * branch;
            spokes[count++] = (spoke){atan2(v[1], v[0]), all->l_of_location[m], branch};
        }
    asj_sort(spokes, count, sizeof *spokes, by_angle);
    return count;
}

/* Does another L-junction of the location have a branch opposite to u? Looked for from OPPOSITE on, which decides by itself. */
static int continues(const asj_l_junctions *all, const spoke *spokes, uint32_t count, uint32_t l, const double u[2])
{
    const double opposite = atan2(-u[1], -u[0]), least = opposite - WITHIN, from = least < -ASJ_PI ? least + ASJ_TWO_PI : least;
    uint32_t low = 0, high = count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (spokes[middle].angle < from)
            low = middle + 1;
        else
            high = middle;
    }
    for (uint32_t k = 0; k < count; k++) {
        const spoke *s = &spokes[(low + k) % count];
        const double *v = all->direction + 4 * (size_t)s->l + 2 * s->branch;
        const double apart = fabs(s->angle - opposite);
        if (apart > WITHIN && apart < ASJ_TWO_PI - WITHIN)
            return 0;
        if (s->l != l && u[0] * v[0] + u[1] * v[1] < OPPOSITE)
            return 1;
    }
    return 0;
}

asj_status asj_t_junctions_find(asj_context *context, asj_l_junctions *all)
{
    uint32_t most = 0;
    for (uint32_t p = 0; p < all->location_count; p++) {
        const uint32_t here = all->first_of_location[p + 1] - all->first_of_location[p];
        most = here > most ? here : most;
    }
    spoke *spokes = asj_allocate(&context->memory, 2 * (size_t)most, sizeof *spokes);
    all->t_junction = asj_allocate(&context->memory, all->count, sizeof *all->t_junction);
    if (!all->t_junction || !spokes) {
        asj_release(&context->memory, spokes);
        return no_memory(context);
    }
    for (uint32_t p = 0; p < all->location_count; p++) {
        const uint32_t count = sort_spokes(all, p, spokes);
        for (uint32_t m = all->first_of_location[p]; m < all->first_of_location[p + 1]; m++) {
            const uint32_t l = all->l_of_location[m];
            const double *u = all->direction + 4 * (size_t)l;
            all->t_junction[l] = continues(all, spokes, count, l, u) != continues(all, spokes, count, l, u + 2);
        }
    }
    asj_release(&context->memory, spokes);
    return ASJ_OK;
}
