/* SPDX-License-Identifier: BSD-2-Clause */
/* Which step of the detector loses a junction when an image changes a little.
 *
 *     losses [--check] [--preset=match|paper] [key=value ...] [FILE.png|FOLDER ...]
 *
 * Junctions are detected in each image and in copies of it that hardly differ (small_changes.h). Those that are not found again
 * (correspond.h, by location) are followed through the dumps of the copy, in the octave that located them: the step after the last
 * one that left something within NEAR px of the place has lost it. What is near may be another junction, so the counts are right on
 * the whole and not one by one. "merge": lost when octaves become one list; "moved": something stays, 3 px and more away. Of those
 * found again that the paper's criterion does not take, what is wrong is counted. Without an image: a rendered room. --check:
 * exit 1 when fewer are found again there than stands below. */
#include "correspond.h"
#include "render.h"
#include "room.h"
#include "small_changes.h"

#include <asj/asj.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef WITH_PHOTOGRAPHS
#include "photograph.h"
#endif

#define NEAR 3.5 /* px of the octave: a junction moves, and a dump has whole pixels */
#define MOST_OCTAVES 32

static const double least_found[CHANGES] = {80, 88, 88, 86, 72, 89, 90}; /* of --check: per cent; measured 83 and more, noise 80 */

static const char *const steps[] = {"candidates", "isotropic", "opening", "guessed",  "distinct",
                                    "fitted",     "apart",     "located", "validated", "junctions"};
enum { STEPS = sizeof steps / sizeof *steps, MERGE = STEPS, MOVED, ENDS };

typedef struct points {
    int32_t *xy;
    size_t count;
} points;

/* What the detector says of one image. */
typedef struct record {
    points left[MOST_OCTAVES][STEPS];
    int octaves, failed;
} record;

typedef struct tally {
    uint32_t junctions;
    int32_t place[CHANGES], whole[CHANGES];
    int32_t lost[ENDS][CHANGES];
    int32_t fault[CORRESPOND_FAULTS][CHANGES]; /* of what is found again */
} tally;

typedef struct session {
    asj_context *context;
    asj_detect_options options;
    record seen;
    tally all;
} session;

static int fail(const char *what)
{
    fprintf(stderr, "losses: %s\n", what);
    return -1;
}

static void clear(record *r)
{
    for (int o = 0; o < r->octaves; o++)
        for (int s = 0; s < STEPS; s++)
            free(r->left[o][s].xy);
    memset(r, 0, sizeof *r);
}

static void keep(void *user, const asj_dump *dump)
{
    record *r = user;
    int step = 0;
    while (step < STEPS && strcmp(dump->name, steps[step]) != 0)
        step++;
    if (step == STEPS || dump->kind != ASJ_DUMP_POINTS || r->failed)
        return;
    r->octaves += step == 0;
    r->failed = r->octaves < 1 || r->octaves > MOST_OCTAVES;
    int32_t *xy = r->failed ? NULL : malloc((dump->count + 1) * 2 * sizeof *xy);
    r->failed |= !xy;
    if (r->failed)
        return;
    memcpy(xy, dump->data, dump->count * 2 * sizeof *xy);
    r->left[r->octaves - 1][step] = (points){xy, dump->count};
}

static int is_near(const points *p, double x, double y)
{
    for (size_t i = 0; i < p->count; i++)
        if (hypot(p->xy[2 * i] - x, p->xy[2 * i + 1] - y) < NEAR)
            return 1;
    return 0;
}

/* The last step that has left something near (x, y) of the copy in an octave, -1 = none. */
static int last_step(const session *s, double octave, double x, double y)
{
    const int index = (int)((s->options.half_octaves ? 2 : 1) * (octave - s->options.first_octave));
    const double scale = exp2(octave);
    int last = -1;
    for (int step = 0; step < STEPS && index >= 0 && index < s->seen.octaves; step++)
        if (is_near(&s->seen.left[index][step], (x + 0.5) / scale - 0.5, (y + 0.5) / scale - 0.5))
            last = step;
    return last;
}

