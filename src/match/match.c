/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_match(), and asj_match_features(), which is what it does after the features of both images: step 7 of the paper.
 *
 * Of each image (image_features.c):
 *   l_junctions_create.c   junctions -> ordered L-junctions      (locations.c, frames.c, t_junctions.c)
 *   describe.c       patches in those frames                     (patch.c, sift.c; paper: patch_induced.c)
 *   colour.c         colours around them                         for the geometry only, as is
 *   colour_patch.c   the image at half its size                  patches of whose colours the pair's geometry makes
 *
 * Of the pair, the list below:
 *   expected.c       of upsampled images: where their own matches put the partners
 *   related.c        unless the images have nothing in common; with a geometry where two_view.c, too, says so at first
 *   shortlist.c      best partners among all pairs               (rank.c; product_bound.c rules most pairs out)
 *   align.c          each candidate's map refined on the images  (disc.c; paper: not done)
 *   support.c        neighbouring candidates that agree          (agreement.c; support_gate.c; paper: not done)
 *   consensus.c      scores by support and appearance
 *   assign.c         ratio test, mutual check: matches
 *   guided.c         matches propose matches near them; once more from align.c on
 *   verify.c         each match is judged by the matches around it
 *   epipolar.c       and by the fundamental matrix of all            (../geometry/)
 *   guests.c         matches of junctions of other octaves, which those propose; once more from align.c to epipolar.c
 *   same_corner.c    one match for each corner that several octaves list
 *   two_view.c       the geometry of the pair, when asked for: candidates once more, a longer list (wide_shortlist.c, prior.c,
 *                    colour_prior.c, ../geometry/)
 *   verdict.c        where one is accepted: which matches go, and which come; then guests.c and same_corner.c once more
 *   match_result.c   what the caller sees; segments.c: which ends of the branches correspond; common_direction.c:
 *                    where they point
 *
 * All of this once, and where there are junctions of octave -1 once more with them in the upsampled images: upsampled.c decides,
 * and same_place.c leaves one match for each place.
 *
 * Up to the consensus every aligned candidate is there, several for a location; a step that needs all of them stands before
 * assign.c. */
#include "align.h"
#include "assign.h"
#include "consensus.h"
#include "core/backend.h"
#include "core/most_junctions.h"
#include "epipolar.h"
#include "expected.h"
#include "final_pose.h"
#include "upsampled.h"
#include "guests.h"
#include "guided.h"
#include "kept_features.h"
#include "match_options.h"
#include "result_changes.h"
#include "related.h"
#include "same_corner.h"
#include "shortlist.h"
#include "support.h"
#include "two_view.h"
#include "unstretch.h"
#include "verdict.h"
#include "verify.h"

#include <math.h>
#include <string.h>

#define ENOUGH_KNOWN 8 /* matches */
#define DOUBTFUL 3.5   /* times related_support: of 52 unrelated pairs of photographs 39 have less support than that option asks,
                        * and 51 less than so many times that */

/* Times of the stages. */
typedef struct stop_watch {
    double stage_ms[16];
    double clock;
} stop_watch;

static void stop(stop_watch *watch, int32_t stage)
{
    const double now = asj_clock_ms();
    watch->stage_ms[stage] += now - watch->clock;
    watch->clock = now;
}

typedef struct step {
    int32_t stage;
    double done; /* progress when it starts */
    asj_status (*run)(asj_match_run *run);
} step;

static asj_status align(asj_match_run *run)
{
    return run->options->align_iterations > 0 ? asj_align_candidates(run, &run->candidates) : ASJ_OK;
}

static asj_status verify(asj_match_run *run)
{
    return asj_verify(run, 0);
}

static asj_status one_a_corner(asj_match_run *run)
{
    return asj_same_corner(run, 0);
}

static asj_status run_step(asj_match_run *run, const step *s, stop_watch *watch)
{
    asj_status status = asj_progress(run->context, s->stage, s->done);
    if (status == ASJ_OK)
        status = s->run(run);
    stop(watch, s->stage);
    return status;
}

