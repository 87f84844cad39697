/* SPDX-License-Identifier: BSD-2-Clause */
/* Whether two line segments are parts of one straight edge of an image: where the shorter lies along the line of the longer. */
#ifndef ASJ_SRC_COURSE_H
#define ASJ_SRC_COURSE_H

#include <stdint.h>

/* What is on one line: as far as the detector takes a junction for on a line. */
#define ASJ_OFF_LINE 2.0        /* px */

/* Ends of two segments are one within .. */
#define ASJ_SAME_END 4.0        /* px, or .. */
#define ASJ_SAME_END_SHARE 0.05 /* .. this part of the length */

/* px within which they are, parts of one edge being told by them: 12 px at most. */
double asj_same_end(double length);

typedef struct asj_end_point {
    double x, y; /* px */
} asj_end_point;

typedef struct asj_course {
    double length;   /* of the longer, px */
    double at[2];    /* the shorter's ends, px along it from the longer's first end */
    double same_end; /* px between ends that are one */
    double overlap;  /* px that parts of one edge share at least, the same of the shorter */
} asj_course;

/* Both by their ends. 0: an end of the shorter lies more than ASJ_OFF_LINE px off the longer's line, it lies across, or there is no
 * such line. */
int32_t asj_course_along(const asj_end_point longer[2], const asj_end_point shorter[2], asj_course *c);

/* rad: a shorter one of this length is turned by no more, or by half a turn and no more, when it lies along. */
double asj_course_most_turn(double of_shorter);

/* Whether the shorter goes the other way. */
int32_t asj_course_is_back(const asj_course *c);

/* px that both cover; below 0 what lies between them. */
double asj_course_shared(const asj_course *c);

/* Whether this end of the shorter lies beyond an end (0, 1) of the longer, or beside it. */
int32_t asj_course_is_beyond(const asj_course *c, int32_t end, int32_t of_shorter);
int32_t asj_course_is_beside(const asj_course *c, int32_t end, int32_t of_shorter);

#endif
