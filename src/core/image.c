/* SPDX-License-Identifier: BSD-2-Clause */
/* Views of every format, checked -> planes of grey levels. */
#include "image.h"
#include "number_text.h"
#include "threads.h"
#include "watch.h"
#include "shared/pixels.h"

#include <math.h>
#include <string.h>

#define LEAST_PIXELS 65536 /* for a thread: 10 to 50 us */
#define LEAST_HALVED 16384 /* of the smaller image: 20 us */

typedef struct format_info {
    float white;
    const char *name;
} format_info;

static const format_info *find_format(int32_t format)
{
    static const format_info table[] = {
        [ASJ_FORMAT_GRAY8] = {255, "gray8"}, [ASJ_FORMAT_GRAY16] = {65535, "gray16"},
        [ASJ_FORMAT_RGB8] = {255, "rgb8"},   [ASJ_FORMAT_BGR8] = {255, "bgr8"},
        [ASJ_FORMAT_RGBA8] = {255, "rgba8"}, [ASJ_FORMAT_BGRA8] = {255, "bgra8"},
        [ASJ_FORMAT_GRAY_FLOAT] = {1, "gray float"},
    };
    return format >= ASJ_FORMAT_GRAY8 && format <= ASJ_FORMAT_GRAY_FLOAT ? &table[format] : NULL;
}

asj_status asj_image_check(asj_context *context, const asj_image *image)
{
    const format_info *format = find_format(image->format);
    if (!image->data)
        return asj_fail(context, ASJ_ERROR_IMAGE, "the image has no data");
    if (!format)
        return asj_fail(context, ASJ_ERROR_IMAGE, "image format %d is unknown", (int)image->format);
    if (image->width < 1 || image->height < 1)
        return asj_fail(context, ASJ_ERROR_IMAGE, "an image of %d x %d pixels is empty", (int)image->width, (int)image->height);
    if (image->width > ASJ_MAX_SIDE || image->height > ASJ_MAX_SIDE ||
        (int64_t)image->width * image->height > ASJ_MAX_PIXELS)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%d x %d pixels are more than the library takes (side %d, %d pixels in all)",
                        (int)image->width, (int)image->height, ASJ_MAX_SIDE, ASJ_MAX_PIXELS);
    ptrdiff_t row = (ptrdiff_t)image->width * asj_pixel_size(image->format);
    if (!asj_stride_holds_row(image))
        return asj_fail(context, ASJ_ERROR_IMAGE, "stride %lld is shorter than a row of %d %s pixels (%lld bytes)",
                        (long long)image->stride, (int)image->width, format->name, (long long)row);
    if (!asj_stride_fits_memory(image))
        return asj_fail(context, ASJ_ERROR_IMAGE, "%d rows with a stride of %lld are more than memory", (int)image->height,
                        (long long)image->stride);
    if (!(image->white >= 0) || isinf(image->white))
        return asj_fail(context, ASJ_ERROR_IMAGE, "white level %s is not a level", ASJ_TEXT((double)image->white));
    return ASJ_OK;
}

/* What is in it is read by nobody: planes are written before, and what is around them here and with them. */
static asj_status prepare_memory(asj_context *context, asj_frame *frame, size_t count)
{
    if (frame->capacity >= count)
        return ASJ_OK;
    asj_release(&context->memory, frame->memory);
    frame->capacity = 0;
    frame->memory = asj_allocate(&context->memory, count, sizeof *frame->memory);
    if (!frame->memory)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for planes of %zu samples", count);
    frame->capacity = count;
    return ASJ_OK;
}

/* Zeros around a plane of the gradient. */
static void clear_margins(const asj_frame *frame, int16_t *rows)
{
    const size_t stride = (size_t)frame->stride, width = (size_t)frame->width, height = (size_t)frame->height;
    int16_t *row = rows + ASJ_MARGIN * stride + ASJ_MARGIN;
    memset(rows, 0, (ASJ_MARGIN * stride + ASJ_MARGIN) * sizeof *rows);
    for (size_t y = 0; y < height; y++, row += stride) /* what is right of a row, and left of the next one */
        memset(row + width, 0, (stride - width) * sizeof *row);
    memset(row, 0, (ASJ_MARGIN * stride - ASJ_MARGIN) * sizeof *row);
}

