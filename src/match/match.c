/* SPDX-License-Identifier: BSD-2-Clause */
/* asj_match(): step 7 of the paper.
 *
 *   corners.c    junctions -> ordered L-junctions with frames
 *   patch.c      patches in those frames                       (paper: induced.c)
 *   distance.c   all pairs, short lists
 *   rank.c       .. of raw patches: those that a bound (sketch.c) does not rule out
 *   align.c      each candidate's map refined on the images    (paper: not done)
 *   consensus.c  support from neighbouring candidates          (paper: not done)
 *   support.c    .. which of them agree
 *   agreement.c  .. what that means
 *   assign.c     ratio test, mutual check
 *   guided.c     matches propose matches near them; once more from align.c on
 *   verify.c     each match asks the matches around it
 *   segments.c   which ends of the branches correspond */
#include "align.h"
#include "core/backend.h"
#include "guided.h"
#include "match_options.h"
#include "match_result.h"
#include "verify.h"

#include <string.h>

/* One call of asj_match(). */
typedef struct match_run {
    asj_context *context;
    const asj_match_options *options;
    asj_view view[2];
    asj_candidates candidates;
    asj_support support;
    asj_choice *choices;
    size_t choice_count;
    double stage_ms[16];
    double clock;
} match_run;

static void stop_watch(match_run *m, int32_t stage)
{
    double now = asj_clock_ms();
    m->stage_ms[stage] += now - m->clock;
    m->clock = now;
}

static asj_status prepare(match_run *m, const asj_image *const images[2], const asj_junction *const junctions[2],
                          const size_t counts[2])
{
    asj_status status = asj_progress(m->context, ASJ_STAGE_PATCHES, 0);
    for (int32_t v = 0; v < 2 && status == ASJ_OK; v++) {
        asj_view *view = &m->view[v];
        status = asj_image_check(m->context, images[v]);
        if (status == ASJ_OK)
            status = asj_corners_create(m->context, junctions[v], counts[v], images[v]->width, images[v]->height, m->options, v + 1,
                                        &view->corners);
        if (status == ASJ_OK)
            status = asj_pyramid_create(m->context, images[v], m->options->smoothing, &view->pyramid);
        if (status == ASJ_OK)
            status = m->options->patches == ASJ_PATCHES_CANONICAL ? asj_describe(m->context, m->options, view)
                                                                  : asj_induced_describe(m->context, m->options, view);
    }
    stop_watch(m, ASJ_STAGE_PATCHES);
    return status;
}

/* The short list with distances and maps; pairs without a map are dropped. */
static asj_status find_candidates(match_run *m)
{
    asj_status status = asj_progress(m->context, ASJ_STAGE_DISTANCES, 0.2);
    if (status == ASJ_OK)
        status = asj_shortlist(m->context, m->options, &m->view[0], &m->view[1], &m->candidates);
    if (status != ASJ_OK)
        return status;
    asj_candidate *list = m->candidates.list;
    const int64_t count = (int64_t)m->candidates.count;
    size_t kept = 0;
#pragma omp parallel for num_threads(m->context->threads) schedule(static)
    for (int64_t k = 0; k < count; k++)
        if (!asj_compare(m->options, &m->view[0], &m->view[1], &list[k]))
            list[k].distance2 = -1;
    for (int64_t k = 0; k < count; k++)
        if (list[k].distance2 >= 0)
            list[kept++] = list[k];
    m->candidates.count = kept;
    stop_watch(m, ASJ_STAGE_DISTANCES);
    return ASJ_OK;
}

static asj_status choose(match_run *m)
{
    asj_status status = asj_consensus(m->context, m->options, &m->view[0], &m->view[1], &m->candidates, &m->support);
    if (status == ASJ_OK)
        status = asj_assign(m->context, m->options, &m->view[0], &m->view[1], &m->candidates, m->choices, &m->choice_count);
    stop_watch(m, ASJ_STAGE_ASSIGN);
    return status;
}

