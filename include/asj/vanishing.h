/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_VANISHING_H
#define ASJ_VANISHING_H

#include <asj/geometry.h>
#include <asj/junction.h>

#ifdef __cplusplus
extern "C" {
#endif

#define ASJ_MOST_VANISHING 3

/* Where the focal length comes from. */
enum {
    ASJ_FOCAL_UNKNOWN = 0,
    ASJ_FOCAL_GIVEN = 1,
    ASJ_FOCAL_FOUND = 2       /* from two vanishing points of directions at right angles */
};

/* Fill with asj_vanishing_options_init(), then change fields. */
typedef struct asj_vanishing_options {
    asj_camera camera;        /* fx = fy = 0, the default: not known; square pixels and the principal point in the middle are
                               * assumed */
    int32_t width, height;    /* px of the image; must be given */
    double epsilon;           /* of chance directions in an image of branches without any: 1e-12 .. 1; 0.01 */
    double reserved[8];       /* zero */
} asj_vanishing_options;

/* Fills in the defaults. NULL is left alone. */
ASJ_API void asj_vanishing_options_init(asj_vanishing_options *options);

/* What parallel edges of the scene meet in. */
typedef struct asj_vanishing_point {
    double point[3];          /* homogeneous, of length 1: the pixel is (point[0] / point[2], point[1] / point[2]), and far away
                               * where point[2] is nearly 0 */
    double direction[3];      /* of the edges in camera coordinates (x right, y down, z forward), of length 1, sign unknown; zero
                               * without a focal length */
    double log10_nfa;         /* how many points with so many branches chance brings in such an image: anywhere, or, where there is
                               * a focal length and another direction, on the line that these leave it */
    uint32_t branch_count;    /* that agree; those of one line count once */
    uint32_t reserved;
} asj_vanishing_point;

/* Up to three directions; with a focal length, given or found, they are at right angles to each other and found together, few
 * branches of one with many of the others; else at least 8 degrees apart in a camera whose focal length is the longer side of the
 * image. The surest first. */
typedef struct asj_vanishing_points {
    int32_t count;
    int32_t focal_source;     /* ASJ_FOCAL_... */
    asj_camera camera;        /* given or found; zero when not known */
    asj_vanishing_point points[ASJ_MOST_VANISHING]; /* those beyond count are zero */
    double reserved[8];
} asj_vanishing_points;

/* Vanishing points of the straight branches of one image's junctions.
 *
 * junctions   may be NULL when count is 0; only read
 * result      written whole when ASJ_OK is returned
 *
 * src/geometry/vanishing.c and vanishing_frame.c say how. Safe in several threads with a context each; the same result every time.
 * The caller is asked every 50 ms whether to go on, as ASJ_STAGE_DECOMPOSE: 300 000 junctions took .2 s.
 *
 * ASJ_ERROR_ARGUMENT   a NULL pointer; a junction that cannot be (asj_junction_check())
 * ASJ_ERROR_LIMIT      more than 2^28 junctions
 * ASJ_ERROR_OPTION     an option outside its range, a camera that cannot be (asj_camera), or a reserved field that is not zero
 * ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED */
ASJ_API asj_status asj_find_vanishing_points(asj_context *context, const asj_junction *junctions, size_t count,
                                             const asj_vanishing_options *options, asj_vanishing_points *result);

#ifdef __cplusplus
}
#endif
#endif
