/* SPDX-License-Identifier: BSD-2-Clause */
#include "machine.h"
#include "measure.h"

#include "core/threads.h"

#include <stdlib.h>
#include <string.h>

#define COPY_BYTES ((size_t)128 << 20)
#define ROUNDS 2000000
#define CHAINS 12 /* independent, so that no result is waited for */
#define RUNS 5
#define MOST_THREADS 256

/* Each result depends on the chain before it and on numbers that the compiler does not know, so nothing can be left out. The
 * sanitizers must not look at what wraps around on purpose: unsigned numbers. */
#define PEAK_LOOP(name, type, size, attribute)                                                                                     \
    attribute static double name(int64_t rounds, type factor, type term)                                                          \
    {                                                                                                                              \
        typedef type vector __attribute__((vector_size(size)));                                                                    \
        vector chains[CHAINS], sum = {0}, factors = sum + factor, terms = sum + term;                                              \
        for (int c = 0; c < CHAINS; c++)                                                                                           \
            chains[c] = factors + (type)c;                                                                                         \
        for (int64_t i = 0; i < rounds; i++)                                                                                       \
            for (int c = 0; c < CHAINS; c++)                                                                                       \
                chains[c] = chains[c] * factors + terms;                                                                           \
        for (int c = 0; c < CHAINS; c++)                                                                                           \
            sum += chains[c];                                                                                                      \
        return (double)sum[0];                                                                                                     \
    }

PEAK_LOOP(whole_16, uint16_t, 16, )
PEAK_LOOP(floating_16, double, 16, )
#if defined(__x86_64__)
PEAK_LOOP(whole_32, uint16_t, 32, __attribute__((target("avx2"))))
PEAK_LOOP(floating_32, double, 32, __attribute__((target("avx2"))))
PEAK_LOOP(whole_64, uint16_t, 64, __attribute__((target("avx512bw"))))
PEAK_LOOP(floating_64, double, 64, __attribute__((target("avx512bw"))))
#endif

typedef struct loops {
    double (*whole)(int64_t rounds, uint16_t factor, uint16_t term);
    double (*floating)(int64_t rounds, double factor, double term);
    int32_t width;
} loops;

static loops choose(void)
{
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512bw"))
        return (loops){whole_64, floating_64, 64};
    if (__builtin_cpu_supports("avx2"))
        return (loops){whole_32, floating_32, 32};
#endif
    return (loops){whole_16, floating_16, 16};
}

typedef struct sum_job {
    const loops *l;
    int whole;
    double *sums;
} sum_job;

static void sum_up(const void *data, const asj_part *part)
{
    const sum_job *j = data;
    for (int64_t t = part->first; t < part->end; t++)
        j->sums[t] = j->whole ? j->l->whole(ROUNDS, (uint16_t)(3 + t), 7) : j->l->floating(ROUNDS, 0.999, 1e-3);
}

/* Milliseconds of the fastest of some runs by all threads. */
static double time_loop(const asj_context *context, const loops *l, int whole)
{
    volatile double sink = 0;
    double sums[MOST_THREADS], least = 0;
    const sum_job j = {l, whole, sums};
    for (int run = 0; run < RUNS; run++) {
        const double start = asj_clock_ms();
        asj_parallel(context, context->threads, context->threads, 1, sum_up, &j);
        for (int32_t t = 0; t < context->threads; t++)
            sink = sink + sums[t];
        const double ms = asj_clock_ms() - start;
        least = run == 0 || ms < least ? ms : least;
    }
    return least;
}

typedef struct copy_job {
    char *to;
    const char *from;
    size_t size;
} copy_job;

static void copy(const void *data, const asj_part *part)
{
    const copy_job *j = data;
    for (int64_t t = part->first; t < part->end; t++)
        memcpy(j->to + (size_t)t * j->size, j->from + (size_t)t * j->size, j->size);
}

static double copy_rate(const asj_context *context, char *from, char *to)
{
    const copy_job j = {to, from, COPY_BYTES / (size_t)context->threads};
    double least = 0;
    memset(from, 1, COPY_BYTES);
    memset(to, 2, COPY_BYTES);
    for (int run = 0; run < RUNS; run++) {
        const double start = asj_clock_ms();
        asj_parallel(context, context->threads, context->threads, 1, copy, &j);
        const double ms = asj_clock_ms() - start;
        least = run == 0 || ms < least ? ms : least;
    }
    return 2.0 * (double)COPY_BYTES / (least * 1e-3);
}

int machine_measure(const asj_context *context, machine_limits *limits)
{
    const loops l = choose();
    const double rounds = 2.0 * CHAINS * ROUNDS * context->threads;
    char *from = malloc(COPY_BYTES), *to = malloc(COPY_BYTES);
    const int result = from && to ? 0 : -1;
    if (result == 0)
        limits->bytes = copy_rate(context, from, to);
    limits->whole = rounds * l.width / 2 / (time_loop(context, &l, 1) * 1e-3);
    limits->floating = rounds * l.width / 8 / (time_loop(context, &l, 0) * 1e-3);
    limits->width = l.width;
    free(from);
    free(to);
    return result;
}
