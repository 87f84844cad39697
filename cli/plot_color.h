/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_CLI_PLOT_COLOR_H
#define ASJ_CLI_PLOT_COLOR_H

#include <stdint.h>

/* sRGB in [0, 1]. */
typedef struct cli_color {
    double red, green, blue;
} cli_color;

/* log10 NFA at the two ends of the ramp; beyond them the colour stays. */
#define CLI_RAMP_UNSURE 0.0
#define CLI_RAMP_SURE -100.0

/* From light orange (unsure) over red and violet to dark blue (sure). */
cli_color cli_ramp_color(double log10_nfa);

/* One of five colours that differ for the colour-blind too. */
cli_color cli_branch_color(int32_t branch);

/* Colours for things in an order, 0 <= place <= 1: red, green, blue, magenta. Equally light, and dark enough for a pale ground. */
cli_color cli_order_color(double place);

#endif
