/* SPDX-License-Identifier: BSD-2-Clause */
/* With a and b the longer's ends, d = b - a, and p an end of the shorter,
 *
 *     across = (d x (p - a)) / |d|,   along = d . (p - a) / |d|. */
#include "course.h"
#include "core/angle.h"

#include <math.h>

#define MOST 12.0 /* px: more would cut long edges at corners on them */
#define ALONG 0.9 /* cosine of 26 degrees, by which even short parts are not turned */

double asj_same_end(double length)
{
    return fmax(ASJ_SAME_END, fmin(MOST, ASJ_SAME_END_SHARE * length));
}

int32_t asj_course_along(const asj_end_point longer[2], const asj_end_point shorter[2], asj_course *c)
{
    const double dx = longer[1].x - longer[0].x, dy = longer[1].y - longer[0].y, length2 = dx * dx + dy * dy;
    for (int32_t end = 0; end < 2; end++) {
        const double px = shorter[end].x - longer[0].x, py = shorter[end].y - longer[0].y;
        const double across = dx * py - dy * px; /* px times the length */
        if (!(across * across <= ASJ_OFF_LINE * ASJ_OFF_LINE * length2))
            return 0;
        c->at[end] = dx * px + dy * py;
    }
    c->length = sqrt(length2);
    c->at[0] /= c->length;
    c->at[1] /= c->length;
    const double sx = shorter[1].x - shorter[0].x, sy = shorter[1].y - shorter[0].y, of_shorter = sqrt(sx * sx + sy * sy);
    c->same_end = asj_same_end(c->length);
    c->overlap = asj_same_end(of_shorter);
    return fabs(c->at[1] - c->at[0]) >= ALONG * of_shorter && length2 > 0;
}

/* Both ends within ASJ_OFF_LINE of the line, and ALONG. */
double asj_course_most_turn(double of_shorter)
{
    if (!(of_shorter > 0))
        return ASJ_PI;
    return fmin(acos(ALONG), asin(fmin(1, 2 * ASJ_OFF_LINE / of_shorter)));
}

int32_t asj_course_is_back(const asj_course *c)
{
    return c->at[1] < c->at[0];
}

double asj_course_shared(const asj_course *c)
{
    return fmin(fmax(c->at[0], c->at[1]), c->length) - fmax(fmin(c->at[0], c->at[1]), 0);
}

int32_t asj_course_is_beyond(const asj_course *c, int32_t end, int32_t of_shorter)
{
    return end == 0 ? c->at[of_shorter] < -c->same_end : c->at[of_shorter] > c->length + c->same_end;
}

int32_t asj_course_is_beside(const asj_course *c, int32_t end, int32_t of_shorter)
{
    return fabs(c->at[of_shorter] - (end == 0 ? 0 : c->length)) <= c->same_end;
}
