/* SPDX-License-Identifier: BSD-2-Clause */
/* Straight edges (asj_find_segments()) of rendered views of the room, whose edges are known:
 *
 *     lines [--check] [--views N] [--blur B] [--noise SD] [key=value ...]        (100, 0.9, 2; options of the detector)
 *
 * True edges: lines of the scene that are at least SHORTEST px long from end to end, with a step of at least MINIMUM_STEP grey
 * levels all along, no other one within CLEARANCE px beside them. A line found is one of such an edge when both its ends lie within
 * BESIDE px of the edge's line and no farther beyond its ends. Of the true edges: how many have one, exactly one, one from end to
 * end (both within BESIDE px), how much of the edges their longest lines cover. Of the lines found, and of the branches, without
 * joining: how many lie along a line of the scene, and how many of them belong to one true edge on average.
 * --check: exit code 1 when less is found than below. */
#define _POSIX_C_SOURCE 200809L
#include "render.h"
#include "room.h"

#include <asj/asj.h>

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SHORTEST 24.0     /* px */
#define MINIMUM_STEP 10.0 /* grey levels */
#define CLEARANCE 6.0     /* px */
#define BESIDE 3.0        /* px */
#define MOST 4000

static const double least_once = 0.83, least_along = 0.84; /* .856 and .863 of a hundred views */

typedef struct line {
    double x, y, dx, dy, length; /* px: an end, the direction, the length */
    int is_wanted;               /* long, of contrast, alone */
    int at_border;               /* the far end */
} line;

typedef struct tally {
    long wanted, has_one, has_one_only, is_whole, lines, along;
    double covered, of_wanted;
} tally;

static line line_of(double x1, double y1, double x2, double y2)
{
    const double dx = x2 - x1, dy = y2 - y1, length = hypot(dx, dy);
    return (line){x1, y1, length > 0 ? dx / length : 0, length > 0 ? dy / length : 0, length, 0, 0};
}

/* px beside the line, and along it from its first end. */
static double beside(const line *l, double x, double y)
{
    return fabs(l->dx * (y - l->y) - l->dy * (x - l->x));
}

static double along(const line *l, double x, double y)
{
    return l->dx * (x - l->x) + l->dy * (y - l->y);
}

/* Does `of` lie along l, within its ends? */
static int lies_along(const line *l, const line *of)
{
    for (int end = 0; end < 2; end++) {
        const double x = of->x + end * of->length * of->dx, y = of->y + end * of->length * of->dy;
        if (beside(l, x, y) > BESIDE || along(l, x, y) < -BESIDE || along(l, x, y) > l->length + BESIDE)
            return 0;
    }
    return 1;
}

/* Is there another branch of the junction straight behind this one? Then the line does not begin here. */
static int goes_on_behind(const synth_true_junction *j, const synth_true_branch *b)
{
    for (int32_t k = 0; k < j->branch_count; k++)
        if (synth_angle_distance(j->branches[k].angle, fmod(b->angle + 3.14159265358979, 6.28318530717959)) < 1e-6)
            return 1;
    return 0;
}

/* All lines of the scene from end to end, each once. */
static int true_lines(const synth_truth *truth, line *lines)
{
    int count = 0;
    for (int32_t i = 0; i < truth->count; i++)
        for (int32_t b = 0; b < truth->junctions[i].branch_count; b++) {
            const synth_true_junction *j = &truth->junctions[i];
            const synth_true_branch *branch = &j->branches[b];
            line l = line_of(j->x, j->y, j->x + branch->length * cos(branch->angle), j->y + branch->length * sin(branch->angle));
            int is_new = !goes_on_behind(j, branch) && count < MOST;
            for (int k = 0; k < count && is_new; k++)
                is_new = !(lies_along(&lines[k], &l) && fabs(lines[k].length - l.length) < 1 && beside(&lines[k], l.x, l.y) < 0.01);
            l.is_wanted = l.length >= SHORTEST && branch->weakest >= MINIMUM_STEP;
            l.at_border = branch->at_border;
            if (is_new)
                lines[count++] = l;
        }
    return count;
}

/* Edges beside each other cannot be told apart by BESIDE. */
static void leave_out_crowded(line *lines, int count)
{
    for (int i = 0; i < count; i++)
        for (int k = 0; k < count && lines[i].is_wanted; k++) {
            const line *l = &lines[i], *other = &lines[k];
            const double middle = along(l, other->x + other->length / 2 * other->dx, other->y + other->length / 2 * other->dy);
            const double cosine = fabs(l->dx * other->dx + l->dy * other->dy);
            if (k != i && cosine > 0.99 && middle > -other->length / 2 && middle < l->length + other->length / 2 &&
                (beside(l, other->x, other->y) < CLEARANCE ||
                 beside(l, other->x + other->length * other->dx, other->y + other->length * other->dy) < CLEARANCE))
                lines[i].is_wanted = 0;
        }
}

static int is_whole(const line *edge, const line *found)
{
    double first = along(edge, found->x, found->y), last = along(edge, found->x + found->length * found->dx,
                                                                 found->y + found->length * found->dy);
    if (first > last) {
        const double other = first;
        first = last;
        last = other;
    }
    return fabs(first) < BESIDE && (fabs(last - edge->length) < BESIDE || (edge->at_border && last > edge->length - 2 * BESIDE));
}

