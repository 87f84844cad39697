/* SPDX-License-Identifier: BSD-2-Clause */
/* Between steps 3 and 4, over an image: isotropic junctions become hypotheses with sub-pixel locations. Most of them are edges,
 * duplicates or noise, so what costs little rejects first: directions that do not open, a quick guess of the lines, twins; only
 * then the line fits and the strips. */
#include "locate.h"
#include "steps.h"
#include "suppress.h"
#include "validate.h"
#include "core/threads.h"
#include "core/watch.h"

#define LEAST_GUESSES (4 * ASJ_LEAST_JUNCTIONS) /* for a thread: a guess takes a quarter of a fit */

static asj_status guess_all(asj_detection_run *run)
{
    asj_watch watch;
    const int64_t count = (int64_t)run->hypothesis_count;
    const int32_t threads = asj_threads_for(run->context, count, LEAST_GUESSES);
    (void)threads;
    asj_watch_start(&watch, run->context, ASJ_STAGE_LOCATE);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 16)
    for (int64_t i = 0; i < count; i++)
        if (!asj_watch_stops(&watch))
            asj_locate_guess(run->context, run->frame, run->options, &run->hypotheses[i]);
    return asj_watch_end(&watch);
}

static asj_status locate_all(asj_detection_run *run)
{
    asj_watch watch;
    const int64_t count = (int64_t)run->hypothesis_count;
    const int32_t threads = asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS);
    (void)threads;
    asj_watch_start(&watch, run->context, ASJ_STAGE_LOCATE);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 8)
    for (int64_t i = 0; i < count; i++) {
        if (asj_watch_stops(&watch))
            continue;
        asj_locate(run->context, run->frame, run->options, &run->hypotheses[i]);
        asj_reject_early(run->context, run->frame, run->options, &run->hypotheses[i]);
    }
    return asj_watch_end(&watch);
}

asj_status asj_step_locate(asj_detection_run *run)
{
    const size_t count = run->isotropic_count, room = asj_detection_run_room(count);
    run->hypotheses = asj_allocate_list(&run->context->memory, room, sizeof *run->hypotheses);
    if (!run->hypotheses)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", count);
    for (size_t i = 0; i < count; i++)
        if (asj_isotropic_has_opening(run->options, &run->isotropic[i]))
            asj_hypothesis_start(&run->isotropic[i], &run->hypotheses[run->hypothesis_count++]);
    asj_status status = guess_all(run);
    if (status == ASJ_OK)
        status = asj_suppress_all(run, ASJ_SUPPRESS_TWINS);
    if (status == ASJ_OK)
        status = locate_all(run);
    if (status == ASJ_OK)
        status = asj_suppress_all(run, ASJ_SUPPRESS_CLOSE);
    return status == ASJ_OK ? asj_detection_run_dump_hypotheses(run, ASJ_STAGE_LOCATE, "located") : status;
}
