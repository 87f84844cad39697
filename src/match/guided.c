/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, guided pass: matches propose matches near them.
 *
 * The short list misses true partners where corners are many and alike, or where a branch's length is wrong. An accepted match says
 * where its neighbours must be, so the partners near that place are looked at as well, however they ranked: an L-junction is
 * paired with those that one of the matches nearest to it predicts within the tolerance of agreement.c, with both branches about
 * where the map turns them. What is proposed is then compared, aligned and judged like every other candidate. Done from both
 * images, so that swapping them changes nothing. */
#include "guided.h"
#include "agreement.h"
#include "align.h"

#include <math.h>
#include <string.h>

#define NEAREST 8                /* matches asked: two or three surfaces meet at a corner; 4 or 16 find as much within 1 % */
#define LEAST_COSINE 0.906307787 /* 25 degrees: what map_tolerance lets two maps differ by, 0.5 in norm, is about that */
#define MOST_PROPOSALS 32        /* for one L-junction; where more are possible, none is likely */

/* Accepted matches as seen from one image. */
typedef struct guide {
    double x1, y1, x2, y2; /* place in the image asked, place in the other */
    double map[4];         /* from the one to the other */
} guide;

typedef struct proposals {
    uint32_t count;
    uint32_t partner[MOST_PROPOSALS];
} proposals;

static uint32_t nearest_guides(const guide *guides, size_t count, double x, double y, uint32_t *out)
{
    double far[NEAREST];
    uint32_t n = 0;
    for (size_t g = 0; g < count; g++) {
        double dx = guides[g].x1 - x, dy = guides[g].y1 - y, d = dx * dx + dy * dy;
        if (n == NEAREST && d >= far[n - 1])
            continue;
        uint32_t k = n < NEAREST ? n++ : NEAREST - 1;
        for (; k > 0 && far[k - 1] > d; k--) {
            far[k] = far[k - 1];
            out[k] = out[k - 1];
        }
        far[k] = d;
        out[k] = (uint32_t)g;
    }
    return n;
}

/* Does the map turn direction u within 25 degrees of v? */
static int turns(const double map[4], const double u[2], const double v[2])
{
    double x = map[0] * u[0] + map[1] * u[1], y = map[2] * u[0] + map[3] * u[1];
    return x * v[0] + y * v[1] >= LEAST_COSINE * sqrt(x * x + y * y);
}

static void propose(proposals *p, uint32_t partner)
{
    for (uint32_t k = 0; k < p->count; k++)
        if (p->partner[k] == partner)
            return;
    if (p->count < MOST_PROPOSALS)
        p->partner[p->count++] = partner;
}

static void ask(const asj_match_options *options, const asj_corners *mine, uint32_t i, const guide *g, const asj_corners *others,
                proposals *p)
{
    const double *u = mine->direction + 4 * (size_t)i;
    double dx = (double)mine->l[i].x - g->x1, dy = (double)mine->l[i].y - g->y1;
    double px = g->map[0] * dx + g->map[1] * dy, py = g->map[2] * dx + g->map[3] * dy;
    double radius = ASJ_AGREEMENT_PIXELS + options->neighbour_tolerance * sqrt(px * px + py * py);
    px += g->x2;
    py += g->y2;
    for (uint32_t q = asj_first_place(others, px - radius); q < others->place_count; q++) {
        double ex = others->place_x[q] - px, ey = others->place_y[q] - py;
        if (ex > radius)
            break;
        if (ex * ex + ey * ey > radius * radius)
            continue;
        for (uint32_t m = others->first_of_place[q]; m < others->first_of_place[q + 1]; m++) {
            const uint32_t k = others->l_of_place[m];
            const double *v = others->direction + 4 * (size_t)k;
            if (turns(g->map, u, v) && turns(g->map, u + 2, v + 2))
                propose(p, k);
        }
    }
}

/* --- both directions -------------------------------------------------------------------------------------------------------- */

static int32_t known(const asj_candidate *list, size_t count, uint32_t i, uint32_t j)
{
    size_t low = 0, high = count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if (list[middle].i < i || (list[middle].i == i && list[middle].j < j))
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && list[low].i == i && list[low].j == j;
}

/* Appends what `side` proposes to `fresh`. */
static asj_status collect(asj_context *context, const proposals *all, uint32_t count, int32_t side,
                          const asj_candidates *candidates, asj_candidates *fresh)
{
    for (uint32_t i = 0; i < count; i++)
        for (uint32_t k = 0; k < all[i].count; k++) {
            uint32_t first = side == 1 ? i : all[i].partner[k], second = side == 1 ? all[i].partner[k] : i;
            if (known(candidates->list, candidates->count, first, second))
                continue;
            void *list = fresh->list;
            asj_status status = asj_grow(&context->memory, &list, &fresh->capacity, fresh->count + 1, sizeof *fresh->list,
                                         fresh->count);
            if (status != ASJ_OK)
                return asj_fail(context, status, "no memory for the guided pass");
            fresh->list = list;
            memset(&fresh->list[fresh->count], 0, sizeof *fresh->list);
            fresh->list[fresh->count].i = first;
            fresh->list[fresh->count++].j = second;
        }
    return ASJ_OK;
}

