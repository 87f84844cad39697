/* SPDX-License-Identifier: BSD-2-Clause */
/* THE option table of the matcher. The reason for each step is told on top of the file that uses its options. */
#include "match_options.h"
#include "core/option_table.h"
#include "core/reserved.h"
#include "geometry/geometry_options.h"

#include <stdio.h>
#include <string.h>

#define OPTIONS_TYPE asj_match_options
#define IMAGES "images"
#define FRAMES "frames of L-junctions"
#define DESCRIPTION "description"
#define RELATED "unrelated images"
#define SHORTLIST "short list"
#define ALIGNMENT "alignment"
#define SUPPORT "support by neighbours"
#define ASSIGNMENT "assignment"
#define VERIFICATION "verification by the matches around"
#define SEGMENTS "line segments"

static const char *const patch_words[] = {"canonical", "induced", NULL};
static const char *const descriptor_words[] = {"raw", "sift", NULL};

/* ..., range, default, paper, match (the same as default), help */
static const asj_option_info rows[] = {
    INTEGER(IMAGES, COMMON, upsample_from, "", 0, 1000000, 8, 0, 8,
            "matches from which on two images are looked at upsampled, too, unless a stretch is given (fewer where a geometry is "
            "asked and left open); 0 = never"),
    SWITCH(IMAGES, COMMON, upsampled_half_octaves, 1, 0, 1,
           "look at upsampled images half-way between their octaves, too: half as many matches again, in 1.3 to 1.6 times the "
           "time"),
    INTEGER(IMAGES, ADVANCED, upsampled_max_junctions, "", 0, 1000000, 16000, 16000, 16000,
            "junctions of an upsampled image that take part, the most meaningful ones; 0 = all"),
    NUMBER(IMAGES, ADVANCED, upsampled_search_radius, "", 0, 1, 0.02, 0, 0.02,
           "upsampled, partners are compared that lie no farther from where eight or more matches of the images put them, in "
           "diagonals, and 0.3 of the distance to these; 0 = anywhere"),
    INTEGER(IMAGES, ADVANCED, upsampled_shortlist, "", 0, 32, 2, 0, 2,
            "shortlist where upsampled_search_radius says where partners lie; 0 = as it is"),
    SWITCH(IMAGES, COMMON, look_at_colours, 1, 0, 1,
           "look at two whole 8-bit colour images once more, with the detector's colours, where a geometry is asked and none is "
           "found that is sure, unless they have nothing in common"),

    NUMBER(FRAMES, ADVANCED, minimum_opening, "deg", 0, 80, 20, 20, 20, "branches that open by less give no frame"),
    INTEGER(FRAMES, ADVANCED, length_hypotheses, "", 1, 4, 3, 1, 3,
            "lengths tried for a branch: its own, and junctions that lie on it"),

    CHOICE(DESCRIPTION, ADVANCED, patches, 1, ASJ_PATCHES_CANONICAL, ASJ_PATCHES_INDUCED, ASJ_PATCHES_CANONICAL, patch_words,
           "canonical: one patch for each L-junction; induced: warped by each pair's own map"),
    CHOICE(DESCRIPTION, COMMON, descriptor, 1, ASJ_DESCRIPTOR_RAW, ASJ_DESCRIPTOR_RAW, ASJ_DESCRIPTOR_RAW, descriptor_words,
           "what describes a patch: raw or sift"),
    SWITCH(DESCRIPTION, ADVANCED, normalise, 1, 0, 1, "bring raw patches to zero mean and unit norm"),
    INTEGER_STEPS(DESCRIPTION, ADVANCED, patch_size, "", 8, 24, 4, 16, 16, 16, "samples along a side of a patch: a multiple of 4"),
    NUMBER(DESCRIPTION, ADVANCED, window_start, "", -1, 0, -0.25, -0.25, -0.25, "a canonical patch starts here, in branch lengths"),
    NUMBER(DESCRIPTION, ADVANCED, window_end, "", 0.25, 2, 1, 1, 1, "a canonical patch ends here, in branch lengths"),
    NUMBER(DESCRIPTION, ADVANCED, patch_radius, "px", 4, 64, 16, 16, 16, "half a side of an induced patch"),
    NUMBER(DESCRIPTION, ADVANCED, smoothing, "px", 0, 2, 0.8, 0, 0.8, "blur of the images before patches are sampled"),

    NUMBER(RELATED, ADVANCED, related_support, "", 0, 64, 0.14, 0, 0.14,
           "images whose likeliest candidates agree less than this have nothing in common and are answered at once; 0 = none are"),

    INTEGER(SHORTLIST, ADVANCED, shortlist, "", 1, 32, 4, 16, 4, "best candidates kept for each L-junction of either image"),

    INTEGER(ALIGNMENT, ADVANCED, align_iterations, "", 0, 30, 6, 0, 6,
            "steps that refine the affine map of a candidate on the images, twice as many with junctions of octave -1; 0 = none"),
    NUMBER(ALIGNMENT, ADVANCED, align_radius, "px", 8, 64, 20, 20, 20, "radius of the disc that is aligned"),
    NUMBER(ALIGNMENT, ADVANCED, max_move, "px", 0.5, 20, 8, 8, 8, "farthest that the alignment may move a junction"),

    INTEGER(SUPPORT, ADVANCED, neighbours, "", 0, 64, 40, 0, 40, "nearest junctions asked for support; 0 = none are asked"),
    INTEGER(SUPPORT, ADVANCED, guided_rounds, "", 0, 4, 1, 0, 1, "times that accepted matches propose matches near them"),
    NUMBER(SUPPORT, COMMON, minimum_support, "", 0, 64, 1.5, 0, 1.5,
           "neighbouring matches that must agree with a match, each counted 0 to 1"),
    NUMBER(SUPPORT, ADVANCED, neighbour_tolerance, "", 0.01, 1, 0.08, 0.08, 0.08,
           "error with which a match predicts its neighbour, as a part of the distance"),
    NUMBER(SUPPORT, ADVANCED, map_tolerance, "", 0.05, 5, 0.5, 0.5, 0.5,
           "relative difference between the affine maps of neighbours"),

    NUMBER(ASSIGNMENT, COMMON, ratio, "", 1, 10, 1.5, 1.5, 1.5,
           "the second best match at another place must be worse by this factor"),
    NUMBER(ASSIGNMENT, ADVANCED, separation, "px", 0, 100, 6, 0, 6, "what is nearer than this is the same place"),
    SWITCH(ASSIGNMENT, COMMON, mutual, 1, 0, 1, "two junctions match only if each is the other's best"),

    RENAMED_INTEGER("witnesses", VERIFICATION, ADVANCED, verify_neighbours, "", 0, 64, 16, 0, 16,
                 "nearest matches that are asked whether they agree with a match; 0 = none, nor epipolar lines"),
    RENAMED_NUMBER("witness_distance", VERIFICATION, ADVANCED, verify_distance, "px", 10, 10000, 100, 100, 100,
                "distance at which such a neighbour counts by half"),
    RENAMED_NUMBER("minimum_agreement", VERIFICATION, COMMON, verify_agreement, "", 0, 1, 0.28, 0, 0.28,
                "mean agreement with the matches around, each counted 0 to 1, that a match needs"),

    NUMBER(SEGMENTS, ADVANCED, end_tolerance, "", 0.01, 1, 0.12, 0.12, 0.12,
           "lengths of branches that explain each other agree within this part, ends that correspond within a sixth, or 4 px"),
};
static const asj_option_table table = {rows, sizeof rows / sizeof *rows, sizeof(asj_match_options)};

