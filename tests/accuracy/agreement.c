/* SPDX-License-Identifier: BSD-2-Clause */
/* Our junctions beside those of the paper's authors' program, for photographs N.png with its output N.authors.asj beside them.
 *
 *     theirs   its distinct locations (it writes one record for each pair of branches)
 *     ours     our junctions
 *     found    share of theirs that have one of ours within 4 px (their locations are whole pixels)
 *     also     share of ours that have one of theirs within 4 px
 *     branch   at the locations found: share of their branches that have one of ours within pi / 20
 *     length   of these: share whose lengths differ by at most 3 px; diff: median of ours minus theirs
 *
 * The last lines are those of all junctions, and the mean of the images' shares with how many of ours there are to one of theirs.
 * Agreement is no accuracy: neither is complete nor always right. --check asserts what is promised of preset paper on the sixteen
 * photographs of ../data/pairs: the means of found and also at least 0.8 and 0.5. */
#include "photograph.h"
#include "sample.h"

#include <asj/io.h>

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define NEAR 4

typedef struct tally {
    int64_t theirs, ours, found, also, branches, branches_found, lengths;
    sample differences;
} tally;

/* Sums over images, each counting the same. */
typedef struct means {
    double found, also, ratio;
    int32_t images;
} means;

static double distance(const asj_junction *a, const asj_junction *b)
{
    return hypot((double)a->x - (double)b->x, (double)a->y - (double)b->y);
}

static const asj_junction *nearest(const asj_junction *to, const asj_junction *list, uint32_t count)
{
    const asj_junction *best = NULL;
    for (uint32_t i = 0; i < count; i++)
        if (distance(to, &list[i]) <= NEAR && (!best || distance(to, &list[i]) < distance(to, best)))
            best = &list[i];
    return best;
}

static void compare_branches(const asj_junction *theirs, const asj_junction *ours, tally *t)
{
    for (int32_t i = 0; i < theirs->branch_count; i++) {
        double best = PI / 20.0, difference = 0.0;
        int found = 0;
        for (int32_t k = 0; k < ours->branch_count; k++) {
            double turn = fmod(fabs((double)theirs->branches[i].angle - (double)ours->branches[k].angle), 2.0 * PI);
            turn = fmin(turn, 2.0 * PI - turn);
            if (turn < best) {
                best = turn;
                found = 1;
                difference = (double)ours->branches[k].length - (double)theirs->branches[i].length;
            }
        }
        t->branches++;
        t->branches_found += found;
        t->lengths += found && fabs(difference) <= 3.0;
        if (found)
            sample_add(&t->differences, difference);
    }
}

static int seen_before(const asj_junction *list, uint32_t index)
{
    for (uint32_t i = 0; i < index; i++)
        if (list[i].x == list[index].x && list[i].y == list[index].y)
            return 1;
    return 0;
}

static void compare(const asj_junction_file *theirs, const asj_detection *ours, int misses, tally *t)
{
    for (uint32_t i = 0; i < theirs->junction_count; i++) {
        const asj_junction *their = &theirs->junctions[i], *our = nearest(their, ours->junctions, ours->junction_count);
        if (our)
            compare_branches(their, our, t);
        if (seen_before(theirs->junctions, i))
            continue;
        t->theirs++;
        t->found += our != NULL;
        if (!our && misses)
            printf("  missed (%g, %g) scale %g log10 NFA %.1f\n", (double)their->x, (double)their->y, (double)their->scale,
                   (double)their->log10_nfa);
    }
    t->ours += ours->junction_count;
    for (uint32_t i = 0; i < ours->junction_count; i++)
        t->also += nearest(&ours->junctions[i], theirs->junctions, theirs->junction_count) != NULL;
}

static double share(int64_t part, int64_t whole)
{
    return whole ? (double)part / (double)whole : 0.0;
}

static void print_tally(const char *name, tally *t)
{
    printf("%-44s %6ld %6ld %7.2f %7.2f %7.2f %7.2f %7.1f\n", name, (long)t->theirs, (long)t->ours, share(t->found, t->theirs),
           share(t->also, t->ours), share(t->branches_found, t->branches), share(t->lengths, t->branches_found),
           sample_quantile(&t->differences, 0.5));
}

/* The last two parts of a path. */
static const char *short_name(const char *path)
{
    const char *cut = path;
    int slashes = 0;
    for (const char *c = path + strlen(path); c > path && slashes < 2; c--)
        if (*c == '/' && ++slashes == 2)
            cut = c + 1;
    return cut;
}

