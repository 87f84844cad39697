/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 7, junctions of octave -1.
 *
 * The upsampled images are matched as if they were the images: patches, distances between neighbours and tolerances in px suit what
 * is small, and octaves -1 and 0 are matched as one. As guests (guests.c) of the images' own matches junctions of octave -1 are
 * wrong in one of twelve.
 *
 * That alone is not safe. In soft frames of videos upsampled blur has many weak corners near each other, and a few of them agree by
 * chance with a few elsewhere: groups of three to five matches within 30 px, turned by any angle, each group for itself.
 * The images themselves are the witness: their own matches, found with other junctions at another scale, come again in the
 * upsampled images when these are right. So the images are matched first without octave -1,
 *   - when nothing comes of it, and no motion is left open, that is the answer, in less time;
 *   - when AGAIN of their matches come again, and the upsampled images have more (with those that a geometry of the images has
 *     added, where it judges both), the upsampled images' matches are the answer, with the others whose places are free;
 *   - otherwise, and when the upsampled images contradict the images (MOST_CONTRADICTED), the images' matches are.
 * And the images' matches say where those of the upsampled ones are looked for (expected.c).
 * Of two matches at one place then one stays (same_place.c).
 * One geometry judges both, and where the images leave it open or the two are at odds it says which ones are, whether or not
 * matches come again (looks.c). What was tried: tests/accuracy/tried/matching.md, "Images upsampled". */
#include "upsampled.h"
#include "both_poses.h"
#include "upsampled_geometry.h"
#include "result_changes.h"
#include "same_place.h"
#include "core/watch.h"

#include <math.h>

#define AGAIN 0.3  /* between the most of upsampled images that are wrong, .14, and the least of those that are right, .41 */
#define OWN 0.2    /* of the time */
#define MOST_CONTRADICTED 0.25 /* for one that comes again: things that repeat, matched by the period in the upsampled images. Of 48
                                * rendered rooms .31 and 1.8 where that is so and .12 at most elsewhere, .08 at most where partners
                                * are expected (expected.c); of a page at an extreme angle .22 */
#define FAR 12.0f  /* px */
#define SAME 4.0f  /* px, in both images: soft corners lie so far apart in two octaves */

int32_t asj_has_upsampled(const asj_junction *junctions, size_t count)
{
    for (size_t n = 0; n < count; n++)
        if (junctions[n].octave < 0)
            return 1;
    return 0;
}

/* One of the images' own matches among those of the upsampled images. */
enum { NEW, TAKEN /* another match has one of its places */, CONTRADICTED /* .. and is FAR off in the other image */, AGAIN_THERE };

static int is_near(float ax, float ay, float bx, float by)
{
    return fabsf(ax - bx) <= SAME && fabsf(ay - by) <= SAME;
}

static uint8_t look_up(const asj_junction_match *m, const asj_around *upsampled)
{
    uint8_t found = NEW;
    for (int32_t side = 0; side < 2 && found != AGAIN_THERE; side++) {
        asj_place_walk walk = asj_places_near(upsampled->places[side], upsampled->place_count, side ? m->x2 : m->x1,
                                              side ? m->y2 : m->y1, (double)SAME);
        for (uint32_t k; asj_places_next(&walk, &k);) {
            const asj_junction_match *f = &upsampled->matches[k];
            const int at1 = is_near(m->x1, m->y1, f->x1, f->y1), at2 = is_near(m->x2, m->y2, f->x2, f->y2);
            if (at1 && at2)
                return AGAIN_THERE;
            if (at1 || at2) {
                const float off = at1 ? fmaxf(fabsf(m->x2 - f->x2), fabsf(m->y2 - f->y2))
                                      : fmaxf(fabsf(m->x1 - f->x1), fabsf(m->y1 - f->y1));
                found = off > FAR ? CONTRADICTED : found == CONTRADICTED ? found : TAKEN;
            }
        }
    }
    return found;
}

/* What the matches of the images are among those of the upsampled ones. */
static asj_status look_all_up(asj_context *context, const asj_match_result *own, const asj_match_result *upsampled, uint8_t *found)
{
    const asj_around around = asj_match_result_around(upsampled);
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_ASSIGN);
    for (uint32_t n = 0; n < own->match_count && !asj_watch_stops(&watch, NULL); n++)
        found[n] = look_up(&own->matches[n], &around);
    return asj_watch_end(&watch);
}

