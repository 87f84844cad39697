/* SPDX-License-Identifier: BSD-2-Clause */
/* Signals set a flag that progress callbacks look at: results are whole or absent. */
#define _XOPEN_SOURCE 700
#include "interrupt.h"

#include <signal.h>
#include <string.h>

static volatile sig_atomic_t signal_seen; /* a signal handler has no other way to say something */

static void note_signal(int number)
{
    signal_seen = number;
}

void cli_interrupt_install(void)
{
    static const int stopping[] = {SIGINT, SIGTERM, SIGHUP};
    struct sigaction action, old;
    memset(&action, 0, sizeof action);
    sigemptyset(&action.sa_mask);
    action.sa_handler = note_signal;
    action.sa_flags = (int)(SA_RESTART | SA_RESETHAND);
    for (size_t i = 0; i < sizeof stopping / sizeof stopping[0]; i++)
        if (sigaction(stopping[i], NULL, &old) == 0 && old.sa_handler != SIG_IGN) /* nohup stays in force */
            sigaction(stopping[i], &action, NULL);
    action.sa_handler = SIG_IGN;
    action.sa_flags = 0;
    sigaction(SIGPIPE, &action, NULL);
    sigaction(SIGXFSZ, &action, NULL); /* a file beyond the limit of the shell is then an error like a full disk */
}

int cli_interrupted(void)
{
    return signal_seen;
}
