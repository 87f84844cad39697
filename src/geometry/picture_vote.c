/* SPDX-License-Identifier: BSD-2-Clause */
/* Pictures decide between geometries that contradict each other.
 *
 * Matches are corners, and where things repeat, the corners of a wrong geometry are as exact as those of the right one. Between the
 * corners there is more to see: a floor that was matched with itself shifted by a tile has other tiles there, brighter or darker
 * ones, and so has one that was turned. A geometry with planes (or a homography) says where each point of a plane is in the other
 * image. So image 1 is divided into cells. Those between the matches of a plane, or near one of them, lie on it, and their grey
 * levels are compared with those where the plane's homography takes them:
 *
 *     log of the mean grey level in image 2 = a + b times that in image 1 + r,
 *
 * a and b (exposure, gamma) fitted to the cells of each geometry with the weights 1/(FLOOR + |r|), which is nearly least absolute
 * deviations. Where two geometries take a cell to different places one of the two is wrong there, and
 *
 *     d = log (|r| of the second + FLOOR)/(|r| of the first + FLOOR)
 *
 * says which, whatever the pictures are: both are compared with the same cell. Means of d over blocks of cells, which share what
 * they show, are the voters: with S their sum and t = S / sqrt(sum of squares) (self-normalised, about normal when the pictures
 * know nothing), the pictures contradict the second geometry when t, S and the mean are all large. (Rendered rooms 0 to 49 with
 * three draws of their noise, 50 to 99 with one: of 359 motions that are out by more than 15 degrees with .6 and more of the log
 * evidence of the right one 91 are contradicted in its favour, most others having the same planes in the same places; of 1567 of
 * any evidence one is preferred to the right motion.)
 */
#include "picture_vote.h"
#include "likelihood.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define PROBABLE 0.3
#define BESIDE 0.5       /* cells: so far outside the matches of a plane it goes on, .. */
#define AROUND 2.0       /* .. and so far around each of them */
#define ELSEWHERE 0.6    /* cells: nearer places are the same */
#define SAMPLES 3        /* along the side of a cell */
#define BLOCK 2          /* cells along a block */
#define DARK 4.0         /* grey levels: noise of what is nearly black */
#define FLOOR 0.02       /* of brightness: smaller differences say nothing */
#define ROUNDS 8
#define LEAST_SLOPE 0.7
#define MOST_SLOPE 1.4
#define STIFF 0.02       /* variance of the brightness from which on the pictures tell the slope */
#define LEAST_CELLS 8
#define LEAST_AREA 0.05  /* a map that shrinks or enlarges a cell more than this shows nothing of it */
#define MOST_AREA 20.0
#define LEAST_T 1.9
#define LEAST_SUM 3.0
#define LEAST_MEAN 0.15

asj_pictures *asj_pictures_create(asj_memory *memory, const asj_pyramid *const of[2], int32_t candidates)
{
    asj_pictures *p = asj_allocate_zero(memory, 1, sizeof *p);
    int32_t good = p != NULL;
    for (int32_t k = 0; k < ASJ_MOST_PLANES && good; k++) {
        p->planes[k].list = asj_allocate(memory, (size_t)candidates, sizeof *p->planes[k].list);
        p->planes[k].hull = asj_allocate(memory, (size_t)candidates, sizeof *p->planes[k].hull);
        good = p->planes[k].list && p->planes[k].hull;
    }
    if (!good) {
        asj_pictures_free(memory, p);
        return NULL;
    }
    p->of[0] = of[0];
    p->of[1] = of[1];
    return p;
}

void asj_pictures_free(asj_memory *memory, asj_pictures *pictures)
{
    for (int32_t k = 0; k < ASJ_MOST_PLANES && pictures; k++) {
        asj_release(memory, pictures->planes[k].list);
        asj_release(memory, pictures->planes[k].hull);
    }
    asj_release(memory, pictures);
}

/* --- which cells lie on which plane ------------------------------------------------------------------------------------------- */

static double side_of(const asj_pair *a, const asj_pair *b, double x, double y)
{
    return (b->x1 - a->x1) * (y - a->y1) - (b->y1 - a->y1) * (x - a->x1);
}

/* From the leftmost one on the one that has all others on one side (Jarvis's march). */
static void surround(asj_patch_of_plane *p)
{
    int32_t at = 0, next;
    for (int32_t k = 1; k < p->count; k++)
        if (p->list[k]->x1 < p->list[at]->x1 || (p->list[k]->x1 == p->list[at]->x1 && p->list[k]->y1 < p->list[at]->y1))
            at = k;
    p->corners = 0;
    do {
        p->hull[p->corners++] = at;
        next = -1;
        for (int32_t k = 0; k < p->count; k++) {
            const asj_pair *a = p->list[at], *c = p->list[k];
            const double far = hypot(c->x1 - a->x1, c->y1 - a->y1);
            if (!(far > 0))
                continue;
            const double side = next < 0 ? -1 : side_of(a, p->list[next], c->x1, c->y1);
            if (side < 0 || (side == 0 && far > hypot(p->list[next]->x1 - a->x1, p->list[next]->y1 - a->y1)))
                next = k;
        }
        at = next;
    } while (next >= 0 && p->corners < p->count && (p->list[next]->x1 != p->list[p->hull[0]]->x1 ||
                                                     p->list[next]->y1 != p->list[p->hull[0]]->y1));
}

