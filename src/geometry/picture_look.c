/* SPDX-License-Identifier: BSD-2-Clause */
/* Pictures, through a geometry.
 *
 * Matches are corners, and where things repeat, the corners of a wrong geometry are as exact as those of the right one. Between the
 * corners there is more to see: a floor that was matched with itself shifted by a tile has other tiles there, of another colour,
 * and so has one that was turned. A geometry with planes (or a homography) says where each point of a plane is in the other
 * image. So image 1 is divided into cells. Those between the matches of a plane, or near one of them, lie on it, and each channel
 * of the images (red, green and blue where both have colours, grey levels otherwise) is compared with what is where the plane's
 * homography takes them:
 *
 *     log of the mean level in image 2 = a + b times that in image 1 + r,
 *
 * a and b (exposure, gamma, white balance) fitted to the cells of each geometry with the weights 1/(ASJ_LEAST_DIFFERENCE + |r|),
 * which is nearly least absolute deviations. How far a cell's pictures differ is the mean of |r| over the channels. What follows
 * from it: picture_vote.c, of two geometries; picture_agreement.c, of one. */
#include "picture_look.h"
#include "likelihood.h"
#include "core/threads.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define PROBABLE 0.3
#define BESIDE 0.5       /* cells: so far outside the matches of a plane it goes on, .. */
#define AROUND 2.0       /* .. and so far around each of them */
#define SAMPLES 3        /* along the side of a cell */
#define DARK 4.0         /* grey levels: noise of what is nearly black */
#define ROUNDS 8
#define LEAST_SLOPE 0.7
#define MOST_SLOPE 1.4
#define STIFF 0.02       /* variance of the brightness from which on the pictures tell the slope */
#define LEAST_CELLS 8
#define LEAST_AREA 0.05  /* a map that shrinks or enlarges a cell more than this shows nothing of it */
#define MOST_AREA 20.0

static void forget(asj_picture_look *look)
{
    memset(look, 0, sizeof *look);
    for (int32_t n = 0; n < ASJ_CELLS; n++)
        look->cells[n].plane = -1;
}

