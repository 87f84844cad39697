/* SPDX-License-Identifier: BSD-2-Clause */
/* Before the location, over an image: isotropic junctions become hypotheses with guessed lines. Most of them are edges, duplicates
 * or noise, so what costs little rejects first: directions that do not open, what finer octaves have located, a quick guess of the
 * lines, twins. They are worked on a chunk at a time, and what is left of them is kept as guesses: a large picture has tens of
 * thousands of them, of which a tenth will be fitted. */
#include "close_grid.h"
#include "locate.h"
#include "octaves.h"
#include "steps.h"
#include "core/threads.h"
#include "core/watch.h"

#include <math.h>

#define AT_ONCE 1024                            /* junctions in a chunk */
#define LEAST_GUESSES (8 * ASJ_LEAST_JUNCTIONS) /* for a thread: a guess takes a quarter of a fit */

/* Junctions that are shared out, and their guesses. */
typedef struct job {
    asj_detection_run *run;
    const asj_octave_known *known;
    const asj_isotropic_junction *junctions;
    asj_guess *guesses; /* of the junctions; branch_count 0 = rejected */
    asj_watch *watch;
} job;

/* Whether a junction is worth a guess; the hypothesis that it makes. */
static int start(const asj_detection_run *run, const asj_octave_known *known, const asj_isotropic_junction *junction,
                 asj_hypothesis *hypothesis)
{
    if (!asj_isotropic_has_opening(run->options, junction))
        return 0;
    asj_hypothesis_start(junction, hypothesis);
    return !asj_octave_is_known(known, hypothesis, ASJ_KNOWN_PIXEL);
}

static void guess_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_detection_run *run = j->run;
    asj_hypothesis hypothesis;
    double units[ASJ_MAX_BRANCHES][2];
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++) {
        j->guesses[i].branch_count = 0;
        if (!start(run, j->known, &j->junctions[i], &hypothesis))
            continue;
        asj_isotropic_units(run->test, &j->junctions[i], units);
        asj_locate_guess(run->context, run->frame, run->options, (const double(*)[2])units, &hypothesis);
        if (hypothesis.branch_count > 0)
            j->guesses[i] = asj_guess_of(&hypothesis);
    }
}

/* A chunk's guesses behind those that there are. */
static asj_status keep(asj_detection_run *run, const asj_guess *chunk, size_t count)
{
    size_t most = run->guess_count;
    for (size_t i = 0; i < count; i++)
        most += chunk[i].branch_count > 0;
    void *list = run->guesses;
    const asj_status status = asj_grow(&run->context->memory, &list, &run->guess_capacity, asj_detection_run_room(most),
                                       sizeof *run->guesses, run->guess_count);
    run->guesses = list;
    if (status != ASJ_OK)
        return asj_fail(run->context, status, "no memory for %zu junctions", most);
    for (size_t i = 0; i < count; i++)
        if (chunk[i].branch_count > 0)
            run->guesses[run->guess_count++] = chunk[i];
    return ASJ_OK;
}