/* Everything but the memory. Returns how many elements of it that takes. */
static size_t set_size(asj_frame *frame, int32_t width, int32_t height)
{
    frame->width = width;
    frame->height = height;
    frame->octave = 0;
    frame->octaves = 1;
    frame->blocks = (width + ASJ_LANES - 1) / ASJ_LANES;
    frame->stride = (ptrdiff_t)frame->blocks * ASJ_LANES + 2 * ASJ_MARGIN;
    const size_t stride = (size_t)frame->stride;
    return 2 * stride * ((size_t)height + 2 * ASJ_MARGIN) + stride * ((size_t)height + 2 * ASJ_GRAY_BORDER) + 2 * ASJ_GRAY_MARGIN;
}

size_t asj_frame_bytes(int32_t width, int32_t height)
{
    asj_frame frame;
    return set_size(&frame, width, height) * sizeof *frame.memory;
}

/* Gray levels stand last: asj_frame_halve() reads those of the larger image when the planes of the smaller one have been set up. */
static void set_planes(asj_frame *frame)
{
    const size_t stride = (size_t)frame->stride, padded = stride * ((size_t)frame->height + 2 * ASJ_MARGIN);
    frame->gradient_x = frame->memory + ASJ_MARGIN * stride + ASJ_MARGIN;
    frame->gradient_y = frame->gradient_x + padded;
    frame->gray = (uint16_t *)frame->memory + 2 * padded + ASJ_GRAY_MARGIN + ASJ_GRAY_BORDER * stride;
}

asj_status asj_frame_prepare_gray(asj_context *context, asj_frame *frame, int32_t width, int32_t height)
{
    const size_t count = set_size(frame, width, height);
    const asj_status status = prepare_memory(context, frame, count);
    if (count > frame->loaded)
        frame->loaded = 0;
    if (status == ASJ_OK)
        set_planes(frame);
    return status;
}

asj_status asj_frame_prepare(asj_context *context, asj_frame *frame, int32_t width, int32_t height)
{
    const asj_status status = asj_frame_prepare_gray(context, frame, width, height);
    if (status != ASJ_OK)
        return status;
    clear_margins(frame, frame->memory);
    clear_margins(frame, frame->memory + (frame->gradient_y - frame->gradient_x));
    return ASJ_OK;
}

void asj_frame_free(asj_memory *memory, asj_frame *frame)
{
    asj_release(memory, frame->memory);
    asj_release(memory, frame->rows);
    memset(frame, 0, sizeof *frame);
}

void asj_image_luma(const uint8_t *pixel, int32_t width, int32_t step, int32_t red, uint16_t *gray)
{
    for (int32_t x = 0; x < width; x++, pixel += step)
        gray[x] = (uint16_t)(asj_luma16(pixel[red], pixel[1], pixel[2 - red]) << 7);
}

/* A level rounded and cut. With a white level next to zero the scale is infinite, and black times that is NaN: black. */
static inline uint16_t cut(float level)
{
    return !(level > 0) ? 0 : level >= ASJ_GRAY_MAX ? ASJ_GRAY_MAX : (uint16_t)(level + 0.5f);
}

/* Rows may stand at any byte (stride), so samples are copied, not read in place. */
static void load_words(uint16_t *gray, const uint8_t *bytes, int32_t width, float scale)
{
    for (int32_t x = 0; x < width; x++) {
        uint16_t sample;
        memcpy(&sample, bytes + (size_t)x * sizeof sample, sizeof sample);
        gray[x] = cut((float)sample * scale);
    }
}

/* Returns 0 when a sample is NaN or infinite. */
static int load_float(uint16_t *gray, const uint8_t *bytes, int32_t width, float scale)
{
    for (int32_t x = 0; x < width; x++) {
        float sample;
        memcpy(&sample, bytes + (size_t)x * sizeof sample, sizeof sample);
        if (!isfinite(sample))
            return 0;
        gray[x] = cut(sample * scale);
    }
    return 1;
}

