/* SPDX-License-Identifier: BSD-2-Clause */
#include "draft.h"

#include <math.h>

#define PI 3.141592653589793

double asj_angle_distance(double a, double b)
{
    double d = fabs(a - b);
    d = d >= 2 * PI ? fmod(d, 2 * PI) : d;
    return d > PI ? 2 * PI - d : d;
}

double asj_angle_wrap(double angle)
{
    angle = fabs(angle) >= 2 * PI ? fmod(angle, 2 * PI) : angle;
    angle = angle < 0 ? angle + 2 * PI : angle;
    return (float)angle < 6.2831853f ? angle : 0; /* results are floats: what rounds to 2 pi is 0, in every order of angles */
}

void asj_draft_select(asj_draft *draft, const int *keep)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < draft->branch_count; i++)
        if (keep[i])
            draft->branches[kept++] = draft->branches[i];
    draft->branch_count = kept;
}

int asj_draft_has_opening(const asj_draft *draft, double least)
{
    for (int32_t i = 0; i < draft->branch_count; i++)
        for (int32_t j = i + 1; j < draft->branch_count; j++) {
            double d = asj_angle_distance(draft->branches[i].angle, draft->branches[j].angle);
            if (d > 0 && d < PI && d >= least && d <= PI - least)
                return 1;
        }
    return 0;
}