static void judge(const line *edges, int edge_count, const line *found, long found_count, tally *sum)
{
    for (int i = 0; i < edge_count; i++) {
        long of_edge = 0;
        double longest = 0;
        int whole = 0;
        for (long k = 0; k < found_count && edges[i].is_wanted; k++)
            if (lies_along(&edges[i], &found[k])) {
                of_edge++;
                longest = fmax(longest, found[k].length);
                whole |= is_whole(&edges[i], &found[k]);
            }
        sum->wanted += edges[i].is_wanted;
        sum->has_one += of_edge > 0;
        sum->has_one_only += of_edge == 1;
        sum->is_whole += whole;
        sum->of_wanted += (double)of_edge;
        sum->covered += edges[i].is_wanted ? fmin(1, longest / edges[i].length) : 0;
    }
    for (long k = 0; k < found_count; k++) {
        int is_true = 0;
        for (int i = 0; i < edge_count && !is_true; i++)
            is_true = lies_along(&edges[i], &found[k]);
        sum->along += is_true;
    }
    sum->lines += found_count;
}

static line found[2][ASJ_MAX_BRANCHES * MOST];

/* Lines into found[0], branches into found[1]. */
static int detect(asj_context *context, const asj_detect_options *options, const asj_image *image, long counts[2])
{
    asj_detection *detection = NULL;
    asj_segment_list *list = NULL;
    counts[0] = counts[1] = 0;
    if (asj_detect(context, image, options, &detection) != ASJ_OK || detection->junction_count > MOST ||
        asj_find_segments(context, detection->junctions, detection->junction_count, detection->edges, detection->edge_count,
                          &list) != ASJ_OK) {
        asj_detection_free(&detection);
        return -1;
    }
    for (uint32_t k = 0; k < list->count; k++) {
        const asj_segment *s = &list->segments[k];
        found[0][counts[0]++] = line_of((double)s->x1, (double)s->y1, (double)s->x2, (double)s->y2);
    }
    for (uint32_t k = 0; k < detection->junction_count; k++)
        for (int32_t b = 0; b < detection->junctions[k].branch_count; b++) {
            const asj_junction *j = &detection->junctions[k];
            const double x = (double)j->x, y = (double)j->y, length = (double)j->branches[b].length;
            const double angle = (double)j->branches[b].angle;
            found[1][counts[1]++] = line_of(x, y, x + length * cos(angle), y + length * sin(angle));
        }
    asj_segment_list_free(&list);
    asj_detection_free(&detection);
    return 0;
}

static int look(asj_context *context, const asj_detect_options *options, const synth_room *room, int number, double blur,
                double noise, tally sums[2])
{
    static line edges[MOST];
    const synth_camera camera = synth_room_camera(number, 1052, 780);
    synth_view view;
    long counts[2];
    if (synth_view_make(room, &camera, 1.0, &view) != 0)
        return -1;
    uint8_t *pixels = synth_photograph(&view.scene, blur, noise, (uint64_t)number + 1);
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, camera.width, camera.height, 0, 0};
    const int result = pixels ? detect(context, options, &image, counts) : -1;
    const int edge_count = true_lines(&view.truth, edges);
    leave_out_crowded(edges, edge_count);
    for (int k = 0; k < 2 && result == 0; k++)
        judge(edges, edge_count, found[k], counts[k], &sums[k]);
    free(pixels);
    synth_view_free(&view);
    return result;
}

static void print(const char *name, const tally *t)
{
    printf("%-9s %6ld, along lines of the scene %.3f; true edges %ld: with one %.3f, with one only %.3f, whole %.3f, covered %.3f, "
           "of each that has one %.2f\n",
           name, t->lines, (double)t->along / (double)t->lines, t->wanted, (double)t->has_one / (double)t->wanted,
           (double)t->has_one_only / (double)t->wanted, (double)t->is_whole / (double)t->wanted, t->covered / (double)t->wanted,
           t->of_wanted / (double)t->has_one);
}

static int set_option(asj_detect_options *options, char *text)
{
    char message[200], *value = strchr(text, '=');
    if (!value)
        return -1;
    *value++ = '\0';
    if (asj_detect_options_set(options, text, value, message, sizeof message) == ASJ_OK)
        return 0;
    fprintf(stderr, "lines: %s\n", message);
    return -1;
}

int main(int argc, char **argv)
{
    static const struct option words[] = {
        {"check", no_argument, NULL, 'c'}, {"views", required_argument, NULL, 'v'}, {"blur", required_argument, NULL, 'b'},
        {"noise", required_argument, NULL, 'n'}, {NULL, 0, NULL, 0}};
    int check = 0, views = 100, letter, result = 0;
    double blur = 0.9, noise = 2;
    tally sums[2];
    asj_detect_options options;
    asj_context *context;
    synth_room room;
    asj_detect_options_init(&options);
    while ((letter = getopt_long(argc, argv, "", words, NULL)) != -1)
        switch (letter) {
        case 'c': check = 1; break;
        case 'v': views = (int)strtol(optarg, NULL, 10); break;
        case 'b': blur = strtod(optarg, NULL); break;
        case 'n': noise = strtod(optarg, NULL); break;
        default: return 2;
        }
    for (; optind < argc; optind++)
        if (set_option(&options, argv[optind]) != 0)
            return 2;
    memset(sums, 0, sizeof sums);
    if (asj_context_create(NULL, &context) != ASJ_OK || synth_room_make(&room) != 0)
        return 99;
    for (int k = 0; k < views && result == 0; k++)
        result = look(context, &options, &room, k, blur, noise, sums);
    synth_room_free(&room);
    asj_context_free(&context);
    if (result != 0 || sums[0].wanted == 0 || sums[0].lines == 0)
        return 99;
    print("lines", &sums[0]);
    print("branches", &sums[1]);
    const double once = (double)sums[0].has_one_only / (double)sums[0].wanted;
    return check && (once < least_once || (double)sums[0].along / (double)sums[0].lines < least_along);
}
