/* SPDX-License-Identifier: BSD-2-Clause */
/* Branches followed outwards, before the search of step 5 (option refinement = search).
 *
 * The isotropic test knows an orientation to a step of 1 / r rad, 11 degrees at r = 5: twice what the search covers. Sectors of
 * larger radii are narrower (Delta(r) = tau / r) and say better where a branch goes. So each branch takes the strongest of five
 * sectors half a step apart, from radius r to r', an eighth and at least 1 px more,
 *     theta(r') = argmax over k = -2 .. 2 of omega_p(r', theta(r) + k / (2 r'))                      (eq. junction-ness-branch)
 * as long as two branches like it are a meaningful junction:  #J(2) F(omega; J)^2 <= epsilon         (step 3), up to r = 60.
 *
 * The disc of the junction's radius has to lie in the image: beside the border the radius is made as small as that asks for, and a
 * junction that has no radius left is dropped. An edge that leaves the image makes no corner there then. In the output of the
 * authors' program the scale, which exceeds the radius by two at least, is never above the distance to the border by more than 1.
 *
 * A junction is one only if its branches, all together, are still meaningful at the radius after its own: texture makes junctions
 * at single places and radii. In the output of the authors' program the scale always exceeds the radius beside it, by two at
 * least. This is ours; the paper does not say how its program comes from radius to radius. Of the L-junctions of six photographs
 * 35 % repeated under zoom by 0.9 in place, angles and lengths with it and 22 % without. */
#include "follow.h"
#include "core/angle.h"
#include "nfa.h"
#include "search.h"

#include <math.h>

#define LARGEST 60 /* px */
#define GROWTH 8   /* from radius to radius by this part, 1 px at least */
#define ASIDE 2    /* half steps to either side */

typedef struct sector {
    double angle, sum; /* rad; omega */
    int32_t pixels;
} sector;

/* The strongest sector of radius r near an angle. */
static sector strongest(const asj_detection_run *run, const asj_hypothesis *hypothesis, double angle, int32_t r)
{
    sector best = {angle, -1, 0};
    for (int32_t k = -ASIDE; k <= ASIDE; k++) {
        const double turned = asj_angle_wrap(angle + 0.5 * k / r);
        const asj_search_sum s = asj_search_omega(run->frame, hypothesis->x, hypothesis->y, turned, r, run->options->sector_width);
        if (s.gamma > best.sum)
            best = (sector){turned, s.gamma, s.pixels};
    }
    return best;
}

/* ln F(t; J); a sector outside of the image says nothing. */
static double log_tail(double t, int32_t pixels)
{
    return pixels > 0 ? asj_nfa_log_sector_tail(asj_nfa_tables(), t, pixels) : 0;
}

/* Whether the branches are meaningful together at radius r. */
static int is_meaningful(const asj_detection_run *run, const asj_hypothesis *hypothesis, int32_t r)
{
    sector sectors[ASJ_MAX_BRANCHES] = {{0, 0, 0}};
    double weakest = HUGE_VAL, log_nfa = run->test->log_tests[hypothesis->branch_count];
    if (!(log_nfa > -HUGE_VAL)) /* so many have no room side by side */
        return 0;
    for (int32_t b = 0; b < hypothesis->branch_count; b++) {
        sectors[b] = strongest(run, hypothesis, hypothesis->branches[b].angle, r);
        weakest = fmin(weakest, sectors[b].sum);
    }
    for (int32_t b = 0; b < hypothesis->branch_count; b++)
        log_nfa += log_tail(weakest, sectors[b].pixels);
    return log_nfa <= run->test->log_epsilon;
}

static void follow_branch(const asj_detection_run *run, const asj_hypothesis *hypothesis, asj_hypothesis_branch *branch)
{
    for (int32_t r = (int32_t)hypothesis->radius + 1; r <= LARGEST; r += r < 2 * GROWTH ? 1 : r / GROWTH) {
        const sector s = strongest(run, hypothesis, branch->angle, r);
        if (log_tail(s.sum, s.pixels) > run->test->log_alone)
            break;
        branch->angle = s.angle;
    }
}

/* The first radius at which a junction can be meaningful at as many in a row as are asked for. */
static int32_t least_radius(const asj_detect_options *options)
{
    int32_t r = 0;
    for (int32_t seen = 0; r < 31 && seen < options->isotropic_persistence; r++)
        seen += options->isotropic_radii >> r & 1 ? 1 : 0;
    return r - 1;
}

/* Makes the radius as small as the border asks for; 0: none is left. */
static int fit_into_image(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    const double right = run->frame->width - 1 - hypothesis->x, below = run->frame->height - 1 - hypothesis->y;
    const double most = fmin(fmin(hypothesis->x, hypothesis->y), fmin(right, below));
    if (hypothesis->radius > most)
        hypothesis->radius = (int32_t)most;
    return hypothesis->radius >= least_radius(run->options);
}

void asj_follow(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    if (!fit_into_image(run, hypothesis) || !is_meaningful(run, hypothesis, (int32_t)hypothesis->radius + 1)) {
        hypothesis->branch_count = 0;
        return;
    }
    for (int32_t b = 0; b < hypothesis->branch_count; b++)
        follow_branch(run, hypothesis, &hypothesis->branches[b]);
}