/* 8-bit samples: levels from 0 to 255 are held as they are, others are looked up. */
static void load_bytes(uint16_t *gray, const uint8_t *bytes, int32_t width, const uint16_t *levels)
{
    if (levels)
        for (int32_t x = 0; x < width; x++)
            gray[x] = levels[bytes[x]];
    else
        for (int32_t x = 0; x < width; x++)
            gray[x] = (uint16_t)(bytes[x] * ASJ_GRAY_ONE);
}

/* How samples become levels. */
typedef struct conversion {
    const asj_image_ops *ops;
    int32_t plane;
    float scale;
    const uint16_t *levels; /* of 8-bit samples; NULL = level 255 is white */
    uint16_t table[256];
} conversion;

static void load_colour(const conversion *c, uint16_t *gray, const uint8_t *bytes, int32_t width, int32_t step, int32_t red)
{
    if (c->plane != ASJ_PLANE_LUMA) {
        asj_colour_row(bytes, width, step, red, c->levels, c->plane, gray);
        return;
    }
    c->ops->luma(bytes, width, step, red, gray);
    if (c->levels)
        for (int32_t x = 0; x < width; x++)
            gray[x] = c->levels[gray[x] / ASJ_GRAY_ONE];
}

static void repeat_columns(uint16_t *gray, int32_t width)
{
    for (int32_t i = 0; i < ASJ_GRAY_BORDER; i++) {
        gray[-1 - i] = gray[0];
        gray[width + i] = gray[width - 1];
    }
}

/* With their repeated columns. */
static void repeat_rows(const asj_frame *frame)
{
    const size_t bytes = ((size_t)frame->width + 2 * ASJ_GRAY_BORDER) * sizeof *frame->gray;
    uint16_t *first = frame->gray - ASJ_GRAY_BORDER, *last = first + (frame->height - 1) * frame->stride;
    for (int32_t i = 1; i <= ASJ_GRAY_BORDER; i++) {
        memcpy(first - i * frame->stride, first, bytes);
        memcpy(last + i * frame->stride, last, bytes);
    }
}

/* Returns 0 when a sample is NaN or infinite. */
static int load_row(const conversion *c, uint16_t *gray, const void *row, const asj_image *image)
{
    const int32_t width = image->width;
    int finite = 1;
    switch (image->format) {
    case ASJ_FORMAT_GRAY8: load_bytes(gray, row, width, c->levels); break;
    case ASJ_FORMAT_GRAY16: load_words(gray, row, width, c->scale); break;
    case ASJ_FORMAT_GRAY_FLOAT: finite = load_float(gray, row, width, c->scale); break;
    default: load_colour(c, gray, row, width, asj_pixel_size(image->format), asj_red_of(image->format)); break;
    }
    repeat_columns(gray, width);
    return finite;
}

static void prepare_conversion(const asj_context *context, const asj_image *image, int32_t plane, conversion *c)
{
    const float standard = find_format(image->format)->white, white = image->white > 0 ? image->white : standard;
    c->ops = context->ops->image;
    c->plane = plane;
    c->scale = (float)ASJ_GRAY_MAX / white;
    for (int i = 0; i < 256; i++)
        c->table[i] = cut((float)i * c->scale);
    c->levels = white < 255 || white > 255 ? c->table : NULL;
}

typedef struct job {
    const conversion *c;
    asj_frame *frame;
    const asj_image *image;
    ptrdiff_t stride;
    int32_t *failed;
    asj_watch *watch;
} job;

static int load_row_at(const job *j, int64_t y)
{
    return load_row(j->c, j->frame->gray + y * j->frame->stride, (const char *)j->image->data + y * j->stride, j->image);
}

static void load_rows(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++)
        if (!load_row_at(j, y))
            __atomic_store_n(j->failed, 1, __ATOMIC_RELAXED);
}