static asj_status run_list(asj_match_run *run, const step *list, size_t count, stop_watch *watch)
{
    asj_status status = ASJ_OK;
    for (size_t n = 0; n < count && status == ASJ_OK; n++)
        status = run_step(run, &list[n], watch);
    return status;
}

/* Without a geometry: what looks, and what is around, say. */
static asj_status match_plainly(asj_match_run *run, stop_watch *watch)
{
    static const step first[] = {
        {ASJ_STAGE_DISTANCES, 0.20, asj_shortlist},
        {ASJ_STAGE_ALIGN, 0.60, align},
        {ASJ_STAGE_ASSIGN, 0.80, asj_support_find},
        {ASJ_STAGE_ASSIGN, 0.82, asj_consensus},
        {ASJ_STAGE_ASSIGN, 0.84, asj_assign},
    };
    static const step guided = {ASJ_STAGE_ALIGN, 0.85, asj_guided};
    static const step again[] = {
        {ASJ_STAGE_ASSIGN, 0.90, asj_support_find},
        {ASJ_STAGE_ASSIGN, 0.92, asj_consensus},
        {ASJ_STAGE_ASSIGN, 0.94, asj_assign},
    };
    static const step last[] = {
        {ASJ_STAGE_ASSIGN, 0.95, verify},
        {ASJ_STAGE_ASSIGN, 0.955, asj_verify_epipolar},
        {ASJ_STAGE_ALIGN, 0.96, asj_match_guests},
        {ASJ_STAGE_ASSIGN, 0.965, one_a_corner},
    };
    asj_status status = run_list(run, first, sizeof first / sizeof *first, watch);
    for (int32_t round = 0; round < run->options->guided_rounds && run->options->neighbours > 0 && status == ASJ_OK; round++) {
        const size_t before = run->candidates.count;
        status = run_step(run, &guided, watch);
        if (run->candidates.count == before)
            break;
        if (status == ASJ_OK)
            status = run_list(run, again, sizeof again / sizeof *again, watch);
    }
    asj_support_free(&run->context->memory, &run->support); /* up to 256 MB, and guests have their own */
    if (status == ASJ_OK)
        status = run_list(run, last, sizeof last / sizeof *last, watch);
    return status;
}

static asj_status look_whether_related(const asj_match_run *run, stop_watch *watch, double *support)
{
    const asj_status status = asj_related(run, support);
    stop(watch, ASJ_STAGE_DISTANCES);
    return status;
}

/* The geometry; where none is accepted the matches stay those that there are without, of related images. */
static asj_status match_by_geometry(asj_match_run *run, int32_t related, stop_watch *watch)
{
    static const step geometry = {ASJ_STAGE_ASSIGN, 0.97, asj_apply_geometry};
    static const step guests = {ASJ_STAGE_ALIGN, 0.98, asj_match_guests};
    const size_t before = run->choices.count;
    asj_status status = run_step(run, &geometry, watch);
    if (status == ASJ_OK && run->geometry.status != ASJ_GEOMETRY_ACCEPTED) {
        run->choices.count = related ? before : 0;
        return status;
    }
    const size_t after = run->choices.count;
    if (status != ASJ_OK || after + run->rejected.count == before)
        return status;
    status = run_step(run, &guests, watch); /* which the newcomers propose */
    if (status == ASJ_OK) {
        asj_judge_guests(run, after);
        status = asj_same_corner(run, after);
    }
    return status;
}

/* Upsampled images are looked at where the images have matches or leave a motion open: all is asked of them. */
static asj_status look_whether_hopeless(asj_match_run *run, stop_watch *watch)
{
    int32_t may_be = 1;
    if (run->image[0]->l_junctions.upsampled || run->image[1]->l_junctions.upsampled)
        return ASJ_OK;
    const asj_status status = asj_geometry_may_be(run, &may_be);
    stop(watch, ASJ_STAGE_ASSIGN);
    run->hopeless = !may_be;
    return status;
}

