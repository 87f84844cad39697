/* SPDX-License-Identifier: BSD-2-Clause */
/* A photograph as the pale background of a plot, scaled. */
#include "plot_photo.h"
#include "pixels.h"
#include "plot_format.h"

#include <math.h>
#include <string.h>

enum { ENLARGED_SIDE = 1000, LARGEST_ENLARGEMENT = 8 };

/* Share of the photograph's contrast that is kept, towards white: dark enough to see the room, light enough for the colours. */
#define CONTRAST 0.45

static double white_of(const asj_image *image)
{
    if (image->white > 0)
        return image->white;
    return image->format == ASJ_FORMAT_GRAY16 ? 65535 : image->format == ASJ_FORMAT_GRAY_FLOAT ? 1 : 255;
}

/* BT.601 luma, as the detector takes it, in the unit of the samples. */
static double luma(const unsigned char *pixel, int32_t format)
{
    uint16_t wide;
    float real;
    switch (format) {
    case ASJ_FORMAT_GRAY8: return pixel[0];
    case ASJ_FORMAT_GRAY16: memcpy(&wide, pixel, sizeof wide); return wide;
    case ASJ_FORMAT_GRAY_FLOAT: memcpy(&real, pixel, sizeof real); return (double)real;
    case ASJ_FORMAT_BGR8:
    case ASJ_FORMAT_BGRA8: return 0.299 * pixel[2] + 0.587 * pixel[1] + 0.114 * pixel[0];
    default: return 0.299 * pixel[0] + 0.587 * pixel[1] + 0.114 * pixel[2];
    }
}

/* Red, green and blue, 0 .. 2; luma for images that have no colours, and for channel GRAY. */
enum { GRAY = 3 };
static double sample(const unsigned char *pixel, int32_t format, int channel)
{
    switch (format) {
    case ASJ_FORMAT_RGB8:
    case ASJ_FORMAT_RGBA8: return channel == GRAY ? luma(pixel, format) : pixel[channel];
    case ASJ_FORMAT_BGR8:
    case ASJ_FORMAT_BGRA8: return channel == GRAY ? luma(pixel, format) : pixel[2 - channel];
    default: return luma(pixel, format);
    }
}

static double block_mean(const asj_image *image, int channel, int32_t left, int32_t top, int32_t reduction)
{
    const size_t bytes = cli_pixel_size(image->format);
    int32_t right = image->width - left < reduction ? image->width : left + reduction;
    int32_t bottom = image->height - top < reduction ? image->height : top + reduction;
    double sum = 0;
    for (int32_t y = top; y < bottom; y++) {
        const unsigned char *pixel = cli_pixel_at(image, left, y);
        for (int32_t x = left; x < right; x++, pixel += bytes)
            sum += sample(pixel, image->format, channel);
    }
    return sum / ((double)(right - left) * (bottom - top));
}

static uint32_t pale(double value)
{
    value = value > 0 ? (value < 1 ? value : 1) : 0;
    return (uint32_t)(255 * (1 - CONTRAST * (1 - value)) + 0.5);
}

/* The photograph as a surface of its own; every pixel is the mean of `reduction` x `reduction` pixels of the image (fewer at the
 * right and lower border). Its cairo status says whether it could be made. */
static cairo_surface_t *make_photo(const asj_image *image, int32_t background, int32_t reduction)
{
    int32_t width = (image->width + reduction - 1) / reduction, height = (image->height + reduction - 1) / reduction;
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
        return surface;
    unsigned char *pixels = cairo_image_surface_get_data(surface);
    ptrdiff_t stride = cairo_image_surface_get_stride(surface);
    double white = white_of(image);
    for (int32_t y = 0; y < height; y++)
        for (int32_t x = 0; x < width; x++) {
            uint32_t pixel = 0;
            for (int c = 0; c < 3 && background == CLI_PLOT_PHOTO_COLOR; c++)
                pixel = pixel << 8 | pale(block_mean(image, c, x * reduction, y * reduction, reduction) / white);
            if (background != CLI_PLOT_PHOTO_COLOR)
                pixel = 0x10101 * pale(block_mean(image, GRAY, x * reduction, y * reduction, reduction) / white);
            memcpy(pixels + y * stride + 4 * (ptrdiff_t)x, &pixel, sizeof pixel);
        }
    cairo_surface_mark_dirty(surface);
    return surface;
}

double cli_plot_natural_scale(int32_t width, int32_t height)
{
    int32_t side = width > height ? width : height;
    if (side > CLI_PLOT_LARGEST_SIDE)
        return (double)CLI_PLOT_LARGEST_SIDE / side;
    return side < ENLARGED_SIDE ? fmin((ENLARGED_SIDE + side / 2) / side, LARGEST_ENLARGEMENT) : 1;
}

/* A reduced copy is enough, and several times smaller, where the plot is smaller than the image. */
void cli_plot_photo(cairo_t *cairo, const asj_image *image, int32_t background, double scale, int32_t width, int32_t height)
{
    int32_t reduction = scale < 1 ? (int32_t)(1 / scale) : 1;
    while (image->width / reduction > CLI_PLOT_LARGEST_SIDE || image->height / reduction > CLI_PLOT_LARGEST_SIDE)
        reduction++;
    cairo_surface_t *photo = make_photo(image, background, reduction);
    cairo_save(cairo);
    cairo_rectangle(cairo, 0, 0, width, height);
    cairo_clip(cairo);
    cairo_scale(cairo, scale * reduction, scale * reduction);
    cairo_set_source_surface(cairo, photo, 0, 0);
    cairo_pattern_set_extend(cairo_get_source(cairo), CAIRO_EXTEND_PAD);
    cairo_paint(cairo);
    cairo_restore(cairo);
    cairo_surface_destroy(photo);
}
