/* SPDX-License-Identifier: BSD-2-Clause */
/* THE option table of the detector. The defaults' evidence is in the comments of the step that uses each option. */
#include "detect_options.h"

#include <string.h>

#define ROW(field, type, unit, minimum, maximum, standard, paper, choices, help) \
    {#field, unit, help, choices, type, (uint32_t)offsetof(asj_detect_options, field), minimum, maximum, standard, paper}
#define NUMBER(field, unit, minimum, maximum, standard, paper, help) \
    ROW(field, ASJ_OPTION_NUMBER, unit, minimum, maximum, standard, paper, NULL, help)
#define INTEGER(field, unit, minimum, maximum, standard, paper, help) \
    ROW(field, ASJ_OPTION_INTEGER, unit, minimum, maximum, standard, paper, NULL, help)
#define SWITCH(field, standard, paper, help) ROW(field, ASJ_OPTION_SWITCH, "", 0, 1, standard, paper, NULL, help)

#define RADII_DEFAULT (1u << 7 | 1u << 14)
#define RADII_PAPER (((1u << 13) - 1) & ~((1u << 3) - 1)) /* 3 .. 12 */

static const char *const refinements[] = {"line_fit", "search", NULL};

static const asj_option_info rows[] = {
    NUMBER(epsilon, "NFA", 1e-30, 1e6, 1, 1, "false alarms allowed in an image of noise, for junctions and for branches"),
    NUMBER(minimum_length, "px", 0, 1000, 0, 0, "branches shorter than this are dropped"),
    NUMBER(candidate_strength, "sd", 0, 12, 2.4, 5.15,
           "strength that two local branches need at a candidate pixel; lower finds weaker corners"),
    INTEGER(candidate_step, "px", 1, 2, 2, 1, "from one pixel that may be a candidate to the next, along x and along y"),
    NUMBER(gradient_epsilon, "grey/px", 0.05, 16, 0.4, 0.05,
           "gradient below which a surface counts as flat; raise it against compression noise"),
    SWITCH(standardise, 0, 1, "give each gradient axis zero mean and unit variance over the image"),
    INTEGER(field_radius, "px", 3, 9, 7, 7, "radius of the local junctions: 3, 5, 7 or 9"),
    NUMBER(sector_width, "px", 1, 3, 2, 2, "half-width of a sector at its outer end (tau)"),
    NUMBER(field_epsilon, "NFA", 1e-6, 100, 1, 1, "false alarms allowed for the local branches of one pixel"),
    ROW(isotropic_radii, ASJ_OPTION_RADII, "px", 3, 30, RADII_DEFAULT, RADII_PAPER, NULL,
           "radii at which isotropic junctions are tested"),
    INTEGER(max_branches, "", 2, ASJ_MAX_BRANCHES, 5, 5, "most branches of a junction"),
    SWITCH(more_branches_win, 0, 1, "of junctions closer than half a radius keep the one with more branches"),
    NUMBER(scan_epsilon, "NFA", 1e-6, 1e3, 1, 1, "false alarms allowed for one step of a ray"),
    INTEGER(scan_start, "px", 0, 30, 3, 0, "first radius of a ray; 0 = the junction's isotropic scale"),
    INTEGER(scan_tolerance, "", 0, 8, 1, 0, "failing steps in a row that a ray survives"),
    INTEGER(arc_half_width, "px", 1, 3, 2, 2, "half-width of the arc that a step of a ray looks at"),
    SWITCH(scan_axial, 1, 0, "scan a second time by axis and take the mean of both lengths"),
    ROW(refinement, ASJ_OPTION_CHOICE, "", 0, 1, ASJ_REFINE_LINE_FIT, ASJ_REFINE_SEARCH, refinements,
           "how branches are oriented: line_fit (and sub-pixel location) or search"),
    NUMBER(minimum_opening, "deg", 0, 80, 25, 0, "two branches must open by this much, and by at most 180 minus this"),
    NUMBER(max_move, "px", 0.5, 10, 2.5, 2.5, "farthest that a junction may move while it is located, again when it is refined"),
    NUMBER(merge_angle, "deg", 0, 60, 15, 0, "of two branches closer than this one stays"),
    SWITCH(strip_test, 1, 0, "report a branch only if the strip along it is meaningful"),
    NUMBER(max_deviation, "deg", 1, 90, 90, 90, "largest angle between a branch and the edges under it"),
    NUMBER(near_strength, "sd", -10, 10, 0, -10, "strength that a branch needs in its first 6 px: it must reach the junction"),
    NUMBER(snap_distance, "px", 0, 30, 8, 0, "a branch that ends this close to a junction on its line ends at it"),
    SWITCH(ignore_frame, 1, 0, "drop branches that run along the border of the image"),
    NUMBER(strip_half_width, "px", 0.5, 4, 1.5, 1.5, "half-width of that strip"),
    NUMBER(strip_length, "px", 10, 1000, 60, 60, "length of that strip at most"),
};
static const asj_option_table table = {rows, sizeof rows / sizeof rows[0]};

void asj_detect_options_init(asj_detect_options *options)
{
    asj_detect_options_preset(options, ASJ_PRESET_DEFAULT);
}

asj_status asj_detect_options_preset(asj_detect_options *options, int32_t preset)
{
    if (!options)
        return ASJ_ERROR_ARGUMENT;
    if (preset != ASJ_PRESET_DEFAULT && preset != ASJ_PRESET_PAPER)
        return ASJ_ERROR_OPTION;
    memset(options, 0, sizeof *options);
    asj_option_table_fill(&table, options, preset);
    return ASJ_OK;
}

size_t asj_detect_option_count(void)
{
    return table.count;
}

const asj_option_info *asj_detect_option(size_t index)
{
    return index < table.count ? &rows[index] : NULL;
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
    static const char odd[] = "field_radius: must be 3, 5, 7 or 9";
    asj_status status = asj_option_table_check(&table, options, message, message_size);
    if (status == ASJ_OK && options->field_radius % 2 == 0) {
        if (message && message_size > 0) {
            strncpy(message, odd, message_size - 1);
            message[message_size - 1] = '\0';
        }
        status = ASJ_ERROR_OPTION;
    }
    return status;
}