asj_pictures *asj_pictures_create(asj_memory *memory, const asj_picture of[2], int32_t candidates)
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
    for (int32_t k = 0; k < 2; k++) {
        p->of[k] = of[k];
        forget(&p->looks[k]);
    }
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
static int32_t plane_at(const asj_pictures *pictures, int32_t count, double x, double y, double cell, int32_t *is_near)
{
    const double around = AROUND * AROUND * cell * cell;
    double nearest = HUGE_VAL;
    int32_t plane = -1;
    for (int32_t n = 0; n < count; n++) {
        const asj_patch_of_plane *p = &pictures->planes[n];
        double least = HUGE_VAL;
        for (int32_t k = 0; k < p->count; k++) {
            const double dx = p->list[k]->x1 - x, dy = p->list[k]->y1 - y, d2 = dx * dx + dy * dy;
            least = d2 < least ? d2 : least;
        }
        if (least < nearest && (least < around || is_between(p, x, y, BESIDE * cell))) {
            nearest = least;
            plane = n;
        }
    }
    *is_near = nearest < around;
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

static int32_t is_inside(const asj_picture *p, double x, double y)
{
    return x >= 0 && y >= 0 && x <= p->width - 1 && y <= p->height - 1;
}

/* Logarithm of the mean level of each channel at `count` places of the image, which together are `area` px^2 large. */
static void measure(const asj_picture *p, const float *x, const float *y, int32_t count, double area, double *brightness)
{
    const double sample = area / (count * p->scale * p->scale);
    uint16_t level[SAMPLES * SAMPLES];
    for (int32_t channel = 0; channel < p->channel_count; channel++) {
        const asj_pyramid *of = p->channels[channel];
        double sum = 0;
        asj_pyramid_sample(of, asj_pyramid_level(of, sample), x, y, count, level);
        for (int32_t n = 0; n < count; n++)
            sum += level[n];
        brightness[channel] = log(sum / (count * ASJ_GRAY_ONE) + DARK);
    }
}

/* Both images' brightness over a cell. 0: not seen. */
static int32_t compare_cell(const asj_pictures *pictures, const double h[9], double x, double y, double cell, asj_seen_cell *seen,
                            double brightness[2][ASJ_MOST_CHANNELS])
{
    const asj_picture *of = pictures->of;
    float at[2][2][SAMPLES * SAMPLES];
    double middle[2], right[2], below[2];
    if (!go(h, x, y, middle) || !go(h, x + 1, y, right) || !go(h, x, y + 1, below))
        return 0;
    const double area = (right[0] - middle[0]) * (below[1] - middle[1]) - (right[1] - middle[1]) * (below[0] - middle[0]);
    if (!(area > LEAST_AREA && area < MOST_AREA))
        return 0;
    for (int32_t n = 0; n < SAMPLES * SAMPLES; n++) {
        const double apart = cell / SAMPLES;
        double in[2][2] = {{x + (n % SAMPLES - (SAMPLES - 1) / 2) * apart, y + (n / SAMPLES - (SAMPLES - 1) / 2) * apart}};
        if (!go(h, in[0][0], in[0][1], in[1]) || !is_inside(&of[0], in[0][0], in[0][1]) || !is_inside(&of[1], in[1][0], in[1][1]))
            return 0;
        for (int32_t side = 0; side < 2; side++)
            for (int32_t k = 0; k < 2; k++)
                at[side][k][n] = (float)((in[side][k] + 0.5) / of[side].scale - 0.5);
    }
    for (int32_t side = 0; side < 2; side++)
        measure(&of[side], at[side][0], at[side][1], SAMPLES * SAMPLES, cell * cell * (side ? area : 1), brightness[side]);
    seen->x2 = middle[0];
    seen->y2 = middle[1];
    return 1;
}

/* The line through the brightness of the cells in a channel, and what each lies off it. */
static void fit(asj_picture_look *look, int32_t channel)
{
    double (*const brightness)[2] = look->brightness[channel];
    double a = 0, b = 1;
    for (int32_t round = 0; round <= ROUNDS; round++) {
        double sum = 0, sum1 = 0, sum2 = 0, sum11 = 0, sum12 = 0;
        for (int32_t n = 0; n < ASJ_CELLS; n++) {
            const double g1 = brightness[n][0], g2 = brightness[n][1];
            if (look->cells[n].plane < 0)
                continue;
            const double weight = round == 0 ? 1 : 1 / (ASJ_LEAST_DIFFERENCE + fabs(g2 - a - b * g1));
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
    look->offset[channel] = a;
    look->slope[channel] = b;
    for (int32_t n = 0; n < ASJ_CELLS; n++)
        look->cells[n].difference += fabs(brightness[n][1] - a - b * brightness[n][0]) / look->channel_count;
}

/* One cell. */
static void look_at_cell(const asj_pictures *pictures, const asj_two_view *view, int32_t planes, int32_t n, asj_picture_look *look)
{
    const double cell = look->cell;
    const double x = (n % ASJ_CELLS_ALONG + 0.5) * cell - 0.5, y = (n / ASJ_CELLS_ALONG + 0.5) * cell - 0.5;
    asj_seen_cell *c = &look->cells[n];
    double brightness[2][ASJ_MOST_CHANNELS];
    if (!(planes > 0 && x < pictures->of[0].width && y < pictures->of[0].height))
        return;
    const int32_t plane = plane_at(pictures, planes, x, y, cell, &c->is_near);
    if (plane < 0 ||
        !compare_cell(pictures, view->planar ? view->matrix : view->planes[plane], x, y, cell, c, brightness))
        return;
    c->plane = plane;
    for (int32_t channel = 0; channel < look->channel_count; channel++)
        for (int32_t side = 0; side < 2; side++)
            look->brightness[channel][n][side] = brightness[side][channel];
}

typedef struct job {
    const asj_pictures *pictures;
    const asj_two_view *view;
    int32_t planes;
    asj_picture_look *look;
} job;

static void look_at_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++)
        look_at_cell(j->pictures, j->view, j->planes, (int32_t)n, j->look);
}

void asj_pictures_look(const asj_context *context, asj_pictures *pictures, const asj_pairs *set, const asj_two_view *view,
                       const double *probability, asj_picture_look *look)
{
    const int32_t width = pictures->of[0].width, height = pictures->of[0].height;
    const int32_t planes = find_planes(pictures, set, view, probability);
    int32_t count = 0;
    forget(look);
    look->cell = (double)(width > height ? width : height) / ASJ_CELLS_ALONG;
    look->channel_count = pictures->of[0].channel_count;
    const job j = {pictures, view, planes, look};
    asj_parallel(context, context->threads, ASJ_CELLS, ASJ_CELLS_ALONG, look_at_some, &j);
    for (int32_t n = 0; n < ASJ_CELLS; n++)
        count += look->cells[n].plane >= 0;
    for (int32_t n = 0; n < ASJ_CELLS && count < LEAST_CELLS; n++)
        look->cells[n].plane = -1;
    for (int32_t channel = 0; channel < look->channel_count; channel++)
        fit(look, channel);
}
