/* SPDX-License-Identifier: BSD-2-Clause */
#ifndef ASJ_SRC_GEOMETRY_PICTURE_VOTE_H
#define ASJ_SRC_GEOMETRY_PICTURE_VOTE_H

#include "picture_look.h"

/* How much the pictures speak against the second look: above 1 they contradict it, 0 where they do not or nothing is known. */
double asj_pictures_against(const asj_picture_look *first, const asj_picture_look *second);

#endif
