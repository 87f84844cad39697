/* SPDX-License-Identifier: BSD-2-Clause */
/* One focal length for both cameras, square pixels, principal points known: six parameters of the seven of a fundamental matrix.
 *
 * Formulas that take it from a fundamental matrix (Bougnoux 1998; Sturm 2001 for equal ones) need a better matrix than a dozen
 * matches among hundreds of wrong ones give. So focal lengths are tried: with each of COARSE ones, and with the one that the edges
 * of the images make likeliest (focal_prior.c), motions are sampled and refined as with known cameras, and the one with most
 * evidence is followed to longer and shorter focal lengths (focal_profile.c). When that tells the focal length, all motions that
 * there are with it are finalists, as with known cameras.
 *
 * Where edges do not tell the same one as well, the best motions of the other focal lengths are followed, too. Where one ends
 * elsewhere with evidence that the best one does not exclude (focal_profile.c), the focal length is not known.
 *
 * Where a focal length is about known, motions are looked for with that one, which explains much the same matches, and with the one
 * that is likeliest by edges, and followed from there (asj_geometry_options.focal_sd).
 *
 * A camera that only turns tells its focal length by itself (Hartley, "Self-calibration from multiple views with a rotating
 * camera", ECCV 1994): K^-1 H K is a rotation with the right one. Of the homographies that were found, the factors with which they
 * are most nearly rotations are where the path may start, and the focal length of the motion.
 *
 * (Of 119 pairs of rooms 45 had a pose without what edges say, 18 of them out by more than 3 degrees, and 97 with it, 2 of
 * them.) */
#include "focal.h"
#include "motions.h"
#include "pure_rotation.h"

#include <math.h>
#include <string.h>

#define COARSE 5
#define FIRST 6 /* number of a factor: 0.54 of the longer side; the others are .. */
#define OFF_PLANE 2.0 /* matches off a plane that tell more than it does, */
#define OFF_PLANE_SHARE 0.03 /* .. and at least such a part of all */
#define MOST_FLAT 6 /* homographies that may be rotations */
#define APART 7 /* .. that far from each other, up to 2.19 */

struct asj_focal_search {
    asj_search search;
    asj_focal_prior prior;
    asj_focal_profile profile;
    asj_model flat; /* the homography with most evidence */
    asj_model starts[COARSE + 1]; /* the best ones with each focal length that is tried */
    int32_t start_count, best;
    asj_focal paths[COARSE + 1]; /* where they lead: first the best one, then, when they are asked, the others */
    int32_t path_count;
    asj_model finalists[3 * ASJ_FINALISTS];
};

/* All motions with one focal length. */
static asj_status search_at(asj_focal_search *s, double factor, const asj_model *flat, int32_t flat_count, int32_t settled,
                            asj_model *list, int32_t *count)
{
    asj_context *context = s->profile.context;
    asj_search with = s->search;
    with.kind = ASJ_GEOMETRY_ESSENTIAL;
    asj_focal_cameras(&s->prior, factor, with.cameras);
    *count = 0;
    asj_status status = asj_focal_turn(&s->profile, factor);
    if (status == ASJ_OK)
        status = asj_geometry_search(context, s->profile.set, &with, list, count);
    if (status == ASJ_OK && flat_count > 0) {
        memcpy(list + *count, flat, (size_t)flat_count * sizeof *flat);
        *count += flat_count;
    }
    if (status == ASJ_OK && *count > 0)
        status = asj_refine_motions(context, s->profile.set, with.cameras, with.seed, settled, list, count);
    return status;
}

/* The best of them, when it is better than *best. */
static asj_status look_at(asj_focal_search *s, double factor, const asj_model *flat, int32_t flat_count, asj_model *best)
{
    int32_t count;
    const asj_status status = search_at(s, factor, flat, flat_count, 0, s->finalists, &count);
    for (int32_t k = 0; k < count && status == ASJ_OK; k++) {
        asj_model *m = &s->finalists[k];
        m->evidence += asj_log_focal_prior(&s->prior, factor);
        if (m->kind == ASJ_GEOMETRY_ESSENTIAL && m->evidence > best->evidence)
            *best = *m;
    }
    return status;
}

/* One plane alone explains the same whatever the focal length is, and what a motion makes of a few tenths of a pixel then is noise.
 * (Sixty matches on a plane, with the right focal length known to 5 %: what is found is out by 6 to 19 %.) */