/* Where the geometry of the images judges both, it has given them matches that it makes likely, and the upsampled ones none of its
 * own; so there are more when there are with those that the upsampled images leave room for. */
static int32_t holds(const asj_match_result *own, const asj_match_result *upsampled, const uint8_t *found, asj_looks looks)
{
    uint32_t again = 0, contradicted = 0, added = 0;
    for (uint32_t n = 0; n < own->match_count; n++) {
        again += found[n] == AGAIN_THERE;
        contradicted += found[n] == CONTRADICTED;
        added += looks == ASJ_LOOKS_BY_IMAGES && found[n] == NEW;
    }
    return looks == ASJ_LOOKS_RESOLVED ||
           (looks != ASJ_LOOKS_LOST && upsampled->match_count + added > own->match_count && again >= AGAIN * own->match_count &&
            contradicted <= MOST_CONTRADICTED * again);
}

/* --- which one holds --------------------------------------------------------------------------------------------------------- */

/* Times of both. */
static void add_times(asj_match_result *to, const asj_match_result *from)
{
    for (int32_t s = 0; s < ASJ_STAGE_COUNT; s++)
        to->stage_ms[s] += from->stage_ms[s];
}

/* Which ones of a list are not in another one, sorted by place here: rejected matches have no places. */
static asj_status find_new(asj_context *context, const asj_junction_match *list, size_t count, const asj_junction_match *others,
                           uint32_t other_count, uint8_t *is_new)
{
    asj_memory *memory = &context->memory;
    asj_place *places[2] = {asj_allocate(memory, other_count, sizeof **places), asj_allocate(memory, other_count, sizeof **places)};
    asj_status status = ASJ_OK;
    if (!places[0] || !places[1])
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %lu matches", (unsigned long)other_count);
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++)
        asj_places_sort(places[side], others, other_count, side);
    const asj_around around = {others, other_count, {places[0], places[1]}, other_count, NULL};
    for (size_t n = 0; n < count && status == ASJ_OK; n++)
        is_new[n] = look_up(&list[n], &around) != AGAIN_THERE;
    asj_release(memory, places[0]);
    asj_release(memory, places[1]);
    return status;
}

/* What one look rejects and the other one keeps is a match. */
static void forget_what_is_kept(asj_match_result *upsampled)
{
    const asj_around kept = asj_match_result_around(upsampled);
    asj_own_result *r = (asj_own_result *)upsampled;
    uint32_t count = 0;
    for (uint32_t n = 0; n < upsampled->rejected_count; n++)
        if (look_up(&r->rejected[n], &kept) != AGAIN_THERE)
            r->rejected[count++] = r->rejected[n];
    upsampled->rejected_count = count;
    upsampled->rejected = count ? r->rejected : NULL;
}

/* Those of the upsampled images, and of the others what is new. A geometry that the upsampled images have themselves judges these,
 * too, and what another one has rejected. */
static asj_status join(asj_context *context, asj_match_result *own, asj_match_result *upsampled, uint8_t *found, asj_looks looks,
                       int32_t same_lists)
{
    asj_status status = looks == ASJ_LOOKS_BY_IMAGES ? ASJ_OK :
                        looks == ASJ_LOOKS_DISPUTED  ? asj_looks_filter(context, upsampled, own) :
                                                       asj_looks_judge_by_upsampled(context, own, upsampled);
    if (status == ASJ_OK)
        status = look_all_up(context, own, upsampled, found);
    uint8_t *rejected = asj_allocate(&context->memory, own->rejected_count, sizeof *rejected);
    if (status == ASJ_OK && !rejected)
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %u matches", (unsigned)own->rejected_count);
    if (status == ASJ_OK)
        status = find_new(context, own->rejected, own->rejected_count, upsampled->rejected, upsampled->rejected_count,
                          rejected);
    for (uint32_t n = 0; n < own->match_count; n++)
        found[n] = found[n] == NEW;
    if (status == ASJ_OK)
        status = asj_match_result_join(context, upsampled, own, found, rejected, same_lists);
    if (status == ASJ_OK)
        forget_what_is_kept(upsampled);
    asj_release(&context->memory, rejected);
    return status == ASJ_OK ? asj_same_place(context, upsampled) : status;
}

