/* SPDX-License-Identifier: BSD-2-Clause */
/* Looks at an image at three sizes, of which two have to agree (not in the paper).
 *
 * Between an image and a junction stand a dozen decisions, each at a limit: which pixels are candidates, what passes the
 * isotropic test, which of several guesses suppresses the others, whether lines move the junction too far, whether a strip is
 * meaningful, reaches its junction, keeps its direction. A true corner that is not beyond doubt in all of them comes and goes
 * with anything that changes the pixels, and no limit is the cause: better numbers for one decision change which corners are
 * lost, not how many.
 *
 * But a second look tells more of a junction than any number of the first one, and another size of the image tells more than
 * other pixels of the same: other pixels are candidates, noise is averaged otherwise, and what limits measure in pixels, the
 * first 6 px of a branch, the radius of the test, is another part of the scene. So the detector looks three times, at the image
 * as it is, RATIO times smaller and RATIO times larger, and what two of them have within NEAR px (ASJ_SIZES_NEAR) stays, as the
 * first that has it sees it. It is hysteresis, without limits of its own.
 *
 * Most of what a look takes it takes where nothing comes of it. So copies are looked at in places alone: the smaller one where
 * the image has something, or something that only its validation has rejected (sizes_step.c), and the larger one where these two
 * disagree. There they go through all steps, since a copy that says yes sooner tells less. But what lies where an earlier
 * look has something is no more than a vote: its branches are followed for some pixels and have no ends. What the smaller one
 * alone has, and the larger one too, is a junction like others.
 *
 * Copies have the octaves of the image itself.
 *
 * RATIO: half as far from one size to the next as half octaves are. Sizes that are nearer are more alike; half octaves leave the
 * smaller image too few pixels for corners blurred by 8 px. NEAR: with 2 px a twentieth fewer are found again. With all this 85 %
 * of the junctions of 26 photographs are found again at zoom .9, where 77 % are without (tests/accuracy/tried/detection.md, "Two of
 * three sizes", also for looking sooner, at whole images, and at other copies). */
#include "sizes.h"

#include <math.h>

#define RATIO 1.189207115002721 /* 2^(1/4) */
#define AGREEING 2              /* looks */
#define APART 5.0               /* px of its octave to what a copy adds: as suppression leaves at radius 14 (suppress.c) */

int32_t asj_size_px(int32_t px, int32_t size)
{
    return size == 0 ? px : (int32_t)lrint(size == 1 ? px / RATIO : px * RATIO);
}

static void map(asj_hypothesis *hypothesis, double x_scale, double y_scale)
{
    const double scale = sqrt(x_scale * y_scale);
    asj_hypothesis_scale(hypothesis, x_scale, y_scale, scale);
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        hypothesis->branches[i].width *= scale; /* px of the copy's octave, which has the same number */
}

/* Of a smaller copy what lies as far outside as it may is too far outside of the image. */
void asj_size_map(asj_size_found *list, int32_t width, int32_t height, int32_t to_width, int32_t to_height)
{
    size_t kept = 0;
    for (size_t i = 0; i < list->count; i++) {
        list->found[kept] = list->found[i];
        map(&list->found[kept], (double)to_width / width, (double)to_height / height);
        kept += (size_t)asj_hypothesis_is_inside(&list->found[kept], to_width, to_height);
    }
    list->count = kept;
}

size_t asj_sizes_total(const asj_sizes *sizes)
{
    size_t total = 0;
    for (int32_t i = 0; i < sizes->count; i++)
        total += sizes->found[i].count;
    return total;
}

size_t asj_sizes_cells(const asj_sizes *sizes, int32_t width, int32_t height)
{
    return ASJ_SIZES * asj_octave_grid_cells(0, width, height) + asj_sizes_total(sizes);
}

void asj_sizes_mark(asj_sizes *sizes, int32_t width, int32_t height, int32_t *cells)
{
    for (int32_t i = 0; i < sizes->count; i++) {
        const asj_size_found *list = &sizes->found[i];
        sizes->grids[i] = asj_octave_grid_start(width, height, cells);
        for (size_t k = 0; k < list->count; k++)
            asj_octave_grid_add(&sizes->grids[i], list->found, k);
        cells += asj_octave_grid_cells(list->count, width, height);
    }
}

static int is_near(const asj_octave_grid *grid, const asj_hypothesis *found, const asj_hypothesis *hypothesis, double reach)
{
    const asj_octave_cells w = asj_octave_grid_around(grid, hypothesis, reach);
    for (int32_t row = w.top; row <= w.bottom; row++)
        for (int32_t column = w.left; column <= w.right; column++)
            for (int32_t i = grid->heads[row * grid->columns + column]; i >= 0; i = grid->next[i])
                if (hypot(found[i].x - hypothesis->x, found[i].y - hypothesis->y) <= reach)
                    return 1;
    return 0;
}

int asj_sizes_have(const asj_sizes *sizes, const asj_size_place *place, double reach)
{
    const asj_hypothesis there = {.x = place->x, .y = place->y};
    int found = 0;
    for (int32_t i = 0; i < sizes->count; i++)
        found |= is_near(&sizes->grids[i], sizes->found[i].found, &there, reach);
    return found;
}

/* Whether enough looks have a hypothesis of look i. */
static int is_agreed(const asj_sizes *sizes, int32_t i, const asj_hypothesis *hypothesis)
{
    int32_t votes = 1;
    for (int32_t other = 0; other < sizes->count; other++)
        votes += other != i && is_near(&sizes->grids[other], sizes->found[other].found, hypothesis, ASJ_SIZES_NEAR);
    return votes >= AGREEING;
}

size_t asj_sizes_disputed(const asj_sizes *sizes, asj_size_place *places)
{
    size_t count = 0;
    for (int32_t i = 0; i < sizes->count; i++)
        for (size_t k = 0; k < sizes->found[i].count; k++) {
            const asj_hypothesis *hypothesis = &sizes->found[i].found[k];
            if (!hypothesis->is_vote && !is_agreed(sizes, i, hypothesis))
                places[count++] = (asj_size_place){hypothesis->x, hypothesis->y, hypothesis->octave};
        }
    return count;
}

size_t asj_sizes_agreed(const asj_sizes *sizes, int32_t width, int32_t height, int32_t *cells, asj_hypothesis *to)
{
    asj_octave_grid grid = asj_octave_grid_start(width, height, cells);
    size_t count = 0;
    for (int32_t i = 0; i < sizes->count; i++) {
        for (size_t k = 0; k < sizes->found[i].count; k++) {
            const asj_hypothesis *hypothesis = &sizes->found[i].found[k];
            const double reach = APART * fmax(asj_octave_scale(hypothesis->octave), 1);
            if (hypothesis->is_vote || !is_agreed(sizes, i, hypothesis) || (i > 0 && is_near(&grid, to, hypothesis, reach)))
                continue;
            to[count] = *hypothesis;
            if (i > 0)
                asj_octave_grid_add(&grid, to, count);
            count++;
        }
        for (size_t k = 0; i == 0 && k < count; k++) /* what one look has side by side stays so */
            asj_octave_grid_add(&grid, to, k);
    }
    return count;
}
