/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "fuzz.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

unsigned fuzz_byte(fuzz_bytes *bytes)
{
    if (!bytes->left)
        return 0;
    bytes->left--;
    return *bytes->next++;
}

unsigned fuzz_pair(fuzz_bytes *bytes)
{
    unsigned high = fuzz_byte(bytes);
    return high << 8 | fuzz_byte(bytes);
}

void fuzz_check(int truth, const char *what)
{
    if (truth)
        return;
    fprintf(stderr, "finding: %s\n", what);
    abort();
}

static char path[64];

static void remove_file(void)
{
    unlink(path);
}

const char *fuzz_file(const uint8_t *data, size_t size)
{
    static int file = -1;
    if (file < 0) {
        snprintf(path, sizeof path, "%s/asj-fuzz-XXXXXX", access("/dev/shm", W_OK) ? "/tmp" : "/dev/shm");
        file = mkstemp(path);
        fuzz_check(file >= 0, "cannot create a file");
        atexit(remove_file);
    }
    fuzz_check(!ftruncate(file, 0) && pwrite(file, data, size, 0) == (ssize_t)size, "cannot write the file");
    return path;
}

asj_context *fuzz_context(void)
{
    static asj_context *context;
    asj_context_options options;
    if (!context) {
        asj_context_options_init(&options);
        options.backend = ASJ_BACKEND_CPU;
        options.threads = 1;
        fuzz_check(asj_context_create(&options, &context) == ASJ_OK, "no context");
    }
    return context;
}

void fuzz_options(fuzz_bytes *bytes, size_t count, const asj_option_info *(*row)(size_t), fuzz_set *set, void *options)
{
    unsigned changes = fuzz_byte(bytes) % 6, i;
    for (i = 0; i < changes; i++) {
        const asj_option_info *info = row(fuzz_byte(bytes) % count);
        double part = fuzz_pair(bytes) / 65535.0, value = info->minimum + part * (info->maximum - info->minimum);
        char text[64];
        size_t words = 0;
        switch (info->type) {
        case ASJ_OPTION_NUMBER: snprintf(text, sizeof text, "%.17g", value); break;
        case ASJ_OPTION_INTEGER: snprintf(text, sizeof text, "%d", (int)(value + (value < 0 ? -0.5 : 0.5))); break;
        case ASJ_OPTION_SWITCH: snprintf(text, sizeof text, "%s", part > 0.5 ? "on" : "off"); break;
        case ASJ_OPTION_CHOICE:
            while (info->choices[words])
                words++;
            snprintf(text, sizeof text, "%s", info->choices[(size_t)(part * (double)(words - 1) + 0.5)]);
            break;
        default: snprintf(text, sizeof text, "%d,%d", (int)value, (int)(info->minimum + (1.0 - part) * 12.0)); break;
        }
        set(options, info->key, text); /* radii may be out of range: refused */
    }
}

size_t fuzz_pixel_bytes(int32_t format)
{
    switch (format) {
    case ASJ_FORMAT_GRAY8: return 1;
    case ASJ_FORMAT_GRAY16: return 2;
    case ASJ_FORMAT_RGB8:
    case ASJ_FORMAT_BGR8: return 3;
    default: return 4;
    }
}

/* A half-plane of another level, xor'ed into the bytes: several make corners. */
static void draw(uint8_t *pixels, const asj_image *image, size_t pixel, fuzz_bytes *bytes)
{
    int a = (int)fuzz_byte(bytes) - 128, b = (int)fuzz_byte(bytes) - 128, c = (int)fuzz_pair(bytes) - 32768;
    uint8_t level = (uint8_t)fuzz_byte(bytes);
    int32_t x, y;
    size_t k;
    for (y = 0; y < image->height; y++)
        for (x = 0; x < image->width; x++)
            if (a * x + b * y > c)
                for (k = 0; k < pixel; k++)
                    pixels[((size_t)y * (size_t)image->width + (size_t)x) * pixel + k] ^= level;
}

void fuzz_image(fuzz_bytes *bytes, unsigned most, asj_image *image)
{
    static const asj_image none = {0};
    unsigned kind = fuzz_byte(bytes), shapes = fuzz_byte(bytes) % 12, i;
    size_t size, at, pixel;
    uint8_t *pixels;

    *image = none;
    image->format = (int32_t)(kind % 7) + 1;
    image->width = (int32_t)(1 + fuzz_byte(bytes) * (most - 1) / 255);
    image->height = (int32_t)(1 + fuzz_byte(bytes) * (most - 1) / 255);
    pixel = fuzz_pixel_bytes(image->format);
    size = (size_t)image->width * (size_t)image->height * pixel;
    pixels = calloc(size, 1);
    fuzz_check(pixels != NULL, "no memory");
    for (i = 0; i < shapes; i++)
        draw(pixels, image, pixel, bytes);
    if (image->format == ASJ_FORMAT_GRAY_FLOAT && kind < 200) /* levels and not bits, mostly */
        for (at = 0; at < size; at += 4) {
            float level = pixels[at] / 255.0f;
            memcpy(pixels + at, &level, 4);
        }
    for (at = 0; at < size && bytes->left; at++)
        pixels[at] ^= (uint8_t)fuzz_byte(bytes);
    image->data = pixels;
}
