/* SPDX-License-Identifier: BSD-2-Clause */
/* Two looks at the same images, two estimates of their geometry, and one answer.
 *
 * Poses are two witnesses of one motion. The rules, in the order in which they are asked; each stands in full above its code:
 *   - What only one of the two looks can tell is told by that one, but for a focal length that the other one
 *     leaves open with much more evidence.                                                                     asj_looks_of()
 *   - Of two accepted poses that agree as far as they know the mean is told; the surer one judges.             compare()
 *   - Of two that are at odds pictures decide, then much more evidence, then which one is upside down; or
 *     nothing does.                                                                                            decide()
 *   - Images that repeat themselves need more than other images do, and upsampled ones that do so leave what the
 *     images accept open where they have much more evidence for another motion.                 repeats(), is_outdone()
 *   - What the images leave open the upsampled ones resolve: by the same motion or its rival, or by another one
 *     with more evidence; but not upside down.                                            resolves(), look_beyond()
 *   - The images' colours answer where there is no geometry yet or none that is sure.                          asj_looks_take()
 * Pictures (../geometry/picture_agreement.c) tell a motion from one that is far from it, and not from one that is nearly the same:
 * there it is the planes that agree or not.                                              agrees_better(), is_convincing()
 *
 * How often which rule is needed, and how often it is right: tests/accuracy/tried/geometry.md, "Which look holds". */
#include "looks.h"
#include "core/angle.h"
#include "geometry/ambiguity.h"
#include "geometry/geometry_options.h"
#include "geometry/picture_agreement.h"
#include "geometry/small_matrix.h"

#include <math.h>
#include <string.h>

/* Of the rotation, and of the direction of the translation: */
#define SAME_POSE (4 * ASJ_DEGREE)   /* where one of the two is not accepted and does not say how sure it is */
#define LEAST_APART (3 * ASJ_DEGREE) /* of two that do, no less is at odds, */
#define SURELY_APART 6.5             /* and no less than so many standard deviations (of others up to 5.9) */
#define OTHER_POSE (8 * ASJ_DEGREE)  /* another motion: pictures decide, and evidence may leave it open */
#define MUCH_SURER 4.0               /* times as well known (room 7399: 21; frames of a video, where it was wrong: 1.02) */
#define HALF_TURN 1e-6               /* 2 sin of an angle that is 180 degrees */

/* Evidence of the upsampled images, or of the colours: */
#define SURPASSES 1.25 /* times that of the images (98 of 100 pairs whose looks agree have 1.27 and more), */
#define SURELY (-35)   /* log10 NFA (without it three more of 396 unrelated pairs are accepted, with it one); */
#define OUTNUMBERS 2.0 /* times that, where either repeats itself (wrong ones have up to 1.7, right ones 2.1 and more), or to leave
                        * a focal length open; */
#define OUTWEIGHS 2.5  /* times that of an accepted motion, with which it is at odds (a wrong one had 1.6) */

/* Agreement of the pictures: */
#define AGREES_BETTER 0.15 /* right looks by .17 to .54 in seven of eleven pairs, a wrong one by .09 */
#define WORSE 0.05
#define ENOUGH 0.5         /* one right motion of 20 has less */
#define CONVINCING (ASJ_USUAL_AGREEMENT - 0.005) /* nothing known is no reason against */

/* How far two poses are apart: rad, and with their covariances in standard deviations along that way. */
typedef struct distance {
    double rotation, translation, deviations;
} distance;

/* v / sd of the sum of both in its direction. Nothing is uncertain along a translation itself, which is of length 1: opposite ones
 * are sure to differ, whatever rounding leaves of the variance. */
static double in_deviations(const double v[3], const asj_geometry *a, const asj_geometry *b, int32_t first)
{
    double variance = 0;
    for (int32_t i = 0; i < 3; i++)
        for (int32_t k = 0; k < 3; k++) {
            const int32_t at = 6 * (first + i) + first + k;
            variance += v[i] * v[k] * (a->covariance[at] + b->covariance[at]);
        }
    const double square = asj_dot3(v, v);
    return variance > 0 ? square / sqrt(variance) : square > 0 ? HUGE_VAL : 0;
}

/* Its axis, of any length. sin(angle) axis is what is antisymmetric of a turn, which vanishes at 180 degrees; what is symmetric is
 * 2 axis axis' - I there. */
static void find_axis(const double turn[9], double axis[3])
{
    int32_t most = 0;
    axis[0] = turn[7] - turn[5];
    axis[1] = turn[2] - turn[6];
    axis[2] = turn[3] - turn[1];
    if (asj_dot3(axis, axis) > HALF_TURN * HALF_TURN || turn[0] + turn[4] + turn[8] > 0)
        return;
    for (int32_t k = 1; k < 3; k++)
        most = turn[4 * k] > turn[4 * most] ? k : most;
    for (int32_t k = 0; k < 3; k++)
        axis[k] = turn[3 * most + k] + (k == most);
}

