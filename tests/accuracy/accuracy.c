/* SPDX-License-Identifier: BSD-2-Clause */
/* How well the detector finds what is known to be there: synthetic scenes with exact truth, pictures of noise. See score.h for
 * how found and true junctions are paired, and --help for how to use it. With --check it is a test: exit code 1 when a row
 * misses its target. */
#define _POSIX_C_SOURCE 200809L

#include "render.h"
#include "room.h"
#include "scenes.h"
#include "score.h"

#include <asj/asj.h>

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PARALLELOGRAMS, CHECKERBOARD, RANDOM_TILES, BORDER, LINE_GRID, STARS, ROOM, NOISE };
enum { FORMAT_TABLE, FORMAT_CSV, FORMAT_JSON };

/* Targets: 0 = none. */
typedef struct row {
    const char *name;
    int32_t kind;
    double blur, noise, contrast;
    double recall, precision, location, angle, within, reached;
} row;

/* The targets of b1.0-n2-c60, b1.0-n10-c60 and b1.0-n2-c15 are the project's acceptance figures for the default preset, and so are
 * those of soft and weak corners (blur 1.5 and more of 15, 25 and 60, contrast 8 and 5), whose locations may be out by 0.12 of the
 * blur; easier scenes must not do worse. (Of blur 8 half was asked for; without the second choice of detect.c it is .607.) The
 * crossing rows ask that long branches pass other junctions wherever every piece of the line has contrast: random tiles may be as
 * grey as their neighbours, so they have no target. */
static const row rows[] = {
    {"b1.0-n0-c60", PARALLELOGRAMS, 1.0, 0, 60, .99, .99, .15, .2, .97, 0},
    {"b0.8-n2-c60", PARALLELOGRAMS, 0.8, 2, 60, .99, .99, .15, .2, .97, 0},
    {"b1.0-n2-c60", PARALLELOGRAMS, 1.0, 2, 60, .99, .99, .15, .2, .97, 0},
    {"b1.5-n2-c40", PARALLELOGRAMS, 1.5, 2, 40, 0, .98, 0, 0, 0, 0},
    {"b1.0-n5-c40", PARALLELOGRAMS, 1.0, 5, 40, 0, .98, 0, 0, 0, 0},
    {"b1.0-n10-c60", PARALLELOGRAMS, 1.0, 10, 60, .90, 0, 0, 0, 0, 0},
    {"b1.0-n1-c10", PARALLELOGRAMS, 1.0, 1, 10, 0, .98, 0, 0, 0, 0},
    {"b1.0-n2-c15", PARALLELOGRAMS, 1.0, 2, 15, .95, .98, 0, 0, 0, 0},
    {"b1.5-n2-c15", PARALLELOGRAMS, 1.5, 2, 15, .99, .99, 0, 0, 0, 0},
    {"b0.8-n1-c5", PARALLELOGRAMS, 0.8, 1, 5, 0, 0, 0, 0, 0, 0},
    {"b2.0-n2-c60", PARALLELOGRAMS, 2.0, 2, 60, .99, .99, .24, 0, 0, 0},
    {"b3.0-n2-c60", PARALLELOGRAMS, 3.0, 2, 60, .99, .99, .36, 0, 0, 0},
    {"b5.0-n2-c60", PARALLELOGRAMS, 5.0, 2, 60, .90, .96, .60, 0, 0, 0},
    {"b8.0-n2-c60", PARALLELOGRAMS, 8.0, 2, 60, .64, .90, .96, 0, 0, 0},
    {"b3.0-n2-c25", PARALLELOGRAMS, 3.0, 2, 25, .98, .98, .36, 0, 0, 0},
    {"b5.0-n2-c25", PARALLELOGRAMS, 5.0, 2, 25, .85, .95, .60, 0, 0, 0},
    {"weak-n2-c8", PARALLELOGRAMS, 1.0, 2, 8, .98, .98, 0, 0, 0, 0},
    {"weak-n2-c5", PARALLELOGRAMS, 1.0, 2, 5, .80, .98, 0, 0, 0, 0},
    {"checkerboard-n1", CHECKERBOARD, 1.0, 1, 100, 0, 0, 0, 0, 0, .95},
    {"checkerboard-n4", CHECKERBOARD, 1.0, 4, 100, 0, 0, 0, 0, 0, .95},
    {"random-tiles-n1", RANDOM_TILES, 1.0, 1, 0, 0, 0, 0, 0, 0, 0},
    {"random-tiles-n4", RANDOM_TILES, 1.0, 4, 0, 0, 0, 0, 0, 0, 0},
    {"t-border-n1", BORDER, 1.0, 1, 0, 0, 0, 0, 0, 0, .95},
    {"t-border-n4", BORDER, 1.0, 4, 0, 0, 0, 0, 0, 0, .95},
    {"line-grid-n1", LINE_GRID, 1.0, 1, 110, 0, 0, 0, 0, 0, .95},
    {"line-grid-n4", LINE_GRID, 1.0, 4, 110, 0, 0, 0, 0, 0, .95},
    {"stars-n2", STARS, 1.0, 2, 40, .95, .95, 0, 0, 0, 0},
    {"stars-n5", STARS, 1.0, 5, 40, 0, 0, 0, 0, 0, 0},
    {"room-n2", ROOM, 0.9, 2, 0, 0, 0, 0, 0, 0, 0},
    {"noise-sd20", NOISE, 0.0, 20, 0, 0, 0, 0, 0, 0, 0},
};

