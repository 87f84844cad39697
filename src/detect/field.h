/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 2: the local junction field. */
#ifndef ASJ_SRC_FIELD_H
#define ASJ_SRC_FIELD_H

#include "sector_plan.h"
#include "sector_runs.h"
#include "core/threads.h"

#include <asj/field.h>

#define ASJ_FIELD_MAX_RADIUS 9
#define ASJ_FIELD_MAX_SECTORS 56  /* of that radius */
#define ASJ_FIELD_MAX_OFFSETS 252

/* Most pixels of a row that asj_field_tile() looks at; with those between them (candidate_step), it may be as much wider. */
#define ASJ_FIELD_TILE 128

/* A branch of a very local junction; strength 0 = none. */
typedef struct asj_field_branch {
    uint16_t angle;    /* in 1/65536 of a turn */
    uint16_t strength; /* in 1/256 of a standard deviation */
} asj_field_branch;

typedef struct asj_field {
    asj_sectors sectors;
    asj_sector_plan plan;
    asj_sector_runs runs;
    int16_t place[ASJ_FIELD_MAX_OFFSETS];      /* of each offset in the runs */
    uint16_t keep[ASJ_FIELD_MAX_SECTORS];      /* least strength of a branch */
    uint16_t candidate[ASJ_FIELD_MAX_SECTORS]; /* least strength of a branch that makes a candidate */
    int32_t angle[ASJ_FIELD_MAX_SECTORS];      /* in 1/65536 of a turn */
    int32_t suppress;                          /* sectors to either side over which a branch must be the largest */
    int32_t apart;                             /* sectors that the two branches of a candidate are from 0 and from pi, at least */
    int32_t step;                              /* option candidate_step */
    int32_t limits[ASJ_FIELD_MAX_SECTORS][4];  /* for vector forms, each twice in 32 bits: mean, scale, keep - 1, candidate - 1 */
} asj_field;

asj_status asj_field_create(asj_context *context, const asj_detect_options *options, asj_field *field);
void asj_field_free(asj_memory *memory, asj_field *field);

/* Elements of uint16_t that the functions below need as scratch. */
size_t asj_field_scratch(const asj_field *field);

/* The branches at a pixel, strongest first. */
void asj_field_pixel(const asj_field *field, const asj_frame *frame, int32_t x, int32_t y, uint16_t *scratch,
                     asj_field_branch branches[ASJ_FIELD_BRANCHES]);

/* A pixel of the image. */
typedef struct asj_pixel {
    int32_t x, y;
} asj_pixel;

/* The branches at `count` pixels; those that are neighbours in a row should follow each other. */
void asj_field_pixels(const asj_field *field, const asj_frame *frame, const asj_pixel *pixels, int32_t count, uint16_t *scratch,
                      asj_field_branch (*branches)[ASJ_FIELD_BRANCHES]);

/* Whether a pixel with these strengths of all sectors is a candidate for a junction: it has two strong branches that are neither
 * parallel nor opposite. */
int asj_field_is_candidate(const asj_field *field, const uint16_t *strengths);

/* Part of an image: `runs` runs of ASJ_LANES pixels from run `run` on, in rows top .. bottom - 1. */
typedef struct asj_tile {
    int32_t run, runs;
    int32_t top, bottom;
} asj_tile;

/* Candidates in a tile of at most candidate_step * ASJ_FIELD_TILE columns (field_tile.c); those of run b of row y go to
 * masks[y * frame->blocks + b]. Pixels outside the image are none, nor those that asj_field_thin() clears. */
void asj_field_tile(const asj_field *field, const asj_frame *frame, const asj_tile *tile, uint16_t *scratch, uint16_t *masks);

/* The same for rows top .. bottom - 1 of the whole image, by all threads of the context. A device may fail. */
asj_status asj_field_rows(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                          const asj_scratch *scratch, uint16_t *masks);

/* The branches at all pixels of rows top .. bottom - 1, by all threads of the context: those of pixel (x, y) at
 * branches[(y - top) * width + x]. A device may fail. */
asj_status asj_field_branches(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                              const asj_scratch *scratch, asj_field_branch (*branches)[ASJ_FIELD_BRANCHES]);

/* ---- for the vector forms of the above ---- */

/* Pixels that a vector form of asj_field_pixels() may work on at once; the scratch has room for them. */
#define ASJ_FIELD_BATCH 32

/* How far the vertex of the parabola through three neighbouring strengths is from the middle one, whose sector is `width` wide. The
 * maximum is larger than the one before, so the denominator is positive. */
static inline int32_t asj_field_shift(int32_t width, int32_t before, int32_t peak, int32_t after)
{
    return (after - before) * width / (2 * (2 * peak - before - after));
}

/* Puts a branch into a pixel's list, strongest first; of equals the one put in first comes first. */
static inline void asj_field_insert(asj_field_branch list[ASJ_FIELD_BRANCHES], asj_field_branch branch)
{
    int i = ASJ_FIELD_BRANCHES - 1;
    if (branch.strength <= list[i].strength)
        return;
    for (; i > 0 && list[i - 1].strength < branch.strength; i--)
        list[i] = list[i - 1];
    list[i] = branch;
}

/* Whether row y has candidates. */
static inline int asj_field_has_candidates(const asj_field *field, int32_t y)
{
    return y % field->step == 0;
}

/* Clears the bits of pixels outside the image and of those in columns without candidates; masks[0] is that of run `run`. */
void asj_field_thin(const asj_field *field, const asj_frame *frame, int32_t run, int32_t runs, uint16_t *masks);

/* Elements of a plane of a tile's row (sector_plan.h) whose columns are candidate_step apart. */
size_t asj_field_plane_stride(const asj_field *field);

/* Operations (core/ops.h): step 2 of a band of rows and the whole field of one, which a device replaces, and their parts for a tile
 * and for single pixels. */
typedef struct asj_field_ops {
    /* asj_field_rows() */
    asj_status (*rows)(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                       const asj_scratch *scratch, uint16_t *masks);
    /* asj_field_branches() */
    asj_status (*branches)(asj_context *context, const asj_field *field, const asj_frame *frame, int32_t top, int32_t bottom,
                           const asj_scratch *scratch, asj_field_branch (*branches)[ASJ_FIELD_BRANCHES]);
    /* asj_field_tile() */
    void (*tile)(const asj_field *field, const asj_frame *frame, const asj_tile *tile, uint16_t *scratch, uint16_t *masks);
    /* asj_field_pixels() */
    void (*pixels)(const asj_field *field, const asj_frame *frame, const asj_pixel *pixels, int32_t count, uint16_t *scratch,
                   asj_field_branch (*branches)[ASJ_FIELD_BRANCHES]);
} asj_field_ops;
extern const asj_field_ops asj_field_reference;

#endif
