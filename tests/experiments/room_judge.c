/* SPDX-License-Identifier: BSD-2-Clause */
/* Says of points in two views of a rendered room whether they show the same thing, by the definition of room_pair.h.
 *
 *     room_judge [--room SEED] [--first N] [--second N] [--width W] [--height H] < POINTS
 *
 * The views are those that sample-room writes with the same arguments. POINTS: lines of x1 y1 x2 y2 near; for each a line with 1
 * when the surface seen within 2 px of (x1, y1) in the first view appears within `near` px of (x2, y2) in the second, else 0. */
#define _POSIX_C_SOURCE 200809L

#include "room_pair.h"

#include <getopt.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef struct settings {
    int32_t which[2], width, height;
    long seed; /* of a random room; -1: the sample room */
} settings;

static int judge(const settings *set)
{
    synth_room room;
    room_view views[2];
    double p[5];
    int fields;
    memset(views, 0, sizeof views);
    if ((set->seed < 0 ? synth_room_make(&room) : synth_room_random(&room, (uint64_t)set->seed)) != 0)
        return 1;
    for (int i = 0; i < 2; i++)
        views[i].camera = set->seed < 0 ? synth_room_camera(set->which[i], set->width, set->height)
                                        : synth_room_random_camera((uint64_t)set->seed, set->which[i], set->width, set->height);
    while ((fields = scanf("%lf %lf %lf %lf %lf", &p[0], &p[1], &p[2], &p[3], &p[4])) == 5)
        printf("%d\n", room_pair_right(&room, &views[0], &views[1], (float)p[0], (float)p[1], (float)p[2], (float)p[3], p[4]));
    synth_room_free(&room);
    return fields == EOF ? 0 : 1;
}

int main(int argc, char **argv)
{
    static const struct option longs[] = {{"room", 1, NULL, 'r'}, {"first", 1, NULL, '1'}, {"second", 1, NULL, '2'},
                                          {"width", 1, NULL, 'w'}, {"height", 1, NULL, 'h'}, {NULL, 0, NULL, 0}};
    settings set = {{0, 1}, ROOM_WIDTH, ROOM_HEIGHT, -1};
    int c;
    while ((c = getopt_long(argc, argv, "", longs, NULL)) != -1)
        switch (c) {
        case 'r': set.seed = strtol(optarg, NULL, 10); break;
        case '1': set.which[0] = (int32_t)strtol(optarg, NULL, 10); break;
        case '2': set.which[1] = (int32_t)strtol(optarg, NULL, 10); break;
        case 'w': set.width = (int32_t)strtol(optarg, NULL, 10); break;
        case 'h': set.height = (int32_t)strtol(optarg, NULL, 10); break;
        default:
            fputs("usage: room_judge [--room SEED] [--first N] [--second N] [--width W] [--height H] < POINTS\n", stderr);
            return 2;
        }
    return judge(&set);
}
