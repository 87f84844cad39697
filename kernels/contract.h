/* SPDX-License-Identifier: BSD-2-Clause */
/* What the host and the kernels agree upon: limits, shapes of tables, structs. C99 and OpenCL C alike: embed.py puts it in front of
 * every program, the files of src/cl include it, and nobody else. Numbers that belong to a step are held against the step's own in
 * src/cl/contract.c when that is compiled. */
#ifndef ASJ_KERNELS_CONTRACT_H
#define ASJ_KERNELS_CONTRACT_H

#ifdef __OPENCL_VERSION__
typedef int shared_int;
typedef long shared_long;
typedef ulong shared_ulong;
#else
#include <stdint.h>
typedef int32_t shared_int;
typedef int64_t shared_long;
typedef uint64_t shared_ulong;
#endif

/* ---- planes: sample (x, y) at [(y - base) * stride + x + MARGIN], row `base` being the first that the buffer holds ---- */

#define MARGIN 32
#define LANES 16 /* pixels of a mask; candidates of a batch */

/* ---- gradient.cl ---- */

#define GRADIENT_ONE 1024
#define GRADIENT_SIGMA 7825 /* sigma_0 in 1/10000 */
#define GRADIENT_LIMIT 93   /* round(256 / (sigma_0 L)) */
#define GRADIENT_PIXELS 8   /* of a row by a work item, */
#define GRADIENT_ROWS 4     /* and so many of these pieces, one below the other, in gradient_normalise */

/* ---- tables of sectors (src/detect/sector_plan.h), in ints ---- */

/* Of each offset. */
enum {
    OFFSET_DX, OFFSET_DY, OFFSET_X, OFFSET_Y, OFFSET_CROSS_X, OFFSET_DOT_Y,
    SCAN_OFFSET_INTS,
    OFFSET_PLANE = SCAN_OFFSET_INTS, /* field.cl: its plane */
    FIELD_OFFSET_INTS
};

/* Of each sector. */
enum {
    SECTOR_LOW, SECTOR_HIGH, /* slots */
    SECTOR_MEAN, SECTOR_SCALE,
    SECTOR_LEAST,            /* strength of a branch that counts */
    FIELD_SECTOR_INTS,
    SECTOR_FIRST = FIELD_SECTOR_INTS, SECTOR_SIZE, /* isotropic.cl: its offsets */
    ISOTROPIC_SECTOR_INTS
};

/* ---- field.cl. Its table: a, b of each family; FIELD_OFFSET_INTS for each offset; where each plain slot ends; which plain slot
 * each extra slot adds to the total; FIELD_SECTOR_INTS for each sector ---- */

#define FIELD_MAX_OFFSETS 252 /* of radius 9 */
#define FIELD_TILE 128        /* pixels of a row that a work item of field_tiles takes, */
#define FIELD_GROUP 4         /* so many vectors of LANES pixels at once */

typedef struct field_sizes {
    shared_int radius, sectors, suppress, apart, families, offsets, plain_slots, slots, step;
} field_sizes;

/* ---- isotropic.cl. Its table: RADIUS_INTS for each radius, which say where in the table the rest is. Gammas are held by runs of
 * RUN neighbours in a row (src/detect/sector_runs.h) ---- */

#define MAX_BRANCHES 5
#define RUN 8

enum {
    RADIUS_SECTORS, RADIUS_SUPPRESS, RADIUS_PLAIN_SLOTS, RADIUS_SLOTS,
    RADIUS_RUNS,      /* number of runs when gammas of its own are made; 0 = those of the radius before serve it */
    RADIUS_RUN_AT,    /* RUN_INTS for each of these */
    RADIUS_PLACE_AT,  /* for each offset: its place in the runs */
    RADIUS_SLOT_AT,   /* where each plain slot ends; which plain slot each extra slot adds to the total */
    RADIUS_SECTOR_AT, /* ISOTROPIC_SECTOR_INTS for each sector */
    RADIUS_INTS
};
enum {
    RUN_DX, RUN_DY,
    RUN_X, RUN_Y = RUN_X + RUN, RUN_CROSS_X = RUN_Y + RUN, RUN_DOT_Y = RUN_CROSS_X + RUN, /* RUN of each */
    RUN_INTS = RUN_DOT_Y + RUN
};

/* ---- ray_scan.cl. Its tables: SCAN_OFFSET_INTS for each offset, and on as for field.cl; cos and sin of d / r in 2^-30 at
 * [r SCAN_TABLE_WIDTH + d], then those of SCAN_UNITS angles in 2^-14 ---- */

#define SCAN_BRANCHES 4
#define SCAN_MAX_SECTORS 56 /* of radius 9 */
#define SCAN_MAX_SLOTS 176  /* two for each sector, and one more for each that runs past the last offset */
#define SCAN_TABLE_RADIUS 256
#define SCAN_TABLE_WIDTH 4
#define SCAN_UNITS 1024
#define SCAN_REOPEN 3       /* these three: src/detect/ray_walk.h */
#define SCAN_STRIDE 4
#define SCAN_PLAIN 4

typedef struct scan_sizes {
    shared_int radius, sectors, suppress, offsets, plain_slots, slots;
} scan_sizes;

typedef struct scan_ray {
    shared_long x, y;      /* start, 1/65536 px */
    shared_int ux, uy;     /* direction, 2^-30 */
    shared_int angle;      /* of it, 1/65536 of a turn */
    shared_int radius;     /* of the next step; 0 = the ray has ended */
    shared_int looked;     /* last step that is to be looked at by itself */
    shared_int forward, axial;
    shared_int forward_failures, ahead_passes, ahead_failures, axial_failures;
    shared_int missed;     /* a stride of a rough scan has failed */
    shared_int passed;     /* how far there is an edge for sure, when the end of the band has come before that of the edge */
    shared_int reserved;   /* whole 64 bits */
} scan_ray;

typedef struct scan_image {
    shared_int width, height, blocks, half_width, tolerance, axial, rough, bridge, threshold;
    shared_int ahead;        /* steps that a ray asks for, beside a quarter of its length */
    shared_int edge;         /* least sum of gamma of a row under which there is an edge, 2^-24 */
    shared_int stride, base; /* of the planes */
    shared_int low, high;    /* the band of rows that rays are walked in, high not included; run 0 is in row `low` */
} scan_image;

/* ---- patch.cl ---- */

#define PATCH_LEVELS 6
#define PATCH_GRID_BITS 13
#define PATCH_UNIT_ONE 16384
#define PATCH_GRAY_ONE 128

/* The pyramid's planes, one after the other in a buffer. */
typedef struct patch_pyramid {
    shared_int width[PATCH_LEVELS], height[PATCH_LEVELS];
    shared_int offset[PATCH_LEVELS]; /* of the level's first element */
} patch_pyramid;

typedef struct patch_grid {
    shared_int level, x, y, ax, ay, bx, by;
} patch_grid;

typedef struct patch_sums {
    shared_int inside, sum;
    shared_ulong squares;
} patch_sums;

/* ---- distance.cl ---- */

#define NO_PARTNER (-2147483647 - 1)
#define PRODUCT_ROWS 4    /* frames of image 1 */
#define PRODUCT_COLUMNS 2 /* and 2 of a work item */

#endif
