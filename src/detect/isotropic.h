/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 3: isotropic junctions, by the a-contrario test of ACJ. */
#ifndef ASJ_SRC_ISOTROPIC_H
#define ASJ_SRC_ISOTROPIC_H

#include "core/angle.h"
#include "field.h"
#include "null_model.h"

#define ASJ_MAX_RADIUS 30

/* Directions of a junction are in so many parts of a turn. */
#define ASJ_ISOTROPIC_TURN 65536

/* A junction with one radius for all branches. */
typedef struct asj_isotropic_junction {
    uint16_t x, y;
    uint16_t radius;
    uint16_t branch_count;
    uint16_t angle[ASJ_MAX_BRANCHES];    /* in 1/65536 of a turn */
    uint16_t strength[ASJ_MAX_BRANCHES]; /* in 1/256 of a standard deviation */
    uint32_t meaningful;                 /* bit i: at radius i of the test; only kept when persistence is more than 1 */
    double log_nfa;                      /* natural logarithm */
} asj_isotropic_junction;

/* Constants of one radius. */
typedef struct asj_isotropic_radius {
    asj_sectors sectors;
    asj_sector_plan plan;
    int32_t source;       /* index of the largest radius with the same unit vectors: its offsets hold those of this one, */
    int16_t *place;       /* offset i in its runs at place[i] */
    asj_sector_runs runs; /* of a radius that is a source */
    int32_t suppress;     /* sectors to either side over which a branch must be the largest */
    int32_t straight;     /* two branches that are more sectors apart are an edge: by more than pi - 2 Delta */
    const double **tails; /* for each sector: ln F(i / ASJ_TAIL_STEPS; J_k), i = 0, 1, .. */
    const double *lowest_tail; /* the lowest of them: that of the sector with the fewest pixels */
    double lowest_end;    /* and the largest sum that such a sector may have: its table ends there */
    int32_t least_sum[ASJ_MAX_BRANCHES + 1]; /* of M branches the weakest has at least this sum, or they are not meaningful */
    double (*units)[2];   /* for each sector: cosine and sine of its direction, as junctions have it */
    uint16_t *least;      /* for each sector: the least strength of a branch that may be one of meaningful ones */
} asj_isotropic_radius;

/* The whole test: made once for a set of options and an image size. */
typedef struct asj_isotropic {
    int32_t radius_count;
    asj_isotropic_radius radii[ASJ_MAX_RADIUS + 1];
    double log_tests[ASJ_MAX_BRANCHES + 1]; /* ln #J(M) */
    double log_epsilon;
    double log_alone;     /* ln F of a branch that is meaningful: two like it are a meaningful junction */
    int32_t all_meaningful; /* such branches all belong to a junction */
    int32_t max_branches;
    int32_t persistence;  /* radii in a row at which a junction is meaningful, at least */
    double *tail_tables[128]; /* by number of pixels, of those that are not stored; shared by the radii */
    size_t scratch;           /* elements of uint16_t for asj_isotropic_pixel() and asj_isotropic_band() */
} asj_isotropic;

asj_status asj_isotropic_create(asj_context *context, const asj_detect_options *options, asj_isotropic *test);
void asj_isotropic_free(asj_memory *memory, asj_isotropic *test);

/* Sets the numbers of tests for an image of this size, and what follows from them. */
void asj_isotropic_set_size(const asj_detect_options *options, int32_t width, int32_t height, int32_t octaves,
                            asj_isotropic *test);

/* Whether a junction that was tested is one: meaningful, at enough radii in a row. */
int asj_isotropic_persists(const asj_isotropic *test, const asj_isotropic_junction *junction);

/* Cosine and sine of the directions of a junction that the test has made. */
void asj_isotropic_units(const asj_isotropic *test, const asj_isotropic_junction *junction, double units[ASJ_MAX_BRANCHES][2]);

/* Tests a pixel. A candidate that no radius makes meaningful has branch_count 0. */
void asj_isotropic_pixel(const asj_isotropic *test, const asj_frame *frame, int32_t x, int32_t y, uint16_t *scratch,
                         asj_isotropic_junction *junction);

/* Tests the candidates of rows top .. bottom - 1, bits of the whole image's `masks`. Records in order of y, then x. */
void asj_isotropic_band(const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom, const uint16_t *masks,
                        uint16_t *scratch, asj_isotropic_junction *junctions);

/* The candidates of rows top .. bottom - 1, and how their records follow each other. */
typedef struct asj_candidate_rows {
    int32_t top, bottom;
    const uint16_t *masks; /* of the whole image */
    const size_t *starts;  /* records of row y start at starts[y - top]; starts[bottom - top] ends the last */
} asj_candidate_rows;

/* The same by all threads of the context. A device may fail. */
asj_status asj_isotropic_rows(asj_context *context, const asj_isotropic *test, const asj_frame *frame,
                              const asj_candidate_rows *rows, const asj_scratch *scratch, asj_isotropic_junction *junctions);

/* ---- for the vector forms of the above ---- */

/* Lanes that a vector form may use at most; asj_isotropic.scratch has room for them. */
#define ASJ_ISOTROPIC_LANES 32

/* A branch at one radius. */
typedef struct asj_isotropic_peak {
    int32_t sector;
    uint16_t sum, strength;
} asj_isotropic_peak;

/* rad */
static inline double asj_isotropic_angle(uint16_t angle)
{
    return angle * (ASJ_TWO_PI / ASJ_ISOTROPIC_TURN);
}

/* ln F at junction-ness t >= 0 from one of the tables. */
static inline double asj_isotropic_log_tail(const double *table, double t)
{
    const double position = t * ASJ_TAIL_STEPS;
    const int32_t i = (int32_t)position;
    const double rest = position - i;
    return table[i] * (1 - rest) + table[i + 1] * rest;
}

/* Makes *best the junction of these branches, strongest first, if that one is meaningful, and more so than *best. Branches are
 * ordered by sum; of equals the one with the lower sector comes first. */
void asj_isotropic_judge(const asj_isotropic *test, const asj_isotropic_radius *entry, const asj_isotropic_peak *peaks,
                         int32_t count, asj_isotropic_junction *best);

/* Operations (core/ops.h): step 3 by all threads, which a device replaces, and for the rows of one. */
typedef struct asj_isotropic_ops {
    /* asj_isotropic_rows() */
    asj_status (*rows)(asj_context *context, const asj_isotropic *test, const asj_frame *frame, const asj_candidate_rows *rows,
                       const asj_scratch *scratch, asj_isotropic_junction *junctions);
    /* asj_isotropic_band() */
    void (*band)(const asj_isotropic *test, const asj_frame *frame, int32_t top, int32_t bottom, const uint16_t *masks,
                 uint16_t *scratch, asj_isotropic_junction *junctions);
} asj_isotropic_ops;
extern const asj_isotropic_ops asj_isotropic_reference;

#endif
