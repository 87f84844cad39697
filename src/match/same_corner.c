/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches of junctions of several octaves (guests.c), when all are there.
 *
 * Support. A guest's match of octave o needs 1 + MORE_SUPPORT o times the usual support: the place of a coarse corner is known that
 * much worse.
 *
 * One match for each corner. Locations of different octaves nearer than `separation` are the same corner, as they are for the ratio
 * test (assign.c); of their matches that of no guest stays, or else that of the finest octave, which knows the place best. The
 * choices before `first` stay in any case. */
#include "same_corner.h"
#include "consensus.h"
#include "core/watch.h"

#include <string.h>

/* An octave. With 1 867 of 892 are right on sixteen pairs in place of 830 of 851, but 90.6 % on average instead of 91.8. */
#define MORE_SUPPORT 2

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

/* Does choice m stand for the corner of choice n, which is a guest's? The first `before` stay. */
static int stands_for(const asj_match_run *run, size_t before, size_t m, size_t n)
{
    const asj_candidate *other = asj_chosen(run, m), *c = asj_chosen(run, n);
    const int comes_first = m < before || !asj_is_of_guests(run, other) || octave_of(run, other) < octave_of(run, c);
    const double separation = run->options->separation;
    return comes_first && (nearer(asj_match_run_l(run, c, 0), asj_match_run_l(run, other, 0), separation) ||
                           nearer(asj_match_run_l(run, c, 1), asj_match_run_l(run, other, 1), separation));
}

static int has_guests(const asj_match_run *run, size_t first)
{
    for (size_t n = first; n < run->choices.count; n++)
        if (asj_is_of_guests(run, asj_chosen(run, n)))
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

/* Leaves out guests that have less support than their octaves need. */
static void keep_supported(asj_match_run *run, size_t first, uint8_t *gone)
{
    asj_choices *choices = &run->choices;
    const float needed = asj_needed_support(run);
    for (size_t n = first; n < choices->count; n++) {
        const asj_candidate *c = asj_chosen(run, n);
        gone[n] = asj_is_of_guests(run, c) && c->support < needed * (float)(1 + MORE_SUPPORT * octave_of(run, c));
    }
    keep(choices, gone);
}

/* Leaves one choice a corner. */
static void keep_finest(asj_match_run *run, size_t first, uint8_t *gone, asj_watch *watch)
{
    asj_choices *choices = &run->choices;
    memset(gone, 0, choices->count);
    for (size_t n = first; n < choices->count && !asj_watch_stops(watch, NULL); n++)
        for (size_t m = 0; m < choices->count && !gone[n]; m++)
            gone[n] = (uint8_t)(asj_is_of_guests(run, asj_chosen(run, n)) && stands_for(run, first, m, n));
    keep(choices, gone);
}

asj_status asj_same_corner(asj_match_run *run, size_t first)
{
    if (!has_guests(run, first))
        return ASJ_OK;
    uint8_t *gone = asj_allocate_zero(&run->context->memory, run->choices.count, 1);
    if (!gone)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu matches", run->choices.count);
    asj_watch watch;
    asj_watch_start(&watch, run->context, ASJ_STAGE_ASSIGN);
    keep_supported(run, first, gone);
    keep_finest(run, first, gone, &watch);
    asj_release(&run->context->memory, gone);
    return asj_watch_end(&watch);
}
