/* SPDX-License-Identifier: BSD-2-Clause */
/* Stopping inside of a step: loops over junctions, rays or matches ask at every turn whether the caller wants to stop, and at most
 * every 50 ms the caller is really asked, by the thread that called the library. A clock says when; where turns are short it is not
 * read at each of them. */
#ifndef ASJ_SRC_WATCH_H
#define ASJ_SRC_WATCH_H

#include "threads.h"

#define ASJ_PAUSE 50.0 /* ms */

typedef struct asj_watch {
    asj_context *context;
    int32_t stage;
    int32_t stopped;
    double next_ms; /* when the caller is asked again */
    double read_ms; /* when the clock was read, */
    int32_t turns;  /* .. how many turns of that thread it was not to be read for then, */
    int32_t left;   /* .. and of these are left */
} asj_watch;

void asj_watch_start(asj_watch *watch, asj_context *context, int32_t stage);

/* 1 = leave the loop. From any thread; `part` is what that thread does of the loop, NULL where the loop is not shared out. */
int asj_watch_stops(asj_watch *watch, const asj_part *part);

/* After the loop: ASJ_OK or ASJ_ERROR_CANCELLED. */
asj_status asj_watch_end(const asj_watch *watch);

#endif