static distance measure(const asj_geometry *a, const asj_geometry *b)
{
    double turn[9], along[3], axis[3];
    asj_multiply3_transposed(a->rotation, b->rotation, turn);
    find_axis(turn, axis);
    const double length = sqrt(asj_dot3(axis, axis));
    distance d = {asj_rotation_angle(turn), 0, 0};
    double vector[3];
    for (int32_t k = 0; k < 3; k++) {
        along[k] = a->translation[k] - b->translation[k];
        vector[k] = length > 0 ? d.rotation * axis[k] / length : 0;
    }
    d.translation = 2 * asin(fmin(1, 0.5 * sqrt(asj_dot3(along, along))));
    d.deviations = fmax(in_deviations(vector, a, b, 0), in_deviations(along, a, b, 3));
    return d;
}

static int32_t have_same_pose(const asj_geometry *a, const asj_geometry *b)
{
    const distance d = measure(a, b);
    return fmax(d.rotation, d.translation) <= SAME_POSE;
}

static int32_t has_rival_pose(const asj_geometry *g)
{
    return g->has_rival && asj_dot3(g->rival_translation, g->rival_translation) > 0;
}

/* Is the pose that of the rival? */
static int32_t is_rival_of(const asj_geometry *g, const asj_geometry *pose)
{
    asj_geometry rival = *g;
    memcpy(rival.rotation, g->rival_rotation, sizeof rival.rotation);
    memcpy(rival.translation, g->rival_translation, sizeof rival.translation);
    return has_rival_pose(g) && have_same_pose(&rival, pose);
}

static int32_t are_at_odds(const asj_geometry *a, const asj_geometry *b)
{
    const distance d = measure(a, b);
    return fmax(d.rotation, d.translation) > LEAST_APART && d.deviations > SURELY_APART;
}

static int32_t is_sure_pose(const asj_geometry *g)
{
    return g->status == ASJ_GEOMETRY_ACCEPTED && g->has_pose && !(g->focal_sd > 0);
}

int32_t asj_looks_agree(const asj_geometry *a, const asj_geometry *b)
{
    return is_sure_pose(a) && is_sure_pose(b) && !are_at_odds(a, b);
}

/* Sum of the variances of rotation and translation. */
static double uncertainty(const asj_geometry *g)
{
    double sum = 0;
    for (int32_t k = 0; k < 6; k++)
        sum += g->covariance[7 * k];
    return sum;
}

/* A motion that the images leave open says how far; without a focal length, nothing. */
static int32_t contradicts(const asj_geometry *open, const asj_geometry *upsampled)
{
    return uncertainty(open) > 0 && are_at_odds(open, upsampled);
}

/* Are two motions so far from each other that pictures tell one from the other? */
static int32_t are_others(const asj_geometry *a, const asj_geometry *b)
{
    const distance d = measure(a, b);
    return fmax(d.rotation, d.translation) > OTHER_POSE;
}

/* Do the pictures agree with `a` so much better that it is right, of two motions? */
static int32_t agrees_better(const asj_geometry *a, const asj_geometry *b)
{
    return are_others(a, b) && fmin(a->picture_knowledge, b->picture_knowledge) > ASJ_LEAST_KNOWN &&
           a->picture_agreement - b->picture_agreement > AGREES_BETTER;
}

/* Do the pictures agree so well with `a` that more evidence than `b` has is believed, of two motions? */
static int32_t is_convincing(const asj_geometry *a, const asj_geometry *b)
{
    return !are_others(a, b) || !(a->picture_agreement > 0) ||
           (a->picture_agreement > CONVINCING && a->picture_agreement > b->picture_agreement - WORSE);
}

/* Has a motion of the upsampled images so much more evidence than the best one of the images, which has rivals or is open, or is it
 * another one with which the pictures agree so much better? */
static int32_t surpasses(const asj_geometry *upsampled, const asj_geometry *own)
{
    return agrees_better(upsampled, own) ||
           (upsampled->log10_nfa < fmin(SURELY, SURPASSES * own->log10_nfa) && is_convincing(upsampled, own));
}

static int32_t tells_motion(const asj_geometry *g)
{
    return g->has_pose || g->only_turns;
}

/* What is up in image 1 is down in image 2. */
static int32_t is_upside_down(const asj_geometry *g)
{
    return tells_motion(g) && g->rotation[4] < 0;
}

/* Have the images a rival that is no chance by itself? Then things repeat, and they do so in the upsampled images, too, whose
 * rivals the matcher may have lost: it makes neighbours agree on one period. So only OUTNUMBERS times the evidence tells. */
