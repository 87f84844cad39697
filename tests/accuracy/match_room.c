/* SPDX-License-Identifier: BSD-2-Clause */
/* The matcher on rendered rooms, whose geometry is known: how many of its key-point and segment matches show the same thing,
 * and how many of the branches of its right key points point the same way.
 *
 *     match_room [--check] [--first N] [--last N] [--rooms] [--first-octave -1] [--sweep] [--threads N] [key=value ...]
 *
 * View 0 of the sample room is matched with the views from --first (1) to --last (6). --rooms: random rooms instead, two views
 * each, seeds --first to --last. --sweep: random rooms, then again with each number among the options a fifth lower and a fifth
 * higher, others as they are. What counts as right: room_pair.h. --check (sample room): exit 1 when the average over the pairs
 * or a pair's matches are below what stands below. key=value sets an option of the matcher. */
#define _POSIX_C_SOURCE 200809L

#include "room_pair.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define MOST 100000

static const double least_average = 0.92; /* share of right matches: measured 0.949 */
static const uint32_t least_matches = 130; /* of each pair: measured 148 and more */

typedef struct settings {
    int32_t first, last, check, random, sweep, first_octave;
    asj_match_options options;
    asj_context *context;
} settings;

static int fail(const char *what)
{
    fprintf(stderr, "match_room: %s\n", what);
    return -1;
}

static double share(uint32_t right, uint32_t all)
{
    return all ? 100.0 * right / all : 0;
}

static void print(const char *name, const room_score *s)
{
    printf("%-24s %5u / %5u %5.1f %%  %5u %5.1f %%  %5u / %5u %5.1f %%  %5u / %5u %5.1f %%"
           "  %5u / %5u %5.1f %%\n", name, s->right_points, s->points,
           share(s->right_points, s->points), s->right_directions, share(s->right_directions, s->segments), s->right_segments,
           s->segments, share(s->right_segments, s->segments), s->right_lines, s->lines, share(s->right_lines, s->lines),
           s->right_joined, s->joined, share(s->right_joined, s->joined));
    fflush(stdout);
}

static void add(room_score *sum, const room_score *s)
{
    sum->points += s->points;
    sum->right_points += s->right_points;
    sum->segments += s->segments;
    sum->right_segments += s->right_segments;
    sum->right_directions += s->right_directions;
    sum->lines += s->lines;
    sum->right_lines += s->right_lines;
    sum->joined += s->joined;
    sum->right_joined += s->right_joined;
}

static int match_pair(const settings *set, const synth_room *room, const room_view *a, const room_view *b, const char *name,
                      room_score *s)
{
    asj_match_result *result = NULL;
    memset(s, 0, sizeof *s);
    if (asj_match(set->context, &a->image, a->found->junctions, a->found->junction_count, &b->image, b->found->junctions,
                  b->found->junction_count, &set->options, &result) != ASJ_OK)
        return fail(asj_context_message(set->context));
    const int failed = room_pair_score(room, a, b, result, s);
    asj_match_result_free(&result);
    print(name, s);
    return failed;
}

/* View `index` of the sample room, or of the random room with that seed. */
static int look(const settings *set, const synth_room *room, int32_t seed, int32_t index, room_view *view)
{
    const synth_camera camera = set->random ? synth_room_random_camera((uint64_t)seed, index, ROOM_WIDTH, ROOM_HEIGHT)
                                            : synth_room_camera(index, ROOM_WIDTH, ROOM_HEIGHT);
    return room_view_make(set->context, room, camera, (uint64_t)index + 1, set->first_octave, view);
}

static int sample_room(const settings *set)
{
    synth_room room;
    room_view a, b;
    room_score sum;
    double average = 0;
    memset(&sum, 0, sizeof sum);
    if (synth_room_make(&room) != 0)
        return fail("no room");
    int result = look(set, &room, 0, 0, &a);
    for (int32_t v = set->first; v <= set->last && result == 0; v++) {
        char name[16];
        room_score s;
        snprintf(name, sizeof name, "0-%d", (int)v);
        result = look(set, &room, 0, v, &b);
        if (result == 0)
            result = match_pair(set, &room, &a, &b, name, &s);
        room_view_free(&b);
        if (result == 0)
            add(&sum, &s);
        if (result == 0 && set->check && s.points < least_matches)
            result = fail("too few matches");
        average += result == 0 ? share(s.right_points, s.points) / (set->last - set->first + 1) : 0;
    }
    room_view_free(&a);
    synth_room_free(&room);
    if (result == 0) {
        print("all", &sum);
        printf("average %.1f %%\n", average);
    }
    return result == 0 && set->check && !(average >= 100 * least_average) ? fail("the average is too low") : result;
}

