/* SPDX-License-Identifier: BSD-2-Clause */
#include "machine.h"
#include "measure.h"

#include "core/context.h"

#include <stdlib.h>
#include <string.h>

#define COPY_BYTES ((size_t)128 << 20)
#define ROUNDS 2000000
#define CHAINS 12 /* independent, so that no result is waited for */
#define RUNS 5

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

/* Milliseconds of the fastest of some runs by all threads. */
static double time_loop(const loops *l, int whole, int32_t threads)
{
    volatile double sink = 0;
    double least = 0;
    for (int run = 0; run < RUNS; run++) {
        const double start = asj_clock_ms();
        double sum = 0;
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(static) reduction(+ : sum)
#endif
        for (int32_t t = 0; t < threads; t++)
            sum += whole ? l->whole(ROUNDS, (uint16_t)(3 + t), 7) : l->floating(ROUNDS, 0.999, 1e-3);
        sink = sink + sum;
        const double ms = asj_clock_ms() - start;
        least = run == 0 || ms < least ? ms : least;
    }
    return least;
}

static double copy_rate(char *from, char *to, int32_t threads)
{
    const size_t part = COPY_BYTES / (size_t)threads;
    double least = 0;
    memset(from, 1, COPY_BYTES);
    memset(to, 2, COPY_BYTES);
    for (int run = 0; run < RUNS; run++) {
        const double start = asj_clock_ms();
#ifdef _OPENMP
#pragma omp parallel for num_threads(threads) schedule(static)
#endif
        for (int32_t t = 0; t < threads; t++)
            memcpy(to + (size_t)t * part, from + (size_t)t * part, part);
        const double ms = asj_clock_ms() - start;
        least = run == 0 || ms < least ? ms : least;
    }
    return 2.0 * (double)COPY_BYTES / (least * 1e-3);
}

int machine_measure(int32_t threads, machine_limits *limits)
{
    const loops l = choose();
    const double rounds = 2.0 * CHAINS * ROUNDS * threads;
    char *from = malloc(COPY_BYTES), *to = malloc(COPY_BYTES);
    const int result = from && to ? 0 : -1;
    if (result == 0)
        limits->bytes = copy_rate(from, to, threads);
    limits->whole = rounds * l.width / 2 / (time_loop(&l, 1, threads) * 1e-3);
    limits->floating = rounds * l.width / 8 / (time_loop(&l, 0, threads) * 1e-3);
    limits->width = l.width;
    free(from);
    free(to);
    return result;
}