static int32_t repeats(const asj_geometry *own)
{
    return own->status == ASJ_GEOMETRY_AMBIGUOUS && own->has_rival && own->rival_log10_nfa < ASJ_SURE_RIVAL;
}

int32_t asj_looks_is_answer(const asj_geometry *g)
{
    return g->status == ASJ_GEOMETRY_ACCEPTED || asj_geometry_is_open(g);
}

/* Of two accepted poses that are at odds one is wrong. Of two of a plane the plane is the answer, and its pose is open. Otherwise
 * pictures say which one it is, where they can; if not, OUTWEIGHS times the evidence does; and if not, what is upside down is
 * wrong, unless it has so much more itself. Where nothing says which, neither is told. */
static asj_looks decide(const asj_geometry *own, const asj_geometry *upsampled)
{
    if (!own->only_turns && own->model == ASJ_GEOMETRY_HOMOGRAPHY && upsampled->model == ASJ_GEOMETRY_HOMOGRAPHY)
        return ASJ_LOOKS_PLANE;
    if (agrees_better(upsampled, own))
        return ASJ_LOOKS_RESOLVED;
    if (agrees_better(own, upsampled))
        return ASJ_LOOKS_BY_IMAGES;
    if (upsampled->log10_nfa < OUTWEIGHS * own->log10_nfa)
        return ASJ_LOOKS_RESOLVED;
    if (is_upside_down(upsampled) && !is_upside_down(own))
        return ASJ_LOOKS_BY_IMAGES;
    return is_upside_down(own) && !is_upside_down(upsampled) && own->log10_nfa > OUTWEIGHS * upsampled->log10_nfa
               ? ASJ_LOOKS_RESOLVED : ASJ_LOOKS_DISPUTED;
}

/* Of two poses that do not contradict each other: is `a` known better, and from much more evidence? */
static int32_t is_surer(const asj_geometry *a, const asj_geometry *b)
{
    return !are_at_odds(a, b) && uncertainty(a) < uncertainty(b) && a->log10_nfa < SURPASSES * b->log10_nfa;
}

/* Of two accepted poses, or turns of a camera: the surer one judges where they agree as far as they know. Where the images' pose
 * is hardly known beside another one from more evidence, that needs no matches that come again: those of the images tell little.
 * (Room 7399: known to 7 degrees, which it was out by, and to .4.) */
static asj_looks compare(const asj_geometry *own, const asj_geometry *upsampled)
{
    if (are_at_odds(own, upsampled))
        return decide(own, upsampled);
    if (is_surer(upsampled, own) && MUCH_SURER * MUCH_SURER * uncertainty(upsampled) < uncertainty(own) &&
        upsampled->log10_nfa < SURELY && !have_same_pose(own, upsampled))
        return ASJ_LOOKS_RESOLVED;
    return uncertainty(upsampled) <= uncertainty(own) ? ASJ_LOOKS_BY_UPSAMPLED : ASJ_LOOKS_BY_IMAGES;
}

int32_t asj_looks_may_resolve(const asj_match_result *own)
{
    return asj_geometry_is_open(&own->geometry) && own->geometry.model == ASJ_GEOMETRY_ESSENTIAL;
}

/* Does a motion resolve what the images have rivals for or leave open? Where it is their best one or its rival it does: chance does
 * not bring one motion to within SAME_POSE twice. Another one needs more evidence. No matches have to come again for that: where
 * things repeat those of the images were matched by the period. */
static int32_t resolves(const asj_geometry *upsampled, const asj_geometry *own)
{
    return upsampled->status == ASJ_GEOMETRY_ACCEPTED && upsampled->has_pose &&
           (have_same_pose(own, upsampled) || is_rival_of(own, upsampled) || surpasses(upsampled, own));
}

/* Of images that have rivals or leave the motion open. Without matches of their own only what resolves it counts. Nothing that is
 * upside down does: frames and windows match themselves so, in either look. And no motion undoes that the camera only turns: of
 * thousands of matches the errors that they have in common look like a small step. What does not resolve it may still hold by its
 * matches, which upsampled.c asks, unless it is a motion that the images do not allow. */
static asj_looks look_beyond(const asj_match_result *own, const asj_geometry *upsampled)
{
    const asj_geometry *a = &own->geometry;
    const int32_t resolved = resolves(upsampled, a);
    if (own->match_count == 0 && !resolved)
        return ASJ_LOOKS_LOST;
    if (upsampled->status != ASJ_GEOMETRY_ACCEPTED)
        return ASJ_LOOKS_BY_UPSAMPLED;
    if (is_upside_down(upsampled) || !upsampled->has_pose || a->only_turns)
        return ASJ_LOOKS_LOST;
    if (resolved)
        return ASJ_LOOKS_RESOLVED;
    return a->status == ASJ_GEOMETRY_DEGENERATE && contradicts(a, upsampled) ? ASJ_LOOKS_LOST : ASJ_LOOKS_BY_UPSAMPLED;
}

