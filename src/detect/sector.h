/* SPDX-License-Identifier: BSD-2-Clause */
/* Sectors around a pixel, and the junction-ness of each: what steps 2 and 3 are built on. */
#ifndef ASJ_SRC_SECTOR_H
#define ASJ_SRC_SECTOR_H

#include "gradient.h"

/* Strengths are whole numbers in 1/256 of a standard deviation. */
#define ASJ_STRENGTH_ONE 256

/* Geometry and constants of the sectors of one radius; made once, then only read. */
typedef struct asj_sectors {
    int32_t radius;
    int32_t count;        /* K = floor(2 pi r) sectors, sector k points to 2 pi k / K */
    int32_t offset_count; /* pixels within the radius, in order of angle */
    int32_t largest;      /* pixels of the largest sector */
    int32_t gamma_bits;   /* junction-ness is held in 1 / 2^gamma_bits */
    int16_t *dx, *dy;     /* the offsets */
    int16_t *ux, *uy;     /* their unit vectors, 1 = 2^(gamma_bits + 6), at most 32767 in size */
    int32_t (*factors)[4]; /* of each offset: y, cross_x, x and dot_y of its asj_direction, each in both halves of a word */
    int32_t *first;       /* sector k: the `size[k]` offsets from `first[k]` on, circularly */
    int32_t *size;
    uint16_t *mean;       /* expected sum under the null model, 1 / 2^gamma_bits */
    uint16_t *scale;      /* strength = (max(sum - mean, 0) scale) >> 16 */
    void *memory;
} asj_sectors;

/* tau: half-width of a sector at its outer end, in pixels. */
asj_status asj_sectors_create(asj_memory *memory, int32_t radius, double tau, asj_sectors *sectors);
void asj_sectors_free(asj_memory *memory, asj_sectors *sectors);

/* sums[k] = junction-ness of sector k at a pixel. gamma[place[i]]: that of offset i (asj_sector_gammas()). `prefix`: scratch, one
 * element more than there are offsets. */
void asj_sector_sums(const asj_sectors *sectors, const int16_t *place, const uint16_t *gamma, uint16_t *prefix, uint16_t *sums);

/* The factors of gamma for an offset, with high halves of products:
 *     gamma = max(|gx y - gy cross_x| - |gx x - gy dot_y|, 0)
 * x = |ux|, y = |uy|, cross_x = x and dot_y = -y where ux and uy have the same sign; -x and y where not, the axis being turned so
 * that x >= 0. A difference of two products that are both rounded down is off by less than one unit, a sum would be by two. */
typedef struct asj_direction {
    int16_t x, y, cross_x, dot_y;
} asj_direction;

static inline asj_direction asj_sector_direction(const asj_sectors *sectors, int32_t offset)
{
    const int16_t ux = sectors->ux[offset], uy = sectors->uy[offset];
    const int16_t x = (int16_t)(ux < 0 ? -ux : ux), y = (int16_t)(uy < 0 ? -uy : uy);
    const int16_t sign = ux != 0 && uy != 0 && (ux < 0) != (uy < 0) ? -1 : 1;
    return (asj_direction){x, y, (int16_t)(sign * x), (int16_t)(-sign * y)};
}

/* The low half of a word in both halves: what vector forms multiply pairs of pixels by. */
int32_t asj_sector_twice(int32_t value);

static inline int16_t asj_high_product(int16_t a, int16_t b)
{
    return (int16_t)((int32_t)a * b >> 16);
}

/* gamma of a pixel with this gradient, whose offset has that direction. */
static inline uint16_t asj_sector_gamma(asj_direction u, int16_t gx, int16_t gy)
{
    const int16_t cross = (int16_t)(asj_high_product(gx, u.y) - asj_high_product(gy, u.cross_x)), back = (int16_t)-cross;
    const int16_t dot = (int16_t)(asj_high_product(gx, u.x) - asj_high_product(gy, u.dot_y)), other = (int16_t)-dot;
    const int16_t gamma = (int16_t)((cross > back ? cross : back) - (dot > other ? dot : other));
    return (uint16_t)(gamma > 0 ? gamma : 0);
}

/* Strength of a sum: standard deviations above the mean of the null model, 0 below the mean. */
static inline uint16_t asj_sector_strength(const asj_sectors *sectors, int32_t k, uint16_t sum)
{
    uint32_t excess = sum > sectors->mean[k] ? (uint32_t)sum - sectors->mean[k] : 0;
    return (uint16_t)(excess * sectors->scale[k] >> 16);
}

#endif