#define MAX_FILTERS 8

typedef struct settings {
    int32_t scenes, threads, format, check, misses;
    uint64_t seed;
    const char *filters[MAX_FILTERS], *save;
    int32_t filter_count;
    asj_detect_options options;
} settings;

typedef struct job {
    const settings *set;
    const row *row;
    int32_t scene;
} job;

static const char help[] =
    "usage: accuracy [--scenes N] [--row TEXT] [--preset default|paper] [--threads N] [--seed N] [--format table|csv|json]\n"
    "                [--check] [--misses] [--save DIR] [key=value ...]\n"
    "\n"
    "Measures the detector on synthetic scenes and prints a line per row. Rows are named blur-noise-contrast; --row takes those\n"
    "whose name contains TEXT, and may be repeated. key=value sets any detector option. --misses lists every missed and every\n"
    "false junction; --save writes the scenes as PGM files. --check compares with the targets and exits with 1 when one is\n"
    "missed.\n"
    "\n"
    "recall, precision   of corners, within 3 px\n"
    "loc, p90            location error in px, median and 90th percentile; /sd its median in stated uncertainties (1 = honest)\n"
    "ang, p90            branch angle error in deg, likewise\n"
    "bias, MAD, <=3      branch length: median error and its median absolute deviation in px, share within 3 px\n"
    "br, extra           true branches found; found branches that are none, per true branch\n"
    "far, full           long branches (past at least one other junction) that reach the far side within 8 px; the same for\n"
    "                    those that start at the end of their line\n"
    "junct               junctions found per scene\n";

static int fail(const char *what)
{
    fprintf(stderr, "accuracy: %s\n", what);
    return -1;
}

/* A view of the room; which one depends on the seed. Its truth takes over from the view's. */
static int make_view(uint64_t seed, synth_scene *scene, synth_truth *truth)
{
    synth_room room;
    synth_view view;
    const synth_camera camera = synth_room_camera((int32_t)(seed % 1000), 1052, 780);
    synth_scene_init(scene, 1, 1, 0.0);
    if (synth_room_make(&room) != 0)
        return -1;
    const int result = synth_view_make(&room, &camera, 1.0, &view);
    if (result == 0) {
        *scene = view.scene;
        *truth = view.truth;
        free(view.corners);
    }
    synth_room_free(&room);
    return result;
}

