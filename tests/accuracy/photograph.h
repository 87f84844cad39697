/* SPDX-License-Identifier: BSD-2-Clause */
/* What the programs that work on photographs share: grey pixels from a file, detection, the list of files. */
#ifndef ASJ_TESTS_ACCURACY_PHOTOGRAPH_H
#define ASJ_TESTS_ACCURACY_PHOTOGRAPH_H

#include <asj/asj.h>

typedef struct photograph {
    uint8_t *pixels; /* 8-bit grey, row by row */
    int32_t width, height;
} photograph;

/* Reads an image and reduces it to luma as the library does. 0, or -1 with a line on standard error. */
int photograph_read(const char *path, photograph *p);
void photograph_free(photograph *p);

/* Junctions of 8-bit grey pixels; NULL with a line on standard error. */
asj_detection *photograph_detect(asj_context *context, const asj_detect_options *options, const uint8_t *pixels,
                                 int32_t width, int32_t height);

/* Paths of PNG files: a file itself, those of a folder, or those of the folders in a folder, in order of name. */
typedef struct path_list {
    char **paths;
    int32_t count, capacity;
} path_list;

/* 0, or -1 with a line on standard error. */
int path_list_add(path_list *list, const char *path);
void path_list_free(path_list *list);

/* Sets an option from "key=value". 0, or -1 with a line on standard error. */
int photograph_option(asj_detect_options *options, const char *text);

#endif
