/* SPDX-License-Identifier: BSD-2-Clause */
/* Vanishing points of rendered rooms, whose three directions and focal lengths are known.
 *
 *     directions [--check] [--first N] [--last N] [--preset default|match]
 *
 * Both views of the pairs of seeds --first (0) to --last (99), with the camera given and without: how many of the three directions
 * are found, each within WITHIN degrees; how many that are told are none of them; and how far focal lengths that are found are out.
 * Of a camera that is not given nor found the direction of a point is that with the true focal length.
 * --check: exit 1 when fewer are found than below, or more are wrong. */
#define _POSIX_C_SOURCE 200809L
#include "wide_pair.h"

#include <asj/asj.h>

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define DEGREE (3.14159265358979323846 / 180.0)
#define WITHIN 2.0 /* degrees */
#define MOST 10000

static const double least_found[2] = {0.85, 0.85}, most_wrong[2] = {0.01, 0.06}; /* of --check: with a camera, without */

typedef struct tally {
    int views, told, found, wrong, focal_count;
    double focals[MOST], errors[3 * MOST]; /* relative; degrees of those that are found */
} tally;

/* The axes of the room in the coordinates of the camera: the columns of its rotation. */
static void find_axes(const synth_camera *camera, double axes[3][3])
{
    double rotation[9], translation[3];
    synth_camera straight = *camera;
    straight.yaw = straight.pitch = straight.roll = 0;
    straight.position.x += 1; /* a translation there must be */
    synth_relative_pose(&straight, camera, rotation, translation);
    for (int a = 0; a < 3; a++)
        for (int k = 0; k < 3; k++)
            axes[a][k] = rotation[3 * k + a];
}

static double degrees_between(const double a[3], const double b[3])
{
    const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    const double lengths = sqrt((a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) * (b[0] * b[0] + b[1] * b[1] + b[2] * b[2]));
    return acos(fmin(1, fabs(dot) / lengths)) / DEGREE;
}

static void direction_with(const asj_vanishing_point *point, const asj_camera *camera, double direction[3])
{
    direction[0] = (point->point[0] - camera->cx * point->point[2]) / camera->fx;
    direction[1] = (point->point[1] - camera->cy * point->point[2]) / camera->fy;
    direction[2] = point->point[2];
}

static void count(const asj_vanishing_points *points, const asj_camera *camera, double axes[3][3], tally *sum)
{
    int known[3] = {0, 0, 0};
    for (int32_t n = 0; n < points->count; n++) {
        double direction[3], off = 90;
        int axis = 0;
        if (points->focal_source == ASJ_FOCAL_UNKNOWN)
            direction_with(&points->points[n], camera, direction);
        else
            memcpy(direction, points->points[n].direction, sizeof direction);
        for (int a = 0; a < 3; a++) {
            const double from = degrees_between(direction, axes[a]);
            axis = from < off ? a : axis;
            off = fmin(off, from);
        }
        if (off < WITHIN && !known[axis])
            sum->errors[sum->found++] = off;
        else
            sum->wrong++;
        known[axis] |= off < WITHIN;
    }
    sum->told += points->count;
    if (points->focal_source == ASJ_FOCAL_FOUND)
        sum->focals[sum->focal_count++] = fabs(points->camera.fx / camera->fx - 1);
    sum->views++;
}

