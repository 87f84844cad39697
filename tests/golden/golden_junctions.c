/* SPDX-License-Identifier: BSD-2-Clause */
/* Golden junctions: what is detected in synthetic pictures. In the files a line for each branch, with the end of an edge that it is
 * one of. */
#include "golden.h"

#include <asj/asj.h>

#include "render.h"
#include "scenes.h"
#include "wide_pair.h"

#include <stdlib.h>
#include <string.h>

typedef struct scene_row {
    const char *name;
    int32_t kind, preset;
    uint64_t seed;
    double blur, noise; /* a room has its own */
    int32_t more;       /* half octaves, and branches that were missed */
} scene_row;

enum { PARALLELOGRAMS, CHECKERBOARD, RANDOM_TILES, BORDER, GRID, STAR, EMPTY, ROOM };

static const scene_row rows[] = {
    {"parallelograms", PARALLELOGRAMS, ASJ_PRESET_DEFAULT, 11, 1, 2, 0},
    {"parallelograms-noisy", PARALLELOGRAMS, ASJ_PRESET_DEFAULT, 12, 0.8, 8, 0},
    {"parallelograms-paper", PARALLELOGRAMS, ASJ_PRESET_PAPER, 11, 1, 2, 0},
    {"checkerboard", CHECKERBOARD, ASJ_PRESET_DEFAULT, 3, 1, 1, 0},
    {"tiles", RANDOM_TILES, ASJ_PRESET_DEFAULT, 4, 1, 2, 0},
    {"border", BORDER, ASJ_PRESET_DEFAULT, 5, 1, 2, 0},
    {"line-grid", GRID, ASJ_PRESET_DEFAULT, 6, 0.8, 1, 0},
    {"star-2", STAR, ASJ_PRESET_DEFAULT, 4, 1, 1, 0},
    {"star-3", STAR, ASJ_PRESET_DEFAULT, 5, 1, 1, 0},
    {"star-4", STAR, ASJ_PRESET_DEFAULT, 6, 1, 1, 0},
    {"star-5", STAR, ASJ_PRESET_DEFAULT, 7, 1, 1, 0},
    {"noise", EMPTY, ASJ_PRESET_DEFAULT, 8, 0, 20, 0},
    {"room", ROOM, ASJ_PRESET_DEFAULT, 6, 0, 0, 0},
    {"room-match", ROOM, ASJ_PRESET_MATCH, 6, 0, 0, 0},
    {"room-soft", ROOM, ASJ_PRESET_DEFAULT, 576, 0, 0, 0},
    {"room-soft-match", ROOM, ASJ_PRESET_MATCH, 576, 0, 0, 0},
    {"room-more", ROOM, ASJ_PRESET_DEFAULT, 466, 0, 0, 1},
};
enum { SCENES = sizeof rows / sizeof rows[0] };

/* Colours, furniture, motion blur and noise. */
static uint8_t *room_picture(uint64_t seed)
{
    synth_wide_pair pair;
    if (synth_wide_pair_make(&pair, seed))
        return NULL;
    uint8_t *pixels = synth_wide_picture(&pair, 0);
    synth_wide_pair_free(&pair);
    return pixels;
}

static uint8_t *picture(const scene_row *row, int32_t *width, int32_t *height)
{
    synth_scene scene;
    synth_point ends[2 * SYNTH_GRID_LINES];
    *width = SYNTH_WIDE_WIDTH;
    *height = SYNTH_WIDE_HEIGHT;
    if (row->kind == ROOM)
        return room_picture(row->seed);
    switch (row->kind) {
    case PARALLELOGRAMS: synth_parallelograms(&scene, 60, row->seed); break;
    case CHECKERBOARD: synth_tiles(&scene, SYNTH_CHECKERBOARD, row->seed); break;
    case RANDOM_TILES: synth_tiles(&scene, SYNTH_RANDOM_TILES, row->seed); break;
    case BORDER: synth_border(&scene, row->seed); break;
    case GRID: synth_line_grid(&scene, ends, row->seed); break;
    case STAR: synth_random_star(&scene, 40, row->seed); break;
    default: synth_scene_init(&scene, 200, 160, 128);
    }
    *width = scene.width;
    *height = scene.height;
    uint8_t *pixels = synth_photograph(&scene, row->blur, row->noise, row->seed);
    synth_scene_free(&scene);
    return pixels;
}

/* A record: the junction, then eight numbers for each branch, zero where there is none. TO: junction and branch at the other end of
 * its edge, as one number; -1 without an edge. */
enum { X, Y, SCALE, NFA, BRANCHES, FIRST_BRANCH };
enum { ANGLE, LENGTH, STRENGTH, BRANCH_NFA, LENGTH_SD, END, TO, EDGE_NFA, BRANCH_NUMBERS };
enum { NUMBERS = FIRST_BRANCH + ASJ_MAX_BRANCHES * BRANCH_NUMBERS };

/* px, rad, decades and standard deviations. */
static golden_column column(size_t index)
{
    static const golden_column junction[] = {
        {"location", 0.01, 0}, {"location", 0.01, 0}, {"scale", 0.5, 0}, {"log10_nfa", 0.02, 0}, {"number of branches", 1e-6, 0},
    };
    static const golden_column branch[] = {
        {"angle of a branch", 0.001, 1}, {"length of a branch", 0.02, 0}, {"strength of a branch", 0.02, 0},
        {"log10_nfa of a branch", 0.02, 0}, {"uncertainty of a length", 0.002, 0}, {"what is at an end", 1e-6, 0},
        {"the other end of an edge", 1e-6, 0}, {"log10_nfa of an edge", 0.02, 0},
    };
    return index < FIRST_BRANCH ? junction[index] : branch[(index - FIRST_BRANCH) % BRANCH_NUMBERS];
}

