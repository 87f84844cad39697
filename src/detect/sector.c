/* SPDX-License-Identifier: BSD-2-Clause */
/* Sectors and junction-ness.
 *
 * Sector k of radius r (paper, eq. sector-def, with K = floor(2 pi r) directions theta_k = 2 pi k / K):
 *     S(r, theta_k) = { q != p : |q - p| <= r, d_2pi(alpha(pq), theta_k) <= Delta },   Delta = tau / r
 * Junction-ness (eq. junction-ness-branch, junction-ness-pairwise):
 *     omega_k = sum of gamma(q) over the sector,   gamma(q) = |g~| max(|cos(phi - alpha)| - |sin(phi - alpha)|, 0)
 * phi, the direction of the edge, is at right angles to the gradient, so that with the unit vector u from p to q
 *     gamma = max(|g~x uy - g~y ux| - |g~x ux + g~y uy|, 0)
 * without any trigonometry, and the same for u and -u. Which products are taken (asj_sector_direction()) makes this hold to the
 * bit, and makes the four axes that mirror each other at the coordinate axes and the diagonals share theirs: back ends compute
 * gamma once for each axis and pixel.
 * Strength (eq. junction-ness-branch-fix-scale): z_k = (omega_k - J_k mu) / (sigma sqrt(J_k)), J_k pixels in the sector.
 *
 * The number of pixels differs from sector to sector; J_k is that of sector k. Offsets are sorted by angle once; a sector is then a
 * circular run of them, and all sums come from one prefix sum and K differences.
 *
 * Whole numbers: the gradient is in 1/1024, u in 2^-(bits + 6), and a product is the high half of the 16 x 16 bit product, so
 * gamma is in 2^-bits with bits = 9. Prefix sums may wrap around 16 bits; a sector's sum may not. |g~| <= L = 3.5 (gradient.c) and
 * each gamma is off by at most 2 units, hence a sum is below J (L 2^bits + 2): bits is 9 for sectors of up to 36 pixels and
 * smaller for larger ones.
 *
 * Border: outside the image the gradient is zero. Sectors keep their full number of pixels there, so evidence is never invented and
 * the number of false alarms stays a bound; branches that point inwards lose nothing. */
#include "sector.h"
#include "nfa.h"
#include "core/angle.h"
#include "core/sort.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct offset {
    double angle;
    int32_t squared, dx, dy;
} offset;

static int by_angle(const void *a, const void *b)
{
    const offset *p = a, *q = b;
    if (p->angle != q->angle)
        return p->angle < q->angle ? -1 : 1;
    return p->squared - q->squared;
}

/* Those of a quadrant, 0 <= angle < pi / 2, in any order. Returns how many there are; NULL counts. */
static int32_t list_quadrant(int32_t radius, offset *list)
{
    int32_t count = 0;
    for (int32_t dy = 0; dy <= radius; dy++)
        for (int32_t dx = 1; dx * dx + dy * dy <= radius * radius; dx++, count++)
            if (list)
                list[count] = (offset){atan2(dy, dx), dx * dx + dy * dy, dx, dy};
    return count;
}

/* The other quadrants are the first one turned. */
static void list_offsets(int32_t radius, offset *list)
{
    const int32_t count = list_quadrant(radius, list);
    asj_sort(list, (size_t)count, sizeof *list, by_angle);
    for (int32_t i = count; i < 4 * count; i++) {
        const offset *before = &list[i - count];
        list[i] = (offset){before->angle + 0.25 * ASJ_TWO_PI, before->squared, -before->dy, before->dx};
    }
}

/* One block for all arrays. */
static asj_status make_room(asj_memory *memory, asj_sectors *s)
{
    size_t offsets = (size_t)s->offset_count, count = (size_t)s->count;
    const size_t per_offset = sizeof *s->factors + 4 * sizeof(int16_t), per_sector = 2 * sizeof(int32_t) + 2 * sizeof(uint16_t);
    s->memory = asj_allocate(memory, 1, offsets * per_offset + count * per_sector);
    if (!s->memory)
        return ASJ_ERROR_MEMORY;
    s->factors = s->memory;
    s->first = (int32_t *)(s->factors + offsets);
    s->size = s->first + count;
    s->dx = (int16_t *)(s->size + count);
    s->dy = s->dx + offsets;
    s->ux = s->dy + offsets;
    s->uy = s->ux + offsets;
    s->mean = (uint16_t *)(s->uy + offsets);
    s->scale = s->mean + count;
    return ASJ_OK;
}

static int in_sector(double alpha, double theta, double half_width)
{
    double distance = fabs(alpha - theta);
    distance = distance > ASJ_TWO_PI / 2 ? ASJ_TWO_PI - distance : distance;
    return distance <= half_width + 1e-5; /* ties are in, whatever the rounding */
}

static int32_t common_divisor(int32_t a, int32_t b)
{
    return b == 0 ? a : common_divisor(b, a % b);
}

/* The unit vector of an offset is made from its smallest parallel and is the same, but for signs and order, in all eight
 * octants. */