static asj_status one_side(asj_context *context, const asj_match_options *options, const asj_corners *mine,
                           const asj_corners *theirs, int32_t side, const guide *guides, size_t guide_count,
                           const asj_candidates *candidates, asj_candidates *fresh)
{
    proposals *all = asj_allocate_zero(&context->memory, mine->count, sizeof *all);
    asj_status status = all ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the guided pass");
    if (status == ASJ_OK) {
        const int64_t count = mine->count;
#pragma omp parallel for num_threads(context->threads) schedule(dynamic, 16)
        for (int64_t i = 0; i < count; i++) {
            uint32_t near[NEAREST];
            uint32_t n = nearest_guides(guides, guide_count, (double)mine->l[i].x, (double)mine->l[i].y, near);
            for (uint32_t k = 0; k < n; k++)
                ask(options, mine, (uint32_t)i, &guides[near[k]], theirs, &all[i]);
        }
        status = collect(context, all, mine->count, side, candidates, fresh);
    }
    asj_release(&context->memory, all);
    return status;
}

static void set_guides(const asj_view *view1, const asj_view *view2, const asj_candidates *candidates, const asj_choice *choices,
                       size_t count, int32_t side, guide *guides)
{
    for (size_t n = 0; n < count; n++) {
        const asj_candidate *c = &candidates->list[choices[n].candidate];
        const asj_l_junction *l1 = &view1->corners.l[c->i], *l2 = &view2->corners.l[c->j];
        const asj_l_junction *from = side == 1 ? l1 : l2, *to = side == 1 ? l2 : l1;
        guides[n] = (guide){(double)from->x, (double)from->y, (double)to->x, (double)to->y, {0, 0, 0, 0}};
        memcpy(guides[n].map, side == 1 ? c->map.to : c->map.from, sizeof guides[n].map);
    }
}

/* Compares the fresh pairs and keeps those with a map. */
static void compare_all(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                        asj_candidates *fresh)
{
    const int64_t count = (int64_t)fresh->count;
    size_t kept = 0;
    (void)context; /* without OpenMP */
#pragma omp parallel for num_threads(context->threads) schedule(static)
    for (int64_t k = 0; k < count; k++)
        if (!asj_compare(options, view1, view2, &fresh->list[k]))
            fresh->list[k].distance2 = -1;
    for (size_t k = 0; k < fresh->count; k++)
        if (fresh->list[k].distance2 >= 0)
            fresh->list[kept++] = fresh->list[k];
    fresh->count = kept;
}

static asj_status append(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                         asj_candidates *candidates, asj_candidates *fresh)
{
    void *list = candidates->list;
    const size_t before = candidates->count;
    asj_candidates_sort(fresh);
    compare_all(context, options, view1, view2, fresh);
    asj_status status = asj_grow(&context->memory, &list, &candidates->capacity, before + fresh->count, sizeof *candidates->list,
                                 before);
    if (status != ASJ_OK)
        return asj_fail(context, status, "no memory for %zu candidates", before + fresh->count);
    candidates->list = list;
    if (fresh->count)
        memcpy(candidates->list + before, fresh->list, fresh->count * sizeof *fresh->list);
    candidates->count = before + fresh->count;
    if (options->align_iterations > 0)
        status = asj_align_candidates(context, options, view1, view2, candidates, before);
    return status == ASJ_OK ? asj_candidates_sort(candidates) : status;
}

asj_status asj_guided(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                      asj_candidates *candidates, const asj_choice *choices, size_t choice_count, size_t *added)
{
    asj_candidates fresh = {NULL, 0, 0};
    guide *guides = asj_allocate(&context->memory, choice_count, sizeof *guides);
    asj_status status = guides ? ASJ_OK : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the guided pass");
    for (int32_t side = 1; side <= 2 && status == ASJ_OK; side++) {
        set_guides(view1, view2, candidates, choices, choice_count, side, guides);
        const asj_corners *mine = side == 1 ? &view1->corners : &view2->corners;
        const asj_corners *theirs = side == 1 ? &view2->corners : &view1->corners;
        status = one_side(context, options, mine, theirs, side, guides, choice_count, candidates, &fresh);
    }
    if (status == ASJ_OK)
        status = append(context, options, view1, view2, candidates, &fresh);
    *added = fresh.count;
    asj_release(&context->memory, fresh.list);
    asj_release(&context->memory, guides);
    return status;
}
