/* SPDX-License-Identifier: BSD-2-Clause */
/* The rule is that of the matches of two images (match/segment_join.c), for one image: both ends of the shorter lie on the longer's
 * line, and they share more than an end's uncertainty, or the shorter lies in the longer (course.c). An end that goes on beyond the
 * longer's moves its end there; a junction that a branch begins at is a better end than one beside it that is none.
 *
 * Of many branches along an edge the one that overshoots most would be its end. So a corner that turns (no branch of it goes on) is
 * the end of what goes on by OVERSHOOT at most and ends at no corner. Rendered rooms (tests/accuracy/lines.c), when that was new:
 * of the true edges .948 had a line in place of .931, and .934 of the lines were true in place of .923. Six photographs have 43
 * such corners; of 18 looked at 14 are the end. */
#include "one_edge.h"

#include <math.h>

#define OVERSHOOT 24.0       /* px, and no more than .. */
#define OVERSHOOT_SHARE 0.5  /* .. this part of the segment */

int32_t asj_is_one_edge(const asj_segment *longer, const asj_segment *shorter, asj_course *c)
{
    const asj_end_point ends[2] = {asj_segment_end(longer, 0), asj_segment_end(longer, 1)};
    const asj_end_point of_shorter[2] = {asj_segment_end(shorter, 0), asj_segment_end(shorter, 1)};
    if (!asj_course_along(ends, of_shorter, c))
        return 0;
    const int32_t back = asj_course_is_back(c);
    const int32_t inside = !asj_course_is_beyond(c, 0, back) && !asj_course_is_beyond(c, 1, !back);
    return asj_course_shared(c) > (inside ? 0 : c->overlap);
}

void asj_take_end(asj_segment *s, int32_t end, const asj_segment *t, int32_t from)
{
    const float x = from == 0 ? t->x1 : t->x2, y = from == 0 ? t->y1 : t->y2, sd = from == 0 ? t->sd1 : t->sd2;
    const int32_t kind = from == 0 ? t->end1 : t->end2;
    const uint32_t junction = from == 0 ? t->junction1 : t->junction2;
    if (end == 0)
        s->x1 = x, s->y1 = y, s->sd1 = sd, s->end1 = kind, s->junction1 = junction;
    else
        s->x2 = x, s->y2 = y, s->sd2 = sd, s->end2 = kind, s->junction2 = junction;
}

void asj_take_nfa(asj_segment *longer, const asj_segment *shorter)
{
    longer->log10_nfa = fminf(longer->log10_nfa, shorter->log10_nfa);
}

static uint32_t junction_at(const asj_segment *s, int32_t end)
{
    return end == 0 ? s->junction1 : s->junction2;
}

/* A corner at which the segment ends: no branch of the junction goes on the way that the segment comes. */
static int32_t turns_at(const asj_junction *junctions, const asj_segment *s, int32_t end)
{
    const uint32_t at = junction_at(s, end);
    if (at == ASJ_NO_JUNCTION)
        return 0;
    const asj_end_point from = asj_segment_end(s, !end), to = asj_segment_end(s, end);
    const double dx = to.x - from.x, dy = to.y - from.y, length = sqrt(dx * dx + dy * dy);
    for (int32_t b = 0; b < junctions[at].branch_count; b++) {
        const double angle = (double)junctions[at].branches[b].angle;
        if (dx * cos(angle) + dy * sin(angle) > ASJ_STRAIGHT * length)
            return 0;
    }
    return 1;
}

/* How far the longer goes on beyond an end of the shorter; below 0: the shorter beyond the longer. */
static double excess(const asj_course *c, int32_t end, int32_t of_shorter)
{
    return end == 0 ? c->at[of_shorter] : c->length - c->at[of_shorter];
}

/* Whether the shorter's end is that of both: where it goes on beyond the longer's, or is a corner and the longer's is none.
 * A corner that goes on is no end of what goes on by more than ASJ_SAME_END. */
static int32_t is_end_of_both(const asj_junction *junctions, const asj_segment *longer, const asj_segment *shorter,
                              const asj_course *c, int32_t end, int32_t far)
{
    const double beyond = excess(c, end, far), most = fmax(c->same_end, fmin(OVERSHOOT, OVERSHOOT_SHARE * c->length));
    const int32_t has = junction_at(longer, end) != ASJ_NO_JUNCTION, has_other = junction_at(shorter, far) != ASJ_NO_JUNCTION;
    if (has && beyond < -ASJ_SAME_END && !turns_at(junctions, longer, end))
        return 1;
    if (beyond < -c->same_end)
        return !has || has_other || beyond < -most;
    if (has || !has_other)
        return 0;
    return beyond <= ASJ_SAME_END || (beyond <= most && turns_at(junctions, shorter, far));
}

int32_t asj_become_one_edge(const asj_junction *junctions, asj_segment *longer, const asj_segment *shorter, const asj_course *c)
{
    const int32_t back = asj_course_is_back(c);
    int32_t is_moved[2];
    for (int32_t end = 0; end < 2; end++)
        is_moved[end] = is_end_of_both(junctions, longer, shorter, c, end, end == 0 ? back : !back);
    for (int32_t end = 0; end < 2; end++)
        if (is_moved[end])
            asj_take_end(longer, end, shorter, end == 0 ? back : !back);
    asj_take_nfa(longer, shorter);
    return is_moved[0] || is_moved[1];
}
