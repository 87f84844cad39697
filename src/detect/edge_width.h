/* SPDX-License-Identifier: BSD-2-Clause */
/* How wide the edge under a branch is: what tells which octave it belongs to. */
#ifndef ASJ_SRC_EDGE_WIDTH_H
#define ASJ_SRC_EDGE_WIDTH_H

#include "hypothesis.h"

/* Wider edges than these do not tell their width, px. */
#define ASJ_WIDEST_EDGE 8.0

/* px^2 by which differences over two pixels (1/3) and interpolation (1/6, on average) widen an edge's gradient. */
#define ASJ_EDGE_SAMPLING 0.5

/* Sets the width of every branch. Their lines must be known. */
void asj_edge_widths(const asj_frame *frame, asj_hypothesis *hypothesis);

#endif