asj_status asj_frame_load(asj_context *context, asj_frame *frame, const asj_image *image, int32_t plane)
{
    const ptrdiff_t row_bytes = (ptrdiff_t)image->width * asj_pixel_size(image->format);
    const ptrdiff_t stride = image->stride ? image->stride : row_bytes;
    const int32_t height = image->height;
    int32_t failed = 0;
    conversion c;
    prepare_conversion(context, image, plane, &c);
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
    const job j = {&c, frame, image, stride, &failed, &watch};
    asj_parallel(context, asj_threads_for(context, (int64_t)image->width * height, LEAST_PIXELS), height, 0, load_rows, &j);
    for (int32_t y = 0; failed && y < height; y++)
        if (!load_row_at(&j, y))
            return asj_fail(context, ASJ_ERROR_IMAGE, "row %d of the image holds NaN or infinity", (int)y);
    repeat_rows(frame);
    const asj_status status = asj_watch_end(&watch);
    frame->loaded = status == ASJ_OK ? 2 * (size_t)frame->stride * ((size_t)height + 2 * ASJ_MARGIN) : 0;
    frame->loaded_width = frame->width;
    frame->loaded_height = height;
    frame->loaded_plane = plane;
    return status;
}

int asj_frame_recall(asj_frame *frame, int32_t width, int32_t height, int32_t plane)
{
    if (!frame->loaded || frame->loaded_width != width || frame->loaded_height != height || frame->loaded_plane != plane)
        return 0;
    set_size(frame, width, height);
    set_planes(frame);
    return 1;
}

const asj_image_ops asj_image_reference = {.luma = asj_image_luma};

void asj_halve_row(const uint16_t *upper, const uint16_t *lower, int32_t width, uint16_t *to)
{
    for (int32_t x = 0; x < width; x++)
        to[x] = (uint16_t)((upper[2 * x] + upper[2 * x + 1] + lower[2 * x] + lower[2 * x + 1] + 2) >> 2);
}

void asj_frame_repeat_border(const asj_frame *frame)
{
    for (int32_t y = 0; y < frame->height; y++)
        repeat_columns(frame->gray + y * frame->stride, frame->width);
    repeat_rows(frame);
}

typedef struct halve_job {
    const uint16_t *from;
    ptrdiff_t stride; /* of `from` */
    const asj_frame *frame;
    asj_watch *watch;
} halve_job;

/* Rows move to the front of the same memory. The planes of the gradient stand before them and are half as high and no wider now,
 * so that all rows are written before the first one that is read: in any order, by any thread. */
static void halve_rows(const void *data, const asj_part *part)
{
    const halve_job *j = data;
    const int32_t width = j->frame->width;
    for (int64_t y = part->first; y < part->end && !asj_watch_stops(j->watch, part); y++) {
        const uint16_t *upper = j->from + 2 * y * j->stride;
        uint16_t *to = j->frame->gray + y * j->frame->stride;
        asj_halve_row(upper, upper + j->stride, width, to);
        repeat_columns(to, width);
    }
}

asj_gray_plane asj_frame_gray(const asj_frame *frame)
{
    return (asj_gray_plane){frame->gray, frame->stride, frame->width, frame->height, frame->octave};
}

asj_status asj_frame_halve_plane(asj_context *context, asj_frame *frame, const asj_gray_plane *from)
{
    asj_watch watch;
    const halve_job j = {from->levels, from->stride, frame, &watch};
    const int32_t octaves = frame->octaves;
    asj_status status = asj_frame_prepare(context, frame, from->width / 2, from->height / 2);
    if (status != ASJ_OK)
        return status;
    frame->octave = from->octave + 1;
    frame->octaves = octaves;
    const int64_t pixels = (int64_t)frame->width * frame->height;
    asj_watch_start(&watch, context, ASJ_STAGE_GRADIENT);
    asj_parallel(context, asj_threads_for(context, pixels, LEAST_HALVED), frame->height, 0, halve_rows, &j);
    repeat_rows(frame);
    return asj_watch_end(&watch);
}

asj_status asj_frame_halve(asj_context *context, asj_frame *frame)
{
    const asj_gray_plane own = asj_frame_gray(frame);
    return asj_frame_halve_plane(context, frame, &own);
}
