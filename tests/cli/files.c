/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "files.h"

#include <asj/io.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <dirent.h>
#include <math.h>
#include <sys/stat.h>

static void write_gray(const char *path, const unsigned char *pixels, int width, int height)
{
    char message[512] = "";
    asj_image image = {pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    if (asj_png_write(path, &image, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
}

/* An edge at `place` seen through a blur of about a pixel. */
static double edge(double coordinate, double place)
{
    return 0.5 + 0.5 * tanh(coordinate - place);
}

/* How much of the light falls on a place, in [0, 1]. */
static double rectangle(double x, double y)
{
    return edge(x, SCENE_LEFT) * edge(-x, -SCENE_RIGHT) * edge(y, SCENE_TOP) * edge(-y, -SCENE_BOTTOM);
}

static double crossing(double x, double y)
{
    double right = edge(x, SCENE_WIDTH / 2), below = edge(y, SCENE_HEIGHT / 2);
    return right * below + (1 - right) * (1 - below);
}

/* The light at x, y of the picture comes from scale x + left, scale y + top of the scene. */
typedef struct view {
    double scale, left, top;
    int rows; /* that are one of the picture: it is so many times less high */
} view;

static void write_view(const char *path, double (*light)(double x, double y), const view *v)
{
    const int height = SCENE_HEIGHT / v->rows;
    unsigned char *pixels = malloc((size_t)SCENE_WIDTH * (size_t)height);
    assert_non_null(pixels);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < SCENE_WIDTH; x++) {
            double sum = 0;
            for (int k = 0; k < v->rows; k++)
                sum += light(v->scale * x + v->left, v->scale * (v->rows * y + k) + v->top);
            pixels[y * SCENE_WIDTH + x] = (unsigned char)(80 + 100 * sum / v->rows + 0.5);
        }
    write_gray(path, pixels, SCENE_WIDTH, height);
    free(pixels);
}

static void write_light(const char *path, double (*light)(double x, double y))
{
    write_view(path, light, &(view){1, 0, 0, 1});
}

/* Later rectangles cover earlier ones. */
static double wall(double x, double y)
{
    static const double rectangles[][5] = { /* left, right, top, bottom, light */
        {30, 120, 25, 80, 0.9},   {45, 75, 35, 65, 0.1},    {140, 200, 30, 120, 0.8}, {152, 185, 45, 75, 0.3},
        {215, 290, 22, 70, 0.1},  {230, 262, 36, 58, 1},    {35, 95, 100, 205, 0.2},  {50, 78, 120, 165, 0.85},
        {120, 190, 140, 210, 0.6}, {135, 160, 160, 190, 0}, {210, 285, 95, 200, 0.95}, {228, 250, 110, 150, 0.4},
        {255, 275, 160, 185, 0.1},
    };
    double light = 0.5;
    for (size_t i = 0; i < sizeof rectangles / sizeof rectangles[0]; i++) {
        const double *r = rectangles[i];
        double inside = edge(x, r[0]) * edge(-x, -r[1]) * edge(y, r[2]) * edge(-y, -r[3]);
        light += inside * (r[4] - light);
    }
    return light;
}

void write_views(const char *first, const char *second)
{
    write_flat_views(first, second, 1);
}

static double tiles(double x, double y)
{
    double light = 0.5;
    for (int k = 0; k < 35; k++) {
        const int column = k % 7, row = k / 7, level = (13 * column + 29 * row) % 17;
        const double left = 20 + 41 * column, right = left + 22 + (7 * column + 5 * row) % 9;
        const double top = 14 + 45 * row, bottom = top + 24 + (5 * column + 3 * row) % 11;
        const double inside = edge(x, left) * edge(-x, -right) * edge(y, top) * edge(-y, -bottom);
        light += inside * ((level < 6 || level > 10 ? level / 16.0 : 0.9) - light);
    }
    return light;
}

void write_tiled_views(const char *first, const char *second)
{
    write_view(first, tiles, &(view){1, 0, 0, 1});
    write_view(second, tiles, &(view){1 / VIEW_SCALE, -VIEW_X / VIEW_SCALE, -VIEW_Y / VIEW_SCALE, 1});
}

int make_views(void **state)
{
    (void)state;
    write_views("first.png", "second.png");
    return 0;
}

void write_flat_views(const char *first, const char *second, int rows)
{
    write_view(first, wall, &(view){1, 0, 0, rows});
    write_view(second, wall, &(view){1 / VIEW_SCALE, -VIEW_X / VIEW_SCALE, -VIEW_Y / VIEW_SCALE, rows});
}

/* Red and green change against each other, so that 0.299 R + 0.587 G + 0.114 B stays what it is. */
static void write_coloured_view(const char *path, const view *v)
{
    char *ppm = malloc(64 + (size_t)3 * SCENE_WIDTH * SCENE_HEIGHT);
    assert_non_null(ppm);
    size_t size = (size_t)snprintf(ppm, 64, "P6 %d %d 255\n", SCENE_WIDTH, SCENE_HEIGHT);
    for (int y = 0; y < SCENE_HEIGHT; y++)
        for (int x = 0; x < SCENE_WIDTH; x++) {
            const double red = 100 * (wall(v->scale * x + v->left, v->scale * y + v->top) - 0.5);
            ppm[size++] = (char)(unsigned char)(128 + red + 0.5);
            ppm[size++] = (char)(unsigned char)(128 - red * (0.299 / 0.587) + 0.5);
            ppm[size++] = (char)(unsigned char)128;
        }
    write_bytes(path, ppm, size);
    free(ppm);
}

void write_smooth_colours(const char *path, int change)
{
    char *ppm = malloc(64 + (size_t)3 * SCENE_WIDTH * SCENE_HEIGHT);
    assert_non_null(ppm);
    size_t size = (size_t)snprintf(ppm, 64, "P6 %d %d 255\n", SCENE_WIDTH, SCENE_HEIGHT);
    for (int k = 0; k < SCENE_WIDTH * SCENE_HEIGHT; k++) {
        ppm[size++] = (char)(unsigned char)(150 + change * (k % SCENE_WIDTH) / SCENE_WIDTH);
        ppm[size++] = (char)(unsigned char)120;
        ppm[size++] = (char)(unsigned char)90;
    }
    write_bytes(path, ppm, size);
    free(ppm);
}

void write_coloured_views(const char *first, const char *second)
{
    write_coloured_view(first, &(view){1, 0, 0, 1});
    write_coloured_view(second, &(view){1 / VIEW_SCALE, -VIEW_X / VIEW_SCALE, -VIEW_Y / VIEW_SCALE, 1});
}

void write_scene(const char *path)
{
    write_light(path, rectangle);
}

void write_deep_scene(const char *path, int white)
{
    static uint16_t pixels[SCENE_WIDTH * SCENE_HEIGHT];
    char message[512] = "";
    asj_image image = {pixels, ASJ_FORMAT_GRAY16, SCENE_WIDTH, SCENE_HEIGHT, 0, 0};
    for (int i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++)
        pixels[i] = (uint16_t)((0.4 + 0.55 * rectangle(i % SCENE_WIDTH, i / SCENE_WIDTH)) * white + 0.5);
    if (asj_png_write(path, &image, message, sizeof message) != ASJ_OK)
        fail_msg("%s", message);
}

void write_float_scene(const char *path, float white)
{
    static char bytes[64 + sizeof(float) * SCENE_WIDTH * SCENE_HEIGHT];
    const uint16_t order = 1; /* of the bytes of a number: the sign says which */
    size_t size = (size_t)snprintf(bytes, 64, "Pf %d %d %s\n", SCENE_WIDTH, SCENE_HEIGHT, *(const char *)&order ? "-1.0" : "1.0");
    for (int i = 0; i < SCENE_WIDTH * SCENE_HEIGHT; i++) {
        const float level = (float)(0.4 + 0.55 * rectangle(i % SCENE_WIDTH, i / SCENE_WIDTH)) * white;
        memcpy(bytes + size, &level, sizeof level);
        size += sizeof level;
    }
    write_bytes(path, bytes, size);
}

void write_crossing(const char *path)
{
    write_light(path, crossing);
}

static void write_plain(const char *path, int width, int height, int more)
{
    unsigned char *pixels = malloc((size_t)width * (size_t)height);
    assert_non_null(pixels);
    memset(pixels, 128, (size_t)width * (size_t)height);
    pixels[(size_t)width * (size_t)height - 1] = (unsigned char)(128 + more);
    write_gray(path, pixels, width, height);
    free(pixels);
}

void write_constant(const char *path, int width, int height)
{
    write_plain(path, width, height, 0);
}

void write_nearly_constant(const char *path, int width, int height)
{
    write_plain(path, width, height, 1);
}

void write_noise(const char *path, int width, int height)
{
    size_t count = (size_t)width * (size_t)height;
    unsigned char *pixels = malloc(count);
    uint32_t number = 1;
    assert_non_null(pixels);
    for (size_t i = 0; i < count; i++) {
        number = number * 1664525u + 1013904223u;
        pixels[i] = (unsigned char)(number >> 24);
    }
    write_gray(path, pixels, width, height);
    free(pixels);
}

void write_bytes(const char *path, const void *bytes, size_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

char *read_bytes(const char *path, size_t *size)
{
    struct stat facts;
    FILE *file = fopen(path, "rb");
    if (!file)
        return NULL;
    assert_int_equal(fstat(fileno(file), &facts), 0);
    char *bytes = calloc((size_t)facts.st_size + 1, 1);
    assert_non_null(bytes);
    *size = fread(bytes, 1, (size_t)facts.st_size, file);
    fclose(file);
    return bytes;
}

/* The checksum of PNG chunks (ISO 3309), bit by bit. */
static uint32_t checksum(const unsigned char *bytes, size_t size)
{
    uint32_t crc = 0xffffffff;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int bit = 0; bit < 8; bit++)
            crc = crc & 1 ? crc >> 1 ^ 0xedb88320 : crc >> 1;
    }
    return ~crc;
}

static void put_big_endian(unsigned char *place, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        place[i] = (unsigned char)(value >> (24 - 8 * i));
}

void write_png_header(const char *path, unsigned width, unsigned height)
{
    static const unsigned char beginning[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n', 0, 0, 0, 13, 'I', 'H', 'D', 'R'};
    unsigned char bytes[64] = {0};
    memcpy(bytes, beginning, sizeof beginning);
    put_big_endian(bytes + 16, width);
    put_big_endian(bytes + 20, height);
    bytes[24] = 8; /* bits; grey, no interlacing */
    put_big_endian(bytes + 29, checksum(bytes + 12, 17));
    memcpy(bytes + 37, "IDAT", 4); /* an empty chunk of pixels */
    put_big_endian(bytes + 41, checksum(bytes + 37, 4));
    write_bytes(path, bytes, 45);
}

void write_part(const char *path, const char *source, size_t size)
{
    size_t all = 0;
    char *bytes = read_bytes(source, &all);
    assert_non_null(bytes);
    assert_true(size < all);
    write_bytes(path, bytes, size);
    free(bytes);
}

void write_damaged(const char *path, const char *source, size_t position)
{
    size_t all = 0;
    char *bytes = read_bytes(source, &all);
    assert_non_null(bytes);
    assert_true(position < all);
    bytes[position] ^= 0x10;
    write_bytes(path, bytes, all);
    free(bytes);
}

int count_files(const char *folder)
{
    int count = 0;
    struct dirent *entry;
    DIR *list = opendir(folder);
    assert_non_null(list);
    while ((entry = readdir(list)) != NULL)
        count += strcmp(entry->d_name, ".") != 0 && strcmp(entry->d_name, "..") != 0;
    closedir(list);
    return count;
}

int exists(const char *path)
{
    struct stat facts;
    return lstat(path, &facts) == 0;
}
