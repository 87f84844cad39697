/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_PLOT_SURFACE_H
#define ASJ_CLI_PLOT_SURFACE_H

#include <asj/status.h>

#include <cairo.h>

/* Writes a plot file of width x height units (pixels of a PNG, points of a PDF) that `draw` fills; the file appears whole or not
 * at all. format: CLI_PLOT_... On failure `message` receives a line that names the cause. */
asj_status cli_plot_file(const char *path, int32_t format, int32_t width, int32_t height, void (*draw)(cairo_t *cairo, void *user),
                         void *user, char *message, size_t message_size);

#endif
