/* SPDX-License-Identifier: BSD-2-Clause */
/* From a scene to pixels: exact area coverage, Gaussian blur, Gaussian noise, rounding. */
#ifndef ASJ_TESTS_SYNTH_RENDER_H
#define ASJ_TESTS_SYNTH_RENDER_H

#include "scene.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Renders the scene into width x height grey levels, row by row: the mean over each pixel's square. 0, or -1 when memory is
 * short, the scene has failed, or more than a few hundred fragments meet in one pixel. */
int synth_render(const synth_scene *scene, double *samples);

/* Gaussian blur in place, standard deviation `sigma` px, taps to 4 sigma, border pixels repeated. sigma 0 = nothing. 0, or -1
 * (memory). */
int synth_blur(double *samples, int32_t width, int32_t height, double sigma);

/* Adds Gaussian noise of standard deviation `sd`. */
void synth_add_noise(double *samples, size_t count, double sd, uint64_t seed);

/* Rounds half up and cuts to 0 .. 255. */
void synth_to_gray8(const double *samples, size_t count, uint8_t *pixels);

/* All of these in order. Returns width x height pixels that the caller frees with free(), or NULL. */
uint8_t *synth_photograph(const synth_scene *scene, double blur, double noise, uint64_t seed);

/* An image of noise around a mean, as synth_photograph() would make it from an empty scene. */
uint8_t *synth_noise_image(int32_t width, int32_t height, double mean, double sd, uint64_t seed);

/* FNV-1a, 64 bit: a checksum for tests. */
uint64_t synth_checksum(const void *data, size_t size);

#ifdef __cplusplus
}
#endif
#endif
