/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_INTERRUPT_H
#define ASJ_CLI_INTERRUPT_H

/* From now on SIGINT, SIGTERM and SIGHUP only leave a note, so that the work in hand can be given up in order; a second one ends
 * the program at once. SIGPIPE is ignored: writing to a closed pipe fails then, without a word where it is standard output. */
void cli_interrupt_install(void);

/* The signal that came, or 0. */
int cli_interrupted(void);

#endif
