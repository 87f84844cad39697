/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, line segments: which parts of two matched branches correspond, and the matches as segment matches.
 *
 * A branch ends where the scan lost it: at a corner, behind something, or where contrast gave out. Only ends at the same scene
 * point make a segment match. With s = |A u| the magnification of the refined map along the branch (u its unit vector in image
 * 1), lengths l1 and l2 agree when s l1 and l2 differ by a factor of at most 1 + end_tolerance. Of all combinations of the
 * branches' length hypotheses that agree, the longest is taken; own lengths agree only where what is at the ends does not speak
 * against it. When none agrees, the longer branch is cut where the map puts the other's end: the part that both images show. */
#include "segments.h"

#include <math.h>

/* Whether another edge is at an end. */
static int is_met(int32_t end)
{
    return end == ASJ_BRANCH_END_JUNCTION || end == ASJ_BRANCH_END_CROSSING || end == ASJ_BRANCH_END_OCCLUSION;
}

/* Whether two ends may be one place of the scene. Of equal kinds they may. A crossing is a junction that was not found in one of
 * the images, and so may an occlusion be, which is a T. Where one edge fades or leaves the picture and the other does not, that
 * they are equally long is chance: of such segments of sixteen pairs of photographs 33 to 73 % were right, of others 80 to 92 %.
 * */
static int may_correspond(int32_t one, int32_t other)
{
    return one == other || (is_met(one) && is_met(other)) || one == ASJ_BRANCH_END_UNKNOWN || other == ASJ_BRANCH_END_UNKNOWN;
}

asj_common_end asj_find_common_end(const asj_match_run *run, const asj_candidate *c, int32_t branch)
{
    const asj_l_junctions *in1 = &run->image[0]->l_junctions, *in2 = &run->image[1]->l_junctions;
    const asj_lengths *h1 = &in1->lengths[2 * (size_t)c->i + (size_t)branch];
    const asj_lengths *h2 = &in2->lengths[2 * (size_t)c->j + (size_t)branch];
    const double *u = in1->direction + 4 * (size_t)c->i + 2 * branch;
    const double x = c->map.to[0] * u[0] + c->map.to[1] * u[1], y = c->map.to[2] * u[0] + c->map.to[3] * u[1];
    const double scale = sqrt(x * x + y * y), most = 1 + run->options->end_tolerance;
    asj_common_end end = {0, 0, ASJ_END_CUT};
    double longest = 0;
    for (int32_t m = 0; m < h1->count; m++)
        for (int32_t n = 0; n < h2->count; n++) {
            const double l1 = (double)h1->length[m], l2 = (double)h2->length[n], mapped = scale * l1;
            const double shorter = mapped < l2 ? mapped : l2, longer = mapped < l2 ? l2 : mapped;
            if (longer > shorter * most || shorter <= longest || (m == 0 && n == 0 && !may_correspond(h1->end, h2->end)))
                continue;
            longest = shorter;
            end = (asj_common_end){l1, l2, m == 0 && n == 0 ? ASJ_END_BOTH : ASJ_END_INNER};
        }
    if (longest > 0)
        return end;
    const double l1 = (double)h1->length[0], l2 = (double)h2->length[0];
    return scale * l1 > l2 ? (asj_common_end){l2 / scale, l2, ASJ_END_CUT} : (asj_common_end){l1, scale * l1, ASJ_END_CUT};
}

/* --- matches as segment matches ------------------------------------------------------------------------------------------------
 *
 * A match says which junctions are one point, so their other branches correspond as well: each to the one that the map turns it
 * towards. Their ends are judged like those of the two that made the match, by their own lengths.
 *
 * An edge between two matched junctions is found from both its ends. Such duplicates are pairs whose ends lie together in both
 * images; the one with the better known end stays, of equals the first. A pair that is a part of another is no duplicate: it
 * ends elsewhere, and so is another segment. */

#define LEAST_TURN_COSINE 0.978147601       /* cosine of 12 degrees: half the least opening of branches of the detector, and less */
#define END_TOLERANCE 0.12     /* as the option's default */
#define SAME_END 4.0           /* px, or .. */
#define SAME_END_SHARE 0.05    /* .. this part of the length */
#define SLOTS ASJ_MAX_BRANCHES /* segment pairs of one match: its branches a and b, then others */

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

/* The pair of branch k of b1 and what corresponds to it in b2; 0 when nothing does. */
static int pair_up(const asj_junction_match *m, uint32_t index, const bundle *b1, const bundle *b2, int32_t k, asj_segment_match *s)
{
    const double x1 = b1->x[k], y1 = b1->y[k], x = m->affine[0] * x1 + m->affine[1] * y1, y = m->affine[3] * x1 + m->affine[4] * y1;
    const int32_t partner = along(b2, x, y);
    if (partner < 0 || along(b1, x1, y1) != k)
        return 0;
    const double x2 = b2->x[partner], y2 = b2->y[partner], mapped = sqrt(x * x + y * y), own = sqrt(x2 * x2 + y2 * y2);
    double part1 = 1, part2 = 1;
    const int cut = mapped > own * (1 + END_TOLERANCE) || own > mapped * (1 + END_TOLERANCE);
    if (cut && mapped > own)
        part1 = own / mapped;
    else if (cut)
        part2 = mapped / own;
    *s = (asj_segment_match){index, cut ? ASJ_END_CUT : ASJ_END_BOTH,
                             m->x1, m->y1, (float)((double)m->x1 + part1 * x1), (float)((double)m->y1 + part1 * y1),
                             m->x2, m->y2, (float)((double)m->x2 + part2 * x2), (float)((double)m->y2 + part2 * y2)};
    return 1;
}

