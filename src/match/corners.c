/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, preparation: from junctions to L-junctions with frames, length hypotheses, places and neighbours.
 *
 * Length hypotheses. A branch that passes other junctions may end at one of them in the other image: occlusion, weak contrast and
 * crossing lines all cut or prolong the scan. So besides its own length a branch is given, longest first, the distances of other
 * junctions that lie within 3 px of it, at least 10 px from its start and 8 px before its end, and 4 px apart. Every
 * combination of both branches' lengths is one frame.
 *
 * A place is a location. Matches are unique by place, and "another place" in the ratio test means farther than `separation`.
 * Neighbours of a place are the nearest others farther than `separation`, so that a cluster of duplicates is no neighbour of
 * itself. */
#include "corners.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define MOST_OUTSIDE ((float)ASJ_MAX_OUTSIDE) /* px: where branches meet may lie a little outside the image */
#define LEAST_LENGTH 3.0     /* px: a shorter branch has no direction worth a frame */
#define RAY_DISTANCE 3.0     /* px */
#define LEAST_START 10.0     /* px */
#define LEAST_BEFORE_END 8.0 /* px */
#define LEAST_APART 4.0      /* px */
#define OPPOSITE (-0.978147601) /* cosine of 180 - 12 degrees: half the least opening of branches, and less */

static asj_status check(asj_context *context, const asj_junction *junctions, size_t count, int32_t width, int32_t height,
                        int32_t which)
{
    for (size_t n = 0; n < count; n++) {
        const asj_junction *j = &junctions[n];
        if (!(j->x >= -MOST_OUTSIDE && j->y >= -MOST_OUTSIDE && j->x <= (float)(width - 1) + MOST_OUTSIDE &&
              j->y <= (float)(height - 1) + MOST_OUTSIDE))
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu of image %d at (%g, %g) lies outside its %d x %d pixels",
                            n, (int)which, (double)j->x, (double)j->y, (int)width, (int)height);
        if (j->branch_count < 0 || j->branch_count > ASJ_MAX_BRANCHES)
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu of image %d has %d branches", n, (int)which,
                            (int)j->branch_count);
        for (int32_t b = 0; b < j->branch_count; b++) {
            const asj_branch *branch = &j->branches[b];
            if (!(branch->length >= 0 && branch->length <= 4 * (float)ASJ_MAX_SIDE && fabsf(branch->angle) <= 1e6f))
                return asj_fail(context, ASJ_ERROR_ARGUMENT, "branch %d of junction %zu of image %d has angle %g, length %g",
                                (int)b, n, (int)which, (double)branch->angle, (double)branch->length);
        }
    }
    return ASJ_OK;
}

static asj_status no_memory(asj_context *context)
{
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the corners of an image");
}

/* --- places ----------------------------------------------------------------------------------------------------------------- */

typedef struct spot {
    float x, y;
    uint32_t l;
} spot;

static int by_position(const void *left, const void *right)
{
    const spot *p = left, *q = right;
    if (p->x != q->x)
        return p->x < q->x ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p->l < q->l ? -1 : p->l > q->l;
}

static asj_status find_places(asj_context *context, asj_corners *corners)
{
    asj_memory *memory = &context->memory;
    spot *spots = asj_allocate(memory, corners->count, sizeof *spots);
    corners->place = asj_allocate(memory, corners->count, sizeof *corners->place);
    corners->place_x = asj_allocate(memory, corners->count, sizeof *corners->place_x);
    corners->place_y = asj_allocate(memory, corners->count, sizeof *corners->place_y);
    corners->first_of_place = asj_allocate(memory, (size_t)corners->count + 1, sizeof *corners->first_of_place);
    corners->l_of_place = asj_allocate(memory, corners->count, sizeof *corners->l_of_place);
    if (!spots || !corners->place || !corners->place_x || !corners->place_y || !corners->first_of_place || !corners->l_of_place) {
        asj_release(memory, spots);
        return no_memory(context);
    }
    for (uint32_t i = 0; i < corners->count; i++)
        spots[i] = (spot){corners->l[i].x, corners->l[i].y, i};
    qsort(spots, corners->count, sizeof *spots, by_position);
    uint32_t places = 0;
    for (uint32_t i = 0; i < corners->count; i++) {
        if (i == 0 || spots[i].x != spots[i - 1].x || spots[i].y != spots[i - 1].y) {
            corners->place_x[places] = (double)spots[i].x;
            corners->place_y[places] = (double)spots[i].y;
            corners->first_of_place[places++] = i;
        }
        corners->place[spots[i].l] = places - 1;
        corners->l_of_place[i] = spots[i].l;
    }
    corners->place_count = places;
    corners->first_of_place[places] = corners->count;
    asj_release(memory, spots);
    return ASJ_OK;
}

