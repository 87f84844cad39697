/* SPDX-License-Identifier: BSD-2-Clause */
/* Matches as segment matches.
 *
 * A match says which junctions are one point, so their other branches correspond as well: each to the one that the map turns it
 * towards. Their ends are judged like those of the two that made the match (segments.c), by their own lengths; what is at them is
 * not asked.
 *
 * An edge between two matched junctions is found from both its ends. Such duplicates are pairs whose ends lie together in both
 * images; the one with the better known end stays, of equals the first. A pair that is a part of another is no duplicate: it
 * ends elsewhere, and so is another segment. */
#include "segment_matches.h"

#include "match_result.h"
#include "segments.h"
#include "segments/course.h"

#include <math.h>

#define LEAST_TURN_COSINE 0.978147601       /* cosine of 12 degrees: half the least opening of branches of the detector, and less */
#define ROUNDING 1e-6          /* of a coordinate: more than single precision is off */
#define SLOTS ASJ_MAX_BRANCHES /* segment pairs of one match: its branches a and b, then others */

/* What segments are looked for among. */
typedef struct search {
    const asj_match_result *result;
    const asj_around *around;
    int32_t minimum_end;
    double end_tolerance;
} search;

/* Branches of one junction, as its L-junctions name them: ends relative to the location. */
typedef struct bundle {
    int32_t known[ASJ_MAX_BRANCHES];
    double x[ASJ_MAX_BRANCHES], y[ASJ_MAX_BRANCHES];
} bundle;

static void tie(bundle *b, const asj_l_junction *l, uint16_t branch, float ex, float ey)
{
    if (branch >= ASJ_MAX_BRANCHES)
        return;
    b->known[branch] = 1;
    b->x[branch] = (double)ex - (double)l->x;
    b->y[branch] = (double)ey - (double)l->y;
}

/* L-junctions of a junction follow each other. The branches of `l` itself are left out. */
static void collect(const asj_l_junction *list, uint32_t count, uint32_t l, bundle *b)
{
    uint32_t first = l;
    *b = (bundle){{0}, {0}, {0}};
    while (first > 0 && list[first - 1].junction == list[l].junction)
        first--;
    for (uint32_t k = first; k < count && list[k].junction == list[l].junction; k++) {
        tie(b, &list[k], list[k].branch_a, list[k].ax, list[k].ay);
        tie(b, &list[k], list[k].branch_b, list[k].bx, list[k].by);
    }
    if (list[l].branch_a < ASJ_MAX_BRANCHES)
        b->known[list[l].branch_a] = 0;
    if (list[l].branch_b < ASJ_MAX_BRANCHES)
        b->known[list[l].branch_b] = 0;
}

/* The branch of b that (x, y) points along, or -1. */
static int32_t along(const bundle *b, double x, double y)
{
    const double length = sqrt(x * x + y * y);
    double best = LEAST_TURN_COSINE;
    int32_t found = -1;
    for (int32_t k = 0; k < ASJ_MAX_BRANCHES; k++) {
        const double own = sqrt(b->x[k] * b->x[k] + b->y[k] * b->y[k]);
        if (b->known[k] && own > 0 && x * b->x[k] + y * b->y[k] > best * length * own) {
            best = (x * b->x[k] + y * b->y[k]) / (length * own);
            found = k;
        }
    }
    return found;
}

/* A branch of a match that is not one of its two, in both images: its lengths as detected, and its numbers. */
typedef struct other_branch {
    asj_matched_branch line;
    double length[2];
    int32_t number[2];
} other_branch;

/* Branch k of b1 and what corresponds to it in b2; 0 when nothing does. */
static int pair_up(const search *in, const asj_junction_match *m, const bundle *b1, const bundle *b2, int32_t k,
                   other_branch *other)
{
    const double x1 = b1->x[k], y1 = b1->y[k], x = m->affine[0] * x1 + m->affine[1] * y1, y = m->affine[3] * x1 + m->affine[4] * y1;
    const int32_t partner = along(b2, x, y);
    if (partner < 0 || along(b1, x1, y1) != k)
        return 0;
    const double x2 = b2->x[partner], y2 = b2->y[partner], l1 = sqrt(x1 * x1 + y1 * y1), l2 = sqrt(x2 * x2 + y2 * y2);
    const asj_l_junction *j1 = &in->result->l_junctions1[m->l1], *j2 = &in->result->l_junctions2[m->l2];
    const asj_matched_branch line = {m, {(double)j1->x, (double)j2->x}, {(double)j1->y, (double)j2->y}, {x1 / l1, x2 / l2},
                                     {y1 / l1, y2 / l2}};
    *other = (other_branch){line, {l1, l2}, {k, partner}};
    return 1;
}

