/* SPDX-License-Identifier: BSD-2-Clause */
/* Location: the least-squares meeting point of the lines fitted to the branches. A whole-pixel location, which the paper uses
 * (refinement = search), cannot be better than 0.38 px on average.
 *
 * The same fits unmask what the isotropic test takes for junctions along single edges, where the sectors of a thick or bent edge
 * seem to open: after the fit the branches are parallel, or meet far away. A junction is rejected when
 *   - no two branches open by at least minimum_opening (with some slack) and at most pi minus that,
 *   - the smallest singular direction of the lines is not determined (determinant of the normal matrix, weighted but in the image
 *     itself, where a clear and a faint edge may meet), or
 *   - it moves farther than max_move, or somewhat more at sharp corners. */
#include "locate.h"
#include "core/angle.h"

#include <math.h>
#include <string.h>

/* Least determinant of the normal matrix, relative to the square of the sum of weights. Two lines of weight w that open by phi have
 * (w sin phi)^2, so 0.02 is an opening of asin(sqrt(4 x 0.02)) = 16.4 degrees. Chosen below minimum_opening (25), so that it
 * decides only where weights differ much or that option is lowered; less lets noise in nearly parallel lines move their meeting
 * point far along them.
 * Weights of w and 50 w fail it at a right angle, though: .03 and .21 px of uncertainty, a clear edge and a faint one, whose corner
 * is known to .21 px. So, in the image itself, where validation asks how well the corner is known (validate.c, MOST_SD), all lines
 * weigh the same here. In coarse octaves that makes junctions of what is only half there (blur 5, 60 grey levels: precision .995 ->
 * .992). */
#define LEAST_DETERMINANT 0.02

/* Where lines are fitted: px along the branch from the junction, and px to either side of it. Chosen: 2 leaves out what blur bends
 * at a corner; over 10 px a line has an angle, which over the isotropic scale of most junctions (7) it hardly has. The first guess
 * starts from a whole pixel and a sector's direction and needs a wide band; each later one may be narrower, which keeps
 * neighbouring edges out. */
#define FIRST 2.0        /* px along: where fits begin, */
#define SOFT_FIRST 5.0   /* and where a second look does: below */
#define LEAST_END 10.0   /* px along: where they end, or at the isotropic scale if that is larger */
#define GUESS_WIDTH 4.0  /* px across: of the first guess, */
#define SECOND_WIDTH 2.5 /* of the second guess and the first fit, */
#define FIT_WIDTH 2.0    /* of the last fit */

/* Slack of what is asked of a guess: degrees of minimum_opening, px of max_move. Chosen: more passes more edges on to the fits,
 * which costs time; less begins to reject what the fits would accept. */
#define GUESS_TURN 8.0
#define GUESS_MOVE 1.0

/* deg: a fit over a few px makes sharp corners up to so much sharper, since each side's band holds a little of the other. Lines
 * over whole branches are asked for all of minimum_opening (validate.c). */
#define FIT_TURN 4.0

#define PLAIN 55      /* deg: corners that open by this much are found with the default of max_move, 2.5 px, however turned */
#define SHARP_MOVE 6.5 /* px: the most, for 23 degrees with that default. Of twelve wedges of 26 degrees 5 finds 6, 6.5 finds 10 */

static void get_lines(const asj_hypothesis *hypothesis, asj_rough_line *lines)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        lines[i] = asj_rough_line_of(&hypothesis->branches[i]);
}

/* Moves the junction; its lines, whose directions these are, stay where they are. */
static void move(asj_hypothesis *hypothesis, const asj_rough_line *lines, double dx, double dy)
{
    hypothesis->x += dx;
    hypothesis->y += dy;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        hypothesis->branches[i].offset -= -lines[i].uy * dx + lines[i].ux * dy;
}

/* Of lines with weights: sum of weight n n'. n is of length 1, so xx + yy is the sum of weights. */
typedef struct normal_matrix {
    double xx, xy, yy;
} normal_matrix;

static normal_matrix add_up(const asj_rough_line *lines, const double *weights, int32_t count)
{
    normal_matrix n = {0, 0, 0};
    for (int32_t i = 0; i < count; i++) {
        const double nx = -lines[i].uy, ny = lines[i].ux, weight = weights[i];
        n.xx += weight * nx * nx;
        n.xy += weight * nx * ny;
        n.yy += weight * ny * ny;
    }
    return n;
}

static double determinant(const normal_matrix *n)
{
    return n->xx * n->yy - n->xy * n->xy;
}

static int determines_point(const normal_matrix *n)
{
    return determinant(n) > LEAST_DETERMINANT * (n->xx + n->yy) * (n->xx + n->yy);
}

typedef struct meeting {
    double dx, dy, variance;
} meeting;