/* With a geometry. Those that seem to have nothing in common are matched when it is known that they may have one. */
static asj_status match_with_geometry(asj_match_run *run, double support, stop_watch *watch)
{
    const int32_t related = support >= run->options->related_support;
    asj_status status = related ? match_plainly(run, watch) : ASJ_OK;
    if (status == ASJ_OK && support < DOUBTFUL * run->options->related_support)
        status = look_whether_hopeless(run, watch);
    if (status == ASJ_OK && !related && !run->hopeless)
        status = match_plainly(run, watch);
    return status == ASJ_OK && !run->hopeless ? match_by_geometry(run, related, watch) : status;
}

static asj_status run_steps(asj_match_run *run, stop_watch *watch)
{
    double support = HUGE_VAL;
    asj_status status = asj_progress(run->context, ASJ_STAGE_DISTANCES, 0.15);
    if (status == ASJ_OK)
        status = look_whether_related(run, watch, &support);
    if (status != ASJ_OK)
        return status;
    if (run->options->geometry.model != ASJ_GEOMETRY_NONE)
        return match_with_geometry(run, support, watch);
    return support >= run->options->related_support ? match_plainly(run, watch) : ASJ_OK;
}

static asj_status finish(const asj_match_run *run, stop_watch *watch, asj_match_result **result)
{
    asj_match_result *found = NULL;
    const asj_status status = asj_match_result_create(run, &found);
    if (status != ASJ_OK)
        return status;
    stop(watch, ASJ_STAGE_ASSIGN);
    memcpy(found->stage_ms, watch->stage_ms, sizeof watch->stage_ms);
    found->backend = asj_context_backend(run->context);
    found->candidates = run->candidates.count;
    *result = found;
    return ASJ_OK;
}

/* In pixels of the images, where features are of upsampled ones. */
static asj_stretch stretch_of(const asj_image_features *features)
{
    return features->l_junctions.upsampled ? (asj_stretch){2, 2} : (asj_stretch){1, 1};
}

static asj_match_options options_for(const asj_match_options *options, const asj_stretch by[2], int32_t expected)
{
    asj_match_options upsampled = *options;
    for (int32_t n = 0; n < 2; n++)
        if (options->geometry.cameras[n].fx > 0)
            upsampled.geometry.cameras[n] = asj_stretch_camera(&options->geometry.cameras[n], &by[n]);
    if (expected && options->upsampled_shortlist > 0)
        upsampled.shortlist = options->upsampled_shortlist;
    return upsampled;
}

/* Do matches that are known say where those of the upsampled images lie? Fewer may all be wrong; and where a geometry was asked
 * that the images leave open, the upsampled ones resolve it (looks.c) and are not told. */
static int32_t says_where(const asj_match_options *options, const asj_known_matches *known)
{
    return known && options->upsampled_search_radius > 0 && known->result->match_count >= ENOUGH_KNOWN &&
           (known->result->geometry.status == ASJ_GEOMETRY_NOT_ASKED || known->result->geometry.status == ASJ_GEOMETRY_ACCEPTED);
}

static asj_status expect(asj_match_run *run, const asj_known_matches *known, const asj_stretch upsampled[2], asj_expected *expected)
{
    asj_stretch by[2];
    for (int32_t n = 0; n < 2; n++)
        by[n] = (asj_stretch){known->by[n].x * upsampled[n].x, known->by[n].y * upsampled[n].y};
    run->expected = expected;
    return asj_expect(run, known->result, by, expected);
}

