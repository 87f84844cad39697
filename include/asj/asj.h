/* SPDX-License-Identifier: BSD-2-Clause */
/* libasj: anisotropic-scale junctions of indoor images. This header includes the whole core interface.
 *
 *     asj_context *context;
 *     asj_detection *found;
 *     asj_image image = {pixels, ASJ_FORMAT_GRAY8, width, height, 0, 0};
 *     if (asj_context_create(NULL, &context) != ASJ_OK) return 1;
 *     if (asj_detect(context, &image, NULL, &found) == ASJ_OK) {
 *         for (uint32_t i = 0; i < found->junction_count; i++)
 *             printf("%g %g\n", found->junctions[i].x, found->junctions[i].y);
 *         asj_detection_free(&found);
 *     }
 *     asj_context_free(&context);
 *
 * For generated bindings: structs are plain data, with fields of fixed width and no padding where pointers have 64 bits. Constants
 * stand in enumerations without a name; what holds one is an int32_t, whose comment says which, so some generators ask for a
 * cast. */
#ifndef ASJ_H
#define ASJ_H

#include <asj/context.h>
#include <asj/detect.h>
#include <asj/device.h>
#include <asj/features.h>
#include <asj/field.h>
#include <asj/geometry.h>
#include <asj/image.h>
#include <asj/junction.h>
#include <asj/match.h>
#include <asj/options.h>
#include <asj/segments.h>
#include <asj/status.h>
#include <asj/vanishing.h>
#include <asj/version.h>

#endif
