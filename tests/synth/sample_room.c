/* SPDX-License-Identifier: BSD-2-Clause */
/* Writes the sample room as seen from two viewpoints, with the truth: what the demo shows and the matcher is tried on. */
#define _POSIX_C_SOURCE 200809L

#include "render.h"
#include "room.h"

#include <asj/io.h>

#include <errno.h>
#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

typedef struct settings {
    int32_t which[2], width, height;
    long seed; /* of a random room; -1: the sample room */
    double blur, noise;
    const char *folder;
} settings;

static const char help[] =
    "usage: sample-room [--first N] [--second N] [--width W] [--height H] [--room SEED] [--blur PX] [--noise SD] FOLDER\n"
    "\n"
    "Renders a furnished room (--room: a random one) from two viewpoints (0 and 1; other numbers are other places) into FOLDER:\n"
    "1.png, 2.png         8-bit grey, 1052x780 unless asked otherwise\n"
    "1.csv, 2.csv         true junctions: junction,x,y,corner,branch,angle,length,contrast (angle in rad; corner 0 = one thing\n"
    "                     hides another there)\n"
    "correspondences.csv  junctions of 1.csv and 2.csv that are the same point of the room: first,second\n"
    "truth.json           the fundamental matrix: F with x2' F x1 = 0\n";

static int fail(const char *path, const char *what)
{
    fprintf(stderr, "sample-room: %s: %s\n", path, what);
    return -1;
}

static FILE *create(const settings *set, const char *name, char *path, size_t size)
{
    snprintf(path, size, "%s/%s", set->folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        fail(path, strerror(errno));
    return file;
}

static int done(FILE *file, const char *path)
{
    const int broken = ferror(file);
    return fclose(file) != 0 || broken ? fail(path, "cannot write") : 0;
}

static int write_picture(const settings *set, const synth_view *view, int index)
{
    char path[1024], message[512];
    snprintf(path, sizeof path, "%s/%d.png", set->folder, index + 1);
    uint8_t *pixels = synth_photograph(&view->scene, set->blur, set->noise, (uint64_t)set->which[index] + 1);
    if (!pixels)
        return fail(path, "cannot render");
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, set->width, set->height, 0, 0};
    const asj_status status = asj_png_write(path, &image, message, sizeof message);
    free(pixels);
    return status == ASJ_OK ? 0 : fail(path, message);
}

static int write_truth(const settings *set, const synth_view *view, int index)
{
    char path[1024];
    FILE *file = create(set, index == 0 ? "1.csv" : "2.csv", path, sizeof path);
    if (!file)
        return -1;
    fprintf(file, "junction,x,y,corner,branch,angle,length,contrast\n");
    for (int32_t i = 0; i < view->truth.count; i++) {
        const synth_true_junction *j = &view->truth.junctions[i];
        for (int32_t k = 0; k < j->branch_count; k++)
            fprintf(file, "%d,%.4f,%.4f,%d,%d,%.6f,%.4f,%.2f\n", (int)i, j->x, j->y, (int)view->corners[i].is_corner, (int)k,
                    j->branches[k].angle, j->branches[k].length, j->branches[k].contrast);
    }
    return done(file, path);
}

static int write_correspondences(const settings *set, const synth_view views[2])
{
    char path[1024];
    const int32_t count = synth_correspondences(&views[0], &views[1], NULL, 0);
    synth_correspondence *pairs = malloc(((size_t)count + 1) * sizeof *pairs);
    FILE *file = pairs ? create(set, "correspondences.csv", path, sizeof path) : NULL;
    if (!file) {
        free(pairs);
        return -1;
    }
    synth_correspondences(&views[0], &views[1], pairs, count);
    fprintf(file, "first,second\n");
    for (int32_t i = 0; i < count; i++)
        fprintf(file, "%d,%d\n", (int)pairs[i].first, (int)pairs[i].second);
    free(pairs);
    return done(file, path);
}

static int write_geometry(const settings *set, const synth_view views[2])
{
    char path[1024];
    double f[9];
    FILE *file = create(set, "truth.json", path, sizeof path);
    if (!file)
        return -1;
    synth_fundamental(&views[0].camera, &views[1].camera, f);
    fprintf(file, "{\"name\": \"room\", \"group\": \"rooms\", \"kind\": \"fundamental\", \"note\": \"rendered\", \"H\": null,\n"
                  " \"F\": [[%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g], [%.17g, %.17g, %.17g]],\n"
                  " \"wref\": null, \"lines\": null}\n", f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7], f[8]);
    return done(file, path);
}

static int write_all(const settings *set)
{
    synth_room room;
    synth_view views[2];
    if ((set->seed < 0 ? synth_room_make(&room) : synth_room_random(&room, (uint64_t)set->seed)) != 0)
        return fail(set->folder, "out of memory");
    int result = 0, made = 0;
    for (int i = 0; i < 2 && result == 0; i++) {
        const synth_camera camera = set->seed < 0
            ? synth_room_camera(set->which[i], set->width, set->height)
            : synth_room_random_camera((uint64_t)set->seed, set->which[i], set->width, set->height);
        result = synth_view_make(&room, &camera, 1.0, &views[i]);
        made += result == 0;
        if (result == 0)
            result = write_picture(set, &views[i], i);
        if (result == 0)
            result = write_truth(set, &views[i], i);
    }
    if (result == 0)
        result = write_correspondences(set, views);
    if (result == 0)
        result = write_geometry(set, views);
    for (int i = 0; i < made; i++)
        synth_view_free(&views[i]);
    synth_room_free(&room);
    return result;
}

static int parse(int argc, char **argv, settings *set)
{
    static const struct option longs[] = {{"first", 1, NULL, '1'}, {"second", 1, NULL, '2'}, {"width", 1, NULL, 'w'},
                                          {"height", 1, NULL, 'h'}, {"room", 1, NULL, 'r'}, {"blur", 1, NULL, 'b'},
                                          {"noise", 1, NULL, 'n'}, {NULL, 0, NULL, 0}};
    int c;
    while ((c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case '1': set->which[0] = (int32_t)strtol(optarg, NULL, 10); break;
        case '2': set->which[1] = (int32_t)strtol(optarg, NULL, 10); break;
        case 'w': set->width = (int32_t)strtol(optarg, NULL, 10); break;
        case 'h': set->height = (int32_t)strtol(optarg, NULL, 10); break;
        case 'r': set->seed = strtol(optarg, NULL, 10); break;
        case 'b': set->blur = strtod(optarg, NULL); break;
        case 'n': set->noise = strtod(optarg, NULL); break;
        default: return -1;
        }
    set->folder = argv[optind];
    return optind + 1 == argc && set->width >= 16 && set->height >= 16 && set->width <= 20000 && set->height <= 20000 ? 0 : -1;
}

int main(int argc, char **argv)
{
    settings set = {{0, 1}, 1052, 780, -1, 0.9, 2.0, NULL};
    if (parse(argc, argv, &set) != 0) {
        fputs(help, stderr);
        return 2;
    }
    if (mkdir(set.folder, 0777) != 0 && errno != EEXIST) {
        fail(set.folder, strerror(errno));
        return 1;
    }
    return write_all(&set) == 0 ? 0 : 1;
}
