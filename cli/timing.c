/* SPDX-License-Identifier: BSD-2-Clause */
#include "timing.h"
#include "message.h"

#include <stdio.h>

static void print_row(const char *stage, double ms, double total_ms)
{
    fprintf(stderr, "  %-12s %9.2f ms %5.1f %%\n", stage, ms, total_ms > 0 ? 100 * ms / total_ms : 0.0);
}

void cli_timing_print(const char *name, const asj_detection *detection, double read_ms, double write_ms)
{
    cli_note("%s: %d x %d, %s", name, (int)detection->width, (int)detection->height,
             detection->backend == ASJ_BACKEND_OPENCL ? "OpenCL" : "CPU");
    for (int32_t stage = ASJ_STAGE_GRADIENT; stage <= ASJ_STAGE_DECOMPOSE; stage++)
        print_row(asj_stage_name(stage), detection->stage_ms[stage], detection->total_ms);
    print_row("detection", detection->total_ms, detection->total_ms);
    fprintf(stderr, "  %-12s %9.2f ms\n  %-12s %9.2f ms\n", "reading", read_ms, "writing", write_ms);
}
