/* SPDX-License-Identifier: BSD-2-Clause */
/* Junction files: checks what is to be written, opens the output, calls the writer of the format. */
#include "finite.h"
#include "junction_graph.h"
#include "junction_list.h"
#include "junction_output.h"
#include "output.h"

#include <math.h>

/* Readers want two branches of each. */
static asj_status check_junctions(const asj_detection *detection, const asj_message *message)
{
    char fault[128];
    uint32_t i;
    for (i = 0; i < detection->junction_count; i++) {
        const asj_junction *junction = &detection->junctions[i];
        if (asj_junction_check(junction, fault, sizeof fault) != ASJ_OK)
            return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: junction %lu has %s", (unsigned long)i, fault);
        if (junction->branch_count < 2)
            return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: junction %lu has less than two branches",
                                    (unsigned long)i);
    }
    return ASJ_OK;
}

static int is_sound_pair(const asj_detection *detection, const asj_l_junction *pair)
{
    int32_t branches = pair->junction < detection->junction_count ? detection->junctions[pair->junction].branch_count : 0;
    return pair->branch_a < branches && pair->branch_b < branches && isfinite(pair->x) && isfinite(pair->y) && isfinite(pair->ax) &&
           isfinite(pair->ay) && isfinite(pair->bx) && isfinite(pair->by);
}

static int is_sound_end(const asj_detection *detection, uint32_t junction)
{
    return junction == ASJ_NO_JUNCTION || junction < detection->junction_count;
}

static int is_sound_segment(const asj_detection *detection, const asj_segment *s)
{
    const int32_t branches = s->junction < detection->junction_count ? detection->junctions[s->junction].branch_count : 0;
    return s->branch < branches && is_sound_end(detection, s->junction1) && is_sound_end(detection, s->junction2) &&
           isfinite(s->x1) && isfinite(s->y1) && isfinite(s->x2) && isfinite(s->y2) && isfinite(s->sd1) && isfinite(s->sd2) &&
           isfinite(s->log10_nfa);
}

static asj_status check_segments(const asj_detection *detection, const asj_segment_list *list, const asj_message *message)
{
    uint32_t i;
    if (list->count && !list->segments)
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: the segments have a count but no array");
    for (i = 0; i < list->count; i++)
        if (!is_sound_segment(detection, &list->segments[i]))
            return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: segment %lu has NaN, infinity or a wrong index",
                                    (unsigned long)i);
    return ASJ_OK;
}

static asj_status check_vanishing(const asj_vanishing_points *found, const asj_message *message)
{
    const asj_camera *c = &found->camera;
    int sound = found->focal_source == ASJ_FOCAL_UNKNOWN ||
                (isfinite(c->fx) && isfinite(c->fy) && isfinite(c->cx) && isfinite(c->cy));
    int32_t i, k;
    for (i = 0; i < found->count && i < ASJ_MOST_VANISHING; i++)
        for (k = 0; k < 3; k++)
            sound = sound && isfinite(found->points[i].point[k]) && isfinite(found->points[i].direction[k]) &&
                    isfinite(found->points[i].log10_nfa);
    return sound ? ASJ_OK
                 : asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: the vanishing points have NaN or infinity");
}

static asj_status check_edges(const asj_detection *detection, const asj_message *message)
{
    size_t which;
    switch (asj_find_edge_fault(detection->junctions, detection->junction_count, detection->edges, detection->edge_count, &which)) {
    case ASJ_EDGES_SOUND: break;
    case ASJ_EDGE_OF_NOTHING:
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: edge %zu has NaN, infinity or a wrong index", which);
    case ASJ_EDGE_OF_AN_OTHER:
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: a branch of edge %zu is part of an edge before", which);
    case ASJ_EDGES_NO_MEMORY: return asj_message_fail(message, ASJ_ERROR_MEMORY, "out of memory");
    }
    return ASJ_OK;
}

static asj_status check(const asj_detection *detection, int32_t file_format, const asj_message *message)
{
    asj_status status;
    uint32_t i;
    if ((detection->junction_count && !detection->junctions) || (detection->l_junction_count && !detection->l_junctions) ||
        (detection->edge_count && !detection->edges))
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: the detection has a count but no array");
    if (file_format == ASJ_FILE_JSON && (detection->width < 1 || detection->height < 1 || detection->width > ASJ_MAX_SIDE ||
                                         detection->height > ASJ_MAX_SIDE))
        return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: an image of %d x %d pixels", (int)detection->width,
                                (int)detection->height);
    status = check_junctions(detection, message);
    if (status != ASJ_OK)
        return status;
    for (i = 0; i < detection->l_junction_count; i++)
        if (!is_sound_pair(detection, &detection->l_junctions[i]))
            return asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: L-junction %lu has NaN, infinity or a wrong index",
                                    (unsigned long)i);
    return check_edges(detection, message);
}

/* options: whether they will be written. */
static asj_status check_report(const asj_detection_report *report, int32_t file_format, int options, const asj_message *message)
{
    asj_status status = asj_message_reserved(message, report->reserved);
    if (status == ASJ_OK)
        status = check(report->detection, file_format, message);
    if (status == ASJ_OK && options && !asj_options_are_finite(report->options, asj_detect_option_count(), asj_detect_option))
        status = asj_message_fail(message, ASJ_ERROR_ARGUMENT, "not written: the options have NaN or infinity");
    if (status == ASJ_OK && report->segments)
        status = check_segments(report->detection, report->segments, message);
    if (status == ASJ_OK && report->vanishing_points)
        status = check_vanishing(report->vanishing_points, message);
    return status;
}

asj_status asj_junctions_write(const char *path, int32_t file_format, const asj_detection_report *report,
                               char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, path);
    asj_output *output;
    asj_status status;

    if (!path || !report || !report->detection)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no path or no detection");
    if (file_format < ASJ_FILE_ASJ || file_format > ASJ_FILE_CSV)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "%d is no file format", (int)file_format);
    status = check_report(report, file_format, file_format == ASJ_FILE_JSON, &message);
    if (status == ASJ_OK)
        status = asj_output_begin(path, &output, text, text_size);
    if (status != ASJ_OK)
        return status;
    if (file_format == ASJ_FILE_JSON)
        status = asj_write_json(output, report, &message);
    else if (file_format == ASJ_FILE_CSV && report->segments)
        asj_write_segments_csv(output, report->segments);
    else if (file_format == ASJ_FILE_CSV)
        status = asj_write_csv(output, report->detection, &message);
    else
        asj_write_text(output, report->detection, file_format == ASJ_FILE_ASJ_WHOLE);
    if (status != ASJ_OK) {
        asj_output_abort(&output);
        return status;
    }
    return asj_output_commit(&output, text, text_size);
}

asj_status asj_junctions_write_line(asj_output *output, const asj_detection_report *report, char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, output ? asj_output_path(output) : NULL);
    asj_status status;

    if (!output || !report || !report->detection)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no output or no detection");
    status = check_report(report, ASJ_FILE_JSON, 0, &message);
    return status == ASJ_OK ? asj_write_json_line(output, report, &message) : status;
}

asj_status asj_junctions_write_failed_line(asj_output *output, const char *image_name, const char *cause,
                                           char *text, size_t text_size)
{
    asj_message message = asj_message_start(text, text_size, output ? asj_output_path(output) : NULL);

    if (!output || !image_name || !cause)
        return asj_message_fail(&message, ASJ_ERROR_ARGUMENT, "no output, no name of the image or no cause");
    return asj_write_json_failure(output, image_name, cause, &message);
}
