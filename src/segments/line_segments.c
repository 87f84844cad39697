/* SPDX-License-Identifier: BSD-2-Clause */
/* Line segments: regions of samples that share the direction of their level lines, each tested as a rectangle.
 *
 * Source: von Gioi, Jakubowicz, Morel, Randall, "LSD: A fast line segment detector with a false detection control", PAMI 32(4),
 * 2010: the level-line field (line_segments_levels.c), region growing from the steepest samples on and its refinement
 * (line_segments_region.c), rectangles (line_segments_rectangle.c), their number of false alarms (line_segments_nfa.c). Here: which
 * regions are tested, and the rectangle's improvement (section 2.9): when it is not meaningful, it is tried again with its pixels
 * counted at precisions p / 2 .. p / 32, then, with each in turn, up to five times half a sample narrower: on both sides, then on
 * the one, then on the other. What is kept is whatever has the fewest false alarms.
 *
 * n aligned samples have at least 6 (N M)^(5/2) p^n false alarms at the precision that they grew with; smaller regions are passed
 * over, as in the article. */
#include "line_segments.h"

#include "line_segments_nfa.h"
#include "line_segments_region.h"
#include "core/watch.h"

#include <math.h>
#include <string.h>

#define PRECISION 0.125 /* of the tolerance: 22.5 of 180 degrees */
#define NARROWER 0.5    /* samples */
#define TRIALS 5

/* cos(pi / 8), cos(pi / 16), .. */
static const float cosines[ASJ_SEGMENT_PRECISIONS] = {0.92387953f, 0.98078528f, 0.99518473f, 0.99879546f, 0.99969882f, 0.9999247f};

typedef struct search {
    asj_levels levels;
    asj_support_region region;
    double log_tests, log_epsilon;
    int32_t least;        /* samples of a region that is tested */
    asj_line_segments found; /* room for as many as there are such regions at most */
} search;

/* ln of the fewest false alarms of a rectangle over the precisions. */
static double log_alarms(const search *s, const asj_rectangle *r)
{
    int32_t aligned[ASJ_SEGMENT_PRECISIONS];
    const int32_t n = asj_rectangle_count(&s->levels, r, cosines, ASJ_SEGMENT_PRECISIONS, aligned);
    double best = HUGE_VAL, p = PRECISION;
    for (int32_t i = 0; i < ASJ_SEGMENT_PRECISIONS; i++, p /= 2)
        best = fmin(best, s->log_tests + asj_segment_log_tail(n, aligned[i], p));
    return best;
}

/* Makes it narrower as long as that is possible, and keeps the best. */
static void try_narrower(const search *s, double low, double high, asj_rectangle *best, double *log_nfa)
{
    asj_rectangle r = *best;
    for (int32_t i = 0; i < TRIALS && r.high - r.low > NARROWER; i++) {
        r.low += low;
        r.high -= high;
        const double alarms = log_alarms(s, &r);
        if (alarms < *log_nfa) {
            *log_nfa = alarms;
            *best = r;
        }
    }
}

static double improve(const search *s, asj_rectangle *r)
{
    double log_nfa = log_alarms(s, r);
    if (log_nfa > s->log_epsilon)
        try_narrower(s, NARROWER / 2, NARROWER / 2, r, &log_nfa);
    if (log_nfa > s->log_epsilon)
        try_narrower(s, NARROWER, 0, r, &log_nfa);
    if (log_nfa > s->log_epsilon)
        try_narrower(s, 0, NARROWER, r, &log_nfa);
    return log_nfa;
}

static asj_line_segment segment_of(const asj_rectangle *r, double log_nfa)
{
    const double across = 0.5 * (r->low + r->high), x = r->x - across * r->uy, y = r->y + across * r->ux;
    return (asj_line_segment){asj_levels_place(x + r->first * r->ux), asj_levels_place(y + r->first * r->uy),
                              asj_levels_place(x + r->last * r->ux), asj_levels_place(y + r->last * r->uy),
                              asj_rectangle_width(r) / ASJ_LEVELS_SCALE, log_nfa};
}

