/* SPDX-License-Identifier: BSD-2-Clause */
/* Where partners are looked for, when some matches are known already. */
#ifndef ASJ_SRC_EXPECTED_H
#define ASJ_SRC_EXPECTED_H

#include "match_run.h"

/* px, as the matcher works on the images: 4 and 2 numbers, which devices read as such. */
typedef struct asj_box {
    float left, top, right, bottom;
} asj_box;

typedef struct asj_point {
    float x, y;
} asj_point;

/* Of each L-junction of image 1 and of image 2. Two may be partners when each lies in the other's box. */
typedef struct asj_expected {
    asj_point *points[2]; /* where it lies, */
    asj_box *boxes[2];    /* and in the other image, where its partners do */
} asj_expected;

/* Asks the matches that are known, in px of the images, of which the matcher works on enlargements by `by`. Free it either way.
 * ASJ_ERROR_MEMORY, ASJ_ERROR_CANCELLED. */
asj_status asj_expect(const asj_match_run *run, const asj_match_result *known, const asj_stretch by[2], asj_expected *expected);
void asj_expected_free(asj_memory *memory, asj_expected *expected);

static inline int asj_box_holds(const asj_box *box, const asj_point *p)
{
    return p->x >= box->left && p->x <= box->right && p->y >= box->top && p->y <= box->bottom;
}

/* i of image 1, j of image 2. */
static inline int asj_may_be_partners(const asj_expected *e, uint32_t i, uint32_t j)
{
    return asj_box_holds(&e->boxes[0][i], &e->points[1][j]) && asj_box_holds(&e->boxes[1][j], &e->points[0][i]);
}

static inline int asj_boxes_meet(const asj_box *a, const asj_box *b)
{
    return a->left <= b->right && b->left <= a->right && a->top <= b->bottom && b->top <= a->bottom;
}

/* One that holds nothing yet, and the least one that holds both. */
static inline asj_box asj_box_empty(void)
{
    return (asj_box){1e30f, 1e30f, -1e30f, -1e30f};
}

static inline void asj_box_join(asj_box *box, const asj_box *other)
{
    box->left = other->left < box->left ? other->left : box->left;
    box->top = other->top < box->top ? other->top : box->top;
    box->right = other->right > box->right ? other->right : box->right;
    box->bottom = other->bottom > box->bottom ? other->bottom : box->bottom;
}

#endif
