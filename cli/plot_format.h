/* SPDX-License-Identifier: BSD-2-Clause */
/* Formats of plot files, and what every plot has; no cairo here. */
#ifndef ASJ_CLI_PLOT_FORMAT_H
#define ASJ_CLI_PLOT_FORMAT_H

#include <stdint.h>

enum { CLI_PLOT_PNG = 0, CLI_PLOT_SVG = 1, CLI_PLOT_PDF = 2 };
enum { CLI_PLOT_PHOTO = 0, CLI_PLOT_PHOTO_COLOR = 1, CLI_PLOT_WHITE = 2 };

#define CLI_PLOT_MIN_SCALE 0.01
#define CLI_PLOT_MAX_SCALE 16

/* 1 when this build can plot. */
int cli_plot_available(void);

/* CLI_PLOT_... of "png", "svg" or "pdf" in either case, or -1. */
int32_t cli_plot_format_of_word(const char *word);

/* Checks that this build can plot, and sets the format from the end of a file's name. CLI_SUCCESS, or CLI_USAGE after saying
 * why. */
int cli_plot_format_of_name(const char *command, const char *name, int32_t *format);

/* --plot-background and --plot-scale: CLI_SUCCESS, or CLI_USAGE after saying why. */
int cli_plot_take_background(const char *command, const char *text, int32_t *background);
int cli_plot_take_scale(const char *command, const char *text, double *scale);

/* CLI_USAGE after saying that this option changes nothing without a plot; CLI_SUCCESS for NULL. */
int cli_plot_check_without(const char *command, const char *option);

#endif
