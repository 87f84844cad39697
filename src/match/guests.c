/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, junctions of several octaves.
 *
 * Corners that the fine octave sees in one image and a coarse one in the other, those out of focus, and those in few pixels find
 * partners across octaves. But most corners are listed two or three times then, coarse ones look more alike, and their places are
 * known less well. So the finest octave that has enough L-junctions (l_junctions_create.c) is matched as if there were no others;
 * those are guests, which come when everything else is decided and change nothing of it:
 *
 *   - accepted matches propose them where nothing is matched yet (guided.c), a guest with a guest or with one of the others;
 *   - what is proposed is compared (with canonical patches; induced ones, preset paper's, are all compared from the start) and
 *     aligned, and supported by the accepted matches alone;
 *   - of those chosen each is judged by the accepted matches around it (verify.c) and by their fundamental matrix (epipolar.c);
 *   - same_corner.c leaves one match for each corner.
 *
 * Where nothing else matches, guests do not either: alike among themselves, they agree too easily. Matched with the others in the
 * guided pass, they take good ones away: sixteen pairs of photographs have 838 of 884 right then, and 830 of 851 so. */
#include "guests.h"
#include "assign.h"
#include "consensus.h"
#include "epipolar.h"
#include "guided.h"
#include "same_corner.h"
#include "support.h"
#include "verify.h"

static asj_status no_memory(const asj_match_run *run)
{
    return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for junctions of other octaves");
}

/* The accepted matches as candidates and choices of a run of their own, and the locations that they take. */
static asj_status start(const asj_match_run *run, asj_match_run *guests, uint8_t *taken[2])
{
    asj_memory *memory = &run->context->memory;
    const size_t count = run->choices.count;
    for (int32_t side = 0; side < 2; side++) {
        taken[side] = asj_allocate_zero(memory, run->image[side]->l_junctions.location_count, sizeof *taken[side]);
        guests->taken[side] = taken[side];
    }
    guests->candidates.list = asj_allocate(memory, count, sizeof *guests->candidates.list);
    guests->choices.list = asj_allocate(memory, run->image[0]->l_junctions.location_count, sizeof *guests->choices.list);
    if (!taken[0] || !taken[1] || !guests->candidates.list || !guests->choices.list)
        return no_memory(run);
    guests->candidates.capacity = count;
    for (size_t n = 0; n < count; n++) {
        asj_candidate *c = &guests->candidates.list[n];
        *c = run->candidates.list[run->choices.list[n].candidate];
        c->number = 0;
        taken[0][run->image[0]->l_junctions.location[c->i]] = 1;
        taken[1][run->image[1]->l_junctions.location[c->j]] = 1;
    }
    guests->candidates.count = guests->choices.count = count;
    asj_candidates_sort(&guests->candidates);
    for (size_t n = 0; n < count; n++) {
        const asj_candidate *c = &run->candidates.list[run->choices.list[n].candidate];
        const asj_candidate *own = asj_candidates_find(&guests->candidates, c->i, c->j);
        guests->choices.list[n] = (asj_choice){(uint32_t)(own - guests->candidates.list), 0, 0};
    }
    return ASJ_OK;
}

/* Is it one of the accepted matches, guests among them where this is not the first time? */
static int is_accepted(const asj_match_run *guests, const asj_candidate *c)
{
    return guests->taken[0][guests->image[0]->l_junctions.location[c->i]] ||
           guests->taken[1][guests->image[1]->l_junctions.location[c->j]];
}

/* The chosen guests go behind the accepted matches. */
static asj_status add_chosen(asj_match_run *run, const asj_match_run *guests)
{
    const size_t room = run->image[0]->l_junctions.location_count;
    for (size_t n = 0; n < guests->choices.count && run->choices.count < room; n++) {
        const asj_candidate *c = &guests->candidates.list[guests->choices.list[n].candidate];
        const asj_candidates one = {guests->candidates.list + guests->choices.list[n].candidate, 1, 1};
        if (!asj_is_of_guests(run, c) || is_accepted(guests, c))
            continue;
        const size_t index = run->candidates.count;
        const asj_status status = asj_candidates_append(run->context, &run->candidates, &one);
        if (status != ASJ_OK)
            return status;
        run->choices.list[run->choices.count++] = (asj_choice){(uint32_t)index, guests->choices.list[n].ratio, 0};
    }
    return ASJ_OK;
}

/* Chooses among those that are proposed. */
static asj_status choose(asj_match_run *guests)
{
    const size_t accepted = guests->candidates.count;
    asj_status status = asj_guided(guests);
    guests->choices.count = 0;
    if (status != ASJ_OK || guests->candidates.count == accepted)
        return status;
    status = asj_support_find(guests);
    if (status == ASJ_OK)
        status = asj_consensus(guests);
    return status == ASJ_OK ? asj_assign(guests) : status;
}

static asj_status add_guests(asj_match_run *run)
{
    asj_memory *memory = &run->context->memory;
    uint8_t *taken[2] = {NULL, NULL};
    asj_match_run guests = {.context = run->context, .options = run->options, .image = {run->image[0], run->image[1]},
                            .alignments = run->alignments};
    asj_status status = start(run, &guests, taken);
    if (status == ASJ_OK)
        status = choose(&guests);
    if (status == ASJ_OK)
        status = add_chosen(run, &guests);
    asj_release_much(memory, guests.candidates.list);
    asj_release(memory, guests.choices.list);
    asj_support_free(memory, &guests.support);
    asj_release(memory, taken[0]);
    asj_release(memory, taken[1]);
    return status;
}

asj_status asj_match_guests(asj_match_run *run)
{
    const size_t accepted = run->choices.count;
    if (accepted == 0 || run->options->patches != ASJ_PATCHES_CANONICAL || run->options->neighbours == 0 ||
        run->options->guided_rounds == 0)
        return ASJ_OK;
    asj_status status = add_guests(run);
    if (status == ASJ_OK)
        status = asj_verify(run, accepted);
    if (status == ASJ_OK)
        asj_drop_off_lines(run, accepted);
    return status;
}
