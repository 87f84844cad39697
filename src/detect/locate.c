/* SPDX-License-Identifier: BSD-2-Clause */
/* Location: the least-squares meeting point of the lines fitted to the branches. A whole-pixel location, which the paper uses
 * (refinement = search), cannot be better than 0.38 px on average.
 *
 * The same fits unmask what the isotropic test takes for junctions along single edges, where the sectors of a thick or bent edge
 * seem to open: after the fit the branches are parallel, or meet far away. A junction is rejected when
 *   - no two branches open by at least minimum_opening and at most pi minus that,
 *   - the smallest singular direction of the lines is not determined (determinant of the weighted normal matrix), or
 *   - it moves farther than max_move. */
#include "locate.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define PI 3.141592653589793

#define TURN 65536 /* of an isotropic junction's directions */

int asj_locate_worthwhile(const asj_detect_options *options, const asj_isotropic_junction *junction)
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

void asj_locate_start(const asj_isotropic_junction *junction, asj_draft *draft)
{
    memset(draft, 0, sizeof *draft);
    draft->x = draft->x0 = junction->x;
    draft->y = draft->y0 = junction->y;
    draft->radius = junction->radius;
    draft->log_nfa = junction->log_nfa;
    draft->branch_count = junction->branch_count;
    for (int32_t i = 0; i < junction->branch_count; i++) {
        draft->branches[i].angle = junction->angle[i] * (2 * PI / TURN);
        draft->branches[i].strength = (double)junction->strength[i] / ASJ_STRENGTH_ONE;
    }
}

static void get_lines(const asj_draft *draft, asj_rough_line *lines)
{
    for (int32_t i = 0; i < draft->branch_count; i++)
        lines[i] = asj_rough_line_of(&draft->branches[i]);
}

/* Moves the junction; its lines, whose directions these are, stay where they are. */
static void move(asj_draft *draft, const asj_rough_line *lines, double dx, double dy)
{
    draft->x += dx;
    draft->y += dy;
    for (int32_t i = 0; i < draft->branch_count; i++)
        draft->branches[i].offset -= -lines[i].uy * dx + lines[i].ux * dy;
}

typedef struct meeting {
    double dx, dy, variance;
} meeting;

/* Each line says n.(p - p0) = offset with weight 1 / variance: covariance of the location the inverse of the normal matrix. */
static int meet_lines(const asj_rough_line *lines, const double *weights, int32_t count, meeting *m)
{
    double xx = 0, xy = 0, yy = 0, bx = 0, by = 0, total = 0;
    for (int32_t i = 0; i < count; i++) {
        const double nx = -lines[i].uy, ny = lines[i].ux, weight = weights[i];
        xx += weight * nx * nx;
        xy += weight * nx * ny;
        yy += weight * ny * ny;
        bx += weight * nx * lines[i].offset;
        by += weight * ny * lines[i].offset;
        total += weight;
    }
    const double determinant = xx * yy - xy * xy;
    if (!(determinant > 0.02 * total * total))
        return 0;
    *m = (meeting){(yy * bx - xy * by) / determinant, (xx * by - xy * bx) / determinant, (xx + yy) / (2 * determinant)};
    return 1;
}

int asj_locate_meet(asj_draft *draft)
{
    asj_rough_line lines[ASJ_MAX_BRANCHES];
    double weights[ASJ_MAX_BRANCHES];
    meeting m;
    get_lines(draft, lines);
    for (int32_t i = 0; i < draft->branch_count; i++)
        weights[i] = 1 / draft->branches[i].offset_variance;
    if (!meet_lines(lines, weights, draft->branch_count, &m))
        return 0;
    move(draft, lines, m.dx, m.dy);
    draft->location_variance = m.variance;
    return 1;
}

#define NEAR 2 /* px: where the fits begin */

static double fit_end(const asj_draft *draft)
{
    return draft->radius > 10 ? draft->radius : 10;
}

static void fit_branches(const asj_context *context, const asj_frame *frame, const asj_line_range *range, asj_draft *draft)
{
    int keep[ASJ_MAX_BRANCHES];
    for (int32_t i = 0; i < draft->branch_count; i++)
        keep[i] = asj_line_fit(context->ops->line, frame, draft->x, draft->y, range, &draft->branches[i]);
    asj_draft_select(draft, keep);
}

/* Moves the lines; those that there are stay, with their branches. */
static void guess_lines(const asj_context *context, const asj_frame *frame, double half_width, double end, asj_draft *draft,
                        asj_rough_line *lines)
{
    const double t[2] = {NEAR, end};
    int keep[ASJ_MAX_BRANCHES], kept = 0;
    for (int32_t i = 0; i < draft->branch_count; i++) {
        lines[kept] = lines[i];
        keep[i] = asj_line_guess(context->ops->line, frame, draft->x, draft->y, t, half_width, &lines[kept]);
        kept += keep[i];
    }
    asj_draft_select(draft, keep);
}

/* As asj_draft_has_opening(). */
static int have_opening(const asj_rough_line *lines, int32_t count, double least)
{
    const double sine = sin(least);
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = i + 1; j < count; j++) {
            const double cross = fabs(lines[i].ux * lines[j].uy - lines[i].uy * lines[j].ux);
            if (cross > 0 && cross >= sine)
                return 1;
        }
    return 0;
}

/* Whether the lines make a junction near its pixel, and where. */
static int guess_meeting(const asj_detect_options *options, const asj_rough_line *lines, int32_t count, double least, meeting *m)
{
    double weights[ASJ_MAX_BRANCHES];
    for (int32_t i = 0; i < count; i++)
        weights[i] = 1;
    return have_opening(lines, count, least) && meet_lines(lines, weights, count, m) &&
           hypot(m->dx, m->dy) <= options->max_move + 1;
}

