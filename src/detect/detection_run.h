/* SPDX-License-Identifier: BSD-2-Clause */
/* One pass of the detector over one image: what its steps share (steps.h lists them, detect.c runs them). */
#ifndef ASJ_SRC_DETECTION_RUN_H
#define ASJ_SRC_DETECTION_RUN_H

#include "edge_evidence.h"
#include "guess.h"
#include "octaves.h"
#include "scan.h"
#include "scan_cache.h"
#include "sizes.h"
#include "core/image.h"

/* What a context keeps from image to image. The tables hold for a set of options; only their numbers of tests depend on the size
 * of the image, and asj_isotropic_set_size() and asj_scan_set_size() change those. */
typedef struct asj_detector {
    asj_detect_options options; /* that the tables were made for */
    int ready;                  /* 0 = there are none yet */
    asj_field field;
    asj_isotropic isotropic;
    asj_scan scan;
    int32_t width, height;      /* that the numbers of tests were set for, */
    int32_t octaves;            /* and for so many octaves */
    asj_frame frame;            /* planes, during a pass */
    asj_scan_cache scan_cache;
} asj_detector;

/* Steps read tables and planes through these pointers and nowhere else. So a pass may run on any frame, for example that of a level
 * of a pyramid: coordinates are its own, numbers of tests are those of its own size, and octaves_step.c merges what the passes
 * have found. */
typedef struct asj_detection_run {
    asj_context *context;
    const asj_detect_options *options;
    asj_detect_options defaults;     /* what `options` points to when the caller gives none */
    const asj_image *image;
    const asj_region *region;        /* NULL = everywhere */
    asj_colour_planes planes;        /* that are looked at, one after the other, */
    int32_t plane;                   /* ASJ_PLANE_... of them */
    int32_t one_list;                /* 1 = the octaves of a plane become one list, and share the false alarms */
    int32_t sharing;                 /* octaves of all planes that do */
    asj_frame *frame;                /* its planes, or those of the image made 2^-octave as large: step 1 fills them */
    double octave;
    asj_gray_plane kept;             /* with half_octaves: grey plane of the whole octave while the one half-way is looked at */
    const asj_field *field;          /* tables of steps 2, .. */
    const asj_isotropic *test;       /* .. 3 .. */
    const asj_scan *scan;            /* .. and 4 */
    asj_scratch scratch;             /* for as many threads as the context has */

    uint16_t *candidates;            /* step 2: one bit for each pixel; run b of row y at [y * blocks + b] */
    size_t candidate_count;          /* step 3 counts them */
    asj_isotropic_junction *isotropic; /* step 3 */
    size_t isotropic_count;
    asj_guess *guesses;              /* of these; after the location those that a better one hides */
    size_t guess_count, guess_capacity;
    asj_hypothesis *hypotheses;
    size_t hypothesis_capacity;
    size_t hypothesis_count;
    int32_t choice;                  /* 0; 1 = of what a better one has suppressed that failed (detect.c) */
    size_t validated;                /* hypotheses at the front that the first choice has validated */
    asj_hypothesis *all;             /* of the octaves that are done, in pixels of the image */
    size_t all_count, all_capacity;
    asj_hypothesis *found;           /* of the planes that are done, likewise */
    size_t found_count, found_capacity;
    size_t candidate_total, isotropic_total; /* and how many of these they had */
    struct asj_luma_found *luma;     /* luma_step.h; NULL: not kept */
    int32_t size;                    /* with three_sizes: 0, 1, 2; */
    asj_sizes sizes;                 /* what those before it have found, */
    const asj_image *whole;          /* the caller's image and region; while another size is looked at .. */
    const asj_region *whole_region;
    asj_image other;                 /* .. this is `image`, which has a size and no pixels, .. */
    asj_size_place *places;          /* .. and here alone it is looked at */
    size_t place_count;
    int32_t *size_cells;             /* grids of what those before it have found */
    asj_size_place *rejected;        /* of the image itself, by validation */
    size_t rejected_count, rejected_capacity;
    asj_evidence *evidence;          /* of branches of all octaves, by asj_hypothesis_branch.evidence */
    size_t evidence_count, evidence_capacity;
    asj_edge *edges;                 /* between hypotheses */
    size_t edge_count;

    double done, share;              /* progress: of the whole before this octave, and by it */
    double stage_ms[16];             /* time spent in each stage (ASJ_STAGE_...) up to `clock`, in milliseconds */
    double clock;
} asj_detection_run;

