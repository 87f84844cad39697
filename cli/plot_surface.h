/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_PLOT_SURFACE_H
#define ASJ_CLI_PLOT_SURFACE_H

#include <asj/io.h>

#include <cairo.h>

typedef struct cli_plot_content {
    void (*draw)(cairo_t *cairo, void *user);
    void (*annotate)(asj_output *output, void *user); /* elements of SVG above the drawing: titles; NULL = none */
    void *user;
    int (*stopped)(void);                             /* 1 = the file is no longer wanted; NULL = never */
} cli_plot_content;

/* Writes a plot file of width x height units (pixels of a PNG, points of a PDF); the file appears whole or not at all. format:
 * CLI_PLOT_... On failure `message` receives a line that names the cause. */
asj_status cli_plot_file(const char *path, int32_t format, int32_t width, int32_t height, const cli_plot_content *content,
                         char *message, size_t message_size);

/* SVG that is not drawn and feels the pointer. */
void cli_plot_hot_dot(asj_output *output, double x, double y, double radius);
void cli_plot_hot_line(asj_output *output, double x1, double y1, double x2, double y2, double width);

#endif