/* Each line says n.(p - p0) = offset with weight 1 / variance: covariance of the location the inverse of their normal matrix. */
static int meet_lines(const asj_rough_line *lines, const double *weights, int32_t count, const normal_matrix *n, meeting *m)
{
    const double area = determinant(n);
    double bx = 0, by = 0;
    for (int32_t i = 0; i < count; i++) {
        bx += weights[i] * -lines[i].uy * lines[i].offset;
        by += weights[i] * lines[i].ux * lines[i].offset;
    }
    if (!(area > 0))
        return 0;
    *m = (meeting){(n->yy * bx - n->xy * by) / area, (n->xx * by - n->xy * bx) / area, (n->xx + n->yy) / (2 * area)};
    return 1;
}

/* As asj_locate_meet(), of the branches' lines. */
static int meet(const asj_frame *frame, const asj_detect_options *options, const asj_rough_line *lines, asj_hypothesis *hypothesis)
{
    const int alike = options->strip_test && frame->octave <= 0;
    double weights[ASJ_MAX_BRANCHES] = {0}, ones[ASJ_MAX_BRANCHES] = {0};
    meeting m;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        weights[i] = 1 / hypothesis->branches[i].offset_variance;
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        ones[i] = 1;
    const normal_matrix normal = add_up(lines, weights, hypothesis->branch_count);
    const normal_matrix shape = alike ? add_up(lines, ones, hypothesis->branch_count) : normal;
    if (!determines_point(&shape) || !meet_lines(lines, weights, hypothesis->branch_count, &normal, &m))
        return 0;
    move(hypothesis, lines, m.dx, m.dy);
    hypothesis->location_variance = m.variance;
    return 1;
}

int asj_locate_meet(const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis)
{
    asj_rough_line lines[ASJ_MAX_BRANCHES];
    get_lines(hypothesis, lines);
    return meet(frame, options, lines, hypothesis);
}

static double fit_first(const asj_hypothesis *hypothesis)
{
    return hypothesis->first > FIRST ? hypothesis->first : FIRST;
}

static double fit_end(const asj_hypothesis *hypothesis)
{
    return (hypothesis->radius > LEAST_END ? hypothesis->radius : LEAST_END) + (fit_first(hypothesis) - FIRST);
}

/* Their directions are those of the lines. */
static void fit_branches(const asj_context *context, const asj_frame *frame, const asj_line_range *range,
                         const asj_rough_line *lines, asj_hypothesis *hypothesis)
{
    int keep[ASJ_MAX_BRANCHES];
    asj_line_fit_all(context->ops->line, frame, hypothesis->x, hypothesis->y, lines, range, hypothesis->branch_count,
                     hypothesis->branches, keep);
    asj_hypothesis_select(hypothesis, keep);
}

/* Moves the lines; those that there are stay, with their branches. */
static void guess_lines(const asj_context *context, const asj_frame *frame, double half_width, double end,
                        asj_hypothesis *hypothesis, asj_rough_line *lines)
{
    const double t[2] = {fit_first(hypothesis), end};
    const int32_t count = hypothesis->branch_count;
    int keep[ASJ_MAX_BRANCHES], kept = 0;
    asj_line_guess_all(context->ops->line, frame, hypothesis->x, hypothesis->y, t, half_width, count, lines, keep);
    for (int32_t i = 0; i < count; i++)
        if (keep[i])
            lines[kept++] = lines[i];
    asj_hypothesis_select(hypothesis, keep);
}

/* As asj_hypothesis_has_opening(). */
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

/* px that a junction may move. The sides of a wedge that opens by phi are 2 d tan(phi / 2) apart at d px from its apex, and blur
 * joins what is too close: so the isotropic test sees a sharp corner farther inside than others. max_move is meant for openings of
 * PLAIN degrees and more; of sharper ones the apex may be where the sides are as far apart as there,
 * d tan(phi / 2) = max_move tan(PLAIN / 2), at most SHARP_MOVE. The best opening of any two lines counts;
 * tan(phi / 2) = sin phi / (1 + cos phi). Where the strip does not judge what comes of it, max_move is all. */
static double most_move(const asj_detect_options *options, const asj_rough_line *lines, int32_t count)
{
    double widest = 0;
    if (!options->strip_test)
        return options->max_move;
    for (int32_t i = 0; i < count; i++)
        for (int32_t j = i + 1; j < count; j++) {
            const double sine = fabs(lines[i].ux * lines[j].uy - lines[i].uy * lines[j].ux);
            const double cosine = lines[i].ux * lines[j].ux + lines[i].uy * lines[j].uy;
            widest = sine >= widest * (1 + cosine) && 1 + cosine > 0 ? sine / (1 + cosine) : widest;
        }
    const double sharp = options->max_move * tan(0.5 * PLAIN * ASJ_DEGREE);
    return fmax(options->max_move, sharp < widest * SHARP_MOVE ? sharp / widest : SHARP_MOVE);
}

