/* SPDX-License-Identifier: BSD-2-Clause */
/* The geometry of the images as they are and that of the upsampled ones, or of their colours: which one is that of both. */
#ifndef ASJ_SRC_MATCH_LOOKS_H
#define ASJ_SRC_MATCH_LOOKS_H

#include "match_result.h"

typedef enum asj_looks {
    ASJ_LOOKS_BY_UPSAMPLED, /* that of the upsampled images, if they have one; otherwise what the images say of theirs */
    ASJ_LOOKS_BY_IMAGES,   /* the accepted one of the images: it is surer, or the upsampled ones do not keep it, or were not asked,
                            * or turn it upside down */
    ASJ_LOOKS_SETTLED,     /* that of the upsampled images, whether or not matches come again: they accept the best one of what the
                            * images leave open, or have so much more evidence */
    ASJ_LOOKS_LOST,        /* the images leave open which motion it is, and the upsampled ones accept what tells none, or one that
                            * is upside down, or, where it is no matter of rivals, another one; or the images have no match, and
                            * the upsampled ones too little evidence; or the images repeat themselves */
    ASJ_LOOKS_PLANE,       /* both accept a plane, which leaves its motion open: the upsampled images', without a pose */
    ASJ_LOOKS_DISPUTED     /* both accept a motion, not the same, and nothing decides: neither, and no match that either
                            * contradicts */
} asj_looks;

asj_looks asj_looks_of(const asj_match_result *own, const asj_match_result *upsampled);

/* Is there something that a look of another kind may answer: no geometry, a motion that stays open or is not sure, or rivals none
 * of which is sure? */
int32_t asj_looks_may_close(const asj_match_result *own);

/* .. and is what such a look accepts the answer? Where the images have chance or too little it is. Otherwise it is when it has so
 * much more evidence, or pictures that agree so much better, that it does not matter which one they had in front; when it is the
 * images' pose, known better and from much more evidence; of rivals also when it is one of them, and of a motion that stays open
 * when they allow it. */
int32_t asj_looks_close(const asj_match_result *own, const asj_match_result *other);

/* Do the images leave a motion open that the upsampled ones may settle, even if the images have no match? */
int32_t asj_looks_may_settle(const asj_match_result *own);

/* Accepted, or one of several. */
int32_t asj_looks_is_answer(const asj_geometry *g);

#endif
