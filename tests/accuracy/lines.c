/* SPDX-License-Identifier: BSD-2-Clause */
/* Straight edges (asj_find_segments()) of rendered views of the room, whose edges are known:
 *
 *     lines [--check] [--views N] [--blur B] [--noise SD] [--save FOLDER] [--judge FOLDER] [key=value ...]
 *
 * (100, 0.9, 2; options of the detector.) --save writes the views as FOLDER/0.pgm and so on; --judge also judges the line segments
 * of FOLDER/0.txt and so on, x1 y1 x2 y2 in each line, that another program has found in them.
 *
 * True edges: lines of the scene that are at least SHORTEST px long from end to end, with a step of at least MINIMUM_STEP grey
 * levels all along, no other one within CLEARANCE px beside them. A line found is true when TRUE_SHARE of it lies along lines of
 * the scene, within BESIDE px: one, or several end to end. It is one of a true edge when it is true and the part of it that lies
 * along the edge is LEAST_PART px long. Of the true edges: how many have one, exactly one, one from end to end (to BESIDE px), and
 * how much of an edge its longest one covers. Of the lines found, and of the branches, without joining: how many are true, and how
 * many of them a true edge that has any has on average.
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
#define TRUE_SHARE 0.95
#define LEAST_PART 10.0   /* px */
#define MOST 4000
#define WAYS 3            /* lines, branches, another program's */

static const double least_once = 0.93, least_true = 0.95; /* .954 and .974 of a hundred views */

typedef struct line {
    double x, y, dx, dy, length; /* px: an end, the direction, the length */
    int counts;                  /* a true edge: long, of contrast, alone; one found: true */
    int at_border;               /* the far end */
} line;

typedef struct tally {
    long wanted, has_one, has_one_only, is_whole, lines, true_ones;
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
            l.counts = l.length >= SHORTEST && branch->weakest >= MINIMUM_STEP;
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
        for (int k = 0; k < count && lines[i].counts; k++) {
            const line *l = &lines[i], *other = &lines[k];
            const double middle = along(l, other->x + other->length / 2 * other->dx, other->y + other->length / 2 * other->dy);
            const double cosine = fabs(l->dx * other->dx + l->dy * other->dy);
            if (k != i && cosine > 0.99 && middle > -other->length / 2 && middle < l->length + other->length / 2 &&
                (beside(l, other->x, other->y) < CLEARANCE ||
                 beside(l, other->x + other->length * other->dx, other->y + other->length * other->dy) < CLEARANCE))
                lines[i].counts = 0;
        }
}

/* The part of a line found that lies along an edge, px from the edge's first end. 0: none. */
static int part_along(const line *edge, const line *of, double part[2])
{
    const double cosine = edge->dx * of->dx + edge->dy * of->dy;
    const double first = along(edge, of->x, of->y), last = first + cosine * of->length;
    part[0] = fmax(fmin(first, last), 0);
    part[1] = fmin(fmax(first, last), edge->length);
    if (fabs(cosine) < 0.9 || part[1] <= part[0])
        return 0;
    for (int end = 0; end < 2; end++) {
        const double at = (part[end] - first) / cosine;
        if (beside(edge, of->x + at * of->dx, of->y + at * of->dy) > BESIDE)
            return 0;
    }
    return 1;
}

/* Does TRUE_SHARE of it lie along lines of the scene? By points a pixel apart; an end may be out by BESIDE. */
static int is_true(const line *edges, int edge_count, const line *of)
{
    static unsigned char lies[4096];
    const int points = (int)fmin(of->length, sizeof lies - 1) + 1;
    int count = 0;
    memset(lies, 0, (size_t)points);
    for (int i = 0; i < edge_count; i++) {
        double part[2];
        if (!part_along(&edges[i], of, part))
            continue;
        const double cosine = edges[i].dx * of->dx + edges[i].dy * of->dy, offset = along(&edges[i], of->x, of->y);
        const double one = (part[0] - offset) / cosine, other = (part[1] - offset) / cosine;
        for (int k = 0; k < points; k++)
            lies[k] |= k >= fmin(one, other) - BESIDE && k <= fmax(one, other) + BESIDE;
    }
    for (int k = 0; k < points; k++)
        count += lies[k];
    return count >= TRUE_SHARE * points;
}

static void judge_edge(const line *edge, const line *lines, long count, tally *sum)
{
    long of_edge = 0;
    double longest = 0;
    int whole = 0;
    for (long k = 0; k < count; k++) {
        double part[2];
        if (!lines[k].counts || !part_along(edge, &lines[k], part) || part[1] - part[0] < LEAST_PART)
            continue;
        of_edge++;
        longest = fmax(longest, part[1] - part[0]);
        whole |= part[0] < BESIDE && part[1] > edge->length - (edge->at_border ? 2 : 1) * BESIDE;
    }
    sum->wanted++;
    sum->has_one += of_edge > 0;
    sum->has_one_only += of_edge == 1;
    sum->is_whole += whole;
    sum->of_wanted += (double)of_edge;
    sum->covered += longest / edge->length;
}

