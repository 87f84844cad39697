/* SPDX-License-Identifier: BSD-2-Clause */
/* THE option table of the matcher. The reason for each step is told on top of the file that uses its options. */
#include "match_options.h"
#include "core/option_table.h"

#include <asj/detect.h>

#include <stdio.h>
#include <string.h>

#define ROW(field, type, unit, minimum, maximum, standard, paper, choices, help) \
    {#field, unit, help, choices, type, (uint32_t)offsetof(asj_match_options, field), minimum, maximum, standard, paper}
#define NUMBER(field, unit, minimum, maximum, standard, paper, help) \
    ROW(field, ASJ_OPTION_NUMBER, unit, minimum, maximum, standard, paper, NULL, help)
#define INTEGER(field, unit, minimum, maximum, standard, paper, help) \
    ROW(field, ASJ_OPTION_INTEGER, unit, minimum, maximum, standard, paper, NULL, help)
#define SWITCH(field, standard, paper, help) ROW(field, ASJ_OPTION_SWITCH, "", 0, 1, standard, paper, NULL, help)
#define CHOICE(field, last, standard, paper, words, help) \
    ROW(field, ASJ_OPTION_CHOICE, "", 0, last, standard, paper, words, help)

static const char *const patch_words[] = {"canonical", "induced", NULL};
static const char *const descriptor_words[] = {"raw", "sift", NULL};

static const asj_option_info rows[] = {
    CHOICE(descriptor, 1, ASJ_DESCRIPTOR_RAW, ASJ_DESCRIPTOR_RAW, descriptor_words, "what describes a patch: raw or sift"),
    NUMBER(ratio, "", 1, 10, 1.5, 1.5, "the second best match at another place must be worse by this factor"),
    SWITCH(mutual, 1, 0, "two junctions match only if each is the other's best"),
    NUMBER(minimum_support, "", 0, 64, 1.5, 0, "neighbouring matches that must agree with a match, each counted 0 to 1"),
    NUMBER(minimum_similarity, "", -1, 1, -1, -1, "correlation that the aligned discs of a match need"),
    INTEGER(neighbours, "", 0, 64, 40, 0, "nearest junctions asked for support; 0 = none are asked"),
    NUMBER(neighbour_tolerance, "", 0.01, 1, 0.08, 0.08,
           "error with which a match predicts its neighbour, as a part of the distance"),
    NUMBER(map_tolerance, "", 0.05, 5, 0.5, 0.5, "relative difference between the affine maps of neighbours"),
    INTEGER(guided_rounds, "", 0, 4, 1, 0, "times that accepted matches propose matches near them"),
    INTEGER(witnesses, "", 0, 64, 16, 0, "nearest matches that are asked whether they agree with a match; 0 = none are asked"),
    NUMBER(witness_distance, "px", 10, 10000, 100, 100, "distance at which a witness counts by half"),
    NUMBER(minimum_agreement, "", 0, 1, 0.28, 0, "mean agreement with the witnesses, each counted 0 to 1, that a match needs"),
    CHOICE(patches, 1, ASJ_PATCHES_CANONICAL, ASJ_PATCHES_INDUCED, patch_words,
           "canonical: one patch for each L-junction; induced: warped by each pair's own map"),
    SWITCH(normalise, 1, 0, "bring raw patches to zero mean and unit norm"),
    INTEGER(patch_size, "", 8, 24, 16, 16, "samples along a side of a patch: a multiple of 4"),
    NUMBER(window_start, "", -1, 0, -0.25, -0.25, "a canonical patch starts here, in branch lengths"),
    NUMBER(window_end, "", 0.25, 2, 1, 1, "a canonical patch ends here, in branch lengths"),
    NUMBER(patch_radius, "px", 4, 64, 16, 16, "half a side of an induced patch"),
    NUMBER(smoothing, "px", 0, 2, 0.8, 0, "blur of the images before patches are sampled"),
    INTEGER(shortlist, "", 1, 32, 4, 16, "best candidates kept for each L-junction of either image"),
    INTEGER(align_iterations, "", 0, 30, 6, 0, "steps that refine the affine map of a candidate on the images; 0 = none"),
    NUMBER(align_radius, "px", 8, 64, 20, 20, "radius of the disc that is aligned"),
    NUMBER(max_move, "px", 0.5, 20, 8, 8, "farthest that the alignment may move a junction"),
    NUMBER(separation, "px", 0, 100, 6, 0, "what is nearer than this is the same place"),
    NUMBER(minimum_opening, "deg", 0, 80, 20, 20, "branches that open by less give no frame"),
    INTEGER(length_hypotheses, "", 1, 4, 3, 1, "lengths tried for a branch: its own, and junctions that lie on it"),
    NUMBER(end_tolerance, "", 0.01, 1, 0.12, 0.12, "branch ends correspond when their lengths agree within this part"),
};

static const asj_option_table table = {rows, sizeof rows / sizeof *rows};

asj_status asj_match_options_check(const asj_match_options *options, char *message, size_t message_size)
{
    asj_status status = asj_option_table_check(&table, options, message, message_size);
    if (status == ASJ_OK && options->patch_size % 4 != 0) {
        if (message)
            snprintf(message, message_size, "patch_size is %d, not a multiple of 4", (int)options->patch_size);
        return ASJ_ERROR_OPTION;
    }
    return status;
}

void asj_match_options_init(asj_match_options *options)
{
    asj_match_options_preset(options, ASJ_PRESET_DEFAULT);
}

asj_status asj_match_options_preset(asj_match_options *options, int32_t preset)
{
    if (!options)
        return ASJ_ERROR_ARGUMENT;
    if (preset != ASJ_PRESET_DEFAULT && preset != ASJ_PRESET_PAPER)
        return ASJ_ERROR_OPTION;
    memset(options, 0, sizeof *options);
    asj_option_table_fill(&table, options, preset);
    return ASJ_OK;
}

size_t asj_match_option_count(void)
{
    return table.count;
}

const asj_option_info *asj_match_option(size_t index)
{
    return index < table.count ? &rows[index] : NULL;
}

asj_status asj_match_options_set(asj_match_options *options, const char *key, const char *text,
                                 char *message, size_t message_size)
{
    return asj_option_table_set(&table, options, key, text, message, message_size);
}

asj_status asj_match_options_get(const asj_match_options *options, const char *key, char *text, size_t text_size)
{
    return asj_option_table_get(&table, options, key, text, text_size);
}

/* Measured on photographs (tests/accuracy/match_pairs.c): what the detector does for precision costs the matcher half of its
 * matches and gains it nothing, because a chance junction has no partner that agrees with its neighbours. So: weaker
 * candidates, no strip test, corners that the line fit moves far (a blurred corner, a short branch) stay, and a branch is as long
 * as its junction's scale at least, whatever lies between. */
void asj_match_detect_options(asj_detect_options *options)
{
    if (!options)
        return;
    options->candidate_strength = 2;
    options->candidate_step = 1;
    options->epsilon = 1e4;
    options->scan_start = 0;
    options->scan_epsilon = 10;
    options->minimum_opening = 20;
    options->max_move = 5;
    options->strip_test = 0;
    options->near_strength = -10;
}