/* What is left of both, in *own. */
static asj_status choose(asj_context *context, asj_match_result **own, asj_match_result **upsampled, uint8_t *found,
                         asj_looks looks, int32_t same_lists)
{
    asj_status status = looks == ASJ_LOOKS_BY_IMAGES ? asj_looks_judge(context, *own, *upsampled) :
                        looks == ASJ_LOOKS_DISPUTED  ? asj_looks_filter(context, *own, *upsampled) : ASJ_OK;
    if (status == ASJ_OK)
        status = look_all_up(context, *own, *upsampled, found);
    if (status != ASJ_OK)
        return status;
    if (!holds(*own, *upsampled, found, looks))
        return looks == ASJ_LOOKS_DISPUTED ? asj_looks_filter(context, *upsampled, *own) : ASJ_OK;
    status = join(context, *own, *upsampled, found, looks, same_lists);
    asj_match_result *other = *own;
    *own = *upsampled;
    *upsampled = other;
    return status;
}

asj_status asj_upsampled_choose(asj_context *context, asj_match_result **own, asj_match_result **upsampled, int32_t same_lists)
{
    const size_t count = (*own)->match_count;
    const asj_looks looks = asj_looks_of(*own, *upsampled);
    const asj_match_result *both = *upsampled;
    const asj_geometry of_own = (*own)->geometry, of_upsampled = (*upsampled)->geometry;
    uint8_t *found = asj_allocate(&context->memory, count, sizeof *found);
    const asj_status status = found ? choose(context, own, upsampled, found, looks, same_lists)
                                    : asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu matches", count);
    if (*own == both && asj_looks_agree(&of_own, &of_upsampled))
        asj_both_poses(looks == ASJ_LOOKS_BY_IMAGES ? &of_upsampled : &of_own, &(*own)->geometry);
    if (looks == ASJ_LOOKS_DISPUTED)
        asj_looks_leave_open(&of_own, &of_upsampled, *own);
    else if (looks == ASJ_LOOKS_PLANE)
        (*own)->geometry.has_pose = 0;
    add_times(*own, *upsampled);
    asj_release(&context->memory, found);
    asj_match_result_free(upsampled);
    return status;
}

/* Worth while where the images themselves have matches, or leave a motion open, or have nothing to match. */
static int is_worth(const asj_match_result *own)
{
    return own->match_count > 0 || asj_looks_may_resolve(own) || own->l_junction_count1 == 0 ||
           own->l_junction_count2 == 0;
}

static asj_status match_both(asj_context *context, const asj_match_options *options, const asj_upsampled_match *match,
                             asj_match_result **result)
{
    const double from = context->progress_from, part = context->progress_part, whole = part > 0 ? part : 1;
    asj_match_result *upsampled = NULL;
    context->progress_part = OWN * whole;
    asj_known_matches known = {NULL, {{1, 1}, {1, 1}}};
    asj_status status = match->pass(context, options, match->data, 0, NULL, result);
    context->progress_from = from + OWN * whole;
    context->progress_part = (1 - OWN) * whole;
    known.result = *result;
    if (status == ASJ_OK && is_worth(*result)) {
        asj_optional_begin(context); /* the images' own matches stay */
        status = asj_optional_end(context, match->pass(context, options, match->data, 1, &known, &upsampled));
    }
    context->progress_from = from;
    context->progress_part = part;
    for (int32_t side = 0; side < 2 && status == ASJ_OK; side++)
        status = asj_match_result_number(context, *result, side, options->minimum_opening, match->junctions[side],
                                         match->counts[side]);
    if (status == ASJ_OK && upsampled)
        status = asj_upsampled_choose(context, result, &upsampled, 1);
    if (status == ASJ_OK)
        status = asj_progress(context, ASJ_STAGE_ASSIGN, 1);
    if (status != ASJ_OK) {
        asj_match_result_free(&upsampled);
        asj_match_result_free(result);
    }
    return status;
}

asj_status asj_match_upsampled(asj_context *context, const asj_match_options *options, const asj_upsampled_match *match,
                               asj_match_result **result)
{
    const int32_t has_upsampled = asj_has_upsampled(match->junctions[0], match->counts[0]) ||
                                  asj_has_upsampled(match->junctions[1], match->counts[1]);
    if (has_upsampled && !match->upsampled_only)
        return match_both(context, options, match, result);
    return match->pass(context, options, match->data, has_upsampled, match->known, result);
}