static void set_direction(asj_sectors *s, int32_t i, double unit)
{
    const int32_t size_x = abs(s->dx[i]), size_y = abs(s->dy[i]), divisor = common_divisor(size_x, size_y);
    const double x = size_x / divisor, y = size_y / divisor, length = sqrt(x * x + y * y);
    const int32_t ux = (int32_t)lrint(fmin(unit * x / length, 32767)), uy = (int32_t)lrint(fmin(unit * y / length, 32767));
    s->ux[i] = (int16_t)(s->dx[i] < 0 ? -ux : ux);
    s->uy[i] = (int16_t)(s->dy[i] < 0 ? -uy : uy);
}

int32_t asj_sector_twice(int32_t value)
{
    const uint32_t half = (uint32_t)value & 0xffff, both = half << 16 | half;
    int32_t word;
    memcpy(&word, &both, sizeof word);
    return word;
}

static void set_factors(asj_sectors *s, int32_t i)
{
    const asj_direction u = asj_sector_direction(s, i);
    s->factors[i][0] = asj_sector_twice(u.y);
    s->factors[i][1] = asj_sector_twice(u.cross_x);
    s->factors[i][2] = asj_sector_twice(u.x);
    s->factors[i][3] = asj_sector_twice(u.dot_y);
}

/* The members of sector k are a circular run: finds where it starts, looking from offset `from` on, and how long it is. */
static void find_run(asj_sectors *s, const offset *list, double half_width, int32_t k, int32_t from)
{
    const double theta = ASJ_TWO_PI * k / s->count;
    const int32_t end = from + s->offset_count;
    int32_t first = from;
    while (first < end && !in_sector(list[first % s->offset_count].angle, theta, half_width))
        first++;
    s->first[k] = first % s->offset_count;
    s->size[k] = 0;
    while (s->size[k] < s->offset_count && in_sector(list[(first + s->size[k]) % s->offset_count].angle, theta, half_width))
        s->size[k]++;
}

/* Sectors start one after the other, the first one at most half a turn before the offset that points along it. */
static void find_runs(asj_sectors *s, const offset *list, double half_width)
{
    int32_t from = s->offset_count / 2;
    for (int32_t k = 0; k < s->count; k++) {
        find_run(s, list, half_width, k, from);
        from = s->first[k];
    }
}

static void fill(asj_sectors *s, const offset *list, double tau)
{
    s->largest = 0;
    find_runs(s, list, tau / s->radius);
    for (int32_t k = 0; k < s->count; k++)
        if (s->size[k] > s->largest)
            s->largest = s->size[k];
    s->gamma_bits = 9;
    while (s->largest * (ASJ_GRADIENT_LIMIT * (1 << s->gamma_bits) + 2) > 65535)
        s->gamma_bits--;
    const double one = (double)(1 << s->gamma_bits), unit = one * 64;
    for (int32_t i = 0; i < s->offset_count; i++) {
        s->dx[i] = (int16_t)list[i].dx;
        s->dy[i] = (int16_t)list[i].dy;
        set_direction(s, i, unit);
        set_factors(s, i);
    }
    for (int32_t k = 0; k < s->count; k++) {
        s->mean[k] = (uint16_t)lrint(one * ASJ_GAMMA_MEAN * s->size[k]);
        s->scale[k] = (uint16_t)lrint(65536.0 * ASJ_STRENGTH_ONE / (one * ASJ_GAMMA_SD * sqrt(s->size[k])));
    }
}

asj_status asj_sectors_create(asj_memory *memory, int32_t radius, double tau, asj_sectors *s)
{
    memset(s, 0, sizeof *s);
    s->radius = radius;
    s->count = (int32_t)(ASJ_TWO_PI * radius);
    s->offset_count = 4 * list_quadrant(radius, NULL);
    offset *list = asj_allocate(memory, (size_t)s->offset_count, sizeof *list);
    asj_status status = list ? make_room(memory, s) : ASJ_ERROR_MEMORY;
    if (status == ASJ_OK) {
        list_offsets(radius, list);
        fill(s, list, tau);
    }
    asj_release(memory, list);
    return status;
}

void asj_sectors_free(asj_memory *memory, asj_sectors *s)
{
    asj_release(memory, s->memory);
    memset(s, 0, sizeof *s);
}

void asj_sector_sums(const asj_sectors *s, const int16_t *place, const uint16_t *gamma, uint16_t *prefix, uint16_t *sums)
{
    const int32_t count = s->offset_count;
    uint16_t total = 0;
    for (int32_t i = 0; i < count; i++) {
        prefix[i] = total;
        total = (uint16_t)(total + gamma[place[i]]);
    }
    prefix[count] = total;
    for (int32_t k = 0; k < s->count; k++) {
        const int32_t first = s->first[k], end = first + s->size[k], past = end - count;
        sums[k] = (uint16_t)(past > 0 ? prefix[count] - prefix[first] + prefix[past] : prefix[end] - prefix[first]);
    }
}