/* The branch of slot 2 or later of a match; 0 when there is none. */
static int other_branch_of(const search *in, const asj_junction_match *m, int32_t slot, other_branch *other)
{
    const asj_match_result *result = in->result;
    if (m->l1 >= result->l_junction_count1 || m->l2 >= result->l_junction_count2)
        return 0;
    bundle b1, b2;
    collect(result->l_junctions1, result->l_junction_count1, m->l1, &b1);
    collect(result->l_junctions2, result->l_junction_count2, m->l2, &b2);
    for (int32_t k = 0; k < ASJ_MAX_BRANCHES; k++)
        if (b1.known[k] && --slot < 2)
            return pair_up(in, m, &b1, &b2, k, other);
    return 0;
}

/* As a segment, to the end that both images show. */
static asj_segment_match segment_along(const search *in, const other_branch *other)
{
    const asj_matched_branch *line = &other->line;
    const asj_junction_match *m = line->match;
    const asj_lengths own[2] = {{1, {(float)other->length[0]}, ASJ_BRANCH_END_UNKNOWN},
                                {1, {(float)other->length[1]}, ASJ_BRANCH_END_UNKNOWN}};
    const asj_lengths *lengths[2] = {&own[0], &own[1]};
    const asj_common_end end = asj_find_common_end(in->around, line, lengths, in->end_tolerance);
    double x[2], y[2];
    for (int32_t side = 0; side < 2; side++) {
        x[side] = line->x[side] + end.length[side] * line->ux[side];
        y[side] = line->y[side] + end.length[side] * line->uy[side];
    }
    return (asj_segment_match){(uint32_t)(m - in->result->matches), end.kind, m->x1, m->y1, (float)x[0], (float)y[0],
                               m->x2, m->y2, (float)x[1], (float)y[1], other->number[0], other->number[1], ASJ_END_CORNER};
}

/* The number of branch a (slot 0) or b of an L-junction. */
static int32_t branch_number(const asj_l_junction *list, uint32_t count, uint32_t l, int32_t slot)
{
    if (l >= count)
        return -1;
    return slot == 0 ? list[l].branch_a : list[l].branch_b;
}

/* Pair number 0 or 1 of match `index`: its branch a or b. */
static asj_segment_match matched_segment(const asj_match_result *result, uint32_t index, int32_t slot)
{
    const asj_junction_match *m = &result->matches[index];
    const int32_t n1 = branch_number(result->l_junctions1, result->l_junction_count1, m->l1, slot);
    const int32_t n2 = branch_number(result->l_junctions2, result->l_junction_count2, m->l2, slot);
    asj_segment_match s = {.match = index, .x1 = m->x1, .y1 = m->y1, .x2 = m->x2, .y2 = m->y2, .branch1 = n1, .branch2 = n2,
                           .start = ASJ_END_CORNER};
    if (slot == 0)
        s.end = m->end_a, s.ex1 = m->ax1, s.ey1 = m->ay1, s.ex2 = m->ax2, s.ey2 = m->ay2;
    else
        s.end = m->end_b, s.ex1 = m->bx1, s.ey1 = m->by1, s.ex2 = m->bx2, s.ey2 = m->by2;
    return s;
}

static double distance2(float x1, float y1, float x2, float y2)
{
    double dx = (double)x2 - (double)x1, dy = (double)y2 - (double)y1;
    return dx * dx + dy * dy;
}

/* px^2 within which ends are one, of a segment of this length (squared). However long: an edge seen from both its ends is one. */
static double same_end2(double length2)
{
    const double least = ASJ_SAME_END * ASJ_SAME_END, share = ASJ_SAME_END_SHARE * ASJ_SAME_END_SHARE * length2;
    return share > least ? share : least;
}

/* Do the ends lie together in both images, in this order or the other? */
static int same(const asj_segment_match *s, const asj_segment_match *t)
{
    const double l1 = distance2(s->x1, s->y1, s->ex1, s->ey1), l2 = distance2(s->x2, s->y2, s->ex2, s->ey2);
    const double near1 = same_end2(l1), near2 = same_end2(l2);
    return (distance2(s->x1, s->y1, t->x1, t->y1) <= near1 && distance2(s->ex1, s->ey1, t->ex1, t->ey1) <= near1 &&
            distance2(s->x2, s->y2, t->x2, t->y2) <= near2 && distance2(s->ex2, s->ey2, t->ex2, t->ey2) <= near2) ||
           (distance2(s->x1, s->y1, t->ex1, t->ey1) <= near1 && distance2(s->ex1, s->ey1, t->x1, t->y1) <= near1 &&
            distance2(s->x2, s->y2, t->ex2, t->ey2) <= near2 && distance2(s->ex2, s->ey2, t->x2, t->y2) <= near2);
}

