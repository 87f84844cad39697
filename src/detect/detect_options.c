/* SPDX-License-Identifier: BSD-2-Clause */
/* THE option table of the detector. The defaults' evidence is in the comments of the step that uses each option.
 *
 * Preset match, measured on photographs (tests/accuracy/match_pairs.c): what the detector does for precision costs the matcher half
 * of its matches and gains it nothing, because a chance junction has no partner that agrees with its neighbours. So: weaker
 * candidates at every pixel, no strip test, corners that the line fit moves far (a blurred corner, a short branch) stay, and a
 * branch is as long as its junction's scale at least, whatever lies between; and branches end where the scan loses them. */
#include "detect_options.h"
#include "core/reserved.h"

#include <stdio.h>

#define OPTIONS_TYPE asj_detect_options
#define OCTAVES "octaves"
#define GRADIENT "step 1, gradient"
#define CANDIDATES "step 2, local junctions and candidates"
#define ISOTROPIC "step 3, isotropic junctions"
#define SCAN "step 4, branch lengths"
#define REFINE "step 5, location, orientation and validation"

#define RADII_DEFAULT (1u << 7 | 1u << 14)
#define RADII_PAPER (((1u << 11) - 1) & ~((1u << 3) - 1)) /* 3 .. 10 */

static const char *const sources[] = {"field", "segments", NULL};
static const char *const refinements[] = {"line_fit", "search", NULL};

