/* SPDX-License-Identifier: BSD-2-Clause */
/* Two views to be matched, with as many L-junctions as are wanted. */
#ifndef ASJ_TESTS_BENCHMARK_VIEWS_H
#define ASJ_TESTS_BENCHMARK_VIEWS_H

#include <asj/asj.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct benchmark_view {
    asj_image image;
    asj_junction *all; /* by meaning, random ones last */
    size_t all_count;
    asj_junction *list;/* what is matched */
    size_t count;
} benchmark_view;

/* Detects with the preset match, and adds `more` corners at random places, for more than the image has. 0, or -1. */
int benchmark_view_make(asj_context *context, const asj_image *image, size_t more, uint64_t seed, benchmark_view *view);
void benchmark_view_free(benchmark_view *view);

/* Makes the list: the first junctions that give `corners` L-junctions; those that would give too many are left out. */
void benchmark_view_take(benchmark_view *view, size_t corners, double minimum_opening);

#ifdef __cplusplus
}
#endif
#endif
