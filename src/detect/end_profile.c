/* SPDX-License-Identifier: BSD-2-Clause */
/* The ray scan (ray_walk.c) follows an edge until noise has it. So an edge that fades, or that goes on as something much weaker,
 * ends where contrast, gain, noise and zoom happen to put that point. What belongs to the scene is where the edge has lost a share
 * f of its own contrast.
 *
 * Across the line the grey levels g(t, s) less their mean (edge_rows.c) are the edge's cross-section times its contrast at t. The
 * cross-section m comes from the means of g over blocks of BLOCK px along the branch, and
 *     a(t) = |<mean of g over t - 2 .. t + 2, m>|
 * is the contrast, and the branch's own contrast c is that of the best quarter of its blocks (the value three quarters of the way
 * up). The end is found in steps, the first two each the change point between an edge and nothing: the T with the largest
 *     C(T) = sum over t <= T of min(max(a(t) / c - f, -w), w),   w = min(f, 1 - f),
 * which is the place of a step down, and of a slow fade where a(t) = f c, whatever noise does, since many pixels decide. The limits
 * keep single places from deciding. But where a(t) is less than f c / 2, and less than DOUBT times what noise makes of it, there is
 * no edge at all, and such places count GAP times, without limit: a gap is bridged when GAP times as much edge follows it. So the
 * edges of two panels side by side stay two; a crossing of tiles, nothing for a place or two, is passed when some 10 px follow,
 * fewer being chance more often than not; and shading that slowly turns an edge's contrast round hardly makes a gap.
 *   1. Over the whole branch and BEYOND px more, with the share asked for: how far the edge goes. A small share lets it go on
 *      where what lies beside it changes.
 *   2. Over the last AROUND px of that, with f = 1/2 and c that of the last LAST px: where exactly it breaks off. Of what fades
 *      slowly nothing has broken off there, and the end stays.
 *   3. What the scan has followed beyond may be an edge all the same, of less than that share: a tile nearly as grey as the next.
 *      Where it is faint and uneven its end is a matter of chance. But the edge goes on when the rest is at least STEADY_LEAST px
 *      long without what smoothing blurs at its ends, its upper quartile of a(t) at least STEADY grey levels, and up to the change
 *      point with f = 1/2 as strong all along: at nine tenths of the places at least EVEN of what it is at the best tenth.
 * Chosen on 24 photographs and their copies (zoom, shift, blur, noise, compression, gain): BLOCK to LAST are one plateau, but
 * LAST >= 16 ends branches before last pieces as short as that. With step 3 random tiles had .899 of their lengths right and
 * without it .854. (Without step 3 a limit of 4 grey levels in place of the share would do the same, but 2 in 100 junctions of the
 * photographs would not repeat any more; step 3 costs none.) */
#include "end_profile.h"
#include "core/sort.h"

#include <math.h>

#define SAMPLES ASJ_EDGE_SAMPLES
#define BLOCK 8     /* px */
#define BLOCKS 24   /* of the part that says what the edge looks like, from the junction on */
#define BEYOND 8    /* px */
/* Rendered rooms: lines that are true .956 -> .968; whole junctions of photographs repeat a little more often under zoom. 6 to 10
 * are one plateau, but with 8 a checkerboard's lines end where its tiles have 10 px. Random tiles have .896 of their lengths right
 * for .900, without DOUBT .888. */
#define GAP 7
#define DOUBT 2.0
#define AROUND 16   /* px */
#define LAST 14     /* px */
#define MOST_FADING 100 /* px to either side */
#define STEADY 4.0        /* grey levels */
#define STEADY_LEAST 12   /* px */
#define STEADY_MOST 512   /* px: looked at, at most */
#define EVEN 0.6
#define SMOOTH 2    /* px to either side */
#define FIRST ASJ_EDGE_FIRST

#define ROWS (BLOCKS * BLOCK + BEYOND + SMOOTH) /* across the branch, that are held at once */
#define MORE 8                                  /* that are read ahead beyond them */
#define ROOM (ROWS + ASJ_EDGE_BATCH)

/* A branch, and what its edge looks like. */
typedef struct profile {
    const asj_edge_ops *ops;
    asj_edge_line line;
    double section[SAMPLES];
    double nothing;               /* contrast that may be noise */
    int32_t count;                /* blocks */
    double blocks[BLOCKS][SAMPLES];
    int32_t from, held, ends;     /* rows t = from .. from + held - 1 have been read; `ends`: the next one is outside */
    int32_t levels[SAMPLES][ROOM]; /* across the branch: of row `from` + k at [..][k] */
    double parts[ROWS];           /* of them along the section, once it is known */
} profile;

