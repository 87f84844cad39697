/* SPDX-License-Identifier: BSD-2-Clause */
/* Junctions of several octaves (option octave_union of the detector). Corners that the fine octave sees in one image and a coarse
 * one in the other, those out of focus, and those in few pixels find partners that way. But most corners are then listed two or
 * three times, and coarse ones look more alike. So those of the octave that most are of are matched first, as if there were no
 * others (shortlist.c, l_junctions.c); the guided pass then proposes the others, which are guests, where accepted matches put them.
 * Only guests that were proposed are compared (with canonical patches; of induced ones, preset paper's, all are), and they support
 * nobody. What is left for here:
 *
 * Support. A match of octave o needs 1 + o times the usual support: the place of a coarse corner is known that much worse. Asked at
 * the end only: what has little support still is good for proposing matches near it.
 *
 * One match for each corner. Locations of different octaves nearer than `separation` are the same corner, as they are for the ratio
 * test (assign.c); of their matches that of the finest octave stays, which knows the place best. Lists of one octave are left as
 * they are. */
#include "same_corner.h"
#include "consensus.h"
#include "core/watch.h"

#include <string.h>

/* The coarser octave of the two that a candidate matches. */
static int32_t octave_of(const asj_match_run *run, const asj_candidate *c)
{
    const int32_t one = run->image[0]->l_junctions.octave[c->i], other = run->image[1]->l_junctions.octave[c->j];
    return one > other ? one : other;
}

/* --- one match for each corner ----------------------------------------------------------------------------------------------- */

static int nearer(const asj_l_junction *a, const asj_l_junction *b, double distance)
{
    const double dx = (double)a->x - (double)b->x, dy = (double)a->y - (double)b->y;
    return dx * dx + dy * dy < distance * distance;
}

/* Does `other` stand for the corner of `c`? */
static int stands_for(const asj_match_run *run, const asj_candidate *other, const asj_candidate *c)
{
    const int32_t mine = octave_of(run, c), theirs = octave_of(run, other);
    const double separation = run->options->separation;
    return theirs < mine && (nearer(asj_match_run_l(run, c, 0), asj_match_run_l(run, other, 0), separation) ||
                             nearer(asj_match_run_l(run, c, 1), asj_match_run_l(run, other, 1), separation));
}

static int has_octaves(const asj_match_run *run)
{
    for (int32_t side = 0; side < 2; side++)
        for (uint32_t l = 1; l < run->image[side]->l_junctions.count; l++)
            if (run->image[side]->l_junctions.octave[l] != run->image[side]->l_junctions.octave[0])
                return 1;
    return 0;
}

/* Leaves the choices that are not gone. */
static void keep(asj_choices *choices, const uint8_t *gone)
{
    size_t kept = 0;
    for (size_t n = 0; n < choices->count; n++)
        if (!gone[n])
            choices->list[kept++] = choices->list[n];
    choices->count = kept;
}

/* Leaves the choices that have the support which their octaves need. */
static void keep_supported(asj_match_run *run, uint8_t *gone)
{
    asj_choices *choices = &run->choices;
    const float needed = asj_needed_support(run);
    for (size_t n = 0; n < choices->count; n++) {
        const asj_candidate *c = &run->candidates.list[choices->list[n].candidate];
        gone[n] = c->support < needed * (float)(1 + octave_of(run, c));
    }
    keep(choices, gone);
}

/* Leaves one choice a corner. */
static void keep_finest(asj_match_run *run, uint8_t *gone, asj_watch *watch)
{
    asj_choices *choices = &run->choices;
    const asj_candidate *list = run->candidates.list;
    memset(gone, 0, choices->count);
    for (size_t n = 0; n < choices->count && !asj_watch_stops(watch, NULL); n++)
        for (size_t m = 0; m < choices->count && !gone[n]; m++)
            gone[n] = (uint8_t)stands_for(run, &list[choices->list[m].candidate], &list[choices->list[n].candidate]);
    keep(choices, gone);
}

asj_status asj_same_corner(asj_match_run *run)
{
    if (!has_octaves(run) || run->choices.count == 0)
        return ASJ_OK;
    uint8_t *gone = asj_allocate_zero(&run->context->memory, run->choices.count, 1);
    if (!gone)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu matches", run->choices.count);
    asj_watch watch;
    asj_watch_start(&watch, run->context, ASJ_STAGE_ASSIGN);
    keep_supported(run, gone);
    keep_finest(run, gone, &watch);
    asj_release(&run->context->memory, gone);
    return asj_watch_end(&watch);
}
