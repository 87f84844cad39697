/* SPDX-License-Identifier: BSD-2-Clause */
/* The L-junctions of one image as the matcher works on them: frames, length hypotheses, locations. */
#ifndef ASJ_SRC_L_JUNCTIONS_H
#define ASJ_SRC_L_JUNCTIONS_H

#include "affine.h"
#include "core/context.h"

#include <asj/match.h>

#define ASJ_MAX_HYPOTHESES 4

/* Lengths that a branch may have, its own first, then falling. */
typedef struct asj_lengths {
    int32_t count;
    float length[ASJ_MAX_HYPOTHESES];
    int32_t end; /* ASJ_BRANCH_END_...: what is at its own end */
} asj_lengths;

typedef struct asj_l_junctions {
    int32_t upsampled;            /* 1: all is in pixels of the image upsampled by two (image_features.c); 0: in its own */
    asj_l_junction *l;           /* as asj_decompose() gives them */
    uint32_t count;
    asj_lengths *lengths;        /* [2 * i] of branch a, [2 * i + 1] of branch b */
    double *direction;           /* [4 * i]: unit vectors of branch a and of branch b */
    float *direction_sd;         /* rad, [2 * i] of branch a, [2 * i + 1] of branch b: what the caller says, unchecked */
    uint32_t *first_frame;       /* frames of L-junction i: first_frame[i] .. first_frame[i + 1] - 1; own lengths come first */
    asj_affine_frame *frames;
    uint32_t frame_count;

    /* Distinct locations, in order of x. L-junctions of one junction share theirs; so do records of a file with the same
     * coordinates. Location p has l_of_location[first_of_location[p]] .. l_of_location[first_of_location[p + 1] - 1]. */
    uint32_t *location;          /* of each L-junction */
    uint32_t location_count;
    uint32_t *first_of_location;
    uint32_t *l_of_location;
    double *location_x, *location_y;
    uint8_t *octave;             /* of each L-junction: that located it, 0 .. ASJ_LARGEST_OCTAVE */
    int32_t home;                /* the finest octave of at least half as many as any; others are guests (guests.c) */
    uint32_t home_locations;     /* locations of that octave */
    float *log10_nfa;            /* of each L-junction: what the caller says of its junction; no NaN */
    uint8_t *t_junction;         /* of each L-junction: is it part of a T? One of its branches goes on beyond the location */
    uint32_t *neighbour;         /* [k * location .. + neighbour_count[location]]: nearest other locations that are no guests',
                                  * nearest first */
    uint32_t *neighbour_count;
    uint32_t neighbour_limit;    /* k */
} asj_l_junctions;

/* How many L-junctions are of octaves that the image itself has. Moves them to the front. */
uint32_t asj_l_junctions_of_image(const asj_junction *junctions, asj_l_junction *l, uint32_t count);

void asj_l_junctions_free(asj_memory *memory, asj_l_junctions *l_junctions);

/* L-junctions of another octave than home: they neither support nor lengthen others. */
static inline int asj_is_guest(const asj_l_junctions *all, uint32_t l)
{
    return all->octave[l] != all->home;
}

static inline int asj_is_guest_location(const asj_l_junctions *all, uint32_t location)
{
    return asj_is_guest(all, all->l_of_location[all->first_of_location[location]]);
}

#endif
