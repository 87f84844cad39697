/* SPDX-License-Identifier: BSD-2-Clause */
/* A line of progress, on terminals only. */
#include "progress.h"
#include "interrupt.h"
#include "message.h"
#include "platform.h"

#include <asj/context.h>

#include <stdio.h>
#include <string.h>

enum { REDRAW_MS = 100, NAME_WIDTH = 40 };

void cli_progress_init(cli_progress *progress, int quiet, size_t image_count)
{
    memset(progress, 0, sizeof *progress);
    progress->enabled = !quiet && cli_is_terminal();
    progress->image_count = image_count;
    progress->name = "";
    progress->last_drawn = cli_now_ms();
}

void cli_progress_next(cli_progress *progress, size_t image, const char *name)
{
    const char *base = cli_base_name(name);
    progress->image = image;
    progress->name = *base ? base : name;
}

static void draw(cli_progress *progress, int32_t stage, double done)
{
    char name[NAME_WIDTH + 1];
    snprintf(name, sizeof name, "%s", progress->name);
    cli_make_harmless(name);
    fputs("\r\033[K", stderr);
    if (progress->image_count > 1)
        fprintf(stderr, "[%zu/%zu] ", progress->image + 1, progress->image_count);
    fprintf(stderr, "%s: %s %.0f %%", name, asj_stage_name(stage), 100 * done);
    fflush(stderr);
    progress->visible = 1;
}

int32_t cli_progress_report(cli_progress *progress, int32_t stage, double done)
{
    if (progress->enabled) {
        double now = cli_now_ms();
        if (now - progress->last_drawn >= REDRAW_MS) {
            draw(progress, stage, done);
            progress->last_drawn = now;
        }
    }
    return cli_interrupted() != 0;
}

void cli_progress_clear(cli_progress *progress)
{
    if (progress->visible)
        fputs("\r\033[K", stderr);
    progress->visible = 0;
}
