/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, choice: the ratio test (Lowe 2004; paper, end of section "ASJ Matching").
 *
 * Of all candidates at a location the best one stands for it: a junction has several L-junctions, and they must not compete with
 * each other. For the same reason the second best of the ratio test must have its partner at another location, farther than
 * `separation` from the partner of the best. Partners are taken where the alignment has put them: junctions of a cluster, a few
 * pixels from each other, all say the same then and do not compete, while things that repeat stay rivals. With `mutual` the
 * candidate must be the best of both its locations, and the ratio is taken on both sides. Without it several locations of image 1
 * may choose one of image 2; then the one with the best score keeps it.
 *
 * The ratio is that of scores, the best over the second (consensus.c: appearance times support, by default). Without neighbours, as
 * in preset `paper`, it is that of distances, the second over the best: as they are, not of their squares, as Lowe has it; 1.5 on
 * distances is 2.25 on squares, and what others call 1.5 on squares is 1.22 here. The paper does not say which; its 1.5 is taken as
 * one of distances. */
#include "assign.h"
#include "consensus.h"
#include "support.h"

#include <math.h>

/* Best candidate of each location of one image, and the score of the best one elsewhere. */
typedef struct winner {
    uint32_t candidate; /* UINT32_MAX: the location has none */
    float second;       /* 0: none */
} winner;

/* Equal scores: the one whose location in the other image comes first. */
static int better(const asj_candidate *list, uint32_t left, uint32_t right)
{
    return list[left].score > list[right].score || (list[left].score == list[right].score && left < right);
}

/* Of candidates order[0] .. order[count - 1], which are those of one location of image `side`. */
static winner find_winner(const asj_match_run *run, int32_t side, const uint32_t *order, uint32_t count)
{
    const asj_candidate *list = run->candidates.list;
    const double separation = run->options->separation;
    if (count == 0)
        return (winner){UINT32_MAX, 0};
    winner best = {order[0], 0};
    for (uint32_t m = 1; m < count; m++)
        best.candidate = better(list, order[m], best.candidate) ? order[m] : best.candidate;
    double at[2], to[2];
    asj_match_run_partner(run, &list[best.candidate], side, at);
    for (uint32_t m = 0; m < count; m++) {
        const asj_candidate *c = &list[order[m]];
        asj_match_run_partner(run, c, side, to);
        const double dx = to[0] - at[0], dy = to[1] - at[1];
        if (dx * dx + dy * dy > separation * separation && c->score > best.second)
            best.second = c->score;
    }
    return best;
}

static asj_status find_winners(const asj_match_run *run, int32_t side, winner *winners)
{
    asj_location_index index = {NULL, NULL};
    const asj_status status = asj_location_index_create(run, side, 0, &index);
    for (uint32_t p = 0; p < run->image[side]->l_junctions.location_count && status == ASJ_OK; p++)
        winners[p] = find_winner(run, side, index.order + index.start[p], index.start[p + 1] - index.start[p]);
    asj_location_index_free(&run->context->memory, &index);
    return status;
}

/* The verdict on the best candidate of a location of image 1. */
static int accept(const asj_match_options *options, const asj_candidate *c, const winner *mine, const winner *theirs, float needed,
                  float *ratio)
{
    float second = mine->second;
    if (options->mutual) {
        if (theirs->candidate != mine->candidate)
            return 0;
        second = theirs->second > second ? theirs->second : second;
    }
    *ratio = second > 0 ? c->score / second : HUGE_VALF;
    return c->score > 0 && *ratio >= (float)options->ratio && c->support >= needed;
}

/* keeper[location of image 2]: index + 1 of the choice that has it. */
static void choose(asj_match_run *run, const winner *winners1, const winner *winners2, uint32_t *keeper)
{
    const asj_candidates *candidates = &run->candidates;
    const float needed = asj_needed_support(run);
    asj_choices *choices = &run->choices;
    choices->count = 0;
    for (uint32_t p = 0; p < run->image[0]->l_junctions.location_count; p++) {
        asj_choice choice = {winners1[p].candidate, 0, 0};
        if (choice.candidate == UINT32_MAX)
            continue;
        const asj_candidate *c = &candidates->list[choice.candidate];
        const uint32_t q = run->image[1]->l_junctions.location[c->j];
        if (!accept(run->options, c, &winners1[p], &winners2[q], needed, &choice.ratio))
            continue;
        if (keeper[q] == 0) {
            choices->list[choices->count++] = choice;
            keeper[q] = (uint32_t)choices->count;
        } else if (better(candidates->list, choice.candidate, choices->list[keeper[q] - 1].candidate)) {
            choices->list[keeper[q] - 1] = choice;
        }
    }
}

asj_status asj_assign(asj_match_run *run)
{
    asj_memory *memory = &run->context->memory;
    const uint32_t count1 = run->image[0]->l_junctions.location_count, count2 = run->image[1]->l_junctions.location_count;
    winner *winners1 = asj_allocate(memory, count1, sizeof *winners1);
    winner *winners2 = asj_allocate(memory, count2, sizeof *winners2);
    uint32_t *keeper = asj_allocate_zero(memory, count2, sizeof *keeper);
    if (!run->choices.list)
        run->choices.list = asj_allocate(memory, count1, sizeof *run->choices.list);
    asj_status status = ASJ_OK;
    if (!winners1 || !winners2 || !keeper || !run->choices.list)
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to choose matches");
    if (status == ASJ_OK)
        status = find_winners(run, 0, winners1);
    if (status == ASJ_OK)
        status = find_winners(run, 1, winners2);
    if (status == ASJ_OK)
        choose(run, winners1, winners2, keeper);
    asj_release(memory, winners1);
    asj_release(memory, winners2);
    asj_release(memory, keeper);
    return status;
}