static asj_status guess_all(asj_detection_run *run, const asj_octave_known *known)
{
    asj_context *context = run->context;
    const size_t total = run->isotropic_count, most = asj_detection_run_room(total < AT_ONCE ? total : AT_ONCE);
    asj_guess *chunk = asj_allocate_list(&context->memory, most, sizeof *chunk);
    if (!chunk)
        return asj_fail(context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", most);
    asj_status status = ASJ_OK;
    asj_watch watch;
    asj_watch_start(&watch, context, ASJ_STAGE_LOCATE);
    for (size_t first = 0; first < total && status == ASJ_OK; first += AT_ONCE) {
        const int64_t count = (int64_t)(total - first < AT_ONCE ? total - first : AT_ONCE);
        const job j = {run, known, run->isotropic + first, chunk, &watch};
        asj_parallel(context, asj_threads_for(context, count, LEAST_GUESSES), count, LEAST_GUESSES / 2, guess_some, &j);
        status = asj_watch_end(&watch);
        if (status == ASJ_OK)
            status = keep(run, chunk, (size_t)count);
    }
    asj_release(&context->memory, chunk);
    return status;
}

/* Guesses of what finer octaves have located become none. */
static void reject_known(const void *data, const asj_part *part)
{
    const job *j = data;
    asj_hypothesis hypothesis;
    for (int64_t i = part->first; i < part->end; i++) {
        asj_guess_restore(&j->guesses[i], &hypothesis);
        if (asj_octave_is_known(j->known, &hypothesis, ASJ_KNOWN_LINES))
            j->guesses[i].branch_count = 0;
    }
}

static void drop_known(asj_detection_run *run, const asj_octave_known *known)
{
    const int64_t count = (int64_t)run->guess_count;
    const job j = {.run = run, .known = known, .guesses = run->guesses};
    if (!known->finer)
        return;
    asj_parallel(run->context, asj_threads_for(run->context, count, LEAST_GUESSES), count, 0, reject_known, &j);
    run->guess_count = 0;
    for (int64_t i = 0; i < count; i++)
        if (run->guesses[i].branch_count > 0)
            run->guesses[run->guess_count++] = run->guesses[i];
}

static asj_status drop_twins(asj_detection_run *run)
{
    const asj_frame *frame = run->frame;
    const size_t count = asj_close_grid_cells(run->guess_count, frame->width, frame->height);
    int32_t *cells = asj_allocate_list(&run->context->memory, count, sizeof *cells);
    if (!cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    run->guess_count = asj_guess_drop_twins(run->guesses, run->guess_count, frame->width, frame->height, cells);
    asj_release(&run->context->memory, cells);
    return ASJ_OK;
}

/* The junctions that are worth a guess. */
static asj_status dump_opening(const asj_detection_run *run, const asj_octave_known *known)
{
    int32_t *points = asj_allocate_list(&run->context->memory, run->isotropic_count, 2 * sizeof *points);
    size_t count = 0;
    if (!points)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to dump %zu points", run->isotropic_count);
    for (size_t i = 0; i < run->isotropic_count; i++) {
        asj_hypothesis hypothesis;
        points[2 * count] = run->isotropic[i].x;
        points[2 * count + 1] = run->isotropic[i].y;
        count += (size_t)start(run, known, &run->isotropic[i], &hypothesis);
    }
    asj_detection_run_dump_points(run, ASJ_STAGE_LOCATE, "opening", count, points);
    asj_release(&run->context->memory, points);
    return ASJ_OK;
}

static asj_status dump_guesses(const asj_detection_run *run, const char *name)
{
    int32_t *points = asj_allocate_list(&run->context->memory, run->guess_count, 2 * sizeof *points);
    if (!points)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory to dump %zu points", run->guess_count);
    for (size_t i = 0; i < run->guess_count; i++) {
        points[2 * i] = (int32_t)lrint(run->guesses[i].x);
        points[2 * i + 1] = (int32_t)lrint(run->guesses[i].y);
    }
    asj_detection_run_dump_points(run, ASJ_STAGE_LOCATE, name, run->guess_count, points);
    asj_release(&run->context->memory, points);
    return ASJ_OK;
}

asj_status asj_step_guess(asj_detection_run *run)
{
    const int dumps = run->context->options.dump != NULL;
    asj_octave_known known;
    asj_status status = asj_detection_run_known(run, &known);
    if (status == ASJ_OK && dumps)
        status = dump_opening(run, &known);
    if (status == ASJ_OK)
        status = guess_all(run, &known);
    if (status == ASJ_OK && dumps)
        status = dump_guesses(run, "guessed");
    if (status == ASJ_OK)
        status = drop_twins(run);
    if (status == ASJ_OK)
        drop_known(run, &known);
    if (status == ASJ_OK && dumps)
        status = dump_guesses(run, "distinct");
    asj_release(&run->context->memory, known.grid.heads);
    asj_release(&run->context->memory, run->isotropic);
    run->isotropic = NULL;
    return status;
}
