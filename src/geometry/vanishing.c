/* SPDX-License-Identifier: BSD-2-Clause */
/* Vanishing points. Three directions at right angles are looked for together (vanishing_frame.c), with the focal length where none
 * is given. Where there are none, points by themselves (vanishing_vote.c). Coordinates: K^-1 of pixels where the camera is known,
 * else pixels from the middle over half the longer side. */
#include "vanishing.h"
#include "geometry_options.h"
#include "vanishing_frame.h"

#include "core/angle.h"
#include "core/decade.h"
#include "core/most_junctions.h"
#include "core/number_text.h"
#include "core/reserved.h"
#include "small_matrix.h"

#include <math.h>
#include <string.h>

#define MORE 1.5
#define SAME (8 * ASJ_DEGREE) /* directions nearer than that are one, which lens or vote has split */

void asj_vanishing_options_init(asj_vanishing_options *options)
{
    if (!options)
        return;
    memset(options, 0, sizeof *options);
    options->epsilon = 0.01;
}

static void fill(const asj_vote *at, const double direction[3], const asj_camera *vote_camera, asj_vanishing_point *out)
{
    out->point[0] = vote_camera->fx * at->v[0] + vote_camera->cx * at->v[2];
    out->point[1] = vote_camera->fy * at->v[1] + vote_camera->cy * at->v[2];
    out->point[2] = at->v[2];
    asj_normalise3(out->point);
    if (direction)
        memcpy(out->direction, direction, sizeof out->direction);
    out->log10_nfa = at->log_nfa / ASJ_LN_10;
    out->branch_count = (uint32_t)at->votes;
}

static void tell_frame(const asj_vanishing_frame *f, const asj_camera *camera, asj_vanishing_points *result)
{
    result->count = f->count;
    for (int32_t a = 0; a < f->count; a++)
        fill(&f->points[a], f->directions[a], camera, &result->points[a]);
}

/* With a focal length the surest alone, without one the surest three. */
static void tell_points(asj_vote *points, int32_t found, int32_t given, const asj_camera *camera, asj_vanishing_points *result)
{
    result->count = asj_vote_distinct(points, found, ASJ_USUAL_FOCAL, SAME, given ? 1 : ASJ_MOST_VANISHING);
    for (int32_t k = 0; k < result->count; k++) {
        double d[3];
        asj_direction_of(points[k].v, 1, d);
        fill(&points[k], given ? d : NULL, camera, &result->points[k]);
    }
}

/* Do three points by themselves, each without the lines of those before, explain MORE times as much as directions at right angles?
 * They are free to lie anywhere, which their NFA counts, but each is where it has most lines. (Presets default and match of 116
 * rendered views and 14 video frames: beside right frames points have up to 1.41 times the log NFA, beside three wrong ones 2.0,
 * 2.1 and 4.4.) */
static int32_t explain_more(const asj_vote *points, int32_t found, const asj_vanishing_frame *f)
{
    double sum = 0;
    for (int32_t k = 0; k < found && k < ASJ_MOST_VANISHING; k++)
        sum += points[k].log_nfa;
    return sum < MORE * f->log_nfa;
}

static asj_status answer(asj_context *context, asj_vote_search *s, const asj_vanishing_options *options, const asj_camera *camera,
                         asj_vanishing_points *result)
{
    const int32_t given = options->camera.fx > 0;
    const double most = log(options->epsilon);
    asj_vote points[ASJ_VOTE_POINTS];
    asj_vanishing_frame f;
    const asj_status status = asj_find_frame(context, s, given ? 1 : 0, most, &f);
    if (status != ASJ_OK)
        return status;
    const int32_t found = asj_vote_points(s, most, points);
    if (explain_more(points, found, &f))
        f.count = 0;
    result->focal_source = given ? ASJ_FOCAL_GIVEN : f.count > 0 ? ASJ_FOCAL_FOUND : ASJ_FOCAL_UNKNOWN;
    if (given)
        result->camera = options->camera;
    else if (f.count > 0)
        result->camera = (asj_camera){f.focal * camera->fx, f.focal * camera->fy, camera->cx, camera->cy};
    if (f.count > 0)
        tell_frame(&f, camera, result);
    else
        tell_points(points, found, given, camera, result);
    return ASJ_OK;
}

