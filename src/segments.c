/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, line segments: which parts of two matched branches correspond, and the matches as segment matches.
 *
 * A branch ends where the scan lost it: at a corner, behind something, or where contrast gave out. Only ends at the same scene
 * point make a segment match. With s = |A u| the magnification of the refined map along the branch (u its unit vector in image
 * 1), lengths l1 and l2 agree when s l1 and l2 differ by a factor of at most 1 + end_tolerance. Of all combinations of the
 * branches' length hypotheses that agree, the longest is taken. When none agrees, the longer branch is cut where the map puts
 * the other's end: the part that both images show. */
#include "segments.h"

#include <math.h>

#define DUPLICATE_DISTANCE 4.0 /* px */

void asj_find_common_end(const asj_match_options *options, const asj_view *view1, const asj_view *view2, const asj_candidate *c,
                         int32_t branch, asj_common_end *end)
{
    const asj_lengths *h1 = &view1->corners.lengths[2 * (size_t)c->i + (size_t)branch];
    const asj_lengths *h2 = &view2->corners.lengths[2 * (size_t)c->j + (size_t)branch];
    const double *u = view1->corners.direction + 4 * (size_t)c->i + 2 * branch;
    double x = c->map.to[0] * u[0] + c->map.to[1] * u[1], y = c->map.to[2] * u[0] + c->map.to[3] * u[1];
    const double scale = sqrt(x * x + y * y), most = 1 + options->end_tolerance;
    double longest = 0;
    for (int32_t m = 0; m < h1->count; m++)
        for (int32_t n = 0; n < h2->count; n++) {
            double l1 = (double)h1->length[m], l2 = (double)h2->length[n], mapped = scale * l1;
            double shorter = mapped < l2 ? mapped : l2, longer = mapped < l2 ? l2 : mapped;
            if (longer > shorter * most || shorter <= longest)
                continue;
            longest = shorter;
            *end = (asj_common_end){l1, l2, m == 0 && n == 0 ? ASJ_END_BOTH : ASJ_END_INNER};
        }
    if (longest > 0)
        return;
    double l1 = (double)h1->length[0], l2 = (double)h2->length[0];
    *end = scale * l1 > l2 ? (asj_common_end){l2 / scale, l2, ASJ_END_CUT} : (asj_common_end){l1, scale * l1, ASJ_END_CUT};
}

/* --- matches as segment matches ---------------------------------------------------------------------------------------------- */

static void segment_of(const asj_junction_match *m, uint32_t index, int32_t branch, asj_segment_match *s)
{
    *s = branch == 0
        ? (asj_segment_match){index, m->end_a, m->x1, m->y1, m->ax1, m->ay1, m->x2, m->y2, m->ax2, m->ay2}
        : (asj_segment_match){index, m->end_b, m->x1, m->y1, m->bx1, m->by1, m->x2, m->y2, m->bx2, m->by2};
}

static double length2(float x1, float y1, float x2, float y2)
{
    double dx = (double)x2 - (double)x1, dy = (double)y2 - (double)y1;
    return dx * dx + dy * dy;
}

/* Is the point within DUPLICATE_DISTANCE of the segment? */
static int on_segment(float px, float py, float x1, float y1, float x2, float y2)
{
    double dx = (double)x2 - (double)x1, dy = (double)y2 - (double)y1, square = dx * dx + dy * dy;
    double ex = (double)px - (double)x1, ey = (double)py - (double)y1;
    double t = square > 0 ? (ex * dx + ey * dy) / square : 0;
    t = t < 0 ? 0 : t > 1 ? 1 : t;
    ex -= t * dx;
    ey -= t * dy;
    return ex * ex + ey * ey <= DUPLICATE_DISTANCE * DUPLICATE_DISTANCE;
}

/* Does s lie on t in both images? */
static int covered(const asj_segment_match *s, const asj_segment_match *t)
{
    return on_segment(s->x1, s->y1, t->x1, t->y1, t->ex1, t->ey1) && on_segment(s->ex1, s->ey1, t->x1, t->y1, t->ex1, t->ey1) &&
           on_segment(s->x2, s->y2, t->x2, t->y2, t->ex2, t->ey2) && on_segment(s->ex2, s->ey2, t->x2, t->y2, t->ex2, t->ey2);
}

/* Is there a longer pair (or an equal one that comes first) that covers s, number n? */
static int duplicate(const asj_match_result *result, int32_t minimum_end, const asj_segment_match *s, uint32_t n)
{
    const double mine = length2(s->x1, s->y1, s->ex1, s->ey1);
    for (uint32_t k = 0; k < 2 * result->match_count; k++) {
        asj_segment_match t;
        segment_of(&result->matches[k / 2], k / 2, (int32_t)(k & 1), &t);
        double theirs = length2(t.x1, t.y1, t.ex1, t.ey1);
        if (k != n && t.end >= minimum_end && (theirs > mine || (theirs == mine && k < n)) && covered(s, &t))
            return 1;
    }
    return 0;
}

size_t asj_match_segments(const asj_match_result *result, int32_t minimum_end, asj_segment_match *segments, size_t capacity)
{
    size_t count = 0;
    for (uint32_t k = 0; result && k < 2 * result->match_count; k++) {
        asj_segment_match s;
        segment_of(&result->matches[k / 2], k / 2, (int32_t)(k & 1), &s);
        if (s.end < minimum_end || duplicate(result, minimum_end, &s, k))
            continue;
        if (segments && count < capacity)
            segments[count] = s;
        count++;
    }
    return count;
}
