/* SPDX-License-Identifier: BSD-2-Clause */
/* The matcher on views of the sample room, whose geometry is known: how many of its key-point matches show the same point.
 *
 *     match_room [--check] [--first N] [--last N] [--threads N] [key=value ...]
 *
 * View 0 is matched with the views from --first (1) to --last (6). A match is right when the surface seen within 2 px of its place
 * in the first view appears within 4 px of its place in the second: corners lie on borders of surfaces, and a border seen from
 * elsewhere may hide what lies behind it, so the exact place alone would judge the background. --check: exit 1 when the average
 * over the pairs or a pair's matches are below what stands below; the aim is an average of 95 %. key=value sets an option of the
 * matcher. */
#define _POSIX_C_SOURCE 200809L

#include "render.h"
#include "room.h"

#include <asj/asj.h>

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define WIDTH 1052
#define HEIGHT 780
#define VIEWS 24
#define AROUND 2.0  /* px */
#define NEAR 4.0    /* px */

static const double least_average = 0.86; /* share of right matches: measured 0.90 */
static const uint32_t least_matches = 130; /* of each pair: measured 168 and more */

typedef struct settings {
    int32_t first, last, check;
    asj_match_options options;
    asj_context *context;
} settings;

typedef struct seen {
    synth_camera camera;
    uint8_t *pixels;
    asj_image image;
    asj_detection *found;
} seen;

static int fail(const char *what)
{
    fprintf(stderr, "match_room: %s\n", what);
    return -1;
}

static int look(const settings *set, const synth_room *room, int32_t index, seen *s)
{
    synth_view view;
    asj_detect_options options;
    memset(s, 0, sizeof *s);
    s->camera = synth_room_camera(index, WIDTH, HEIGHT);
    if (synth_view_make(room, &s->camera, 1.0, &view) != 0)
        return fail("cannot make a view");
    s->pixels = synth_photograph(&view.scene, 0.9, 2.0, (uint64_t)index + 1);
    synth_view_free(&view);
    if (!s->pixels)
        return fail("cannot render a view");
    s->image = (asj_image){s->pixels, ASJ_FORMAT_GRAY8, WIDTH, HEIGHT, 0, 0};
    asj_detect_options_init(&options);
    asj_match_detect_options(&options);
    return asj_detect(set->context, &s->image, &options, &s->found) == ASJ_OK ? 0 : fail(asj_context_message(set->context));
}

static void forget(seen *s)
{
    asj_detection_free(&s->found);
    free(s->pixels);
}

static int right(const synth_room *room, const seen *a, const seen *b, const asj_junction_match *m)
{
    for (int32_t j = -2; j <= 2; j++)
        for (int32_t i = -2; i <= 2; i++) {
            synth_point p;
            const double x = (double)m->x1 + i * AROUND / 2, y = (double)m->y1 + j * AROUND / 2;
            if (i * i + j * j > 4 || !synth_room_transfer(room, &a->camera, x, y, &b->camera, &p))
                continue;
            const double dx = p.x - (double)m->x2, dy = p.y - (double)m->y2;
            if (dx * dx + dy * dy <= NEAR * NEAR)
                return 1;
        }
    return 0;
}

/* Adds the pair's share to `sum`. */
static int match_pair(const settings *set, const synth_room *room, const seen *a, const seen *b, int32_t index, double *sum)
{
    asj_match_result *result = NULL;
    uint32_t good = 0;
    if (asj_match(set->context, &a->image, a->found->junctions, a->found->junction_count, &b->image, b->found->junctions,
                  b->found->junction_count, &set->options, &result) != ASJ_OK)
        return fail(asj_context_message(set->context));
    const uint32_t count = result->match_count;
    for (uint32_t k = 0; k < count; k++)
        good += (uint32_t)right(room, a, b, &result->matches[k]);
    asj_match_result_free(&result);
    const double share = count ? (double)good / count : 0;
    printf("0-%-3d %4u / %4u  %5.1f %%\n", (int)index, (unsigned)good, (unsigned)count, 100 * share);
    fflush(stdout);
    *sum += share;
    return set->check && count < least_matches ? fail("too few matches") : 0;
}

static int run(const settings *set)
{
    synth_room room;
    seen a, b;
    double sum = 0;
    if (synth_room_make(&room) != 0)
        return fail("no room");
    int result = look(set, &room, 0, &a);
    printf("pair  right / matches (%d x %d)\n", WIDTH, HEIGHT);
    for (int32_t v = set->first; v <= set->last && result == 0; v++) {
        result = look(set, &room, v, &b);
        if (result == 0)
            result = match_pair(set, &room, &a, &b, v, &sum);
        forget(&b);
    }
    forget(&a);
    synth_room_free(&room);
    const double average = sum / (set->last - set->first + 1);
    if (result == 0)
        printf("average %.1f %%\n", 100 * average);
    return result == 0 && set->check && !(average >= least_average) ? fail("the average is too low") : result;
}

static int number(const char *text, long lowest, long highest, int32_t *value)
{
    char *end;
    const long n = strtol(text, &end, 10);
    *value = (int32_t)n;
    return *text && !*end && n >= lowest && n <= highest ? 0 : -1;
}

static int set_option(settings *set, const char *text)
{
    char key[64], message[256];
    const char *equals = strchr(text, '=');
    if (!equals || (size_t)(equals - text) >= sizeof key)
        return -1;
    memcpy(key, text, (size_t)(equals - text));
    key[equals - text] = 0;
    if (asj_match_options_set(&set->options, key, equals + 1, message, sizeof message) == ASJ_OK)
        return 0;
    return fail(message);
}

static int parse(int argc, char **argv, settings *set, int32_t *threads)
{
    static const struct option longs[] = {{"check", 0, NULL, 'c'}, {"first", 1, NULL, 'f'}, {"last", 1, NULL, 'l'},
                                          {"threads", 1, NULL, 't'}, {NULL, 0, NULL, 0}};
    int c, result = 0;
    while (result == 0 && (c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case 'c': set->check = 1; break;
        case 'f': result = number(optarg, 1, VIEWS, &set->first); break;
        case 'l': result = number(optarg, 1, VIEWS, &set->last); break;
        case 't': result = number(optarg, 0, 256, threads); break;
        default: result = -1;
        }
    for (; result == 0 && optind < argc; optind++)
        result = set_option(set, argv[optind]);
    return set->first <= set->last ? result : -1;
}

int main(int argc, char **argv)
{
    settings set = {.first = 1, .last = 6};
    asj_context_options how;
    asj_match_options_init(&set.options);
    asj_context_options_init(&how);
    if (parse(argc, argv, &set, &how.threads) != 0) {
        fputs("usage: match_room [--check] [--first N] [--last N] [--threads N] [key=value ...]\n", stderr);
        return 2;
    }
    if (asj_context_create(&how, &set.context) != ASJ_OK)
        return fail("no context") != 0;
    const int result = run(&set);
    asj_context_free(&set.context);
    return result == 0 ? 0 : 1;
}
