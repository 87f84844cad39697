/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "bench.h"
#include "operations.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#define RUNS 15

static int by_value(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

/* Processor time of this thread in ms: what others do on the machine counts less than in wall time. */
static double clock_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static double time_once(const operation *op, const asj_ops *ops, const subject *s, uint16_t *scratch, void *output, int repeat)
{
    const double start = clock_ms();
    for (int i = 0; i < repeat; i++)
        op->run(ops, s, scratch, output);
    return (clock_ms() - start) / repeat;
}

static void bench_operation(const operation *op, const subject *s, const asj_ops *tables, const int *available, uint16_t *scratch,
                            void *output)
{
    double times[ASJ_VARIANT_COUNT][RUNS];
    const double once = time_once(op, &tables[0], s, scratch, output, 1);
    const int repeat = once > 2 ? 1 : 1 + (int)(2 / (once + 1e-3));
    for (int run = 0; run < RUNS; run++)
        for (int32_t v = 0; v < ASJ_VARIANT_COUNT; v++)
            if (available[v])
                times[v][run] = time_once(op, &tables[v], s, scratch, output, repeat);
    for (int32_t v = 0; v < ASJ_VARIANT_COUNT; v++) {
        if (!available[v])
            continue;
        qsort(times[v], RUNS, sizeof times[v][0], by_value);
        printf("%-14s %-10s %10.3f ns/px %8.2f x\n", op->name, asj_ops_name(v), 1e6 * times[v][RUNS / 2] / op->pixels(s),
               times[0][RUNS / 2] / times[v][RUNS / 2]);
    }
}

int bench_run(asj_context *context, const asj_ops *tables, const int *available)
{
    subject s;
    int failed = 1;
    if (subject_create(context, 640, 480, CONTENT_SCENE, 7, 2, 1, &s)) {
        size_t most = 0;
        for (size_t i = 0; i < operation_count; i++)
            most = operations[i].size(&s) > most ? operations[i].size(&s) : most;
        void *scratch = NULL, *output = malloc(most);
        if (posix_memalign(&scratch, ASJ_ALIGNMENT, s.scratch_size * sizeof(uint16_t)) != 0)
            scratch = NULL;
        for (size_t i = 0; scratch && output && i < operation_count; i++)
            bench_operation(&operations[i], &s, tables, available, scratch, output);
        failed = !scratch || !output;
        free(output);
        free(scratch);
    }
    subject_free(&s);
    return failed;
}
