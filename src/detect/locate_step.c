/* SPDX-License-Identifier: BSD-2-Clause */
/* Between steps 3 and 4, over an image: guesses become hypotheses with sub-pixel locations, by the line fits and the strips along
 * them. A chunk of guesses at a time, of which a quarter stays. */
#include "edge_width.h"
#include "locate.h"
#include "octaves.h"
#include "steps.h"
#include "suppress.h"
#include "validate.h"
#include "core/threads.h"
#include "core/watch.h"

#define AT_ONCE 256 /* guesses in a chunk */

/* Guesses that are shared out. */
typedef struct job {
    asj_detection_run *run;
    const asj_guess *guesses;
    asj_hypothesis *hypotheses; /* of them; branch_count 0 = rejected */
    asj_watch *watch;
} job;

static void locate_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_detection_run *run = j->run;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++) {
        asj_guess_restore(&j->guesses[i], &j->hypotheses[i]);
        asj_locate(run->context, run->frame, run->options, &j->hypotheses[i]);
        asj_reject_early(run->context, run->frame, run->options, &j->hypotheses[i]);
    }
}

/* A chunk's hypotheses behind those that there are. */
static asj_status keep(asj_detection_run *run, const asj_hypothesis *chunk, size_t count)
{
    size_t most = run->hypothesis_count;
    for (size_t i = 0; i < count; i++)
        most += chunk[i].branch_count > 0;
    void *list = run->hypotheses;
    const asj_status status = asj_grow(&run->context->memory, &list, &run->hypothesis_capacity, asj_detection_run_room(most),
                                       sizeof *run->hypotheses, run->hypothesis_count);
    run->hypotheses = list;
    if (status != ASJ_OK)
        return asj_fail(run->context, status, "no memory for %zu junctions", most);
    for (size_t i = 0; i < count; i++)
        if (chunk[i].branch_count > 0)
            run->hypotheses[run->hypothesis_count++] = chunk[i];
    return ASJ_OK;
}

static asj_status locate_chunks(asj_detection_run *run, asj_hypothesis *chunk)
{
    asj_context *context = run->context;
    asj_status status = keep(run, NULL, 0);
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_LOCATE);
    for (size_t first = 0; first < run->guess_count && status == ASJ_OK; first += AT_ONCE) {
        const size_t left = run->guess_count - first;
        const int64_t count = (int64_t)(left < AT_ONCE ? left : AT_ONCE);
        const job j = {run, run->guesses + first, chunk, &watch};
        asj_parallel(context, asj_threads_for(context, count, ASJ_LEAST_JUNCTIONS), count, ASJ_JUNCTIONS_AT_ONCE, locate_some, &j);
        status = asj_watch_end(&watch);
        if (status == ASJ_OK)
            status = keep(run, chunk, (size_t)count);
    }
    return status;
}

static asj_status locate_all(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    asj_hypothesis *chunk = asj_allocate(memory, AT_ONCE, sizeof *chunk);
    if (!chunk)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %d junctions", AT_ONCE);
    const asj_status status = locate_chunks(run, chunk);
    asj_release(memory, chunk);
    asj_release(memory, run->guesses);
    run->guesses = NULL;
    return status;
}

static asj_status drop_known(asj_detection_run *run)
{
    asj_octave_known known;
    const asj_status status = asj_detection_run_known(run, &known);
    size_t kept = 0;
    if (status != ASJ_OK || !known.finer)
        return status;
    for (size_t i = 0; i < run->hypothesis_count; i++) {
        asj_edge_widths(run->frame, &run->hypotheses[i]);
        if (!asj_octave_is_known(&known, &run->hypotheses[i], ASJ_KNOWN_LINES))
            run->hypotheses[kept++] = run->hypotheses[i];
    }
    run->hypothesis_count = kept;
    asj_release(&run->context->memory, known.grid.heads);
    return ASJ_OK;
}

asj_status asj_step_locate(asj_detection_run *run)
{
    static const struct {
        asj_status (*step)(asj_detection_run *run);
        const char *name; /* of what is left then */
    } steps[] = {{locate_all, "fitted"}, {asj_suppress_all, "apart"}, {drop_known, "located"}};
    asj_status status = ASJ_OK;
    for (size_t i = 0; i < sizeof steps / sizeof *steps && status == ASJ_OK; i++) {
        status = steps[i].step(run);
        if (status == ASJ_OK)
            status = asj_detection_run_dump_hypotheses(run, ASJ_STAGE_LOCATE, steps[i].name);
    }
    return status;
}
