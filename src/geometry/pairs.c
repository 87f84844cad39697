/* SPDX-License-Identifier: BSD-2-Clause */
/* Candidates as the geometry works on them. Of many thousand the likeliest 3000 are looked at: on wide pairs of rooms all of them
 * (up to 30 000) give the same poses within what the seed changes. */
#include "pairs.h"
#include "core/angle.h"
#include "core/number_text.h"
#include "core/sort.h"
#include "elementary.h"
#include "geometry_options.h"
#include "labels.h"
#include "manhattan.h"
#include "near.h"
#include "ratios.h"

#include <math.h>
#include <string.h>

#define FARTHEST 1e6       /* px */
#define MOST_COUNT 0x1000000
#define DIGIT 11 /* bits */
#define MOST_OF_PLACE 0.9  /* nothing is sure before geometry */

static asj_status check_candidate(asj_context *context, const asj_geometry_candidate *c, size_t k)
{
    const double location[4] = {c->x1, c->y1, c->x2, c->y2};
    const double det = c->affine[0] * c->affine[3] - c->affine[1] * c->affine[2];
    for (int32_t i = 0; i < 4; i++) {
        if (!(fabs(location[i]) <= FARTHEST))
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "candidate %zu lies at %s, %s and %s, %s, farther than %s px", k,
                            ASJ_TEXT(c->x1), ASJ_TEXT(c->y1), ASJ_TEXT(c->x2), ASJ_TEXT(c->y2), ASJ_TEXT(FARTHEST));
        if (!(fabs(c->affine[i]) <= FARTHEST))
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "the map of candidate %zu has %s", k, ASJ_TEXT(c->affine[i]));
    }
    if (!(det > 1e-6))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the map of candidate %zu mirrors or flattens: its determinant is %s", k,
                        ASJ_TEXT(det));
    if (!(c->probability >= 0 && c->probability <= 1))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "candidate %zu has the probability %s", k, ASJ_TEXT(c->probability));
    if (c->place1 >= MOST_COUNT || c->place2 >= MOST_COUNT)
        return asj_fail(context, ASJ_ERROR_LIMIT, "candidate %zu has a place beyond %d", k, MOST_COUNT);
    return ASJ_OK;
}

static int likelier(const void *left, const void *right)
{
    const asj_pair *p = left, *q = right;
    if (p->prior != q->prior)
        return p->prior > q->prior ? -1 : 1;
    return p->source < q->source ? -1 : p->source > q->source;
}

/* New numbers for the places of one image that are left, in order of their old ones. */
static asj_status number_places(asj_context *context, asj_pairs *set, int32_t side)
{
    uint32_t largest = 0, next = 0;
    for (int32_t k = 0; k < set->count; k++) {
        const uint32_t place = side == 0 ? set->list[k].place1 : set->list[k].place2;
        largest = place > largest ? place : largest;
    }
    uint32_t *number = asj_allocate_zero(&context->memory, (size_t)largest + 1, sizeof *number);
    if (!number)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %lu places", (unsigned long)largest + 1);
    for (int32_t k = 0; k < set->count; k++)
        number[side == 0 ? set->list[k].place1 : set->list[k].place2] = 1;
    for (uint32_t p = 0; set->count > 0 && p <= largest; p++)
        if (number[p])
            number[p] = next++;
    for (int32_t k = 0; k < set->count; k++) {
        uint32_t *place = side == 0 ? &set->list[k].place1 : &set->list[k].place2;
        *place = number[*place];
    }
    asj_release(&context->memory, number);
    set->place_count[side] = (int32_t)next;
    set->prior[side] = asj_allocate_zero(&context->memory, next, sizeof *set->prior[side]);
    set->log_rest[side] = asj_allocate_zero(&context->memory, next, sizeof *set->log_rest[side]);
    return set->prior[side] && set->log_rest[side]
               ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %lu places", (unsigned long)next);
}