static void add(tally *sum, const tally *t)
{
    sum->theirs += t->theirs;
    sum->ours += t->ours;
    sum->found += t->found;
    sum->also += t->also;
    sum->branches += t->branches;
    sum->branches_found += t->branches_found;
    sum->lengths += t->lengths;
    for (size_t i = 0; i < t->differences.count; i++)
        sample_add(&sum->differences, t->differences.values[i]);
}

static void add_shares(means *m, const tally *t)
{
    m->found += share(t->found, t->theirs);
    m->also += share(t->also, t->ours);
    m->ratio += share(t->ours, t->theirs);
    m->images++;
}

/* 0; 1 when there is no file to compare with; -1 on failure. */
static int run(asj_context *context, const asj_detect_options *options, const char *path, int misses, tally *sum, means *m)
{
    char beside[4096], message[512];
    photograph p;
    tally t;
    memset(&t, 0, sizeof t);
    snprintf(beside, sizeof beside, "%.*s.authors.asj", (int)(strlen(path) - 4), path);
    FILE *there = fopen(beside, "rb");
    if (!there)
        return 1;
    fclose(there);
    asj_junction_file *theirs = NULL;
    if (asj_junctions_read(beside, &theirs, message, sizeof message) != ASJ_OK) {
        fprintf(stderr, "%s\n", message);
        return -1;
    }
    int result = photograph_read(path, &p);
    asj_detection *ours = result == 0 ? photograph_detect(context, options, p.pixels, p.width, p.height) : NULL;
    if (ours) {
        if (misses)
            printf("%s\n", path);
        compare(theirs, ours, misses, &t);
        print_tally(short_name(path), &t);
        add(sum, &t);
        add_shares(m, &t);
    }
    result = ours && !t.differences.failed ? 0 : -1;
    photograph_free(&p);
    sample_free(&t.differences);
    asj_detection_free(&ours);
    asj_junction_file_free(&theirs);
    return result;
}

static int print_means(const means *m, int check)
{
    const double count = m->images > 0 ? m->images : 1, found = m->found / count, also = m->also / count;
    printf("%-44s %6ld %6.2f %7.2f %7.2f\n", "mean", (long)m->images, m->ratio / count, found, also);
    if (check && (found < 0.8 || also < 0.5)) {
        fprintf(stderr, "agreement: found %.3f of 0.8, also %.3f of 0.5\n", found, also);
        return -1;
    }
    return 0;
}

int main(int argc, char **argv)
{
    asj_detect_options options;
    path_list list = {NULL, 0, 0};
    asj_context *context = NULL;
    tally sum;
    means m = {0, 0, 0, 0};
    int result = argc > 1 ? 0 : 2, misses = 0, check = 0;
    memset(&sum, 0, sizeof sum);
    asj_detect_options_init(&options);
    for (int i = 1; i < argc && result == 0; i++) {
        if (strcmp(argv[i], "--misses") == 0)
            misses = 1;
        else if (strcmp(argv[i], "--check") == 0)
            check = 1;
        else if (strcmp(argv[i], "--preset=paper") == 0)
            result = asj_detect_options_preset(&options, ASJ_PRESET_PAPER) == ASJ_OK ? 0 : 2;
        else if (strchr(argv[i], '=') && !strchr(argv[i], '/'))
            result = photograph_option(&options, argv[i]) == 0 ? 0 : 2;
        else
            result = path_list_add(&list, argv[i]) == 0 ? 0 : 1;
    }
    if (result == 2)
        fprintf(stderr, "usage: agreement [--misses] [--check] [--preset=paper] [key=value ...] FILE.png|FOLDER ...\n");
    if (result == 0)
        result = asj_context_create(NULL, &context) == ASJ_OK ? 0 : 1;
    if (result == 0)
        printf("%-44s %6s %6s %7s %7s %7s %7s %7s\n", "image", "theirs", "ours", "found", "also", "branch", "length", "diff");
    for (int32_t i = 0; i < list.count && result == 0; i++)
        result = run(context, &options, list.paths[i], misses, &sum, &m) < 0;
    if (result == 0)
        print_tally("all", &sum);
    if (result == 0)
        result = print_means(&m, check) != 0;
    sample_free(&sum.differences);
    asj_context_free(&context);
    path_list_free(&list);
    return result;
}