/* The region around a sample that belongs to none yet. One that is too small frees nothing: its samples would not do better. */
static void test_region(search *s, int32_t seed)
{
    asj_rectangle rectangle;
    asj_region_grow(&s->levels, seed, ASJ_REGION_COSINE, &s->region);
    if (s->region.count < s->least || !asj_region_approximate(&s->levels, &s->region, &rectangle) || s->region.count < s->least)
        return;
    const double log_nfa = improve(s, &rectangle);
    if (log_nfa <= s->log_epsilon)
        s->found.list[s->found.count++] = segment_of(&rectangle, log_nfa);
}

typedef struct job {
    search *searches;
    asj_watch *watch;
} job;

static void test_some(const void *data, const asj_part *part)
{
    const job *j = data;
    for (int64_t n = part->first; n < part->end; n++) {
        search *s = &j->searches[n];
        for (int32_t i = 0; i < s->levels.order_count; i++) {
            if (s->region.used[s->levels.order[i]])
                continue;
            if (asj_watch_stops(j->watch, part))
                return;
            test_region(s, s->levels.order[i]);
        }
    }
}

static asj_status prepare(asj_context *context, const asj_frame *frame, int32_t stage, double epsilon, search *s)
{
    asj_memory *memory = &context->memory;
    const asj_status status = asj_levels_create(context, frame, stage, &s->levels);
    if (status != ASJ_OK || s->levels.order_count == 0)
        return status;
    const size_t samples = (size_t)s->levels.width * (size_t)s->levels.height;
    s->log_epsilon = log(epsilon);
    s->log_tests = asj_segment_log_tests(s->levels.width, s->levels.height);
    s->least = (int32_t)ceil(fmax((s->log_tests - s->log_epsilon) / -log(PRECISION), 2));
    s->region.samples = asj_allocate(memory, samples, sizeof *s->region.samples);
    s->region.used = asj_allocate_zero(memory, samples, sizeof *s->region.used);
    s->found.list = asj_allocate(memory, (size_t)(s->levels.order_count / s->least), sizeof *s->found.list);
    if (s->region.samples && s->region.used && s->found.list)
        return ASJ_OK;
    return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the line segments of %d x %d pixels", (int)frame->width,
                    (int)frame->height);
}

asj_status asj_line_segments_find_each(asj_context *context, const asj_frame *frames, int32_t count, int32_t stage, double epsilon,
                                       asj_line_segments *found)
{
    asj_memory *memory = &context->memory;
    search searches[ASJ_SEGMENT_IMAGES];
    asj_status status = ASJ_OK;
    memset(searches, 0, sizeof searches);
    for (int32_t n = 0; n < count && status == ASJ_OK; n++)
        status = prepare(context, &frames[n], stage, epsilon, &searches[n]);
    if (status == ASJ_OK) {
        asj_watch watch;
        const job j = {searches, &watch};
        asj_watch_start(&watch, context, stage);
        asj_parallel(context, context->threads, count, 1, test_some, &j);
        status = asj_watch_end(&watch);
    }
    for (int32_t n = 0; n < count; n++) {
        search *s = &searches[n];
        if (status != ASJ_OK || s->found.count == 0) {
            asj_release(memory, s->found.list);
            s->found = (asj_line_segments){NULL, 0};
        }
        found[n] = s->found;
        asj_release(memory, s->region.samples);
        asj_release(memory, s->region.used);
        asj_levels_free(memory, &s->levels);
    }
    return status;
}

asj_status asj_line_segments_find(asj_context *context, const asj_frame *frame, int32_t stage, double epsilon,
                                  asj_line_segment **segments, size_t *count)
{
    asj_line_segments found;
    const asj_status status = asj_line_segments_find_each(context, frame, 1, stage, epsilon, &found);
    *segments = found.list;
    *count = found.count;
    return status;
}
