/* SPDX-License-Identifier: BSD-2-Clause */
/* What is at the end of a branch that ends at no junction. Around the end E, which is known to a few pixels, other edges are
 * looked for along short rays: from places on the branch's line up to AROUND px before and behind E, in directions up to MOST
 * degrees off either side of it, and from E on ahead. A ray has an edge under it when the mean of
 *     gamma = max(|g.n| - |g.u|, 0)        (n, u: across and along the ray; strip.c)
 * over r = 2 .. 8 px (edge_fan.c) is at least EDGE. In noise the mean of seven is that large once in 4000 times (by simulation),
 * and rays side by side share pixels.
 *   - E within BORDER px of the image's border, along the branch: the border;
 *   - an edge to both sides, in one line to within STRAIGHT, and none ahead: an edge passes by, and the branch may go on behind
 *     what it bounds: an occlusion;
 *   - an edge to any side otherwise: a crossing, or a corner that was not found;
 *   - none: the branch fades. */
#include "end_kind.h"
#include "end_profile.h"
#include "core/angle.h"

#include <math.h>
#include <stdlib.h>

#define AROUND 3     /* px */
#define SHIFT 1.5    /* px from one place to the next */
#define LEAST 30     /* deg between a ray and the branch's line, .. */
#define MOST 150
#define STEP 10      /* deg from one ray to the next */
#define AHEAD 20     /* deg off the branch's line that still are ahead */
#define STRAIGHT 25  /* deg */
#define EDGE 1.2     /* standard deviations of noise */
#define BORDER 5.0   /* px: sectors are cut by the border, and lose the edge before it */

#define SHARE 0.5    /* of its contrast that an edge loses where it fades, when ends are the scan's */
#define END_SD 1.0   /* px: of the scan, where other edges end it */
#define FADE_SD 0.4  /* px: of an end by contrast where the edge breaks off (measured), .. */
#define CHERNOFF 0.51 /* .. and the standard deviation of Chernoff's distribution: see variance_of() */

void asj_end_rays_make(asj_end_rays *rays)
{
    for (int32_t i = 0; i < ASJ_END_TURNS; i++) {
        rays->cosine[i] = cos(STEP * i * ASJ_DEGREE);
        rays->sine[i] = sin(STEP * i * ASJ_DEGREE);
    }
}

/* An end, and the direction in which its branch comes there. */
typedef struct arrival {
    double x, y, ux, uy;
} arrival;

/* One ray more, turned by `turn` steps to one side (1: growing angles, -1). */
static void add_ray(const asj_end_rays *rays, const arrival *end, int32_t turn, int side, asj_edge_fan *fan)
{
    const double c = rays->cosine[turn], s = side * rays->sine[turn];
    fan->ux[fan->count] = c * end->ux - s * end->uy;
    fan->uy[fan->count++] = c * end->uy + s * end->ux;
}

/* From a place `shift` px behind the end. */
static void look_along(const asj_edge_ops *ops, const asj_frame *frame, const asj_edge_fan *fan, const arrival *end, double shift,
                       double edges[ASJ_FAN_RAYS])
{
    ops->fan(frame, fan, end->x + shift * end->ux, end->y + shift * end->uy, edges);
}

/* The strongest edge to one side from around the end: its angle from the branch's line in degrees; 0 when there is none. */
static double edge_beside(const asj_edge_ops *ops, const asj_frame *frame, const asj_end_rays *rays, const arrival *end, int side)
{
    double best = EDGE, found = 0, edges[ASJ_FAN_RAYS];
    asj_edge_fan fan = {0};
    for (int32_t turn = LEAST / STEP; turn <= MOST / STEP; turn++)
        add_ray(rays, end, turn, side, &fan);
    for (double shift = -AROUND; shift <= AROUND; shift += SHIFT) {
        look_along(ops, frame, &fan, end, shift, edges);
        for (int32_t i = 0; i < fan.count; i++)
            if (edges[i] > best) {
                best = edges[i];
                found = LEAST + i * STEP;
            }
    }
    return found;
}

static int edge_ahead(const asj_edge_ops *ops, const asj_frame *frame, const asj_end_rays *rays, const arrival *end)
{
    double edges[ASJ_FAN_RAYS];
    asj_edge_fan fan = {0};
    int found = 0;
    for (int32_t turn = -AHEAD / STEP; turn <= AHEAD / STEP; turn++)
        add_ray(rays, end, abs(turn), turn < 0 ? -1 : 1, &fan);
    look_along(ops, frame, &fan, end, AROUND, edges);
    for (int32_t i = 0; i < fan.count; i++)
        found |= edges[i] > EDGE;
    return found;
}

