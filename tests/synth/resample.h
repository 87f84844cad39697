/* SPDX-License-Identifier: BSD-2-Clause */
/* Smaller copies of an image: each new pixel is the mean over the area it covers. */
#ifndef ASJ_TESTS_SYNTH_RESAMPLE_H
#define ASJ_TESTS_SYNTH_RESAMPLE_H

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Scales width x height 8-bit pixels to new_width x new_height (neither larger than before) by exact area averages. The point
 * (x, y) goes to ((x + 0.5) new_width / width - 0.5, likewise y). Returns pixels that the caller frees with free(), or NULL. */
uint8_t *synth_resample(const uint8_t *pixels, int32_t width, int32_t height, int32_t new_width, int32_t new_height);

#ifdef __cplusplus
}
#endif
#endif
