/* SPDX-License-Identifier: BSD-2-Clause */
#include "resample.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

/* Averages `count` samples, `step` apart, into `new_count`. */
static void resample_line(const double *in, int32_t count, double *out, int32_t new_count, int32_t step)
{
    const double scale = (double)count / new_count;
    for (int32_t i = 0; i < new_count; i++) {
        const double from = i * scale, to = (i + 1) * scale;
        double sum = 0.0;
        for (int32_t k = (int32_t)from; k < count && k < to; k++)
            sum += in[(ptrdiff_t)k * step] * (fmin(to, k + 1.0) - fmax(from, k));
        out[(ptrdiff_t)i * step] = sum / scale;
    }
}

uint8_t *synth_resample(const uint8_t *pixels, int32_t width, int32_t height, int32_t new_width, int32_t new_height)
{
    if (new_width < 1 || new_height < 1 || new_width > width || new_height > height)
        return NULL;
    const size_t count = (size_t)width * (size_t)height, new_count = (size_t)new_width * (size_t)new_height;
    double *in = malloc(count * sizeof *in), *tall = malloc(count * sizeof *tall);
    uint8_t *out = malloc(new_count);
    if (in && tall && out) {
        for (size_t i = 0; i < count; i++)
            in[i] = pixels[i];
        for (int32_t y = 0; y < height; y++)
            resample_line(in + (ptrdiff_t)y * width, width, tall + (ptrdiff_t)y * width, new_width, 1);
        for (int32_t x = 0; x < new_width; x++)
            resample_line(tall + x, height, in + x, new_height, width);
        for (int32_t y = 0; y < new_height; y++)
            for (int32_t x = 0; x < new_width; x++)
                out[(size_t)y * (size_t)new_width + (size_t)x] = (uint8_t)floor(in[(ptrdiff_t)y * width + x] + 0.5);
    } else {
        free(out);
        out = NULL;
    }
    free(in);
    free(tall);
    return out;
}