void asj_locate_guess(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft)
{
    const double least = fmax((options->minimum_opening - 8) * (PI / 180), 0);
    asj_rough_line lines[ASJ_MAX_BRANCHES];
    meeting m;
    if (options->refinement != ASJ_REFINE_LINE_FIT)
        return;
    get_lines(draft, lines);
    guess_lines(context, frame, 4, 10, draft, lines); /* px: enough to tell edges */
    if (!have_opening(lines, draft->branch_count, least)) { /* most of the others */
        draft->branch_count = 0;
        return;
    }
    guess_lines(context, frame, 2.5, fit_end(draft), draft, lines);
    if (!guess_meeting(options, lines, draft->branch_count, least, &m)) {
        draft->branch_count = 0;
        return;
    }
    for (int32_t i = 0; i < draft->branch_count; i++)
        asj_rough_line_keep(&lines[i], &draft->branches[i]);
    move(draft, lines, m.dx, m.dy);
}

void asj_locate(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_draft *draft)
{
    const asj_line_range fine = {NEAR, fit_end(draft), {2.5, 2, 0}, 2};
    asj_rough_line lines[ASJ_MAX_BRANCHES];
    if (options->refinement != ASJ_REFINE_LINE_FIT)
        return;
    get_lines(draft, lines);
    move(draft, lines, draft->x0 - draft->x, draft->y0 - draft->y); /* the guess is good enough to tell twins */
    fit_branches(context, frame, &fine, draft);
    if (!asj_draft_has_opening(draft, options->minimum_opening * (PI / 180)) || !asj_locate_meet(draft) ||
        hypot(draft->x - draft->x0, draft->y - draft->y0) > options->max_move)
        draft->branch_count = 0;
}

static int by_meaning(const void *a, const void *b)
{
    const asj_draft *p = a, *q = b;
    if (p->log_nfa != q->log_nfa)
        return p->log_nfa < q->log_nfa ? -1 : 1;
    if (p->y != q->y)
        return p->y < q->y ? -1 : 1;
    return p->x < q->x ? -1 : p->x > q->x;
}

/* Kept drafts are linked into a grid of cells as wide as the largest suppression radius, so that only the cells around need a
 * look. */
#define CELL 11 /* px: max(3, 0.35 * 30) rounded up */

static int32_t cell_columns(int32_t width)
{
    return width / CELL + 3; /* a border of cells for junctions just outside the image, and for the neighbours */
}

size_t asj_locate_cells(size_t count, int32_t width, int32_t height)
{
    return (size_t)cell_columns(width) * (size_t)cell_columns(height) + count;
}

/* Whether each branch of a draft is one of the other's too, and the other one is not likely to be rejected yet because it moves too
 * far. */
static int same_junction(const asj_draft *draft, const asj_draft *other)
{
    const double turn = 10 * (PI / 180), surely_near = 1.5;
    if (draft->branch_count != other->branch_count || hypot(other->x - other->x0, other->y - other->y0) > surely_near)
        return 0;
    for (int32_t i = 0; i < draft->branch_count; i++) {
        int found = 0;
        for (int32_t j = 0; j < other->branch_count; j++)
            found |= asj_angle_distance(draft->branches[i].angle, other->branches[j].angle) < turn;
        if (!found)
            return 0;
    }
    return 1;
}

static int suppressed(const asj_draft *drafts, const asj_draft *draft, int same, int32_t columns, int64_t cell,
                      const int32_t *heads, const int32_t *next)
{
    for (int dy = -1; dy <= 1; dy++)
        for (int dx = -1; dx <= 1; dx++)
            for (int32_t i = heads[cell + dy * columns + dx]; i >= 0; i = next[i]) {
                const double radius = same ? 1.5 : fmax(3, 0.35 * drafts[i].radius);
                const double x = drafts[i].x - draft->x, y = drafts[i].y - draft->y;
                if (x * x + y * y < radius * radius && (!same || same_junction(draft, &drafts[i])))
                    return 1;
            }
    return 0;
}

size_t asj_locate_suppress(asj_draft *drafts, size_t count, int same, int32_t width, int32_t height, int32_t *cells)
{
    const int32_t columns = cell_columns(width), rows = cell_columns(height);
    int32_t *heads = cells, *next = cells + (size_t)columns * (size_t)rows;
    size_t valid = 0, kept = 0;
    for (size_t i = 0; i < count; i++)
        if (drafts[i].branch_count >= 2)
            drafts[valid++] = drafts[i];
    qsort(drafts, valid, sizeof *drafts, by_meaning);
    memset(heads, 0xff, (size_t)columns * (size_t)rows * sizeof *heads);
    for (size_t i = 0; i < valid; i++) {
        const asj_draft draft = drafts[i];
        int32_t cx = (int32_t)floor(draft.x / CELL) + 1, cy = (int32_t)floor(draft.y / CELL) + 1;
        cx = cx < 1 ? 1 : cx > columns - 2 ? columns - 2 : cx;
        cy = cy < 1 ? 1 : cy > rows - 2 ? rows - 2 : cy;
        int64_t cell = (int64_t)cy * columns + cx;
        if (suppressed(drafts, &draft, same, columns, cell, heads, next))
            continue;
        drafts[kept] = draft;
        next[kept] = heads[cell];
        heads[cell] = (int32_t)kept++;
    }
    return kept;
}