static void sum_priors(asj_pairs *set)
{
    for (int32_t v = 0; v < 2; v++)
        memset(set->prior[v], 0, (size_t)set->place_count[v] * sizeof *set->prior[v]);
    for (int32_t k = 0; k < set->count; k++) {
        set->prior[0][set->list[k].place1] += set->list[k].prior;
        set->prior[1][set->list[k].place2] += set->list[k].prior;
    }
}

static void limit_priors(asj_pairs *set)
{
    sum_priors(set);
    for (int32_t k = 0; k < set->count; k++) {
        asj_pair *c = &set->list[k];
        const double most = fmax(set->prior[0][c->place1], set->prior[1][c->place2]);
        c->prior *= most > MOST_OF_PLACE ? MOST_OF_PLACE / most : 1;
    }
    sum_priors(set);
    for (int32_t v = 0; v < 2; v++) {
        set->empty[v] = 0;
        for (int32_t p = 0; p < set->place_count[v]; p++)
            set->empty[v] += set->log_rest[v][p] = log(1 - set->prior[v][p]);
    }
}

static void set_scales(const asj_geometry_options *options, asj_pairs *set)
{
    const double w1 = options->widths[0], h1 = options->heights[0], w2 = options->widths[1], h2 = options->heights[1];
    set->location_sd = options->location_sd;
    set->angle_sd = options->angle_sd * ASJ_DEGREE;
    set->scale_sd = options->scale_sd;
    set->spread = 0.2 * (sqrt(w1 * w1 + h1 * h1) + sqrt(w2 * w2 + h2 * h2)); /* 0.4 of the diagonal: 300 px at 624 x 460 */
    for (int32_t v = 0; v < 2; v++) {
        set->middle[v][0] = 0.5 * (options->widths[v] - 1);
        set->middle[v][1] = 0.5 * (options->heights[v] - 1);
    }
    set->area = sqrt(w1 * h1) * sqrt(w2 * h2);
}

/* The caller's directions, with cameras, or else the images'; and what branches point along. */
static asj_status set_rotations(asj_context *context, const asj_geometry_options *options, const asj_geometry_hints *hints,
                                asj_pairs *set)
{
    asj_directions_list given[2] = {{.count = 0}, {.count = 0}};
    for (int32_t v = 0; v < 2 && asj_cameras_are_known(options); v++)
        asj_directions_given(options->directions[v], &given[v]);
    const int32_t from_caller = given[0].count > 0 || given[1].count > 0 || !hints;
    const asj_directions_list *directions = from_caller ? given : hints->directions;
    if (hints && hints->branches && asj_cameras_are_known(options))
        asj_set_labels(set, hints->branches, directions, options->cameras);
    return asj_manhattan_rotations(&context->memory, directions, set)
               ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the rotations of the geometry");
}

static asj_status order_rotations(asj_context *context, asj_pairs *set)
{
    return asj_order_rotations(&context->memory, set)
               ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the labels of %ld candidates", (long)set->count);
}

static asj_status check_candidates(asj_context *context, const asj_geometry_candidate *candidates, size_t count)
{
    if (count > MOST_COUNT)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%zu candidates are more than %d", count, MOST_COUNT);
    asj_status status = ASJ_OK;
    for (size_t k = 0; k < count && status == ASJ_OK; k++)
        status = check_candidate(context, &candidates[k], k);
    return status;
}

/* A probability that ASJ_MOST_PAIRS candidates have or exceed, and hardly any more: so few need be sorted. Bits of positive numbers
 * rise with them; DIGIT at a time, the candidates of each value are counted. */
