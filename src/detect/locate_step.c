/* SPDX-License-Identifier: BSD-2-Clause */
/* Between steps 3 and 4, over an image: guesses become hypotheses with sub-pixel locations, by the line fits and the strips along
 * them. A chunk of guesses at a time, of which a quarter stays.
 *
 * The most meaningful come first, as suppression has it (suppress.c). So what stays of the chunks before suppresses whatever comes
 * within its reach, and a guess well within that is not worth a fit. Guesses that are suppressed, fitted or not, are kept: what
 * suppressed them may fail later, and then they are located after all, apart from what is valid by then (detect.c). */
#include "blurred_corner.h"
#include "edge_width.h"
#include "locate.h"
#include "octaves.h"
#include "steps.h"
#include "suppress.h"
#include "validate.h"
#include "core/threads.h"
#include "core/watch.h"

#include <math.h>

#define AT_ONCE 64 /* guesses in a chunk */

/* A guess is seldom farther from the fitted location than this share of max_move: 1 px by default. */
#define GUESS_ERROR 0.4

/* px of a coarse octave: a soft corner that is found with certainty may be so much farther from where the isotropic test saw it. */
#define SOFT_MOVE 1.0

/* Guesses that are shared out. */
typedef struct job {
    asj_detection_run *run;
    const asj_guess *guesses;
    asj_hypothesis *hypotheses; /* of them; branch_count 0 = rejected */
    asj_watch *watch;
} job;

/* Fits of lines to soft edges as short as a few of their widths follow what bends the ends, and may find no junction. */
static void look_for_soft(const asj_detection_run *run, const asj_guess *guess, asj_hypothesis *hypothesis)
{
    asj_hypothesis soft;
    if (hypothesis->branch_count > 0 || guess->branch_count != 2)
        return;
    asj_guess_restore(guess, &soft);
    asj_edge_widths(run->frame, &soft);
    asj_blurred_corner(run->context, run->frame, &soft);
    if (asj_blurred_corner_is_sure(&soft) &&
        hypot(soft.x - soft.x0, soft.y - soft.y0) <= asj_locate_most_move(run->options, &soft) + SOFT_MOVE)
        *hypothesis = soft;
}