/* Which step has lost what would be at (x, y) of the copy: half octaves come rounded away from 0. */
static int find_step(const session *s, const asj_detection *copy, int32_t octave, double x, double y)
{
    int last = last_step(s, octave, x, y);
    if (s->options.half_octaves && octave != 0) {
        const int between = last_step(s, octave < 0 ? octave + 0.5 : octave - 0.5, x, y);
        last = between > last ? between : last;
    }
    for (uint32_t i = 0; last == STEPS - 1 && i < copy->junction_count; i++)
        if (hypot((double)copy->junctions[i].x - x, (double)copy->junctions[i].y - y) < NEAR * exp2(octave) + 1)
            return MOVED;
    return last + 1;
}

static asj_detection *detect(session *s, const uint8_t *pixels, int32_t width, int32_t height)
{
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    asj_detection *found = NULL;
    clear(&s->seen);
    if (asj_detect(s->context, &image, &s->options, &found) != ASJ_OK || s->seen.failed) {
        fail(s->seen.failed ? "cannot keep the dumps" : asj_context_message(s->context));
        asj_detection_free(&found);
    }
    return found;
}

static int compare(session *s, const asj_detection *image, const asj_detection *copy, const correspond_map *map, int change)
{
    const correspond_list a = {image->junctions, image->junction_count}, b = {copy->junctions, copy->junction_count};
    uint32_t *partner = malloc((a.count + (size_t)1) * sizeof *partner);
    const int32_t place = partner ? correspond(&a, &b, map, CORRESPOND_PLACE, partner) : -1;
    const int32_t whole = correspond(&a, &b, map, CORRESPOND_WHOLE, NULL);
    for (uint32_t i = 0; place >= 0 && i < a.count; i++) {
        const asj_junction *j = &a.junctions[i];
        if (partner[i] != UINT32_MAX) {
            s->all.fault[correspond_fault(j, &b.junctions[partner[i]], 0.5 * (map->sx + map->sy))][change]++;
        } else {
            const double x = (double)j->x * map->sx + map->tx, y = (double)j->y * map->sy + map->ty;
            s->all.lost[find_step(s, copy, j->octave, x, y)][change]++;
        }
    }
    free(partner);
    s->all.place[change] += place;
    s->all.whole[change] += whole;
    return place < 0 || whole < 0 ? fail("no memory") : 0;
}

static int follow(session *s, const uint8_t *pixels, int32_t width, int32_t height)
{
    asj_detection *image = detect(s, pixels, width, height);
    int result = image ? 0 : -1;
    s->all.junctions += image ? image->junction_count : 0;
    for (int change = 0; change < CHANGES && result == 0; change++) {
        changed_image changed;
        if (change_image(pixels, width, height, change, &changed) != 0)
            result = fail("cannot change the image");
        asj_detection *copy = result == 0 ? detect(s, changed.pixels, changed.width, changed.height) : NULL;
        result = copy ? compare(s, image, copy, &changed.map, change) : -1;
        asj_detection_free(&copy);
        free(changed.pixels);
    }
    asj_detection_free(&image);
    return result;
}

static int follow_room(session *s)
{
    synth_room room;
    synth_view view;
    const synth_camera camera = synth_room_camera(0, 480, 360);
    uint8_t *pixels = NULL;
    if (synth_room_make(&room) == 0 && synth_view_make(&room, &camera, 1.0, &view) == 0) {
        pixels = synth_photograph(&view.scene, 0.9, 2.0, 1);
        synth_view_free(&view);
    }
    synth_room_free(&room);
    const int result = pixels ? follow(s, pixels, camera.width, camera.height) : fail("cannot render a room");
    free(pixels);
    return result;
}

static double share(int32_t part, uint32_t whole)
{
    return whole ? 100.0 * part / whole : 0;
}

