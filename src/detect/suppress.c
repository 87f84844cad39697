/* SPDX-License-Identifier: BSD-2-Clause */
/* Suppression: of hypotheses that lie close together the most meaningful one stays.
 *
 * The isotropic test finds a clear corner at several pixels and radii; the fits bring these to one place. ACJ suppresses within its
 * scale in the same way; the paper says no more about it. */
#include "suppress.h"
#include "core/angle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Two located junctions are one when they are closer than this: the larger of 3 px and a share of the radius of the more
 * meaningful one. Chosen: less reports corners twice, more loses one of two close corners (of a frame, of a tile joint). */
#define LEAST_CLOSE 3.0   /* px */
#define CLOSE_SHARE 0.35  /* of the radius */

/* Guessed junctions are one, and only one is worth a fit, when they lie this close, with the same branches to within this angle.
 * Chosen: less sends more guesses of one corner to the fits, which costs time; more drops corners that the fits would tell from
 * their neighbours. */
#define TWIN_DISTANCE 1.5             /* px */
#define TWIN_TURN (10 * ASJ_DEGREE)

/* A guess that has moved no farther than this is not likely to be rejected because it moves too far (max_move, 2.5 px). */
#define SURELY_NEAR 1.5 /* px */

static int by_meaning(const void *a, const void *b)
{
    const asj_hypothesis *p = a, *q = b;
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p->x < q->x ? -1 : p->x > q->x;
}

void asj_suppress_sort(asj_hypothesis *hypotheses, size_t count)
{
    if (count > 1)
        qsort(hypotheses, count, sizeof *hypotheses, by_meaning);
}

/* Kept hypotheses are linked into a grid of cells as wide as the largest suppression radius, so that only the cells around need a
 * look. */
#define CELL 11 /* px: CLOSE_SHARE * ASJ_MAX_RADIUS rounded up */

static int32_t cell_columns(int32_t width)
{
    return width / CELL + 3; /* a border of cells for junctions just outside the image, and for the neighbours */
}

size_t asj_suppress_cells(size_t count, int32_t width, int32_t height)
{
    return (size_t)cell_columns(width) * (size_t)cell_columns(height) + count;
}

/* Whether each branch of a hypothesis is one of the other's too, and the other one is not likely to be rejected yet. */
static int same_junction(const asj_hypothesis *hypothesis, const asj_hypothesis *other)
{
    if (hypothesis->branch_count != other->branch_count || hypot(other->x - other->x0, other->y - other->y0) > SURELY_NEAR)
        return 0;
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        int found = 0;
        for (int32_t j = 0; j < other->branch_count; j++)
            found |= asj_angle_distance(hypothesis->branches[i].angle, other->branches[j].angle) < TWIN_TURN;
        if (!found)
            return 0;
    }
    return 1;
}

static int suppressed(const asj_hypothesis *hypotheses, const asj_hypothesis *hypothesis, int twins, int32_t columns, int64_t cell,
                      const int32_t *heads, const int32_t *next)
{
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            for (int32_t i = heads[cell + dy * columns + dx]; i >= 0; i = next[i]) {
                const double radius = twins ? TWIN_DISTANCE : fmax(LEAST_CLOSE, CLOSE_SHARE * hypotheses[i].radius);
                const double x = hypotheses[i].x - hypothesis->x, y = hypotheses[i].y - hypothesis->y;
                if (x * x + y * y < radius * radius && (!twins || same_junction(hypothesis, &hypotheses[i])))
                    return 1;
            }
    return 0;
}

size_t asj_suppress(asj_hypothesis *hypotheses, size_t count, int32_t rule, int32_t width, int32_t height, int32_t *cells)
{
    const int32_t columns = cell_columns(width), rows = cell_columns(height);
    int32_t *heads = cells, *next = cells + (size_t)columns * (size_t)rows;
    size_t valid = 0, kept = 0;
    for (size_t i = 0; i < count; i++)
        if (hypotheses[i].branch_count >= 2)
            hypotheses[valid++] = hypotheses[i];
    asj_suppress_sort(hypotheses, valid);
    memset(heads, 0xff, (size_t)columns * (size_t)rows * sizeof *heads);
    for (size_t i = 0; i < valid; i++) {
        const asj_hypothesis hypothesis = hypotheses[i];
        int32_t cx = (int32_t)floor(hypothesis.x / CELL) + 1, cy = (int32_t)floor(hypothesis.y / CELL) + 1;
        cx = cx < 1 ? 1 : cx > columns - 2 ? columns - 2 : cx;
        cy = cy < 1 ? 1 : cy > rows - 2 ? rows - 2 : cy;
        int64_t cell = (int64_t)cy * columns + cx;
        if (suppressed(hypotheses, &hypothesis, rule == ASJ_SUPPRESS_TWINS, columns, cell, heads, next))
            continue;
        hypotheses[kept] = hypothesis;
        next[kept] = heads[cell];
        heads[cell] = (int32_t)kept++;
    }
    return kept;
}

asj_status asj_suppress_all(asj_detection_run *run, int32_t rule)
{
    const asj_frame *frame = run->frame;
    const size_t count = asj_suppress_cells(run->hypothesis_count, frame->width, frame->height);
    int32_t *cells = asj_allocate_list(&run->context->memory, count, sizeof *cells);
    if (!cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    run->hypothesis_count = asj_suppress(run->hypotheses, run->hypothesis_count, rule, frame->width, frame->height, cells);
    asj_release(&run->context->memory, cells);
    return ASJ_OK;
}