static int32_t is_between(const asj_patch_of_plane *p, double x, double y, double beside)
{
    for (int32_t k = 0; k < p->corners; k++) {
        const asj_pair *a = p->list[p->hull[k]], *b = p->list[p->hull[k + 1 < p->corners ? k + 1 : 0]];
        if (side_of(a, b, x, y) < -beside * hypot(b->x1 - a->x1, b->y1 - a->y1))
            return 0;
    }
    return p->corners > 2;
}

/* What the geometry has matched on each of its planes. Their number. */
static int32_t find_planes(asj_pictures *pictures, const asj_pairs *set, const asj_two_view *view, const double *probability)
{
    const asj_peaks peaks = asj_likelihood_peaks(set, view, 1);
    const int32_t count = view->planar ? 1 : view->plane_count;
    for (int32_t k = 0; k < count; k++)
        pictures->planes[k].count = pictures->planes[k].corners = 0;
    for (int32_t k = 0; k < set->count; k++) {
        double parts[ASJ_MOST_PARTS] = {0};
        int32_t best = 0;
        if (!(probability[k] >= PROBABLE))
            continue;
        if (view->planar)
            best = 1;
        else
            asj_likelihood_ratio(view, set, &set->list[k], &peaks, parts);
        for (int32_t n = 1; n <= count && !view->planar; n++)
            best = parts[n] > parts[best] ? n : best;
        if (best > 0) {
            asj_patch_of_plane *p = &pictures->planes[best - 1];
            p->list[p->count++] = &set->list[k];
        }
    }
    for (int32_t k = 0; k < count; k++)
        if (pictures->planes[k].count > 2)
            surround(&pictures->planes[k]);
    return count;
}

/* The plane with the nearest match of those that reach there; -1: none. */
static int32_t plane_at(const asj_pictures *pictures, int32_t count, double x, double y, double cell)
{
    double nearest = HUGE_VAL;
    int32_t plane = -1;
    for (int32_t n = 0; n < count; n++) {
        const asj_patch_of_plane *p = &pictures->planes[n];
        double least = HUGE_VAL;
        for (int32_t k = 0; k < p->count; k++) {
            const double dx = p->list[k]->x1 - x, dy = p->list[k]->y1 - y, d2 = dx * dx + dy * dy;
            least = d2 < least ? d2 : least;
        }
        if (least < nearest && (least < AROUND * AROUND * cell * cell || is_between(p, x, y, BESIDE * cell))) {
            nearest = least;
            plane = n;
        }
    }
    return plane;
}

/* --- what is seen there ------------------------------------------------------------------------------------------------------- */

static int32_t go(const double h[9], double x, double y, double to[2])
{
    const double w = h[6] * x + h[7] * y + h[8];
    to[0] = (h[0] * x + h[1] * y + h[2]) / w;
    to[1] = (h[3] * x + h[4] * y + h[5]) / w;
    return w > 0 || w < 0;
}

static int32_t is_inside(const asj_pyramid *p, double x, double y)
{
    return x >= 0 && y >= 0 && x <= p->width[0] - 1 && y <= p->height[0] - 1;
}

/* Logarithms of the means of both images over a cell. 0: not seen. */
static int32_t compare_cell(const asj_pictures *pictures, const double h[9], double x, double y, double cell, asj_seen_cell *seen,
                            double grey[2])
{
    float at[2][2][SAMPLES * SAMPLES];
    uint16_t level[SAMPLES * SAMPLES];
    const double apart = cell / SAMPLES;
    double middle[2], right[2], below[2];
    if (!go(h, x, y, middle) || !go(h, x + 1, y, right) || !go(h, x, y + 1, below))
        return 0;
    const double area = (right[0] - middle[0]) * (below[1] - middle[1]) - (right[1] - middle[1]) * (below[0] - middle[0]);
    if (!(area > LEAST_AREA && area < MOST_AREA))
        return 0;
    for (int32_t n = 0; n < SAMPLES * SAMPLES; n++) {
        const double u = x + (n % SAMPLES - (SAMPLES - 1) / 2) * apart, v = y + (n / SAMPLES - (SAMPLES - 1) / 2) * apart;
        double to[2];
        if (!go(h, u, v, to) || !is_inside(pictures->of[0], u, v) || !is_inside(pictures->of[1], to[0], to[1]))
            return 0;
        at[0][0][n] = (float)u;
        at[0][1][n] = (float)v;
        at[1][0][n] = (float)to[0];
        at[1][1][n] = (float)to[1];
    }
    for (int32_t side = 0; side < 2; side++) {
        const asj_pyramid *p = pictures->of[side];
        double sum = 0;
        asj_pyramid_sample(p, asj_pyramid_level(p, apart * apart * (side ? area : 1)), at[side][0], at[side][1],
                           SAMPLES * SAMPLES, level);
        for (int32_t n = 0; n < SAMPLES * SAMPLES; n++)
            sum += level[n];
        grey[side] = log(sum / (SAMPLES * SAMPLES * ASJ_GRAY_ONE) + DARK);
    }
    seen->x2 = middle[0];
    seen->y2 = middle[1];
    return 1;
}

