/* SPDX-License-Identifier: BSD-2-Clause */
/* The reference form of the sums of a blurred wedge. */
#include "blurred_wedge_sums.h"

const asj_wedge_ops asj_wedge_reference = {.add_up = wedge_add_up};