/* ..., range, default, paper, match, help */
static const asj_option_info rows[] = {
    INTEGER(OCTAVES, COMMON, octaves, "", 1, 16, 16, 1, 4,
            "how often the image is looked at, each time at half the size, as far as it allows; more finds softer corners"),
    INTEGER(OCTAVES, COMMON, first_octave, "", -1, 15, 0, 0, 0,
            "sizes left out: 1 = begin at half the image's size, or at the last one it has; -1 = begin at twice it"),
    SWITCH(OCTAVES, COMMON, half_octaves, 0, 0, 0,
           "look half-way between two octaves, too: finds weak and soft corners more surely, for half as much time again"),
    SWITCH(OCTAVES, ADVANCED, independent_octaves, 0, 0, 1,
           "every octave keeps what it finds, though a finer one has found the same corner; for matching"),
    SWITCH(OCTAVES, COMMON, colours, 0, 0, 0,
           "look at 8-bit colours, too: corners between surfaces of different colours that are equally bright, in 1.2 to 1.7 times "
           "the time; they match where a geometry is asked"),
    SWITCH(OCTAVES, ADVANCED, three_sizes, 0, 0, 0,
           "look at junctions 0.84 and 1.19 times as large, too, and keep what two of the three have: those that stay when an "
           "image changes a little, in 1.4 to 1.7 times the time"),

    NUMBER(GRADIENT, COMMON, gradient_epsilon, "grey/px", 0.05, 16, 0.4, 0.05, 0.4,
           "gradient below which a surface counts as flat; raise it against compression noise"),
    SWITCH(GRADIENT, ADVANCED, standardise, 0, 1, 0, "give each gradient axis zero mean and unit variance over the image"),

    INTEGER_STEPS(CANDIDATES, ADVANCED, field_radius, "px", 3, 9, 2, 7, 7, 7, "radius of the local junctions: 3, 5, 7 or 9"),
    NUMBER(CANDIDATES, ADVANCED, sector_width, "px", 1, 3, 2, 2.5, 2, "half-width of a sector at its outer end (tau)"),
    NUMBER(CANDIDATES, ADVANCED, field_epsilon, "NFA", 1e-6, 100, 1, 1, 1,
           "false alarms allowed for the local branches of one pixel"),
    NUMBER(CANDIDATES, COMMON, candidate_strength, "sd", 0, 12, 2.4, 5.15, 2,
           "strength that two local branches need at a candidate pixel; lower finds weaker corners"),
    INTEGER(CANDIDATES, ADVANCED, candidate_step, "px", 1, 2, 2, 1, 1,
            "from one pixel that may be a candidate to the next, along x and along y"),
    CHOICE(CANDIDATES, ADVANCED, seeds, 1, ASJ_SEEDS_FIELD, ASJ_SEEDS_SEGMENTS, ASJ_SEEDS_FIELD, sources,
           "where candidates come from: local junctions, or line segments that nearly meet"),
    NUMBER(CANDIDATES, ADVANCED, segment_epsilon, "NFA", 1e-6, 1e12, 1e6, 1e7, 1e6, "false alarms allowed for a line segment"),
    NUMBER(CANDIDATES, ADVANCED, seed_gap, "px", 0, 50, 12, 10, 12, "distance between two segments that nearly meet, at most"),
    INTEGER(CANDIDATES, ADVANCED, seed_radius, "px", 0, 10, 3, 3, 3,
            "candidates lie this close to where segments nearly meet, or end then"),

    RADII(ISOTROPIC, ADVANCED, isotropic_radii, 3, 30, RADII_DEFAULT, RADII_PAPER, RADII_DEFAULT,
          "radii at which isotropic junctions are tested"),
    NUMBER(ISOTROPIC, COMMON, epsilon, "NFA", 1e-30, 1e6, 1, 1, 1e4,
           "false alarms allowed in an image of noise, for junctions and for branches (at half the image and less two weak "
           "branches are judged together)"),
    INTEGER(ISOTROPIC, ADVANCED, isotropic_persistence, "", 1, 8, 1, 3, 1,
            "radii in a row at which a junction must be meaningful"),
    SWITCH(ISOTROPIC, ADVANCED, disjoint_sectors, 0, 1, 0, "the branches of an isotropic junction do not share pixels"),
    INTEGER(ISOTROPIC, ADVANCED, max_branches, "", 2, ASJ_MAX_BRANCHES, 5, 5, 5, "branches that are tested together, at most"),
    SWITCH(ISOTROPIC, ADVANCED, all_meaningful_branches, 0, 1, 0,
           "a junction has all branches that are meaningful by themselves"),
    INTEGER(ISOTROPIC, ADVANCED, isotropic_separation, "px", 0, 15, 2, 0, 2,
            "nearest that two isotropic junctions may be; 0 = half the radius"),
    SWITCH(ISOTROPIC, ADVANCED, more_branches_win, 0, 0, 0, "of nearer ones keep the one with the most branches"),

    NUMBER(SCAN, ADVANCED, scan_epsilon, "NFA", 1e-6, 1e3, 1, 1, 10, "false alarms allowed for one step of a ray"),
    INTEGER(SCAN, ADVANCED, scan_start, "px", 0, 30, 3, 0, 0, "first radius of a ray; 0 = the junction's isotropic scale"),
    INTEGER(SCAN, COMMON, scan_tolerance, "", 0, 8, 1, 0, 1, "failing steps in a row that a ray survives"),
    INTEGER(SCAN, ADVANCED, arc_half_width, "px", 1, 3, 2, 2, 2, "half-width of the arc that a step of a ray looks at"),
    SWITCH(SCAN, ADVANCED, scan_axial, 1, 0, 1, "scan a second time by axis and take the mean of both lengths"),

    NUMBER(REFINE, COMMON, minimum_opening, "deg", 0, 80, 25, 0, 20,
           "two branches must open by this much, and by at most 180 minus this"),
    NUMBER(REFINE, COMMON, minimum_length, "px", 0, 1000, 0, 0, 0, "branches shorter than this are dropped"),
    CHOICE(REFINE, ADVANCED, refinement, 1, ASJ_REFINE_LINE_FIT, ASJ_REFINE_SEARCH, ASJ_REFINE_LINE_FIT, refinements,
           "how branches are oriented: line_fit (and sub-pixel location) or search"),
    SWITCH(REFINE, COMMON, ignore_frame, 1, 0, 1, "drop branches that run along the border of the image"),
    NUMBER(REFINE, ADVANCED, max_move, "px", 0.5, 10, 2.5, 2.5, 5,
           "farthest that a junction may move while it is located, again when it is refined"),
    NUMBER(REFINE, ADVANCED, merge_angle, "deg", 0, 60, 15, 0, 15, "of two branches closer than this one stays"),
    SWITCH(REFINE, ADVANCED, strip_test, 1, 0, 0, "report a branch only if the strip along it is meaningful"),
    NUMBER(REFINE, ADVANCED, strip_half_width, "px", 0.5, 4, 1.5, 1.5, 1.5, "half-width of that strip"),
    NUMBER(REFINE, ADVANCED, strip_length, "px", 10, 1000, 60, 60, 60, "length of that strip at most"),
    NUMBER(REFINE, ADVANCED, near_strength, "sd", -10, 10, 0, -10, -10,
           "strength that a branch needs in its first 6 px: it must reach the junction"),
    NUMBER(REFINE, ADVANCED, max_tilt, "deg", 0, 45, 6, 0, 0,
           "angle at which a branch may cross the edges in its strip; it is turned to them, or counts less; 0 = any, and it may "
           "slip from one to the next"),
    NUMBER(REFINE, ADVANCED, snap_distance, "px", 0, 30, 2, 0, 8,
           "a branch that ends so close (px of its octave) to a junction on its line ends at it"),
    NUMBER(REFINE, ADVANCED, end_contrast, "", 0, 0.9, 0.15, 0, 0,
           "an edge ends where it has this share of its own contrast left; 0 = where noise has it"),
    SWITCH(REFINE, COMMON, complete_junctions, 0, 0, 0,
           "look around every junction for branches that its test has missed"),
};
static const asj_option_table table = {rows, sizeof rows / sizeof *rows, sizeof(asj_detect_options)};

void asj_detect_options_init(asj_detect_options *options)
{
    asj_option_table_preset(&table, options, ASJ_PRESET_DEFAULT);
}

asj_status asj_detect_options_preset(asj_detect_options *options, int32_t preset)
{
    return asj_option_table_preset(&table, options, preset);
}

size_t asj_detect_option_count(void)
{
    return table.count;
}

const asj_option_info *asj_detect_option(size_t index)
{
    return asj_option_table_row(&table, index);
}

asj_status asj_detect_options_set(asj_detect_options *options, const char *key, const char *text,
                                  char *message, size_t message_size)
{
    return asj_option_table_set(&table, options, key, text, message, message_size);
}

asj_status asj_detect_options_get(const asj_detect_options *options, const char *key, char *text, size_t text_size)
{
    return asj_option_table_get(&table, options, key, text, text_size);
}

asj_status asj_detect_options_check(const asj_detect_options *options, char *message, size_t message_size)
{
    if (!asj_is_zero(options->reserved, sizeof options->reserved)) {
        snprintf(message, message_size, "%s", ASJ_RESERVED_MESSAGE);
        return ASJ_ERROR_OPTION;
    }
    return asj_option_table_check(&table, options, message, message_size);
}
