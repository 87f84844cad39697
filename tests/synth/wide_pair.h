/* SPDX-License-Identifier: BSD-2-Clause */
/* Rooms seen from far apart or from near each other, in colour, by two cameras that differ in exposure, white balance, shake and
 * noise. */
#ifndef ASJ_TESTS_SYNTH_WIDE_PAIR_H
#define ASJ_TESTS_SYNTH_WIDE_PAIR_H

#include "room.h"

#ifdef __cplusplus
extern "C" {
#endif

#define SYNTH_WIDE_WIDTH 640
#define SYNTH_WIDE_HEIGHT 480

/* How a camera makes a picture of what it sees. */
typedef struct synth_exposure {
    double gain;           /* of all channels, 0.7 to 1.3 */
    double white[3];       /* of red, green and blue, 0.85 to 1.15 */
    double gamma;          /* 0.85 to 1.15 */
    double blur;           /* px: standard deviation */
    double shake[2];       /* px that the picture moves while the shutter is open, at most 5 */
    double noise;          /* grey levels */
    uint64_t noise_seed;
} synth_exposure;

typedef struct synth_wide_pair {
    synth_room room;
    synth_camera cameras[2];
    synth_exposure exposures[2];
    uint64_t seed;
    double angle;          /* degrees between the directions from which the point in the middle of image 1 is seen */
    double scale;          /* distance of camera 1 from it over that of camera 2 */
    double common;         /* the smaller share of either image that the other one shows too */
    int32_t corners;       /* of surfaces that both images show: 40 at least; those of frames and panes count one by one */
    int32_t reserved;
} synth_wide_pair;

/* Pair `seed`: the random room of that seed, seen under 30 to 70 degrees, from distances whose ratio is at most 2.5. 0, or -1
 * (memory, or no such viewpoints). Seeds below SYNTH_WIDE_HELD_OUT are for tuning, the others for judging: nobody looks at them. */
#define SYNTH_WIDE_HELD_OUT 100000
int synth_wide_pair_make(synth_wide_pair *pair, uint64_t seed);
/* The same with cameras near each other, as in a video: under 1 to 15 degrees at most, small angles as often as large ones. */
int synth_near_pair_make(synth_wide_pair *pair, uint64_t seed);
/* The same with a camera that only turns. */
int synth_turned_pair_make(synth_wide_pair *pair, uint64_t seed);
void synth_wide_pair_free(synth_wide_pair *pair);

/* The picture of camera 0 or 1: RGB, 8 bits, row by row, freed with free(); NULL (memory). */
uint8_t *synth_wide_picture(const synth_wide_pair *pair, int32_t which);

#ifdef __cplusplus
}
#endif
#endif
