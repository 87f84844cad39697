/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_PICTURE_AGREEMENT_H
#define ASJ_SRC_GEOMETRY_PICTURE_AGREEMENT_H

#include "picture_look.h"

#define ASJ_USUAL_AGREEMENT 0.6 /* what a share is drawn to where little is known */
#define ASJ_LEAST_KNOWN 15.0    /* nats: less is not worth anything where shares decide */

typedef struct asj_agreement {
    double share; /* of what they could: about 1 as well as possible, 0 as well as any two cells of what a geometry takes for a
                   * plane; what nothing is known of has ASJ_USUAL_AGREEMENT */
    double known; /* nats: what they could say */
} asj_agreement;

/* What they say for the geometry, nats. */
double asj_agreement_said(asj_agreement agreement);

/* How well the pictures agree through a geometry. */
asj_agreement asj_pictures_agreement(const asj_picture_look *look);

#endif