/* Rows up to t = `last`, as far as there is room for them and the image goes. */
static void read_rows(profile *p, int32_t last)
{
    const int32_t wanted = last - p->from < ROWS ? last - p->from + 1 : ROWS;
    if (p->held >= wanted || p->ends)
        return;
    p->held += p->ops->rows(&p->line, p->from + p->held, 1, wanted - p->held, p->levels[0] + p->held, ROOM);
    p->ends = p->held < wanted;
}

/* Their parts along the section, from number `first` on. */
static void project(profile *p, int32_t first)
{
    asj_edge_parts(p->levels[0] + first, ROOM, p->held - first, p->section, p->parts + first);
    for (int32_t k = first; k < p->held; k++)
        p->parts[k] /= ASJ_EDGE_LEVEL;
}

/* Makes rows around t be held, if there are such. */
static void hold(profile *p, int32_t t)
{
    const int32_t before = t - SMOOTH > FIRST ? t - SMOOTH : FIRST, after = t + SMOOTH;
    const int32_t held = p->held;
    if (before >= p->from && (after < p->from + held || p->ends))
        return;
    if (before < p->from || after >= p->from + ROWS) {
        p->from = before - ROWS / 2 > FIRST ? before - ROWS / 2 : FIRST;
        p->held = p->ends = 0;
        read_rows(p, after + MORE);
        project(p, 0);
        return;
    }
    read_rows(p, after + MORE);
    project(p, held);
}

/* The blocks' means: what is left over at the end is in none; a branch shorter than a block is one. */
static void find_blocks(profile *p, int32_t length)
{
    const int32_t wanted = length > FIRST + 1 ? length - FIRST : 1, size = wanted < BLOCK ? wanted : BLOCK;
    p->count = 0;
    for (int32_t end = size; end <= wanted && end <= p->held && p->count < BLOCKS; end += size) {
        for (int32_t i = 0; i < SAMPLES; i++) {
            int32_t sum = 0;
            for (int32_t k = end - size; k < end; k++)
                sum += p->levels[i][k];
            p->blocks[p->count][i] = sum / (ASJ_EDGE_LEVEL * size);
        }
        p->count++;
    }
}

static int rising(const void *a, const void *b)
{
    const double p = *(const double *)a, q = *(const double *)b;
    return p < q ? -1 : p > q;
}

static double own_contrast(const profile *p)
{
    double blocks[BLOCKS];
    for (int32_t k = 0; k < p->count; k++)
        blocks[k] = fabs(asj_edge_product(p->blocks[k], p->section));
    asj_sort(blocks, (size_t)p->count, sizeof *blocks, rising);
    return blocks[(3 * p->count) / 4];
}

/* a(t); negative: there is no such row. */
static double contrast_at(profile *p, int32_t t)
{
    hold(p, t);
    const int32_t end = p->from + p->held, first = t - SMOOTH > FIRST ? t - SMOOTH : FIRST;
    const int32_t last = t + SMOOTH < end ? t + SMOOTH : end - 1;
    double sum = 0;
    if (t >= end)
        return -1;
    for (int32_t k = first - p->from; k <= last - p->from; k++)
        sum += p->parts[k];
    return fabs(sum) / (last - first + 1);
}

/* Half of the mean square of the difference of neighbours: noise, and nothing of what changes slowly. Of rows that are held. */
static double noise_of(const profile *p, int32_t length)
{
    const int32_t wanted = length < FIRST + BLOCKS * BLOCK ? length - FIRST : BLOCKS * BLOCK;
    const int32_t count = wanted < p->held ? wanted : p->held;
    double sum = 0;
    for (int32_t k = 1; k < count; k++)
        sum += (p->parts[k] - p->parts[k - 1]) * (p->parts[k] - p->parts[k - 1]);
    return count > 1 ? sqrt(0.5 * sum / (count - 1)) : 0;
}

/* px around t = end in which the contrast lies between the two levels. */
static double fading_around(profile *p, int32_t end, double high, double low)
{
    int32_t before = end, after = end;
    while (before > FIRST && before > end - MOST_FADING && contrast_at(p, before) < high)
        before--;
    while (after < end + MOST_FADING && contrast_at(p, after) > low)
        after++;
    return after - before;
}

/* The change point between contrast `own` and nothing, where `share` of it is left, from `first` to `last`; -1 = nothing all the
 * way. */