/* From the features of two images to the result. */
static asj_status match_features(asj_context *context, const asj_match_options *options, const asj_image_features *features[2],
                                 const asj_known_matches *known, asj_alignments *alignments, stop_watch *watch,
                                 asj_match_result **result)
{
    const asj_stretch by[2] = {stretch_of(features[0]), stretch_of(features[1])};
    const int32_t upsampled = by[0].x > 1 || by[1].x > 1, expected = upsampled && says_where(options, known);
    const asj_match_options of_upsampled = options_for(options, by, expected);
    asj_expected places = {{NULL, NULL}, {NULL, NULL}};
    /* In upsampled images a geometry's list has half the steps of the others (align.c): hardly anything comes again. */
    asj_alignments own = {NULL, NULL, 0, 0, 0};
    if (!alignments && !upsampled && options->geometry.model != ASJ_GEOMETRY_NONE)
        alignments = &own;
    asj_match_run run = {.context = context, .options = upsampled ? &of_upsampled : options, .image = {features[0], features[1]},
                         .alignments = alignments};
    asj_status status = expected ? expect(&run, known, by, &places) : ASJ_OK;
    if (status == ASJ_OK)
        status = run_steps(&run, watch);
    if (status == ASJ_OK)
        status = finish(&run, watch, result);
    if (status == ASJ_OK && upsampled)
        asj_match_result_unstretch(*result, by);
    if (status == ASJ_OK)
        (*result)->upsampled = upsampled ? 1 : 0;
    asj_expected_free(&context->memory, &places);
    asj_release_much(&context->memory, run.candidates.list);
    asj_release(&context->memory, run.choices.list);
    asj_release(&context->memory, run.rejected.list);
    asj_support_free(&context->memory, &run.support);
    asj_alignments_free(&context->memory, &own);
    if (status == ASJ_OK && asj_progress(context, ASJ_STAGE_ASSIGN, 1) != ASJ_OK) {
        asj_match_result_free(result);
        status = ASJ_ERROR_CANCELLED;
    }
    return status;
}

typedef struct source_pair {
    const asj_match_source *images;
    asj_alignments *alignments; /* or NULL */
} source_pair;

/* Of one image; `upsampled`: of the image upsampled by two, if it has junctions of octave -1. */
static asj_status make_features(asj_context *context, const asj_match_options *options, const asj_match_source *s, int32_t n,
                                int32_t upsampled, asj_image_features *features)
{
    const int32_t has_upsampled = upsampled && asj_has_upsampled(s->junctions, s->count);
    asj_status status = asj_image_features_create(context, options, s->image, s->junctions, s->count, n + 1, has_upsampled,
                                                  features);
    if (status == ASJ_OK && options->geometry.model != ASJ_GEOMETRY_NONE)
        status = asj_image_features_add_colours(context, s->image, features);
    return status;
}

static asj_status match_sources(asj_context *context, const asj_match_options *options, const void *data, int32_t upsampled,
                                const asj_known_matches *known, asj_match_result **result)
{
    const source_pair *sources = data;
    asj_image_features features[2];
    const asj_image_features *both[2] = {&features[0], &features[1]};
    stop_watch watch = {.clock = asj_clock_ms()};
    memset(features, 0, sizeof features);
    asj_status status = asj_progress(context, ASJ_STAGE_PATCHES, 0);
    for (int32_t n = 0; n < 2 && status == ASJ_OK; n++)
        status = make_features(context, options, &sources->images[n], n, upsampled, &features[n]);
    stop(&watch, ASJ_STAGE_PATCHES);
    if (status == ASJ_OK)
        status = match_features(context, options, both, known, sources->alignments, &watch, result);
    for (int32_t n = 0; n < 2; n++)
        asj_image_features_free(&context->memory, &features[n]);
    return status;
}

