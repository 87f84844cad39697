/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, guided pass: matches propose matches near them.
 *
 * The short list misses true partners where corners are many and alike, or where a branch's length is wrong. An accepted match says
 * where its neighbours must be, so the partners near that location are candidates as well, however they ranked: an L-junction is
 * paired with those that one of the matches nearest to it predicts within the tolerance of agreement.c, with both branches about
 * where the map turns them. What is proposed is then compared, aligned and judged like every other candidate. Both images
 * propose, so that swapping them changes nothing. */
#include "guided.h"
#include "agreement.h"
#include "align.h"
#include "compare.h"
#include "location_grid.h"
#include "locations.h"
#include "pair_list.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define GUIDES_ASKED 8            /* nearest matches: two or three surfaces meet at a corner; 4 or 16 find as much within 1 % */
#define LEAST_TURN_COSINE 0.906307787 /* 25 degrees: what map_tolerance lets two maps differ by, 0.5 in norm, is about that */
#define MOST_NEAR 64              /* locations that are sorted; where there are more they are gone through in order */
#define MOST_PROPOSALS 32         /* for one L-junction; where more are possible, none is likely */

/* A chosen match as seen from one image. */
typedef struct guide {
    double x, y;           /* px: where it stands in the image asked, */
    double to_x, to_y;     /* .. and in the other */
    const double *map;     /* from the one to the other */
} guide;

typedef struct guides {
    guide *list;
    asj_location_place *places; /* of the list, in the image asked */
    size_t count;
} guides;

typedef struct proposals {
    uint32_t count;
    uint32_t partner[MOST_PROPOSALS];
} proposals;

/* Does the map turn direction u within 25 degrees of v? */
static int turns(const double map[4], const double u[2], const double v[2])
{
    double x = map[0] * u[0] + map[1] * u[1], y = map[2] * u[0] + map[3] * u[1];
    return x * v[0] + y * v[1] >= LEAST_TURN_COSINE * sqrt(x * x + y * y);
}

static void propose(proposals *p, uint32_t partner)
{
    for (uint32_t k = 0; k < p->count; k++)
        if (p->partner[k] == partner)
            return;
    if (p->count < MOST_PROPOSALS)
        p->partner[p->count++] = partner;
}

/* May L-junction l of image `side` be paired with k of the other? Guests (guests.c) when their turn comes, where nothing is matched
 * yet. */
static int may_propose(const asj_match_run *run, int32_t side, uint32_t l, uint32_t k)
{
    const asj_l_junctions *mine = &run->image[side]->l_junctions, *others = &run->image[1 - side]->l_junctions;
    const int of_guests = asj_is_guest(mine, l) || asj_is_guest(others, k);
    if (!run->taken[0])
        return !of_guests;
    return of_guests && !run->taken[side][mine->location[l]] && !run->taken[1 - side][others->location[k]];
}

/* A guide's proposals for an L-junction. */
typedef struct question {
    const asj_match_run *run;
    int32_t side;      /* of the L-junction, */
    uint32_t l;        /* its number, */
    const double *map; /* and the guide's map from there */
} question;

/* Those at location q of the other image. */
static void ask_at(const question *of, uint32_t q, proposals *p)
{
    const asj_l_junctions *mine = &of->run->image[of->side]->l_junctions, *others = &of->run->image[1 - of->side]->l_junctions;
    const double *u = mine->direction + 4 * (size_t)of->l;
    for (uint32_t m = others->first_of_location[q]; m < others->first_of_location[q + 1]; m++) {
        const uint32_t k = others->l_of_location[m];
        const double *v = others->direction + 4 * (size_t)k;
        if (may_propose(of->run, of->side, of->l, k) && turns(of->map, u, v) && turns(of->map, u + 2, v + 2))
            propose(p, k);
    }
}

/* Those at all locations within `radius` of (x, y), one after the other. */
static void ask_all_near(const question *of, double x, double y, double radius, proposals *p)
{
    const asj_l_junctions *others = &of->run->image[1 - of->side]->l_junctions;
    for (uint32_t q = asj_first_location(others, x - radius); q < others->location_count; q++) {
        const double ex = others->location_x[q] - x, ey = others->location_y[q] - y;
        if (ex > radius)
            break;
        if (ex * ex + ey * ey <= radius * radius)
            ask_at(of, q, p);
    }
}

/* What guide g proposes for L-junction l of image `side`; `locations`: of the other image. */
static void ask(const asj_match_run *run, int32_t side, uint32_t l, const guide *g, const asj_location_grid *locations,
                proposals *p)
{
    const asj_l_junctions *mine = &run->image[side]->l_junctions;
    const question of = {run, side, l, g->map};
    double dx = (double)mine->l[l].x - g->x, dy = (double)mine->l[l].y - g->y;
    double px = g->map[0] * dx + g->map[1] * dy, py = g->map[2] * dx + g->map[3] * dy;
    double radius = ASJ_AGREEMENT_PIXELS + run->options->neighbour_tolerance * sqrt(px * px + py * py);
    uint32_t near[MOST_NEAR];
    px += g->to_x;
    py += g->to_y;
    const uint32_t count = asj_location_grid_within(locations, px, py, radius, MOST_NEAR, near);
    if (count > MOST_NEAR)
        ask_all_near(&of, px, py, radius, p);
    for (uint32_t n = 0; n < count && count <= MOST_NEAR; n++)
        ask_at(&of, near[n], p);
}

/* --- both directions -------------------------------------------------------------------------------------------------------- */

