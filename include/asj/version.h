/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_VERSION_H
#define ASJ_VERSION_H

#include <asj/status.h>

#ifdef __cplusplus
extern "C" {
#endif

/* Version of the programming interface. The build reads these three lines; they are the only place where it stands.
 * MAJOR changes when a program must be rebuilt or edited, MINOR when something is added, PATCH for corrections. */
#define ASJ_VERSION_MAJOR 0
#define ASJ_VERSION_MINOR 1
#define ASJ_VERSION_PATCH 0

/* How structs grow. Those that the caller makes and fills keep their size and the places of their fields for as long as MAJOR
 * stays (from 1 on; before it MINOR): new fields take the place of what is called `reserved`, and zero there means what the
 * library did before, or the struct's _init() function fills in the default. So what a caller does not know he leaves at zero or as
 * _init() left it. asj_image, asj_junction, asj_branch and the others without `reserved` do not grow. Structs that the library
 * makes and that are only reached through its pointers (rows of option tables, lists of devices and of segments) may also grow at
 * the end, and are never copied by their size. What is an element of an array, a part of another struct, filled in by the library
 * where the caller has it (asj_geometry, asj_vanishing_points, asj_features_info), or may be put together by the caller
 * (asj_detection, asj_match_result) keeps its size as well. */

/* Version of the library that runs, as (major << 16) | (minor << 8) | patch. Compare it with ASJ_VERSION at start-up.
 * Thread safety: any thread, any time. */
ASJ_API uint32_t asj_version(void);

/* The same as text, "0.1.0". A static string. */
ASJ_API const char *asj_version_string(void);

#define ASJ_VERSION ((ASJ_VERSION_MAJOR << 16) | (ASJ_VERSION_MINOR << 8) | ASJ_VERSION_PATCH)

#ifdef __cplusplus
}
#endif
#endif
