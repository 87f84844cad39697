/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_match_images(): from two images to their matches, if wanted stretched before.
 *
 * Automatically: as they are; where that gives matches enough, upsampled, too, or if they are large, made smaller; and where it
 * leaves the images without an answer, stretched to three times their height, then to three times their width; and where that is
 * the answer, stretched and upsampled.
 *
 * Upsampled. With junctions of octave -1 photographs have three times the matches (match/upsampled.c, which asks the images' own
 * matches whether those hold), in several times the time. options->upsample_from own matches are asked, so that pairs without
 * anything in common are answered as before; where they leave a motion open, none is needed, and without cameras one. A pose is
 * estimated again, from more matches, in 1.8 times the time, and match/looks.c says which one is told. With half octaves
 * (options->upsampled_half_octaves) there are half as many matches again, in 1.3 to 2.3 times the time; in the images as they are
 * these would add 3 %. Partners are looked for where the images' own matches put them (match/expected.c), and anywhere where these
 * leave a geometry open: it would be confirmed, right or wrong. Without cameras the geometry of the images judges the new matches,
 * too.
 *
 * Smaller. What a camera delivers of more than LARGEST pixels is seldom sharp to the pixel, junctions are of edges some pixels wide
 * then, and patches, of so many pixels, see little beside them. So such images are also looked at halved, as often as it takes, and
 * upsampled from there; that is told when it is more: soft photographs have two and a half times the matches then. The looks that
 * follow are of the smaller images, too.
 *
 * Stretched. A square on a plane seen at an angle of a to it has sin a of its height: at 1, 3 one at 19 degrees is a
 * square again, and those at 10 and 40 degrees are off by less than two times (the tilts of ASIFT, Morel and Yu 2009, go by sqrt 2
 * up to 5.7, as descriptors want them; here the patches follow the junctions, and one is enough).
 *
 * Each of the two is tried first on TRIAL_PIXELS, half of them to either side at most, one octave and without a geometry: where the
 * stretch helps, a tenth or more of its matches are there (two magazines at extreme angles: 16 of 113, 16 of 197; on four times as
 * many pixels 41 and 55), in a thirtieth of the time, and where the images have nothing in common that is answered at once
 * (match/related.c).
 *
 * Colours. Where a geometry is asked, and neither look has one that is sure, agrees with the pictures and tells a motion, the
 * detector looks at colours, too (detect/planes_step.c), before anything is stretched: between surfaces that are equally bright
 * there are corners that only these show. match/looks.c says what is believed. What the luma has is known from the look without
 * them. Where the first look for a geometry shows that there is none (match/two_view.c) they are not looked at again.
 *
 * Images that have nothing in common match at a few places now and then, and so do things that repeat; the more looks the more
 * often. So a stretched look needs ENOUGH matches, and as many more than there are.
 *
 * What each look brings: tests/accuracy/tried/matching.md ("Images upsampled", "Large photographs") and geometry.md ("What each
 * look brings"). */
#include "look.h"
#include "core/colour_plane.h"
#include "core/number_text.h"
#include "geometry/geometry_options.h"
#include "match/both_poses.h"
#include "match/final_pose.h"
#include "match/match_result.h"
#include "match/upsampled.h"
#include "match/upsampled_geometry.h"
#include "match/match_options.h"

#include <math.h>
#include <string.h>

#define ENOUGH 16  /* matches. Stretched by 1, 3 or 3, 1, pairs of frames that do not match had up to 7 wrong ones, of which
                    * no geometry was left; planes at extreme angles 95 to 190 right ones */
#define SURELY_ENOUGH 32 /* .. where a geometry tells no pose. (LePoint3, with a focal length that is looked for: 18 matches as it
                    * is, 6 of them wrong, 720 right ones of 721 stretched) */
