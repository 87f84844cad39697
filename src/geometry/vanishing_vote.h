/* SPDX-License-Identifier: BSD-2-Clause */
/* Branches vote for vanishing points. */
#ifndef ASJ_SRC_GEOMETRY_VANISHING_VOTE_H
#define ASJ_SRC_GEOMETRY_VANISHING_VOTE_H

#include "core/watch.h"

#include <asj/vanishing.h>

#include <stddef.h>

#define ASJ_VOTE_LEVELS 3    /* tolerances */
#define ASJ_VOTE_POINTS 6    /* looked at before right angles */
#define ASJ_VOTE_LINES 300   /* that take part, at most */
#define ASJ_VOTE_LONGEST 60  /* that define points */
#define ASJ_VOTE_PAIRS (ASJ_VOTE_LONGEST * (ASJ_VOTE_LONGEST - 1) / 2)

/* A straight edge, px. `pixel`: how many px wide the pixels are in which it was seen; what it is out grows with them. */
typedef struct asj_straight_edge {
    double x1, y1, x2, y2, pixel;
} asj_straight_edge;

typedef struct asj_vote_line {
    double l[3];      /* unit normal and distance, in the coordinates of the vote */
    double mx, my;    /* middle */
    double sd;        /* rad */
    double length, pixel; /* px */
    double angle;     /* px coordinates, [0, pi) */
    double x, y, ex, ey; /* px: both ends */
    uint32_t source;
    int32_t taken;
} asj_vote_line;

typedef struct asj_vote {
    double v[3];
    double log_nfa;
    int32_t votes, level; /* index of the tolerance */
} asj_vote;

typedef struct asj_vote_search {
    asj_vote_line *lines;
    int32_t count;
    double *tail;     /* log binomial tails, by level and k: ASJ_VOTE_LINES + 1 of each level */
    int32_t members[ASJ_VOTE_LEVELS];
    asj_watch *watch; /* asks whether to go on */
} asj_vote_search;

/* The branches that take part, the longest first; `lines` has room for all branches. Returns how many, fewer when stopped. */
int32_t asj_vanishing_lines(const asj_junction *junctions, size_t count, const asj_camera *camera, asj_watch *watch,
                            asj_vote_line *lines);

/* The edges of at least `shortest` px, in the same way. */
int32_t asj_vote_lines(const asj_straight_edge *edges, size_t count, double shortest, const asj_camera *camera,
                       asj_vote_line *lines);

/* Does the branch vote for v at that level? */
int32_t asj_line_votes_for(const asj_vote_line *one, const double v[3], int32_t level);

/* How likely a line votes for a point by chance, at that level. */
double asj_vote_chance(int32_t level);

/* How many lines vote for any of `count` points, at each level. */
void asj_count_votes(const asj_vote_search *s, double points[][3], int32_t count, int32_t votes[ASJ_VOTE_LEVELS]);

/* Natural logarithm of sum over i >= k of C(n, i) p^i (1 - p)^(n - i), for all k up to n. */
void asj_binomial_tails(int32_t n, double p, double *tail);

/* The points with a log NFA of at most `most`, the surest first; room for ASJ_VOTE_POINTS. Returns how many, fewer when stopped. */
int32_t asj_vote_points(asj_vote_search *s, double most, asj_vote *points);

/* The points of all pairs of the ASJ_VOTE_LONGEST longest lines that a third one votes for, in any order; room for ASJ_VOTE_PAIRS.
 * Returns how many. */
int32_t asj_vote_pairs(asj_vote_search *s, asj_vote *points);

/* The direction of a point of rays times `focal`, of length 1. */
void asj_direction_of(const double v[3], double focal, double direction[3]);

/* The surest first. */
void asj_vote_sort(asj_vote *points, int32_t count);

/* The surest first; of those nearer than `apart` (rad), with that focal length, the surest stays, and `most` in all. Returns how
 * many stay. */
int32_t asj_vote_distinct(asj_vote *points, int32_t count, double focal, double apart, int32_t most);

#endif