static void locate_some(const void *data, const asj_part *part)
{
    const job *j = data;
    const asj_detection_run *run = j->run;
    for (int64_t i = part->first; i < part->end && !asj_watch_stops(j->watch, part); i++) {
        asj_guess_restore(&j->guesses[i], &j->hypotheses[i]);
        asj_locate(run->context, run->frame, run->options, &j->hypotheses[i]);
        asj_reject_early(run->context, run->frame, run->options, &j->hypotheses[i]);
        if (asj_detection_run_is_coarse(run))
            look_for_soft(run, &j->guesses[i], &j->hypotheses[i]);
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

/* The next chunk begins at guess `first`: those from *next on that nothing hides move there, before those that are hidden. Returns
 * how many. */
static int64_t pick(const asj_detection_run *run, const asj_close_grid *apart, size_t first, size_t *next)
{
    const double spare = GUESS_ERROR * run->options->max_move;
    size_t end = first;
    for (; *next < run->guess_count && end - first < AT_ONCE; (*next)++) {
        const asj_guess guess = run->guesses[*next];
        if (asj_suppress_hides(run->hypotheses, apart, guess.x, guess.y, spare))
            continue;
        run->guesses[*next] = run->guesses[end];
        run->guesses[end++] = guess;
    }
    return (int64_t)(end - first);
}

/* The hypothesis goes to the grid where nothing suppresses it; whether it does. */
static int mark(const asj_detection_run *run, size_t index, asj_close_grid *apart)
{
    const double x = run->hypotheses[index].x, y = run->hypotheses[index].y;
    if (asj_suppress_hides(run->hypotheses, apart, x, y, 0))
        return 0;
    asj_close_grid_add(apart, asj_close_grid_cell(apart, x, y), index);
    return 1;
}

/* The hypotheses of a chunk go to the grid. Of the `count` guesses of the chunk those that are suppressed, and the ones that were
 * not worth a fit, which stand behind them up to `next`, go where hidden ones are kept. */
static void mark_chunk(asj_detection_run *run, const asj_hypothesis *chunk, asj_guess *guesses, size_t count, size_t skipped,
                       asj_close_grid *apart, size_t *hidden)
{
    size_t index = run->hypothesis_count;
    for (size_t i = 0; i < count; i++)
        index -= chunk[i].branch_count > 0;
    for (size_t i = 0; i < count + skipped; i++)
        if (i >= count || (chunk[i].branch_count > 0 && !mark(run, index++, apart)))
            run->guesses[(*hidden)++] = guesses[i];
}

static asj_status locate_chunks(asj_detection_run *run, asj_close_grid *apart, asj_hypothesis *chunk)
{
    asj_context *context = run->context;
    asj_status status = keep(run, NULL, 0);
    size_t hidden = 0;
    asj_watch watch;
    for (size_t i = 0; i < run->validated; i++)
        mark(run, i, apart);
    asj_watch_start(&watch, context, ASJ_STAGE_LOCATE);
    for (size_t first = 0, next = 0; next < run->guess_count && status == ASJ_OK; first = next) {
        const int64_t count = pick(run, apart, first, &next);
        const job j = {run, run->guesses + first, chunk, &watch};
        asj_parallel(context, asj_threads_for(context, count, ASJ_LEAST_JUNCTIONS), count, ASJ_JUNCTIONS_AT_ONCE, locate_some, &j);
        status = asj_watch_end(&watch);
        if (status == ASJ_OK)
            status = keep(run, chunk, (size_t)count);
        if (status == ASJ_OK)
            mark_chunk(run, chunk, run->guesses + first, (size_t)count, next - first - (size_t)count, apart, &hidden);
    }
    run->guess_count = hidden;
    return status;
}

static asj_status locate_all(asj_detection_run *run)
{
    asj_memory *memory = &run->context->memory;
    const asj_frame *frame = run->frame;
    const size_t count = asj_close_grid_cells(run->guess_count + run->validated, frame->width, frame->height);
    asj_hypothesis *chunk = asj_allocate(memory, AT_ONCE, sizeof *chunk);
    int32_t *cells = asj_allocate_list(memory, count, sizeof *cells);
    asj_status status;
    if (chunk && cells) {
        asj_close_grid apart = asj_close_grid_start(frame->width, frame->height, cells);
        status = locate_chunks(run, &apart, chunk);
    } else
        status = asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %d junctions", AT_ONCE);
    asj_release(memory, cells);
    asj_release(memory, chunk);
    if (run->choice == 0 && run->options->strip_test) /* there may be a second choice */
        return status;
    asj_release(memory, run->guesses);
    run->guesses = NULL;
    run->guess_count = run->guess_capacity = 0;
    return status;
}

typedef struct known_job {
    const asj_detection_run *run;
    const asj_octave_known *known;
} known_job;

static void reject_known(const void *data, const asj_part *part)
{
    const known_job *j = data;
    for (int64_t i = part->first; i < part->end; i++) {
        asj_hypothesis *hypothesis = &j->run->hypotheses[j->run->validated + (size_t)i];
        asj_edge_widths(j->run->frame, hypothesis); /* which say where lines are fitted next (refine.c) */
        if (asj_octave_is_known(j->known, hypothesis, ASJ_KNOWN_LINES))
            hypothesis->branch_count = 0;
    }
}

static asj_status drop_known(asj_detection_run *run)
{
    asj_octave_known known;
    const asj_status status = asj_detection_run_known(run, &known);
    const int64_t count = (int64_t)(run->hypothesis_count - run->validated);
    if (status != ASJ_OK || !known.finer)
        return status;
    const known_job j = {run, &known};
    asj_parallel(run->context, asj_threads_for(run->context, count, ASJ_LEAST_JUNCTIONS), count, 0, reject_known, &j);
    asj_detection_run_drop_rejected(run);
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
        if (status == ASJ_OK && run->choice == 0)
            status = asj_detection_run_dump_hypotheses(run, ASJ_STAGE_LOCATE, steps[i].name);
    }
    asj_sizes_tell_votes(run);
    return status;
}
