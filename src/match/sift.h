/* SPDX-License-Identifier: BSD-2-Clause */
/* A SIFT-like descriptor of a patch. */
#ifndef ASJ_SRC_SIFT_H
#define ASJ_SRC_SIFT_H

#include "patch.h"

#define ASJ_SIFT_LENGTH 128

/* The gradient histogram of a size x size patch (size a multiple of 4) as a unit vector of ASJ_SIFT_LENGTH numbers in
 * 1/ASJ_UNIT_ONE. A flat patch gives zeros. */
void asj_sift_describe(const uint16_t *grey, int32_t size, int16_t *unit);

#endif
