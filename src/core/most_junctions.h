/* SPDX-License-Identifier: BSD-2-Clause */
/* How many junctions of an image the library takes: counts that cannot be are told before anything is read. */
#ifndef ASJ_SRC_MOST_JUNCTIONS_H
#define ASJ_SRC_MOST_JUNCTIONS_H

#define ASJ_MOST_JUNCTIONS 0x10000000u

#endif