/* Have upsampled images that repeat themselves so much more evidence for another motion that an accepted one is not sure, unless
 * pictures agree better with it? (Of 396 pairs six repeat themselves beside an accepted motion. Three have that in front; of the
 * others, which have 2.1 to 2.6 times its evidence, two are wrong, which pictures say, and one is right.) Where their
 * rival is another motion, too, so much more as looks at one motion have is enough: the right one would be one of the two. */
static int32_t is_outdone(const asj_geometry *own, const asj_geometry *upsampled)
{
    const double times = has_rival_pose(upsampled) && !is_rival_of(upsampled, own) ? SURPASSES : OUTNUMBERS;
    return upsampled->status == ASJ_GEOMETRY_AMBIGUOUS && own->has_pose && upsampled->has_pose && are_others(own, upsampled) &&
           upsampled->log10_nfa < times * own->log10_nfa && !agrees_better(own, upsampled);
}

/* Is a focal length that was found with the motion one that upsampled images with so much more evidence leave open? (A villa: 1865
 * px, in place of some 507.) */
static int32_t loses_focal(const asj_geometry *own, const asj_geometry *upsampled)
{
    return own->focal_sd > 0 && upsampled->status == ASJ_GEOMETRY_ACCEPTED && !tells_motion(upsampled) &&
           upsampled->log10_nfa < OUTNUMBERS * own->log10_nfa;
}

/* The images' accepted geometry stays beside upsampled images that have none, or rivals that do not outdo it, and beside a motion
 * of another kind; one without a motion (a plane, a fundamental matrix), or with a focal length that is lost, gives way to what the
 * upsampled images accept. */
asj_looks asj_looks_of(const asj_match_result *own, const asj_match_result *upsampled)
{
    const asj_geometry *a = &own->geometry, *b = &upsampled->geometry;
    const int32_t accepted = b->status == ASJ_GEOMETRY_ACCEPTED;
    const int32_t alike = (a->has_pose && b->has_pose) || (a->only_turns && b->only_turns);
    if (a->status == ASJ_GEOMETRY_ACCEPTED)
        return accepted && alike ? compare(a, b) :
               is_outdone(a, b) ? ASJ_LOOKS_DISPUTED :
               accepted && (!tells_motion(a) || loses_focal(a, b)) ? ASJ_LOOKS_BY_UPSAMPLED : ASJ_LOOKS_BY_IMAGES;
    if (repeats(a) && !(accepted && b->log10_nfa < OUTNUMBERS * a->log10_nfa))
        return ASJ_LOOKS_LOST;
    return asj_looks_may_resolve(own) ? look_beyond(own, b) : ASJ_LOOKS_BY_UPSAMPLED;
}

static int32_t agrees_enough(const asj_geometry *g)
{
    return !(g->picture_agreement > 0) || g->picture_agreement > ENOUGH;
}

/* A geometry that needs no other. Without cameras, and where the model is a plane, there is no motion to ask for. */
static int32_t is_enough(const asj_geometry *g)
{
    return g->status == ASJ_GEOMETRY_ACCEPTED &&
           (tells_motion(g) ? g->log10_nfa < SURELY && agrees_enough(g) : g->model != ASJ_GEOMETRY_ESSENTIAL);
}

int32_t asj_looks_want_other(const asj_match_result *own)
{
    const asj_geometry *g = &own->geometry;
    if (g->status == ASJ_GEOMETRY_AMBIGUOUS)
        return asj_looks_may_resolve(own) && !repeats(g);
    return g->status != ASJ_GEOMETRY_NOT_ASKED && !is_enough(g);
}

/* Where the images have chance or too little, whatever the other look accepts. Otherwise no pose is no answer, nor is one that is
 * upside down, nor any where the camera only turns. Rivals and motions that stay open it resolves as the upsampled images do, and a
 * motion that stays open also when the images allow it. A pose gives way to another one that surpasses it, or to a surer one. */
int32_t asj_looks_take(const asj_match_result *own, const asj_match_result *other)
{
    const asj_geometry *a = &own->geometry, *b = &other->geometry;
    if (!asj_looks_want_other(own) || b->status != ASJ_GEOMETRY_ACCEPTED)
        return 0;
    if (a->status == ASJ_GEOMETRY_CHANCE || a->status == ASJ_GEOMETRY_TOO_FEW)
        return 1;
    if (!b->has_pose || is_upside_down(b) || a->only_turns)
        return 0;
    if (a->status == ASJ_GEOMETRY_AMBIGUOUS)
        return resolves(b, a);
    return surpasses(b, a) || (!tells_motion(a) && !contradicts(a, b)) || (a->has_pose && is_surer(b, a));
}
