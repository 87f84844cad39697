/* SPDX-License-Identifier: BSD-2-Clause */
/* Match files: checks what is to be written, opens the output, calls the writer of the format. */
#include "finite.h"
#include "match_output.h"

#include <stdlib.h>

static int is_sound(const asj_match_result *result, const asj_junction_match *m)
{
    const double numbers[] = {(double)m->x1, (double)m->y1, (double)m->ax1, (double)m->ay1, (double)m->bx1, (double)m->by1,
                              (double)m->x2, (double)m->y2, (double)m->ax2, (double)m->ay2, (double)m->bx2, (double)m->by2,
                              (double)m->distance, (double)m->similarity, (double)m->support, (double)m->probability};
    return asj_all_finite(numbers, sizeof numbers / sizeof numbers[0]) && asj_all_finite(m->affine, 6) && !isnan(m->ratio) &&
           m->l1 < result->l_junction_count1 && m->l2 < result->l_junction_count2;
}

static int is_sound_corner(const asj_l_junction *l)
{
    const double numbers[] = {(double)l->x, (double)l->y, (double)l->ax, (double)l->ay, (double)l->bx, (double)l->by};
    return asj_all_finite(numbers, 6);
}

/* What is written of an accepted geometry, and of an ambiguous one (asj_write_match_json()). */
static int is_sound_geometry(const asj_geometry *g)
{
    const asj_camera *a = &g->cameras[0], *b = &g->cameras[1];
    const double numbers[] = {a->fx, a->fy, a->cx, a->cy, b->fx, b->fy, b->cx, b->cy, g->focal_sd, g->log10_nfa, g->inliers,
                              g->picture_agreement};
    if (g->status == ASJ_GEOMETRY_AMBIGUOUS && g->has_rival)
        return isfinite(g->log10_nfa) && isfinite(g->rival_log10_nfa) && asj_all_finite(g->rotation, 9) &&
               asj_all_finite(g->translation, 3) && asj_all_finite(g->rival_rotation, 9) && asj_all_finite(g->rival_translation, 3);
    return g->status != ASJ_GEOMETRY_ACCEPTED ||
           (asj_all_finite(numbers, sizeof numbers / sizeof numbers[0]) && asj_all_finite(g->matrix, 9) &&
            asj_all_finite(g->rotation, 9) && asj_all_finite(g->translation, 3) && asj_all_finite(g->covariance, 36));
}

static asj_status check(const asj_match_result *result, const asj_message *message)
{
    const asj_l_junction *const lists[2] = {result->l_junctions1, result->l_junctions2};
    const uint32_t counts[2] = {result->l_junction_count1, result->l_junction_count2};
    uint32_t i;
    int v;
    if ((result->match_count && !result->matches) || (result->rejected_count && !result->rejected) ||
        (counts[0] && !lists[0]) || (counts[1] && !lists[1]))
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: the result has a count but no array");
    if (!is_sound_geometry(&result->geometry))
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: the geometry has NaN or infinity");
    for (i = 0; i < result->match_count; i++)
        if (!is_sound(result, &result->matches[i]))
            return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: match %lu has NaN, infinity or a wrong index",
                                    (unsigned long)i);
    for (i = 0; i < result->rejected_count; i++)
        if (!is_sound(result, &result->rejected[i]))
            return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: rejected match %lu has NaN, infinity or a wrong "
                                    "index", (unsigned long)i);
    for (v = 0; v < 2; v++)
        for (i = 0; i < counts[v]; i++)
            if (!is_sound_corner(&lists[v][i]))
                return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: L-junction %lu of image %d has NaN or infinity",
                                        (unsigned long)i, v + 1);
    return ASJ_OK;
}

static asj_status check_report(const asj_match_report *report, int32_t file_format, const asj_message *message)
{
    if (file_format != ASJ_FILE_JSON) /* which alone has the rest */
        return check(report->result, message);
    if (!asj_all_finite(report->stretch, 2))
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: the stretch has NaN or infinity");
    if (!asj_options_are_finite(report->options, asj_match_option_count(), asj_match_option) ||
        !asj_options_are_finite(report->detect_options, asj_detect_option_count(), asj_detect_option))
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: the options have NaN or infinity");
    return check(report->result, message);
}

static asj_status find_segments(const asj_match_report *report, asj_match_lines *segments, const asj_message *message)
{
    segments->list = NULL;
    segments->count = report->lines ? asj_match_segments(report->result, report->minimum_end, NULL, 0) : 0;
    if (segments->count == 0)
        return ASJ_OK;
    segments->list = malloc(segments->count * sizeof *segments->list);
    if (!segments->list)
        return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory for %zu line segments", segments->count);
    asj_match_segments(report->result, report->minimum_end, segments->list, segments->count);
    if (report->lines == ASJ_LINES_JOINED)
        segments->count = asj_join_segment_matches(segments->list, segments->count);
    return ASJ_OK;
}

static asj_status write_file(const char *path, int32_t file_format, const asj_match_report *report,
                             const asj_match_lines *segments, const asj_message *message)
{
    asj_output *output;
    asj_status status = asj_output_begin(path, &output, message->text, message->size);
    if (status != ASJ_OK)
        return status;
    if (file_format == ASJ_FILE_JSON)
        status = asj_write_match_json(output, report, segments, message);
    else
        asj_write_match_csv(output, report, segments);
    if (status == ASJ_OK)
        return asj_output_commit(&output, message->text, message->size);
    asj_output_abort(&output);
    return status;
}

asj_status asj_matches_write(const char *path, int32_t file_format, const asj_match_report *report, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    asj_match_lines segments;
    asj_status status;

    if (!path || !report || !report->result)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no matches");
    if (file_format != ASJ_FILE_JSON && file_format != ASJ_FILE_CSV)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "%d is no file format for matches", (int)file_format);
    if (report->lines < ASJ_LINES_NONE || report->lines > ASJ_LINES_JOINED)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "lines %d: there is no such", (int)report->lines);
    if (report->lines && (report->minimum_end < ASJ_END_CUT || report->minimum_end > ASJ_END_CORNER))
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "minimum_end %d: there is no such", (int)report->minimum_end);
    status = asj_message_reserved(&message, report->reserved);
    if (status == ASJ_OK)
        status = check_report(report, file_format, &message);
    if (status == ASJ_OK)
        status = find_segments(report, &segments, &message);
    if (status != ASJ_OK)
        return status;
    status = write_file(path, file_format, report, &segments, &message);
    free(segments.list);
    return status;
}