double asj_locate_farthest_move(const asj_detect_options *options)
{
    return options->strip_test ? fmax(options->max_move, SHARP_MOVE) : options->max_move;
}

double asj_locate_most_move(const asj_detect_options *options, const asj_hypothesis *hypothesis)
{
    asj_rough_line lines[ASJ_MAX_BRANCHES];
    get_lines(hypothesis, lines);
    return most_move(options, lines, hypothesis->branch_count);
}

/* Whether the lines make a junction near its pixel, and where. */
static int guess_meeting(const asj_detect_options *options, const asj_rough_line *lines, int32_t count, double least, meeting *m)
{
    double weights[ASJ_MAX_BRANCHES];
    for (int32_t i = 0; i < count; i++)
        weights[i] = 1;
    if (!have_opening(lines, count, least))
        return 0;
    const normal_matrix normal = add_up(lines, weights, count);
    return determines_point(&normal) && meet_lines(lines, weights, count, &normal, m) &&
           hypot(m->dx, m->dy) <= most_move(options, lines, count) + GUESS_MOVE;
}

/* The lines from `first` px on. *astray is set when they open but make no junction here. */
static void guess_from(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, double first,
                       const asj_rough_line *start, asj_hypothesis *hypothesis, int *astray)
{
    const double least = fmax((options->minimum_opening - GUESS_TURN) * ASJ_DEGREE, 0);
    asj_rough_line lines[ASJ_MAX_BRANCHES];
    meeting m;
    hypothesis->first = first;
    memcpy(lines, start, (size_t)hypothesis->branch_count * sizeof *lines);
    guess_lines(context, frame, GUESS_WIDTH, LEAST_END + (first - FIRST), hypothesis, lines); /* enough to tell edges */
    if (!have_opening(lines, hypothesis->branch_count, least)) { /* most of the others */
        hypothesis->branch_count = 0;
        return;
    }
    guess_lines(context, frame, SECOND_WIDTH, fit_end(hypothesis), hypothesis, lines);
    if (!guess_meeting(options, lines, hypothesis->branch_count, least, &m)) {
        *astray = 1;
        hypothesis->branch_count = 0;
        return;
    }
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        asj_rough_line_keep(&lines[i], &hypothesis->branches[i]);
    move(hypothesis, lines, m.dx, m.dy);
}

void asj_locate_guess(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                      const double (*units)[2], asj_hypothesis *hypothesis)
{
    const asj_hypothesis before = *hypothesis;
    asj_rough_line lines[ASJ_MAX_BRANCHES];
    int astray = 0;
    if (options->refinement != ASJ_REFINE_LINE_FIT)
        return;
    if (units)
        for (int32_t i = 0; i < hypothesis->branch_count; i++)
            lines[i] = (asj_rough_line){units[i][0], units[i][1], hypothesis->branches[i].offset, hypothesis->branches[i].apart};
    else
        get_lines(hypothesis, lines);
    guess_from(context, frame, options, FIRST, lines, hypothesis, &astray);
    if (!astray || frame->octave <= 0)
        return;
    /* close by, soft edges bend so much that their lines miss the corner: coarse octaves, to which it is left, look farther out */
    *hypothesis = before;
    guess_from(context, frame, options, SOFT_FIRST, lines, hypothesis, &astray);
}

void asj_locate(const asj_context *context, const asj_frame *frame, const asj_detect_options *options, asj_hypothesis *hypothesis)
{
    const asj_line_range fine = {fit_first(hypothesis), fit_end(hypothesis), {SECOND_WIDTH, FIT_WIDTH, 0}, 2};
    const double least = fmax(options->minimum_opening - (options->strip_test ? FIT_TURN : 0), 0) * ASJ_DEGREE;
    asj_rough_line lines[ASJ_MAX_BRANCHES];
    if (options->refinement != ASJ_REFINE_LINE_FIT)
        return;
    get_lines(hypothesis, lines);
    /* back to the pixel: a guess is good enough to tell twins, not to start from */
    move(hypothesis, lines, hypothesis->x0 - hypothesis->x, hypothesis->y0 - hypothesis->y);
    fit_branches(context, frame, &fine, lines, hypothesis);
    get_lines(hypothesis, lines);
    if (!asj_hypothesis_has_opening(hypothesis, least) || !meet(frame, options, lines, hypothesis) ||
        hypot(hypothesis->x - hypothesis->x0, hypothesis->y - hypothesis->y0) > most_move(options, lines, hypothesis->branch_count))
        hypothesis->branch_count = 0;
}