#define MANY 8     /* matches beside a geometry that is chance: worth another one */
#define HINT 4     /* matches of the trial: of 84 with unrelated photographs 83 have none and one has 3; the whole look decides */
#define TRIAL_PIXELS 60000.0 /* of the smaller image, stretched, in the trial */
#define FIRST 0.2  /* of all the progress, for the look as they are, */
#define CLOSER 0.4 /* .. and for the upsampled one */
#define COLOURED 0.2 /* .. and for the colours */
#define LARGEST 2e6 /* pixels */
#define SMALLER 0.3 /* of what smaller images have of it, before the upsampled look */
#define TRIAL 0.1  /* of what a stretch has of it */
#define WHOLE 0.3  /* .. before the upsampled look */

static const asj_stretch as_it_is = {1, 1};
static const asj_stretch glancing[] = {{1, 3}, {3, 1}};
enum { GLANCING = sizeof glancing / sizeof glancing[0] };

typedef struct search {
    asj_context *context;
    const asj_image *images[2];
    const asj_detect_options *detect_options;
    const asj_match_options *options;
    double scale; /* at most 1: so many times as long, large images have LARGEST pixels at most */
    asj_match_result *best;
    asj_luma_found luma[2][2]; /* of looks that are taken with colours once more, and upsampled; of both images */
    asj_alignments *alignments; /* of the same looks */
    double stage_ms[ASJ_STAGE_COUNT]; /* of all looks */
} search;

static int32_t asks_geometry(const search *s)
{
    return s->options->geometry.model != ASJ_GEOMETRY_NONE;
}

/* Matches that count: with a geometry asked those that one holds together. */
static uint32_t answered(const search *s, const asj_match_result *r)
{
    return asks_geometry(s) && r->geometry.status != ASJ_GEOMETRY_ACCEPTED ? 0 : r->match_count;
}

/* Are the images left without an answer? A geometry of few matches that tells no pose may be of what looks alike. */
static int32_t goes_on(const search *s)
{
    const int32_t tells_motion = s->best->geometry.has_pose || s->best->geometry.only_turns;
    const uint32_t enough = asks_geometry(s) && !tells_motion ? SURELY_ENOUGH : ENOUGH;
    return !asj_geometry_is_open(&s->best->geometry) && answered(s, s->best) < enough;
}

static int32_t asks_colours(const search *s)
{
    return asks_geometry(s) && s->options->look_at_colours && !s->detect_options->colours;
}

static int32_t may_look_at_colours(const search *s)
{
    return asks_colours(s) && (!s->best || (asj_looks_want_other(s->best) && !asj_match_result_is_hopeless(s->best)));
}

/* Is what is not stretched looked at with colours, or may it be? */
static int32_t may_come_again(const search *s, const asj_stretch *stretch, const asj_detect_options *detect_options)
{
    return (detect_options->colours || may_look_at_colours(s)) && stretch->x == s->scale && stretch->y == s->scale;
}

static void forget(search *s)
{
    for (int32_t n = 0; n < 4; n++)
        asj_luma_found_free(&s->context->memory, &s->luma[n / 2][n % 2]);
    asj_alignments_free(&s->context->memory, s->alignments);
}

/* own: the images' own matches, of the upsampled ones that are looked at; NULL: these are none. */
static asj_status look_by(search *s, const asj_match_result *own, const asj_stretch *stretch,
                          const asj_detect_options *detect_options, const asj_match_options *options, double from, double part,
                          asj_match_result **found)
{
    asj_look eyes;
    const int32_t again = may_come_again(s, stretch, detect_options);
    asj_luma_found *luma = again ? s->luma[detect_options->first_octave < 0] : NULL;
    asj_status status = asj_look_open(s->context, s->images, stretch, detect_options, luma, from, part, &eyes);
    eyes.alignments = again ? s->alignments : NULL;
    if (status == ASJ_OK)
        status = own ? asj_look_match_upsampled(&eyes, options, own, found) : asj_look_match(&eyes, options, found);
    if (status == ASJ_OK) {
        asj_look_add_times(&eyes, s->stage_ms);
        for (int32_t k = 0; k < ASJ_STAGE_COUNT; k++)
            s->stage_ms[k] += (*found)->stage_ms[k];
    }
    asj_look_close(&eyes);
    return status;
}

/* One look, from `from` on a part of the progress. */
static asj_status look(search *s, const asj_stretch *stretch, const asj_detect_options *detect_options,
                       const asj_match_options *options, double from, double part, asj_match_result **found)
{
    return look_by(s, NULL, stretch, detect_options, options, from, part, found);
}

