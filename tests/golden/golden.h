/* SPDX-License-Identifier: BSD-2-Clause */
/* What the golden tests of junctions and of matches share: a result is a list of records of numbers, each number with its
 * tolerance. */
#ifndef ASJ_TESTS_GOLDEN_H
#define ASJ_TESTS_GOLDEN_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct golden_column {
    const char *name;
    double tolerance;
    int turn; /* an angle in rad: compared around the circle */
} golden_column;

typedef struct golden_list {
    size_t width; /* numbers of a record */
    size_t count, capacity;
    double *numbers; /* count records */
} golden_list;

/* A new record, zeroed; NULL when there is no memory. */
double *golden_add(golden_list *list);

typedef struct golden_kind {
    const char *name;      /* "junctions" */
    const char *row_name;  /* "scene" */
    size_t width;          /* columns of a record; the first two are x and y */
    golden_column (*column)(size_t index);
    size_t moved;          /* the column that the test of the comparison moves by a pixel */
    size_t row_count;
    const char *(*row)(size_t index); /* name of a row, and of its file */
    int (*make)(size_t row, golden_list *found); /* 1 = made */
    void (*print)(FILE *file, const golden_list *list);
    int (*read)(FILE *file, golden_list *list); /* 1 = the file holds what print writes */
} golden_kind;

extern const golden_kind golden_junctions, golden_matches;

#endif
