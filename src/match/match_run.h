/* SPDX-License-Identifier: BSD-2-Clause */
/* One call of asj_match(), which its steps hand on (match.c lists them). */
#ifndef ASJ_SRC_MATCH_RUN_H
#define ASJ_SRC_MATCH_RUN_H

#include "candidate.h"
#include "features.h"
#include "geometry/judge.h"

typedef struct asj_match_run {
    asj_context *context;
    const asj_match_options *options;
    const asj_image_features *image[2];
    const struct asj_expected *expected; /* expected.c: where partners are looked for; NULL: everywhere */
    asj_candidates candidates; /* shortlist.c fills them, align.c their maps, consensus.c their scores */
    asj_support support;       /* support.c: who agrees with whom */
    asj_choices choices;       /* assign.c; room for every location of image 1 */
    struct asj_alignments *alignments; /* of the same images, that are known; NULL: none are kept */
    int32_t for_geometry;      /* 1: the candidates of two_view.c's longer list, */
    uint32_t most_listed;      /* .. of so many L-junctions of each image, the most meaningful ones and their equals (canonical
                                * patches); 0: of all */
    asj_colour_patches colours[2]; /* wide_shortlist.c: what pairs are compared by, too; NULL: by grey levels alone */
    asj_geometry geometry;     /* two_view.c */
    asj_judge judge;           /* two_view.c: what was accepted, for matches that were no candidates of it */
    int32_t hopeless;          /* match.c: is it known that there is no geometry? */
    int32_t lines_hold;        /* verdict.c: is what lies off its epipolar lines wrong? */
    asj_choices rejected;      /* verdict.c: what were choices before */
    const uint8_t *taken[2];   /* guests.c: locations that are matched already; NULL: guests are not proposed */
    int32_t has_epipolar;      /* epipolar.c: is the fundamental matrix of all choices known, */
    double epipolar[9];        /* .. by rows: x2' F x1 = 0 */
} asj_match_run;

/* L-junction of a candidate in image `side` (0 or 1). */
static inline const asj_l_junction *asj_match_run_l(const asj_match_run *run, const asj_candidate *c, int32_t side)
{
    return &run->image[side]->l_junctions.l[asj_candidate_l(c, side)];
}

/* Where the candidate's map puts its L-junction of image `side` in the other image. Alignment has moved either: where it was this
 * one, the map takes the moved location to that of the other, so q = p2 + move2 - A move1 of image 1. */
static inline void asj_match_run_partner(const asj_match_run *run, const asj_candidate *c, int32_t side, double at[2])
{
    const asj_l_junction *l = asj_match_run_l(run, c, 1 - side);
    const double *mine = side == 0 ? c->move1 : c->move2, *theirs = side == 0 ? c->move2 : c->move1;
    const double *map = asj_candidate_map(c, side);
    at[0] = (double)l->x + theirs[0] - (map[0] * mine[0] + map[1] * mine[1]);
    at[1] = (double)l->y + theirs[1] - (map[2] * mine[0] + map[3] * mine[1]);
}

/* The candidate of choice n. */
static inline const asj_candidate *asj_chosen(const asj_match_run *run, size_t n)
{
    return &run->candidates.list[run->choices.list[n].candidate];
}

/* Does it match a guest (guests.c)? */
static inline int asj_is_of_guests(const asj_match_run *run, const asj_candidate *c)
{
    return asj_is_guest(&run->image[0]->l_junctions, c->i) || asj_is_guest(&run->image[1]->l_junctions, c->j);
}

#endif
