/* SPDX-License-Identifier: BSD-2-Clause */
/* Golden results: junctions of synthetic pictures (golden_junctions.c) and matches of rendered views (golden_matches.c), made here
 * and held against files in expected/. The library is deterministic, so the tolerances are those of the printed digits and of other
 * compilers' libm; a change of the method shows here, and then
 *
 *     golden KIND compare FOLDER       what differs first, exit 1
 *     golden KIND display ROW          what is found now
 *     golden KIND generate FOLDER      writes the files anew: look at the difference before committing it
 *     golden KIND meta FOLDER          the comparison itself: an empty result and one moved by a pixel must be told apart
 *
 * KIND is junctions or matches. In a build folder, `meson compile update-golden` and `update-golden-matches` generate with the
 * right folder. */
#include "golden.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TWO_PI 6.28318530717958647692

double *golden_add(golden_list *list)
{
    if (list->count == list->capacity) {
        const size_t capacity = 2 * list->capacity + 16;
        double *larger = realloc(list->numbers, capacity * list->width * sizeof *larger);
        if (!larger)
            return NULL;
        list->numbers = larger;
        list->capacity = capacity;
    }
    double *record = list->numbers + list->count++ * list->width;
    memset(record, 0, list->width * sizeof *record);
    return record;
}

static void list_start(const golden_kind *kind, golden_list *list)
{
    memset(list, 0, sizeof *list);
    list->width = kind->width;
}

static int make(const golden_kind *kind, size_t row, golden_list *found)
{
    list_start(kind, found);
    if (kind->make(row, found))
        return 1;
    fprintf(stderr, "%s: cannot be made\n", kind->row(row));
    return 0;
}

static FILE *open_expected(const golden_kind *kind, const char *folder, size_t row, const char *mode)
{
    char name[1024];
    snprintf(name, sizeof name, "%s/%s.csv", folder, kind->row(row));
    FILE *file = fopen(name, mode);
    if (!file)
        perror(name);
    return file;
}

static int read_expected(const golden_kind *kind, const char *folder, size_t row, golden_list *expected)
{
    FILE *file = open_expected(kind, folder, row, "r");
    list_start(kind, expected);
    const int good = file && kind->read(file, expected);
    if (file)
        fclose(file);
    if (!good)
        fprintf(stderr, "%s: no golden file, or a damaged one\n", kind->row(row));
    return good;
}

/* The largest difference of two records, in tolerances; what it is in. */
static double difference(const golden_kind *kind, const double *a, const double *b, const char **what)
{
    double worst = 0;
    *what = "nothing";
    for (size_t n = 0; n < kind->width; n++) {
        const golden_column column = kind->column(n);
        const double off = fabs(column.turn ? remainder(a[n] - b[n], TWO_PI) : a[n] - b[n]) / column.tolerance;
        if (!(off <= worst)) {
            worst = off;
            *what = column.name;
        }
    }
    return worst;
}

/* Everything in `from` has its like in `to`. Prints the first that has not, with what comes nearest. */
static int all_in(const golden_kind *kind, const char *row, const char *direction, const golden_list *from, const golden_list *to)
{
    for (size_t i = 0; i < from->count; i++) {
        const double *record = from->numbers + i * kind->width, *nearest = NULL;
        double least = HUGE_VAL;
        const char *what = "", *least_what = "";
        for (size_t k = 0; k < to->count; k++) {
            const double *other = to->numbers + k * kind->width, d = difference(kind, record, other, &what);
            if (d < least) {
                least = d;
                least_what = what;
                nearest = other;
            }
        }
        if (least <= 1)
            continue;
        printf("%s: number %zu at (%.4f, %.4f) is %s; ", row, i, record[0], record[1], direction);
        if (nearest)
            printf("nearest (%.4f, %.4f): %s off by %.1f tolerances\n", nearest[0], nearest[1], least_what, least);
        else
            puts("there is none");
        return 0;
    }
    return 1;
}

