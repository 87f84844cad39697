/* SPDX-License-Identifier: BSD-2-Clause */
/* Repeatability under zoom, by the paper's criterion (correspond.h).
 *
 * A photograph is scaled by 0.9, 0.8, ... 0.3 (area averages, see resample.h; points map with the pixels' areas), junctions are
 * detected in the original and in the copy. The paper does not say what the rate is a share of; here:
 *     rate    correspondences / junctions of the original
 *     of min  correspondences / the smaller of the two numbers of junctions
 *     paired  as rate, but angle and length have to agree branch by branch: stricter than the paper's formula
 *     place   as rate, by location alone
 *     L       as rate, for junctions decomposed into L-junctions (which is how the authors' program reports them) */
#include "correspond.h"
#include "photograph.h"
#include "resample.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { RATE, OF_MIN, PAIRED, PLACE, DECOMPOSED, FIGURES, FACTORS = 7 };

/* L-junctions as junctions of two branches. */
static asj_junction *decomposed(const asj_detection *d)
{
    asj_junction *out = calloc((size_t)d->l_junction_count + 1, sizeof *out);
    for (uint32_t i = 0; out && i < d->l_junction_count; i++) {
        const asj_l_junction *l = &d->l_junctions[i];
        out[i] = d->junctions[l->junction];
        const asj_branch a = out[i].branches[l->branch_a], b = out[i].branches[l->branch_b];
        out[i].branch_count = 2;
        out[i].branches[0] = a;
        out[i].branches[1] = b;
    }
    return out;
}

static double share(int32_t part, uint32_t whole)
{
    return whole ? 100.0 * part / whole : 0.0;
}

static int compare(const asj_detection *a, const asj_detection *b, double sx, double sy, double *figures)
{
    int32_t counts[FIGURES] = {0};
    const correspond_map map = correspond_scaling(sx, sy);
    const correspond_list image = {a->junctions, a->junction_count}, copy = {b->junctions, b->junction_count};
    counts[RATE] = correspond(&image, &copy, &map, CORRESPOND_WHOLE, NULL);
    counts[PAIRED] = correspond(&image, &copy, &map, CORRESPOND_PAIRED, NULL);
    counts[PLACE] = correspond(&image, &copy, &map, CORRESPOND_PLACE, NULL);
    asj_junction *la = decomposed(a), *lb = decomposed(b);
    const correspond_list image_l = {la, a->l_junction_count}, copy_l = {lb, b->l_junction_count};
    counts[DECOMPOSED] = la && lb ? correspond(&image_l, &copy_l, &map, CORRESPOND_WHOLE, NULL) : -1;
    free(la);
    free(lb);
    const uint32_t smaller = a->junction_count < b->junction_count ? a->junction_count : b->junction_count;
    figures[RATE] = share(counts[RATE], a->junction_count);
    figures[OF_MIN] = share(counts[RATE], smaller);
    figures[PAIRED] = share(counts[PAIRED], a->junction_count);
    figures[PLACE] = share(counts[PLACE], a->junction_count);
    figures[DECOMPOSED] = share(counts[DECOMPOSED], a->l_junction_count);
    return counts[RATE] < 0 || counts[PAIRED] < 0 || counts[PLACE] < 0 || counts[DECOMPOSED] < 0 ? -1 : 0;
}

static void print_figures(double factor, const double *figures)
{
    printf("  %4.1f", factor);
    for (int i = 0; i < FIGURES; i++)
        printf("%8.1f", figures[i]);
}

static int run_factor(asj_context *context, const asj_detect_options *options, const photograph *p, const asj_detection *whole,
                      double factor, double *figures)
{
    const int32_t width = (int32_t)floor(factor * p->width + 0.5), height = (int32_t)floor(factor * p->height + 0.5);
    uint8_t *smaller = synth_resample(p->pixels, p->width, p->height, width, height);
    asj_detection *found = smaller ? photograph_detect(context, options, smaller, width, height) : NULL;
    int result = found ? compare(whole, found, (double)width / p->width, (double)height / p->height, figures) : -1;
    if (result == 0) {
        print_figures(factor, figures);
        printf("  %6u junctions\n", (unsigned)found->junction_count);
    }
    asj_detection_free(&found);
    free(smaller);
    return result;
}

static int run_photograph(asj_context *context, const asj_detect_options *options, const char *path, double sums[FACTORS][FIGURES])
{
    photograph p;
    if (photograph_read(path, &p) != 0)
        return -1;
    asj_detection *whole = photograph_detect(context, options, p.pixels, p.width, p.height);
    int result = whole ? 0 : -1;
    if (whole)
        printf("%s: %u junctions\n", path, (unsigned)whole->junction_count);
    for (int f = 0; f < FACTORS && result == 0; f++) {
        double figures[FIGURES];
        result = run_factor(context, options, &p, whole, 0.1 * (9 - f), figures);
        for (int i = 0; i < FIGURES && result == 0; i++)
            sums[f][i] += figures[i];
    }
    asj_detection_free(&whole);
    photograph_free(&p);
    return result;
}

static int run(asj_context *context, const asj_detect_options *options, const path_list *list)
{
    double sums[FACTORS][FIGURES] = {{0.0}};
    printf("factor    rate  of min  paired   place       L   (percent)\n");
    for (int32_t i = 0; i < list->count; i++)
        if (run_photograph(context, options, list->paths[i], sums) != 0)
            return 1;
    printf("mean of %d images\n", (int)list->count);
    for (int f = 0; f < FACTORS; f++) {
        for (int i = 0; i < FIGURES; i++)
            sums[f][i] /= list->count;
        print_figures(0.1 * (9 - f), sums[f]);
        printf("\n");
    }
    return 0;
}

int main(int argc, char **argv)
{
    asj_detect_options options;
    path_list list = {NULL, 0, 0};
    int result = argc > 1 ? 0 : 2;
    asj_detect_options_init(&options);
    for (int i = 1; i < argc && result == 0; i++) {
        if (strcmp(argv[i], "--preset=paper") == 0)
            result = asj_detect_options_preset(&options, ASJ_PRESET_PAPER) == ASJ_OK ? 0 : 2;
        else if (strchr(argv[i], '=') && !strchr(argv[i], '/'))
            result = photograph_option(&options, argv[i]) == 0 ? 0 : 2;
        else
            result = path_list_add(&list, argv[i]) == 0 ? 0 : 1;
    }
    if (result == 2)
        fprintf(stderr, "usage: repeatability [--preset=paper] [key=value ...] FILE.png|FOLDER ...\n");
    asj_context *context = NULL;
    if (result == 0)
        result = asj_context_create(NULL, &context) == ASJ_OK ? run(context, &options, &list) : 1;
    asj_context_free(&context);
    path_list_free(&list);
    return result;
}
