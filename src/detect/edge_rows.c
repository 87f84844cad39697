/* SPDX-License-Identifier: BSD-2-Clause */
/* Across a branch the grey levels g(t, s), s = -2 .. 2 px, less their mean, are the cross-section m of its edge times its contrast
 * at t. Two px to either side see enough of a step; farther out lie the other edges of acute corners.
 *
 * The cross-section is the principal direction of means of g over pieces of the branch: steps, thin lines and soft edges all have
 * one, and a change of sign (a crossing of checkerboard tiles) does not matter to it. */
#include "edge_rows.h"

#include <math.h>
#include <string.h>

#define NOTHING 1.0 /* square of 1/ASJ_GRAY_ONE grey levels */
#define TURNS 12    /* of the power iteration: directions that far apart are told, and no other matters */
#define OUTSIDE (ASJ_GRAY_BORDER - 2) /* px: samples reach no farther than that from the middle of their row */

asj_edge_line asj_edge_line_of(const asj_frame *frame, const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    return (asj_edge_line){frame,
                           hypothesis->x,
                           hypothesis->y,
                           cos(branch->angle),
                           sin(branch->angle),
                           fmin(fmax(branch->offset, ASJ_EDGE_HALF - OUTSIDE), OUTSIDE - ASJ_EDGE_HALF)};
}

/* Bilinear in 1/256 px at a place in 1/65536 px, in 1/256 levels. */
static int32_t level_at(const asj_frame *frame, int64_t x, int64_t y)
{
    const uint16_t *upper = frame->gray + (ptrdiff_t)(y >> 16) * frame->stride + (ptrdiff_t)(x >> 16);
    const uint16_t *lower = upper + frame->stride;
    const int32_t wx = (int32_t)(x >> 8 & 255), wy = (int32_t)(y >> 8 & 255);
    const int32_t above = (256 - wx) * upper[0] + wx * upper[1], below = (256 - wx) * lower[0] + wx * lower[1];
    return ((256 - wy) * (above >> 1) + wy * (below >> 1)) >> 7;
}

/* One row; 0 outside the image. */
static int read_row(const asj_edge_line *line, int32_t t, int32_t levels[ASJ_EDGE_SAMPLES])
{
    const asj_frame *frame = line->frame;
    const double x = line->x + t * line->ux, y = line->y + t * line->uy, first = line->offset - ASJ_EDGE_HALF;
    if (!(x >= 0 && y >= 0 && x <= frame->width - 1 && y <= frame->height - 1))
        return 0;
    const int64_t step_x = (int64_t)(-65536 * line->uy), step_y = (int64_t)(65536 * line->ux);
    /* whole numbers from a corner that lies before all samples: none is negative, and none rounded up */
    int64_t at_x = (int64_t)(65536 * (x - first * line->uy + ASJ_GRAY_BORDER)) - ((int64_t)ASJ_GRAY_BORDER << 16);
    int64_t at_y = (int64_t)(65536 * (y + first * line->ux + ASJ_GRAY_BORDER)) - ((int64_t)ASJ_GRAY_BORDER << 16);
    for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++, at_x += step_x, at_y += step_y)
        levels[i] = level_at(frame, at_x, at_y);
    return 1;
}

int32_t asj_edge_rows(const asj_edge_line *line, int32_t first, int32_t step, int32_t count, int32_t *levels, ptrdiff_t room)
{
    for (int32_t k = 0; k < count; k++) {
        int32_t row[ASJ_EDGE_SAMPLES], sum = 0;
        if (!read_row(line, first + k * step, row))
            return k;
        for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++)
            sum += row[i];
        for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++)
            levels[i * room + k] = ASJ_EDGE_SAMPLES * row[i] - sum;
    }
    return count;
}

const asj_edge_ops asj_edge_reference = {.rows = asj_edge_rows, .fan = asj_edge_fan_means};

void asj_edge_parts(const int32_t *levels, ptrdiff_t room, int32_t count, const double section[ASJ_EDGE_SAMPLES], double *parts)
{
    for (int32_t k = 0; k < count; k++) {
        double sum = 0;
        for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++)
            sum += levels[i * room + k] * section[i];
        parts[k] = sum;
    }
}

double asj_edge_product(const double *a, const double *b)
{
    double sum = 0;
    for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++)
        sum += a[i] * b[i];
    return sum;
}

/* By power iteration from the largest of them. */
int asj_edge_section(const double *means, int32_t count, double section[ASJ_EDGE_SAMPLES])
{
    double largest = NOTHING;
    for (int32_t k = 0; k < count; k++) {
        const double *mean = means + k * ASJ_EDGE_SAMPLES, norm = asj_edge_product(mean, mean);
        if (norm > largest) {
            largest = norm;
            memcpy(section, mean, ASJ_EDGE_SAMPLES * sizeof *section);
        }
    }
    for (int32_t turn = 0; turn < TURNS && largest > NOTHING; turn++) {
        double next[ASJ_EDGE_SAMPLES] = {0};
        for (int32_t k = 0; k < count; k++) {
            const double *mean = means + k * ASJ_EDGE_SAMPLES, part = asj_edge_product(mean, section);
            for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++)
                next[i] += part * mean[i];
        }
        const double norm = sqrt(asj_edge_product(next, next));
        for (int32_t i = 0; i < ASJ_EDGE_SAMPLES; i++)
            section[i] = norm > 0 ? next[i] / norm : 0;
    }
    return largest > NOTHING;
}
