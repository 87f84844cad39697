/* SPDX-License-Identifier: BSD-2-Clause */
/* How grey levels are held. */
#ifndef ASJ_SRC_GRAY_LEVEL_H
#define ASJ_SRC_GRAY_LEVEL_H

/* As whole numbers in 1/128 of a grey level: 0 .. 255 * 128. */
#define ASJ_GRAY_ONE 128
#define ASJ_GRAY_MAX (255 * ASJ_GRAY_ONE)

#endif
