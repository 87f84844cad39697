/* SPDX-License-Identifier: BSD-2-Clause */
#include "views.h"
#include "random.h"

#include <stdlib.h>
#include <string.h>

static int by_meaning(const void *a, const void *b)
{
    const asj_junction *p = a, *q = b;
    if (p->log10_nfa != q->log10_nfa)
        return p->log10_nfa < q->log10_nfa ? -1 : 1;
    return p->y != q->y ? (p->y < q->y ? -1 : 1) : (p->x > q->x) - (p->x < q->x);
}

static void fill_up(asj_junction *junctions, size_t count, const asj_image *image, uint64_t seed)
{
    synth_random random;
    synth_random_seed(&random, seed);
    for (size_t i = 0; i < count; i++) {
        asj_junction *j = &junctions[i];
        const double angle = synth_random_between(&random, 0, 4.5);
        memset(j, 0, sizeof *j);
        j->x = (float)synth_random_between(&random, 20, image->width - 20);
        j->y = (float)synth_random_between(&random, 20, image->height - 20);
        j->branch_count = 2;
        j->branches[0].angle = (float)angle;
        j->branches[0].length = (float)synth_random_between(&random, 15, 120);
        j->branches[1].angle = (float)(angle + synth_random_between(&random, 1, 1.7));
        j->branches[1].length = (float)synth_random_between(&random, 15, 120);
    }
}

int benchmark_view_make(asj_context *context, const asj_image *image, size_t more, uint64_t seed, benchmark_view *view)
{
    asj_detect_options options;
    asj_detection *found = NULL;
    memset(view, 0, sizeof *view);
    view->image = *image;
    asj_detect_options_preset(&options, ASJ_PRESET_MATCH);
    if (asj_detect(context, image, &options, &found) != ASJ_OK)
        return -1;
    view->all_count = found->junction_count + more;
    view->all = malloc((view->all_count + 1) * sizeof *view->all);
    view->list = malloc((view->all_count + 1) * sizeof *view->list);
    const int result = view->all && view->list ? 0 : -1;
    if (result == 0) {
        if (found->junction_count)
            memcpy(view->all, found->junctions, found->junction_count * sizeof *view->all);
        qsort(view->all, found->junction_count, sizeof *view->all, by_meaning);
        fill_up(view->all + found->junction_count, more, image, seed);
    }
    asj_detection_free(&found);
    return result;
}

void benchmark_view_free(benchmark_view *view)
{
    free(view->all);
    free(view->list);
    memset(view, 0, sizeof *view);
}

void benchmark_view_take(benchmark_view *view, size_t corners, double minimum_opening)
{
    size_t sum = 0;
    view->count = 0;
    for (size_t i = 0; i < view->all_count && sum < corners; i++) {
        const size_t more = asj_decompose(&view->all[i], 1, minimum_opening, NULL, 0);
        if (more == 0 || sum + more > corners)
            continue;
        view->list[view->count++] = view->all[i];
        sum += more;
    }
}
