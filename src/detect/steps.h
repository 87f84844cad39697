/* SPDX-License-Identifier: BSD-2-Clause */
/* The steps of the detector over a whole image, in the order in which detect.c runs them: threads, memory, progress and dumps
 * around what a step does to one place, which stands in the file of the step's name. */
#ifndef ASJ_SRC_STEPS_H
#define ASJ_SRC_STEPS_H

#include "detection_run.h"

asj_status asj_step_load(asj_detection_run *run);       /* gradient_step.c: image -> grey plane of the frame */
asj_status asj_step_halve(asj_detection_run *run);      /* gradient_step.c: -> grey plane of the next octave */
asj_status asj_step_half_octave(asj_detection_run *run); /* gradient_step.c: -> the same, of half an octave more */
asj_status asj_step_gradient(asj_detection_run *run);   /* step 1 (gradient_step.c): -> gradient planes */
asj_status asj_step_candidates(asj_detection_run *run); /* step 2 (candidates_step.c): planes -> candidates */
size_t asj_candidates_count(const uint16_t *masks, size_t count); /* bits in a list of masks */
asj_status asj_step_isotropic(asj_detection_run *run);  /* step 3 (isotropic_step.c): candidates -> isotropic junctions */
asj_status asj_step_guess(asj_detection_run *run);      /* guess_step.c: isotropic junctions -> guesses */
asj_status asj_step_locate(asj_detection_run *run);     /* locate_step.c: guesses -> hypotheses */
asj_status asj_step_scan(asj_detection_run *run);       /* step 4 (scan_step.c): lengths where they are not known */
asj_status asj_step_scan_roughly(asj_detection_run *run); /* the same, about, of what is scanned again */
asj_status asj_step_orient(asj_detection_run *run);     /* step 5 (refine_step.c): orientations, to scan along again */
asj_status asj_step_search(asj_detection_run *run);     /* the same as in the paper (search_step.c), with their lengths */
asj_status asj_step_refine(asj_detection_run *run);     /* step 5 (refine_step.c): orientations, location, validation */
void asj_step_fit_lines(const asj_detection_run *run, asj_hypothesis *hypothesis); /* refine_step.c: of one, without validation */
asj_status asj_step_complete(asj_detection_run *run);   /* complete_step.c: branches that junctions lack, if asked for */
asj_status asj_step_ends(asj_detection_run *run);       /* ends_step.c: what is at the ends of branches, evidence along them */
asj_status asj_step_snap(asj_detection_run *run);       /* ends_step.c: ends moved onto junctions */
asj_status asj_step_next_octave(asj_detection_run *run);  /* octaves_step.c: hypotheses put by, the next octave's grey plane */
asj_status asj_step_merge_octaves(asj_detection_run *run);/* octaves_step.c: one list of a plane's hypotheses */
asj_status asj_step_merge_planes(asj_detection_run *run); /* planes_step.c: those that are new, put by */
int32_t asj_sizes_of(const asj_detection_run *run);       /* sizes_step.c: how often the image is looked at */
double asj_sizes_time(const asj_detection_run *run);      /* sizes_step.c: how long all take, for that of the image itself, */
double asj_size_time(const asj_detection_run *run);       /* and a pixel of the one at hand, for one of the image */
asj_status asj_step_next_size(asj_detection_run *run);    /* sizes_step.c: hypotheses put by, the image at the next size */
void asj_sizes_mark_candidates(asj_detection_run *run);   /* sizes_step.c: step 2 of a copy */
asj_status asj_sizes_put_rejected(asj_detection_run *run); /* sizes_step.c: what validation has rejected, put by */
void asj_sizes_tell_votes(asj_detection_run *run);        /* sizes_step.c: hypotheses of copies that are votes */
size_t asj_sizes_votes_last(asj_detection_run *run);      /* sizes_step.c: these behind the others; how many */
asj_status asj_step_merge_sizes(asj_detection_run *run);  /* sizes_step.c: what two looks have */
int asj_luma_may_be_kept(const asj_detection_run *run);   /* luma_step.c: for another pass that looks at colours, */
asj_status asj_step_keep_luma(asj_detection_run *run);    /* what the luma has; */
asj_status asj_step_recall_luma(asj_detection_run *run);  /* in such a pass */
asj_status asj_step_list(asj_detection_run *run);         /* planes_step.c: the hypotheses of all planes; ends of branches */
asj_status asj_step_join(asj_detection_run *run);       /* edges_step.c: edges between junctions */

#endif
