/* SPDX-License-Identifier: BSD-2-Clause */
/* Golden matches: two rendered views of the sample room and their true junctions, so that a change of the detector does not show
 * here. In the files a line for each match. */
#include "golden.h"

#include <asj/asj.h>

#include "render.h"
#include "room.h"

#include <stdlib.h>
#include <string.h>

#define WIDTH 480
#define HEIGHT 356

typedef struct pair_row {
    const char *name;
    int32_t preset, descriptor, second; /* view 0 with this one */
} pair_row;

static const pair_row rows[] = {
    {"room-matches", ASJ_PRESET_DEFAULT, ASJ_DESCRIPTOR_RAW, 1},
    {"room-matches-near", ASJ_PRESET_DEFAULT, ASJ_DESCRIPTOR_RAW, 3},
    {"room-matches-sift", ASJ_PRESET_DEFAULT, ASJ_DESCRIPTOR_SIFT, 1},
    {"room-matches-paper", ASJ_PRESET_PAPER, ASJ_DESCRIPTOR_RAW, 1},
};
enum { ROWS = sizeof rows / sizeof rows[0] };

enum { X1, Y1, X2, Y2, H11, H12, H21, H22, AX2, AY2, BX2, BY2, DISTANCE, SIMILARITY, NUMBERS };

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

static int is_place(size_t number)
{
    return number <= Y2 || (number >= AX2 && number <= BY2);
}

/* px; and for the linear part, distance and correlation. */
static golden_column column(size_t index)
{
    static const char *const names[NUMBERS] = {"x1", "y1", "x2", "y2", "h11", "h12", "h21", "h22", "ax2", "ay2", "bx2", "by2",
                                               "distance", "similarity"};
    return (golden_column){names[index], is_place(index) ? 0.02 : 0.002, 0};
}

static int put(const asj_junction_match *m, golden_list *found)
{
    const double values[NUMBERS] = {(double)m->x1, (double)m->y1, (double)m->x2, (double)m->y2, m->affine[0], m->affine[1],
                                    m->affine[3], m->affine[4], (double)m->ax2, (double)m->ay2, (double)m->bx2,
                                    (double)m->by2, (double)m->distance, (double)m->similarity};
    double *n = golden_add(found);
    if (n)
        memcpy(n, values, sizeof values);
    return n != NULL;
}

static int match(size_t index, golden_list *found)
{
    const pair_row *row = &rows[index];
    asj_context *context = NULL;
    asj_match_options options;
    asj_match_result *result = NULL;
    view a, b;
    int good = make_view(0, &a);
    good = make_view(row->second, &b) && good && asj_match_options_preset(&options, row->preset) == ASJ_OK &&
           asj_context_create(NULL, &context) == ASJ_OK;
    if (good) {
        options.descriptor = row->descriptor;
        good = asj_match(context, &a.image, a.junctions, a.count, &b.image, b.junctions, b.count, &options, &result) == ASJ_OK;
    }
    for (uint32_t i = 0; good && i < result->match_count; i++)
        good = put(&result->matches[i], found);
    asj_match_result_free(&result);
    asj_context_free(&context);
    free(a.pixels);
    free(a.junctions);
    free(b.pixels);
    free(b.junctions);
    return good;
}

static const char header[] = "x1,y1,x2,y2,h11,h12,h21,h22,ax2,ay2,bx2,by2,distance,similarity\n";

static void print(FILE *file, const golden_list *found)
{
    fputs(header, file);
    for (size_t i = 0; i < found->count; i++)
        for (size_t n = 0; n < NUMBERS; n++)
            fprintf(file, is_place(n) ? "%.3f%c" : "%.4f%c", found->numbers[i * NUMBERS + n], n + 1 < NUMBERS ? ',' : '\n');
}

static int read_lines(FILE *file, golden_list *expected)
{
    char line[512];
    int good = fgets(line, sizeof line, file) && strcmp(line, header) == 0;
    while (good && fgets(line, sizeof line, file)) {
        char *next = line;
        double *numbers = golden_add(expected);
        good = numbers != NULL;
        for (size_t n = 0; n < NUMBERS && good; n++) {
            char *end;
            numbers[n] = strtod(next, &end);
            good = end > next && *end == (n + 1 < NUMBERS ? ',' : '\n');
            next = end + 1;
        }
    }
    return good;
}

static const char *name_of(size_t index)
{
    return rows[index].name;
}

const golden_kind golden_matches = {"matches", "pair", NUMBERS, column, X2, ROWS, name_of, match, print, read_lines};