/* The line through the brightness of the cells, and what each lies off it. */
static void fit(asj_look *look)
{
    double a = 0, b = 1;
    for (int32_t round = 0; round <= ROUNDS; round++) {
        double sum = 0, sum1 = 0, sum2 = 0, sum11 = 0, sum12 = 0;
        for (int32_t n = 0; n < ASJ_CELLS; n++) {
            const double g1 = look->grey[n][0], g2 = look->grey[n][1];
            if (!look->cells[n].seen)
                continue;
            const double weight = round == 0 ? 1 : 1 / (FLOOR + fabs(g2 - a - b * g1));
            sum += weight;
            sum1 += weight * g1;
            sum2 += weight * g2;
            sum11 += weight * g1 * g1;
            sum12 += weight * g1 * g2;
        }
        if (!(sum > 0))
            return;
        const double middle1 = sum1 / sum, middle2 = sum2 / sum;
        const double slope = (sum12 / sum - middle1 * middle2 + STIFF) / (sum11 / sum - middle1 * middle1 + STIFF);
        b = round == 0 ? 1 : fmin(MOST_SLOPE, fmax(LEAST_SLOPE, slope));
        a = middle2 - b * middle1;
    }
    for (int32_t n = 0; n < ASJ_CELLS; n++)
        look->cells[n].difference = fabs(look->grey[n][1] - a - b * look->grey[n][0]);
}

void asj_pictures_look(asj_pictures *pictures, const asj_pairs *set, const asj_two_view *view, const double *probability,
                       asj_look *look)
{
    const int32_t width = pictures->of[0]->width[0], height = pictures->of[0]->height[0];
    const double cell = (double)(width > height ? width : height) / ASJ_CELLS_ALONG;
    const int32_t planes = find_planes(pictures, set, view, probability);
    int32_t count = 0;
    memset(look, 0, sizeof *look);
    look->cell = cell;
    for (int32_t n = 0; n < ASJ_CELLS && planes > 0; n++) {
        const double x = (n % ASJ_CELLS_ALONG + 0.5) * cell - 0.5, y = (n / ASJ_CELLS_ALONG + 0.5) * cell - 0.5;
        const int32_t plane = x < width && y < height ? plane_at(pictures, planes, x, y, cell) : -1;
        asj_seen_cell *c = &look->cells[n];
        if (plane < 0)
            continue;
        c->seen = compare_cell(pictures, view->planar ? view->matrix : view->planes[plane], x, y, cell, c, look->grey[n]);
        count += c->seen;
    }
    for (int32_t n = 0; n < ASJ_CELLS && count < LEAST_CELLS; n++)
        look->cells[n].seen = 0;
    fit(look);
}

/* --- the vote ----------------------------------------------------------------------------------------------------------------- */

/* The mean of d over the cells of a block; 0 and *voters as it was when there are none. */
static double ask_block(const asj_look *first, const asj_look *second, int32_t column, int32_t row, double *voters)
{
    const double apart = ELSEWHERE * first->cell;
    double sum = 0;
    int32_t count = 0;
    for (int32_t k = 0; k < BLOCK * BLOCK; k++) {
        const int32_t n = (row + k / BLOCK) * ASJ_CELLS_ALONG + column + k % BLOCK;
        const asj_seen_cell *f = &first->cells[n], *s = &second->cells[n];
        const double dx = f->x2 - s->x2, dy = f->y2 - s->y2;
        if (!f->seen || !s->seen || !(dx * dx + dy * dy > apart * apart))
            continue;
        sum += log((s->difference + FLOOR) / (f->difference + FLOOR));
        count++;
    }
    *voters += count > 0;
    return count > 0 ? sum / count : 0;
}

double asj_pictures_against(const asj_look *first, const asj_look *second)
{
    double sum = 0, square = 0, voters = 0;
    for (int32_t row = 0; row < ASJ_CELLS_ALONG; row += BLOCK)
        for (int32_t column = 0; column < ASJ_CELLS_ALONG; column += BLOCK) {
            const double d = ask_block(first, second, column, row, &voters);
            sum += d;
            square += d * d;
        }
    return fmax(0, sum / fmax(LEAST_SUM, fmax(LEAST_MEAN * voters, LEAST_T * sqrt(square))));
}