static double least_probability(const asj_geometry_candidate *candidates, size_t count)
{
    uint64_t least = 0;
    size_t above = 0; /* candidates that exceed it for sure */
    for (int32_t shift = 64 - 1 - DIGIT; shift >= 64 - 1 - 3 * DIGIT && count > ASJ_MOST_PAIRS; shift -= DIGIT) {
        uint32_t number[1 << DIGIT] = {0};
        uint64_t digit = (1 << DIGIT) - 1;
        for (size_t k = 0; k < count; k++) {
            const double p = candidates[k].probability;
            const uint64_t bits = p > 0 ? asj_bits_of(p) : 0;
            if (bits >> (shift + DIGIT) == least >> (shift + DIGIT))
                number[bits >> shift & ((1 << DIGIT) - 1)]++;
        }
        for (; digit > 0 && above + number[digit] < ASJ_MOST_PAIRS; digit--)
            above += number[digit];
        least |= digit << shift;
    }
    return asj_double_of(least);
}

asj_status asj_pairs_create(asj_context *context, const asj_geometry_candidate *candidates, size_t count,
                            const asj_geometry_hints *hints, const asj_geometry_options *options, asj_pairs *set)
{
    const double *colours = hints ? hints->colours : NULL;
    memset(set, 0, sizeof *set);
    const asj_status usable_all = check_candidates(context, candidates, count);
    if (usable_all != ASJ_OK)
        return usable_all;
    set->list = asj_allocate_zero(&context->memory, count, sizeof *set->list);
    if (!set->list)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu candidates", count);
    const double least = least_probability(candidates, count);
    size_t kept = 0;
    for (size_t k = 0; k < count; k++) {
        const asj_geometry_candidate *c = &candidates[k];
        if (c->probability < least)
            continue;
        set->list[kept++] = (asj_pair){c->x1, c->y1, c->x2, c->y2, {c->affine[0], c->affine[1], c->affine[2], c->affine[3]},
                                  c->probability, c->place1, c->place2, (uint32_t)k, colours ? (float)colours[k] : 0, {{{0}}}};
    }
    if (kept > 1)
        asj_sort(set->list, kept, sizeof *set->list, likelier);
    set->count = (int32_t)(kept < ASJ_MOST_PAIRS ? kept : ASJ_MOST_PAIRS);
    while (set->count > 0 && !(set->list[set->count - 1].prior > 0))
        set->count--;
    set->has_colours = colours != NULL;
    set_scales(options, set);
    asj_status status = set_rotations(context, options, hints, set);
    for (int32_t v = 0; v < 2 && status == ASJ_OK; v++)
        status = number_places(context, set, v);
    if (status != ASJ_OK)
        return status;
    limit_priors(set);
    if (set->has_labels)
        status = order_rotations(context, set);
    if (status != ASJ_OK)
        return status;
    set->ratio = context->ops->ratio;
    return asj_near_prepare(&context->memory, context->ops->near, set)
               ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %lu candidates", (unsigned long)set->count);
}

asj_status asj_pairs_turn(asj_context *context, const asj_directions_list directions[2], const double *branches,
                          const asj_camera cameras[2], double log_share, asj_pairs *set)
{
    asj_release(&context->memory, set->rotations);
    set->rotations = NULL;
    set->has_labels = set->has_down = 0;
    if (branches)
        asj_set_labels(set, branches, directions, cameras);
    if (!asj_manhattan_rotations(&context->memory, directions, set))
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the rotations of the geometry");
    for (int32_t k = 0; k < set->rotation_count; k++) {
        asj_likely_rotation *r = &set->rotations[k];
        r->log_share += log_share;
        for (int32_t n = 0; n < ASJ_ROTATION_SIZES; n++)
            r->log_top[n] += log_share;
    }
    return branches ? order_rotations(context, set) : ASJ_OK;
}

void asj_pairs_free(asj_memory *memory, asj_pairs *set)
{
    asj_release(memory, set->list);
    asj_release(memory, set->at);
    asj_release(memory, set->rotations);
    for (int32_t v = 0; v < 2; v++) {
        asj_release(memory, set->prior[v]);
        asj_release(memory, set->log_rest[v]);
    }
    memset(set, 0, sizeof *set);
}