uint32_t asj_first_place(const asj_corners *corners, double x)
{
    uint32_t low = 0, high = corners->place_count;
    while (low < high) {
        const uint32_t middle = low + (high - low) / 2;
        if (corners->place_x[middle] < x)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* A list of places, nearest first, ties by number. */
typedef struct nearest {
    uint32_t count, limit;
    uint32_t *place;
    double square[64]; /* of their distances */
} nearest;

static void insert(nearest *list, uint32_t place, double square)
{
    uint32_t k = list->count;
    while (k > 0 && (list->square[k - 1] > square || (list->square[k - 1] == square && list->place[k - 1] > place)))
        k--;
    if (k == list->limit)
        return;
    list->count += list->count < list->limit;
    for (uint32_t m = list->count - 1; m > k; m--) {
        list->square[m] = list->square[m - 1];
        list->place[m] = list->place[m - 1];
    }
    list->square[k] = square;
    list->place[k] = place;
}

/* The nearest places farther than `separation`: from the place itself outwards in x, until x alone is too far away. */
static uint32_t find_nearest(const asj_corners *corners, uint32_t place, double separation, uint32_t limit, uint32_t *out)
{
    const double x = corners->place_x[place], y = corners->place_y[place], least = separation * separation;
    nearest list = {.limit = limit, .place = out};
    for (uint32_t left = place, right = place + 1; left > 0 || right < corners->place_count;) {
        const int32_t back = right == corners->place_count ||
                             (left > 0 && x - corners->place_x[left - 1] <= corners->place_x[right] - x);
        const uint32_t q = back ? --left : right++;
        const double dx = corners->place_x[q] - x, dy = corners->place_y[q] - y, square = dx * dx + dy * dy;
        if (list.count == limit && dx * dx > list.square[limit - 1])
            break;
        if (square > least)
            insert(&list, q, square);
    }
    return list.count;
}

static asj_status find_neighbours(asj_context *context, const asj_match_options *options, asj_corners *corners)
{
    corners->neighbour_limit = (uint32_t)options->neighbours;
    if (options->neighbours == 0)
        return ASJ_OK;
    corners->neighbour = asj_allocate(&context->memory, (size_t)corners->place_count * corners->neighbour_limit, sizeof(uint32_t));
    corners->neighbour_count = asj_allocate(&context->memory, corners->place_count, sizeof(uint32_t));
    if (!corners->neighbour || !corners->neighbour_count)
        return no_memory(context);
    const int64_t count = corners->place_count;
#pragma omp parallel for num_threads(context->threads) schedule(static)
    for (int64_t p = 0; p < count; p++)
        corners->neighbour_count[p] = find_nearest(corners, (uint32_t)p, options->separation, corners->neighbour_limit,
                                                   corners->neighbour + (size_t)p * corners->neighbour_limit);
    return ASJ_OK;
}

/* --- lengths and frames ----------------------------------------------------------------------------------------------------- */

/* Appends extra lengths, falling, LEAST_APART from each other. Only places with an x that the branch passes are looked at. */
static void find_lengths(const asj_corners *corners, double x, double y, const double u[2], double own, int32_t limit,
                         asj_lengths *lengths)
{
    lengths->count = 1;
    lengths->length[0] = (float)own;
    double before = own - LEAST_BEFORE_END;
    const double most = x + (u[0] > 0 ? before * u[0] : 0) + RAY_DISTANCE + 1;
    const uint32_t first = asj_first_place(corners, x + (u[0] < 0 ? before * u[0] : 0) - RAY_DISTANCE - 1);
    while (lengths->count < limit) { /* the longest one not longer than `before` */
        double best = 0;
        for (uint32_t q = first; q < corners->place_count && corners->place_x[q] <= most; q++) {
            double dx = corners->place_x[q] - x, dy = corners->place_y[q] - y;
            double along = dx * u[0] + dy * u[1];
            if (along >= LEAST_START && along <= before && along > best && fabs(dx * u[1] - dy * u[0]) < RAY_DISTANCE)
                best = along;
        }
        if (best <= 0)
            return;
        lengths->length[lengths->count++] = (float)best;
        before = best - LEAST_APART;
    }
}

/* Unit vector and length of the branch that ends at (ex, ey). */
static double direct(const asj_l_junction *l, float ex, float ey, double u[2])
{
    double dx = (double)ex - (double)l->x, dy = (double)ey - (double)l->y, length = sqrt(dx * dx + dy * dy);
    u[0] = length > 0 ? dx / length : 1;
    u[1] = length > 0 ? dy / length : 0;
    return length;
}

static void prepare(asj_corners *corners, uint32_t i, int32_t limit)
{
    const asj_l_junction *l = &corners->l[i];
    double *u = corners->direction + 4 * (size_t)i;
    double a = direct(l, l->ax, l->ay, u), b = direct(l, l->bx, l->by, u + 2);
    if (a < LEAST_LENGTH || b < LEAST_LENGTH) {
        corners->lengths[2 * i] = (asj_lengths){0, {(float)a}};
        corners->lengths[2 * i + 1] = (asj_lengths){0, {(float)b}};
        return;
    }
    find_lengths(corners, (double)l->x, (double)l->y, u, a, limit, &corners->lengths[2 * i]);
    find_lengths(corners, (double)l->x, (double)l->y, u + 2, b, limit, &corners->lengths[2 * i + 1]);
}

static void fill_frames(asj_corners *corners)
{
    for (uint32_t i = 0; i < corners->count; i++) {
        const double *u = corners->direction + 4 * (size_t)i;
        const asj_lengths *a = &corners->lengths[2 * i], *b = &corners->lengths[2 * i + 1];
        asj_affine_frame *frame = corners->frames + corners->first_frame[i];
        for (int32_t m = 0; m < a->count; m++)
            for (int32_t n = 0; n < b->count; n++) {
                double p = (double)a->length[m], q = (double)b->length[n];
                *frame++ = (asj_affine_frame){(double)corners->l[i].x, (double)corners->l[i].y,
                                              p * u[0], p * u[1], q * u[2], q * u[3]};
            }
    }
}

static asj_status make_frames(asj_context *context, const asj_match_options *options, asj_corners *corners)
{
    asj_memory *memory = &context->memory;
    corners->lengths = asj_allocate(memory, 2 * (size_t)corners->count, sizeof *corners->lengths);
    corners->direction = asj_allocate(memory, 4 * (size_t)corners->count, sizeof *corners->direction);
    corners->first_frame = asj_allocate(memory, (size_t)corners->count + 1, sizeof *corners->first_frame);
    if (!corners->lengths || !corners->direction || !corners->first_frame)
        return no_memory(context);
    const int64_t count = corners->count;
#pragma omp parallel for num_threads(context->threads) schedule(static)
    for (int64_t i = 0; i < count; i++)
        prepare(corners, (uint32_t)i, options->length_hypotheses);
    uint32_t total = 0;
    for (uint32_t i = 0; i < corners->count; i++) {
        corners->first_frame[i] = total;
        total += (uint32_t)(corners->lengths[2 * i].count * corners->lengths[2 * i + 1].count);
    }
    corners->first_frame[corners->count] = corners->frame_count = total;
    corners->frames = asj_allocate(memory, total, sizeof *corners->frames);
    if (!corners->frames)
        return no_memory(context);
    fill_frames(corners);
    return ASJ_OK;
}

/* Does another L-junction of the place have a branch opposite to u? */
static int continues(const asj_corners *corners, uint32_t l, const double u[2])
{
    const uint32_t place = corners->place[l];
    for (uint32_t m = corners->first_of_place[place]; m < corners->first_of_place[place + 1]; m++) {
        const double *v = corners->direction + 4 * (size_t)corners->l_of_place[m];
        if (corners->l_of_place[m] != l &&
            (u[0] * v[0] + u[1] * v[1] < OPPOSITE || u[0] * v[2] + u[1] * v[3] < OPPOSITE))
            return 1;
    }
    return 0;
}

static asj_status find_stems(asj_context *context, asj_corners *corners)
{
    corners->stem = asj_allocate(&context->memory, corners->count, sizeof *corners->stem);
    if (!corners->stem)
        return no_memory(context);
    for (uint32_t l = 0; l < corners->count; l++) {
        const double *u = corners->direction + 4 * (size_t)l;
        corners->stem[l] = continues(corners, l, u) != continues(corners, l, u + 2);
    }
    return ASJ_OK;
}

asj_status asj_corners_create(asj_context *context, const asj_junction *junctions, size_t count, int32_t width, int32_t height,
                              const asj_match_options *options, int32_t which, asj_corners *corners)
{
    memset(corners, 0, sizeof *corners);
    asj_status status = check(context, junctions, count, width, height, which);
    if (status != ASJ_OK)
        return status;
    size_t total = asj_decompose(junctions, count, options->minimum_opening, NULL, 0);
    if (total > 0x1000000)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%zu L-junctions in image %d are more than the matcher takes", total, (int)which);
    corners->l = asj_allocate(&context->memory, total, sizeof *corners->l);
    if (!corners->l)
        return no_memory(context);
    corners->count = (uint32_t)asj_decompose(junctions, count, options->minimum_opening, corners->l, total);
    status = find_places(context, corners);
    if (status == ASJ_OK)
        status = find_neighbours(context, options, corners);
    if (status == ASJ_OK)
        status = make_frames(context, options, corners);
    if (status == ASJ_OK)
        status = find_stems(context, corners);
    return status;
}

void asj_corners_free(asj_memory *memory, asj_corners *corners)
{
    void *blocks[] = {corners->l, corners->lengths, corners->direction, corners->first_frame, corners->frames, corners->place,
                      corners->place_x, corners->place_y, corners->neighbour, corners->neighbour_count,
                      corners->first_of_place, corners->l_of_place, corners->stem};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        asj_release(memory, blocks[i]);
    memset(corners, 0, sizeof *corners);
}
