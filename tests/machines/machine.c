/* SPDX-License-Identifier: BSD-2-Clause */
/* The same bits on every machine? Two views of a wall, made by whole numbers alone, so that they are the same everywhere; junctions
 * and matches of them; one line for each result: how many there are, and a hash of all their numbers, bit by bit.
 * scripts/machines.sh builds and runs it for many machines. */
#include <asj/asj.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { WIDTH = 320, HEIGHT = 168, FINE = 4, PANELS = 10 };

/* --- pictures --------------------------------------------------------------------------------------------------------------- */

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 16;
}

/* A quadrilateral in 1/FINE px, corners clockwise on the screen. */
typedef struct panel {
    int32_t x[4], y[4];
    int32_t level;
} panel;

static int covers(const panel *p, int32_t x, int32_t y)
{
    for (int i = 0; i < 4; i++) {
        const int32_t j = (i + 1) % 4, ax = p->x[j] - p->x[i], ay = p->y[j] - p->y[i];
        if (ax * (y - p->y[i]) - ay * (x - p->x[i]) < 0)
            return 0;
    }
    return 1;
}

/* Panels on a lattice of 5 x 2, each turned and sheared; the second view is the first one under x' = (71 x - 6 y) / 64 - 100,
 * y' = (5 x + 67 y) / 64 - 90, in 1/FINE px. */
static void make_panels(panel *panels, int view)
{
    uint32_t state = 7;
    for (int32_t n = 0; n < PANELS; n++) {
        const int32_t cx = (n % 5 * 60 + 40) * FINE, cy = (n / 5 * 72 + 44) * FINE, turn = (int32_t)(next_random(&state) % 31) - 15;
        const int32_t w = (int32_t)(next_random(&state) % 10 + 15) * FINE, h = (int32_t)(next_random(&state) % 12 + 16) * FINE;
        const int32_t sx[4] = {-w, w, w, -w}, sy[4] = {-h, -h, h, h};
        panels[n].level = (int32_t)(next_random(&state) % 180 + 40);
        for (int i = 0; i < 4; i++) {
            const int32_t x = cx + sx[i] - sy[i] * turn / 40, y = cy + sy[i] + sx[i] * turn / 40;
            panels[n].x[i] = view ? (71 * x - 6 * y) / 64 - 100 : x;
            panels[n].y[i] = view ? (5 * x + 67 * y) / 64 - 90 : y;
        }
    }
}

/* Means of FINE x FINE samples, a blur of 1 2 1 along x and y, noise of -3 .. 3. */
static void draw(uint8_t *pixels, int view)
{
    static int32_t plane[HEIGHT][WIDTH];
    panel panels[PANELS];
    uint32_t state = 99 + (uint32_t)view;
    make_panels(panels, view);
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            int32_t sum = 0;
            for (int32_t s = 0; s < FINE * FINE; s++) {
                int32_t level = 100 + x / 16;
                for (int n = 0; n < PANELS; n++)
                    if (covers(&panels[n], x * FINE + s % FINE, y * FINE + s / FINE))
                        level = panels[n].level;
                sum += level;
            }
            plane[y][x] = sum / (FINE * FINE) * 16;
        }
    for (int32_t y = 0; y < HEIGHT; y++)
        for (int32_t x = 0; x < WIDTH; x++) {
            int32_t sum = 0;
            for (int32_t dy = -1; dy <= 1; dy++)
                for (int32_t dx = -1; dx <= 1; dx++) {
                    const int32_t i = y + dy < 0 ? 0 : y + dy >= HEIGHT ? HEIGHT - 1 : y + dy;
                    const int32_t j = x + dx < 0 ? 0 : x + dx >= WIDTH ? WIDTH - 1 : x + dx;
                    sum += plane[i][j] * (2 - dx * dx) * (2 - dy * dy);
                }
            pixels[y * WIDTH + x] = (uint8_t)(sum / 256 + (int32_t)(next_random(&state) % 7) - 3);
        }
}

/* --- hashes ----------------------------------------------------------------------------------------------------------------- */

/* FNV-1a of the bytes from the least significant one on. */
static void add(uint64_t *hash, uint64_t bits, int bytes)
{
    for (int i = 0; i < bytes; i++)
        *hash = (*hash ^ (bits >> 8 * i & 255)) * 0x100000001b3u;
}

static void add_float(uint64_t *hash, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    add(hash, bits, 4);
}

static void add_double(uint64_t *hash, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    add(hash, bits, 8);
}