/* --- upsampled ---------------------------------------------------------------------------------------------------------------- */

/* Whether to ask the upsampled images for a geometry: a motion, also where the images have a plane without one. Where cameras are
 * known and the images' is chance, that of the upsampled ones is not believed either (accepted then: of 398 pairs of rooms one, of
 * 397 unrelated ones nine), but beside MANY matches (of 800 pairs one is accepted, and is right, of 395 unrelated ones none).
 * Without cameras it is, when matches come again (of 198 pairs five, of 197 unrelated ones five). */
static int32_t asks_closer(const search *s)
{
    const asj_geometry *g = &s->best->geometry;
    if (g->status == ASJ_GEOMETRY_ACCEPTED)
        return g->has_pose || g->only_turns || asj_cameras_are_known(&s->options->geometry);
    return asks_geometry(s) && (asj_geometry_is_open(g) || s->best->match_count >= MANY ||
                                !asj_cameras_are_known(&s->options->geometry));
}

static double pixels_of(const asj_image *image)
{
    return (double)image->width * image->height;
}

/* Of the smaller image. */
static double least_pixels(const search *s)
{
    return fmin(pixels_of(s->images[0]), pixels_of(s->images[1]));
}

/* Who asks for one octave, or for another first one, has decided. */
static int32_t may_choose_scale(const search *s)
{
    return s->detect_options->first_octave == 0 && s->detect_options->octaves > 1 && s->options->upsample_from > 0;
}

static int32_t may_upsample(const search *s, const asj_stretch *stretch)
{
    const asj_stretch twice = {2 * stretch->x, 2 * stretch->y};
    const int32_t one_is_enough = asks_closer(s) && answered(s, s->best) == 0;
    const uint32_t enough = asj_looks_may_resolve(s->best) ? 0 : one_is_enough ? 1 : (uint32_t)s->options->upsample_from;
    int32_t may = may_choose_scale(s) && s->best->match_count >= enough;
    for (int32_t n = 0; n < 2 && may; n++)
        may = pixels_of(s->images[n]) * fmin(1, stretch->x * stretch->y) <= LARGEST && asj_look_fits(s->images[n], &twice);
    return may;
}

/* What was seen with a stretch, with the same one. */
static asj_status look_closer(search *s, const asj_stretch *stretch, double from, double part)
{
    asj_detect_options upsampled = *s->detect_options;
    asj_match_options options = *s->options;
    asj_match_result *found = NULL;
    if (!may_upsample(s, stretch))
        return ASJ_OK;
    upsampled.first_octave = -1;
    upsampled.half_octaves |= s->options->upsampled_half_octaves;
    if (!asks_closer(s))
        options.geometry.model = ASJ_GEOMETRY_NONE;
    const asj_status status = look_by(s, s->best, stretch, &upsampled, &options, from, part, &found);
    return status == ASJ_OK ? asj_upsampled_choose(s->context, &s->best, &found, 0) : status;
}

/* --- smaller ------------------------------------------------------------------------------------------------------------------ */

/* As long as the smaller one of them has more than LARGEST pixels it has some to spare. */
static double scale_of(const search *s)
{
    const double pixels = least_pixels(s);
    double scale = 1;
    while (may_choose_scale(s) && pixels * scale * scale > LARGEST)
        scale *= 0.5;
    return scale;
}

/* What large images show when they are smaller, and upsampled from there, takes the place of the best if it is more. */
static asj_status look_smaller(search *s, double from, double part)
{
    const asj_stretch smaller = {s->scale, s->scale};
    asj_match_result *own = s->best;
    s->best = NULL;
    asj_status status = look(s, &smaller, s->detect_options, s->options, from, SMALLER * part, &s->best);
    if (status == ASJ_OK)
        status = look_closer(s, &smaller, from + SMALLER * part, (1 - SMALLER) * part);
    if (status == ASJ_OK && answered(s, s->best) > answered(s, own)) {
        asj_match_result_free(&own);
        return ASJ_OK;
    }
    asj_match_result_free(&s->best);
    s->best = own;
    return status;
}