static void print(const tally *t)
{
    printf("%-22s", "");
    for (int c = 0; c < CHANGES; c++)
        printf("%10s", change_names[c]);
    printf("\n%-22s", "found again, %");
    for (int c = 0; c < CHANGES; c++)
        printf("%10.1f", share(t->place[c], t->junctions));
    printf("\n%-22s", "paper's criterion, %");
    for (int c = 0; c < CHANGES; c++)
        printf("%10.1f", share(t->whole[c], t->junctions));
    static const char *const faults[CORRESPOND_FAULTS] = {"", "number of branches", "angles", "lengths"};
    printf("\nfound again, but for\n");
    for (int fault = 1; fault < CORRESPOND_FAULTS; fault++) {
        printf("  %-20s", faults[fault]);
        for (int c = 0; c < CHANGES; c++)
            printf("%10d", (int)t->fault[fault][c]);
        printf("\n");
    }
    printf("lost of %u by\n", (unsigned)t->junctions);
    for (int step = 0; step < ENDS; step++) {
        printf("  %-20s", step == MERGE ? "merge" : step == MOVED ? "moved" : steps[step]);
        for (int c = 0; c < CHANGES; c++)
            printf("%10d", (int)t->lost[step][c]);
        printf("\n");
    }
}

static int check(const tally *t)
{
    int result = 0;
    for (int c = 0; c < CHANGES; c++)
        if (!(share(t->place[c], t->junctions) >= least_found[c])) {
            fprintf(stderr, "losses: %s: %.1f %% found again, wanted %.0f\n", change_names[c],
                    share(t->place[c], t->junctions), least_found[c]);
            result = 1;
        }
    return result;
}

/* 0, or -1 with a line on standard error. */
static int set_option(asj_detect_options *options, const char *text)
{
    char key[64], message[256];
    const char *equals = strchr(text, '=');
    if (strcmp(text, "--preset=match") == 0)
        return asj_detect_options_preset(options, ASJ_PRESET_MATCH) == ASJ_OK ? 0 : -1;
    if (strcmp(text, "--preset=paper") == 0)
        return asj_detect_options_preset(options, ASJ_PRESET_PAPER) == ASJ_OK ? 0 : -1;
    if (!equals || (size_t)(equals - text) >= sizeof key)
        return fail("options are given as key=value");
    memcpy(key, text, (size_t)(equals - text));
    key[equals - text] = '\0';
    return asj_detect_options_set(options, key, equals + 1, message, sizeof message) == ASJ_OK ? 0 : fail(message);
}

#ifdef WITH_PHOTOGRAPHS
static int follow_photograph(session *s, const char *path)
{
    photograph p;
    if (photograph_read(path, &p) != 0)
        return -1;
    const int result = follow(s, p.pixels, p.width, p.height);
    photograph_free(&p);
    return result;
}

static int follow_all(session *s, char *const *arguments, int count)
{
    path_list list = {NULL, 0, 0};
    int result = 0;
    for (int i = 0; i < count && result == 0; i++)
        result = path_list_add(&list, arguments[i]);
    for (int32_t i = 0; i < list.count && result == 0; i++)
        result = follow_photograph(s, list.paths[i]);
    path_list_free(&list);
    return result;
}
#else
static int follow_all(session *s, char *const *arguments, int count)
{
    (void)s, (void)arguments, (void)count;
    return fail("built without image files");
}
#endif

int main(int argc, char **argv)
{
    static session s;
    asj_context_options how;
    int checks = 0, result = 0, at = 1;
    asj_context_options_init(&how);
    asj_detect_options_init(&s.options);
    how.backend = ASJ_BACKEND_CPU;
    how.dump = keep;
    how.dump_user = &s.seen;
    for (; at < argc && (strncmp(argv[at], "--", 2) == 0 || (strchr(argv[at], '=') && !strchr(argv[at], '/'))); at++)
        if (strcmp(argv[at], "--check") == 0)
            checks = 1;
        else if (set_option(&s.options, argv[at]) != 0)
            return 2;
    if (asj_context_create(&how, &s.context) != ASJ_OK)
        return 2;
    result = at < argc ? follow_all(&s, argv + at, argc - at) : follow_room(&s);
    clear(&s.seen);
    asj_context_free(&s.context);
    if (result != 0)
        return 2;
    print(&s.all);
    return checks ? check(&s.all) : 0;
}
