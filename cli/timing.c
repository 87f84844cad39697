/* SPDX-License-Identifier: BSD-2-Clause */
/* Times of the stages on standard error. */
#include "timing.h"
#include "message.h"

#include <asj/device.h>

#include <stdio.h>

static void print_row(const char *stage, double ms, double total_ms)
{
    fprintf(stderr, "  %-12s %9.2f ms %5.1f %%\n", stage, ms, total_ms > 0 ? 100 * ms / total_ms : 0.0);
}

/* The context may have lost its device since. */
static const char *backend(const asj_context *context, int32_t number)
{
    if (number != ASJ_BACKEND_OPENCL)
        return "CPU";
    const char *device = asj_context_device(context);
    return device ? device : "OpenCL";
}

void cli_timing_detection(const char *name, const asj_context *context, const asj_detection *detection)
{
    cli_note("%s: %d x %d, %s", name, (int)detection->width, (int)detection->height, backend(context, detection->backend));
    for (int32_t stage = ASJ_STAGE_GRADIENT; stage <= ASJ_STAGE_DECOMPOSE; stage++)
        print_row(asj_stage_name(stage), detection->stage_ms[stage], detection->total_ms);
    print_row("detection", detection->total_ms, detection->total_ms);
}

void cli_timing_match(const char *name, const asj_context *context, const asj_match_result *result)
{
    cli_note("%s: %lu and %lu L-junctions, %s", name, (unsigned long)result->l_junction_count1,
             (unsigned long)result->l_junction_count2, backend(context, result->backend));
    /* those of the detector too where it ran in the same call */
    const int32_t first = result->stage_ms[ASJ_STAGE_GRADIENT] > 0 ? ASJ_STAGE_GRADIENT : ASJ_STAGE_PATCHES;
    for (int32_t stage = first; stage <= ASJ_STAGE_ASSIGN; stage++)
        print_row(asj_stage_name(stage), result->stage_ms[stage], result->total_ms);
    print_row("matching", result->total_ms, result->total_ms);
}

void cli_timing_work(const char *work, double ms)
{
    fprintf(stderr, "  %-12s %9.2f ms\n", work, ms);
}

void cli_timing_files(double read_ms, double write_ms)
{
    cli_timing_work("reading", read_ms);
    cli_timing_work("writing", write_ms);
}