static int32_t tells(const asj_focal_search *s, const asj_model *motion)
{
    if (!(s->flat.evidence > -HUGE_VAL))
        return 1;
    asj_adjust_scratch *scratch = &s->profile.scratch[0];
    const double all = asj_explained(s->profile.set, motion, scratch);
    return all - asj_explained(s->profile.set, &s->flat, scratch) >= fmax(OFF_PLANE, OFF_PLANE_SHARE * all);
}

void asj_focal_search_flat(asj_focal_search *s, const asj_model *flat, int32_t count)
{
    for (int32_t k = 0; k < count; k++)
        if (flat[k].evidence > s->flat.evidence)
            s->flat = flat[k];
}

static double factor_of(const asj_focal_search *s, const asj_focal *found)
{
    return found->model.cameras[0].fx / s->prior.cameras[0].fx;
}

/* Is there no other focal length with which nearly as much is explained? */
static int32_t is_alone(const asj_focal_search *s, const asj_focal *found)
{
    const double factor = factor_of(s, found), least = found->model.evidence - asj_focal_excludes(found->model.evidence);
    for (int32_t k = 0; k < s->path_count; k++)
        if (s->paths[k].model.evidence > least && fabs(log(factor_of(s, &s->paths[k]) / factor)) > ASJ_SAME_FOCAL)
            return 0;
    return 1;
}

/* Does nobody else tell this focal length: nobody who knew it before, and not the edges? */
static int32_t is_only_witness(const asj_focal_search *s, const asj_focal *found)
{
    return found->is_known && !(s->prior.sd > 0) && !asj_focal_has_edges(&s->prior, factor_of(s, found));
}

static asj_status follow(asj_focal_search *s, const asj_model *start)
{
    return asj_focal_follow(&s->profile, start, tells(s, start), &s->paths[s->path_count++]);
}

/* Where a focal length is told by a motion alone, all others have their say. */
static asj_status ask_others(asj_focal_search *s, asj_focal *found)
{
    const int32_t first = s->path_count == 1; /* they stay */
    asj_status status = ASJ_OK;
    if (!is_only_witness(s, found))
        return ASJ_OK;
    for (int32_t k = 0; k < s->start_count && first && status == ASJ_OK; k++)
        if (k != s->best)
            status = follow(s, &s->starts[k]);
    found->is_known = is_alone(s, found);
    return status == ASJ_OK ? asj_focal_turn(&s->profile, factor_of(s, found)) : status;
}

/* The one with most evidence. */
static const asj_focal *best_path(const asj_focal_search *s)
{
    const asj_focal *best = s->paths;
    for (int32_t k = 1; k < s->path_count; k++)
        best = s->paths[k].model.evidence > best->model.evidence ? &s->paths[k] : best;
    return best;
}

asj_status asj_find_focal(asj_focal_search *s, const asj_model *flat, int32_t count, asj_focal *found)
{
    double factors[COARSE + 1];
    int32_t tried = 0;
    const int32_t likeliest = asj_likeliest_focal(&s->prior), is_given = s->prior.sd > 0;
    asj_status status = ASJ_OK;
    memset(found, 0, sizeof *found);
    found->model.evidence = -HUGE_VAL;
    if (is_given)
        factors[tried++] = 1;
    if (likeliest >= 0 && !(is_given && likeliest == s->prior.count / 2))
        factors[tried++] = asj_focal_factor(&s->prior, likeliest);
    for (int32_t k = 0; k < COARSE && !is_given; k++)
        factors[tried++] = asj_focal_factor(&s->prior, FIRST + k * APART);
    for (int32_t k = 0; k < tried && status == ASJ_OK; k++) {
        asj_model *start = &s->starts[s->start_count];
        start->evidence = -HUGE_VAL;
        status = look_at(s, factors[k], flat, count, start);
        s->start_count += start->evidence > -HUGE_VAL;
    }
    for (int32_t k = 1; k < s->start_count; k++)
        s->best = s->starts[k].evidence > s->starts[s->best].evidence ? k : s->best;
    if (status == ASJ_OK && s->start_count > 0)
        status = follow(s, &s->starts[s->best]);
    if (status != ASJ_OK || s->path_count == 0)
        return status;
    *found = s->paths[0];
    status = ask_others(s, found);
    if (status != ASJ_OK || best_path(s) == s->paths)
        return status;
    *found = *best_path(s);
    status = ask_others(s, found);
    return status == ASJ_OK ? asj_focal_turn(&s->profile, factor_of(s, found)) : status;
}

