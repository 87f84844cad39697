/* SPDX-License-Identifier: BSD-2-Clause */
#include "small_changes.h"
#include "render.h"
#include "resample.h"

#include <math.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

const char *const change_names[CHANGES] = {"zoom 0.9", "shift 1", "shift 0.5", "blur 0.5", "noise 2", "JPEG 90", "gain 0.8"};

static double *to_samples(const uint8_t *pixels, size_t count)
{
    double *samples = malloc(count * sizeof *samples);
    for (size_t i = 0; samples && i < count; i++)
        samples[i] = pixels[i];
    return samples;
}

/* Half way between `count` samples and the ones before them, `step` apart: the cubic through four, (-1, 9, 9, -1) / 16. */
static void shift_line(double *samples, int32_t count, ptrdiff_t step)
{
    double before[2]; /* samples i - 1 and i - 2 as they were */
    before[0] = before[1] = samples[0];
    for (int32_t i = 0; i < count; i++) {
        const double here = samples[i * step], next = i + 1 < count ? samples[(i + 1) * step] : here;
        samples[i * step] = (9.0 * (before[0] + here) - before[1] - next) / 16.0;
        before[1] = before[0];
        before[0] = here;
    }
}

static void shift(double *samples, int32_t width, int32_t height)
{
    for (int32_t y = 0; y < height; y++)
        shift_line(samples + (ptrdiff_t)y * width, width, 1);
    for (int32_t x = 0; x < width; x++)
        shift_line(samples + x, height, width);
}

/* What comes in from the right and from below is the last column and row once more. */
static void shift_by_one(double *samples, int32_t width, int32_t height)
{
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++)
            samples[(ptrdiff_t)y * width + x] =
                samples[(ptrdiff_t)(y + 1 < height ? y + 1 : y) * width + (x + 1 < width ? x + 1 : x)];
}

/* ITU-T T.81, table K.1: steps of luma at quality 50, row by row; quality 90 has a fifth of them (libjpeg's rule), at least 1. */
static const uint8_t steps[64] = {16, 11, 10, 16, 24,  40,  51,  61,  12, 12, 14, 19, 26,  58,  60,  55,
                                  14, 13, 16, 24, 40,  57,  69,  56,  14, 17, 22, 29, 51,  87,  80,  62,
                                  18, 22, 37, 56, 68,  109, 103, 77,  24, 35, 55, 64, 81,  104, 113, 92,
                                  49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99};

/* What coding leaves of a block: its cosine transform (T.81, A.3.3) in whole steps. */
static void code_block(double *block)
{
    double basis[64], rows[64], sums[64];
    for (int u = 0; u < 8; u++)
        for (int x = 0; x < 8; x++)
            basis[8 * u + x] = (u ? 0.5 : sqrt(0.125)) * cos((2 * x + 1) * u * PI / 16.0);
    for (int back = 0; back < 2; back++) {
        for (int i = 0; i < 64; i++) {
            rows[i] = 0.0;
            for (int k = 0; k < 8; k++)
                rows[i] += block[i / 8 * 8 + k] * basis[back ? 8 * k + i % 8 : 8 * (i % 8) + k];
        }
        for (int i = 0; i < 64; i++) {
            sums[i] = 0.0;
            for (int k = 0; k < 8; k++)
                sums[i] += rows[8 * k + i % 8] * basis[back ? 8 * k + i / 8 : 8 * (i / 8) + k];
        }
        for (int i = 0; i < 64; i++) {
            const double step = fmax(floor((20.0 * steps[i] + 50.0) / 100.0), 1.0);
            block[i] = back ? sums[i] : step * rint(sums[i] / step);
        }
    }
}

static void compress(double *samples, int32_t width, int32_t height)
{
    for (int32_t top = 0; top < height; top += 8)
        for (int32_t left = 0; left < width; left += 8) {
            double block[64];
            for (int32_t i = 0; i < 64; i++) { /* the last pixels go on beyond the border */
                const int32_t x = left + i % 8, y = top + i / 8;
                block[i] = samples[(ptrdiff_t)(y < height ? y : height - 1) * width + (x < width ? x : width - 1)] - 128.0;
            }
            code_block(block);
            for (int32_t i = 0; i < 64; i++)
                if (left + i % 8 < width && top + i / 8 < height)
                    samples[(ptrdiff_t)(top + i / 8) * width + left + i % 8] = block[i] + 128.0;
        }
}

/* Changes that leave the size as it is. */
static int change_samples(double *samples, int32_t width, int32_t height, int change)
{
    const size_t count = (size_t)width * (size_t)height;
    switch (change) {
    case CHANGE_PIXEL: shift_by_one(samples, width, height); return 0;
    case CHANGE_SHIFT: shift(samples, width, height); return 0;
    case CHANGE_BLUR: return synth_blur(samples, width, height, 0.5);
    case CHANGE_NOISE: synth_add_noise(samples, count, 2.0, 1); return 0;
    case CHANGE_JPEG: compress(samples, width, height); return 0;
    default:
        for (size_t i = 0; i < count; i++)
            samples[i] *= 0.8;
        return 0;
    }
}

int change_image(const uint8_t *pixels, int32_t width, int32_t height, int change, changed_image *out)
{
    const size_t count = (size_t)width * (size_t)height;
    const double moved = change == CHANGE_SHIFT ? 0.5 : change == CHANGE_PIXEL ? -1.0 : 0.0;
    *out = (changed_image){NULL, width, height, {1.0, 1.0, moved, moved}};
    if (change == CHANGE_ZOOM) {
        out->width = (int32_t)floor(0.9 * width + 0.5);
        out->height = (int32_t)floor(0.9 * height + 0.5);
        out->map = correspond_scaling((double)out->width / width, (double)out->height / height);
        out->pixels = synth_resample(pixels, width, height, out->width, out->height);
        return out->pixels ? 0 : -1;
    }
    double *samples = to_samples(pixels, count);
    uint8_t *changed = malloc(count);
    if (samples && changed && change_samples(samples, width, height, change) == 0) {
        synth_to_gray8(samples, count, changed);
        out->pixels = changed;
        changed = NULL;
    }
    free(changed);
    free(samples);
    return out->pixels ? 0 : -1;
}