asj_status asj_match_look(asj_context *context, const asj_match_source sources[2], const asj_match_options *options,
                          int32_t upsampled, const asj_known_matches *known, asj_alignments *alignments,
                          asj_match_result **result)
{
    const source_pair pair = {sources, alignments};
    if (result)
        *result = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    for (int32_t n = 0; n < 2; n++)
        if (!sources[n].image || (!sources[n].junctions && sources[n].count > 0) || !result)
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "an image, the junctions or the result is NULL");
    for (int32_t n = 0; n < 2; n++)
        if (sources[n].count > ASJ_MOST_JUNCTIONS)
            return asj_fail(context, ASJ_ERROR_LIMIT, "%zu junctions of image %d are too many", sources[n].count, (int)n + 1);
    const asj_upsampled_match match = {match_sources,
                                   &pair,
                                   {sources[0].junctions, sources[1].junctions},
                                   {sources[0].count, sources[1].count},
                                   upsampled,
                                   known};
    asj_status status;
    asj_backend_begin(context);
    do
        status = asj_match_upsampled(context, options, &match, result);
    while (asj_backend_retry(context, status));
    return status;
}

/* What comes at the end of a call of the caller's. */
static asj_status finish_call(asj_context *context, double start, asj_match_result **result)
{
    const asj_status status = asj_finish_pose(context, result);
    if (status == ASJ_OK)
        (*result)->total_ms = asj_clock_ms() - start;
    return status;
}

asj_status asj_match(asj_context *context, const asj_image *image1, const asj_junction *junctions1, size_t count1,
                     const asj_image *image2, const asj_junction *junctions2, size_t count2,
                     const asj_match_options *options, asj_match_result **result)
{
    const asj_match_source sources[2] = {{image1, junctions1, count1}, {image2, junctions2, count2}};
    asj_match_options defaults;
    if (result)
        *result = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!options) {
        asj_match_options_init(&defaults);
        options = &defaults;
    }
    const double start = asj_clock_ms();
    asj_status status = asj_match_request_check(context, options);
    if (status == ASJ_OK)
        status = asj_match_look(context, sources, options, 0, NULL, NULL, result);
    return status == ASJ_OK ? finish_call(context, start, result) : status;
}

static asj_status match_kept(asj_context *context, const asj_match_options *options, const void *data, int32_t upsampled,
                             const asj_known_matches *known, asj_match_result **result)
{
    const asj_features *const *kept = data;
    const asj_image_features views[2] = {asj_features_view(context, kept[0], upsampled),
                                         asj_features_view(context, kept[1], upsampled)};
    const asj_image_features *both[2] = {&views[0], &views[1]};
    stop_watch watch = {.clock = asj_clock_ms()};
    return match_features(context, options, both, known, NULL, &watch, result);
}

/* Features tell what they were made with; the pair's steps read the same options. */
static asj_status check_options(asj_context *context, const asj_match_options *options, const asj_features *kept[2])
{
    const asj_status status = asj_match_request_check(context, options);
    if (status != ASJ_OK)
        return status;
    for (int32_t n = 0; n < 2; n++) {
        const char *key = asj_match_options_difference(options, &kept[n]->options);
        char wanted[64] = "", made[64] = "";
        if (!key)
            continue;
        asj_match_options_get(options, key, wanted, sizeof wanted);
        asj_match_options_get(&kept[n]->options, key, made, sizeof made);
        return asj_fail(context, ASJ_ERROR_OPTION, "the features of image %d were made with %s %s, not %s", (int)n + 1, key, made,
                        wanted);
    }
    return ASJ_OK;
}

asj_status asj_match_features(asj_context *context, const asj_features *features1, const asj_features *features2,
                              const asj_match_options *options, asj_match_result **result)
{
    const asj_features *kept[2] = {features1, features2};
    if (result)
        *result = NULL;
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!features1 || !features2 || !result)
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "features or the result are NULL");
    if (!options)
        options = &features1->options;
    const double start = asj_clock_ms();
    asj_status status = check_options(context, options, kept);
    if (status != ASJ_OK)
        return status;
    const asj_upsampled_match match = {match_kept,
                                   kept,
                                   {features1->junctions, features2->junctions},
                                   {features1->junction_count, features2->junction_count},
                                   0,
                                   NULL};
    asj_backend_begin(context);
    do
        status = asj_match_upsampled(context, options, &match, result);
    while (asj_backend_retry(context, status));
    return status == ASJ_OK ? finish_call(context, start, result) : status;
}
