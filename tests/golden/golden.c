/* SPDX-License-Identifier: BSD-2-Clause */
/* Golden results: junctions of synthetic pictures, rendered here, against files in expected/. The detector is deterministic, so the
 * tolerances are those of the printed digits and of other compilers' libm; a change of the method shows here, and then
 *
 *     golden compare FOLDER            what differs first, exit 1
 *     golden display SCENE             what is found now
 *     golden generate FOLDER           writes the files anew: look at the difference before committing it
 *     golden meta FOLDER               the comparison itself: an empty result and one moved by a pixel must be told apart
 *
 * In a build folder, `meson compile update-golden` is `golden generate` with the right folder. */
#include <asj/asj.h>

#include "render.h"
#include "scenes.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* px, rad, decades and standard deviations. */
static const double place_tolerance = 0.01, angle_tolerance = 0.001, length_tolerance = 0.02, other_tolerance = 0.02;

/* ---- scenes ---- */

typedef struct scene_row {
    const char *name;
    int32_t kind, preset;
    uint64_t seed;
    double blur, noise;
} scene_row;

enum { PARALLELOGRAMS, CHECKERBOARD, RANDOM_TILES, BORDER, GRID, STAR, EMPTY };

static const scene_row rows[] = {
    {"parallelograms", PARALLELOGRAMS, ASJ_PRESET_DEFAULT, 11, 1, 2},
    {"parallelograms-noisy", PARALLELOGRAMS, ASJ_PRESET_DEFAULT, 12, 0.8, 8},
    {"parallelograms-paper", PARALLELOGRAMS, ASJ_PRESET_PAPER, 11, 1, 2},
    {"checkerboard", CHECKERBOARD, ASJ_PRESET_DEFAULT, 3, 1, 1},
    {"tiles", RANDOM_TILES, ASJ_PRESET_DEFAULT, 4, 1, 2},
    {"border", BORDER, ASJ_PRESET_DEFAULT, 5, 1, 2},
    {"line-grid", GRID, ASJ_PRESET_DEFAULT, 6, 0.8, 1},
    {"star-2", STAR, ASJ_PRESET_DEFAULT, 4, 1, 1},
    {"star-3", STAR, ASJ_PRESET_DEFAULT, 5, 1, 1},
    {"star-4", STAR, ASJ_PRESET_DEFAULT, 6, 1, 1},
    {"star-5", STAR, ASJ_PRESET_DEFAULT, 7, 1, 1},
    {"noise", EMPTY, ASJ_PRESET_DEFAULT, 8, 0, 20},
};
enum { SCENES = sizeof rows / sizeof rows[0] };

