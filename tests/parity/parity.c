/* SPDX-License-Identifier: BSD-2-Clause */
/* Every variant of every operation against the reference, bit for bit; with --devices, every OpenCL device instead, with the
 * operations that devices have; with --bench, times of all of them; with --list, which form has which operation; with --coverage,
 * which operation is compared by which check:
 *     parity [--devices] [--bench] [--list] [--coverage] [--quick | --fewer] [--seed N] [--rounds N] [--sabotage]
 * --quick: three small images; --fewer: all sizes and contents, with one of four radii each.
 * Exit status 0 = all equal, 1 = not, 77 = nothing but the reference is there. */
#define _POSIX_C_SOURCE 200809L
#include "bench.h"
#include "matrix.h"
#include "operations.h"
#include "targets.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GUARD 256 /* bytes on either side of outputs and behind the scratch */
#define PATTERN 0xa5

typedef struct run_state {
    target_list list;
    uint64_t seed;
    int quick;
    int fewer;
    int sabotage; /* flip a bit of every target's output: the program must then fail */
    int failed;
} run_state;

static int guards_hold(const uint8_t *block, size_t size)
{
    for (size_t i = 0; i < GUARD; i++)
        if (block[i] != PATTERN || block[GUARD + size + i] != PATTERN)
            return 0;
    return 1;
}

/* Runs an operation into a guarded block, which the caller frees; NULL with a word in *fault when it failed or a guard was hit. */
static uint8_t *produce(const operation *op, target *t, const subject *s, const char **fault)
{
    const size_t size = op->size(s), scratch_size = s->scratch_size * sizeof(uint16_t);
    uint8_t *output = malloc(size + 2 * GUARD);
    void *block;
    if (!output || posix_memalign(&block, ASJ_ALIGNMENT, scratch_size + 2 * GUARD) != 0)
        abort();
    uint8_t *scratch = block;
    memset(output, PATTERN, size + 2 * GUARD);
    memset(scratch, PATTERN, scratch_size + 2 * GUARD);
    target_prepare(t, s->frame.stride);
    const asj_status status = op->run(t->context, s, (uint16_t *)(scratch + GUARD), output + GUARD);
    const int ok = guards_hold(output, size) && guards_hold(scratch, scratch_size);
    free(scratch);
    *fault = status != ASJ_OK ? asj_context_message(t->context) : ok ? NULL : "written outside its memory";
    if (!*fault)
        return output;
    free(output);
    return NULL;
}

static void describe(const char *what, const operation *op, const target *t, const subject *s)
{
    const asj_detect_options *o = &s->options;
    printf("FAIL %s: %s of %s at %d x %d, content %s, field radius %d, width %g, radii %#x, seed %llu\n", what, op->name,
           t->name, (int)s->frame.width, (int)s->frame.height, content_name(s->content), (int)o->field_radius,
           o->sector_width, (unsigned)o->isotropic_radii, (unsigned long long)s->seed);
}

static int same(const run_state *state, const operation *op, target *t, const subject *s, const uint8_t *expected)
{
    const size_t size = op->size(s);
    const char *fault;
    uint8_t *output = produce(op, t, s, &fault);
    if (output && state->sabotage)
        output[GUARD + size / 2] ^= 4;
    const int equal = output && memcmp(output, expected, size + 2 * GUARD) == 0;
    if (!equal)
        describe(output ? "differs" : fault, op, t, s);
    for (size_t i = 0, shown = 0; output && i < size && shown < 4; i++)
        if (output[GUARD + i] != expected[GUARD + i] && ++shown)
            printf("    byte %zu is %#x, expected %#x\n", i, output[GUARD + i], expected[GUARD + i]);
    free(output);
    return equal;
}

static void compare(run_state *state, const operation *op, const subject *s)
{
    target *targets = state->list.targets;
    const char *fault;
    uint8_t *expected = produce(op, &targets[0], s, &fault);
    if (!expected) {
        describe(fault, op, &targets[0], s);
        state->failed = 1;
        return;
    }
    for (int32_t i = 1; i < state->list.count; i++)
        if (targets[i].context && (op->whole || targets[i].form == FORM_NONE)) {
            if (!same(state, op, &targets[i], s, expected))
                state->failed = 1;
            targets[i].compared++;
        }
    free(expected);
}