static int same(const golden_kind *kind, const char *row, const golden_list *found, const golden_list *expected)
{
    if (found->count != expected->count) {
        printf("%s: %zu %s instead of %zu\n", row, found->count, kind->name, expected->count);
        all_in(kind, row, "missing", expected, found);
        return 0;
    }
    return all_in(kind, row, "missing", expected, found) && all_in(kind, row, "new", found, expected);
}

static int compare(const golden_kind *kind, const char *folder)
{
    size_t differ = 0, records = 0;
    for (size_t i = 0; i < kind->row_count; i++) {
        golden_list found, expected;
        const int made = make(kind, i, &found), read = read_expected(kind, folder, i, &expected);
        differ += !made || !read || !same(kind, kind->row(i), &found, &expected);
        records += expected.count;
        free(found.numbers);
        free(expected.numbers);
    }
    printf("%zu %ss, %zu %s, %zu %ss differ\n", kind->row_count, kind->row_name, records, kind->name, differ, kind->row_name);
    return differ || records == 0;
}

/* What is compared with itself is the same; nothing, and everything a pixel to the right, is not. */
static int meta(const golden_kind *kind, const char *folder)
{
    size_t wrong = 0, tried = 0;
    for (size_t i = 0; i < kind->row_count; i++) {
        golden_list expected, moved, none;
        wrong += !read_expected(kind, folder, i, &expected) || !read_expected(kind, folder, i, &moved);
        list_start(kind, &none);
        for (size_t k = 0; k < moved.count; k++)
            moved.numbers[k * kind->width + kind->moved] += 1;
        wrong += !same(kind, kind->row(i), &expected, &expected);
        if (expected.count) {
            tried++;
            wrong += same(kind, kind->row(i), &none, &expected) || same(kind, kind->row(i), &moved, &expected);
        }
        free(expected.numbers);
        free(moved.numbers);
    }
    printf("meta: %zu %ss with %s, %zu wrong answers\n", tried, kind->row_name, kind->name, wrong);
    return wrong || tried < 4;
}

static int generate(const golden_kind *kind, const char *folder)
{
    for (size_t i = 0; i < kind->row_count; i++) {
        golden_list found;
        FILE *file = NULL;
        const int good = make(kind, i, &found) && (file = open_expected(kind, folder, i, "w")) != NULL;
        if (good)
            kind->print(file, &found);
        free(found.numbers);
        if (!good || fclose(file) != 0)
            return 1;
    }
    return 0;
}

static int display(const golden_kind *kind, const char *name)
{
    for (size_t i = 0; i < kind->row_count; i++)
        if (strcmp(kind->row(i), name) == 0) {
            golden_list found;
            const int good = make(kind, i, &found);
            kind->print(stdout, &found);
            free(found.numbers);
            return !good;
        }
    fprintf(stderr, "no %s '%s'; there are:", kind->row_name, name);
    for (size_t i = 0; i < kind->row_count; i++)
        fprintf(stderr, " %s", kind->row(i));
    fputs("\n", stderr);
    return 2;
}

int main(int count, char **arguments)
{
    static const golden_kind *const kinds[] = {&golden_junctions, &golden_matches};
    static const struct {
        const char *name;
        int (*run)(const golden_kind *kind, const char *argument);
    } modes[] = {{"compare", compare}, {"meta", meta}, {"generate", generate}, {"display", display}};
    for (size_t k = 0; count == 4 && k < sizeof kinds / sizeof kinds[0]; k++)
        for (size_t i = 0; i < sizeof modes / sizeof modes[0]; i++)
            if (strcmp(arguments[1], kinds[k]->name) == 0 && strcmp(arguments[2], modes[i].name) == 0)
                return modes[i].run(kinds[k], arguments[3]);
    fprintf(stderr, "usage: golden junctions|matches compare|meta|generate FOLDER\n       golden junctions|matches display ROW\n");
    return 2;
}
