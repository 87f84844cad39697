/* SPDX-License-Identifier: BSD-2-Clause */
/* What the unit tests share: CMocka with what it needs in front, comparisons of doubles, a counting allocator that fails on demand,
 * and working planes made from pictures. */
#ifndef ASJ_TESTS_UNIT_TEST_H
#define ASJ_TESTS_UNIT_TEST_H

#include "core/image.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "random.h"
#include "render.h"
#include "scenes.h"

#define UNIT_PI 3.14159265358979323846
#define UNIT_COUNT(array) (sizeof(array) / sizeof *(array))

/* Fails the test unless |value - expected| <= tolerance; `what` and the two numbers say where. */
void unit_near(const char *what, double at, double also_at, double value, double expected, double tolerance);

/* Difference of two angles, in [0, pi]. */
double unit_turn(double a, double b);

/* Allocator: counts, and fails at call number `fail_at` (from 1; 0 = never) and, with `for_good`, at all after it. */
typedef struct unit_counter {
    long calls, live, fail_at;
    int for_good;
} unit_counter;
void *unit_allocate(void *user, size_t size);
void unit_release(void *user, void *block);
asj_memory unit_memory(unit_counter *counter);

/* A context on the counting allocator; fails the test when there is none. unit_context_free() fails it when anything leaks. */
asj_context *unit_context(unit_counter *counter, int32_t threads);
void unit_context_free(unit_counter *counter, asj_context **context);

/* For the tear-down of a group: ends the program, failed, when anything leaks. (CMocka 1.1 prints that a group's tear-down fails,
 * but counts no failure: the program would end with 0.) */
void unit_nothing_left(const unit_counter *counter);

/* Whether the allocation that was to fail has been asked for; none is to fail any more. A test of failing allocations goes on until
 * this is 0, not until a call succeeds: what does without some memory would end it too soon. */
int unit_reached(unit_counter *counter);

/* Progress function, `user` a long that counts the questions: wherever one may be asked, with a context whose pause_ms is 0. */
int32_t unit_count_question(void *user, int32_t stage, double done);

/* From one allocation that fails to the next, in tests that take long: under sanitizers every sixth is enough. */
#ifdef ASJ_IS_SANITIZED
enum { UNIT_ALLOCATION_STEP = 6 };
#else
enum { UNIT_ALLOCATION_STEP = 1 };
#endif

/* Pixels of a scene, freed with free(); the scene is freed too. Never NULL: fails the test. */
uint8_t *unit_picture(synth_scene *scene, double blur, double noise, uint64_t seed);
asj_image unit_gray8(const uint8_t *pixels, int32_t width, int32_t height);

/* The sample room from a viewpoint (synth_room_camera()), blur 0.9, noise 2, freed with free(). Never NULL: fails the test. */
uint8_t *unit_room_picture(int32_t viewpoint, int32_t width, int32_t height);

/* Loaded and differentiated; asj_frame_free() when done. `options` NULL = the preset default. */
void unit_frame(asj_context *context, const asj_image *image, const asj_detect_options *options, asj_frame *frame);
/* The same from a scene, which is freed. */
void unit_frame_of(asj_context *context, synth_scene *scene, double blur, double noise, const asj_detect_options *options,
                   asj_frame *frame);

/* What most tests share: a context of one thread on the counting allocator, the default options, and the planes of a picture where
 * the test works on one. The functions are CMocka's set-up and tear-down of a group; the latter fails when anything
 * leaks. */
typedef struct unit_fixture {
    unit_counter counter;
    asj_context *context;
    asj_detect_options options;
    asj_frame frame;
} unit_fixture;
int unit_set_up(void **state);
int unit_set_up_threads(void **state, int32_t threads);
int unit_tear_down(void **state);
/* unit_set_up(), and the planes of a scene, which is freed. */
int unit_set_up_scene(void **state, synth_scene *scene, double blur, double noise);

/* A half plane: bright (`high`) where (x - x0) sin(angle) - (y - y0) cos(angle) < 0, so that the edge runs along `angle` and its
 * gradient points along the branch turned by +90 degrees when high < low. */
void unit_half_plane(synth_scene *scene, int32_t size, synth_point through, double angle, double low, double high);

/* Normalised gradient of a pixel, in units; zero outside. */
double unit_gx(const asj_frame *frame, int32_t x, int32_t y);
double unit_gy(const asj_frame *frame, int32_t x, int32_t y);

/* gamma(q) of algorithm section 3, with trigonometry: |g| max(|cos(phi - alpha)| - |sin(phi - alpha)|, 0), phi at right angles to
 * g. */
double unit_gamma(double gx, double gy, double alpha);

#endif
