/* SPDX-License-Identifier: BSD-2-Clause */
/* Hypotheses of several octaves become one list. Octave o works on the image halved o times, octave -1 on the image upsampled by
 * two, octave o + 1/2 on that of o made 1 / sqrt 2 as large. */
#ifndef ASJ_SRC_OCTAVES_H
#define ASJ_SRC_OCTAVES_H

#include "octave_grid.h"

/* The octaves that the options ask for and an image of this size has: first .. end - 1, at least one, and those between. */
typedef struct asj_octave_range {
    int32_t first, end;
    int32_t count; /* with those between */
    double pixels; /* of all of them */
} asj_octave_range;

asj_octave_range asj_octaves_of(const asj_detect_options *options, int32_t width, int32_t height);

/* How many octaves share the false alarms, and find each other's junctions. */
int32_t asj_octaves_sharing(const asj_detect_options *options, int32_t width, int32_t height);

/* From the pixels of an octave to those of the image; the hypothesis and its branches belong to that octave from then on. */
void asj_octaves_map(asj_hypothesis *hypothesis, double octave);

/* Merges hypotheses in pixels of the image, each octave's without duplicates: see octaves.c. Returns how many stay, at the front,
 * in no order that matters. `cells` is scratch of asj_octave_grid_cells() elements. */
size_t asj_octaves_merge(asj_hypothesis *hypotheses, size_t count, const asj_detect_options *options, int32_t width, int32_t height,
                         int32_t *cells);

/* What is known of hypotheses by now: a pixel and directions, or the lines. */
enum { ASJ_KNOWN_PIXEL, ASJ_KNOWN_LINES };

/* What finer octaves have located well is not followed again by coarser ones. */
typedef struct asj_octave_known {
    asj_octave_grid grid;         /* of the sharp ones of `finer` */
    const asj_hypothesis *finer;  /* in pixels of the image; NULL = none */
    double octave;                /* the coarser one */
    const asj_detect_options *options;
} asj_octave_known;

/* `cells` as above, for `count`. */
asj_octave_known asj_octave_known_start(const asj_hypothesis *finer, size_t count, double octave, const asj_detect_options *options,
                                        int32_t width, int32_t height, int32_t *cells);

/* Whether a hypothesis in pixels of the coarser octave would not survive the merge and could add nothing: one that lies at a sharp
 * finer one, which has all its directions; and a ghost, once lines are known. `what`: ASJ_KNOWN_... */
int asj_octave_is_known(const asj_octave_known *known, const asj_hypothesis *hypothesis, int what);

#endif