asj_status asj_find_focal_of(asj_focal_search *s, const asj_model *motion, asj_focal *found)
{
    const asj_status status = asj_focal_follow(&s->profile, motion, tells(s, motion), found);
    return status == ASJ_OK ? ask_others(s, found) : status;
}

/* With which K2^-1 H K1 is most nearly a rotation. */
static double factor_of_rotation(const asj_focal_search *s, const asj_model *homography)
{
    double least = HUGE_VAL, best = 1;
    for (int32_t n = 0; n < s->prior.count; n++) {
        asj_camera cameras[2];
        asj_focal_cameras(&s->prior, asj_focal_factor(&s->prior, n), cameras);
        const double far = asj_far_from_rotation(homography, cameras);
        if (far < least) {
            least = far;
            best = asj_focal_factor(&s->prior, n);
        }
    }
    return best;
}

/* The rotation near that of a model, with that focal length, when it is better than *best. */
static asj_status look_at_rotation(asj_focal_search *s, double factor, const asj_model *near, asj_model *best)
{
    asj_model rotation;
    asj_camera cameras[2];
    int32_t found = 0;
    asj_focal_cameras(&s->prior, factor, cameras);
    asj_status status = asj_focal_turn(&s->profile, factor);
    if (status == ASJ_OK)
        status = asj_find_pure_rotation(s->profile.context, s->profile.set, cameras, near, 1, &rotation, &found);
    if (status != ASJ_OK || !found)
        return status;
    rotation.evidence += asj_log_focal_prior(&s->prior, factor);
    if (rotation.evidence > best->evidence)
        *best = rotation;
    return ASJ_OK;
}

asj_status asj_find_focal_of_rotation(asj_focal_search *s, const asj_model *flat, int32_t count, const asj_model *motion,
                                      asj_focal *found)
{
    asj_model best;
    memset(found, 0, sizeof *found);
    best.evidence = found->model.evidence = -HUGE_VAL;
    asj_status status = look_at_rotation(s, motion->cameras[0].fx / s->prior.cameras[0].fx, motion, &best);
    for (int32_t k = 0; k < count && k < MOST_FLAT && status == ASJ_OK; k++)
        status = look_at_rotation(s, factor_of_rotation(s, &flat[k]), &flat[k], &best);
    return status == ASJ_OK && best.evidence > -HUGE_VAL ? asj_focal_follow(&s->profile, &best, 1, found) : status;
}

asj_status asj_focal_search_turn(asj_focal_search *s, const asj_focal *found)
{
    return asj_focal_turn(&s->profile, factor_of(s, found));
}

asj_status asj_find_with_focal(asj_focal_search *s, const asj_focal *found, const asj_model *flat, int32_t flat_count,
                               asj_model *list, int32_t *count)
{
    int32_t kept = 0;
    const asj_status status = search_at(s, factor_of(s, found), flat, flat_count, ASJ_SETTLED, list, count);
    for (int32_t k = 0; k < *count && status == ASJ_OK; k++) {
        asj_model *m = &list[k];
        if (m->kind != ASJ_GEOMETRY_ESSENTIAL || !(m->evidence > -HUGE_VAL))
            continue;
        m->evidence += found->log_share;
        m->peak += found->log_share;
        list[kept++] = *m;
    }
    *count = kept;
    return status;
}

asj_status asj_focal_search_create(asj_context *context, asj_pairs *set, const asj_geometry_hints *hints, const asj_search *search,
                                   double sd, asj_focal_search **created)
{
    asj_memory *memory = &context->memory;
    asj_focal_search *s = *created = asj_allocate_zero(memory, 1, sizeof *s);
    if (!s)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the focal length");
    s->search = *search;
    s->flat.evidence = -HUGE_VAL;
    s->profile.context = context;
    s->profile.set = set;
    s->profile.prior = &s->prior;
    s->profile.branches = hints ? hints->branches : NULL;
    s->profile.seed = search->seed;
    s->profile.scratch = asj_adjust_scratches_create(memory, set, context->threads);
    if (!s->profile.scratch)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the focal length");
    return asj_focal_prior_make(context, set, hints ? hints->edges : NULL, search->cameras, sd, &s->prior);
}

void asj_focal_search_free(asj_memory *memory, asj_focal_search *s)
{
    if (s && s->profile.scratch)
        asj_adjust_scratches_free(memory, s->profile.scratch, s->profile.context->threads);
    asj_release(memory, s);
}
