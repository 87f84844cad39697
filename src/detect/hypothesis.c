/* SPDX-License-Identifier: BSD-2-Clause */
/* Hypotheses, and the angles of their branches. */
#include "hypothesis.h"
#include "core/angle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define TURN ASJ_ISOTROPIC_TURN

int asj_isotropic_has_opening(const asj_detect_options *options, const asj_isotropic_junction *junction)
{
    const double least = options->minimum_opening * (TURN / 360.0);
    for (int32_t i = 0; i < junction->branch_count; i++)
        for (int32_t j = i + 1; j < junction->branch_count; j++) {
            const int32_t turn = abs(junction->angle[i] - junction->angle[j]), opening = turn > TURN / 2 ? TURN - turn : turn;
            if (opening > 0 && opening < TURN / 2 && opening >= least && opening <= TURN / 2 - least)
                return 1;
        }
    return 0;
}

void asj_hypothesis_start(const asj_isotropic_junction *junction, asj_hypothesis *hypothesis)
{
    memset(hypothesis, 0, sizeof *hypothesis);
    hypothesis->x = hypothesis->x0 = junction->x;
    hypothesis->y = hypothesis->y0 = junction->y;
    hypothesis->radius = junction->radius;
    hypothesis->log_nfa = junction->log_nfa;
    hypothesis->branch_count = junction->branch_count;
    for (int32_t i = 0; i < junction->branch_count; i++) {
        hypothesis->branches[i].angle = asj_isotropic_angle(junction->angle[i]);
        hypothesis->branches[i].strength = (double)junction->strength[i] / ASJ_STRENGTH_ONE;
    }
}

double asj_angle_distance(double a, double b)
{
    double d = fabs(a - b);
    d = d >= ASJ_TWO_PI ? fmod(d, ASJ_TWO_PI) : d;
    return d > ASJ_PI ? ASJ_TWO_PI - d : d;
}

double asj_angle_wrap(double angle)
{
    angle = fabs(angle) >= ASJ_TWO_PI ? fmod(angle, ASJ_TWO_PI) : angle;
    angle = angle < 0 ? angle + ASJ_TWO_PI : angle;
    return (float)angle < 6.2831853f ? angle : 0; /* results are floats: what rounds to 2 pi is 0, in every order of angles */
}

int asj_hypothesis_is_inside(const asj_hypothesis *hypothesis, int32_t width, int32_t height)
{
    return hypothesis->x >= -ASJ_MAX_OUTSIDE && hypothesis->x <= width - 1 + ASJ_MAX_OUTSIDE &&
           hypothesis->y >= -ASJ_MAX_OUTSIDE && hypothesis->y <= height - 1 + ASJ_MAX_OUTSIDE;
}

void asj_hypothesis_scale(asj_hypothesis *hypothesis, double x_scale, double y_scale, double scale)
{
    hypothesis->x = (hypothesis->x + 0.5) * x_scale - 0.5;
    hypothesis->y = (hypothesis->y + 0.5) * y_scale - 0.5;
    hypothesis->radius *= scale;
    hypothesis->location_variance *= scale * scale;
    for (int32_t i = 0; i < hypothesis->branch_count; i++) {
        asj_hypothesis_branch *branch = &hypothesis->branches[i];
        branch->length *= scale;
        branch->offset *= scale;
        branch->offset_variance *= scale * scale;
        branch->end_variance *= scale * scale;
        branch->apart *= scale;
    }
}

void asj_hypothesis_select(asj_hypothesis *hypothesis, const int *keep)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        if (keep[i])
            hypothesis->branches[kept++] = hypothesis->branches[i];
    hypothesis->branch_count = kept;
}

double asj_joined_apart(const asj_detect_options *options)
{
    return fmax(ASJ_JOINED_APART, options->merge_angle * ASJ_DEGREE);
}

int asj_hypothesis_is_free(const asj_hypothesis *hypothesis, double angle, double least)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        if (asj_angle_distance(hypothesis->branches[i].angle, angle) < least)
            return 0;
    return 1;
}

void asj_hypothesis_insert(asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch)
{
    int32_t i = hypothesis->branch_count++;
    for (; i > 0 && hypothesis->branches[i - 1].angle > branch->angle; i--)
        hypothesis->branches[i] = hypothesis->branches[i - 1];
    hypothesis->branches[i] = *branch;
}

int asj_hypothesis_opens(const asj_hypothesis *hypothesis, const int *keep, double least)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        for (int32_t j = i + 1; j < hypothesis->branch_count; j++) {
            if (keep && !(keep[i] && keep[j]))
                continue;
            const double d = asj_angle_distance(hypothesis->branches[i].angle, hypothesis->branches[j].angle);
            if (d > 0 && d < ASJ_PI && d >= least && d <= ASJ_PI - least)
                return 1;
        }
    return 0;
}

int asj_hypothesis_has_opening(const asj_hypothesis *hypothesis, double least)
{
    return asj_hypothesis_opens(hypothesis, NULL, least);
}
