/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches at one place in both images: one corner, which several octaves have found.
 *
 * In upsampled images octaves -1 and 0, and those between them, are matched as one (upsampled.c), so a corner may be two locations
 * a fraction of a pixel apart, each with its match. Of 5140 matches of sixteen pairs 101 lie within .25 px of another one in both
 * images, 180 within .5 and 268 within 1 px; as many of a hundred of these are right as of all. The one that looks most alike
 * stays. Which of two looks is the answer is decided before: two that agree are better witnesses than one. */
#include "same_place.h"
#include "core/sort.h"
#include "core/watch.h"

#include <math.h>

#define APART 1.0f /* px, along x and along y */

typedef struct place {
    const asj_junction_match *match;
    size_t number;
} place;

static int by_x1(const void *a, const void *b)
{
    const place *p = a, *q = b;
    if (p->match->x1 < q->match->x1 || p->match->x1 > q->match->x1)
        return p->match->x1 < q->match->x1 ? -1 : 1;
    return p->number < q->number ? -1 : p->number > q->number;
}

static int32_t is_same(const asj_junction_match *a, const asj_junction_match *b)
{
    return fabsf(a->y1 - b->y1) <= APART && fabsf(a->x2 - b->x2) <= APART && fabsf(a->y2 - b->y2) <= APART;
}

static int32_t comes_first(const place *p, const place *q)
{
    const float a = p->match->similarity, b = q->match->similarity;
    return a > b || (a >= b && p->number < q->number);
}

/* Marks of each two at one place the worse one. */
static asj_status find_gone(asj_context *context, const place *places, size_t count, uint8_t *gone)
{
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_ASSIGN);
    for (size_t n = 0; n < count && !asj_watch_stops(&watch, NULL); n++)
        for (size_t m = n + 1; m < count && places[m].match->x1 - places[n].match->x1 <= APART; m++)
            if (is_same(places[n].match, places[m].match))
                gone[places[comes_first(&places[n], &places[m]) ? m : n].number] = 1;
    return asj_watch_end(&watch);
}

static void keep(asj_own_result *r, const uint8_t *gone)
{
    uint32_t kept = 0;
    for (uint32_t n = 0; n < r->shown.match_count; n++)
        if (!gone[n])
            r->matches[kept++] = r->matches[n];
    r->shown.match_count = r->count = kept;
    asj_match_result_sort(r);
}

asj_status asj_same_place(asj_context *context, asj_match_result *shown)
{
    const size_t count = shown->match_count;
    place *places = asj_allocate(&context->memory, count, sizeof *places);
    uint8_t *gone = asj_allocate_zero(&context->memory, count, 1);
    asj_status status = ASJ_OK;
    if (!places || !gone)
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu matches", count);
    for (size_t n = 0; n < count && status == ASJ_OK; n++)
        places[n] = (place){&shown->matches[n], n};
    if (status == ASJ_OK) {
        asj_sort(places, count, sizeof *places, by_x1);
        status = find_gone(context, places, count, gone);
    }
    if (status == ASJ_OK)
        keep((asj_own_result *)shown, gone);
    asj_release(&context->memory, places);
    asj_release(&context->memory, gone);
    return status;
}