static int random_rooms(const settings *set)
{
    static const char *const kinds[4] = {"bare", "repeated", "furnished", "pictures"};
    room_score sums[5];
    int result = 0;
    memset(sums, 0, sizeof sums);
    for (int32_t seed = set->first; seed <= set->last && result == 0; seed++) {
        synth_room room;
        room_view a, b;
        room_score s;
        char name[16];
        snprintf(name, sizeof name, "%d", (int)seed);
        if (synth_room_random(&room, (uint64_t)seed) != 0)
            return fail("no room");
        result = look(set, &room, seed, 0, &a);
        if (result == 0) {
            result = look(set, &room, seed, 1, &b);
            if (result == 0)
                result = match_pair(set, &room, &a, &b, name, &s);
            room_view_free(&b);
        }
        room_view_free(&a);
        synth_room_free(&room);
        if (result == 0) {
            add(&sums[seed % 4], &s);
            add(&sums[4], &s);
        }
    }
    for (int k = 0; k < 4 && result == 0; k++)
        print(kinds[k], &sums[k]);
    if (result == 0)
        print("all", &sums[4]);
    return result;
}

/* ---- sensitivity ---- */

typedef struct pair {
    synth_room room;
    room_view views[2];
} pair;

static int match_all(const settings *set, const pair *pairs, int32_t count, const char *name)
{
    room_score sum;
    memset(&sum, 0, sizeof sum);
    for (int32_t k = 0; k < count; k++) {
        asj_match_result *result = NULL;
        const room_view *a = &pairs[k].views[0], *b = &pairs[k].views[1];
        if (asj_match(set->context, &a->image, a->found->junctions, a->found->junction_count, &b->image, b->found->junctions,
                      b->found->junction_count, &set->options, &result) != ASJ_OK)
            return fail(asj_context_message(set->context));
        const int failed = room_pair_score(&pairs[k].room, a, b, result, &sum);
        asj_match_result_free(&result);
        if (failed)
            return failed;
    }
    print(name, &sum);
    return 0;
}

/* The option at `scale` times its value, a whole number at least by one away. Returns 0 when that is no value that it can have. */
static int scaled(const asj_match_options *from, const asj_option_info *info, double scale, asj_match_options *to, char *name,
                  size_t size)
{
    char text[32], message[256];
    *to = *from;
    asj_match_options_get(from, info->key, text, sizeof text);
    const double value = strtod(text, NULL), whole = value * scale < value ? floor(value * scale) : ceil(value * scale);
    const int number = info->type == ASJ_OPTION_NUMBER;
    if ((!number && info->type != ASJ_OPTION_INTEGER) || value == 0)
        return 0;
    snprintf(text, sizeof text, "%.4g", number ? value * scale : whole);
    snprintf(name, size, "%s %s", info->key, text);
    return asj_match_options_set(to, info->key, text, message, sizeof message) == ASJ_OK;
}

static int sweep(const settings *set)
{
    const int32_t count = set->last - set->first + 1;
    settings changed = *set;
    pair *pairs = calloc((size_t)count, sizeof *pairs);
    int result = pairs ? 0 : fail("no memory");
    for (int32_t k = 0; k < count && result == 0; k++) {
        result = synth_room_random(&pairs[k].room, (uint64_t)(set->first + k));
        for (int32_t v = 0; v < 2 && result == 0; v++)
            result = look(set, &pairs[k].room, set->first + k, v, &pairs[k].views[v]);
    }
    if (result == 0)
        result = match_all(set, pairs, count, "as they are");
    for (size_t i = 0; i < asj_match_option_count() && result == 0; i++)
        for (int32_t up = 0; up < 2 && result == 0; up++) {
            char name[128];
            if (scaled(&set->options, asj_match_option(i), up ? 1.2 : 0.8, &changed.options, name, sizeof name))
                result = match_all(&changed, pairs, count, name);
        }
    for (int32_t k = 0; pairs && k < count; k++) {
        room_view_free(&pairs[k].views[0]);
        room_view_free(&pairs[k].views[1]);
        synth_room_free(&pairs[k].room);
    }
    free(pairs);
    return result;
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
                                          {"rooms", 0, NULL, 'r'}, {"first-octave", 1, NULL, 'o'}, {"sweep", 0, NULL, 's'},
                                          {"threads", 1, NULL, 't'}, {NULL, 0, NULL, 0}};
    int c, result = 0;
    while (result == 0 && (c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case 'c': set->check = 1; break;
        case 'f': result = number(optarg, 1, MOST, &set->first); break;
        case 'l': result = number(optarg, 1, MOST, &set->last); break;
        case 'o': set->first_octave = (int32_t)strtol(optarg, NULL, 10); break;
        case 's': set->sweep = 1; /* fall through */
        case 'r': set->random = 1; break;
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
        fputs("usage: match_room [--check] [--first N] [--last N] [--rooms] [--first-octave N] [--sweep] [--threads N] "
              "[key=value ...]\n", stderr);
        return 2;
    }
    if (asj_context_create(&how, &set.context) != ASJ_OK)
        return fail("no context") != 0;
    printf("pair                     key points             directions      segments               merged lines            joined  "
           "(right / all, %d x %d)\n", ROOM_WIDTH, ROOM_HEIGHT);
    const int result = set.sweep ? sweep(&set) : set.random ? random_rooms(&set) : sample_room(&set);
    asj_context_free(&set.context);
    return result == 0 ? 0 : 1;
}