/* Adds what image `side` proposes and is no candidate yet. */
static asj_status collect(const asj_match_run *run, int32_t side, const proposals *all, asj_pair_list *fresh)
{
    asj_watch watch;
    asj_status status = ASJ_OK;
    asj_watch_start(&watch, run->context, ASJ_STAGE_ALIGN);
    for (uint32_t l = 0; l < run->image[side]->l_junctions.count && status == ASJ_OK && !asj_watch_stops(&watch, NULL); l++)
        for (uint32_t k = 0; k < all[l].count && status == ASJ_OK; k++) {
            const uint32_t i = side == 0 ? l : all[l].partner[k], j = side == 0 ? all[l].partner[k] : l;
            if (!asj_candidates_find(&run->candidates, i, j))
                status = asj_pair_list_add(run->context, fresh, i, j);
        }
    return status == ASJ_OK ? asj_watch_end(&watch) : status;
}

typedef struct job {
    const asj_match_run *run;
    int32_t side;
    const guides *asked;
    const asj_location_grid *grid, *locations; /* of these, and of the locations of the other image */
    proposals *all;
    asj_watch *watch;
} job;

static void ask_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_l_junction *mine = j->run->image[j->side]->l_junctions.l;
    for (int64_t l = part->first; l < part->end && !asj_watch_stops(j->watch, part); l++) {
        uint32_t near[GUIDES_ASKED];
        const uint32_t n = asj_location_grid_nearest(j->grid, (double)mine[l].x, (double)mine[l].y, -1, GUIDES_ASKED, near);
        for (uint32_t k = 0; k < n; k++)
            ask(j->run, j->side, (uint32_t)l, &j->asked->list[near[k]], j->locations, &j->all[l]);
    }
}

static asj_status ask_all(const asj_match_run *run, int32_t side, const guides *asked, const asj_location_grid *grid,
                          const asj_location_grid *locations, proposals *all)
{
    asj_watch watch;
    const job j = {run, side, asked, grid, locations, all, &watch};
    asj_watch_start(&watch, run->context, ASJ_STAGE_ALIGN);
    asj_parallel(run->context, run->context->threads, run->image[side]->l_junctions.count, 16, ask_some, &j);
    return asj_watch_end(&watch);
}

static asj_status grid_of_locations(asj_memory *memory, const asj_l_junctions *all, asj_location_grid *grid)
{
    asj_location_place *places = asj_allocate(memory, all->location_count, sizeof *places);
    if (!places)
        return ASJ_ERROR_MEMORY;
    for (uint32_t q = 0; q < all->location_count; q++)
        places[q] = (asj_location_place){all->location_x[q], all->location_y[q], q};
    const asj_status status = asj_location_grid_make(memory, places, all->location_count, grid);
    asj_release(memory, places);
    return status;
}

static asj_status one_side(const asj_match_run *run, int32_t side, const guides *asked, asj_pair_list *fresh)
{
    asj_memory *memory = &run->context->memory;
    asj_location_grid grid = {.first = NULL}, locations = {.first = NULL};
    proposals *all = asj_allocate_zero(memory, run->image[side]->l_junctions.count, sizeof *all);
    asj_status status = all ? asj_location_grid_make(memory, asked->places, (uint32_t)asked->count, &grid) : ASJ_ERROR_MEMORY;
    if (status == ASJ_OK)
        status = grid_of_locations(memory, &run->image[1 - side]->l_junctions, &locations);
    if (status == ASJ_OK)
        status = ask_all(run, side, asked, &grid, &locations, all);
    else
        asj_fail(run->context, status, "no memory for the guided pass");
    if (status == ASJ_OK)
        status = collect(run, side, all, fresh);
    asj_location_grid_free(memory, &grid);
    asj_location_grid_free(memory, &locations);
    asj_release(memory, all);
    return status;
}

static void set_guides(const asj_match_run *run, int32_t side, guides *all)
{
    all->count = run->choices.count;
    for (size_t n = 0; n < all->count; n++) {
        const asj_candidate *c = &run->candidates.list[run->choices.list[n].candidate];
        const asj_l_junction *from = asj_match_run_l(run, c, side), *to = asj_match_run_l(run, c, 1 - side);
        all->list[n] = (guide){(double)from->x, (double)from->y, (double)to->x, (double)to->y, asj_candidate_map(c, side)};
        all->places[n] = (asj_location_place){(double)from->x, (double)from->y, (uint32_t)n};
    }
}

/* What is proposed joins the candidates, compared and aligned as they are. */
static asj_status append(asj_match_run *run, const asj_pair_list *proposed)
{
    asj_candidates fresh = {NULL, 0, 0};
    asj_status status = asj_pair_list_candidates(run->context, proposed, run->image[0]->l_junctions.count,
                                                 run->candidates.count, ASJ_STAGE_ALIGN, &fresh);
    if (status == ASJ_OK)
        status = asj_compare_and_drop(run, &fresh);
    if (status == ASJ_OK && run->options->align_iterations > 0)
        status = asj_align_candidates(run, &fresh);
    if (status == ASJ_OK)
        status = asj_candidates_merge(run->context, &run->candidates, &fresh, ASJ_STAGE_ALIGN);
    asj_release_much(&run->context->memory, fresh.list);
    return status;
}

asj_status asj_guided(asj_match_run *run)
{
    asj_pair_list fresh = {NULL, 0, 0};
    asj_memory *memory = &run->context->memory;
    guides all = {asj_allocate(memory, run->choices.count, sizeof *all.list),
                  asj_allocate(memory, run->choices.count, sizeof *all.places), 0};
    asj_status status = all.list && all.places ? ASJ_OK : asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for the guided pass");
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++) {
        set_guides(run, side, &all);
        status = one_side(run, side, &all, &fresh);
    }
    if (status == ASJ_OK)
        status = append(run, &fresh);
    asj_release_much(memory, fresh.pairs);
    asj_release(memory, all.list);
    asj_release(memory, all.places);
    return status;
}