static void judge(const line *edges, int edge_count, line *lines, long count, tally *sum)
{
    for (long k = 0; k < count; k++) {
        lines[k].counts = is_true(edges, edge_count, &lines[k]);
        sum->true_ones += lines[k].counts;
    }
    sum->lines += count;
    for (int i = 0; i < edge_count; i++)
        if (edges[i].counts)
            judge_edge(&edges[i], lines, count, sum);
}

typedef struct settings {
    asj_context *context;
    asj_detect_options options;
    double blur, noise;
    const char *save, *judge; /* folders; NULL = none */
} settings;

static line found[WAYS][ASJ_MAX_BRANCHES * MOST];

/* Lines into found[0], branches into found[1]. */
static int detect(asj_context *context, const asj_detect_options *options, const asj_image *image, long counts[WAYS])
{
    asj_detection *detection = NULL;
    asj_segment_list *list = NULL;
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

static int save(const char *folder, int number, const asj_image *image)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%d.pgm", folder, number);
    FILE *file = fopen(path, "wb");
    if (!file)
        return -1;
    const size_t size = (size_t)image->width * (size_t)image->height;
    fprintf(file, "P5\n%d %d\n255\n", (int)image->width, (int)image->height);
    const int written = fwrite(image->data, 1, size, file) == size;
    return fclose(file) == 0 && written ? 0 : -1;
}

/* Another program's, into found[2]. */
static int read_others(const char *folder, int number, long *count)
{
    char path[1024];
    double x1, y1, x2, y2;
    snprintf(path, sizeof path, "%s/%d.txt", folder, number);
    FILE *file = fopen(path, "r");
    if (!file)
        return -1;
    while (*count < ASJ_MAX_BRANCHES * MOST && fscanf(file, "%lf %lf %lf %lf", &x1, &y1, &x2, &y2) == 4)
        found[2][(*count)++] = line_of(x1, y1, x2, y2);
    fclose(file);
    return 0;
}

static int look(const settings *set, const synth_room *room, int number, tally sums[WAYS])
{
    static line edges[MOST];
    const synth_camera camera = synth_room_camera(number, 1052, 780);
    synth_view view;
    long counts[WAYS] = {0};
    if (synth_view_make(room, &camera, 1.0, &view) != 0)
        return -1;
    uint8_t *pixels = synth_photograph(&view.scene, set->blur, set->noise, (uint64_t)number + 1);
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, camera.width, camera.height, 0, 0};
    int result = pixels ? detect(set->context, &set->options, &image, counts) : -1;
    if (result == 0 && set->save)
        result = save(set->save, number, &image);
    if (result == 0 && set->judge)
        result = read_others(set->judge, number, &counts[2]);
    const int edge_count = true_lines(&view.truth, edges);
    leave_out_crowded(edges, edge_count);
    for (int k = 0; k < WAYS && result == 0; k++)
        judge(edges, edge_count, found[k], counts[k], &sums[k]);
    free(pixels);
    synth_view_free(&view);
    return result;
}

static void print(const char *name, const tally *t)
{
    printf("%-9s %6ld, true %.3f; true edges %ld: with one %.3f, with one only %.3f, whole %.3f, covered %.3f, "
           "of each that has one %.2f\n",
           name, t->lines, (double)t->true_ones / (double)t->lines, t->wanted, (double)t->has_one / (double)t->wanted,
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
        {"noise", required_argument, NULL, 'n'}, {"save", required_argument, NULL, 's'}, {"judge", required_argument, NULL, 'j'},
        {NULL, 0, NULL, 0}};
    settings set = {.blur = 0.9, .noise = 2};
    int check = 0, views = 100, letter, result = 0;
    tally sums[WAYS];
    synth_room room;
    asj_detect_options_init(&set.options);
    while ((letter = getopt_long(argc, argv, "", words, NULL)) != -1)
        switch (letter) {
        case 'c': check = 1; break;
        case 'v': views = (int)strtol(optarg, NULL, 10); break;
        case 'b': set.blur = strtod(optarg, NULL); break;
        case 'n': set.noise = strtod(optarg, NULL); break;
        case 's': set.save = optarg; break;
        case 'j': set.judge = optarg; break;
        default: return 2;
        }
    for (; optind < argc; optind++)
        if (set_option(&set.options, argv[optind]) != 0)
            return 2;
    memset(sums, 0, sizeof sums);
    if (asj_context_create(NULL, &set.context) != ASJ_OK || synth_room_make(&room) != 0)
        return 99;
    for (int k = 0; k < views && result == 0; k++)
        result = look(&set, &room, k, sums);
    synth_room_free(&room);
    asj_context_free(&set.context);
    if (result != 0 || sums[0].wanted == 0 || sums[0].lines == 0)
        return 99;
    print("lines", &sums[0]);
    print("branches", &sums[1]);
    if (sums[2].lines > 0)
        print("others", &sums[2]);
    const double once = (double)sums[0].has_one_only / (double)sums[0].wanted;
    return check && (once < least_once || (double)sums[0].true_ones / (double)sums[0].lines < least_true);
}
