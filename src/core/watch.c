/* SPDX-License-Identifier: BSD-2-Clause */
/* A loop of many threads asks the caller whether to go on: one of them asks, the others see the answer. See watch.h. */
#include "watch.h"

#define SHORT 0.05     /* ms: turns between two looks at the clock, which takes 30 ns, need not take longer, .. */
#define MOST_TURNS 255 /* .. and are no more than that, in case some take long */

void asj_watch_start(asj_watch *watch, asj_context *context, int32_t stage)
{
    watch->context = context;
    watch->stage = stage;
    watch->stopped = 0;
    watch->next_ms = context->asked_ms + context->pause_ms; /* not from now on: many short loops in a row would never ask */
    watch->read_ms = 0;
    watch->turns = watch->left = 0;
}

/* Is it time to ask? */
static int is_time(asj_watch *watch)
{
    if (watch->left > 0) {
        watch->left--;
        return 0;
    }
    const double now = asj_clock_ms();
    const int due = now >= watch->next_ms;
    watch->turns = due ? 0 : now - watch->read_ms > SHORT ? watch->turns / 4 : 2 * watch->turns + 1;
    if (watch->turns > MOST_TURNS)
        watch->turns = MOST_TURNS;
    watch->left = watch->turns;
    watch->read_ms = now;
    return due;
}

int asj_watch_stops(asj_watch *watch, const asj_part *part)
{
    if (!watch->context->options.progress)
        return 0;
    int32_t stopped = __atomic_load_n(&watch->stopped, __ATOMIC_RELAXED);
    if (stopped || (part && !part->caller) || !is_time(watch))
        return stopped;
    stopped = asj_progress(watch->context, watch->stage, 0) != ASJ_OK; /* no farther than before: progress never falls */
    watch->next_ms = asj_clock_ms() + watch->context->pause_ms;
    __atomic_store_n(&watch->stopped, stopped, __ATOMIC_RELAXED);
    return stopped;
}

asj_status asj_watch_end(const asj_watch *watch)
{
    return watch->stopped ? ASJ_ERROR_CANCELLED : ASJ_OK;
}
