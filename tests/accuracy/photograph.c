/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L

#include "photograph.h"

#include <asj/io.h>

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static int luma(const asj_image *image, uint8_t *out)
{
    const int32_t channels = image->format == ASJ_FORMAT_GRAY8 ? 1 : image->format == ASJ_FORMAT_RGBA8 ? 4 : 3;
    const int bgr = image->format == ASJ_FORMAT_BGR8;
    if (image->format != ASJ_FORMAT_GRAY8 && image->format != ASJ_FORMAT_RGB8 && image->format != ASJ_FORMAT_RGBA8 && !bgr)
        return -1;
    const ptrdiff_t stride = image->stride ? image->stride : (ptrdiff_t)image->width * channels;
    for (int32_t y = 0; y < image->height; y++) {
        const uint8_t *row = (const uint8_t *)image->data + y * stride;
        for (int32_t x = 0; x < image->width; x++, row += channels)
            *out++ = channels == 1 ? row[0] : (uint8_t)((77 * row[bgr ? 2 : 0] + 150 * row[1] + 29 * row[bgr ? 0 : 2] + 128) >> 8);
    }
    return 0;
}

int photograph_read(const char *path, photograph *p)
{
    char message[512];
    asj_image_file *file = NULL;
    memset(p, 0, sizeof *p);
    if (asj_image_file_read(path, 0, &file, message, sizeof message) != ASJ_OK) {
        fprintf(stderr, "%s\n", message);
        return -1;
    }
    p->width = file->image.width;
    p->height = file->image.height;
    p->pixels = malloc((size_t)p->width * (size_t)p->height);
    const int result = p->pixels ? luma(&file->image, p->pixels) : -1;
    if (result != 0) {
        fprintf(stderr, "%s: not an 8-bit image, or out of memory\n", path);
        photograph_free(p);
    }
    asj_image_file_free(&file);
    return result;
}

void photograph_free(photograph *p)
{
    free(p->pixels);
    p->pixels = NULL;
}

asj_detection *photograph_detect(asj_context *context, const asj_detect_options *options, const uint8_t *pixels,
                                 int32_t width, int32_t height)
{
    const asj_image image = {pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
    asj_detection *detection = NULL;
    if (asj_detect(context, &image, options, &detection) != ASJ_OK)
        fprintf(stderr, "%s\n", asj_context_message(context));
    return detection;
}

static int append(path_list *list, const char *path)
{
    if (list->count == list->capacity) {
        const int32_t capacity = list->capacity ? 2 * list->capacity : 32;
        char **grown = realloc(list->paths, (size_t)capacity * sizeof *grown);
        if (!grown)
            return -1;
        list->paths = grown;
        list->capacity = capacity;
    }
    char *copy = malloc(strlen(path) + 1);
    if (!copy)
        return -1;
    strcpy(copy, path);
    list->paths[list->count++] = copy;
    return 0;
}

static int is_png(const char *name)
{
    const size_t length = strlen(name);
    return length > 4 && strcmp(name + length - 4, ".png") == 0;
}

static int by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

static int add_folder(path_list *list, const char *folder, int depth)
{
    DIR *directory = opendir(folder);
    int result = 0;
    if (!directory)
        return -1;
    for (struct dirent *entry = readdir(directory); entry && result == 0; entry = readdir(directory)) {
        char path[4096];
        struct stat status;
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (stat(path, &status) != 0)
            continue;
        if (S_ISDIR(status.st_mode) && depth == 0)
            result = add_folder(list, path, depth + 1);
        else if (S_ISREG(status.st_mode) && is_png(path))
            result = append(list, path);
    }
    closedir(directory);
    return result;
}

int path_list_add(path_list *list, const char *path)
{
    struct stat status;
    const int32_t first = list->count;
    int result = stat(path, &status);
    if (result == 0)
        result = S_ISDIR(status.st_mode) ? add_folder(list, path, 0) : append(list, path);
    if (result != 0)
        fprintf(stderr, "%s: cannot be read\n", path);
    else if (list->count == first)
        fprintf(stderr, "%s: no PNG files there\n", path);
    if (list->count > first)
        qsort(list->paths + first, (size_t)(list->count - first), sizeof *list->paths, by_name);
    return list->count == first ? -1 : result;
}

void path_list_free(path_list *list)
{
    for (int32_t i = 0; i < list->count; i++)
        free(list->paths[i]);
    free(list->paths);
    memset(list, 0, sizeof *list);
}

int photograph_option(asj_detect_options *options, const char *text)
{
    char key[64], message[256];
    const char *equals = strchr(text, '=');
    if (!equals || (size_t)(equals - text) >= sizeof key) {
        fprintf(stderr, "%s: options are given as key=value\n", text);
        return -1;
    }
    memcpy(key, text, (size_t)(equals - text));
    key[equals - text] = '\0';
    if (asj_detect_options_set(options, key, equals + 1, message, sizeof message) == ASJ_OK)
        return 0;
    fprintf(stderr, "%s\n", message);
    return -1;
}
