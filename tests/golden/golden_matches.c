/* SPDX-License-Identifier: BSD-2-Clause */
/* Golden matches: two rendered views of the sample room and their true junctions (so that a change of the detector does not show
 * here), matched and held against files in expected/. A change of the method shows here, and then
 *
 *     golden_matches compare FOLDER    what differs first, exit 1
 *     golden_matches display ROW       what is found now
 *     golden_matches generate FOLDER   writes the files anew: look at the difference before committing it
 *     golden_matches meta FOLDER       the comparison itself: an empty result and one moved by a pixel must be told apart
 *
 * In a build folder, `meson compile update-golden-matches` is `golden_matches generate` with the right folder. */
#include <asj/asj.h>

#include "render.h"
#include "room.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 480
#define HEIGHT 356

/* px; and for the linear part, distance and correlation. The printed digits and other compilers' libm. */
static const double place_tolerance = 0.02, other_tolerance = 0.002;

typedef struct golden_row {
    const char *name;
    int32_t preset, descriptor, second; /* view 0 with this one */
} golden_row;

static const golden_row rows[] = {
    {"room-matches", ASJ_PRESET_DEFAULT, ASJ_DESCRIPTOR_RAW, 1},
    {"room-matches-near", ASJ_PRESET_DEFAULT, ASJ_DESCRIPTOR_RAW, 3},
    {"room-matches-sift", ASJ_PRESET_DEFAULT, ASJ_DESCRIPTOR_SIFT, 1},
    {"room-matches-paper", ASJ_PRESET_PAPER, ASJ_DESCRIPTOR_RAW, 1},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

enum { X1, Y1, X2, Y2, H11, H12, H21, H22, AX2, AY2, BX2, BY2, DISTANCE, SIMILARITY, NUMBERS };

/* Most matches that a row may have; view 0 has fewer junctions. */
#define MOST 2000

typedef struct list {
    size_t count;
    double match[MOST][NUMBERS];
} list;

/* ---- results ---- */

typedef struct view {
    uint8_t *pixels;
    asj_image image;
    asj_junction *junctions;
    size_t count;
} view;

static int copy_truth(const synth_truth *truth, view *v)
{
    v->junctions = calloc((size_t)truth->count + 1, sizeof *v->junctions);
    for (int32_t i = 0; v->junctions && i < truth->count; i++) {
        const synth_true_junction *from = &truth->junctions[i];
        asj_junction *to = &v->junctions[v->count++];
        to->x = (float)from->x;
        to->y = (float)from->y;
        for (int32_t b = 0; b < from->branch_count && b < ASJ_MAX_BRANCHES; b++) {
            to->branches[b].angle = (float)from->branches[b].angle;
            to->branches[b].length = (float)from->branches[b].length;
            to->branch_count = b + 1;
        }
    }
    return v->junctions != NULL;
}

static int make_view(int32_t index, view *v)
{
    synth_room room;
    synth_view made;
    const synth_camera camera = synth_room_camera(index, WIDTH, HEIGHT);
    int good = synth_room_make(&room) == 0;
    memset(v, 0, sizeof *v);
    if (good && synth_view_make(&room, &camera, 4.0, &made) == 0) {
        v->pixels = synth_photograph(&made.scene, 0.9, 2.0, (uint64_t)index + 1);
        v->image = (asj_image){v->pixels, ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0};
        good = copy_truth(&made.truth, v) && v->pixels;
        synth_view_free(&made);
    } else {
        good = 0;
    }
    synth_room_free(&room);
    return good;
}

static void put(const asj_junction_match *m, double n[NUMBERS])
{
    const double values[NUMBERS] = {(double)m->x1, (double)m->y1, (double)m->x2, (double)m->y2, m->affine[0], m->affine[1],
                                    m->affine[3], m->affine[4], (double)m->ax2, (double)m->ay2, (double)m->bx2,
                                    (double)m->by2, (double)m->distance, (double)m->similarity};
    memcpy(n, values, sizeof values);
}

static int match(const golden_row *row, list *found)
{
    asj_context *context = NULL;
    asj_match_options options;
    asj_match_result *result = NULL;
    view a, b;
    int good = make_view(0, &a);
    good = make_view(row->second, &b) && good && asj_match_options_preset(&options, row->preset) == ASJ_OK &&
           asj_context_create(NULL, &context) == ASJ_OK;
    if (good) {
        options.descriptor = row->descriptor;
        good = asj_match(context, &a.image, a.junctions, a.count, &b.image, b.junctions, b.count, &options, &result) == ASJ_OK &&
               result->match_count <= MOST;
    }
    found->count = 0;
    for (uint32_t i = 0; good && i < result->match_count; i++)
        put(&result->matches[i], found->match[found->count++]);
    asj_match_result_free(&result);
    asj_context_free(&context);
    free(a.pixels);
    free(a.junctions);
    free(b.pixels);
    free(b.junctions);
    if (!good)
        fprintf(stderr, "%s: cannot be made or matched\n", row->name);
    return good;
}

/* ---- files: a line for each match ---- */

static const char header[] = "x1,y1,x2,y2,h11,h12,h21,h22,ax2,ay2,bx2,by2,distance,similarity\n";

static int is_place(int number)
{
    return number <= Y2 || (number >= AX2 && number <= BY2);
}

static void print(FILE *file, const list *found)
{
    fputs(header, file);
    for (size_t i = 0; i < found->count; i++)
        for (int n = 0; n < NUMBERS; n++)
            fprintf(file, is_place(n) ? "%.3f%c" : "%.4f%c", found->match[i][n], n + 1 < NUMBERS ? ',' : '\n');
}

static FILE *open_expected(const char *folder, const golden_row *row, const char *mode)
{
    char name[1024];
    snprintf(name, sizeof name, "%s/%s.csv", folder, row->name);
    FILE *file = fopen(name, mode);
    if (!file)
        perror(name);
    return file;
}

static int read_expected(const char *folder, const golden_row *row, list *expected)
{
    char line[512];
    FILE *file = open_expected(folder, row, "r");
    int good = file && fgets(line, sizeof line, file) && strcmp(line, header) == 0;
    expected->count = 0;
    while (good && fgets(line, sizeof line, file)) {
        char *next = line;
        good = expected->count < MOST;
        for (int n = 0; n < NUMBERS && good; n++) {
            char *end;
            expected->match[expected->count][n] = strtod(next, &end);
            good = end > next && *end == (n + 1 < NUMBERS ? ',' : '\n');
            next = end + 1;
        }
        expected->count++;
    }
    if (file)
        fclose(file);
    if (!good)
        fprintf(stderr, "%s: no golden file, or a damaged one\n", row->name);
    return good;
}

/* ---- comparison ---- */

/* Largest difference in tolerances. */
static double difference(const double *a, const double *b)
{
    double worst = 0;
    for (int n = 0; n < NUMBERS; n++)
        worst = fmax(worst, fabs(a[n] - b[n]) / (is_place(n) ? place_tolerance : other_tolerance));
    return worst;
}

/* Everything in `from` has its like in `to`; prints the first that has not. */
static int all_in(const char *name, const char *direction, const list *from, const list *to)
{
    for (size_t i = 0; i < from->count; i++) {
        double least = HUGE_VAL;
        for (size_t k = 0; k < to->count; k++)
            least = fmin(least, difference(from->match[i], to->match[k]));
        if (least <= 1)
            continue;
        printf("%s: match (%.3f, %.3f) - (%.3f, %.3f) is %s; the nearest is off by %.1f tolerances\n", name, from->match[i][X1],
               from->match[i][Y1], from->match[i][X2], from->match[i][Y2], direction, least);
        return 0;
    }
    return 1;
}

static int same(const char *name, const list *found, const list *expected)
{
    if (found->count != expected->count) {
        printf("%s: %zu matches instead of %zu\n", name, found->count, expected->count);
        all_in(name, "missing", expected, found);
        return 0;
    }
    return all_in(name, "missing", expected, found) && all_in(name, "new", found, expected);
}

static list found, expected, other; /* too large for a stack */

static int compare(const char *folder)
{
    int differ = 0;
    size_t matches = 0;
    for (int i = 0; i < ROWS; i++) {
        if (!match(&rows[i], &found) || !read_expected(folder, &rows[i], &expected) || !same(rows[i].name, &found, &expected))
            differ++;
        matches += expected.count;
    }
    printf("%d pairs, %zu matches, %d pairs differ\n", ROWS, matches, differ);
    return differ || matches == 0;
}

/* What is compared with itself is the same; nothing, and everything a pixel to the right in the second image, is not. */
static int meta(const char *folder)
{
    int wrong = 0;
    for (int i = 0; i < ROWS; i++) {
        wrong += !read_expected(folder, &rows[i], &expected) || expected.count < 5;
        other = expected;
        wrong += !same(rows[i].name, &other, &expected);
        for (size_t k = 0; k < other.count; k++)
            other.match[k][X2] += 1;
        wrong += same(rows[i].name, &other, &expected);
        other.count = 0;
        wrong += same(rows[i].name, &other, &expected);
    }
    printf("meta: %d pairs, %d wrong answers\n", ROWS, wrong);
    return wrong != 0;
}

static int generate(const char *folder)
{
    for (int i = 0; i < ROWS; i++) {
        FILE *file = NULL;
        const int good = match(&rows[i], &found) && (file = open_expected(folder, &rows[i], "w")) != NULL;
        if (good)
            print(file, &found);
        if (!good || fclose(file) != 0)
            return 1;
    }
    return 0;
}

static int display(const char *name)
{
    for (int i = 0; i < ROWS; i++)
        if (strcmp(rows[i].name, name) == 0) {
            const int good = match(&rows[i], &found);
            print(stdout, &found);
            return !good;
        }
    fprintf(stderr, "no pair '%s'; there are:", name);
    for (int i = 0; i < ROWS; i++)
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
    fprintf(stderr, "usage: golden_matches compare|meta|generate FOLDER\n       golden_matches display PAIR\n");
    return 2;
}