static int32_t change_point(profile *p, double own, double share, int32_t first, int32_t last)
{
    const double limit = fmin(share, 1 - share), gap = fmin(0.5 * share * own, p->nothing);
    double sum = 0, most = 0;
    int32_t end = -1;
    for (int32_t t = first; t <= last; t++) {
        const double a = contrast_at(p, t), more = a / own - share;
        if (a < 0)
            break;
        sum += a < gap ? GAP * more : more < -limit ? -limit : more > limit ? limit : more;
        if (sum > most) {
            most = sum;
            end = t;
        }
    }
    return end;
}

/* Where the edge that reaches to t = end breaks off. *own: its contrast there. */
static int32_t break_before(profile *p, int32_t end, double *own)
{
    double before[LAST + 1];
    int32_t count = 0;
    for (int32_t t = end - LAST > FIRST ? end - LAST : FIRST; t <= end; t++)
        before[count++] = contrast_at(p, t);
    asj_sort(before, (size_t)count, sizeof *before, rising);
    *own = before[(3 * count) / 4];
    return *own > 0 ? change_point(p, *own, 0.5, end - AROUND > FIRST ? end - AROUND : FIRST, end) : -1;
}

/* The contrast from t = first to last in rising order, as far as there are rows. Returns how many. */
static int32_t sorted_contrast(profile *p, int32_t first, int32_t last, double values[STEADY_MOST])
{
    int32_t count = 0;
    for (int32_t t = first; t <= last && count < STEADY_MOST; t++) {
        const double a = contrast_at(p, t);
        if (a < 0)
            break;
        values[count++] = a;
    }
    if (count > 1)
        asj_sort(values, (size_t)count, sizeof *values, rising);
    return count;
}

/* Where a weaker edge ends that goes on behind t = end and is as strong all along; `end` when there is none. *own: the contrast
 * there. */
static int32_t end_of_steady(profile *p, int32_t end, int32_t length, double *own)
{
    const int32_t first = end + 2 * SMOOTH; /* samples of what ends are no part of it */
    double values[STEADY_MOST];
    int32_t count = sorted_contrast(p, first, length - SMOOTH - 1, values);
    if (count < STEADY_LEAST || values[(3 * count) / 4] < STEADY * ASJ_GRAY_ONE)
        return end;
    const double weaker = values[(3 * count) / 4];
    const int32_t last = change_point(p, weaker, 0.5, first, length + BEYOND);
    count = sorted_contrast(p, first, last - SMOOTH, values);
    if (count < STEADY_LEAST || values[count / 10] < EVEN * values[count - 1 - count / 10])
        return end;
    *own = weaker;
    return last;
}

/* Reads the part that says what the edge looks like; 0 when it has no contrast. */
static int start(const asj_edge_ops *ops, const asj_frame *frame, const asj_hypothesis *hypothesis,
                 const asj_hypothesis_branch *branch, int32_t length, profile *p)
{
    p->ops = ops;
    p->line = asj_edge_line_of(frame, hypothesis, branch);
    p->from = FIRST;
    p->held = p->ends = 0;
    read_rows(p, (length > FIRST ? length : FIRST) + BEYOND + SMOOTH);
    find_blocks(p, length);
    if (!asj_edge_section(p->blocks[0], p->count, p->section))
        return 0;
    project(p, 0);
    return 1;
}

asj_end_profile asj_end_profile_of(const asj_edge_ops *ops, const asj_frame *frame, const asj_hypothesis *hypothesis,
                                   const asj_hypothesis_branch *branch, double share, int steady)
{
    asj_end_profile result = {0, 0, 0};
    const int32_t length = (int32_t)lrint(branch->length);
    profile p;
    if (!start(ops, frame, hypothesis, branch, length, &p))
        return result;
    double own = own_contrast(&p);
    if (!(own > 0)) /* flat but for a block or two: no contrast to take a share of */
        return result;
    const double noise = noise_of(&p, length);
    p.nothing = DOUBT * noise / sqrt(2 * SMOOTH + 1);
    const int32_t reach = change_point(&p, own, share, FIRST, length + BEYOND);
    int32_t end = reach < 0 ? -1 : break_before(&p, reach, &own);
    if (end < 0)
        return result;
    if (steady && length - end >= STEADY_LEAST)
        end = end_of_steady(&p, end, length, &own);
    result.end = end + 0.5;
    result.noise = noise / own;
    result.fading = fading_around(&p, end, 0.75 * own, 0.25 * own);
    return result;
}