static int32_t kind_of(const asj_edge_ops *ops, const asj_frame *frame, const asj_end_rays *rays, const asj_hypothesis *hypothesis,
                       const asj_hypothesis_branch *branch)
{
    const double ux = cos(branch->angle), uy = sin(branch->angle);
    const arrival end = {hypothesis->x + branch->length * ux, hypothesis->y + branch->length * uy, ux, uy};
    const double bx = end.x + BORDER * ux, by = end.y + BORDER * uy;
    if (bx < 0 || by < 0 || bx > frame->width - 1 || by > frame->height - 1)
        return ASJ_BRANCH_END_BORDER;
    const double left = edge_beside(ops, frame, rays, &end, -1), right = edge_beside(ops, frame, rays, &end, 1);
    if (left > 0 && right > 0 && fabs(left + right - 180) <= STRAIGHT && !edge_ahead(ops, frame, rays, &end))
        return ASJ_BRANCH_END_OCCLUSION;
    return left > 0 || right > 0 ? ASJ_BRANCH_END_CROSSING : ASJ_BRANCH_END_FADED;
}

/* Around the end the sum C(T) of end_profile.c is a parabola, -slope / 2 (T - end)^2, with a random walk on it, noise sqrt(T -
 * end). The place of its maximum has Chernoff's distribution, (2 noise / slope)^(2/3) px wide. */
static double variance_of(const asj_end_profile *profile)
{
    const double slope = 0.5 / fmax(profile->fading, 1);
    const double walk = CHERNOFF * pow(2 * profile->noise / slope, 2.0 / 3);
    return FADE_SD * FADE_SD + walk * walk;
}

void asj_ends_by_contrast(const asj_edge_ops *ops, const asj_frame *frame, const asj_detect_options *options,
                          asj_hypothesis *hypothesis)
{
    for (int32_t i = 0; i < hypothesis->branch_count && options->end_contrast > 0; i++) {
        asj_hypothesis_branch *branch = &hypothesis->branches[i];
        const asj_end_profile profile = asj_end_profile_of(ops, frame, hypothesis, branch, options->end_contrast, 1);
        branch->end_variance = END_SD * END_SD;
        if (profile.end <= 0)
            continue;
        branch->length = profile.end;
        branch->end_variance = variance_of(&profile);
    }
}

void asj_ends_of_short(const asj_edge_ops *ops, const asj_frame *frame, const asj_detect_options *options,
                       asj_hypothesis *hypothesis)
{
    const double shortest = options->field_radius + 1;
    for (int32_t i = 0; i < hypothesis->branch_count && options->end_contrast > 0; i++) {
        asj_hypothesis_branch branch = hypothesis->branches[i];
        if (branch.length >= shortest)
            continue;
        branch.length = shortest;
        const asj_end_profile profile = asj_end_profile_of(ops, frame, hypothesis, &branch, options->end_contrast, 0);
        hypothesis->branches[i].length = fmax(hypothesis->branches[i].length, profile.end);
    }
}

/* Of ends that are the scan's: where an edge fades, its contrast tells how sure the end is. */
static double scan_variance(const asj_edge_ops *ops, const asj_frame *frame, const asj_hypothesis *hypothesis,
                            const asj_hypothesis_branch *branch)
{
    if (branch->end != ASJ_BRANCH_END_FADED && branch->end != ASJ_BRANCH_END_BORDER)
        return END_SD * END_SD;
    const asj_end_profile profile = asj_end_profile_of(ops, frame, hypothesis, branch, SHARE, 0);
    const double off = profile.end - branch->length;
    return profile.end > 0 ? variance_of(&profile) + off * off : END_SD * END_SD;
}

void asj_end_kinds(const asj_edge_ops *ops, const asj_frame *frame, const asj_end_rays *rays, const asj_detect_options *options,
                   asj_hypothesis *hypothesis)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        if (hypothesis->branches[i].end != ASJ_BRANCH_END_JUNCTION) {
            asj_hypothesis_branch *branch = &hypothesis->branches[i];
            branch->end = kind_of(ops, frame, rays, hypothesis, branch);
            if (options->end_contrast <= 0)
                branch->end_variance = scan_variance(ops, frame, hypothesis, branch);
        }
}