static asj_status refine(match_run *m)
{
    asj_status status = asj_progress(m->context, ASJ_STAGE_ALIGN, 0.6);
    if (status == ASJ_OK && m->options->align_iterations > 0)
        status = asj_align_candidates(m->context, m->options, &m->view[0], &m->view[1], &m->candidates, 0);
    stop_watch(m, ASJ_STAGE_ALIGN);
    m->choices = asj_allocate(&m->context->memory, m->view[0].corners.place_count, sizeof *m->choices);
    if (status == ASJ_OK && !m->choices)
        status = asj_fail(m->context, ASJ_ERROR_MEMORY, "no memory for matches");
    if (status == ASJ_OK)
        status = asj_progress(m->context, ASJ_STAGE_ASSIGN, 0.8);
    if (status == ASJ_OK)
        status = choose(m);
    for (int32_t round = 0; round < m->options->guided_rounds && m->options->neighbours > 0 && status == ASJ_OK; round++) {
        size_t added = 0;
        status = asj_progress(m->context, ASJ_STAGE_ALIGN, 0.85);
        if (status == ASJ_OK)
            status = asj_guided(m->context, m->options, &m->view[0], &m->view[1], &m->candidates, m->choices, m->choice_count,
                                &added);
        stop_watch(m, ASJ_STAGE_ALIGN);
        if (added == 0)
            break;
        if (status == ASJ_OK)
            status = choose(m);
    }
    if (status == ASJ_OK)
        status = asj_verify(m->context, m->options, &m->view[0], &m->view[1], &m->candidates, m->choices, &m->choice_count);
    stop_watch(m, ASJ_STAGE_ASSIGN);
    return status;
}

static asj_status finish(match_run *m, asj_match_result **result)
{
    asj_match_result *found = asj_match_result_create(m->context, m->options, &m->view[0], &m->view[1], &m->candidates, m->choices,
                                                      m->choice_count);
    if (!found)
        return asj_fail(m->context, ASJ_ERROR_MEMORY, "no memory for %zu matches", m->choice_count);
    stop_watch(m, ASJ_STAGE_ASSIGN);
    memcpy(found->stage_ms, m->stage_ms, sizeof m->stage_ms);
    for (int32_t s = 0; s < ASJ_STAGE_COUNT; s++)
        found->total_ms += m->stage_ms[s];
    found->backend = asj_context_backend(m->context);
    found->candidates = m->candidates.count;
    *result = found;
    return ASJ_OK;
}

static void clean(match_run *m)
{
    asj_memory *memory = &m->context->memory;
    for (int32_t v = 0; v < 2; v++) {
        asj_corners_free(memory, &m->view[v].corners);
        asj_pyramid_free(memory, &m->view[v].pyramid);
        asj_release(memory, m->view[v].patches);
        asj_release(memory, m->view[v].usable);
    }
    asj_release(memory, m->candidates.list);
    asj_release(memory, m->choices);
    asj_support_free(memory, &m->support);
}

static asj_status match(asj_context *context, const asj_match_options *options, const asj_image *const images[2],
                        const asj_junction *const junctions[2], const size_t counts[2], asj_match_result **result)
{
    match_run m;
    memset(&m, 0, sizeof m);
    m.context = context;
    m.options = options;
    m.clock = asj_clock_ms();
    asj_status status = prepare(&m, images, junctions, counts);
    if (status == ASJ_OK)
        status = find_candidates(&m);
    if (status == ASJ_OK)
        status = refine(&m);
    if (status == ASJ_OK)
        status = finish(&m, result);
    clean(&m);
    if (status == ASJ_OK && asj_progress(context, ASJ_STAGE_ASSIGN, 1) != ASJ_OK) {
        asj_match_result_free(result);
        status = ASJ_ERROR_CANCELLED;
    }
    return status;
}

asj_status asj_match(asj_context *context, const asj_image *image1, const asj_junction *junctions1, size_t count1,
                     const asj_image *image2, const asj_junction *junctions2, size_t count2,
                     const asj_match_options *options, asj_match_result **result)
{
    asj_match_options defaults;
    char message[256];
    if (result)
        *result = NULL;
    if (!context)
        return ASJ_ERROR_ARGUMENT;
    if (!image1 || !image2 || !result || (!junctions1 && count1 > 0) || (!junctions2 && count2 > 0))
        return asj_fail(context, ASJ_ERROR_ARGUMENT, "an image, the junctions or the result is NULL");
    if (!options) {
        asj_match_options_init(&defaults);
        options = &defaults;
    }
    if (asj_match_options_check(options, message, sizeof message) != ASJ_OK)
        return asj_fail(context, ASJ_ERROR_OPTION, "%s", message);
    const asj_image *const images[2] = {image1, image2};
    const asj_junction *const junctions[2] = {junctions1, junctions2};
    const size_t counts[2] = {count1, count2};
    asj_status status;
    asj_backend_begin(context);
    do
        status = match(context, options, images, junctions, counts, result);
    while (asj_backend_retry(context, status));
    return status;
}
