/* SPDX-License-Identifier: BSD-2-Clause */
/* The geometry of the images as they are and that of the upsampled ones, or of their colours: which one is that of both. */
#ifndef ASJ_SRC_MATCH_LOOKS_H
#define ASJ_SRC_MATCH_LOOKS_H

#include "match_result.h"

/* Which one it is, of the images and the upsampled ones; looks.c has the rules. "Hold": enough matches of the images come again
 * among those of the upsampled ones (upsampled.c). */
typedef enum asj_looks {
    ASJ_LOOKS_BY_UPSAMPLED, /* that of the upsampled images, if they have one, where their matches hold; else that of the images */
    ASJ_LOOKS_BY_IMAGES,    /* the accepted one of the images, which judges the matches of both where these hold */
    ASJ_LOOKS_RESOLVED,     /* that of the upsampled images, whether or not their matches hold */
    ASJ_LOOKS_LOST,         /* that of the images, and nothing of the upsampled ones, which do not resolve what is open */
    ASJ_LOOKS_PLANE,        /* as ASJ_LOOKS_BY_UPSAMPLED, but its pose is open: both accept a plane, with poses at odds */
    ASJ_LOOKS_DISPUTED      /* neither, and no match that either contradicts: both accept a motion, not the same, and nothing
                             * decides; or the upsampled ones have rivals with much more evidence than the images' */
} asj_looks;

asj_looks asj_looks_of(const asj_match_result *own, const asj_match_result *upsampled);

/* Are these two estimates of one pose: both accepted, of cameras that were given, and not at odds? */
int32_t asj_looks_agree(const asj_geometry *a, const asj_geometry *b);

/* Is there something that another kind of look (at colours) may answer: no geometry, a motion that stays open or is not sure, or
 * rivals none of which is sure? */
int32_t asj_looks_want_other(const asj_match_result *own);

/* .. and is what that look accepts the answer, in place of `own`? */
int32_t asj_looks_take(const asj_match_result *own, const asj_match_result *other);

/* Do the images leave a motion open that the upsampled ones may resolve, even if the images have no match? */
int32_t asj_looks_may_resolve(const asj_match_result *own);

/* Accepted, or one of several. */
int32_t asj_looks_is_answer(const asj_geometry *g);

#endif
