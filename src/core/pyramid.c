/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, image pyramids: what patches and alignments are sampled from.
 *
 * Why integers: planes and interpolation weights (8 bits) are exact, so every back end can give the same bits. What is lost:
 * places are cut to 1/256 px, 1/512 px in the mean, and values rounded to 1/128 of a grey level, in each level once. */
#include "pyramid.h"
#include "threads.h"
#include "watch.h"

#include <math.h>
#include <string.h>

#define WEIGHT_BITS 14
#define LEAST_PIXELS 32768 /* for a thread */

/* Taps of a Gaussian over 2 radius + 1 pixels that sum to 2^14 exactly: the centre takes what rounding leaves. */
static int32_t gaussian(double sigma, int32_t *taps)
{
    int32_t radius = (int32_t)ceil(3 * sigma);
    double weight[ASJ_BLUR_RADIUS + 1], sum = 0;
    for (int32_t i = 0; i <= radius; i++) {
        weight[i] = i == 0 ? 1 : exp(-0.5 * i * i / (sigma * sigma));
        sum += i == 0 ? weight[i] : 2 * weight[i];
    }
    int32_t rest = 1 << WEIGHT_BITS;
    for (int32_t i = 1; i <= radius; i++) {
        taps[i] = (int32_t)floor(weight[i] / sum * (1 << WEIGHT_BITS) + 0.5);
        rest -= 2 * taps[i];
    }
    taps[0] = rest;
    return radius;
}

void asj_blur_row(const uint16_t *const *rows, const int32_t *taps, int32_t radius, int32_t width, uint16_t *to)
{
    for (int32_t x = 0; x < width; x++) {
        int32_t sum = taps[0] * rows[0][x] + (1 << (WEIGHT_BITS - 1));
        for (int32_t i = 1; i <= radius; i++)
            sum += taps[i] * ((int32_t)rows[2 * i - 1][x] + rows[2 * i][x]);
        to[x] = (uint16_t)(sum >> WEIGHT_BITS);
    }
}

/* Along a line that has `radius` copies of its border before and after it. */
static void blur_line(const asj_pyramid_ops *ops, const uint16_t *line, int32_t width, const int32_t *taps, int32_t radius,
                      uint16_t *to)
{
    const uint16_t *rows[ASJ_BLUR_ROWS] = {line};
    for (int32_t i = 1; i <= radius; i++) {
        rows[2 * i - 1] = line - i;
        rows[2 * i] = line + i;
    }
    ops->blur_row(rows, taps, radius, width, to);
}

/* Vertically: one row of output from the rows around it. */
static void blur_column(const asj_pyramid_ops *ops, const uint16_t *plane, ptrdiff_t stride, int32_t width, int32_t height,
                        int32_t y, const int32_t *taps, int32_t radius, uint16_t *to)
{
    const uint16_t *rows[ASJ_BLUR_ROWS] = {plane + y * stride};
    for (int32_t i = 1; i <= radius; i++) {
        rows[2 * i - 1] = plane + (y - i < 0 ? 0 : y - i) * stride;
        rows[2 * i] = plane + (y + i >= height ? height - 1 : y + i) * stride;
    }
    ops->blur_row(rows, taps, radius, width, to);
}

static void copy_border(uint16_t *plane, int32_t width, int32_t height)
{
    const ptrdiff_t stride = width + 1;
    for (int32_t y = 0; y < height; y++)
        plane[y * stride + width] = plane[y * stride + width - 1];
    memcpy(plane + height * stride, plane + (height - 1) * stride, (size_t)stride * sizeof *plane);
}

typedef struct blur_job {
    const asj_pyramid_ops *ops;
    const asj_frame *frame;
    const int32_t *taps;
    int32_t radius;
    asj_scratch scratch; /* a row */
    uint16_t *across, *plane;
    asj_watch *watch;
} blur_job;

static void blur_lines(const void *data, const asj_part *part)
{
    const blur_job *j = data;
    const int32_t width = j->frame->width;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++) {
        uint16_t *line = asj_thread_scratch(&j->scratch, part) + ASJ_BLUR_RADIUS;
        memcpy(line, j->frame->gray + y * j->frame->stride, (size_t)width * sizeof *line);
        for (int32_t i = 1; i <= j->radius; i++) {
            line[-i] = line[0];
            line[width - 1 + i] = line[width - 1];
        }
        blur_line(j->ops, line, width, j->taps, j->radius, j->across + y * (width + 1));
    }
}

