/* SPDX-License-Identifier: BSD-2-Clause */
/* Step 1 over an image: grey plane, of each octave, and its normalised gradient. */
#include "steps.h"

/* In colour planes whose noise is smooth (core/colour_plane.c) a surface counts as flat up to so many times gradient_epsilon: of
 * what colours add to nine photographs' matches 93 of 100 are right then, 86 of 100 by 1. In planes of independent noise it would
 * cost what is gained (tests/accuracy/tried/detection.md, "Colours"). */
#define SMOOTH_EPSILON 2

asj_status asj_step_load(asj_detection_run *run)
{
    if (run->size > 0) {
        const double octave = run->octave < 0 ? run->octave : 0;
        run->frame->octave = octave;
        return asj_frame_load_resized(run->context, run->frame, run->whole, run->plane,
                                      asj_octave_size(run->image->width, octave), asj_octave_size(run->image->height, octave));
    }
    return run->octave < 0 ? asj_frame_upsample(run->context, run->frame, run->image, run->plane)
                           : asj_frame_load(run->context, run->frame, run->image, run->plane);
}

/* From the upsampled image to the image itself. */
static asj_status reduce(asj_detection_run *run)
{
    const int32_t octaves = run->frame->octaves;
    const asj_status status = asj_frame_prepare(run->context, run->frame, run->image->width, run->image->height);
    run->frame->octaves = octaves;
    return status == ASJ_OK ? asj_step_load(run) : status;
}

asj_status asj_step_halve(asj_detection_run *run)
{
    run->octave++;
    asj_status status = run->octave > 0 ? asj_frame_halve(run->context, run->frame) : reduce(run);
    return status == ASJ_OK ? asj_detection_run_set_size(run) : status;
}

/* From a whole octave half-way to the next one. That one is made of the grey plane that is kept, but octave 0, of the image. */
static asj_status go_half_way(asj_detection_run *run)
{
    const int32_t in_place = run->octave < 0 && asj_frame_shrinks_in_place(run->frame);
    const asj_gray_plane own = asj_frame_gray(run->frame);
    const asj_status status = in_place ? ASJ_OK : asj_gray_plane_keep(run->context, run->frame, &run->kept);
    run->octave += 0.5;
    return status == ASJ_OK ? asj_frame_shrink(run->context, run->frame, in_place ? &own : &run->kept) : status;
}

static asj_status go_on(asj_detection_run *run)
{
    run->octave += 0.5;
    const asj_status status = run->octave > 0 ? asj_frame_halve_plane(run->context, run->frame, &run->kept) : reduce(run);
    asj_release(&run->context->memory, run->kept.levels);
    run->kept.levels = NULL;
    return status;
}

asj_status asj_step_half_octave(asj_detection_run *run)
{
    const asj_status status = asj_octave_is_whole(run->octave) ? go_half_way(run) : go_on(run);
    return status == ASJ_OK ? asj_detection_run_set_size(run) : status;
}

asj_status asj_step_gradient(asj_detection_run *run)
{
    asj_frame *frame = run->frame;
    asj_detect_options of_plane = *run->options;
    if (run->planes.smooth[run->plane])
        of_plane.gradient_epsilon *= SMOOTH_EPSILON;
    asj_status status = run->context->ops->gradient->planes(run->context, frame, &of_plane);
    if (status != ASJ_OK)
        return status;
    asj_detection_run_dump_plane(run, ASJ_DUMP_PLANE_U16, "gray", frame->gray, 1.0 / ASJ_GRAY_ONE);
    asj_detection_run_dump_plane(run, ASJ_DUMP_PLANE_I16, "gradient_x", frame->gradient_x, 1.0 / ASJ_GRADIENT_ONE);
    asj_detection_run_dump_plane(run, ASJ_DUMP_PLANE_I16, "gradient_y", frame->gradient_y, 1.0 / ASJ_GRADIENT_ONE);
    return ASJ_OK;
}