/* Rows are worked on in groups, between which progress is reported. */
#define ASJ_ROW_GROUP 128

/* Junctions that a thread needs to be worth waking in steps that fit lines: 20 us and more. One at a time, as long branches take
 * ten times as long as short ones. */
#define ASJ_LEAST_JUNCTIONS 2
#define ASJ_JUNCTIONS_AT_ONCE 1

/* Checks the arguments of a public function that writes to `output`, makes the tables for the options (NULL = default) and the
 * planes for the image. Whatever the result, asj_detection_run_end() releases what the run holds. */
asj_status asj_detection_run_begin(asj_detection_run *run, asj_context *context, const asj_image *image,
                                   const asj_detect_options *options, const void *output);
void asj_detection_run_end(asj_detection_run *run);

/* Sets the frame up for the first octave of a plane. */
asj_status asj_detection_run_start_plane(asj_detection_run *run);

/* What the octaves that are done know; the caller releases known->grid.heads. */
asj_status asj_detection_run_known(const asj_detection_run *run, asj_octave_known *known);

/* Numbers of tests and an empty cache for the size of the frame. */
asj_status asj_detection_run_set_size(asj_detection_run *run);

/* Whether this is an octave that soft edges are left to by finer ones. */
int asj_detection_run_is_coarse(const asj_detection_run *run);

/* Releases what steps 3 to 5 have found; the candidates' memory serves the next octave. */
void asj_detection_run_clear(asj_detection_run *run);

/* Releases what looks have put by. */
void asj_detection_run_clear_sizes(asj_detection_run *run);

/* Length of a list that is allocated for `count` elements: room for a few when there are hardly any, so that the next of a stream
 * of pictures needs no more. */
size_t asj_detection_run_room(size_t count);

/* What is done to one hypothesis, without a look at the others. */
typedef void (*asj_hypothesis_work)(const asj_detection_run *run, asj_hypothesis *hypothesis);

/* Does it to every hypothesis that is not validated, by the threads of the context, until the caller stops it. `least`: so many of
 * them make a thread worth waking. */
asj_status asj_detection_run_each(asj_detection_run *run, int32_t stage, int32_t least, asj_hypothesis_work work);

/* Rejected hypotheses that are not validated go. */
void asj_detection_run_drop_rejected(asj_detection_run *run);

/* Reports that the stage is done up to here, as a part of the pass over one octave; ASJ_ERROR_CANCELLED when the caller wants to
 * stop. */
asj_status asj_detection_run_progress(const asj_detection_run *run, int32_t stage, double done);

/* Adds the time since the last call to the stage. */
void asj_detection_run_time(asj_detection_run *run, int32_t stage);

/* ---- what the caller sees of the steps (asj_context_options.dump) ---- */

/* `kind`: ASJ_DUMP_PLANE_...; a value of 1 in the plane means `unit`. */
void asj_detection_run_dump_plane(const asj_detection_run *run, int32_t kind, const char *name, const void *data, double unit);

/* Hands out `count` points as x, y, x, y, .. */
void asj_detection_run_dump_points(const asj_detection_run *run, int32_t stage, const char *name, size_t count,
                                   const int32_t *points);

/* The same from the places of the hypotheses that are not rejected. No memory is an error like any other. */
asj_status asj_detection_run_dump_hypotheses(const asj_detection_run *run, int32_t stage, const char *name);

#endif