/* --- colours ------------------------------------------------------------------------------------------------------------------ */

static asj_status have_colours(const search *s, int32_t *both)
{
    asj_status status = ASJ_OK;
    *both = 1;
    for (int32_t n = 0; n < 2 && status == ASJ_OK && *both; n++)
        status = asj_image_has_colours(s->context, s->images[n], both);
    return status;
}

static asj_status look_with_colours(search *s, double from, double part)
{
    const asj_stretch stretch = {s->scale, s->scale};
    asj_detect_options with_colours = *s->detect_options;
    search other = *s;
    with_colours.colours = 1;
    other.detect_options = &with_colours;
    other.best = NULL;
    asj_status status = look(&other, &stretch, &with_colours, other.options, from, FIRST * part, &other.best);
    if (status == ASJ_OK)
        status = look_closer(&other, &stretch, from + FIRST * part, (1 - FIRST) * part);
    memcpy(s->stage_ms, other.stage_ms, sizeof s->stage_ms);
    const int32_t believed = status == ASJ_OK && asj_looks_take(s->best, other.best);
    const asj_geometry of_own = s->best->geometry;
    asj_match_result_free(believed ? &s->best : &other.best);
    if (believed) {
        if (asj_looks_agree(&of_own, &other.best->geometry))
            asj_both_poses(&of_own, &other.best->geometry);
        s->best = other.best;
        s->best->coloured = 1;
    }
    return status;
}

static asj_status look_at_colours(search *s, double from, double part)
{
    int32_t both = 0;
    const asj_status status = may_look_at_colours(s) ? have_colours(s, &both) : ASJ_OK;
    return both && status == ASJ_OK ? look_with_colours(s, from, part) : status;
}

/* --- stretched --------------------------------------------------------------------------------------------------------------- */

/* Of large images those that are smaller are stretched. */
static asj_stretch scaled(const search *s, const asj_stretch *stretch)
{
    return (asj_stretch){s->scale * stretch->x, s->scale * stretch->y};
}

/* The same stretch on fewer pixels. */
static asj_stretch trial_of(const search *s, const asj_stretch *stretch)
{
    const double part = fmin(0.5, sqrt(TRIAL_PIXELS / (least_pixels(s) * stretch->x * stretch->y)));
    return (asj_stretch){part * stretch->x, part * stretch->y};
}

static asj_status try_stretch(search *s, const asj_stretch *stretch, double from, double part, int32_t *hopeful)
{
    asj_detect_options one_octave = *s->detect_options;
    asj_match_options without = *s->options;
    asj_match_result *found = NULL;
    one_octave.octaves = 1;
    if (one_octave.first_octave < 0)
        one_octave.first_octave = 0;
    without.geometry.model = ASJ_GEOMETRY_NONE;
    const asj_status status = look(s, stretch, &one_octave, &without, from, part, &found);
    *hopeful = status == ASJ_OK && found->match_count >= HINT;
    asj_match_result_free(&found);
    return status;
}

/* What a stretch shows takes the place of the best if it is enough, and more. Images too large for it are not looked at so. */
static asj_status look_again(search *s, int32_t which, double from, double part)
{
    const double more = s->detect_options->first_octave < 0 ? 2 : 1; /* the detector upsamples them once more */
    const asj_stretch stretch = scaled(s, &glancing[which]), trial = trial_of(s, &stretch);
    const asj_stretch largest = {more * stretch.x, more * stretch.y};
    asj_match_result *found = NULL;
    int32_t hopeful = 0;
    if (!asj_look_fits(s->images[0], &largest) || !asj_look_fits(s->images[1], &largest))
        return ASJ_OK;
    asj_status status = try_stretch(s, &trial, from, TRIAL * part, &hopeful);
    if (status != ASJ_OK || !hopeful)
        return status;
    status = look(s, &stretch, s->detect_options, s->options, from + TRIAL * part, WHOLE * part, &found);
    if (status != ASJ_OK)
        return status;
    const uint32_t count = answered(s, found);
    const int32_t better = count >= ENOUGH && count >= 2 * answered(s, s->best);
    asj_match_result_free(better ? &s->best : &found);
    if (!better)
        return ASJ_OK;
    s->best = found;
    return look_closer(s, &stretch, from + (TRIAL + WHOLE) * part, (1 - TRIAL - WHOLE) * part);
}