static int look(asj_context *context, const synth_wide_pair *pair, int which, int32_t preset, tally sums[2])
{
    const double f = pair->cameras[which].focal;
    const asj_camera camera = {f, f, 0.5 * (SYNTH_WIDE_WIDTH - 1), 0.5 * (SYNTH_WIDE_HEIGHT - 1)};
    uint8_t *pixels = synth_wide_picture(pair, which);
    const asj_image image = {pixels, ASJ_FORMAT_RGB8, SYNTH_WIDE_WIDTH, SYNTH_WIDE_HEIGHT, 0, 0};
    asj_detect_options detect_options;
    asj_vanishing_options options;
    asj_detection *found = NULL;
    double axes[3][3];
    find_axes(&pair->cameras[which], axes);
    asj_detect_options_preset(&detect_options, preset);
    asj_vanishing_options_init(&options);
    options.width = SYNTH_WIDE_WIDTH;
    options.height = SYNTH_WIDE_HEIGHT;
    int failed = !pixels || asj_detect(context, &image, &detect_options, &found) != ASJ_OK;
    for (int without = 0; without < 2 && !failed; without++) {
        asj_vanishing_points points;
        memset(&options.camera, 0, sizeof options.camera);
        if (!without)
            options.camera = camera;
        failed = asj_find_vanishing_points(context, found->junctions, found->junction_count, &options, &points) != ASJ_OK;
        if (!failed)
            count(&points, &camera, axes, &sums[without]);
    }
    asj_detection_free(&found);
    free(pixels);
    return failed;
}

static int by_size(const void *left, const void *right)
{
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static void print_part(const char *what, double *list, int count, const char *unit)
{
    qsort(list, (size_t)count, sizeof *list, by_size);
    if (count > 0)
        printf("; %s out by %.2f %s in the median, %.2f in nine of ten, %.2f at most", what, list[count / 2], unit,
               list[(int)(0.9 * count)], list[count - 1]);
}

static int report(const char *name, tally *sum, double least, double most)
{
    const double all = 3.0 * sum->views;
    for (int k = 0; k < sum->focal_count; k++)
        sum->focals[k] *= 100;
    printf("%s: %d views, directions found %d of %.0f, told and none of them %d of %d", name, sum->views, sum->found, all,
           sum->wrong, sum->told);
    print_part("found ones are", sum->errors, sum->found, "degrees");
    printf("; focal lengths found %d", sum->focal_count);
    print_part("these are", sum->focals, sum->focal_count, "%");
    puts("");
    return sum->found >= least * all && sum->wrong <= most * sum->told ? 0 : 1;
}

static int usage(void)
{
    fputs("usage: directions [--check] [--first N] [--last N] [--preset default|match]\n", stderr);
    return 2;
}

int main(int argc, char **argv)
{
    static const struct option longs[] = {
        {"check", 0, NULL, 'c'}, {"first", 1, NULL, 'f'}, {"last", 1, NULL, 'l'}, {"preset", 1, NULL, 'p'}, {NULL, 0, NULL, 0}};
    static tally sums[2];
    long first = 0, last = 99;
    int32_t preset = ASJ_PRESET_DEFAULT;
    int check = 0, failed = 0, c;
    asj_context *context;
    while ((c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case 'c': check = 1; break;
        case 'f': first = strtol(optarg, NULL, 10); break;
        case 'l': last = strtol(optarg, NULL, 10); break;
        case 'p':
            if (strcmp(optarg, "match") != 0 && strcmp(optarg, "default") != 0)
                return usage();
            preset = strcmp(optarg, "match") == 0 ? ASJ_PRESET_MATCH : ASJ_PRESET_DEFAULT;
            break;
        default: return usage();
        }
    if (asj_context_create(NULL, &context) != ASJ_OK)
        return 1;
    for (long seed = first; seed <= last && sums[0].views + 2 <= MOST && !failed; seed++) {
        synth_wide_pair pair;
        if (synth_wide_pair_make(&pair, (uint64_t)seed) != 0)
            continue; /* no such viewpoints in this room */
        for (int which = 0; which < 2 && !failed; which++)
            failed = look(context, &pair, which, preset, sums);
        synth_wide_pair_free(&pair);
    }
    if (failed)
        fprintf(stderr, "directions: %s\n", asj_context_message(context));
    asj_context_free(&context);
    if (failed)
        return 1;
    const int bad = report("with the camera", &sums[0], least_found[0], most_wrong[0]) +
                    report("without", &sums[1], least_found[1], most_wrong[1]);
    return check && bad ? 1 : 0;
}
