/* SPDX-License-Identifier: BSD-2-Clause */
/* Thinning of step 3: of isotropic junctions that lie close together the most meaningful one stays. Close is 2 px in the default,
 * half the radius in preset paper (option isotropic_separation).
 *
 * ACJ lets M + 1 branches within half a radius replace M, however weak they are (more_branches_win). Then a chance branch at a
 * pixel beside a corner decides where the corner is and which branches it has: on eight photographs under zoom by 0.9, 0.7, 0.5 the
 * number of branches and their angles repeat at 44, 26, 14 % of the junctions with that rule, at 50, 34, 19 % without. */
#include "isotropic_thin.h"
#include "core/sort.h"

#include <string.h>

/* Ties are broken by place, so that the order never depends on anything else. */
static int by_place(const asj_isotropic_junction *p, const asj_isotropic_junction *q)
{
    return p->y != q->y ? p->y - q->y : p->x - q->x;
}

static int in_rows(const void *a, const void *b)
{
    return by_place(a, b);
}

static int by_meaning(const void *a, const void *b)
{
    const asj_isotropic_junction *p = a, *q = b;
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa ? -1 : 1;
    return by_place(p, q);
}

static int by_branches(const void *a, const void *b)
{
    const asj_isotropic_junction *p = a, *q = b;
    if (p->branch_count != q->branch_count)
        return q->branch_count - p->branch_count;
    return by_meaning(a, b);
}

#define MOST_REACH 24 /* px: a row of a disc fits into 56 bits from any bit on. Radii are at most 15 */
#define MOST_BYTES 7

/* Rows of a disc, from its middle one on: half of their pixels, without the middle one. */
typedef struct disc {
    double radius;
    int32_t bytes; /* that a row may touch */
    int32_t reach, half[MOST_REACH + 1];
} disc;

static void set_disc(disc *d, double radius)
{
    if (d->radius == radius)
        return;
    d->radius = radius;
    d->reach = radius < MOST_REACH ? (int32_t)radius : MOST_REACH;
    d->bytes = (2 * d->reach + 1 + 7 + 7) / 8;
    for (int32_t row = 0; row <= d->reach; row++) {
        int32_t half = 0;
        while ((half + 1) * (half + 1) + row * row <= radius * radius)
            half++;
        d->half[row] = half;
    }
}

/* Marks the disc around a junction in the bit map, behind which there is room for MOST_BYTES more. */
static void take(uint8_t *taken, int32_t width, int32_t height, int32_t x, int32_t y, const disc *d)
{
    const size_t row_bytes = ((size_t)width + 7) / 8;
    const int32_t top = y > d->reach ? y - d->reach : 0, bottom = y + d->reach < height ? y + d->reach : height - 1;
    for (int32_t row = top; row <= bottom; row++) {
        const int32_t half = d->half[row < y ? y - row : row - y];
        const int32_t left = x > half ? x - half : 0, right = x + half < width ? x + half : width - 1;
        const uint64_t bits = (((uint64_t)2 << (right - left)) - 1) << left % 8;
        uint8_t *bytes = taken + (size_t)row * row_bytes + left / 8;
        for (int32_t byte = 0; byte < d->bytes; byte++)
            bytes[byte] |= (uint8_t)(bits >> 8 * byte);
    }
}

/* A junction's place in the list and its log_nfa as a float, turned into a whole number in the same order; and its pixel. */
typedef struct rank {
    uint32_t key, index;
    uint16_t x, y;
} rank;

static uint32_t key_of(double log_nfa)
{
    const float rounded = (float)log_nfa + 0.0f; /* no negative zero */
    uint32_t bits;
    memcpy(&bits, &rounded, sizeof bits);
    return bits >> 31 ? ~bits : bits | 0x80000000u;
}

/* Ranks by meaningfulness: three passes over 11 bits of the keys each, then what the floats do not tell. `spare` is as long as
 * `ranks`; returns the one of both that holds the result. */
static rank *sort_ranks(const asj_isotropic_junction *junctions, rank *ranks, rank *spare, size_t count)
{
    for (int shift = 0; shift < 32; shift += 11) {
        size_t starts[2048] = {0}, next = 0;
        for (size_t i = 0; i < count; i++)
            starts[ranks[i].key >> shift & 2047]++;
        for (size_t b = 0; b < 2048; b++) {
            const size_t here = starts[b];
            starts[b] = next;
            next += here;
        }
        for (size_t i = 0; i < count; i++)
            spare[starts[ranks[i].key >> shift & 2047]++] = ranks[i];
        rank *swap = ranks;
        ranks = spare;
        spare = swap;
    }
    for (size_t i = 1; i < count; i++) {
        const rank moved = ranks[i];
        size_t j = i;
        for (; j > 0 && ranks[j - 1].key == moved.key; j--) {
            if (by_meaning(&junctions[ranks[j - 1].index], &junctions[moved.index]) <= 0)
                break;
            ranks[j] = ranks[j - 1];
        }
        ranks[j] = moved;
    }
    return ranks;
}

size_t asj_isotropic_thin_scratch(size_t count, int32_t width, int32_t height)
{
    return count * (2 * sizeof(rank) + 1) + ((size_t)width + 7) / 8 * (size_t)height + MOST_BYTES;
}

size_t asj_isotropic_thin(asj_isotropic_junction *junctions, size_t count, const asj_detect_options *options,
                          int32_t width, int32_t height, void *scratch)
{
    const size_t row_bytes = ((size_t)width + 7) / 8;
    rank *ranks = scratch, *spare = ranks + count;
    uint8_t *stays = (uint8_t *)(void *)(spare + count), *taken = stays + count;
    const double apart = options->isotropic_separation;
    disc around = {.radius = -1};
    size_t kept = 0;
    if (count == 0)
        return 0;
    if (options->more_branches_win)
        asj_sort(junctions, count, sizeof *junctions, by_branches);
    for (size_t i = 0; i < count; i++)
        ranks[i] = (rank){key_of(junctions[i].log_nfa), (uint32_t)i, junctions[i].x, junctions[i].y};
    const rank *order = options->more_branches_win ? ranks : sort_ranks(junctions, ranks, spare, count);
    memset(stays, 0, count + row_bytes * (size_t)height + MOST_BYTES);
    for (size_t i = 0; i < count; i++) {
        const rank *r = &order[i];
        if (taken[r->y * row_bytes + r->x / 8] >> r->x % 8 & 1)
            continue;
        set_disc(&around, apart > 0 ? apart : 0.5 * junctions[r->index].radius);
        take(taken, width, height, r->x, r->y, &around);
        stays[r->index] = 1;
    }
    for (size_t i = 0; i < count; i++)
        if (stays[i])
            junctions[kept++] = junctions[i];
    if (options->more_branches_win)
        asj_sort(junctions, kept, sizeof *junctions, in_rows);
    return kept;
}
