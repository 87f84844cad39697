/* SPDX-License-Identifier: BSD-2-Clause */
/* Looks at an image at three sizes, of which two have to agree (not in the paper).
 *
 * Between an image and a junction stand a dozen decisions, each at a limit: which pixels are candidates, what passes the isotropic
 * test, which of several guesses suppresses the others, whether lines move the junction too far, whether a strip is meaningful,
 * reaches its junction, keeps its direction. A true corner that is not beyond doubt in all of them comes and goes with anything
 * that changes the pixels, and no limit is the cause: of what 26 photographs have at zoom .9 and not as they are (450 of some 1900)
 * validation drops 201, by a dozen reasons, fits and early rejection 108, the merge of octaves 31, and so on. Better numbers for
 * one decision change which corners are lost, not how many.
 *
 * But a second look tells more of a junction than any number of the first one, and another size of the image tells more than other
 * pixels of the same: other pixels are candidates, noise is averaged otherwise, and what limits measure in pixels, the first 6 px
 * of a branch, the radius of the test, is another part of the scene. So the detector looks three times, at the image as it is,
 * RATIO times smaller and RATIO times larger, and what two of them have within NEAR px stays, as the first that has it sees it.
 * (Looks are not independent: of 2097 junctions .84 has 65 % within NEAR px.) It is hysteresis, without limits of its own.
 *
 * The third look decides only where the first two disagree: candidates lie around there (asj_sizes_disputed()). Copies have the
 * octaves of the image itself.
 *
 * RATIO: half as far from one size to the next as half octaves are. Sizes that are nearer are more alike: with 1.09 the 26 have
 * 80.4 % at .8 for 82.6. With half octaves the smaller image has too few pixels for corners blurred by 8 px. NEAR: with 2 81.2 and
 * 80.4 % at .9 and .8. What two of three sizes have (tests/accuracy/README.md, zooms of .9 to .3, without and with it): 26
 * photographs 77.2 74.7 74.9 75.1 80.3 75.6 80.6 and 84.1 82.5 81.6 81.6 80.7 80.0 82.4, six 85.0 84.8 84.4 84.1 85.2 78.6 81.4 and
 * 86.9 87.6 87.5 86.2 84.9 77.9 76.7; corners of 5 grey levels in noise of 2 .817 and .907 found, precision .997 and .999; rooms
 * .951 and .954, .989 and .990. Copies are made in the image's own format, so that images of 8 and 16 bits differ a little. */
#include "sizes.h"

#include <math.h>

#define RATIO 1.189207115002721 /* 2^(1/4) */
#define NEAR 3.0                /* px of the image */
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

/* How many looks have a hypothesis of look i. */
static int32_t votes_for(const asj_sizes *sizes, int32_t i, const asj_hypothesis *hypothesis)
{
    int32_t votes = 1;
    for (int32_t other = 0; other < sizes->count; other++)
        votes += other != i && is_near(&sizes->grids[other], sizes->found[other].found, hypothesis, NEAR);
    return votes;
}

size_t asj_sizes_disputed(const asj_sizes *sizes, double *places)
{
    size_t count = 0;
    for (int32_t i = 0; i < sizes->count; i++)
        for (size_t k = 0; k < sizes->found[i].count; k++) {
            const asj_hypothesis *hypothesis = &sizes->found[i].found[k];
            if (votes_for(sizes, i, hypothesis) >= AGREEING)
                continue;
            places[2 * count] = hypothesis->x;
            places[2 * count + 1] = hypothesis->y;
            count++;
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
            if (votes_for(sizes, i, hypothesis) < AGREEING || (i > 0 && is_near(&grid, to, hypothesis, reach)))
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
