/* SPDX-License-Identifier: BSD-2-Clause */
/* The edge between two junctions is a part of a branch: from the junction to another one that it ends at or passes. The test is
 * the strip's (strip.c), over the whole part: the strip from the junction to t = d holds gamma(d) in n(d) pixels, of which c are as
 * good as one (asj_strip_alike()), and
 *     ln NFA = ln tests + ln F(gamma(d); n(d)) / c,     tests = (NM)^(3/2) times the octaves.
 * The image's planes are gone when edges are known (each octave has its own), so gamma and n are kept at eight places of the
 * branch and are linear between them. */
#include "edge_evidence.h"
#include "nfa.h"
#include "strip.h"

#include <math.h>

#define STRIP_START 0.5 /* px: a strip begins behind this (strip.c), so that parts which follow each other share no pixel */

static void measure(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                    const asj_hypothesis *hypothesis, const asj_hypothesis_branch *branch, asj_evidence *evidence)
{
    const double ux = cos(branch->angle), uy = sin(branch->angle), part = branch->length / ASJ_EVIDENCE_PARTS;
    double gamma = 0, along = 0, across = 0;
    int32_t pixels = 0;
    evidence->length = branch->length;
    for (int32_t i = 0; i < ASJ_EVIDENCE_PARTS; i++) {
        const double t = i == 0 ? 0 : i * part - STRIP_START;
        const asj_strip_line line = {hypothesis->x + t * ux, hypothesis->y + t * uy, branch->angle, (i + 1) * part - t};
        const asj_strip_sums sums = asj_strip_add_up(context, frame, &line, options->strip_half_width, 0);
        evidence->gamma[i] = gamma += sums.gamma;
        evidence->pixels[i] = pixels += sums.pixels;
        along += sums.uu;
        across += sums.nn;
    }
    const double waver = across > 0 ? along / across : 0;
    evidence->alike = options->strip_test ? asj_strip_alike(waver, branch->width, hypothesis->explained) : 1;
}

void asj_edge_evidence_measure(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                               const asj_hypothesis *hypothesis, asj_evidence *evidence)
{
    for (int32_t i = 0; i < hypothesis->branch_count; i++)
        measure(context, frame, options, hypothesis, &hypothesis->branches[i], &evidence[hypothesis->branches[i].evidence]);
}

double asj_edge_evidence_log_nfa(const asj_evidence *evidence, double distance, double log_tests)
{
    if (evidence->length <= 0)
        return HUGE_VAL;
    const double place = fmin(fmax(distance / evidence->length, 0), 1) * ASJ_EVIDENCE_PARTS;
    const int32_t part = place < ASJ_EVIDENCE_PARTS ? (int32_t)place : ASJ_EVIDENCE_PARTS - 1;
    const double before = part > 0 ? evidence->gamma[part - 1] : 0, share = place - part;
    const int32_t first = part > 0 ? evidence->pixels[part - 1] : 0;
    const int32_t pixels = first + (int32_t)lrint(share * (evidence->pixels[part] - first));
    if (pixels == 0)
        return HUGE_VAL;
    const double gamma = before + share * (evidence->gamma[part] - before);
    return log_tests + asj_nfa_log_sector_tail(asj_nfa_tables(), gamma, pixels) / evidence->alike;
}
