/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_TIMING_H
#define ASJ_CLI_TIMING_H

#include <asj/detect.h>

/* Prints the wall times of the stages of a detection, of reading and of writing, in milliseconds, on standard error. */
void cli_timing_print(const char *name, const asj_detection *detection, double read_ms, double write_ms);

#endif
