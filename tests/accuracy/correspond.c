/* SPDX-License-Identifier: BSD-2-Clause */
#include "correspond.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

typedef struct pair {
    double distance;
    uint32_t first, second;
} pair;

correspond_map correspond_scaling(double sx, double sy)
{
    const correspond_map map = {sx, sy, 0.5 * sx - 0.5, 0.5 * sy - 0.5};
    return map;
}

static double angle_distance(double a, double b)
{
    const double d = fmod(fabs(a - b), 2.0 * PI);
    return d > PI ? 2.0 * PI - d : d;
}

/* Is there a branch of `to` that agrees with `branch` in angle, in length, or in both at once? */
static int has_branch(const asj_branch *branch, const asj_junction *to, double scale, int angle, int length)
{
    for (int32_t i = 0; i < to->branch_count; i++)
        if ((!angle || angle_distance((double)branch->angle, (double)to->branches[i].angle) < PI / 20.0) &&
            (!length || fabs(scale * (double)branch->length - (double)to->branches[i].length) < 3.0))
            return 1;
    return 0;
}

int correspond_fault(const asj_junction *a, const asj_junction *b, double scale)
{
    int fault = a->branch_count == b->branch_count ? CORRESPOND_AGREES : CORRESPOND_BRANCHES;
    for (int32_t i = 0; i < a->branch_count && fault == CORRESPOND_AGREES; i++)
        fault = has_branch(&a->branches[i], b, scale, 1, 0) ? fault : CORRESPOND_ANGLES;
    for (int32_t i = 0; i < a->branch_count && fault == CORRESPOND_AGREES; i++)
        fault = has_branch(&a->branches[i], b, scale, 0, 1) ? fault : CORRESPOND_LENGTHS;
    return fault;
}

static int agree(const asj_junction *a, const asj_junction *b, double scale, int criterion)
{
    if (criterion == CORRESPOND_PLACE)
        return 1;
    if (criterion == CORRESPOND_WHOLE)
        return correspond_fault(a, b, scale) == CORRESPOND_AGREES;
    if (a->branch_count != b->branch_count)
        return 0;
    for (int32_t i = 0; i < a->branch_count; i++)
        if (!has_branch(&a->branches[i], b, scale, 1, 1))
            return 0;
    return 1;
}

static int compare_pairs(const void *a, const void *b)
{
    const pair *p = a, *q = b;
    if (p->distance != q->distance)
        return p->distance < q->distance ? -1 : 1;
    return p->first != q->first ? (p->first > q->first) - (p->first < q->first) : (p->second > q->second) - (p->second < q->second);
}

static size_t list_pairs(const correspond_list *image, const correspond_list *copy, const correspond_map *map, int criterion,
                         pair *pairs)
{
    size_t count = 0;
    for (uint32_t i = 0; i < image->count; i++)
        for (uint32_t k = 0; k < copy->count; k++) {
            const asj_junction *a = &image->junctions[i], *b = &copy->junctions[k];
            const double x = (double)a->x * map->sx + map->tx, y = (double)a->y * map->sy + map->ty;
            const double distance = hypot(x - (double)b->x, y - (double)b->y);
            if (distance < CORRESPOND_DISTANCE && agree(a, b, 0.5 * (map->sx + map->sy), criterion))
                pairs[count++] = (pair){distance, i, k};
        }
    qsort(pairs, count, sizeof *pairs, compare_pairs);
    return count;
}

int32_t correspond(const correspond_list *image, const correspond_list *copy, const correspond_map *map, int criterion,
                   uint32_t *partner)
{
    pair *pairs = malloc(((size_t)image->count * copy->count + 1) * sizeof *pairs);
    uint8_t *taken = calloc((size_t)image->count + copy->count + 1, 1);
    int32_t found = pairs && taken ? 0 : -1;
    const size_t count = found == 0 ? list_pairs(image, copy, map, criterion, pairs) : 0;
    for (uint32_t i = 0; partner && i < image->count; i++)
        partner[i] = UINT32_MAX;
    for (size_t i = 0; i < count; i++) {
        uint8_t *first = &taken[pairs[i].first], *second = &taken[image->count + pairs[i].second];
        if (*first || *second)
            continue;
        *first = *second = 1;
        found++;
        if (partner)
            partner[pairs[i].first] = pairs[i].second;
    }
    free(pairs);
    free(taken);
    return found;
}
