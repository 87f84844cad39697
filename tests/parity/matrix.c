/* SPDX-License-Identifier: BSD-2-Clause */
#define _POSIX_C_SOURCE 200809L
#include "matrix.h"
#include "operations.h"
#include "tables.h"

#ifdef ASJ_HAVE_OPENCL
#include "cl/cl.h"
#endif

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

typedef void (*any_operation)(void);

#define SLOT(table, member) {#table "." #member, offsetof(asj_tables, table.member)}
static const struct {
    const char *name;
    size_t at;
} slots[] = {
    SLOT(image, luma),
    SLOT(pyramid, blur_row), SLOT(pyramid, sample),
    SLOT(gradient, planes), SLOT(gradient, slide), SLOT(gradient, normalise),
    SLOT(field, rows), SLOT(field, branches), SLOT(field, tile), SLOT(field, pixels),
    SLOT(isotropic, rows), SLOT(isotropic, band),
    SLOT(line, sums), SLOT(line, profile),
    SLOT(arc, place), SLOT(arc, sum),
    SLOT(scan, rays),
    SLOT(strip, sums),
    SLOT(wedge, add_up),
    SLOT(edge, rows), SLOT(edge, fan),
    SLOT(patch, levels), SLOT(patch, normalise), SLOT(patch, products),
    SLOT(describe, frames),
    SLOT(bound, above),
    SLOT(rank, partners),
    SLOT(disc, compare),
    SLOT(gate, pass),
    SLOT(near, lines), SLOT(near, places),
    SLOT(ratio, lines), SLOT(ratio, places),
};
#define SLOTS (sizeof slots / sizeof slots[0])

/* The tables hold nothing but operations, one after the other: each must have its line above. */
static int all_named(void)
{
    const size_t first = offsetof(asj_tables, image), count = (sizeof(asj_tables) - first) / sizeof(any_operation);
    for (size_t i = 0; i < SLOTS && SLOTS == count; i++)
        if (slots[i].at != first + i * sizeof(any_operation)) {
            fprintf(stderr, "parity: %s stands elsewhere in the tables (matrix.c lists them in order)\n", slots[i].name);
            return 0;
        }
    if (SLOTS != count)
        fprintf(stderr, "parity: the tables have %zu operations, matrix.c names %zu\n", count, SLOTS);
    return SLOTS == count;
}

static int same(const asj_tables *a, const asj_tables *b, size_t slot)
{
    return memcmp((const char *)a + slots[slot].at, (const char *)b + slots[slot].at, sizeof(any_operation)) == 0;
}

/* ---- list ---- */

/* What a column says of an operation. */
static const char *cell(const asj_tables *forms, const int *there, int32_t simd, size_t slot)
{
    if (!there[simd])
        return "?";
    if (same(&forms[simd], &forms[ASJ_SIMD_REFERENCE], slot))
        return "-";
    return simd == ASJ_SIMD_AVX512 && same(&forms[simd], &forms[ASJ_SIMD_AVX2], slot) ? "avx2" : "own";
}

int matrix_list(void)
{
    static asj_tables forms[ASJ_SIMD_COUNT + 1];
    int there[ASJ_SIMD_COUNT + 1] = {0};
    for (int32_t simd = ASJ_SIMD_REFERENCE; simd < ASJ_SIMD_COUNT; simd++)
        there[simd] = asj_tables_fill(simd, &forms[simd]);
    asj_tables_fill(ASJ_SIMD_REFERENCE, &forms[ASJ_SIMD_COUNT]);
#ifdef ASJ_HAVE_OPENCL
    asj_cl_fill(&forms[ASJ_SIMD_COUNT].ops);
    there[ASJ_SIMD_COUNT] = 1;
#endif
    if (!all_named())
        return 1;
    printf("%-20s", "operation");
    for (int32_t simd = ASJ_SIMD_REFERENCE + 1; simd <= ASJ_SIMD_COUNT; simd++)
        printf(" %-7s", simd == ASJ_SIMD_COUNT ? "opencl" : asj_simd_name(simd));
    printf("\n");
    for (size_t i = 0; i < SLOTS; i++) {
        printf("%-20s", slots[i].name);
        for (int32_t simd = ASJ_SIMD_REFERENCE + 1; simd <= ASJ_SIMD_COUNT; simd++)
            printf(" %-7s", cell(forms, there, simd, i));
        printf("\n");
    }
    return 0;
}

/* ---- coverage ---- */

enum { CALLED = 42 };

/* In place of an operation: never returns, so that it fits any. */
static void called(void)
{
    _Exit(CALLED);
}

/* Whether a check runs the operation: in a process of its own, with the trap in its place. */
static int reaches(const operation *check, size_t slot, asj_context *context, const subject *s)
{
    const any_operation trap = called;
    int status = 0;
    fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        static asj_tables tables;
        uint16_t *scratch = malloc(s->scratch_size * sizeof *scratch + ASJ_ALIGNMENT);
        void *output = malloc(check->size(s));
        asj_tables_fill(ASJ_SIMD_REFERENCE, &tables);
        memcpy((char *)&tables + slots[slot].at, &trap, sizeof trap);
        context->ops = &tables.ops;
        _Exit(scratch && output && check->run(context, s, scratch, output) == ASJ_OK ? 0 : 1);
    }
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == CALLED;
}

int matrix_coverage(int sabotage)
{
    asj_context_options options;
    asj_context *context;
    subject s;
    int missing = 0;
    asj_context_options_init(&options);
    options.backend = ASJ_BACKEND_CPU;
    options.simd = ASJ_SIMD_REFERENCE;
    options.threads = 1;
    if (!all_named() || asj_context_create(&options, &context) != ASJ_OK)
        return 1;
    const int ready = subject_create(context, 64, 40, CONTENT_SCENE, 5, 1.5, 1, &s);
    for (size_t i = 0; i < SLOTS && ready; i++) {
        int count = 0;
        printf("%-20s", slots[i].name);
        for (size_t n = 0; n < operation_count - (sabotage ? 1 : 0); n++)
            if (reaches(&operations[n], i, context, &s))
                printf("%s%s", count++ ? ", " : " ", operations[n].name);
        printf(count ? "\n" : " NO CHECK\n");
        missing += count == 0;
    }
    subject_free(&s);
    asj_context_free(&context);
    printf(missing ? "%d operations that no check runs\n" : "every operation is compared\n", missing);
    return !ready || missing > 0;
}
