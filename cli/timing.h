/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_TIMING_H
#define ASJ_CLI_TIMING_H

#include <asj/detect.h>
#include <asj/match.h>

/* Print wall times in milliseconds on standard error: the stages of a detection or of a match, what comes beside them, and
 * reading and writing. The context is the one that did the work. */
void cli_timing_detection(const char *name, const asj_context *context, const asj_detection *detection);
void cli_timing_match(const char *name, const asj_context *context, const asj_match_result *result);
void cli_timing_work(const char *work, double ms);
void cli_timing_files(double read_ms, double write_ms);

#endif
