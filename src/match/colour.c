/* SPDX-License-Identifier: BSD-2-Clause */
/* What colours surround an L-junction: the mean of red, green and blue in six regions, in pixels of the image, or
 * of the image upsampled by two where the L-junctions are (image_features.c).
 *
 *   strips     rows 3 and 4.5 px beside a branch, from where they leave what is near the other branch to 24 px or its end
 *   sectors    on three rays between the branches, and on three opposite, 6 to 15 px away
 *
 * All of these lengths are doubled with each octave that the junction was located in, up to the fourth: 384 px of a strip are as
 * much as an image shows of one thing. The nearest pixel counts; a pixel that is cut in one channel does not, since its colour is
 * not that of the scene.
 *
 * Sums of whole numbers at places that are rounded once: the same on every machine. Neither exposure nor white balance is known
 * here: what two images differ in as a whole is seen when they are compared. */
#include "colour.h"
#include "core/colour_plane.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define NEAREST 3.0   /* px: of a strip from its branch */
#define APART 1.5     /* px between samples */
#define FIRST 3.0     /* px: from the corner */
#define LONGEST 24.0  /* px: of a strip */
#define INNERMOST 6.0 /* px: of a sector */
#define RINGS 4
#define RING 3.0      /* px between them */
#define CUT 255       /* or the level that means white */
#define LEAST_SHARE 3 /* a region is seen when a third of its samples counts */
#define LEVEL_ONE 128
#define LARGEST_OCTAVE 4

typedef struct picture {
    asj_channels channels;
    int32_t cut; /* from this level on a channel is cut */
    double scale; /* px for one of the L-junctions' */
} picture;

typedef struct sums {
    uint32_t channel[3], count, tried;
} sums;

static int32_t picture_of(const asj_image *image, picture *p)
{
    p->cut = image->white > 0 && image->white < CUT ? (int32_t)ceilf(image->white) : CUT;
    return asj_channels_of(image, &p->channels);
}

static void add(const picture *p, double x, double y, sums *s)
{
    const asj_channels *c = &p->channels;
    s->tried++;
    x = (x + 0.5) * p->scale - 0.5;
    y = (y + 0.5) * p->scale - 0.5;
    if (!(x > -0.5 && y > -0.5 && x < c->width - 0.5 && y < c->height - 0.5))
        return;
    const int32_t column = (int32_t)fmin(x + 0.5, c->width - 1), row = (int32_t)fmin(y + 0.5, c->height - 1);
    const uint8_t *pixel = c->first + row * c->stride + (ptrdiff_t)column * c->step;
    const uint8_t red = pixel[c->red], green = pixel[1], blue = pixel[2 - c->red];
    if (red >= p->cut || green >= p->cut || blue >= p->cut)
        return;
    s->channel[0] += red;
    s->channel[1] += green;
    s->channel[2] += blue;
    s->count++;
}

static void set_level(const sums *s, uint16_t level[3])
{
    memset(level, 0, 3 * sizeof *level);
    if (s->count == 0 || LEAST_SHARE * s->count < s->tried)
        return;
    for (int32_t c = 0; c < 3; c++)
        level[c] = (uint16_t)((s->channel[c] * LEVEL_ONE + s->count / 2) / s->count);
    if (level[0] + level[1] + level[2] == 0) /* black: seen, and as dark as can be told */
        level[0] = level[1] = level[2] = 1;
}

/* An L-junction as it is sampled. */
typedef struct corner {
    double x, y, scale;
    double direction[2][2], length[2]; /* of branches a and b */
    double cosine, sine;               /* of the angle from a to b */
} corner;

/* side: 1 on that of the other branch, -1 on the other. */
static void strip(const picture *p, const corner *c, int32_t branch, int32_t side, uint16_t level[3])
{
    const double *d = c->direction[branch], turn = (branch == 0) == (c->sine > 0) ? side : -side;
    const double normal[2] = {-turn * d[1], turn * d[0]}, s = c->scale, last = fmin(LONGEST * s, c->length[branch]);
    sums sum = {{0, 0, 0}, 0, 0};
    for (int32_t row = 0; row < 2; row++) {
        const double aside = (NEAREST + APART * row) * s;
        /* between the branches a strip begins where it is as far from the other one: there t = aside / tan(angle / 2) */
        const double first = side > 0 ? aside * (1 + c->cosine) / fmax(fabs(c->sine), 1e-6) : 0;
        for (double t = fmax(FIRST * s, first); t <= last; t += APART * s)
            add(p, c->x + t * d[0] + aside * normal[0], c->y + t * d[1] + aside * normal[1], &sum);
    }
    set_level(&sum, level);
}