static void add_junction(uint64_t *hash, const asj_junction *j)
{
    const float numbers[] = {j->x, j->y, j->scale, j->log10_nfa, j->location_sd};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        add_float(hash, numbers[i]);
    add(hash, (uint32_t)j->branch_count, 4);
    for (int32_t b = 0; b < j->branch_count; b++) {
        const asj_branch *branch = &j->branches[b];
        const float more[] = {branch->angle, branch->length, branch->strength, branch->log10_nfa, branch->angle_sd};
        for (size_t i = 0; i < sizeof more / sizeof *more; i++)
            add_float(hash, more[i]);
    }
}

static void add_match(uint64_t *hash, const asj_junction_match *m)
{
    const float numbers[] = {m->x1,  m->y1,  m->x2,  m->y2,       m->ax1,        m->ay1,    m->bx1, m->by1,
                             m->ax2, m->ay2, m->bx2, m->distance, m->similarity, m->support, m->probability};
    add(hash, m->l1, 4);
    add(hash, m->l2, 4);
    for (int i = 0; i < 6; i++)
        add_double(hash, m->affine[i]);
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        add_float(hash, numbers[i]);
}

static void print(const char *what, uint32_t count, uint64_t hash)
{
    printf("%s %u %08lx%08lx\n", what, (unsigned)count, (unsigned long)(hash >> 32), (unsigned long)(hash & 0xffffffff));
}

#define START 0xcbf29ce484222325u

static asj_detection *detect(asj_context *context, const char *what, const asj_image *image, int32_t preset, int32_t octaves)
{
    asj_detect_options options;
    asj_detection *found = NULL;
    uint64_t hash = START;
    asj_detect_options_preset(&options, preset);
    options.octaves = octaves;
    if (asj_detect(context, image, &options, &found) != ASJ_OK) {
        printf("%s: %s\n", what, asj_context_message(context));
        exit(1);
    }
    for (uint32_t i = 0; i < found->junction_count; i++)
        add_junction(&hash, &found->junctions[i]);
    print(what, found->junction_count, hash);
    return found;
}

static void match(asj_context *context, const char *what, const asj_image *images, asj_detection **found, int32_t descriptor,
                  int32_t geometry)
{
    asj_match_options options;
    asj_match_result *result = NULL;
    uint64_t hash = START;
    asj_match_options_init(&options);
    options.descriptor = descriptor;
    options.geometry.model = geometry;
    if (asj_match(context, &images[0], found[0]->junctions, found[0]->junction_count, &images[1], found[1]->junctions,
                  found[1]->junction_count, &options, &result) != ASJ_OK) {
        printf("%s: %s\n", what, asj_context_message(context));
        exit(1);
    }
    for (uint32_t i = 0; i < result->match_count; i++)
        add_match(&hash, &result->matches[i]);
    print(what, result->match_count, hash);
    asj_match_result_free(&result);
}

int main(void)
{
    static uint8_t pixels[2][WIDTH * HEIGHT];
    asj_context_options options;
    asj_context *context = NULL;
    asj_image images[2];
    asj_detection *found[2];
    uint64_t hash = START;
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    options.threads = 1;
    if (asj_context_create(&options, &context) != ASJ_OK)
        return 1;
    for (int v = 0; v < 2; v++) {
        draw(pixels[v], v);
        images[v] = (asj_image){pixels[v], ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0};
        for (int32_t i = 0; i < WIDTH * HEIGHT; i++)
            add(&hash, pixels[v][i], 1);
    }
    print("pictures", 2, hash);
    found[0] = detect(context, "octaves", &images[0], ASJ_PRESET_DEFAULT, 16);
    asj_detection_free(&found[0]);
    found[0] = detect(context, "paper", &images[0], ASJ_PRESET_PAPER, 1);
    asj_detection_free(&found[0]);
    for (int v = 0; v < 2; v++)
        found[v] = detect(context, v ? "second" : "first", &images[v], ASJ_PRESET_MATCH, 1);
    match(context, "match", images, found, ASJ_DESCRIPTOR_RAW, ASJ_GEOMETRY_NONE);
    match(context, "sift", images, found, ASJ_DESCRIPTOR_SIFT, ASJ_GEOMETRY_NONE);
    match(context, "geometry", images, found, ASJ_DESCRIPTOR_RAW, ASJ_GEOMETRY_AUTO);
    for (int v = 0; v < 2; v++)
        asj_detection_free(&found[v]);
    asj_context_free(&context);
    return 0;
}