static int make_scene(const row *r, uint64_t seed, synth_scene *scene, synth_truth *truth)
{
    synth_point ends[2 * SYNTH_GRID_LINES];
    memset(truth, 0, sizeof *truth);
    switch (r->kind) {
    case PARALLELOGRAMS:
        synth_parallelograms(scene, r->contrast, seed);
        break;
    case CHECKERBOARD:
        synth_tiles(scene, SYNTH_CHECKERBOARD, seed);
        break;
    case RANDOM_TILES:
        synth_tiles(scene, SYNTH_RANDOM_TILES, seed);
        break;
    case BORDER:
        synth_border(scene, seed);
        break;
    case LINE_GRID:
        synth_line_grid(scene, ends, seed);
        return synth_truth_of_lines(ends, SYNTH_GRID_LINES, scene->width, scene->height, truth);
    case STARS:
        synth_random_star(scene, r->contrast, seed);
        break;
    case ROOM:
        return make_view(seed, scene, truth);
    default:
        synth_scene_init(scene, 256, 256, 128.0);
        return 0;
    }
    return synth_truth_of_scene(scene, 1.0, truth);
}

static void save_scene(const job *j, const synth_scene *scene, const uint8_t *pixels)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s-%03d.pgm", j->set->save, j->row->name, (int)j->scene);
    FILE *file = fopen(path, "wb");
    if (!file) {
        fprintf(stderr, "accuracy: cannot write %s\n", path);
        return;
    }
    fprintf(file, "P5\n%d %d\n255\n", (int)scene->width, (int)scene->height);
    fwrite(pixels, 1, (size_t)scene->width * (size_t)scene->height, file);
    fclose(file);
}

static void print_miss(void *user, const char *what, double x, double y)
{
    const job *j = user;
    printf("  %s scene %d: %s (%.2f, %.2f)\n", j->row->name, (int)j->scene, what, x, y);
}

static int run_scene(asj_context *context, job *j, score *s)
{
    synth_scene scene;
    synth_truth truth;
    asj_detection *detection = NULL;
    const uint64_t seed = j->set->seed + (uint64_t)j->scene;
    int result = make_scene(j->row, seed, &scene, &truth);
    uint8_t *pixels = result == 0 ? synth_photograph(&scene, j->row->blur, j->row->noise, seed ^ UINT64_C(0x5eed)) : NULL;
    if (!pixels) {
        result = fail("cannot render the scene");
    } else {
        const asj_image image = {pixels, ASJ_FORMAT_GRAY8, scene.width, scene.height, 0, 0};
        if (j->set->save)
            save_scene(j, &scene, pixels);
        if (asj_detect(context, &image, &j->set->options, &detection) != ASJ_OK)
            result = fail(asj_context_message(context));
        else
            result = score_add(s, &truth, detection->junctions, detection->junction_count,
                               j->set->misses ? print_miss : NULL, j);
    }
    asj_detection_free(&detection);
    free(pixels);
    synth_truth_free(&truth);
    synth_scene_free(&scene);
    return result;
}

/* ---- what is printed ---- */

enum { COLUMNS = 18 };
static const char *const column_names[COLUMNS] = {"scenes", "recall", "precision", "loc", "loc_p90", "loc/sd",
                                                  "ang", "ang_p90", "ang/sd", "bias", "MAD", "<=3",
                                                  "br", "extra", "far", "full", "junct", "corners"};

static double ratio(int64_t part, int64_t whole)
{
    return whole ? (double)part / (double)whole : NAN;
}

/* The median of |error| / sd is 1.1774 for a two-dimensional normal error whose sd per axis is right, 0.6745 for one dimension. */
static void figures(score *s, double *v)
{
    const double values[COLUMNS] = {(double)s->scenes, score_recall(s), score_precision(s), sample_quantile(&s->location, 0.5),
                                    sample_quantile(&s->location, 0.9), sample_quantile(&s->location_sds, 0.5) / 1.1774,
                                    sample_quantile(&s->angle, 0.5), sample_quantile(&s->angle, 0.9),
                                    sample_quantile(&s->angle_sds, 0.5) / 0.6745, sample_quantile(&s->length, 0.5),
                                    sample_mad(&s->length), sample_share_within(&s->length, 3.0),
                                    ratio(s->branches_paired, s->branches), ratio(s->branches_extra, s->branches),
                                    ratio(s->long_reached, s->long_branches), ratio(s->full_reached, s->full_branches),
                                    ratio(s->found, s->scenes), (double)s->expected};
    memcpy(v, values, sizeof values);
}

