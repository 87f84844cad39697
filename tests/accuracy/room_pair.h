/* SPDX-License-Identifier: BSD-2-Clause */
/* Two views of a rendered room, and how many of their matches are right. */
#ifndef ASJ_TESTS_ACCURACY_ROOM_PAIR_H
#define ASJ_TESTS_ACCURACY_ROOM_PAIR_H

#include "room.h"

#include <asj/asj.h>

#define ROOM_WIDTH 1052
#define ROOM_HEIGHT 780

/* A view with its picture and the junctions that the matcher's detector options find in it. */
typedef struct room_view {
    synth_camera camera;
    uint8_t *pixels;
    asj_image image;
    asj_detection *found;
} room_view;

/* Blur 0.9 px, noise 2 grey levels. 0, or -1 with a line on standard error; free either way. */
int room_view_make(asj_context *context, const synth_room *room, synth_camera camera, uint64_t noise_seed, int32_t first_octave,
                   room_view *view);
void room_view_free(room_view *view);

/* Counts of a pair; add up over pairs. */
typedef struct room_score {
    uint32_t points, right_points;     /* matches as key points */
    uint32_t segments, right_segments; /* two of each match: both ends */
    uint32_t right_directions;         /* of as many branches */
    uint32_t lines, right_lines;       /* as asj_match_segments() merges them, ends at least `inner` */
    uint32_t joined, right_joined;     /* of these, those of one edge as one: asj_join_segment_matches() */
} room_score;

/* A point match is right when the surface seen within 2 px of its place in the first view appears within `near` px of its place in
 * the second: corners lie on borders of surfaces, and a border seen from elsewhere may hide what lies behind it, so the exact
 * place alone would judge the background. Locations: 4 px; far ends of segments: 8 px; directions of branches of matches that are
 * right: 10 degrees, of their first 20 px. 0, or -1 (memory). */
int room_pair_score(const synth_room *room, const room_view *a, const room_view *b, const asj_match_result *result, room_score *s);

/* One place of it; tests and pictures of what is wrong. */
int room_pair_right(const synth_room *room, const room_view *a, const room_view *b, float x1, float y1, float x2, float y2,
                    double near);

#endif