/* side: 1 between the branches, -1 opposite. */
static void sector(const picture *p, const corner *c, int32_t side, uint16_t level[3])
{
    sums sum = {{0, 0, 0}, 0, 0};
    for (int32_t ray = 1; ray <= 3; ray++) {
        const double u = 4 - ray, v = ray;
        const double x = u * c->direction[0][0] + v * c->direction[1][0], y = u * c->direction[0][1] + v * c->direction[1][1];
        const double length = side * sqrt(x * x + y * y);
        for (int32_t ring = 0; ring < RINGS; ring++) {
            const double radius = (INNERMOST + RING * ring) * c->scale;
            add(p, c->x + radius * x / length, c->y + radius * y / length, &sum);
        }
    }
    set_level(&sum, level);
}

static double distance(const asj_l_junction *l, float x, float y)
{
    const double dx = (double)x - (double)l->x, dy = (double)y - (double)l->y;
    return sqrt(dx * dx + dy * dy);
}

static void look_around(const picture *p, const asj_l_junctions *in, int64_t index, asj_colour *colour)
{
    const asj_l_junction *l = &in->l[index];
    const double *d = in->direction + 4 * index;
    const int32_t octave = in->octave[index] < LARGEST_OCTAVE ? in->octave[index] : LARGEST_OCTAVE;
    const corner c = {(double)l->x, (double)l->y, (double)(1 << octave), {{d[0], d[1]}, {d[2], d[3]}},
                      {distance(l, l->ax, l->ay), distance(l, l->bx, l->by)},
                      d[0] * d[2] + d[1] * d[3], d[0] * d[3] - d[1] * d[2]};
    for (int32_t branch = 0; branch < 2; branch++) {
        strip(p, &c, branch, 1, colour->level[2 * branch]);
        strip(p, &c, branch, -1, colour->level[2 * branch + 1]);
    }
    sector(p, &c, 1, colour->level[4]);
    sector(p, &c, -1, colour->level[5]);
}

typedef struct job {
    const picture *picture;
    const asj_l_junctions *l_junctions;
    asj_colour *colours;
    asj_watch *watch;
} job;

static void look_around_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end && !asj_watch_stops(j->watch, part); n++)
        look_around(j->picture, j->l_junctions, n, &j->colours[n]);
}

/* Guests (guests.c) are no candidates of a geometry, and are not asked. */
static int32_t is_grey(const asj_colour *colours, const asj_l_junctions *in)
{
    for (uint32_t n = 0; n < in->count; n++)
        for (int32_t r = 0; r < ASJ_COLOUR_REGIONS && !asj_is_guest(in, n); r++) {
            const uint16_t *level = colours[n].level[r];
            if (level[0] != level[1] || level[1] != level[2])
                return 0;
        }
    return 1;
}

asj_status asj_colours_create(asj_context *context, const asj_image *image, const asj_l_junctions *l_junctions,
                              asj_colour **colours)
{
    picture p;
    *colours = NULL;
    if (!picture_of(image, &p))
        return ASJ_OK;
    p.scale = l_junctions->upsampled ? 0.5 : 1;
    asj_colour *made = asj_allocate(&context->memory, l_junctions->count, sizeof *made);
    if (!made)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the colours of %lu L-junctions",
                        (unsigned long)l_junctions->count);
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    const job j = {&p, l_junctions, made, &watch};
    asj_parallel(context, asj_threads_for(context, l_junctions->count, 256), l_junctions->count, 0, look_around_some, &j);
    if (watch.stopped || is_grey(made, l_junctions))
        asj_release(&context->memory, made);
    else
        *colours = made;
    return asj_watch_end(&watch);
}
