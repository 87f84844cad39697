/* SPDX-License-Identifier: BSD-2-Clause */
#include "score.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.14159265358979323846
#define LOCATION_LIMIT 3.0
#define ANGLE_LIMIT (10.0 * PI / 180.0)
#define FAR_LIMIT 8.0
#define MINIMUM_LENGTH 10.0

typedef struct pair {
    double distance;
    int32_t truth, found;
} pair;

void score_init(score *s, double minimum_opening_deg)
{
    memset(s, 0, sizeof *s);
    s->minimum_opening = minimum_opening_deg * PI / 180.0;
}

void score_free(score *s)
{
    sample_free(&s->location);
    sample_free(&s->angle);
    sample_free(&s->length);
    sample_free(&s->location_sds);
    sample_free(&s->angle_sds);
}

static int compare_pairs(const void *a, const void *b)
{
    const pair *p = a, *q = b;
    if (p->distance != q->distance)
        return p->distance < q->distance ? -1 : 1;
    return p->truth != q->truth ? p->truth - q->truth : p->found - q->found;
}

/* Closest first: keeps each index of either side once. Writes for each of `truths` the index found or -1, and marks `taken`. */
static void assign(pair *pairs, size_t count, int32_t *partner, int32_t truths, uint8_t *taken)
{
    for (int32_t i = 0; i < truths; i++)
        partner[i] = -1;
    qsort(pairs, count, sizeof *pairs, compare_pairs);
    for (size_t i = 0; i < count; i++)
        if (partner[pairs[i].truth] < 0 && !taken[pairs[i].found]) {
            partner[pairs[i].truth] = pairs[i].found;
            taken[pairs[i].found] = 1;
        }
}

static int is_expected(const score *s, const synth_truth *truth, int32_t index)
{
    const synth_true_junction *junction = &truth->junctions[index];
    if (synth_truth_opening(junction, s->minimum_opening, MINIMUM_LENGTH, s->minimum_step) <= 0.0)
        return 0;
    for (int32_t i = 0; i < truth->count; i++)
        if (i != index && hypot(truth->junctions[i].x - junction->x, truth->junctions[i].y - junction->y) < s->clearance)
            return 0;
    return 1;
}

static int starts_its_line(const synth_true_junction *junction, double angle)
{
    for (int32_t k = 0; k < junction->branch_count; k++)
        if (synth_angle_distance(junction->branches[k].angle, angle + PI) < 0.01)
            return 0;
    return 1;
}

static void score_branch(score *s, const synth_true_branch *truth, const asj_branch *found)
{
    const double error = synth_angle_distance(truth->angle, (double)found->angle);
    s->branches_paired++;
    sample_add(&s->angle, error * 180.0 / PI);
    if (found->angle_sd > 0.0f)
        sample_add(&s->angle_sds, error / (double)found->angle_sd);
    if (!truth->at_border)
        sample_add(&s->length, (double)found->length - truth->length);
}

static void score_branches(score *s, const synth_true_junction *truth, const asj_junction *found)
{
    pair pairs[SYNTH_MAX_BRANCHES * ASJ_MAX_BRANCHES];
    int32_t partner[SYNTH_MAX_BRANCHES];
    uint8_t taken[ASJ_MAX_BRANCHES] = {0};
    size_t count = 0;
    for (int32_t i = 0; i < truth->branch_count; i++)
        for (int32_t k = 0; k < found->branch_count; k++) {
            const double distance = synth_angle_distance(truth->branches[i].angle, (double)found->branches[k].angle);
            if (distance <= ANGLE_LIMIT) {
                const pair p = {distance, i, k};
                pairs[count++] = p;
            }
        }
    assign(pairs, count, partner, truth->branch_count, taken);
    s->branches += truth->branch_count;
    for (int32_t k = 0; k < found->branch_count; k++)
        s->branches_extra += !taken[k];
    for (int32_t i = 0; i < truth->branch_count; i++) {
        const synth_true_branch *branch = &truth->branches[i];
        const asj_branch *mine = partner[i] >= 0 ? &found->branches[partner[i]] : NULL;
        if (mine)
            score_branch(s, branch, mine);
        if (branch->passes == 0 || branch->at_border)
            continue;
        const int reached = mine && fabs((double)mine->length - branch->length) <= FAR_LIMIT;
        s->long_branches++;
        s->long_reached += reached;
        if (starts_its_line(truth, branch->angle)) {
            s->full_branches++;
            s->full_reached += reached;
        }
    }
}

static void score_junction(score *s, const synth_true_junction *truth, const asj_junction *found)
{
    const double error = hypot((double)found->x - truth->x, (double)found->y - truth->y);
    s->paired++;
    sample_add(&s->location, error);
    if (found->location_sd > 0.0f)
        sample_add(&s->location_sds, error / (double)found->location_sd);
    score_branches(s, truth, found);
}

static size_t close_pairs(const synth_truth *truth, const asj_junction *found, uint32_t count, pair *pairs)
{
    size_t n = 0;
    for (int32_t i = 0; i < truth->count; i++)
        for (uint32_t k = 0; k < count; k++) {
            const double distance = hypot((double)found[k].x - truth->junctions[i].x, (double)found[k].y - truth->junctions[i].y);
            if (distance <= LOCATION_LIMIT) {
                const pair p = {distance, i, (int32_t)k};
                pairs[n++] = p;
            }
        }
    return n;
}

int score_add(score *s, const synth_truth *truth, const asj_junction *found, uint32_t count, score_report report, void *user)
{
    pair *pairs = malloc(((size_t)truth->count * count + 1) * sizeof *pairs);
    int32_t *partner = malloc(((size_t)truth->count + 1) * sizeof *partner);
    uint8_t *taken = calloc((size_t)count + 1, 1);
    const int ready = pairs && partner && taken;
    if (ready) {
        assign(pairs, close_pairs(truth, found, count, pairs), partner, truth->count, taken);
        s->scenes++;
        s->found += count;
        for (int32_t i = 0; i < truth->count; i++) {
            const synth_true_junction *junction = &truth->junctions[i];
            const int expected = is_expected(s, truth, i);
            s->expected += expected;
            if (expected && partner[i] >= 0)
                score_junction(s, junction, &found[partner[i]]);
            else if (expected && report)
                report(user, "missed", junction->x, junction->y);
        }
        for (uint32_t k = 0; k < count; k++) {
            s->false_found += !taken[k];
            if (!taken[k] && report)
                report(user, "false", (double)found[k].x, (double)found[k].y);
        }
    }
    free(pairs);
    free(partner);
    free(taken);
    return ready ? 0 : -1;
}

double score_recall(const score *s)
{
    return s->expected ? (double)s->paired / (double)s->expected : NAN;
}

double score_precision(const score *s)
{
    return s->found ? 1.0 - (double)s->false_found / (double)s->found : NAN;
}
