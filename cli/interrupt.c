/* SPDX-License-Identifier: BSD-2-Clause */
/* Signals set a flag that progress callbacks look at: results are whole or absent. */
#include "interrupt.h"
#include "platform.h"

#include <signal.h>

static volatile sig_atomic_t signal_seen; /* a signal handler has no other way to say something */

static void note_signal(int number)
{
    signal_seen = number;
}

void cli_interrupt_install(void)
{
    cli_catch_signals(note_signal);
}

int cli_interrupted(void)
{
    return signal_seen;
}
