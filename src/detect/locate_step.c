/* SPDX-License-Identifier: BSD-2-Clause */
/* Between steps 3 and 4, over an image: isotropic junctions become hypotheses with sub-pixel locations. Most of them are edges,
 * duplicates or noise, so what costs little rejects first: directions that do not open, a quick guess of the lines, twins; only
 * then the line fits and the strips. */
#include "edge_width.h"
#include "locate.h"
#include "octaves.h"
#include "steps.h"
#include "suppress.h"
#include "validate.h"

#define LEAST_GUESSES (4 * ASJ_LEAST_JUNCTIONS) /* for a thread: a guess takes a quarter of a fit */

/* What finer octaves have located well is not followed again. */
static asj_status drop_known(asj_detection_run *run, int known)
{
    const int32_t width = run->image->width, height = run->image->height;
    if (run->all_count == 0)
        return ASJ_OK;
    const size_t count = asj_octave_grid_cells(run->all_count, width, height);
    int32_t *cells = asj_allocate_list(&run->context->memory, count, sizeof *cells);
    if (!cells)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu cells", count);
    run->hypothesis_count = asj_octaves_drop_known(run->hypotheses, run->hypothesis_count, run->octave, known, run->all,
                                                   run->all_count, run->options, width, height, cells);
    asj_release(&run->context->memory, cells);
    return ASJ_OK;
}

static void guess(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    asj_locate_guess(run->context, run->frame, run->options, hypothesis);
}

static asj_status guess_all(asj_detection_run *run)
{
    return asj_detection_run_each(run, ASJ_STAGE_LOCATE, LEAST_GUESSES, guess);
}

static void locate(const asj_detection_run *run, asj_hypothesis *hypothesis)
{
    asj_locate(run->context, run->frame, run->options, hypothesis);
    asj_reject_early(run->context, run->frame, run->options, hypothesis);
}

static asj_status locate_all(asj_detection_run *run)
{
    return asj_detection_run_each(run, ASJ_STAGE_LOCATE, ASJ_LEAST_JUNCTIONS, locate);
}

static asj_status drop_known_early(asj_detection_run *run)
{
    return drop_known(run, ASJ_KNOWN_PIXEL);
}

static asj_status drop_known_late(asj_detection_run *run)
{
    for (size_t i = 0; i < run->hypothesis_count && run->all_count > 0; i++)
        asj_edge_widths(run->frame, &run->hypotheses[i]);
    return drop_known(run, ASJ_KNOWN_LINES);
}

static asj_status drop_twins(asj_detection_run *run)
{
    const asj_status status = asj_suppress_all(run, ASJ_SUPPRESS_TWINS);
    return status == ASJ_OK ? drop_known(run, ASJ_KNOWN_ROUGHLY) : status;
}

static asj_status drop_close(asj_detection_run *run)
{
    return asj_suppress_all(run, ASJ_SUPPRESS_CLOSE);
}

asj_status asj_step_locate(asj_detection_run *run)
{
    size_t count = 0;
    for (size_t i = 0; i < run->isotropic_count; i++)
        count += (size_t)asj_isotropic_has_opening(run->options, &run->isotropic[i]);
    run->hypotheses = asj_allocate_list(&run->context->memory, asj_detection_run_room(count), sizeof *run->hypotheses);
    if (!run->hypotheses)
        return asj_fail(run->context, ASJ_ERROR_MEMORY, "no memory for %zu junctions", count);
    for (size_t i = 0; i < run->isotropic_count; i++)
        if (asj_isotropic_has_opening(run->options, &run->isotropic[i]))
            asj_hypothesis_start(&run->isotropic[i], &run->hypotheses[run->hypothesis_count++]);
    static const struct {
        asj_status (*step)(asj_detection_run *run);
        const char *name; /* of what is left then */
    } steps[] = {{drop_known_early, "opening"}, {guess_all, "guessed"}, {drop_twins, "distinct"}, {locate_all, "fitted"},
                 {drop_close, "apart"},         {drop_known_late, "located"}};
    asj_status status = ASJ_OK;
    for (size_t i = 0; i < sizeof steps / sizeof *steps && status == ASJ_OK; i++) {
        status = steps[i].step(run);
        if (status == ASJ_OK)
            status = asj_detection_run_dump_hypotheses(run, ASJ_STAGE_LOCATE, steps[i].name);
    }
    return status;
}