static asj_status check(asj_context *context, const asj_junction *junctions, size_t count, const asj_vanishing_options *o)
{
    const asj_camera *c = &o->camera;
    char fault[128];
    if (!asj_is_zero(o->reserved, sizeof o->reserved))
        return asj_fail(context, ASJ_ERROR_OPTION, ASJ_RESERVED_MESSAGE);
    if (o->width < 1 || o->height < 1)
        return asj_fail(context, ASJ_ERROR_OPTION, "the image has no size");
    if (!(o->epsilon >= 1e-12 && o->epsilon <= 1))
        return asj_fail(context, ASJ_ERROR_OPTION, "epsilon %s is not 1e-12 .. 1", ASJ_TEXT(o->epsilon));
    if (!asj_camera_can_be(c))
        return asj_fail(context, ASJ_ERROR_OPTION, "the camera cannot be: fx %s, fy %s, cx %s, cy %s", ASJ_TEXT(c->fx),
                        ASJ_TEXT(c->fy), ASJ_TEXT(c->cx), ASJ_TEXT(c->cy));
    if (count > ASJ_MOST_JUNCTIONS)
        return asj_fail(context, ASJ_ERROR_LIMIT, "%zu junctions are too many", count);
    for (size_t k = 0; k < count; k++)
        if (asj_junction_check(&junctions[k], fault, sizeof fault) != ASJ_OK)
            return asj_fail(context, ASJ_ERROR_ARGUMENT, "junction %zu has %s", k, fault);
    return ASJ_OK;
}

asj_status asj_vanishing_points_of(asj_context *context, const asj_junction *junctions, size_t count,
                                   const asj_vanishing_options *options, int32_t stage, asj_vanishing_points *result)
{
    const double half = 0.5 * (options->width > options->height ? options->width : options->height);
    const asj_camera guess = {half, half, 0.5 * (options->width - 1), 0.5 * (options->height - 1)};
    const asj_camera *camera = options->camera.fx > 0 ? &options->camera : &guess;
    asj_memory *memory = &context->memory;
    asj_status status = ASJ_OK;
    asj_vanishing_points found;
    asj_watch watch;
    asj_vote_search s = {.watch = &watch};
    memset(&found, 0, sizeof found);
    asj_watch_start(&watch, context, stage);
    s.lines = asj_allocate(memory, count, ASJ_MAX_BRANCHES * sizeof *s.lines);
    s.tail = asj_allocate(memory, ASJ_VOTE_LEVELS * (ASJ_VOTE_LINES + 1), sizeof *s.tail);
    if (s.lines && s.tail) {
        s.count = asj_vanishing_lines(junctions, count, camera, &watch, s.lines);
        status = answer(context, &s, options, camera, &found);
        if (status == ASJ_OK)
            status = asj_watch_end(&watch);
        if (status == ASJ_OK)
            *result = found;
    } else {
        status = asj_fail(context, ASJ_ERROR_MEMORY, "no memory for the branches of %zu junctions", count);
    }
    asj_release(memory, s.lines);
    asj_release(memory, s.tail);
    return status;
}

asj_status asj_find_vanishing_points(asj_context *context, const asj_junction *junctions, size_t count,
                                     const asj_vanishing_options *options, asj_vanishing_points *result)
{
    if (asj_enter(context) != ASJ_OK)
        return ASJ_ERROR_ARGUMENT;
    if (!options || !result || (!junctions && count > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "the junctions, the options or the result is NULL");
    context->progress = 0; /* a call of its own */
    const asj_status status = check(context, junctions, count, options);
    return status == ASJ_OK ? asj_vanishing_points_of(context, junctions, count, options, ASJ_STAGE_DECOMPOSE, result) : status;
}
