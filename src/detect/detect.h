/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_DETECT_H
#define ASJ_SRC_DETECT_H

#include "core/memory.h"

/* Tables and scratch of the detector, kept in a context from image to image. */
typedef struct asj_detector asj_detector;
void asj_detector_free(asj_memory *memory, asj_detector **detector);

#endif