static void print_header(int32_t format)
{
    if (format == FORMAT_JSON)
        return;
    printf(format == FORMAT_CSV ? "row" : "%-16s", "row");
    for (int c = 0; c < COLUMNS; c++)
        printf(format == FORMAT_CSV ? ",%s" : c < 3 ? "%10s" : "%8s", column_names[c]);
    printf("\n");
}

static void print_value(int32_t format, int column, double value)
{
    const int whole = column == 0 || column == COLUMNS - 1;
    if (format == FORMAT_TABLE) {
        const int width = column < 3 ? 10 : 8;
        if (isnan(value))
            printf("%*s", width, "-");
        else
            printf("%*.*f", width, whole ? 0 : 3, value);
    } else if (format == FORMAT_CSV) {
        printf(isnan(value) ? "," : ",%.6g", value);
    } else {
        printf(", \"%s\": ", column_names[column]);
        printf(isnan(value) ? "null" : "%.6g", value);
    }
}

static void print_row(int32_t format, const char *name, const double *values)
{
    printf(format == FORMAT_JSON ? "{\"row\": \"%s\"" : format == FORMAT_CSV ? "%s" : "%-16s", name);
    for (int c = 0; c < COLUMNS; c++)
        print_value(format, c, values[c]);
    printf(format == FORMAT_JSON ? "}\n" : "\n");
    fflush(stdout);
}

/* ---- targets ---- */

static int missed(const char *row_name, const char *what, double value, double target, int at_least)
{
    if (target == 0.0 || (at_least ? value >= target : value <= target))
        return 0;
    fprintf(stderr, "accuracy: row %s: %s is %.4f, target %s %.4f\n", row_name, what, value, at_least ? ">=" : "<=", target);
    return 1;
}

static int count_misses(const row *r, const score *s, const double *v)
{
    if (r->kind == NOISE) { /* at most one junction in a thousand images */
        const int64_t allowed = s->scenes / 1000;
        if (s->found > allowed)
            fprintf(stderr, "accuracy: %ld junctions in %ld images of noise\n", (long)s->found, (long)s->scenes);
        return s->found > allowed;
    }
    return missed(r->name, "recall", v[1], r->recall, 1) + missed(r->name, "precision", v[2], r->precision, 1) +
           missed(r->name, "location median", v[3], r->location, 0) + missed(r->name, "angle median", v[6], r->angle, 0) +
           missed(r->name, "length within 3 px", v[11], r->within, 1) +
           missed(r->name, "full branches reached", v[15], r->reached, 1);
}

/* Number of targets missed, or -1 when the row could not be run. */
static int run_row(asj_context *context, const settings *set, const row *r)
{
    score s;
    int result = 0;
    double values[COLUMNS];
    score_init(&s, fmax(25.0, set->options.minimum_opening));
    s.minimum_step = r->kind == ROOM ? 10.0 : r->kind == RANDOM_TILES ? 5.0 : 0.0;
    s.clearance = r->kind == ROOM ? 8.0 : 0.0; /* rims and legs a few pixels wide cannot be told apart */
    for (int32_t i = 0; i < set->scenes && result == 0; i++) {
        job j = {set, r, i};
        result = run_scene(context, &j, &s);
    }
    if (result == 0) {
        figures(&s, values);
        print_row(set->format, r->name, values);
        result = set->check ? count_misses(r, &s, values) : 0;
    }
    score_free(&s);
    return result;
}

/* ---- command line ---- */