static void compare_all(run_state *state, int32_t width, int32_t height, int32_t content, int32_t radius, double tau)
{
    subject s;
    if (!subject_create(state->list.targets[0].context, width, height, content, radius, tau, state->seed++, &s))
        state->failed = 1;
    else
        for (size_t i = 0; i < operation_count; i++)
            compare(state, &operations[i], &s);
    subject_free(&s);
}

/* For simulators, which take long. */
static void quick_round(run_state *state)
{
    compare_all(state, 1, 1, CONTENT_RANDOM, 3, 1);
    compare_all(state, 20, 5, CONTENT_SCENE, 7, 2);
    compare_all(state, 9, 9, CONTENT_SATURATED, 5, 1.5);
}

static void round_of_cases(run_state *state, int fewer)
{
    static const int32_t sizes[][2] = {{1, 1},   {1, 40},  {40, 1},  {2, 2},    {15, 3},   {16, 16},  {17, 5},
                                       {31, 9},  {33, 40}, {64, 7},  {127, 20}, {128, 18}, {129, 31}, {300, 140}};
    static const int32_t radii[] = {3, 5, 7, 9};
    static const double widths[] = {2, 1, 3, 1.5};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++)
        for (int32_t content = 0; content < CONTENT_COUNT; content++)
            for (size_t r = 0; r < 4; r++)
                if (!fewer || r == (i + (size_t)content) % 4)
                    compare_all(state, sizes[i][0], sizes[i][1], content, radii[r], widths[(r + i) % 4]);
}

static int report(const run_state *state)
{
    for (int32_t i = 1; i < state->list.count; i++) {
        const target *t = &state->list.targets[i];
        if (t->context)
            printf("%-9s %ld comparisons with the reference\n", t->name, t->compared);
        else
            printf("%-9s not tested: not built, or this processor lacks it\n", t->name);
    }
    printf(state->failed ? "FAILED\n" : "all equal\n");
    return state->failed;
}

static int work(run_state *state, int devices, long rounds)
{
    const int32_t count = targets_open(devices, &state->list);
    if (count < 0)
        return 1;
    if (count == 0)
        return targets_missing(&state->list);
    printf("first seed %llu\n", (unsigned long long)state->seed);
    for (long i = 0; i < rounds; i++)
        if (state->quick)
            quick_round(state);
        else
            round_of_cases(state, state->fewer);
    return report(state);
}

int main(int argc, char **argv)
{
    run_state state = {0};
    int bench = 0, coverage = 0, devices = 0;
    long rounds = 1;
    state.seed = 1;
    for (int i = 1; i < argc; i++) {
        if (strcmp(argv[i], "--bench") == 0)
            bench = 1;
        else if (strcmp(argv[i], "--devices") == 0)
            devices = 1;
        else if (strcmp(argv[i], "--list") == 0)
            return matrix_list();
        else if (strcmp(argv[i], "--coverage") == 0)
            coverage = 1;
        else if (strcmp(argv[i], "--quick") == 0)
            state.quick = 1;
        else if (strcmp(argv[i], "--fewer") == 0)
            state.fewer = 1;
        else if (strcmp(argv[i], "--sabotage") == 0)
            state.sabotage = 1;
        else if (strcmp(argv[i], "--seed") == 0 && i + 1 < argc)
            state.seed = strtoull(argv[++i], NULL, 10);
        else if (strcmp(argv[i], "--rounds") == 0 && i + 1 < argc)
            rounds = strtol(argv[++i], NULL, 10);
        else {
            fprintf(stderr, "usage: parity [--devices] [--bench] [--list] [--coverage] [--quick | --fewer] [--seed N] "
                            "[--rounds N] [--sabotage]\n");
            return 2;
        }
    }
    const int status = coverage ? matrix_coverage(state.sabotage) : bench ? bench_run(1052, 780) : work(&state, devices, rounds);
    targets_close(&state.list);
    return status;
}