/* Where duplicates of a segment s begin: each segment of a match begins at the match's location, and so that lies together with an
 * end of s. */
typedef struct surroundings {
    float x[2], y[2]; /* the ends of s */
    double near2;     /* px^2 */
} surroundings;

static surroundings around(const asj_segment_match *s)
{
    return (surroundings){{s->x1, s->ex1}, {s->y1, s->ey1}, same_end2(distance2(s->x1, s->y1, s->ex1, s->ey1))};
}

/* May a segment from m's location along this line of image 1 be the same? One end of s lies at the location, and then the other
 * not farther off the line. To find where the segment ends takes a hundred times as long as this. */
static int may_be_same(const surroundings *at, const asj_junction_match *m, const asj_matched_branch *line)
{
    const double off_most = sqrt(at->near2) + ROUNDING * (1 + fabs(line->x[0]) + fabs(line->y[0]));
    for (int32_t end = 0; end < 2; end++) {
        const double dx = (double)at->x[1 - end] - line->x[0], dy = (double)at->y[1 - end] - line->y[0];
        if (distance2(at->x[end], at->y[end], m->x1, m->y1) <= at->near2 && fabs(dy * line->ux[0] - dx * line->uy[0]) <= off_most)
            return 1;
    }
    return 0;
}

/* Pair number `slot` of match k; 0 when there is none, or, with surroundings, when it cannot be the segment whose they are. */
static int segment_of(const search *in, uint32_t k, int32_t slot, const surroundings *at, asj_segment_match *s)
{
    const asj_junction_match *m = &in->result->matches[k];
    other_branch other;
    if (slot < 2) {
        *s = matched_segment(in->result, k, slot);
        return 1;
    }
    if (!other_branch_of(in, m, slot, &other) || (at && !may_be_same(at, m, &other.line)))
        return 0;
    *s = segment_along(in, &other);
    return 1;
}

/* Has match k the same pair as s with a better known end, or an equally known one that comes first? */
static int match_has(const search *in, uint32_t k, const surroundings *at, const asj_segment_match *s, int32_t slot)
{
    const asj_junction_match *m = &in->result->matches[k];
    if (distance2(at->x[0], at->y[0], m->x1, m->y1) > at->near2 && distance2(at->x[1], at->y[1], m->x1, m->y1) > at->near2)
        return 0;
    for (int32_t n = 0; n < SLOTS; n++) {
        asj_segment_match t;
        if ((k == s->match && n == slot) || !segment_of(in, k, n, at, &t) || t.end < in->minimum_end)
            continue;
        const int before = k < s->match || (k == s->match && n < slot);
        if ((t.end > s->end || (t.end == s->end && before)) && same(s, &t))
            return 1;
    }
    return 0;
}

static int duplicate(const search *in, const asj_segment_match *s, int32_t slot)
{
    const surroundings at = around(s);
    if (!in->around->places[0]) {
        for (uint32_t k = 0; k < in->result->match_count; k++)
            if (match_has(in, k, &at, s, slot))
                return 1;
        return 0;
    }
    for (int32_t end = 0; end < 2; end++) {
        asj_place_walk walk = asj_places_near(in->around->places[0], in->around->place_count, at.x[end], at.y[end], sqrt(at.near2));
        for (uint32_t k; asj_places_next(&walk, &k);)
            if (k < in->result->match_count && match_has(in, k, &at, s, slot))
                return 1;
    }
    return 0;
}

size_t asj_segment_matches(const asj_match_result *result, const asj_around *around, int32_t minimum_end,
                           asj_segment_match *segments, size_t capacity)
{
    const search in = {result, around, minimum_end, asj_match_result_end_tolerance(result)};
    size_t count = 0;
    for (uint32_t k = 0; k < result->match_count; k++)
        for (int32_t n = 0; n < SLOTS; n++) {
            asj_segment_match s;
            if (!segment_of(&in, k, n, NULL, &s) || s.end < minimum_end || duplicate(&in, &s, n))
                continue;
            if (segments && count < capacity)
                segments[count] = s;
            count++;
        }
    return count;
}

size_t asj_match_segments(const asj_match_result *result, int32_t minimum_end, asj_segment_match *segments, size_t capacity)
{
    if (!result)
        return 0;
    const asj_around around = asj_match_result_around(result);
    return asj_segment_matches(result, &around, minimum_end, segments, capacity);
}
