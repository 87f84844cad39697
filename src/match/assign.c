/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, choice: the ratio test (Lowe 2004; paper, end of section "ASJ Matching").
 *
 * Of all candidates at a place the best one stands for it: a junction has several L-junctions, and they must not compete with each
 * other. For the same reason the second best of the ratio test must have its partner at another place, farther than
 * `separation` from the partner of the best. Partners are taken where the alignment has put them: junctions of a cluster, a few
 * pixels from each other, all say the same then and do not compete, while things that repeat stay rivals. With `mutual` the
 * candidate must be the best of both its places, and the ratio is taken on both sides. Without it several places of image 1 may
 * choose one of image 2; then the one with the best score keeps it.
 *
 * The ratio is of distances as they are, not of their squares, as Lowe has it; 1.5 on distances is 2.25 on squares, and what others
 * call 1.5 on squares is 1.22 here. The paper does not say which; its 1.5 is taken as one of distances.
 *
 * The ratio is that of scores, best over second: of distances, second over best, when no neighbours are asked. */
#include "assign.h"

#include <math.h>
#include <stdlib.h>

/* Best candidate of each place of one image, and the score of the best one elsewhere. */
typedef struct winner {
    uint32_t candidate; /* UINT32_MAX: the place has none */
    float second;       /* 0: none */
} winner;

/* Equal scores: the one whose place in the other image comes first. */
static int better(const asj_candidate *list, uint32_t left, uint32_t right)
{
    return list[left].score > list[right].score || (list[left].score == list[right].score && left < right);
}

/* Where the candidate has the location of its L-junction in image `side` in the other image, whose corners are `others`. */
static void partner(const asj_candidate *c, const asj_corners *others, int32_t side, double at[2])
{
    const asj_l_junction *l = &others->l[side == 1 ? c->j : c->i];
    const double *mine = side == 1 ? c->move1 : c->move2, *theirs = side == 1 ? c->move2 : c->move1;
    const double *map = side == 1 ? c->map.to : c->map.from;
    at[0] = (double)l->x + theirs[0] - map[0] * mine[0] - map[1] * mine[1];
    at[1] = (double)l->y + theirs[1] - map[2] * mine[0] - map[3] * mine[1];
}

static void find_winners(const asj_candidates *candidates, const asj_place_index *index, const asj_corners *corners,
                         const asj_corners *others, int32_t side, double separation, winner *winners)
{
    const asj_candidate *list = candidates->list;
    for (uint32_t p = 0; p < corners->place_count; p++) {
        winners[p] = (winner){UINT32_MAX, 0};
        const uint32_t first = index->start[p], end = index->start[p + 1];
        if (first == end)
            continue;
        uint32_t best = index->order[first];
        for (uint32_t m = first + 1; m < end; m++)
            best = better(list, index->order[m], best) ? index->order[m] : best;
        winners[p].candidate = best;
        double at[2], to[2];
        partner(&list[best], others, side, at);
        for (uint32_t m = first; m < end; m++) {
            const asj_candidate *c = &list[index->order[m]];
            partner(c, others, side, to);
            const double dx = to[0] - at[0], dy = to[1] - at[1];
            if (dx * dx + dy * dy > separation * separation && c->score > winners[p].second)
                winners[p].second = c->score;
        }
    }
}

/* The verdict on the best candidate of a place of image 1. */
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

/* keeper[place of image 2]: index + 1 of the choice that has it. */
static size_t choose(const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                     const asj_candidates *candidates, const winner *winners1, const winner *winners2, uint32_t *keeper,
                     asj_choice *choices)
{
    const float needed = asj_needed_support(options, &view1->corners, &view2->corners);
    size_t count = 0;
    for (uint32_t p = 0; p < view1->corners.place_count; p++) {
        asj_choice choice = {winners1[p].candidate, 0};
        if (choice.candidate == UINT32_MAX)
            continue;
        const asj_candidate *c = &candidates->list[choice.candidate];
        const uint32_t q = view2->corners.place[c->j];
        if (!accept(options, c, &winners1[p], &winners2[q], needed, &choice.ratio))
            continue;
        if (keeper[q] == 0) {
            choices[count++] = choice;
            keeper[q] = (uint32_t)count;
        } else if (better(candidates->list, choice.candidate, choices[keeper[q] - 1].candidate)) {
            choices[keeper[q] - 1] = choice;
        }
    }
    return count;
}

asj_status asj_assign(asj_context *context, const asj_match_options *options, const asj_view *view1, const asj_view *view2,
                      const asj_candidates *candidates, asj_choice *choices, size_t *count)
{
    asj_memory *memory = &context->memory;
    asj_place_index index1 = {NULL, NULL}, index2 = {NULL, NULL};
    const asj_corners *c1 = &view1->corners, *c2 = &view2->corners;
    winner *winners1 = asj_allocate(memory, c1->place_count, sizeof *winners1);
    winner *winners2 = asj_allocate(memory, c2->place_count, sizeof *winners2);
    uint32_t *keeper = asj_allocate_zero(memory, c2->place_count, sizeof *keeper);
    asj_status status = winners1 && winners2 && keeper ? ASJ_OK
                                                       : asj_fail(context, ASJ_ERROR_MEMORY, "no memory to choose matches");
    if (status == ASJ_OK)
        status = asj_place_index_create(context, c1, candidates, 1, 0, &index1);
    if (status == ASJ_OK)
        status = asj_place_index_create(context, c2, candidates, 2, 0, &index2);
    if (status == ASJ_OK) {
        find_winners(candidates, &index1, c1, c2, 1, options->separation, winners1);
        find_winners(candidates, &index2, c2, c1, 2, options->separation, winners2);
        *count = choose(options, view1, view2, candidates, winners1, winners2, keeper, choices);
    }
    asj_place_index_free(memory, &index1);
    asj_place_index_free(memory, &index2);
    asj_release(memory, winners1);
    asj_release(memory, winners2);
    asj_release(memory, keeper);
    return status;
}
