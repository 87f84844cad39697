/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_PROGRESS_H
#define ASJ_CLI_PROGRESS_H

#include <stddef.h>
#include <stdint.h>

/* One line on the terminal that is rewritten while an image is worked on. Nothing is shown for the first tenth of a second, nor
 * where standard error is not a terminal. */
typedef struct cli_progress {
    int enabled;
    int visible;
    size_t image, image_count;
    const char *name;   /* of the image in hand */
    double last_drawn;  /* ms */
} cli_progress;

void cli_progress_init(cli_progress *progress, int quiet, size_t image_count);
void cli_progress_next(cli_progress *progress, size_t image, const char *name);

/* What an asj_progress_callback is to do. Asks to stop once a signal has come. */
int32_t cli_progress_report(cli_progress *progress, int32_t stage, double done);

/* Removes the line; to be called before anything else is printed. */
void cli_progress_clear(cli_progress *progress);

#endif