static uint8_t *picture(const scene_row *row, int32_t *width, int32_t *height)
{
    synth_scene scene;
    synth_point ends[2 * SYNTH_GRID_LINES];
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

/* ---- results: what both the detector and the files give ---- */

typedef struct list {
    asj_junction *junctions;
    size_t count, capacity;
} list;

static int add(list *to, const asj_junction *junction)
{
    if (to->count == to->capacity) {
        const size_t capacity = 2 * to->capacity + 16;
        asj_junction *larger = realloc(to->junctions, capacity * sizeof *larger);
        if (!larger)
            return 0;
        to->junctions = larger;
        to->capacity = capacity;
    }
    to->junctions[to->count++] = *junction;
    return 1;
}

static int detect(const scene_row *row, list *found)
{
    int32_t width, height;
    asj_context *context = NULL;
    asj_detection *detection = NULL;
    asj_detect_options options;
    uint8_t *pixels = picture(row, &width, &height);
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    int good = pixels && asj_detect_options_preset(&options, row->preset) == ASJ_OK &&
               asj_context_create(NULL, &context) == ASJ_OK &&
               asj_detect(context, &image, &options, &detection) == ASJ_OK;
    memset(found, 0, sizeof *found);
    for (uint32_t i = 0; good && i < detection->junction_count; i++)
        good = add(found, &detection->junctions[i]);
    asj_detection_free(&detection);
    asj_context_free(&context);
    free(pixels);
    if (!good)
        fprintf(stderr, "%s: cannot be made or detected\n", row->name);
    return good;
}

/* ---- files: a line for each branch ---- */

static const char header[] = "junction,x,y,scale,log10_nfa,branch,angle,length,strength,branch_log10_nfa\n";

static void print(FILE *file, const list *found)
{
    fputs(header, file);
    for (size_t i = 0; i < found->count; i++)
        for (int32_t b = 0; b < found->junctions[i].branch_count; b++) {
            const asj_junction *j = &found->junctions[i];
            const asj_branch *branch = &j->branches[b];
            fprintf(file, "%zu,%.4f,%.4f,%.0f,%.3f,%d,%.5f,%.3f,%.3f,%.3f\n", i, (double)j->x, (double)j->y, (double)j->scale,
                    (double)j->log10_nfa, (int)b, (double)branch->angle, (double)branch->length, (double)branch->strength,
                    (double)branch->log10_nfa);
        }
}

static FILE *open_expected(const char *folder, const scene_row *row, const char *mode)
{
    char name[1024];
    snprintf(name, sizeof name, "%s/%s.csv", folder, row->name);
    FILE *file = fopen(name, mode);
    if (!file)
        perror(name);
    return file;
}

static int read_expected(const char *folder, const scene_row *row, list *expected)
{
    char line[256];
    FILE *file = open_expected(folder, row, "r");
    int good = file && fgets(line, sizeof line, file) && strcmp(line, header) == 0;
    memset(expected, 0, sizeof *expected);
    while (good && fgets(line, sizeof line, file)) {
        asj_junction j;
        asj_branch branch;
        size_t index;
        int b;
        memset(&j, 0, sizeof j);
        memset(&branch, 0, sizeof branch);
        good = sscanf(line, "%zu,%f,%f,%f,%f,%d,%f,%f,%f,%f", &index, &j.x, &j.y, &j.scale, &j.log10_nfa, &b, &branch.angle,
                      &branch.length, &branch.strength, &branch.log10_nfa) == 10 && b >= 0 && b < ASJ_MAX_BRANCHES;
        if (good && b == 0)
            good = add(expected, &j);
        good = good && expected->count == index + 1;
        if (good) {
            expected->junctions[index].branches[b] = branch;
            expected->junctions[index].branch_count = b + 1;
        }
    }
    if (file)
        fclose(file);
    if (!good)
        fprintf(stderr, "%s: no golden file, or a damaged one\n", row->name);
    return good;
}

/* ---- comparison ---- */

static double turn(double a, double b)
{
    return fabs(remainder(a - b, 2 * 3.14159265358979323846));
}

/* The largest difference, in tolerances; what it is in. */
static double difference(const asj_junction *a, const asj_junction *b, const char **what)
{
    double worst = fmax(fabs((double)a->x - b->x), fabs((double)a->y - b->y)) / place_tolerance;
    *what = "location";
    if (a->branch_count != b->branch_count) {
        *what = "number of branches";
        return fmax(worst, 1e6);
    }
#define LOOK(value, tolerance, name) \
    if ((value) / (tolerance) > worst) { \
        worst = (value) / (tolerance); \
        *what = name; \
    }
    LOOK(fabs((double)a->scale - b->scale), 0.5, "scale")
    LOOK(fabs((double)a->log10_nfa - b->log10_nfa), other_tolerance, "log10_nfa")
    for (int32_t i = 0; i < a->branch_count; i++) {
        const asj_branch *p = &a->branches[i], *q = &b->branches[i];
        LOOK(turn(p->angle, q->angle), angle_tolerance, "angle of a branch")
        LOOK(fabs((double)p->length - q->length), length_tolerance, "length of a branch")
        LOOK(fabs((double)p->strength - q->strength), other_tolerance, "strength of a branch")
        LOOK(fabs((double)p->log10_nfa - q->log10_nfa), other_tolerance, "log10_nfa of a branch")
    }
#undef LOOK
    return worst;
}

/* Everything in `from` has its like in `to`. Prints the first that has not, with what comes nearest. */
static int all_in(const char *scene, const char *direction, const list *from, const list *to)
{
    for (size_t i = 0; i < from->count; i++) {
        const asj_junction *j = &from->junctions[i], *nearest = NULL;
        double least = HUGE_VAL;
        const char *what = "", *least_what = "";
        for (size_t k = 0; k < to->count; k++) {
            const double d = difference(j, &to->junctions[k], &what);
            if (d < least) {
                least = d;
                least_what = what;
                nearest = &to->junctions[k];
            }
        }
        if (least <= 1)
            continue;
        printf("%s: junction %zu at (%.4f, %.4f) with %d branches is %s; ", scene, i, (double)j->x, (double)j->y,
               (int)j->branch_count, direction);
        if (nearest)
            printf("nearest (%.4f, %.4f) with %d branches: %s off by %.1f tolerances\n", (double)nearest->x, (double)nearest->y,
                   (int)nearest->branch_count, least_what, least);
        else
            puts("there is none");
        return 0;
    }
    return 1;
}

static int same(const char *scene, const list *found, const list *expected)
{
    if (found->count != expected->count) {
        printf("%s: %zu junctions instead of %zu\n", scene, found->count, expected->count);
        all_in(scene, "missing", expected, found);
        return 0;
    }
    return all_in(scene, "missing", expected, found) && all_in(scene, "new", found, expected);
}

static int compare(const char *folder)
{
    int differ = 0, junctions = 0;
    for (int i = 0; i < SCENES; i++) {
        list found = {NULL, 0, 0}, expected = {NULL, 0, 0};
        if (!detect(&rows[i], &found) || !read_expected(folder, &rows[i], &expected) || !same(rows[i].name, &found, &expected))
            differ++;
        junctions += (int)expected.count;
        free(found.junctions);
        free(expected.junctions);
    }
    printf("%d scenes, %d junctions, %d scenes differ\n", SCENES, junctions, differ);
    return differ || junctions == 0;
}

/* What is compared with itself is the same; nothing, and everything a pixel to the right, is not. */
static int meta(const char *folder)
{
    int wrong = 0, tried = 0;
    for (int i = 0; i < SCENES; i++) {
        list expected = {NULL, 0, 0}, none = {NULL, 0, 0}, moved = {NULL, 0, 0};
        wrong += !read_expected(folder, &rows[i], &expected) || !read_expected(folder, &rows[i], &moved);
        for (size_t k = 0; k < moved.count; k++)
            moved.junctions[k].x += 1;
        wrong += !same(rows[i].name, &expected, &expected);
        if (expected.count) {
            tried++;
            wrong += same(rows[i].name, &none, &expected) || same(rows[i].name, &moved, &expected);
        }
        free(expected.junctions);
        free(moved.junctions);
    }
    printf("meta: %d scenes with junctions, %d wrong answers\n", tried, wrong);
    return wrong || tried < 5;
}

static int generate(const char *folder)
{
    for (int i = 0; i < SCENES; i++) {
        list found;
        FILE *file = NULL;
        const int good = detect(&rows[i], &found) && (file = open_expected(folder, &rows[i], "w")) != NULL;
        if (good)
            print(file, &found);
        free(found.junctions);
        if (!good || fclose(file) != 0)
            return 1;
    }
    return 0;
}

static int display(const char *name)
{
    for (int i = 0; i < SCENES; i++)
        if (strcmp(rows[i].name, name) == 0) {
            list found;
            const int good = detect(&rows[i], &found);
            print(stdout, &found);
            free(found.junctions);
            return !good;
        }
    fprintf(stderr, "no scene '%s'; there are:", name);
    for (int i = 0; i < SCENES; i++)
        fprintf(stderr, " %s", rows[i].name);
    fputs("\n", stderr);
    return 2;
}

int main(int count, char **arguments)
{
    static const struct {
        const char *name;
        int (*run)(const char *argument);
    } modes[] = {{"compare", compare}, {"meta", meta}, {"generate", generate}, {"display", display}};
    for (size_t i = 0; count == 3 && i < sizeof modes / sizeof modes[0]; i++)
        if (strcmp(arguments[1], modes[i].name) == 0)
            return modes[i].run(arguments[2]);
    fprintf(stderr, "usage: golden compare|meta|generate FOLDER\n       golden display SCENE\n");
    return 2;
}
