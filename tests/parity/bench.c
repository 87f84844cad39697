/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "bench.h"
#include "copy.h"
#include "operations.h"
#include "targets.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#ifdef ASJ_HAVE_OPENCL
#include "cl/runtime.h"
#endif

#define RUNS 15

typedef struct measured {
    target *target;
    double limit;       /* GB/s of a copy */
    double times[RUNS]; /* ms of one run */
    double kernels;     /* of these, in kernels */
    double processor;   /* what all threads of this process spend on a run: of a device that is this processor, its work */
} measured;

static int by_value(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

/* Of a variant, the processor time of this thread: what others do on the machine counts less than in wall time. A device has
 * threads of its own. */
static double clock_ms(const target *t)
{
    struct timespec now;
    clock_gettime(t->form == FORM_NONE ? CLOCK_THREAD_CPUTIME_ID : CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static double time_once(const operation *op, target *t, const subject *s, uint16_t *scratch, void *output, int repeat)
{
    const double start = clock_ms(t);
    for (int i = 0; i < repeat; i++)
        op->run(t->context, s, scratch, output);
    return (clock_ms(t) - start) / repeat;
}

static double process_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* Time that the device itself takes for one run. */
static double kernel_time(const operation *op, target *t, const subject *s, uint16_t *scratch, void *output)
{
    double sum = 0;
#ifdef ASJ_HAVE_OPENCL
    asj_cl_time times[64];
    if (t->form == FORM_NONE || asj_cl_profile(t->context, 1) != ASJ_OK)
        return 0;
    op->run(t->context, s, scratch, output);
    const int32_t count = asj_cl_get_times(t->context, times, 64);
    for (int32_t i = 0; i < count && i < 64; i++)
        sum += times[i].bytes ? 0 : times[i].ms; /* transfers apart */
    asj_cl_profile(t->context, 0);
#else
    (void)op;
    (void)t;
    (void)s;
    (void)scratch;
    (void)output;
#endif
    return sum;
}

static void show(const operation *op, const measured *m, const subject *s, double reference)
{
    const double ms = m->times[RUNS / 2];
    printf("%-14s %-40s %9.3f ms %8.3f ns/px %7.2f x", op->name, m->target->name, ms, 1e6 * ms / op->pixels(s), reference / ms);
    if (m->target->form != FORM_NONE)
        printf(", processor %8.3f ms", m->processor);
    if (op->bytes) {
        const double on_device = m->target->form == FORM_NONE ? ms : m->kernels, rate = 1e-6 * op->bytes(s) / on_device;
        if (m->target->form != FORM_NONE)
            printf(", kernels %8.3f ms", m->kernels);
        printf(", %6.2f GB/s, %5.1f %% of a copy", rate, 100 * rate / m->limit);
    }
    printf("\n");
}

static void bench_operation(const operation *op, const subject *s, measured *all, int32_t count, uint16_t *scratch, void *output)
{
    const double once = time_once(op, all[0].target, s, scratch, output, 1);
    const int repeat = once > 2 ? 1 : 1 + (int)(2 / (once + 1e-3));
    for (int32_t i = 0; i < count; i++) { /* builds kernels, brings the planes to the device */
        target_prepare(all[i].target, s->frame.stride);
        if (op->whole || all[i].target->form == FORM_NONE)
            op->run(all[i].target->context, s, scratch, output);
    }
    for (int run = 0; run < RUNS; run++)
        for (int32_t i = 0; i < count; i++)
            if (op->whole || all[i].target->form == FORM_NONE)
                all[i].times[run] = time_once(op, all[i].target, s, scratch, output, repeat);
    for (int32_t i = 0; i < count; i++) {
        if (!op->whole && all[i].target->form != FORM_NONE)
            continue;
        const double before = process_ms();
        for (int run = 0; run < RUNS; run++)
            op->run(all[i].target->context, s, scratch, output);
        all[i].processor = (process_ms() - before) / RUNS;
        all[i].kernels = kernel_time(op, all[i].target, s, scratch, output);
        qsort(all[i].times, RUNS, sizeof all[i].times[0], by_value);
        show(op, &all[i], s, all[0].times[RUNS / 2]);
    }
}

static int bench_all(measured *all, int32_t count, int width, int height)
{
    subject s;
    int failed = 1;
    if (subject_create(all[0].target->context, width, height, CONTENT_SCENE, 7, 2, 1, &s)) {
        size_t most = 0;
        for (size_t i = 0; i < operation_count; i++)
            most = operations[i].size(&s) > most ? operations[i].size(&s) : most;
        void *scratch = NULL, *output = malloc(most);
        if (posix_memalign(&scratch, ASJ_ALIGNMENT, s.scratch_size * sizeof(uint16_t)) != 0)
            scratch = NULL;
        for (size_t i = 0; scratch && output && i < operation_count; i++)
            bench_operation(&operations[i], &s, all, count, scratch, output);
        failed = !scratch || !output;
        free(output);
        free(scratch);
    }
    subject_free(&s);
    return failed;
}

/* The targets of a list that are there; devices as the library uses them. */
static int32_t choose(target_list *list, int32_t from, measured *all, int32_t count, double host)
{
    for (int32_t i = from; i < list->count; i++) {
        target *t = &list->targets[i];
        if (!t->context || t->form > FORM_OWN)
            continue;
        all[count].target = t;
        all[count].limit = t->form == FORM_NONE ? host : copy_rate_device(t->context);
        printf("%-40s copies %.2f GB/s%s\n", t->name, all[count].limit, t->form == FORM_NONE ? " in one thread" : "");
        count++;
    }
    return count;
}

int bench_run(int width, int height)
{
    static target_list variants, devices;
    static measured all[2 * MOST_TARGETS];
    int failed = 1;
    if (targets_open(0, &variants) >= 0 && targets_open(1, &devices) >= 0) {
        int32_t count = choose(&variants, 0, all, 0, copy_rate_host());
        count = choose(&devices, 1, all, count, 0);
        printf("%d x %d pixels, medians of %d\n", width, height, RUNS);
        failed = bench_all(all, count, width, height);
    }
    targets_close(&variants);
    targets_close(&devices);
    return failed;
}