static int set_option(settings *set, const char *text)
{
    char key[64], message[256];
    const char *equals = strchr(text, '=');
    if (!equals || (size_t)(equals - text) >= sizeof key)
        return fail("options are given as key=value");
    memcpy(key, text, (size_t)(equals - text));
    key[equals - text] = '\0';
    if (asj_detect_options_set(&set->options, key, equals + 1, message, sizeof message) != ASJ_OK)
        return fail(message);
    return 0;
}

static int one_of(const char *text, const char *const *words)
{
    for (int i = 0; words[i]; i++)
        if (strcmp(text, words[i]) == 0)
            return i;
    fprintf(stderr, "accuracy: unknown word %s\n", text);
    return -1;
}

/* 0 to go on, 1 when help was asked for, -1 on a mistake. */
static int parse(int argc, char **argv, settings *set)
{
    static const struct option longs[] = {{"scenes", 1, NULL, 'n'}, {"row", 1, NULL, 'r'}, {"preset", 1, NULL, 'p'},
                                          {"threads", 1, NULL, 't'}, {"seed", 1, NULL, 's'}, {"format", 1, NULL, 'f'},
                                          {"check", 0, NULL, 'c'}, {"misses", 0, NULL, 'm'}, {"save", 1, NULL, 'o'},
                                          {"help", 0, NULL, 'h'}, {NULL, 0, NULL, 0}};
    static const char *const presets[] = {"default", "paper", NULL}, *const formats[] = {"table", "csv", "json", NULL};
    int c;
    while ((c = getopt_long(argc, argv, "", longs, NULL)) != -1) {
        int word = 0;
        switch (c) {
        case 'n': set->scenes = (int32_t)strtol(optarg, NULL, 10); break;
        case 'r':
            if (set->filter_count == MAX_FILTERS)
                return fail("too many --row");
            set->filters[set->filter_count++] = optarg;
            break;
        case 't': set->threads = (int32_t)strtol(optarg, NULL, 10); break;
        case 's': set->seed = strtoull(optarg, NULL, 10); break;
        case 'c': set->check = 1; break;
        case 'm': set->misses = 1; break;
        case 'o': set->save = optarg; break;
        case 'p':
            word = one_of(optarg, presets);
            if (word >= 0)
                asj_detect_options_preset(&set->options, word == 0 ? ASJ_PRESET_DEFAULT : ASJ_PRESET_PAPER);
            break;
        case 'f': word = set->format = one_of(optarg, formats); break;
        case 'h': fputs(help, stdout); return 1;
        default: return -1;
        }
        if (word < 0)
            return -1;
    }
    if (set->scenes < 1)
        return fail("--scenes must be at least 1");
    for (; optind < argc; optind++)
        if (set_option(set, argv[optind]) != 0)
            return -1;
    return 0;
}

static int is_wanted(const settings *set, const row *r)
{
    int wanted = set->filter_count == 0;
    for (int32_t i = 0; i < set->filter_count; i++)
        wanted |= strstr(r->name, set->filters[i]) != NULL;
    return wanted;
}

static int run_all(asj_context *context, const settings *set)
{
    int misses = 0;
    print_header(set->format);
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        if (!is_wanted(set, &rows[i]))
            continue;
        const int result = run_row(context, set, &rows[i]);
        if (result < 0)
            return 2;
        misses += result;
    }
    return misses > 0;
}

int main(int argc, char **argv)
{
    settings set;
    memset(&set, 0, sizeof set);
    set.scenes = 100;
    set.threads = 1;
    set.seed = 1;
    asj_detect_options_init(&set.options);
    const int parsed = parse(argc, argv, &set);
    if (parsed != 0)
        return parsed < 0 ? 2 : 0;
    asj_context_options how;
    asj_context *context = NULL;
    asj_context_options_init(&how);
    how.backend = ASJ_BACKEND_CPU;
    how.threads = set.threads;
    if (asj_context_create(&how, &context) != ASJ_OK) {
        fail("cannot make a context");
        return 2;
    }
    const int result = run_all(context, &set);
    asj_context_free(&context);
    return result;
}