void asj_match_options_init(asj_match_options *options)
{
    asj_match_options_preset(options, ASJ_PRESET_DEFAULT);
}

asj_status asj_match_options_preset(asj_match_options *options, int32_t preset)
{
    const asj_status status = asj_option_table_preset(&table, options, preset);
    if (status == ASJ_OK) {
        asj_geometry_options_init(&options->geometry);
        options->geometry.model = ASJ_GEOMETRY_NONE;
    }
    return status;
}

size_t asj_match_option_count(void)
{
    return table.count;
}

const asj_option_info *asj_match_option(size_t index)
{
    return asj_option_table_row(&table, index);
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

asj_status asj_match_options_check(const asj_match_options *options, char *message, size_t message_size)
{
    if (!asj_is_zero(options->reserved, sizeof options->reserved) || options->reserved_integer || options->reserved_switch) {
        snprintf(message, message_size, "%s", ASJ_RESERVED_MESSAGE);
        return ASJ_ERROR_OPTION;
    }
    return asj_option_table_check(&table, options, message, message_size);
}

asj_status asj_match_request_check(asj_context *context, const asj_match_options *options)
{
    char message[256];
    if (asj_match_options_check(options, message, sizeof message) != ASJ_OK)
        return asj_fail(context, ASJ_ERROR_OPTION, "%s", message);
    return options->geometry.model == ASJ_GEOMETRY_NONE ? ASJ_OK : asj_geometry_request_check(context, &options->geometry);
}

/* What the frames and patches of an image depend on: two groups, and what neighbours are. */
static int describes(const asj_option_info *row)
{
    return strcmp(row->group, FRAMES) == 0 || strcmp(row->group, DESCRIPTION) == 0 || strcmp(row->key, "neighbours") == 0 ||
           strcmp(row->key, "separation") == 0;
}

const char *asj_match_options_difference(const asj_match_options *left, const asj_match_options *right)
{
    for (size_t n = 0; n < table.count; n++) {
        const double one = asj_option_load(&rows[n], left), other = asj_option_load(&rows[n], right); /* numbers: -0 is 0 */
        if (describes(&rows[n]) && (one < other || one > other))
            return rows[n].key;
    }
    return NULL;
}
