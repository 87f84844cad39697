/* SPDX-License-Identifier: BSD-2-Clause */
/* A wall of tiles in front of both cameras, which are one tile apart. Its upper half is matched as it is. Its lower half, half of
 * which repeats every four tiles, is matched otherwise: with what is four tiles beside that, as if the camera had moved three tiles
 * the other way, or as if it had moved by four and been turned by 90 degrees. */
#ifndef ASJ_TESTS_TILED_WALL_H
#define ASJ_TESTS_TILED_WALL_H

#include "estimation_fixture.h"

#define TILE 40
#define PERIOD 4
#define COLUMNS 16
#define ROWS 12
#define WIDTH (COLUMNS * TILE)
#define HEIGHT (ROWS * TILE)
#define FOCAL 500.0
#define LEFT 4   /* columns of corners that are matched: from here .. */
#define RIGHT 14 /* .. to before this one */
#define PLACES ((RIGHT - LEFT) * (ROWS - 2))

static const asj_camera tiled_camera = {FOCAL, FOCAL, 0.5 * (WIDTH - 1), 0.5 * (HEIGHT - 1)};

enum { TILED_SHIFTED, TILED_TURNED };

/* Corner (x1, y1) of the lower half, where it is matched. */
static void match_wrongly(int32_t way, asj_geometry_candidate *c)
{
    if (way == TILED_SHIFTED) {
        c->x2 = c->x1 - (PERIOD - 1) * TILE;
        return;
    }
    c->x2 = HEIGHT / 2 + WIDTH / 2 + TILE * PERIOD - c->y1;
    c->y2 = HEIGHT / 2 - WIDTH / 2 + c->x1;
    c->affine[0] = c->affine[3] = 0;
    c->affine[1] = -1;
    c->affine[2] = 1;
}

static void make_candidates(int32_t way, asj_geometry_candidate list[PLACES])
{
    memset(list, 0, PLACES * sizeof *list);
    for (uint32_t k = 0; k < PLACES; k++) {
        asj_geometry_candidate *c = &list[k];
        const int32_t row = 1 + (int32_t)k / (RIGHT - LEFT);
        c->x1 = TILE * (LEFT + k % (RIGHT - LEFT));
        c->y1 = TILE * row;
        c->x2 = c->x1 + TILE;
        c->y2 = c->y1;
        c->affine[0] = c->affine[3] = 1;
        c->place1 = c->place2 = k;
        c->probability = 0.5;
        if (row >= ROWS / 2)
            match_wrongly(way, c);
    }
}

/* Of the wall, which it takes so many pixels to the right in the image. */
static asj_model moved_by(double pixels, double evidence)
{
    asj_model m;
    memset(&m, 0, sizeof m);
    m.kind = ASJ_GEOMETRY_ESSENTIAL;
    m.parameters = 8;
    m.evidence = m.peak = evidence;
    m.cameras[0] = m.cameras[1] = tiled_camera;
    m.rotation[0] = m.rotation[4] = m.rotation[8] = 1;
    m.translation[0] = pixels > 0 ? 1 : -1;
    m.planes[0][2] = fabs(pixels) / FOCAL;
    m.view.plane_count = 1;
    assert_true(asj_model_complete(&m));
    return m;
}

static asj_model right_motion(double evidence)
{
    return moved_by(TILE, evidence);
}

/* That of the lower half's matches. */
static asj_model wrong_motion(int32_t way, double evidence)
{
    if (way == TILED_SHIFTED)
        return moved_by(-(PERIOD - 1) * TILE, evidence);
    asj_model m = moved_by(PERIOD * TILE + 1, evidence); /* the camera's middle is half a pixel beside a corner */
    m.rotation[0] = m.rotation[4] = 0;
    m.rotation[1] = -1;
    m.rotation[3] = 1;
    assert_true(asj_model_complete(&m));
    return m;
}

/* Which of the levels a tile has in a channel: every other row of the lower half repeats. */
static int32_t level_of(int32_t column, int32_t row, int32_t channel, int32_t contrast)
{
    synth_random random;
    const int32_t repeats = row >= ROWS / 2 && row % 2 == 0;
    const int32_t number = repeats ? column % PERIOD : column;
    synth_random_seed(&random, 1 + (uint64_t)channel + 8 * (uint64_t)(row + ROWS * (number + PERIOD)));
    return (int32_t)synth_random_between(&random, 100, 100 + contrast);
}

static void paint(int32_t which, int32_t channel, int32_t contrast, uint8_t *pixels)
{
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            const int32_t line = x % TILE < 2 || y % TILE < 2;
            pixels[y * WIDTH + x] = (uint8_t)(line ? 60 : level_of(x / TILE - which, y / TILE, channel, contrast));
        }
}

/* An estimation that has found nothing yet, and is shown the wall in so many channels; 0: nobody shows it. */
static asj_estimation *create_tiled(asj_context *context, int32_t way, int32_t channels, int32_t contrast,
                                    asj_geometry_options *options)
{
    const int32_t contrasts[ASJ_MOST_CHANNELS] = {contrast, contrast, contrast};
    asj_geometry_candidate list[PLACES];
    asj_geometry_options_init(options);
    for (int32_t v = 0; v < 2; v++) {
        options->widths[v] = WIDTH;
        options->heights[v] = HEIGHT;
        options->cameras[v] = tiled_camera;
    }
    make_candidates(way, list);
    asj_estimation *e = create_estimation(context, list, PLACES, options);
    show_pictures(context, e, channels, contrasts, paint);
    return e;
}

#endif