static void blur_columns(const void *data, const asj_part *part)
{
    const blur_job *j = data;
    const int32_t width = j->frame->width, stride = width + 1;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++)
        blur_column(j->ops, j->across, stride, width, j->frame->height, (int32_t)y, j->taps, j->radius, j->plane + y * stride);
}

/* Blurs the frame's grey plane into level 0. */
static asj_status fill_base(asj_context *context, const asj_frame *frame, double smoothing, asj_pyramid *pyramid)
{
    const int32_t width = frame->width, height = frame->height;
    const ptrdiff_t stride = width + 1;
    if (smoothing <= 0) {
        for (int32_t y = 0; y < height; y++)
            memcpy(pyramid->plane[0] + y * stride, frame->gray + y * frame->stride, (size_t)width * sizeof(uint16_t));
        return ASJ_OK;
    }
    int32_t taps[ASJ_BLUR_RADIUS + 1];
    const int32_t radius = gaussian(smoothing, taps);
    const size_t padded = (size_t)width + 2 * ASJ_BLUR_RADIUS;
    uint16_t *across = asj_allocate(&context->memory, (size_t)height * (size_t)stride, sizeof *across);
    uint16_t *scratch = asj_allocate(&context->memory, (size_t)context->threads, padded * sizeof *scratch);
    if (!across || !scratch) {
        asj_release(&context->memory, across);
        asj_release(&context->memory, scratch);
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory to blur an image");
    }
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_PATCHES);
    const blur_job j = {context->ops->pyramid, frame, taps, radius, {scratch, padded}, across, pyramid->plane[0], &watch};
    const int32_t threads = asj_threads_for(context, (int64_t)width * height, LEAST_PIXELS);
    asj_parallel(context, threads, height, 0, blur_lines, &j);
    asj_parallel(context, threads, height, 0, blur_columns, &j);
    asj_release(&context->memory, across);
    asj_release(&context->memory, scratch);
    return asj_watch_end(&watch);
}

/* A level, and that above it. */
typedef struct halve_job {
    const uint16_t *from;
    uint16_t *to;
    ptrdiff_t from_stride, stride;
    int32_t width;
} halve_job;

static void halve_rows(const void *data, const asj_part *part)
{
    const halve_job *j = data;
    for (int64_t y = part->first; y < part->end; y++) {
        const uint16_t *upper = j->from + 2 * y * j->from_stride;
        asj_halve_row(upper, upper + j->from_stride, j->width, j->to + y * j->stride);
    }
}

static void halve(const asj_context *context, asj_pyramid *pyramid, int32_t level)
{
    const int32_t width = pyramid->width[level], height = pyramid->height[level];
    const halve_job j = {pyramid->plane[level - 1], pyramid->plane[level], pyramid->width[level - 1] + 1, width + 1, width};
    asj_parallel(context, asj_threads_for(context, (int64_t)width * height, LEAST_PIXELS), height, 0, halve_rows, &j);
}

asj_status asj_pyramid_allocate(asj_context *context, int32_t width, int32_t height, asj_pyramid *pyramid)
{
    memset(pyramid, 0, sizeof *pyramid);
    pyramid->ops = context->ops;
    for (int32_t l = 0; l < ASJ_PYRAMID_LEVELS && (l == 0 || (width >= 8 && height >= 8)); l++) {
        pyramid->width[l] = width;
        pyramid->height[l] = height;
        pyramid->plane[l] = asj_allocate(&context->memory, ((size_t)width + 1) * ((size_t)height + 1), sizeof(uint16_t));
        if (!pyramid->plane[l])
            return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the pyramid of an image");
        pyramid->levels = l + 1;
        width /= 2;
        height /= 2;
    }
    return ASJ_OK;
}

void asj_pyramid_complete(asj_context *context, asj_pyramid *pyramid)
{
    for (int32_t l = 0; l < pyramid->levels; l++) {
        if (l > 0)
            halve(context, pyramid, l);
        copy_border(pyramid->plane[l], pyramid->width[l], pyramid->height[l]);
    }
}

