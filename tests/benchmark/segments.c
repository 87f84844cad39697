/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_find_segments(): how its time and memory grow with the number of junctions and the length of their branches. */
#define _POSIX_C_SOURCE 200809L

#include "measure.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#define SIDE 4000 /* px */
#define PI 3.14159265358979323846

static const char help[] =
    "usage: segments [--most N] [--quick]\n"
    "\n"
    "Junctions with two branches each that lie anywhere in 4000 x 4000 pixels, 1/4, 1/2 and all of N (50000) of them, with\n"
    "branches of 30, 100, 300 and 1000 px: seconds of processor time that asj_find_segments() takes, bytes of memory for each\n"
    "junction at most, and how many segments come of it. --quick: 1000 junctions at most.\n";

typedef struct use {
    size_t now, most;
} use;

/* Before each block its size. */
static void *allocate(void *user, size_t size)
{
    use *u = user;
    size_t *block = malloc(size + 16);
    if (!block)
        return NULL;
    *block = size;
    u->now += size;
    u->most = u->now > u->most ? u->now : u->most;
    return (char *)block + 16;
}

static void release(void *user, void *block)
{
    use *u = user;
    if (!block)
        return;
    size_t *own = (size_t *)(void *)((char *)block - 16);
    u->now -= *own;
    free(own);
}

static double between(uint64_t *random, double low, double high)
{
    *random = *random * 6364136223846793005u + 1442695040888963407u;
    return low + (high - low) * (double)(*random >> 11) / 9007199254740992.0;
}

static void draw(asj_junction *junctions, int32_t count, double length)
{
    uint64_t random = 1;
    memset(junctions, 0, (size_t)count * sizeof *junctions);
    for (int32_t k = 0; k < count; k++) {
        asj_junction *j = &junctions[k];
        j->x = (float)between(&random, 0, SIDE);
        j->y = (float)between(&random, 0, SIDE);
        j->branch_count = 2;
        for (int32_t b = 0; b < 2; b++) {
            j->branches[b].angle = (float)between(&random, 0, 2 * PI);
            j->branches[b].length = (float)(length * between(&random, 0.9, 1.1));
        }
    }
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static int measure(asj_context *context, use *memory, asj_junction *junctions, int32_t count, double length)
{
    asj_segment_list *list = NULL;
    draw(junctions, count, length);
    memory->most = memory->now;
    const size_t before = memory->now;
    const double start = seconds();
    if (asj_find_segments(context, junctions, (size_t)count, NULL, 0, &list) != ASJ_OK)
        return -1;
    const double took = seconds() - start;
    printf("%9d %9.0f %9.3f %9.0f %9lu\n", (int)count, length, took, (double)(memory->most - before) / count,
           (unsigned long)list->count);
    fflush(stdout);
    asj_segment_list_free(&list);
    return 0;
}

static int run(int32_t most)
{
    static const double lengths[] = {30, 100, 300, 1000};
    use memory = {0, 0};
    asj_context_options options;
    asj_context *context = NULL;
    asj_junction *junctions = malloc((size_t)most * sizeof *junctions);
    asj_context_options_init(&options);
    options.threads = 1;
    options.allocator = (asj_allocator){allocate, release, &memory};
    int result = junctions && asj_context_create(&options, &context) == ASJ_OK ? 0 : -1;
    printf("%9s %9s %9s %9s %9s\n", "junctions", "px", "s", "bytes", "segments");
    for (int32_t part = 4; result == 0 && part >= 1; part /= 2)
        for (size_t l = 0; result == 0 && l < sizeof lengths / sizeof *lengths; l++)
            result = measure(context, &memory, junctions, most / part, lengths[l]);
    asj_context_free(&context);
    free(junctions);
    return result;
}

int main(int argc, char **argv)
{
    static const struct option longs[] = {{"most", 1, NULL, 'm'}, {"quick", 0, NULL, 'q'}, {NULL, 0, NULL, 0}};
    int32_t most = 50000;
    int c, result = 0;
    while (result == 0 && (c = getopt_long(argc, argv, "", longs, NULL)) != -1) {
        result = c == 'm' ? measure_number(optarg, 4, 10000000, &most) : c == 'q' ? 0 : -1;
        most = c == 'q' ? 1000 : most;
    }
    if (result != 0 || optind < argc) {
        fputs(help, stderr);
        return 2;
    }
    return run(most) == 0 ? 0 : 1;
}
