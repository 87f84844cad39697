/* SPDX-License-Identifier: BSD-2-Clause */
/* Repeatability under zoom, by the paper's criterion (section "Comparison with ACJ").
 *
 * A photograph is scaled by 0.9, 0.8, ... 0.3 (area averages, see resample.h; points map with the pixels' areas), junctions are
 * detected in the original and in the copy. Junction 1 of the original and junction 2 of the copy correspond when they have the
 * same number of branches and     |s p1 - p2| < 3 px,  max over theta1 of min over theta2 of d(theta1, theta2) < pi / 20,
 * max over r1 of min over r2 of |s r1 - r2| < 3 px. Correspondences are one to one, closest first. The paper does not say what
 * the rate is a share of; here:     rate    correspondences / junctions of the original     of min  correspondences / the
 * smaller of the two numbers of junctions     paired  as rate, but angle and length have to agree branch by branch: stricter
 * than the paper's formula     place   as rate, by location alone L       as rate, for junctions decomposed into L-junctions
 * (which is how the authors' program reports them) */


#include "photograph.h"
#include "resample.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
enum { RATE, OF_MIN, PAIRED, PLACE, DECOMPOSED, FIGURES, FACTORS = 7 };

typedef struct pair {
    double distance;
    uint32_t first, second;
} pair;

static double angle_distance(double a, double b)
{
    const double d = fmod(fabs(a - b), 2.0 * PI);
    return d > PI ? 2.0 * PI - d : d;
}

/* Is there a branch of `to` that agrees with `branch` in angle, in length, or in both at once? */
static int has_branch(const asj_branch *branch, const asj_junction *to, double scale, int angle, int length)
{
    for (int32_t i = 0; i < to->branch_count; i++)
        if ((!angle || angle_distance((double)branch->angle, (double)to->branches[i].angle) < PI / 20.0) &&
            (!length || fabs(scale * (double)branch->length - (double)to->branches[i].length) < 3.0))
            return 1;
    return 0;
}

static int agree(const asj_junction *a, const asj_junction *b, double scale, int figure)
{
    if (figure == PLACE)
        return 1;
    if (a->branch_count != b->branch_count)
        return 0;
    for (int32_t i = 0; i < a->branch_count; i++) {
        const int both = has_branch(&a->branches[i], b, scale, 1, 1);
        const int apart = has_branch(&a->branches[i], b, scale, 1, 0) && has_branch(&a->branches[i], b, scale, 0, 1);
        if (figure == PAIRED ? !both : !apart)
            return 0;
    }
    return 1;
}

static int compare_pairs(const void *a, const void *b)
{
    const pair *p = a, *q = b;
    if (p->distance != q->distance)
        return p->distance < q->distance ? -1 : 1;
    return p->first != q->first ? (p->first > q->first) - (p->first < q->first) : (p->second > q->second) - (p->second < q->second);
}

/* Number of correspondences, or -1 (memory). */
static int32_t correspond(const asj_junction *a, uint32_t count_a, const asj_junction *b, uint32_t count_b, double sx, double sy,
                          int figure)
{
    pair *pairs = malloc(((size_t)count_a * count_b + 1) * sizeof *pairs);
    uint8_t *taken = calloc((size_t)count_a + count_b + 1, 1);
    int32_t found = pairs && taken ? 0 : -1;
    size_t count = 0;
    for (uint32_t i = 0; found == 0 && i < count_a; i++)
        for (uint32_t k = 0; k < count_b; k++) {
            const double x = ((double)a[i].x + 0.5) * sx - 0.5, y = ((double)a[i].y + 0.5) * sy - 0.5;
            const double distance = hypot(x - (double)b[k].x, y - (double)b[k].y);
            if (distance < 3.0 && agree(&a[i], &b[k], 0.5 * (sx + sy), figure)) {
                const pair p = {distance, i, k};
                pairs[count++] = p;
            }
        }
    if (found == 0)
        qsort(pairs, count, sizeof *pairs, compare_pairs);
    for (size_t i = 0; i < count; i++)
        if (!taken[pairs[i].first] && !taken[count_a + pairs[i].second]) {
            taken[pairs[i].first] = taken[count_a + pairs[i].second] = 1;
            found++;
        }
    free(pairs);
    free(taken);
    return found;
}

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
    static const int kinds[] = {RATE, PAIRED, PLACE};
    for (int i = 0; i < 3; i++)
        counts[kinds[i]] = correspond(a->junctions, a->junction_count, b->junctions, b->junction_count, sx, sy, kinds[i]);
    asj_junction *la = decomposed(a), *lb = decomposed(b);
    counts[DECOMPOSED] = la && lb ? correspond(la, a->l_junction_count, lb, b->l_junction_count, sx, sy, RATE) : -1;
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
