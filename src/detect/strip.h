/* SPDX-License-Identifier: BSD-2-Clause */
/* Validation of a branch: the a-contrario test of the strip of pixels along it. */
#ifndef ASJ_SRC_STRIP_H
#define ASJ_SRC_STRIP_H

#include "core/image.h"

/* Over the pixels of a strip: the sum of gamma, those of the squares of the gradient's components along (uu) and across (nn) and of
 * their product (un), that of gamma of the part next to the junction, numbers of pixels. Sums of gamma are in 1/1024 while they are
 * added up, and in standard units in what asj_strip_add_up() and asj_strip_test() return; the others stay in 2^-20: only their
 * ratios count. */
typedef struct asj_strip_sums {
    double gamma, uu, un, nn, near_gamma;
    int32_t pixels, near_pixels;
} asj_strip_sums;

typedef struct asj_strip {
    double log_nfa;       /* natural logarithm of the number of false alarms */
    double waver;         /* mean square of the gradient along the branch over that across it: 0 = an edge without noise */
    double near_strength; /* standard deviations above the null model in the part next to the junction */
    double near_share;    /* gamma of a pixel in that part, of the mean over the whole strip */
    asj_strip_sums sums;
} asj_strip;

/* Where a strip lies. */
typedef struct asj_strip_line {
    double x, y;   /* px: its start */
    double angle;  /* rad */
    double length; /* px; no more than strip_length counts */
} asj_strip_line;

/* ln NFA of a strip whose pixels are not independent: see strip.c. `width` of its edge, px; `explained` of its hypothesis. */
double asj_strip_correlated(const asj_frame *frame, const asj_strip *strip, double width, double explained);

/* How many of the pixels of a strip are as good as one. */
double asj_strip_alike(double waver, double width, double explained);

asj_strip asj_strip_test(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                         const asj_strip_line *line);

/* near_strength of that strip, alone. */
double asj_strip_near_strength(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                               const asj_strip_line *line);

/* Whether the log_nfa of that strip, or of one only `shorter` px long, is at most `limit`. */
int asj_strip_passes(const asj_context *context, const asj_frame *frame, const asj_detect_options *options,
                     const asj_strip_line *line, double shorter, double limit);

/* ---- sums over it ---- */

#define ASJ_STRIP_LANES 4

/* A strip as it is walked along: by the axis (x or y) that it is longer on, and across over the few pixels that can be inside. */
typedef struct asj_strip_walk {
    double x, y, ux, uy;
    double reach, half_width;
    double near;             /* px: the part next to the junction */
    double slope, spread;    /* across for one step along; half the width across */
    int32_t along_x;
    int32_t first, last;     /* steps along */
} asj_strip_walk;

asj_strip_walk asj_strip_walk_along(const asj_frame *frame, const asj_strip_line *line, double half_width, double near);

/* The sums of any strip, however long; gamma in standard units. `near` px: see asj_strip_walk. */
asj_strip_sums asj_strip_add_up(const asj_context *context, const asj_frame *frame, const asj_strip_line *line, double half_width,
                                double near);

/* ln of the number of strips in an image of this size, one of so many octaves. */
double asj_strip_log_tests(int32_t width, int32_t height, int32_t octaves);

void asj_strip_sums_of(const asj_frame *frame, const asj_strip_walk *walk, asj_strip_sums *sums);

/* floor() for what is near the image, without a call. */
static inline int32_t asj_strip_floor(double value)
{
    return (int32_t)(value + 131072) - 131072;
}

/* The pixels across that step i may have inside, from *first to *last. */
static inline void asj_strip_step(const asj_frame *frame, const asj_strip_walk *walk, int32_t i, int32_t *first, int32_t *last)
{
    const double major = walk->along_x ? walk->x : walk->y, minor = walk->along_x ? walk->y : walk->x;
    const double middle = minor + (i - major) * walk->slope;
    const int32_t end = (walk->along_x ? frame->height : frame->width) - 1;
    *first = asj_strip_floor(middle - walk->spread) + 1;
    *last = asj_strip_floor(middle + walk->spread);
    *first = *first > 0 ? *first : 0;
    *last = *last < end ? *last : end;
}

/* Operations (core/ops.h). */
typedef struct asj_strip_ops {
    void (*sums)(const asj_frame *frame, const asj_strip_walk *walk, asj_strip_sums *sums); /* asj_strip_sums_of() */
} asj_strip_ops;
extern const asj_strip_ops asj_strip_reference;

#endif