/* Where a further look shows more than can be matched, what was seen before stays the answer. */
static asj_status look_for_answer(search *s)
{
    const double done = FIRST + CLOSER + COLOURED, part = (1 - done) / GLANCING;
    asj_status status = look(s, &as_it_is, s->detect_options, s->options, 0, FIRST, &s->best);
    if (!may_look_at_colours(s))
        forget(s); /* as soon as it is known: it is a tenth of all memory */
    if (status == ASJ_OK) {
        asj_optional_begin(s->context);
        status = asj_optional_end(s->context, s->scale < 1 ? look_smaller(s, FIRST, CLOSER)
                                                           : look_closer(s, &as_it_is, FIRST, CLOSER));
    }
    if (status == ASJ_OK) {
        asj_optional_begin(s->context);
        status = asj_optional_end(s->context, look_at_colours(s, FIRST + CLOSER, COLOURED));
    }
    for (int32_t k = 0; k < GLANCING && status == ASJ_OK && goes_on(s); k++) {
        asj_optional_begin(s->context);
        status = asj_optional_end(s->context, look_again(s, k, done + k * part, part));
    }
    return status == ASJ_OK ? asj_progress(s->context, ASJ_STAGE_ASSIGN, 1) : status;
}

static int32_t is_automatic(const asj_stretch *stretch)
{
    return stretch->x == 0 && stretch->y == 0;
}

static int32_t is_factor(double factor)
{
    return factor >= ASJ_MIN_STRETCH && factor <= ASJ_MAX_STRETCH;
}

static asj_status check(asj_context *context, const asj_stretch *stretch)
{
    if (!is_automatic(stretch) && !(is_factor(stretch->x) && is_factor(stretch->y)))
        return asj_fail(context, ASJ_ERROR_OPTION, "a stretch of %s, %s is outside %s .. %d", ASJ_TEXT(stretch->x),
                        ASJ_TEXT(stretch->y), ASJ_TEXT(ASJ_MIN_STRETCH), ASJ_MAX_STRETCH);
    return ASJ_OK;
}

asj_status asj_match_images(asj_context *context, const asj_image *image1, const asj_image *image2, const asj_stretch *wanted,
                            const asj_detect_options *detect_options, const asj_match_options *options, asj_match_result **result)
{
    asj_detect_options for_matching;
    asj_match_options defaults;
    if (result)
        *result = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!image1 || !image2 || !result)
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "an image or the result is NULL");
    context->progress = 0; /* the images are stretched before the first call that is a part of this one begins */
    asj_detect_options_preset(&for_matching, ASJ_PRESET_MATCH);
    asj_match_options_init(&defaults);
    wanted = wanted ? wanted : &as_it_is;
    asj_alignments alignments = {NULL, NULL, 0, 0, 0};
    search s = {.context = context, .images = {image1, image2}, .alignments = &alignments};
    s.detect_options = detect_options ? detect_options : &for_matching;
    s.options = options ? options : &defaults;
    s.scale = scale_of(&s);
    const double start = asj_clock_ms();
    asj_status status = check(context, wanted);
    if (status == ASJ_OK)
        status = asj_match_request_check(context, s.options);
    if (status == ASJ_OK)
        status = is_automatic(wanted) ? look_for_answer(&s) : look(&s, wanted, s.detect_options, s.options, 0, 1, &s.best);
    forget(&s);
    if (status == ASJ_OK)
        status = asj_finish_pose(context, &s.best);
    if (status != ASJ_OK) {
        asj_match_result_free(&s.best);
        return status;
    }
    for (int32_t k = 0; k < ASJ_STAGE_COUNT; k++)
        s.best->stage_ms[k] = s.stage_ms[k];
    s.best->total_ms = asj_clock_ms() - start;
    *result = s.best;
    return ASJ_OK;
}