/* Pair number `slot` of match `index`; 0 when there is none. */
static int segment_of(const asj_match_result *result, uint32_t index, int32_t slot, asj_segment_match *s)
{
    const asj_junction_match *m = &result->matches[index];
    if (slot < 2) {
        *s = slot == 0
            ? (asj_segment_match){index, m->end_a, m->x1, m->y1, m->ax1, m->ay1, m->x2, m->y2, m->ax2, m->ay2}
            : (asj_segment_match){index, m->end_b, m->x1, m->y1, m->bx1, m->by1, m->x2, m->y2, m->bx2, m->by2};
        return 1;
    }
    if (m->l1 >= result->l_junction_count1 || m->l2 >= result->l_junction_count2)
        return 0;
    bundle b1, b2;
    collect(result->l_junctions1, result->l_junction_count1, m->l1, &b1);
    collect(result->l_junctions2, result->l_junction_count2, m->l2, &b2);
    for (int32_t k = 0; k < ASJ_MAX_BRANCHES; k++)
        if (b1.known[k] && --slot < 2)
            return pair_up(m, index, &b1, &b2, k, s);
    return 0;
}

static double distance2(float x1, float y1, float x2, float y2)
{
    double dx = (double)x2 - (double)x1, dy = (double)y2 - (double)y1;
    return dx * dx + dy * dy;
}

/* Do the ends lie together in both images, in this order or the other? */
static int same(const asj_segment_match *s, const asj_segment_match *t)
{
    const double l1 = distance2(s->x1, s->y1, s->ex1, s->ey1), l2 = distance2(s->x2, s->y2, s->ex2, s->ey2);
    const double least = SAME_END * SAME_END, share = SAME_END_SHARE * SAME_END_SHARE;
    const double near1 = share * l1 > least ? share * l1 : least, near2 = share * l2 > least ? share * l2 : least;
    return (distance2(s->x1, s->y1, t->x1, t->y1) <= near1 && distance2(s->ex1, s->ey1, t->ex1, t->ey1) <= near1 &&
            distance2(s->x2, s->y2, t->x2, t->y2) <= near2 && distance2(s->ex2, s->ey2, t->ex2, t->ey2) <= near2) ||
           (distance2(s->x1, s->y1, t->ex1, t->ey1) <= near1 && distance2(s->ex1, s->ey1, t->x1, t->y1) <= near1 &&
            distance2(s->x2, s->y2, t->ex2, t->ey2) <= near2 && distance2(s->ex2, s->ey2, t->x2, t->y2) <= near2);
}

/* Whether a segment of match m, each of which begins at the match's location, can be the same pair as s: that place would lie
 * together with an end of s. Nearly all matches are told apart by this alone. */
static int can_be_same(const asj_segment_match *s, const asj_junction_match *m)
{
    const double l1 = distance2(s->x1, s->y1, s->ex1, s->ey1), least = SAME_END * SAME_END, share = SAME_END_SHARE * SAME_END_SHARE;
    const double near1 = share * l1 > least ? share * l1 : least;
    return distance2(s->x1, s->y1, m->x1, m->y1) <= near1 || distance2(s->ex1, s->ey1, m->x1, m->y1) <= near1;
}

/* Is there the same pair with a better known end, or an equally known one that comes first? */
static int duplicate(const asj_match_result *result, int32_t minimum_end, const asj_segment_match *s, int32_t slot)
{
    for (uint32_t k = 0; k < result->match_count; k++)
        for (int32_t n = 0; n < SLOTS && can_be_same(s, &result->matches[k]); n++) {
            asj_segment_match t;
            if ((k == s->match && n == slot) || !segment_of(result, k, n, &t) || t.end < minimum_end)
                continue;
            const int before = k < s->match || (k == s->match && n < slot);
            if ((t.end > s->end || (t.end == s->end && before)) && same(s, &t))
                return 1;
        }
    return 0;
}

size_t asj_match_segments(const asj_match_result *result, int32_t minimum_end, asj_segment_match *segments, size_t capacity)
{
    size_t count = 0;
    for (uint32_t k = 0; result && k < result->match_count; k++)
        for (int32_t n = 0; n < SLOTS; n++) {
            asj_segment_match s;
            if (!segment_of(result, k, n, &s) || s.end < minimum_end || duplicate(result, minimum_end, &s, n))
                continue;
            if (segments && count < capacity)
                segments[count] = s;
            count++;
        }
    return count;
}