static asj_status fill(asj_context *context, const asj_frame *frame, double smoothing, asj_pyramid *pyramid)
{
    asj_status status = asj_pyramid_allocate(context, frame->width, frame->height, pyramid);
    if (status == ASJ_OK)
        status = fill_base(context, frame, smoothing, pyramid);
    if (status == ASJ_OK)
        asj_pyramid_complete(context, pyramid);
    return status;
}

asj_status asj_pyramid_create(asj_context *context, const asj_image *image, double smoothing, asj_pyramid *pyramid)
{
    asj_frame frame;
    memset(pyramid, 0, sizeof *pyramid);
    memset(&frame, 0, sizeof frame);
    asj_status status = asj_image_check(context, image);
    if (status == ASJ_OK)
        status = asj_frame_prepare_gray(context, &frame, image->width, image->height);
    if (status == ASJ_OK)
        status = asj_frame_load(context, &frame, image, ASJ_PLANE_LUMA);
    if (status == ASJ_OK)
        status = fill(context, &frame, smoothing, pyramid);
    asj_frame_free(&context->memory, &frame);
    return status;
}

asj_status asj_pyramid_create_upsampled(asj_context *context, const asj_image *image, double smoothing, asj_pyramid *pyramid)
{
    asj_frame frame;
    memset(pyramid, 0, sizeof *pyramid);
    memset(&frame, 0, sizeof frame);
    asj_status status = asj_image_check(context, image);
    if (status == ASJ_OK)
        status = asj_frame_upsample(context, &frame, image, ASJ_PLANE_LUMA);
    if (status == ASJ_OK)
        status = fill(context, &frame, smoothing, pyramid);
    asj_frame_free(&context->memory, &frame);
    return status;
}

void asj_pyramid_free(asj_memory *memory, asj_pyramid *pyramid)
{
    for (int32_t l = 0; l < ASJ_PYRAMID_LEVELS; l++)
        asj_release(memory, pyramid->plane[l]);
    memset(pyramid, 0, sizeof *pyramid);
}

/* floor(log2(sqrt(area)) + 0.3) without a logarithm: level l + 1 from area 4^(l + 0.7) on. */
int32_t asj_pyramid_level(const asj_pyramid *pyramid, double area)
{
    int32_t level = 0;
    for (double next = 2.6390158215457884; level + 1 < pyramid->levels && area >= next; next *= 4)
        level++;
    return level;
}

int32_t asj_pyramid_sample(const asj_pyramid *pyramid, int32_t level, const float *x, const float *y, int32_t count,
                           uint16_t *grey)
{
    return pyramid->ops->pyramid->sample(pyramid, level, x, y, count, grey);
}

int32_t asj_pyramid_sample_reference(const asj_pyramid *pyramid, int32_t level, const float *x, const float *y, int32_t count,
                                     uint16_t *grey)
{
    const int32_t width = pyramid->width[level], height = pyramid->height[level];
    const uint16_t *plane = pyramid->plane[level];
    const int32_t stride = width + 1;
    const float scale = 256.0f / (float)(1 << level), shift = 0.5f * scale - 128.0f;
    const float right = (float)(width - 1) * 256.0f, bottom = (float)(height - 1) * 256.0f;
    const float last_x = (float)(pyramid->width[0] - 1), last_y = (float)(pyramid->height[0] - 1);
    int32_t inside = 0;
    for (int32_t i = 0; i < count; i++) {
        inside += (x[i] >= 0) & (y[i] >= 0) & (x[i] <= last_x) & (y[i] <= last_y);
        float fx = x[i] * scale + shift, fy = y[i] * scale + shift;
        fx = fx > 0 ? fx : 0;
        fy = fy > 0 ? fy : 0;
        fx = fx < right ? fx : right;
        fy = fy < bottom ? fy : bottom;
        int32_t ix = (int32_t)fx, iy = (int32_t)fy;
        int32_t wx = ix & 255, wy = iy & 255;
        const uint16_t *p = plane + (ptrdiff_t)(iy >> 8) * stride + (ix >> 8);
        int32_t upper = (256 - wx) * p[0] + wx * p[1];
        int32_t lower = (256 - wx) * p[stride] + wx * p[stride + 1];
        grey[i] = (uint16_t)(((256 - wy) * (upper >> 1) + wy * (lower >> 1) + (1 << 14)) >> 15);
    }
    return inside;
}

const asj_pyramid_ops asj_pyramid_reference = {.blur_row = asj_blur_row, .sample = asj_pyramid_sample_reference};