static int put(const asj_junction *junction, golden_list *found)
{
    double *n = golden_add(found);
    if (!n)
        return 0;
    n[X] = (double)junction->x;
    n[Y] = (double)junction->y;
    n[SCALE] = (double)junction->scale;
    n[NFA] = (double)junction->log10_nfa;
    n[BRANCHES] = junction->branch_count;
    n += FIRST_BRANCH;
    for (int32_t b = 0; b < junction->branch_count; b++, n += BRANCH_NUMBERS) {
        n[ANGLE] = (double)junction->branches[b].angle;
        n[LENGTH] = (double)junction->branches[b].length;
        n[STRENGTH] = (double)junction->branches[b].strength;
        n[BRANCH_NFA] = (double)junction->branches[b].log10_nfa;
        n[LENGTH_SD] = (double)junction->branches[b].length_sd;
        n[END] = junction->branches[b].end;
        n[TO] = -1;
    }
    return 1;
}

/* Once all junctions are there. */
static void put_edge(const asj_edge *e, golden_list *found)
{
    const uint32_t junctions[2] = {e->junction_a, e->junction_b}, branches[2] = {e->branch_a, e->branch_b};
    for (int32_t k = 0; k < 2; k++) {
        double *n = found->numbers + (size_t)junctions[k] * NUMBERS + FIRST_BRANCH + branches[k] * BRANCH_NUMBERS;
        n[TO] = (double)junctions[1 - k] * ASJ_MAX_BRANCHES + branches[1 - k];
        n[EDGE_NFA] = (double)e->log10_nfa;
    }
}

static int detect(size_t index, golden_list *found)
{
    const scene_row *row = &rows[index];
    int32_t width, height;
    asj_context *context = NULL;
    asj_detection *detection = NULL;
    asj_detect_options options;
    uint8_t *pixels = picture(row, &width, &height);
    const asj_image image = {pixels, row->kind == ROOM ? ASJ_FORMAT_RGB8 : ASJ_FORMAT_GRAY8, width, height, 0, 0};
    int good = pixels && asj_detect_options_preset(&options, row->preset) == ASJ_OK &&
               asj_context_create(NULL, &context) == ASJ_OK;
    if (row->more)
        options.half_octaves = options.complete_junctions = 1;
    good = good && asj_detect(context, &image, &options, &detection) == ASJ_OK;
    for (uint32_t i = 0; good && i < detection->junction_count; i++)
        good = put(&detection->junctions[i], found);
    for (uint32_t k = 0; good && k < detection->edge_count; k++)
        put_edge(&detection->edges[k], found);
    asj_detection_free(&detection);
    asj_context_free(&context);
    free(pixels);
    return good;
}

static const char header[] = "junction,x,y,scale,log10_nfa,branch,angle,length,strength,branch_log10_nfa,length_sd,end,to,"
                             "edge_log10_nfa\n";

static void print(FILE *file, const golden_list *found)
{
    fputs(header, file);
    for (size_t i = 0; i < found->count; i++) {
        const double *n = found->numbers + i * NUMBERS;
        for (int b = 0; b < (int)n[BRANCHES]; b++) {
            const double *branch = n + FIRST_BRANCH + b * BRANCH_NUMBERS;
            fprintf(file, "%zu,%.4f,%.4f,%.0f,%.3f,%d,", i, n[X], n[Y], n[SCALE], n[NFA], b);
            fprintf(file, "%.5f,%.3f,%.3f,%.3f,%.4f,%.0f,%.0f,%.3f\n", branch[ANGLE], branch[LENGTH], branch[STRENGTH],
                    branch[BRANCH_NFA], branch[LENGTH_SD], branch[END], branch[TO], branch[EDGE_NFA]);
        }
    }
}

static int read_lines(FILE *file, golden_list *expected)
{
    char line[256];
    double *n = NULL;
    int good = fgets(line, sizeof line, file) && strcmp(line, header) == 0;
    while (good && fgets(line, sizeof line, file)) {
        double junction[FIRST_BRANCH], branch[BRANCH_NUMBERS];
        size_t index;
        int b;
        good = sscanf(line, "%zu,%lf,%lf,%lf,%lf,%d,%lf,%lf,%lf,%lf,%lf,%lf,%lf,%lf", &index, &junction[X], &junction[Y],
                      &junction[SCALE], &junction[NFA], &b, &branch[ANGLE], &branch[LENGTH], &branch[STRENGTH], &branch[BRANCH_NFA],
                      &branch[LENGTH_SD], &branch[END], &branch[TO], &branch[EDGE_NFA]) == 14 &&
               b >= 0 && b < ASJ_MAX_BRANCHES;
        if (good && b == 0)
            n = golden_add(expected);
        good = good && n && expected->count == index + 1;
        if (good) {
            junction[BRANCHES] = b + 1;
            memcpy(n, junction, sizeof junction);
            memcpy(n + FIRST_BRANCH + b * BRANCH_NUMBERS, branch, sizeof branch);
        }
    }
    return good;
}

static const char *name_of(size_t index)
{
    return rows[index].name;
}

const golden_kind golden_junctions = {"junctions", "scene", NUMBERS, column, X, SCENES, name_of, detect, print, read_lines};
