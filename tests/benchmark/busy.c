/* SPDX-License-Identifier: BSD-2-Clause */
/* Detection on a machine that has other things to do: time with one and with more threads, alone and beside processes that compute
 * without end, which this program starts itself. */
#define _POSIX_C_SOURCE 200809L

#include "measure.h"

#include <getopt.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define MOST_RUNS 999
#define MOST_LOAD 64

static const char help[] =
    "usage: busy [--threads N] [--load N] [--runs N] [--images N] [--quick]\n"
    "\n"
    "Detects the junctions of the sample room at three sizes with one and with N threads (2), alone and beside N processes (2)\n"
    "that compute, all taking turns, and prints milliseconds an image: medians of N runs (15) of N images in a row (40) and the\n"
    "worst, and the time with more threads over that with one. --quick: three runs of five images of the smallest size.\n";

typedef struct settings {
    int32_t threads, load, runs, images;
    int quick;
} settings;

typedef struct times {
    double ms[2][2][MOST_RUNS]; /* alone or busy, one or more threads */
} times;

static double clock_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

/* Ends with its parent. */
static void compute(pid_t parent)
{
    volatile unsigned value = 0;
    while (getppid() == parent)
        for (int i = 0; i < 1000000; i++)
            value = value * 5 + 1;
    _exit(0);
}

static int32_t start_load(int32_t wanted, pid_t *load)
{
    const pid_t parent = getpid();
    int32_t count = 0;
    for (; count < wanted; count++) {
        load[count] = fork();
        if (load[count] < 0)
            break;
        if (load[count] == 0)
            compute(parent);
    }
    return count;
}

static void end_load(int32_t count, const pid_t *load)
{
    for (int32_t i = 0; i < count; i++) {
        kill(load[i], SIGKILL);
        waitpid(load[i], NULL, 0);
    }
}

/* Images in a row, milliseconds of one. In a short row one thread may keep a processor to itself, as a process that has slept may
 * for tens of ms; in a longer one the load has its share. */
static double time_row(int32_t images, asj_context *context, const asj_image *image)
{
    const double start = clock_ms();
    for (int32_t i = 0; i < images; i++) {
        asj_detection *found = NULL;
        if (asj_detect(context, image, NULL, &found) != ASJ_OK)
            return -1;
        asj_detection_free(&found);
    }
    return (clock_ms() - start) / images;
}

static int measure(const settings *set, const asj_image *image, asj_context *const contexts[2], times *all)
{
    for (int32_t run = -1; run < set->runs; run++)
        for (int busy = 0; busy < 2; busy++) {
            pid_t load[MOST_LOAD];
            double ms[2];
            const int32_t started = busy ? start_load(set->load, load) : 0;
            for (int turn = 0; turn < 2; turn++) { /* either first in turn */
                const int more = (turn + run) & 1;
                ms[more] = time_row(set->images, contexts[more], image);
            }
            end_load(started, load);
            if (ms[0] < 0 || ms[1] < 0)
                return -1;
            for (int more = 0; run >= 0 && more < 2; more++)
                all->ms[busy][more][run] = ms[more];
        }
    return 0;
}

static void print(const settings *set, const asj_image *image, times *all)
{
    for (int busy = 0; busy < 2; busy++) {
        double median[2];
        for (int more = 0; more < 2; more++)
            median[more] = measure_median(all->ms[busy][more], set->runs); /* sorted now */
        printf("%4dx%-4d  %-5s %9.2f %9.2f %9.2f %9.2f %9.2f\n", (int)image->width, (int)image->height, busy ? "busy" : "alone",
               median[0], all->ms[busy][0][set->runs - 1], median[1], all->ms[busy][1][set->runs - 1], median[1] / median[0]);
    }
    fflush(stdout);
}

static int run(const settings *set)
{
    static const int32_t sizes[][2] = {{320, 240}, {640, 480}, {1052, 780}};
    static times all;
    asj_context *contexts[2] = {measure_context(1), measure_context(set->threads)};
    int result = contexts[0] && contexts[1] ? 0 : -1;
    printf("%-9s  %-5s %9s %9s %6d threads %9s\n", "", "", "1 thread", "worst", (int)set->threads, "worst   over 1");
    for (int i = 0; result == 0 && i < (set->quick ? 1 : 3); i++) {
        uint8_t *pixels = measure_room(0, sizes[i][0], sizes[i][1]);
        const asj_image image = {pixels, ASJ_FORMAT_GRAY8, sizes[i][0], sizes[i][1], 0, 0};
        result = pixels ? measure(set, &image, contexts, &all) : -1;
        if (result == 0)
            print(set, &image, &all);
        free(pixels);
    }
    asj_context_free(&contexts[0]);
    asj_context_free(&contexts[1]);
    return result;
}

int main(int argc, char **argv)
{
    static const struct option longs[] = {{"threads", 1, NULL, 't'}, {"load", 1, NULL, 'l'}, {"runs", 1, NULL, 'r'},
                                          {"images", 1, NULL, 'i'}, {"quick", 0, NULL, 'q'}, {NULL, 0, NULL, 0}};
    settings set = {2, 2, 15, 40, 0};
    int c, result = 0;
    while (result == 0 && (c = getopt_long(argc, argv, "", longs, NULL)) != -1) {
        result = c == 't' ? measure_number(optarg, 1, 256, &set.threads) :
                 c == 'l' ? measure_number(optarg, 0, MOST_LOAD, &set.load) :
                 c == 'r' ? measure_number(optarg, 1, MOST_RUNS, &set.runs) :
                 c == 'i' ? measure_number(optarg, 1, MOST_RUNS, &set.images) : c == 'q' ? 0 : -1;
        if (c == 'q') {
            set.quick = 1;
            set.runs = 3;
            set.images = 5;
        }
    }
    if (result != 0 || optind < argc) {
        fputs(help, stderr);
        return 2;
    }
    return run(&set) == 0 ? 0 : 1;
}
